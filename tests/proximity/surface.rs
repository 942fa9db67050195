//! The openings of a wall are found and measured, and a robot that leaves through one is not
//! inside.

use crate::parity::on_grid;
use continuum_demo::lumen;
use continuum_testing::{Random, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::{Ball, Cuboid, TriMesh};
use parry_continuum::proximity::{BvhSearch, Opening, Proximity, Side, SurfaceReport};
use std::collections::BTreeMap;

type Mesh = (Vec<Vector>, Vec<[u32; 3]>);

fn search((vertices, triangles): &Mesh) -> BvhSearch {
    BvhSearch::from_triangles(vertices, triangles).unwrap()
}

fn report(mesh: &Mesh) -> SurfaceReport {
    search(mesh).surface().clone()
}

/// A straight vessel along z, open at both ends, and the lids of both ends.
fn vessel(radius: f64, length: f64, around: u32) -> (Mesh, Vec<[u32; 3]>) {
    let ring = |z: f64| {
        (0..around).map(move |k| {
            let (sin, cos) = (f64::from(k) / f64::from(around) * std::f64::consts::TAU).sin_cos();
            Vector::new(radius * cos, radius * sin, z)
        })
    };
    let mut vertices: Vec<_> =
        (0..=4).flat_map(|row| ring(length * f64::from(row) / 4.0)).collect();
    let at = |row: u32, k: u32| row * around + k % around;
    let squares = (0..4).flat_map(|row| (0..around).map(move |k| (row, k)));
    let sides = squares.flat_map(|(row, k)| {
        let [a, b, c, d] = [at(row, k), at(row, k + 1), at(row + 1, k), at(row + 1, k + 1)];
        [[a, b, d], [a, d, c]]
    });
    let sides = sides.collect();
    let middle = vertices.len() as u32;
    vertices.extend([Vector::ZERO, Vector::Z * length]);
    let lids = (0..around)
        .flat_map(|k| [[at(0, k + 1), at(0, k), middle], [at(4, k), at(4, k + 1), middle + 1]]);
    ((vertices, sides), lids.collect())
}

#[test]
fn a_closed_surface_has_no_flaw() {
    for mesh in [Ball::new(3.0).to_trimesh(24, 12), Cuboid::new(Vector::ONE).to_trimesh()] {
        let found = report(&mesh);
        assert!(found.is_sound() && found.doubts().is_empty(), "{found:?}");
        // A box of an STL file: corners are shared by place alone.
        let corners = mesh.1.as_flattened().iter().map(|&corner| mesh.0[corner as usize]);
        let alone = (0..mesh.1.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
        assert!(report(&(corners.collect(), alone.collect())).is_sound());
    }
}

#[test]
fn openings_are_as_wide_as_they_are() {
    let around = 24;
    let (mesh, lids) = vessel(7.0, 40.0, around);
    let found = report(&mesh);
    assert_eq!(found.openings.len(), 2);
    for opening in &found.openings {
        assert_eq!(opening.edges, around as usize);
        assert!((opening.width - 14.0).abs() < 1e-12, "{opening:?}");
        let centre = opening.centre;
        let off = (centre - Vector::Z * if centre.z > 20.0 { 40.0 } else { 0.0 }).length();
        assert!(off < 1e-12, "{centre}");
    }
    assert!(found.doubts()[0].starts_with("the mesh is open: 2 openings, the widest 14 wide at ("));
    // With its lids it is closed; with one lid, it has one opening.
    let with = |lids: &[[u32; 3]]| (mesh.0.clone(), [&mesh.1[..], lids].concat());
    assert!(report(&with(&lids)).is_sound());
    let one: Vec<_> = lids.iter().copied().skip(1).step_by(2).collect();
    assert_eq!(report(&with(&one)).openings.len(), 1);
    // The unit is exact, and the frame makes no difference beyond rounding.
    for power in [-300, -40, 40, 300] {
        let scale = 2.0_f64.powi(power);
        let scaled = (mesh.0.iter().map(|&place| place * scale).collect(), mesh.1.clone());
        let widths = report(&scaled).openings.into_iter().map(|opening| opening.width / scale);
        assert!(widths.eq(found.openings.iter().map(|opening| opening.width)), "{power}");
    }
    let mut random = Random::new(71);
    for _ in 0..20 {
        let pose = random.pose(1e3);
        let turned = (mesh.0.iter().map(|&place| pose * place).collect(), mesh.1.clone());
        let widths = report(&turned).openings.into_iter().map(|opening| opening.width);
        assert!(widths.into_iter().all(|width| (width - 14.0).abs() < 1e-10));
    }
}

/// A slit is as wide as its gap. Corners on an edge within rounding are a seam: no opening.
#[test]
fn a_slit_is_narrow_and_a_seam_is_closed() {
    // A square of two halves, whose inner edges meet at their ends. One half has a corner in the
    // middle of its inner edge that is `gap` away.
    let halves = |gap: f64, pose: &Pose| -> Mesh {
        let places = [(-9.0, 0.0), (9.0, 0.0), (0.0, 30.0), (0.0, -30.0), (1.0, -gap)];
        let vertices = places.map(|(x, y)| *pose * Vector::new(x, y, 0.0));
        (vertices.to_vec(), vec![[0, 1, 2], [3, 4, 0], [3, 1, 4]])
    };
    let mut random = Random::new(73);
    for round in 0..60 {
        let pose = match round {
            0 => Pose::IDENTITY,
            _ => random.pose(1e4),
        };
        let count = |mesh: &Mesh| report(mesh).openings.len();
        // The outer edge and the inner one share two corners: they are one opening, the whole.
        let [seam, slit] = [0.0, 1e-3].map(|gap| halves(gap, &pose));
        assert_eq!([count(&seam), count(&slit)], [1, 1]);
        // Closed at the back by a cone, so that only the inner edges are left.
        let closed = |(mut vertices, mut triangles): Mesh| -> Mesh {
            vertices.push(pose * Vector::new(0.0, 0.0, 8.0));
            triangles.extend([[2, 1, 5], [0, 2, 5], [3, 0, 5], [1, 3, 5]]);
            (vertices, triangles)
        };
        let [seam, slit] = [seam, slit].map(closed);
        assert_eq!(count(&seam), 0, "{pose:?}");
        let found = report(&slit);
        assert!((found.openings[0].width - 1e-3).abs() < 1e-10, "{found:?}");
    }
}

/// The six faces of a box, each a grid of its own fineness, so that the corners of one face lie
/// within the edges of the other: at T-vertices, around the corners of the box too.
fn patched_box(random: &mut Random, place: &dyn Fn(Vector) -> Vector) -> Vec<Mesh> {
    let sizes = [7.0, 11.0, 13.0];
    let mut faces = Vec::new();
    for axis in 0..3 {
        for is_high in [false, true] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let [columns, rows] = [0; 2].map(|_| 1 + random.below(5));
            let at = |column: u32, row: u32| {
                let mut point = [0.0; 3];
                point[axis] = if is_high { sizes[axis] } else { 0.0 };
                point[u] = sizes[u] * f64::from(column) / f64::from(columns);
                point[v] = sizes[v] * f64::from(row) / f64::from(rows);
                place(Vector::from(point))
            };
            let vertices =
                (0..=rows).flat_map(|row| (0..=columns).map(move |column| at(column, row)));
            let squares = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
            let triangles = squares.flat_map(|(row, column)| {
                let a = row * (columns + 1) + column;
                let [b, c, d] = [a + 1, a + columns + 1, a + columns + 2];
                if is_high { [[a, b, d], [a, d, c]] } else { [[a, d, b], [a, c, d]] }
            });
            faces.push((vertices.collect(), triangles.collect()));
        }
    }
    faces
}

/// T-vertices are no opening; a face that is missing is one, and a face that is turned is found.
#[test]
fn grids_of_different_fineness_close_a_box() {
    let joined = |faces: &[Mesh]| {
        let mut mesh = Mesh::default();
        for (vertices, triangles) in faces {
            let first = mesh.0.len() as u32;
            mesh.0.extend(vertices);
            mesh.1.extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        }
        mesh
    };
    let mut random = Random::new(101);
    for round in 0..rounds(200) {
        let scale = 2.0_f64.powi(random.below(600) as i32 - 300);
        let pose = if round == 0 { Pose::IDENTITY } else { random.pose(100.0) };
        let mut faces = patched_box(&mut random, &|point| (pose * point) * scale);
        let found = report(&joined(&faces));
        assert!(found.is_sound() && found.bounds_volume(), "{round}: {found:?}");
        let face = random.below(6) as usize;
        faces[face].1.iter_mut().for_each(|corners| corners.swap(0, 1));
        let found = report(&joined(&faces));
        assert!(found.openings.is_empty() && found.nonmanifold_edges == 0, "{round}: {found:?}");
        assert!(found.misoriented_edges >= 4, "{round}: {found:?}");
        let missing = faces.remove(face);
        let found = report(&joined(&faces));
        assert_eq!((found.openings.len(), found.misoriented_edges), (1, 0), "{round}: {found:?}");
        // The other faces come to its four sides.
        let Opening { edges, centre, .. } = found.openings[0];
        assert!(edges >= 4);
        let [low, high] = [missing.0[0], missing.0[missing.0.len() - 1]];
        let reach = (high - low).length();
        assert!((centre - (low + high) * 0.5).length() < 0.5 * reach, "{round}: {centre}");
    }
}

/// Edges, flipped faces and groups agree with counts by brute force, on soups of coincident
/// vertices with repeated, flipped and flat triangles.
#[test]
fn flaws_are_counted_as_by_hand() {
    let mut seen = [0; 4];
    for seed in 0..rounds(800_u32) {
        let random = &mut Random::new(seed.into());
        let (places, clean) = Ball::new(8.0).to_trimesh(8, 5);
        let mut vertices: Vec<_> = places.iter().map(|&place| on_grid(place)).collect();
        let count = vertices.len() as u32;
        // Copies of all vertices, at the same places.
        vertices.extend_from_within(..);
        let mut triangles: Vec<_> = clean
            .iter()
            .map(|triangle| triangle.map(|corner| corner + count * random.below(2)))
            .collect();
        let holes = random.below(4);
        triangles.retain(|_| holes == 0 || random.below(12) > 0);
        for _ in 0..random.below(3) {
            let k = random.below(triangles.len() as u32) as usize;
            match random.below(3) {
                0 => triangles[k].swap(0, 1),
                1 => triangles.push(triangles[k]),
                _ => triangles.push([triangles[k][0], triangles[k][1], triangles[k][0]]),
            }
        }
        let found = report(&(vertices.clone(), triangles.clone()));
        let key = |corner: u32| vertices[corner as usize].to_array().map(|x| (x + 0.0).to_bits());
        let mut edges: BTreeMap<_, Vec<bool>> = BTreeMap::new();
        for triangle in &triangles {
            let [a, b, c] = triangle.map(key);
            if a != b && b != c && c != a {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    edges.entry((from.min(to), from.max(to))).or_default().push(from < to);
                }
            }
        }
        let nonmanifold = edges.values().filter(|faces| faces.len() > 2).count();
        let misoriented =
            edges.values().filter(|faces| faces.len() == 2 && faces[0] == faces[1]).count();
        let boundary: Vec<_> =
            edges.iter().filter(|(_, faces)| faces.len() == 1).map(|(ends, _)| *ends).collect();
        // Groups: every corner takes the least name among its edges until nothing changes.
        let mut names: BTreeMap<_, _> = BTreeMap::new();
        boundary.iter().for_each(|&(a, b)| names.extend([(a, a), (b, b)]));
        while boundary.iter().any(|(a, b)| {
            let least = names[a].min(names[b]);
            let changes = names[a] != names[b];
            names.insert(*a, least);
            names.insert(*b, least);
            changes
        }) {}
        // An edge alone is as narrow as a seam. It is left where its other end has too many faces.
        let mut groups: BTreeMap<_, usize> = BTreeMap::new();
        boundary.iter().for_each(|(a, _)| *groups.entry(names[a]).or_default() += 1);
        groups.retain(|_, edges| *edges > 1);
        assert_eq!(found.nonmanifold_edges, nonmanifold, "{seed}");
        assert_eq!(found.misoriented_edges, misoriented, "{seed}");
        assert_eq!(found.openings.len(), groups.len(), "{seed}");
        let of_openings: usize = found.openings.iter().map(|opening| opening.edges).sum();
        assert_eq!(of_openings, groups.values().sum::<usize>(), "{seed}");
        assert!(found.openings.is_sorted_by(|one, other| one.width >= other.width));
        assert_eq!(found.is_sound(), found.doubts().is_empty());
        for (seen, count) in
            seen.iter_mut().zip([nonmanifold, misoriented, groups.len(), groups.len() / 2])
        {
            *seen += u32::from(count > 0);
        }
    }
    assert!(seen.iter().all(|&count| count > rounds(100)), "{seen:?}");
}

