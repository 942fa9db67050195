//! The scene of the examples: a closed ventricle with a robot that fits, a start and a goal in any
//! other mesh, and pictures that show the caps of the queries.

use continuum_demo::canvas::Canvas;
use continuum_demo::colour_map::ColourMap;
use continuum_demo::ctr::three_tubes;
use continuum_demo::picture::{Camera, Picture, Solid};
use continuum_demo::surface::Mesh;
use continuum_demo::{lettering, remesh, steer, surface, ventricle};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{Ray, RayCast};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum::{Chain, ModifiedCylinder};
use std::collections::{BTreeMap, BTreeSet};

/// Asserts that a mesh is one closed surface: every edge has exactly two triangles, which run along
/// it in opposite directions, those around a vertex form one ring, and Euler's characteristic is as
/// given: 2 for a surface without handles, 0 for a ring.
fn assert_closed(points: &[Vector], triangles: &[[u32; 3]], euler: i64) {
    let mut edges = BTreeSet::new();
    let mut next = vec![BTreeMap::new(); points.len()];
    for &[a, b, c] in triangles {
        for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert!(edges.insert((a, b)), "two triangles run from {a} to {b}");
            next[a as usize].insert(b, c);
        }
    }
    assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))), "an edge has one triangle");
    for ring in &next {
        let (&first, _) = ring.first_key_value().expect("a vertex without a triangle");
        let (mut at, mut count) = (ring[&first], 1);
        while at != first {
            (at, count) = (ring[&at], count + 1);
        }
        assert_eq!(count, ring.len(), "the triangles around a vertex form more than one ring");
    }
    let mut reached = vec![false; points.len()];
    let mut stack = vec![0];
    while let Some(at) = stack.pop() {
        if !std::mem::replace(&mut reached[at as usize], true) {
            stack.extend(next[at as usize].keys());
        }
    }
    assert!(reached.iter().all(|&is| is), "more than one part");
    let (v, e, f) = (points.len() as i64, edges.len() as i64 / 2, triangles.len() as i64);
    assert_eq!(v - e + f, euler);
}

