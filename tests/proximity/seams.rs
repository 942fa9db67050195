//! Contacts of walls whose triangles touch within rounding: T-vertices, seams of an ulp, corners
//! that each triangle rounds for itself. Each wall has a twin, the same surface with equal corners
//! and whole edges, and the same contacts are right.

use super::scenes::mesh_of;
use continuum_testing::{Random, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Contact, Exhaustive, Proximity};
use std::f64::consts::TAU;

type Triangle = [Vector; 3];

/// Returns what pairs of triangles share, by all pairs of their edges: equal corners, the edges
/// between them, and the stretches in which open edges run along one another. Each is given by its
/// ends. An edge is open if all of its triangles have the same third corner.
pub fn shared_stretches(triangles: &[Triangle]) -> Vec<Vec<Vec<[Vector; 2]>>> {
    let edges = |t: usize| [0, 1, 2].map(|k| [0, 1, 2].map(|j| triangles[t][(k + j) % 3]));
    let is_open = |[from, to, third]: [Vector; 3]| {
        let all = (0..triangles.len()).flat_map(edges);
        let mut same = all.filter(|&[a, b, _]| [a, b] == [from, to] || [b, a] == [from, to]);
        from != to && same.all(|[.., other]| other == third || other == from || other == to)
    };
    let open: Vec<Vec<_>> = (0..triangles.len())
        .map(|t| edges(t).into_iter().filter(|edge| is_open(*edge)).collect())
        .collect();
    let is_on = |point: Vector, [from, to, _]: [Vector; 3]| {
        let along = to - from;
        let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let largest = [point, from, to].map(|point| point.abs().max_element());
        let rounding = 16.0 * Real::EPSILON * largest.into_iter().fold(0.0, Real::max);
        (point - from - along * share).abs().max_element() <= rounding
    };
    let of_pair = |one: usize, other: usize| {
        let common = triangles[one].into_iter().filter(|corner| triangles[other].contains(corner));
        let common: Vec<_> = common.collect();
        let mut stretches = Vec::new();
        for &from in &common {
            stretches.extend(common.iter().map(|&to| [from, to]));
        }
        for &e in &open[one] {
            for &f in &open[other] {
                let ends = e[..2].iter().filter(|&&end| is_on(end, f));
                let ends = ends.chain(f[..2].iter().filter(|&&end| is_on(end, e)));
                let ends: Vec<_> = ends.copied().collect();
                for &from in &ends {
                    stretches.extend(ends.iter().map(|&to| [from, to]));
                }
            }
        }
        stretches
    };
    let count = triangles.len();
    (0..count).map(|one| (0..count).map(|other| of_pair(one, other)).collect()).collect()
}

/// The contacts of a robot, from all engines, which agree.
fn contacts(mesh: &TriMesh, robot: &Chain, margin: Real, prominence: Real) -> Vec<Contact> {
    let mut engines: [Box<dyn Proximity>; 3] = [
        Box::new(BvhSearch::new(mesh).unwrap()),
        Box::new(Exhaustive::<f32>::new(mesh).unwrap()),
        Box::new(Exhaustive::<f64>::new(mesh).unwrap()),
    ];
    let [first, second, third] = engines.each_mut().map(|engine| {
        let mut out = Vec::new();
        engine.contacts_within(robot, &Pose::IDENTITY, margin, prominence, &mut out).unwrap();
        out
    });
    assert_eq!(first, second);
    assert_eq!(first, third);
    first
}

fn capsule(ends: [Vector; 2], radius: Real) -> Chain {
    Chain::capsules(&ends, &[radius]).unwrap()
}

/// A wall over a grid of squares, each of two triangles. `height` gives the height of each corner.
/// Each triangle is a fan around its centre. Its fan has further corners on its edges: in the first
/// wall its own, as T-vertices; in the second also the corners of the neighbour.
struct Twins {
    with_t_vertices: Vec<Triangle>,
    conforming: Vec<Triangle>,
}