/// A robot that leaves through the cut end of a vessel touches nothing. Its base is inside.
#[test]
fn a_robot_that_leaves_through_an_opening_is_not_inside() {
    let (mesh, _) = vessel(10.0, 60.0, 48);
    let mut search = search(&mesh);
    let mut ask = |points: &[[f64; 3]], radius: f64| {
        let points: Vec<_> = points.iter().map(|&point| Vector::from(point)).collect();
        let robot = Chain::with_constant_radius(&points, radius).unwrap();
        search.clears_inside(&robot, &Pose::IDENTITY, 2.0).unwrap()
    };
    let within = ask(&[[0.0, 0.0, 20.0], [1.0, 0.0, 30.0], [0.0, 0.0, 40.0]], 1.0);
    assert!(within.holds() && !within.crosses_opening && within.tip == Side::Inside);
    let out = ask(&[[0.0, 0.0, 30.0], [0.0, 0.0, 80.0], [0.0, 0.0, 130.0]], 1.0);
    assert!(out.clears && out.crosses_opening && !out.holds(), "{out:?}");
    assert_eq!([out.base, out.tip], [Side::Inside, Side::Outside]);
    // Out through one end and in through the other: base and tip are inside.
    let around = ask(
        &[
            [0.0, 0.0, 30.0],
            [0.0, 0.0, 90.0],
            [40.0, 0.0, 90.0],
            [40.0, 0.0, -30.0],
            [0.0, 0.0, -30.0],
            [0.0, 0.0, 25.0],
        ],
        1.0,
    );
    assert_eq!([around.base, around.tip], [Side::Inside; 2]);
    assert!(around.clears && around.crosses_opening && !around.holds(), "{around:?}");
    // The axis stays within the vessel, and a link's flank bulges out of it.
    let bulging = ask(&[[0.0, 0.0, 30.0], [-4.0, 0.0, 55.0], [4.0, 0.0, 58.0]], 3.0);
    assert!(bulging.clears && bulging.crosses_opening && !bulging.holds(), "{bulging:?}");
    // Outside, beside it.
    let beside = ask(&[[40.0, 0.0, 30.0], [40.0, 0.0, 90.0]], 1.0);
    assert!(beside.clears && !beside.holds() && !beside.crosses_opening);
}