fn volume((points, triangles): &Mesh) -> Real {
    let corner = |t: &[u32; 3]| t.map(|i| points[i as usize]);
    triangles.iter().map(corner).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

fn smallest_angle([a, b, c]: [Vector; 3]) -> Real {
    [(b - a).angle_between(c - a), (c - b).angle_between(a - b), (a - c).angle_between(b - c)]
        .into_iter()
        .fold(Real::INFINITY, Real::min)
        .to_degrees()
}

#[test]
fn ventricle_is_closed_oriented_and_of_well_shaped_triangles_at_any_size() {
    let field = ventricle::Ventricle::grow();
    for wanted in [ventricle::DEFAULT_TRIANGLES, 50_000] {
        let mesh = ventricle::mesh(wanted);
        let (points, triangles) = &mesh;
        assert!(
            triangles.len().abs_diff(wanted) <= wanted / 1000,
            "{} of {wanted}",
            triangles.len()
        );
        assert_closed(points, triangles, 2);
        // Outward normals make the volume positive; an adult's ventricles hold 20 to 50 ml.
        assert!((20e3..50e3).contains(&volume(&mesh)), "{} ml", volume(&mesh) / 1e3);
        let low = points.iter().copied().reduce(Vector::min).unwrap();
        let size = points.iter().copied().reduce(Vector::max).unwrap() - low;
        assert!((size - Vector::new(80.0, 90.0, 90.0)).abs().max_element() < 12.0, "{size} mm");
        assert!(points.iter().all(|&p| field.value(p).abs() < 1e-3));

        let mut angles: Vec<_> =
            triangles.iter().map(|t| smallest_angle(t.map(|i| points[i as usize]))).collect();
        angles.sort_by(Real::total_cmp);
        assert!(
            angles[0] > 15.0 && angles[angles.len() / 2] > 45.0,
            "{} {}",
            angles[0],
            angles[angles.len() / 2]
        );
    }
}

#[test]
fn coarsening_stops_before_it_closes_a_ring() {
    // So thin that the last collapses allowed by shape alone would pinch it.
    let ring = |p: Vector| (p.x.hypot(p.y) - 5.0).hypot(p.z) - 1.0;
    let fine = surface::extract(&ring, Vector::splat(-7.0), Vector::splat(7.0), 0.35);
    assert_closed(&fine.0, &fine.1, 0);
    for target in [1000, 300, 100, 0] {
        let (points, triangles) = remesh::remesh(&ring, fine.clone(), target, 1e-4);
        assert_closed(&points, &triangles, 0);
        assert!(
            triangles.len() >= target && triangles.len() < target.max(100) + 100,
            "{}",
            triangles.len()
        );
    }
}

#[test]
fn default_robot_starts_inside_a_burr_hole_and_keeps_clear_all_the_way() {
    let (points, triangles) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    let mesh = TriMesh::new(points, triangles).unwrap();
    let (base, robot, goal) = (ventricle::entry(), three_tubes(), ventricle::goal());
    assert!(steer::is_inside(&mesh, base.translation));
    let back = Ray::new(base.translation, base.rotation * -Vector::Z);
    let depth = mesh.cast_local_ray(&back, 100.0, false).unwrap();
    assert!((depth - 3.0).abs() < 0.2, "the base is {depth} mm from the roof");

    let mut search = BvhSearch::new(&mesh).unwrap();
    let whole: Vec<Real> = (0..=40).map(|k| robot.length(&goal) * Real::from(k) / 40.0).collect();
    let shape = robot.frames(&goal, &whole);
    for step in 1..=40 {
        let joints = robot.on_the_way(&goal, Real::from(step) / 40.0);
        let out = &whole[..=step as usize];
        assert!((robot.length(&joints) - out[out.len() - 1]).abs() < 1e-12);
        for (frame, settled) in robot.frames(&joints, out).iter().zip(&shape) {
            // The wire's nominal curvature of 1e-9 / mm is all that differs.
            assert!((frame.translation - settled.translation).length() < 1e-6);
        }
        let line = robot.centreline(&joints, 30);
        let chain = Chain::from_centreline(&line.points, &line.radii).unwrap();
        let clearance = search.minimum(&chain, &base).unwrap().distance;
        assert!(clearance > 1.0, "{clearance} mm at step {step}");
    }
    let tip = base * shape[40].translation;
    assert!(
        (tip - Vector::new(0.0, -15.0, -5.0)).length() < 2.0,
        "{tip} is not the mouth of the aqueduct"
    );
}

/// A ball of about the given radius: an octahedron, cut finer three times.
fn ball(radius: Real) -> TriMesh {
    let field = |p: Vector| p.length() - radius;
    let axes = [Vector::X, Vector::Y, Vector::Z];
    let points = axes.iter().flat_map(|&axis| [axis * radius, -axis * radius]).collect();
    let octants = (0..8u32).map(|k| {
        let [x, y, z] = [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)];
        if k.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] }
    });
    let mut mesh: Mesh = (points, octants.collect());
    for _ in 0..3 {
        mesh = surface::subdivide(&field, mesh, 1e-6 * radius);
    }
    assert_closed(&mesh.0, &mesh.1, 2);
    assert!(volume(&mesh) > 0.0);
    TriMesh::new(mesh.0, mesh.1).unwrap()
}

