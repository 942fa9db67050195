//! Very many triangles around one corner or edge, as exported meshes have them: the work grows with
//! their number, and not with its square.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};
use std::f64::consts::{PI, TAU};
use std::time::{Duration, Instant};

const FEW: u32 = 1_000;
const MANY: u32 = 16_000;
const RADIUS: Real = 0.1;

/// Queries of the mesh of few triangles, to take about as long as one query of the mesh of many:
/// other load then slows both alike.
const TIMES: u32 = MANY / FEW;

/// How long an engine takes: see [`time`].
type Timed = fn(u32, &TriMesh, [Vector; 2], (Real, Vector)) -> Duration;

/// Builds an engine and queries the contacts of a capsule, exactly one, this many times.
fn time<E: Proximity>(
    times: u32,
    mesh: &TriMesh,
    axis: [Vector; 2],
    expected: (Real, Vector),
    engine: impl Fn(&TriMesh) -> E,
) -> Duration {
    let robot = Chain::capsules(&axis, &[RADIUS]).unwrap();
    let mut out = Vec::new();
    let start = Instant::now();
    for _ in 0..times {
        engine(mesh).contacts_within(&robot, &Pose::IDENTITY, 3.0, 0.0, &mut out).unwrap();
    }
    let time = start.elapsed();
    assert_eq!(out.len(), 1);
    let (distance, on_mesh) = expected;
    let near = |one: Real, other: Real| (one - other).abs() <= 64.0 * Real::EPSILON;
    assert!(near(out[0].distance, distance), "{} {distance}", out[0].distance);
    assert!(near(out[0].witness.on_mesh.z, on_mesh.z) && near(out[0].witness.on_mesh.y, on_mesh.y));
    time
}

/// With 16 times the triangles one query takes less than 4 times as long as 16 queries: about as
/// long if no triangle visits all others, and 16 times as long if each does.
fn grows_slowly(mesh: impl Fn(u32) -> TriMesh, axis: [Vector; 2], expected: (Real, Vector)) {
    let meshes = [(TIMES, mesh(FEW)), (1, mesh(MANY))];
    let engines: [Timed; 2] = [
        |times, mesh, axis, expected| {
            time(times, mesh, axis, expected, |mesh| BvhSearch::new(mesh).unwrap())
        },
        |times, mesh, axis, expected| {
            time(times, mesh, axis, expected, |mesh| Exhaustive::<f32>::new(mesh).unwrap())
        },
    ];
    for time in engines {
        let [mut few, mut many] = [Duration::MAX; 2];
        // More often where the machine has much else to do.
        for round in 0..30 {
            if round >= 3 && many < 4 * few {
                break;
            }
            for (best, (times, mesh)) in [&mut few, &mut many].into_iter().zip(&meshes) {
                *best = (*best).min(time(*times, mesh, axis, expected));
            }
        }
        assert!(
            many < 4 * few,
            "{TIMES} times {FEW} triangles: {few:?}, {MANY} triangles: {many:?}"
        );
    }
}

fn mesh(vertices: Vec<Vector>, triangles: impl Iterator<Item = [u32; 3]>) -> TriMesh {
    TriMesh::new(vertices, triangles.collect()).unwrap()
}

/// A disc around the origin.
#[test]
fn a_fan_of_very_many_triangles_is_asked_in_time() {
    let fan = |count: u32| {
        let around = |k: u32| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
            Vector::new(2.0 * cos, 2.0 * sin, 0.0)
        };
        let vertices = std::iter::once(Vector::ZERO).chain((0..count).map(around)).collect();
        mesh(vertices, (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]))
    };
    let over_the_centre = [Vector::new(0.0, 0.0, 0.5), Vector::new(0.0, 0.0, 1.5)];
    grows_slowly(fan, over_the_centre, (0.4, Vector::ZERO));
}

/// Triangles that hang from an edge like the pages of a book.
#[test]
fn very_many_triangles_at_an_edge_are_asked_in_time() {
    let book = |count: u32| {
        let page = |k: u32| {
            let (sin, cos) = (PI * f64::from(k) / f64::from(count)).sin_cos();
            Vector::new(0.5, cos, -sin)
        };
        let vertices = [Vector::ZERO, Vector::X].into_iter().chain((0..count).map(page)).collect();
        mesh(vertices, (0..count).map(|k| [0, 1, 2 + k]))
    };
    let over_the_edge = [Vector::new(-0.5, 0.0, 0.7), Vector::new(1.5, 0.0, 0.7)];
    grows_slowly(book, over_the_edge, (0.6, Vector::ZERO));
}

/// Exporters put invalid vertices there.
#[test]
fn very_many_triangles_without_extent_at_the_origin_are_asked_in_time() {
    let points = |count: u32| {
        mesh(vec![Vector::ZERO; count as usize + 2], (0..count).map(|k| [k, k + 1, k + 2]))
    };
    let away = [Vector::new(0.0, 0.3, 0.4), Vector::new(0.0, 0.6, 0.8)];
    grows_slowly(points, away, (0.4, Vector::ZERO));
}

/// By the same vertices, and each with vertices of its own.
#[test]
fn very_many_identical_triangles_are_asked_in_time() {
    let corners = [Vector::ZERO, Vector::X, Vector::Y];
    let over_an_edge = [Vector::new(-0.5, 0.0, 0.7), Vector::new(1.5, 0.0, 0.7)];
    let same = |count: u32| mesh(corners.to_vec(), (0..count).map(|_| [0, 1, 2]));
    grows_slowly(same, over_an_edge, (0.6, Vector::ZERO));
    let own = |count: u32| {
        let vertices = (0..count).flat_map(|_| corners).collect();
        mesh(vertices, (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]))
    };
    grows_slowly(own, over_an_edge, (0.6, Vector::ZERO));
}