/// The side of a link agrees with its sides of the vessel whose ends are closed by the same lids.
#[test]
fn the_sides_of_links_are_those_behind_lids() {
    let (mesh, lids) = vessel(10.0, 60.0, 24);
    let (mut open, mut closed) =
        (search(&mesh), search(&(mesh.0.clone(), [&mesh.1[..], &lids].concat())));
    let mut random = Random::new(79);
    let mut seen = BTreeMap::new();
    let (mut sides, mut links) = (Vec::new(), Vec::new());
    for round in 0..rounds(1200) {
        // Along the axis, across a lid, or anywhere; every fourth on the axis itself.
        let spread = if round % 4 == 0 { 0.0 } else { 6.0 };
        // Short robots near an opening.
        let (first, size) = match round % 3 {
            0 => (60.0 * random.unit().round() + random.between(-5.0, 5.0), 0.1),
            _ => (random.between(-20.0, 80.0), 1.0),
        };
        let mut point = Vector::new(0.0, 0.0, first);
        point += Vector::new(random.unit() - 0.5, random.unit() - 0.5, 0.0) * spread;
        let points: Vec<_> = (0..5)
            .map(|_| {
                let step = Vector::Z * random.between(-9.0, 18.0);
                point += (step + random.point() * Vector::new(1.0, 1.0, 0.0) * spread) * size;
                point
            })
            .collect();
        let robot = Chain::with_constant_radius(&points, random.between(0.0, 2.0)).unwrap();
        let pose = Pose::IDENTITY;
        open.link_sides(&robot, &pose, &mut sides).unwrap();
        closed.per_link(&robot, &pose, &mut links).unwrap();
        let answer = open.clears_inside(&robot, &pose, 0.0).unwrap();
        assert_eq!(answer.base, open.side(points[0]));
        for (link, (side, found)) in robot.links().iter().zip(sides.iter().zip(&links)) {
            if found.distance == 0.0 {
                assert_eq!(*side, Side::Undecided, "{round}");
                *seen.entry("touches").or_insert(0) += 1;
                continue;
            }
            let truth = closed.side(link.start().lerp(link.end(), 0.5));
            let ends = [link.start(), link.end()].map(|end| open.side(end));
            if *side != Side::Undecided {
                assert_eq!(*side, truth, "{round}: {link:?}");
                *seen
                    .entry(if truth == Side::Inside { "inside" } else { "outside" })
                    .or_insert(0) += 1;
            } else {
                // Too near the opening for any end to be decided.
                assert_eq!(ends, [Side::Undecided; 2], "{round}");
                *seen.entry("undecided").or_insert(0) += 1;
            }
        }
        let is_within = sides.iter().all(|side| *side == Side::Inside);
        assert!(!answer.holds() || is_within, "{round}");
    }
    assert!(seen.len() == 4 && seen.values().all(|&count| count > rounds(40)), "{seen:?}");
}