#[test]
fn a_start_and_a_goal_are_found_in_an_unknown_mesh() {
    let room = ball(60.0);
    let start = steer::deepest_point(&room).unwrap();
    assert!(start.length() < 3.0, "{start}");
    assert!(steer::is_inside(&room, start) && !steer::is_inside(&room, Vector::X * 61.0));
    assert!(steer::clear_direction(&room, Vector::X * 50.0).dot(-Vector::X) > 0.97);

    // There is room for the longest shape whose way in is exact: the second section and the third.
    let robot = three_tubes();
    let mut search = BvhSearch::new(&room).unwrap();
    let base = Pose::from_translation(start);
    let goal = steer::find_goal(&robot, &mut search, &base).unwrap();
    let line = robot.centreline(&goal, 30);
    let chain = Chain::capsules(&line.points, &line.radii).unwrap();
    let clearance = search.minimum(&chain, &base).unwrap().distance;
    assert!(clearance > 0.5 && robot.length(&goal) > 76.0, "{clearance} {}", robot.length(&goal));
    assert!(goal.extensions[0] + goal.extensions[1] <= 66.7 + 1e-12);

    let mut cramped = BvhSearch::new(&ball(2.0)).unwrap();
    assert!(matches!(
        steer::find_goal(&robot, &mut cramped, &Pose::IDENTITY),
        Err(steer::NoGoal::NoRoom)
    ));
    let sheet = TriMesh::new(vec![Vector::ZERO, Vector::X, Vector::Y], vec![[0, 1, 2]]).unwrap();
    assert_eq!(steer::deepest_point(&sheet), None);
    // Below a ball, the sheet makes the number of crossings odd: no telling what is inside.
    let (mut points, mut triangles) = (room.vertices().to_vec(), room.indices().to_vec());
    let last = points.len() as u32;
    points.extend(
        [[-500.0, -300.0], [500.0, -300.0], [0.0, 800.0]].map(|[x, y]| Vector::new(x, y, -400.0)),
    );
    triangles.push([last, last + 1, last + 2]);
    let deepest = steer::deepest_point(&TriMesh::new(points, triangles).unwrap());
    assert!(deepest.is_none_or(|p| p.length() < 60.0), "{deepest:?}");
}

/// How much of a picture differs from its first pixel.
fn covered(canvas: &Canvas) -> Real {
    let backdrop = canvas.pixels[0];
    canvas.pixels.iter().filter(|&&pixel| pixel != backdrop).count() as Real
}

#[test]
fn pictures_show_caps_as_they_are_queried() {
    let (start, end, radius) = (Vector::ZERO, Vector::X * 4.0, 1.0);
    let seen = |link: ModifiedCylinder| {
        let solid = Solid::new(SharedShape::new(link), Pose::IDENTITY, [0.2, 0.3, 0.4], false);
        let mut picture = Picture::new(None, vec![solid]);
        picture.sky = [[1.0; 3]; 2];
        // From far away the outline is that of a parallel projection.
        let far = Vector::new(2.0, 0.0, 4000.0);
        let camera = Camera {
            eye: far,
            forward: -Vector::Z,
            up: Vector::Y,
            right: Vector::X,
            spread: 5.0 / 4000.0,
            cut: 0.0,
        };
        covered(&picture.render(&camera, 400, 400)) / 1600.0
    };
    let flat = seen(ModifiedCylinder::cylinder(start, end, radius).unwrap());
    let round = seen(ModifiedCylinder::capsule(start, end, radius).unwrap());
    // 40 pixels to a unit: an outline pixel is a fortieth of a unit wide.
    assert!((flat - 8.0).abs() < 0.3, "{flat}");
    assert!((round - flat - std::f64::consts::PI).abs() < 0.2, "{}", round - flat);
}

#[test]
fn every_letter_can_be_drawn_and_every_scale_has_numbers() {
    for letter in ('a'..='z').chain('A'..='Z').chain('0'..='9').chain(".,:;'_-+=<>/()%*".chars()) {
        let (strokes, width) = lettering::strokes(&letter.to_string(), 7.0);
        assert!(
            !strokes.is_empty() && strokes.iter().all(|s| s.len() > 1) && width < 8.0,
            "{letter}"
        );
    }
    for largest in [1e-6, 0.03, 0.99, 1.0, 3.9, 4.1, 77.0, 12345.0] {
        let map = ColourMap::up_to(largest);
        assert!((1.0 - 1e-9..1.5).contains(&(map.end / largest)), "{} for {largest}", map.end);
    }
}
