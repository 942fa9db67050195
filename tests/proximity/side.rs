//! Inside or outside: never wrong on closed meshes, undecided near holes, the same for all ways to
//! give a mesh.

use crate::parity::{Parity, on_grid};
use continuum_demo::field::{Body, Tube, round};
use continuum_demo::remesh::remesh;
use continuum_demo::surface::extract;
use continuum_demo::{cavity, ctr, lumen, subdivide, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, Cuboid, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity, Side};
use std::f64::consts::{PI, TAU};

type Mesh = (Vec<Vector>, Vec<[u32; 3]>);

fn parts(mesh: TriMesh) -> Mesh {
    (mesh.vertices().to_vec(), mesh.indices().to_vec())
}

fn turned((vertices, mut indices): Mesh) -> Mesh {
    indices.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    (vertices, indices)
}

fn moved((vertices, indices): Mesh, scale: f64, offset: Vector) -> Mesh {
    (vertices.into_iter().map(|vertex| vertex * scale + offset).collect(), indices)
}

/// Both meshes in one.
fn together(mut one: Mesh, other: Mesh) -> Mesh {
    let first = one.0.len() as u32;
    one.0.extend(other.0);
    one.1.extend(other.1.into_iter().map(|triangle| triangle.map(|corner| first + corner)));
    one
}