impl Twins {
    fn new(random: &mut Random, squares: u32, height: impl Fn(&mut Random) -> Real) -> Self {
        let corners: Vec<_> = (0..(squares + 1) * (squares + 1))
            .map(|i| {
                let [x, y] = [i % (squares + 1), i / (squares + 1)]
                    .map(|k| f64::from(k) - 0.5 * f64::from(squares));
                Vector::new(x, y, height(random))
            })
            .collect();
        let (mut coarse, row) = (Vec::new(), squares + 1);
        for i in (0..row * squares).filter(|i| i % row != squares) {
            coarse.extend([[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]);
        }
        // Further corners of each edge, as its share from the lower end: of the triangle where the
        // edge leads up, and of the other one.
        let cuts = (0..row * row).flat_map(|from| [1, row, row + 1].map(|to| (from, from + to)));
        let cuts: std::collections::HashMap<_, [Vec<Real>; 2]> = cuts
            .map(|edge| {
                (
                    edge,
                    [(); 2].map(|()| {
                        let mut shares: Vec<_> =
                            (0..random.below(3)).map(|_| random.between(0.1, 0.9)).collect();
                        shares.sort_by(Real::total_cmp);
                        shares
                    }),
                )
            })
            .collect();
        let fan = |triangle: [u32; 3], sides: &dyn Fn(bool) -> Vec<usize>| {
            let mut rim = Vec::new();
            for k in 0..3 {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                let is_up = from < to;
                let ends = [from.min(to), from.max(to)];
                let of_edge = &cuts[&(ends[0], ends[1])];
                let mut shares: Vec<Real> =
                    sides(is_up).into_iter().flat_map(|side| of_edge[side].clone()).collect();
                shares.sort_by(Real::total_cmp);
                if !is_up {
                    shares.reverse();
                }
                let [low, high] = ends.map(|end| corners[end as usize]);
                rim.push(corners[from as usize]);
                rim.extend(shares.into_iter().map(|share| low + (high - low) * share));
            }
            let centre = triangle.map(|k| corners[k as usize]).into_iter().sum::<Vector>() / 3.0;
            (0..rim.len()).map(move |k| [centre, rim[k], rim[(k + 1) % rim.len()]]).collect()
        };
        let own = |is_up: bool| vec![usize::from(is_up)];
        let both = |_: bool| vec![0, 1];
        let all = |sides: &dyn Fn(bool) -> Vec<usize>| {
            coarse.iter().flat_map(|&triangle| -> Vec<Triangle> { fan(triangle, sides) }).collect()
        };
        Self { with_t_vertices: all(&own), conforming: all(&both) }
    }

    /// Places both in another frame. The corners are rounded there.
    fn placed(mut self, pose: &Pose) -> Self {
        for triangles in [&mut self.with_t_vertices, &mut self.conforming] {
            triangles.as_flattened_mut().iter_mut().for_each(|corner| *corner = *pose * *corner);
        }
        self
    }
}

/// A frame: as the wall was made, turned, far away, or both.
fn frame(random: &mut Random) -> Pose {
    let pose = random.pose(1.0);
    let offset = [0.0, 1.0, 1e3, 1e7][random.below(4) as usize];
    let turn = if random.below(3) == 0 { Pose::IDENTITY.rotation } else { pose.rotation };
    Pose::from_parts(pose.translation * offset, turn)
}

/// Each triangle with its own rounding: coordinates that an ulp moves.
fn with_own_rounding(random: &mut Random, triangles: &mut [Triangle]) {
    for corner in triangles.as_flattened_mut() {
        let ulp = corner.abs().max_element() * Real::EPSILON;
        let [x, y, z] = [(); 3].map(|()| f64::from(random.below(3)) - 1.0);
        *corner += Vector::new(x, y, z) * ulp;
    }
}

/// A mesh in which each triangle has its own corners.
fn soup(triangles: &[Triangle]) -> TriMesh {
    let corners = |triangle: &Triangle| triangle.map(|corner| corner.to_array());
    mesh_of(&triangles.iter().map(corners).collect::<Vec<_>>())
}

/// The floor of the report: one T-vertex in the middle.
#[test]
fn a_t_vertex_ends_no_floor() {
    let corners = [
        [-2.0, -2.0],
        [2.0, -2.0],
        [2.0, 0.0],
        [-2.0, 0.0],
        [0.25, 0.0],
        [2.0, 2.0],
        [0.25, 2.0],
        [-2.0, 2.0],
    ];
    let corners = corners.map(|[x, y]| Vector::new(x, y, 0.0)).to_vec();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 2, 5], [4, 5, 6], [3, 4, 6], [3, 6, 7]];
    let floor = TriMesh::new(corners, triangles).unwrap();
    let robot = capsule([Vector::new(1.25, -0.5, 1.25), Vector::new(1.25, -0.5, 3.0)], 0.25);
    for prominence in [0.0, 1e-9, 0.5] {
        let found = contacts(&floor, &robot, 2.0, prominence);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].distance, 1.0);
    }
}