/// An opening that closes takes its lid along: no later query begins at a triangle of it.
#[test]
fn an_opening_may_close() {
    let (mesh, _) = vessel(2.0, 10.0, 64);
    let through = |z: f64| {
        Chain::with_constant_radius(&[Vector::Z * (z - 1.0), Vector::Z * (z + 1.0)], 0.1).unwrap()
    };
    for [closing, open] in [[0.0, 10.0], [10.0, 0.0]] {
        let mut search = search(&mesh);
        let crosses_opening = |search: &mut BvhSearch, z: f64| {
            search.clears_inside(&through(z), &Pose::IDENTITY, 0.0).unwrap().crosses_opening
        };
        assert!(crosses_opening(&mut search, closing));
        let close =
            |&vertex: &Vector| if vertex.z == closing { Vector::Z * closing } else { vertex };
        search.set_vertices(&mesh.0.iter().map(close).collect::<Vec<_>>()).unwrap();
        assert_eq!(search.surface().openings.len(), 1);
        assert!(crosses_opening(&mut search, open) && !crosses_opening(&mut search, closing));
    }
}

/// A vessel that moves opens and closes nothing; its openings move with it.
#[test]
fn openings_follow_the_vertices() {
    let mesh = lumen::mesh(12);
    let (vertices, indices) = (mesh.vertices().to_vec(), mesh.indices().to_vec());
    let mut moved =
        BvhSearch::new(&TriMesh::new(vertices.clone(), indices.clone()).unwrap()).unwrap();
    let before = moved.surface().clone();
    let pose = Pose::from_parts(Vector::new(5.0, -80.0, 3.0), Rot3::IDENTITY);
    let there: Vec<_> = vertices.iter().map(|&vertex| pose * vertex * 2.0).collect();
    moved.set_vertices(&there).unwrap();
    assert_eq!(*moved.surface(), report(&(there, indices)));
    assert!(before.openings.len() == 2 && moved.surface().openings.len() == 2);
    assert!(moved.surface().openings[0].width > 1.9 * before.openings[0].width);
}