fn torus() -> Mesh {
    let (around, across) = (48, 24);
    let vertex = |i: u32, j: u32| {
        let (long, short) =
            (f64::from(i) * TAU / f64::from(around), f64::from(j) * TAU / f64::from(across));
        let from_axis = 0.7 + 0.25 * short.cos();
        Vector::new(from_axis * long.cos(), from_axis * long.sin(), 0.25 * short.sin())
    };
    let vertices = (0..around).flat_map(|i| (0..across).map(move |j| vertex(i, j))).collect();
    let at = |i: u32, j: u32| i % around * across + j % across;
    let squares = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let indices = squares.flat_map(|(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (vertices, indices.collect())
}

/// A bent vessel with round ends, remeshed.
fn bent_lumen() -> Mesh {
    let knots = [[-0.8, 0.0, -0.3], [-0.3, 0.2, 0.3], [0.3, -0.2, 0.4], [0.8, 0.1, -0.4]];
    let tubes = vec![Tube::new(knots.map(|centre| round(centre, 0.15)).into())];
    let body = Body { tubes, blend: 0.1 };
    let field = |point: Vector| body.value(point);
    remesh(&field, extract(&field, Vector::splat(-1.1), Vector::splat(1.1), 0.05), 1500, 1e-5)
}

/// Closed meshes in a cube of half width 1, their vertices on the grid.
fn closed_meshes() -> Vec<(&'static str, TriMesh)> {
    let cuboid = |half: [f64; 3]| -> Mesh { Cuboid::new(Vector::from(half)).to_trimesh() };
    let ball = || Ball::new(0.8).to_trimesh(40, 20);
    let fine = subdivide::in_four(subdivide::in_four(cuboid([0.9, 0.5, 0.25])));
    let meshes = [
        ("box", cuboid([0.75, 0.5, 0.25])),
        ("box inside out, in small triangles", turned(subdivide::shuffled(fine, 3))),
        ("ball", ball()),
        ("torus", torus()),
        ("bumpy cavity", moved(parts(cavity::mesh(3)), 0.018, Vector::ZERO)),
        ("thick wall", together(ball(), turned(moved(ball(), 0.75, Vector::ZERO)))),
        ("boxes that overlap", together(cuboid([0.9, 0.3, 0.3]), cuboid([0.25, 0.7, 0.4]))),
        (
            "boxes that share an edge",
            together(
                moved(cuboid([0.5; 3]), 0.5, Vector::new(0.25, 0.25, 0.0)),
                moved(cuboid([0.5; 3]), 0.5, Vector::new(-0.25, -0.25, 0.0)),
            ),
        ),
        ("bent lumen", bent_lumen()),
        ("ventricle", moved(ventricle::mesh(6_000), 1.0 / 70.0, Vector::ZERO)),
    ];
    let build = |(name, (vertices, indices)): (_, Mesh)| {
        (name, TriMesh::new(vertices.into_iter().map(on_grid).collect(), indices).unwrap())
    };
    meshes.into_iter().map(build).collect()
}

/// A point from 1e-9 to 1 of a mesh's size from its wall, or anywhere near the mesh.
fn any_point(random: &mut Random, mesh: &TriMesh) -> Vector {
    if random.below(8) == 0 {
        return on_grid(random.point() * 1.2);
    }
    let triangle = mesh.triangle(random.below(mesh.indices().len() as u32));
    let (s, t) = (
        [0.0, 1e-6, random.unit()][random.below(3) as usize],
        [0.0, random.unit()][random.below(2) as usize],
    );
    let on_wall = triangle.a.lerp(triangle.b, s).lerp(triangle.c, t);
    on_grid(on_wall + random.direction() * 10.0_f64.powf(random.between(-9.0, 0.0)))
}

/// Asks about `count` points of each closed mesh and as many far away.
fn never_wrong(count: usize) {
    for (name, mesh) in closed_meshes() {
        let (search, parity) = (BvhSearch::new(&mesh).unwrap(), Parity::new(&mesh));
        let mut random = Random::new(47);
        let (mut inside, mut outside, mut near, mut untold) = (0, 0, 0, 0);
        for _ in 0..count {
            let point = any_point(&mut random, &mesh);
            let Some(winding) = parity.winding(point) else {
                untold += 1;
                continue;
            };
            let truth = if winding == 0 { Side::Outside } else { Side::Inside };
            assert_eq!(search.side(point), truth, "{name}: {point:?}, winding number {winding}");
            *(if winding == 0 { &mut outside } else { &mut inside }) += 1;
            near += usize::from(mesh.distance_to_wall(point) < 1e-6);
        }
        for _ in 0..count / 10 {
            let point = random.direction() * 10.0_f64.powf(random.between(1.0, 150.0));
            assert_eq!(search.side(point), Side::Outside, "{name}: {point}");
        }
        assert!(
            inside > count / 5 && outside > count / 5 && near > count / 8,
            "{name}: {inside} {outside} {near}"
        );
        assert!(untold < count / 100, "{name}: {untold}");
    }
}

trait Wall {
    fn distance_to_wall(&self, point: Vector) -> f64;
}

impl Wall for TriMesh {
    fn distance_to_wall(&self, point: Vector) -> f64 {
        use parry_continuum::parry::query::PointQuery;
        self.project_local_point(point, false).point.distance(point)
    }
}

#[test]
fn a_closed_mesh_is_never_mistaken() {
    never_wrong(rounds(1000));
}

/// A million points: `cargo test --release --test proximity -- side::a_million --ignored`
#[test]
#[ignore = "a minute in release"]
fn a_million_points_are_never_mistaken() {
    never_wrong(100_000);
}

/// The winding number by all triangles, in plain double precision.
fn winding(mesh: &TriMesh, point: Vector) -> f64 {
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] =
            triangle.map(|corner| (mesh.vertices()[corner as usize] - point).normalize());
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    mesh.indices().iter().map(angle).sum::<f64>() / (4.0 * PI)
}

/// What an open mesh has to answer, by its winding number; nothing where rounding may decide.
fn by_winding(winding: f64) -> Option<Side> {
    let size = winding.abs();
    if (size - 0.25).abs() < 1e-3 || (size - 0.75).abs() < 1e-3 {
        None
    } else if size > 0.75 {
        Some(Side::Inside)
    } else {
        Some(if size < 0.25 { Side::Outside } else { Side::Undecided })
    }
}

/// A vessel open at both ends has the same sides as with flat lids, where they are decided.
#[test]
fn an_opening_leaves_doubt_where_it_fills_the_view() {
    let open = lumen::mesh(24);
    let (mut vertices, mut indices) = parts(open.clone());
    for (first, step) in [(0, 1), (vertices.len() as u32 - 24, 23)] {
        let middle = vertices.len() as u32;
        let rim = first as usize..first as usize + 24;
        vertices.push(vertices[rim].iter().copied().sum::<Vector>() / 24.0);
        indices.extend((0..24).map(|k| [first + (k + step) % 24, first + k, middle]));
    }
    let closed = TriMesh::new(vertices, indices).unwrap();
    let (open_search, closed_search) =
        (BvhSearch::new(&open).unwrap(), BvhSearch::new(&closed).unwrap());
    let mut random = Random::new(53);
    let bounds = open.local_aabb();
    let mut seen = [0; 3];
    for _ in 0..rounds(6_000) {
        let point = if random.below(2) == 0 {
            bounds.center() + random.point() * bounds.half_extents() * 1.3
        } else {
            lumen::entry() * (random.point() * Vector::new(9.0, 9.0, 16.0))
        };
        let found = open_search.side(point);
        let truth = closed_search.side(point);
        assert!(found == truth || found == Side::Undecided, "{point}: {found:?}, closed {truth:?}");
        if let Some(expected) = by_winding(winding(&open, point)) {
            assert_eq!(found, expected, "{point}");
        }
        seen[found as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > rounds(200)), "{seen:?}");
}

/// Triangles that are missing or there twice cast doubt on their surroundings, and mislead nowhere.
#[test]
fn flaws_of_a_wall_mislead_nowhere() {
    let (vertices, clean) = ventricle::mesh(6_000);
    let truth = BvhSearch::new(&TriMesh::new(vertices.clone(), clean.clone()).unwrap()).unwrap();
    let mut random = Random::new(59);
    let mut flawed = clean.clone();
    flawed.retain(|_| random.below(50) > 0);
    flawed.extend(clean.iter().filter(|_| random.below(50) == 0));
    let mesh = TriMesh::new(vertices, flawed).unwrap();
    let search = BvhSearch::new(&mesh).unwrap();
    let mut seen = [0; 3];
    for _ in 0..rounds(2000) {
        let triangle = mesh.triangle(random.below(mesh.indices().len() as u32));
        let point =
            triangle.center() + random.direction() * 10.0_f64.powf(random.between(-2.0, 1.0));
        let (found, clean) = (search.side(point), truth.side(point));
        assert!(found == clean || found == Side::Undecided, "{point}: {found:?}, clean {clean:?}");
        if let Some(expected) = by_winding(winding(&mesh, point)) {
            assert_eq!(found, expected, "{point}");
        }
        seen[found as usize] += 1;
    }
    assert!(seen[0] > rounds(400) && seen[1] > rounds(400) && seen[2] > rounds(20), "{seen:?}");
}

/// The unit, the distance of the mesh from the origin and a triangle far out do not matter.
#[test]
fn any_unit_serves() {
    let mut random = Random::new(61);
    let plain = torus();
    let points: Vec<_> = (0..300).map(|_| random.point()).collect();
    let answers = |scale: f64| {
        let mesh = moved(plain.clone(), scale, Vector::ZERO);
        let search = BvhSearch::new(&TriMesh::new(mesh.0, mesh.1).unwrap()).unwrap();
        points.iter().map(|&point| search.side(point * scale)).collect::<Vec<_>>()
    };
    let expected = answers(1.0);
    assert!(expected.contains(&Side::Inside) && !expected.contains(&Side::Undecided));
    for power in [-300, -100, 100, 300] {
        assert_eq!(answers(2.0_f64.powi(power)), expected, "{power}");
    }
    let offset = Vector::new(3e5, -1e6, 2e5);
    let (vertices, indices) = moved(plain.clone(), 1.0, offset);
    let search = BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap();
    let far_off: Vec<_> = points.iter().map(|&point| search.side(point + offset)).collect();
    assert_eq!(far_off, expected);

    let speck = Cuboid::new(Vector::splat(1e-9)).to_trimesh();
    let (vertices, indices) = together(plain, moved(speck, 1.0, Vector::splat(1e12)));
    let search = BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap();
    let beside: Vec<_> = points.iter().map(|&point| search.side(point)).collect();
    assert_eq!(beside, expected);
    assert_eq!(search.side(Vector::NAN), Side::Undecided);
    assert_eq!(search.side(Vector::INFINITY), Side::Undecided);
    assert_eq!(search.side(Vector::splat(f64::MAX)), Side::Outside);
}

/// A clone shares the prepared structures, and each engine keeps its own vertices.
#[test]
fn the_side_follows_the_vertices() {
    let (vertices, indices) = torus();
    let mut search = BvhSearch::new(&TriMesh::new(vertices.clone(), indices).unwrap()).unwrap();
    let (in_ring, in_hole) = (Vector::X * 0.7, Vector::ZERO);
    assert_eq!([search.side(in_ring), search.side(in_hole)], [Side::Inside, Side::Outside]);
    let kept = search.clone();
    let aside: Vec<_> = vertices.iter().map(|&vertex| vertex + Vector::X * 0.7).collect();
    search.set_vertices(&aside).unwrap();
    assert_eq!([search.side(in_ring), search.side(in_hole)], [Side::Outside, Side::Inside]);
    assert_eq!([kept.side(in_ring), kept.side(in_hole)], [Side::Inside, Side::Outside]);
}

#[test]
fn a_robot_beside_the_anatomy_is_not_inside() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mut search = BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 30);
    let robot = Chain::from_centreline(&line.points, &line.radii).unwrap();
    let mut ask = |pose: &Pose, margin| {
        let answer = search.clears_inside(&robot, pose, margin).unwrap();
        assert_eq!(answer.clears, search.clears(&robot, pose, margin).unwrap());
        assert_eq!(answer.holds(), answer.clears && answer.base == Side::Inside);
        (answer.base, answer.clears)
    };
    let inside = ventricle::entry();
    let beside = Pose::from_translation(Vector::Z * 100.0) * inside;
    assert_eq!(ask(&inside, 0.5), (Side::Inside, true));
    assert_eq!(ask(&inside, 5.0), (Side::Inside, false));
    assert_eq!(ask(&beside, 0.5), (Side::Outside, true));
    // Back out of the entry: the tip is inside, the base is not, and the wall is touched.
    let half_out = inside * Pose::from_translation(Vector::Z * -15.0);
    assert_eq!(ask(&half_out, 0.0), (Side::Outside, false));
    assert!(search.clears_inside(&robot, &inside, -1.0).is_err());
}