/// Two halves of a floor: their common edge differs by rounding, or by more.
#[test]
fn halves_are_one_up_to_rounding() {
    let ends = [Vector::new(0.5, -0.5, 1.25), Vector::new(0.5, 1.5, 1.25)];
    for offset in [0.0, 1.0, 1e3, -1e9] {
        let ulp = Real::EPSILON * f64::max(2.0, f64::abs(offset));
        for (gap, count) in [(0.0, 1), (ulp, 1), (-ulp, 1), (8.0 * ulp, 1), (1e-4, 2)] {
            let place = |x: Real, y: Real| [x, y + offset, 0.0];
            let floor = mesh_of(&[
                [place(-2.0, -2.0), place(2.0, -2.0), place(2.0, 0.0)],
                [place(-2.0, -2.0), place(2.0, 0.0), place(-2.0, 0.0)],
                [place(-2.0, gap), place(2.0, gap), place(2.0, 2.0)],
                [place(-2.0, gap), place(2.0, 2.0), place(-2.0, 2.0)],
            ]);
            let robot = capsule(ends.map(|end| end + Vector::Y * offset), 0.25);
            for prominence in [0.0, 0.1] {
                let found = contacts(&floor, &robot, 2.0, prominence);
                assert_eq!(found.len(), count, "{offset} {gap}: {found:?}");
                assert!((found[0].distance - 1.0).abs() <= 1e-15, "{found:?}");
            }
        }
    }
}

/// A flat floor is one contact, however its triangles meet, and the contact is the lowest of the
/// nearest triangles.
#[test]
fn flat_floors_are_one_contact() {
    let mut cut = 0;
    for seed in 0..rounds(160) {
        let random = &mut Random::new(seed);
        let frame = match random.below(3) {
            // The floor stays exactly flat.
            0 => Pose::from_translation(
                Vector::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.5)
                    * [0.0, 1.0, 1e3, 1e7][random.below(4) as usize],
            ),
            _ => Pose::from_parts(Vector::ZERO, random.pose(0.0).rotation),
        };
        let walls = Twins::new(random, 3, |_| 0.0).placed(&frame);
        let mut floor = walls.with_t_vertices;
        cut += usize::from(floor.len() != walls.conforming.len());
        if frame.translation == Vector::ZERO && random.below(2) == 0 {
            with_own_rounding(random, &mut floor);
        }
        let height = random.between(0.5, 1.5);
        let mut end = || Vector::new(random.between(-1.2, 1.2), random.between(-1.2, 1.2), height);
        let robot = capsule([end(), end()].map(|end| frame * end), 0.25);
        let floor = soup(&floor);
        for prominence in [0.0, 1e-6, 0.1] {
            let found = contacts(&floor, &robot, 2.0, prominence);
            assert_eq!(found.len(), 1, "{seed}: {found:?}");
            let least = BvhSearch::new(&floor).unwrap().minimum(&robot, &Pose::IDENTITY).unwrap();
            assert_eq!(found[0].witness.triangle, least.witness.triangle);
        }
    }
    assert!(cut > rounds(100), "{cut}");
}

/// Rough walls with T-vertices have the contacts of their twins, at every prominence.
#[test]
fn rough_walls_have_the_contacts_of_their_twins() {
    let (mut several, mut dropped, mut noisy, mut far) = (0, 0, 0, 0);
    for seed in 0..rounds(240) {
        let random = &mut Random::new(seed);
        let rough = [0.05, 0.3, 1.0][random.below(3) as usize];
        let frame = frame(random);
        let walls = Twins::new(random, 3, |random| random.between(-rough, rough)).placed(&frame);
        let Twins { mut with_t_vertices, conforming } = walls;
        if random.below(2) == 0 {
            with_own_rounding(random, &mut with_t_vertices);
            noisy += 1;
        }
        let ends = [(); 2].map(|()| random.point() * 1.3 + Vector::Z * random.between(0.0, 1.5));
        let robot = capsule(ends.map(|end| frame * end), random.between(0.02, 0.2));
        let [split, twin] = [with_t_vertices, conforming].map(|triangles| soup(&triangles));
        let size = 10.0 + frame.translation.abs().max_element();
        let tolerance = 64.0 * Real::EPSILON * size;
        let mut counts = Vec::new();
        for prominence in [0.0, 0.02, 0.2] {
            let [found, expected] =
                [&split, &twin].map(|mesh| contacts(mesh, &robot, 3.0, prominence));
            let is_same =
                |one: &Contact, other: &Contact| (one.distance - other.distance).abs() <= tolerance;
            assert_eq!(found.len(), expected.len(), "{seed}, {prominence}: {found:?} {expected:?}");
            let all = found.iter().zip(&expected);
            assert!(all.clone().all(|(a, b)| is_same(a, b)), "{seed}: {found:?} {expected:?}");
            counts.push(found.len());
        }
        several += usize::from(counts[0] > 1);
        dropped += usize::from(counts[2] < counts[0]);
        far += usize::from(size > 1e6);
    }
    assert!(several > rounds(30) && dropped > rounds(15), "{several} {dropped}");
    assert!(noisy > rounds(50) && far > rounds(40), "{noisy} {far}");
}

/// A lumen whose triangles round their corners for themselves.
#[test]
fn a_lumen_of_rounded_corners_has_no_seams() {
    // No two walls of it face one another at 60 degrees, where a prominence decides by rounding.
    let (rows, columns) = (6, 11);
    for seed in 0..4 {
        let random = &mut Random::new(seed);
        let turn = random.pose(1.0);
        let corner = |row: u32, column: u32| {
            let angle = TAU * f64::from(column % columns) / f64::from(columns);
            turn * Vector::new(angle.cos(), angle.sin(), f64::from(row) - 2.5)
        };
        let squares = (0..rows - 1).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let mut triangles: Vec<Triangle> = squares
            .flat_map(|(row, column)| {
                let [a, b] = [corner(row, column), corner(row, column + 1)];
                let [c, d] = [corner(row + 1, column + 1), corner(row + 1, column)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let exact = soup(&triangles);
        for corner in triangles.as_flattened_mut() {
            *corner = (*corner * 1e15).round() / 1e15;
            corner[random.below(3) as usize] += [0.0, 1e-15][random.below(2) as usize];
        }
        let rounded = soup(&triangles);
        let ends = [Vector::new(0.2, 0.1, -1.1), Vector::new(0.2, 0.1, 1.2)];
        let robot = capsule(ends.map(|end| turn * end), 0.1);
        for prominence in [0.0, 0.01] {
            let [found, expected] =
                [&rounded, &exact].map(|mesh| contacts(mesh, &robot, 3.0, prominence));
            assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                let difference = (found.distance - expected.distance).abs();
                assert!(difference < 1e-14, "{seed}: {found:?} {expected:?}");
            }
        }
    }
}

/// Coincident triangles share their corners and edges, but not their faces.
#[test]
fn coincident_triangles_are_separate_between_their_edges() {
    let triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let double = mesh_of(&[triangle, [triangle[0], triangle[2], triangle[1]]]);
    for (x, y, count) in [(1.0, 1.0, 2), (1.0, -0.5, 1), (-0.5, -0.5, 1)] {
        let robot = capsule([Vector::new(x, y, 1.0), Vector::new(x, y, 2.0)], 0.25);
        let found = contacts(&double, &robot, 3.0, 0.0);
        assert_eq!(found.len(), count, "{found:?}");
        assert_eq!(found[0].witness.triangle, 0);
    }
}

/// Three corners in a row, each within rounding of the next: one place, although the first and the
/// last are farther apart. Without the one between them these are two places.
#[test]
fn a_chain_of_corners_is_one_place() {
    let step = 40.0 * 1e3 * Real::EPSILON / 2.0;
    let leg = |x: Real, turn: Real| {
        let (sin, cos) = turn.sin_cos();
        let down = |side: Real| {
            let out = Vector::new(cos - side * sin, sin + side * cos, 0.0);
            [1e3 + out.x, out.y, out.z - 1.0]
        };
        [[1e3 + x, 0.0, 0.0], down(-0.2), down(0.2)]
    };
    let robot = capsule([Vector::new(1e3, 0.0, 1.0), Vector::new(1e3, 0.0, 2.0)], 0.25);
    // Below the rounding of 32 u 1e3, and above it. No corner lies beside an edge of another leg.
    for (far, count) in [(0.6 * step, 1), (1.2 * step, 2)] {
        let two = mesh_of(&[leg(0.0, 0.0), leg(-far, 2.0)]);
        assert_eq!(contacts(&two, &robot, 2.0, 0.0).len(), count);
    }
    let three = mesh_of(&[leg(0.0, 0.0), leg(-1.2 * step, 2.0), leg(-0.6 * step, 4.0)]);
    assert_eq!(contacts(&three, &robot, 2.0, 0.0).len(), 1);
}

/// After the vertices moved, the seams follow from the new positions.
#[test]
fn seams_follow_the_vertices() {
    let (mut closed, mut torn) = (0, 0);
    for seed in 0..rounds(80) {
        let random = &mut Random::new(seed);
        let walls = Twins::new(random, 2, |random| random.between(-0.2, 0.2));
        let whole = soup(&walls.with_t_vertices);
        let moved = |random: &mut Random| -> Vec<Vector> {
            match random.below(3) {
                0 => whole.vertices().to_vec(),
                1 => whole.vertices().iter().map(|corner| *corner * 1.5 + Vector::X).collect(),
                _ => {
                    let gap = [1e-3, 0.1][random.below(2) as usize];
                    whole.vertices().iter().map(|c| *c + random.point() * gap).collect()
                }
            }
        };
        let first = TriMesh::new(moved(random), whole.indices().to_vec()).unwrap();
        let mut search = BvhSearch::new(&first).unwrap();
        if random.below(2) == 0 {
            search.prepare();
        }
        let robot =
            capsule([(); 2].map(|()| random.point() + Vector::Z * random.between(0.3, 1.0)), 0.1);
        for _ in 0..3 {
            let places = moved(random);
            search.set_vertices(&places).unwrap();
            let fresh = TriMesh::new(places, whole.indices().to_vec()).unwrap();
            for prominence in [0.0, 0.05] {
                let mut out = Vec::new();
                search.contacts_within(&robot, &Pose::IDENTITY, 2.0, prominence, &mut out).unwrap();
                let expected = contacts(&fresh, &robot, 2.0, prominence);
                assert_eq!(out, expected, "{seed}");
                *if out.len() > 3 { &mut torn } else { &mut closed } += 1;
            }
        }
    }
    assert!(closed > rounds(60) && torn > rounds(15), "{closed} {torn}");
}
