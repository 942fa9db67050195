//! Casts of links that move straight against triangles and other convex shapes: never late, and
//! early by at most the documented amount.

use crate::draw::Draw;
use crate::scene::floor_mesh;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{QueryDispatcher, ShapeCastOptions, ShapeCastStatus};
use parry_continuum::parry::shape::{Shape, SharedShape, Triangle};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

/// What a hit may be early by, for shapes of size one: the share of the size at which a link
/// touches.
const EARLY: Real = 1e-8;
/// The same where contacts come from iterations.
const ITERATED: Real = 1e-5;

/// A link, a triangle, where it is, and a velocity that is often towards the link.
fn scene(random: &mut Random) -> (ModifiedCylinder, Triangle, Pose, Vector) {
    let triangle = Triangle::new(random.vector(2.0), random.vector(2.0), random.vector(2.0));
    let pose = random.pose(5.0);
    let link = random.link();
    let velocity = link.start() - pose * triangle.center() + random.vector(1.5);
    (link, triangle, pose, velocity)
}

/// A hit is early by at most `early`, and none is late. How many hits and misses there were.
fn stops_in_time(
    random: &mut Random,
    (link, wall): (&ModifiedCylinder, &dyn Shape),
    pose: Pose,
    velocity: Vector,
    early: Real,
) -> [usize; 2] {
    let ours = ContinuumDispatcher::default();
    let target_distance = [0.0, 0.0, random.between(0.0, 0.5)][random.index(3)];
    let options =
        ShapeCastOptions { target_distance, ..ShapeCastOptions::with_max_time_of_impact(1.5) };
    let back = -(pose.rotation.inverse() * velocity);
    let pairs: [(Pose, Vector, &dyn Shape, &dyn Shape); 2] =
        [(pose, velocity, link, wall), (pose.inverse(), back, wall, link)];
    let at = |time: Real| {
        let pose = Pose::from_translation(velocity * time) * pose;
        ours.distance(&pose, link, wall).unwrap().distance
    };
    let [mut hits, mut misses] = [0; 2];
    if at(0.0) <= target_distance {
        return [hits, misses];
    }
    let met =
        (1..=400).map(|k| 1.5 * Real::from(k) / 400.0).find(|&time| at(time) <= target_distance);
    for (pos12, velocity, g1, g2) in pairs {
        let context = || format!("{link:?} {:?} {pose:?} {velocity}", wall.as_typed_shape());
        let Some(hit) = ours.cast_shapes(&pos12, velocity, g1, g2, options).unwrap() else {
            misses += 1;
            assert_eq!(met, None, "{}", context());
            continue;
        };
        hits += 1;
        let time = hit.time_of_impact;
        assert_eq!(hit.status, ShapeCastStatus::Converged);
        assert!(met.is_none_or(|met| time <= met), "{hit:?}, met at {met:?}: {}", context());
        assert!((at(time) - target_distance).abs() < early, "{hit:?}: {}, {}", at(time), context());
        // Points that are as far apart, on either shape, along the normal.
        let (one, other) =
            (hit.witness1, Pose::from_translation(velocity * time) * pos12 * hit.witness2);
        assert!(((other - one).length() - target_distance).abs() < early, "{hit:?}: {}", context());
        assert!(
            ((other - one).dot(hit.normal1) - target_distance).abs() < early,
            "{hit:?}: {}",
            context()
        );
        assert!((pos12.rotation * hit.normal2 + hit.normal1).length() < 1e-9);
    }
    [hits, misses]
}

#[test]
fn straight_casts_stop_where_the_two_are_as_near_as_they_may() {
    let (mut random, mut counts) = (Random::new(151), [0; 2]);
    for _ in 0..rounds(3000) {
        let (link, triangle, pose, velocity) = scene(&mut random);
        let found = stops_in_time(&mut random, (&link, &triangle), pose, velocity, EARLY);
        counts = [0, 1].map(|k| counts[k] + found[k]);
    }
    let [hits, misses] = counts;
    assert!(hits > rounds(1500) && misses > rounds(500), "{hits} hits, {misses} misses");
}

/// A convex shape of about size 1.
fn convex(random: &mut Random) -> SharedShape {
    let mut size = || random.between(0.2, 0.8);
    let (a, b, c) = (size(), size(), size());
    match random.index(7) {
        0 => SharedShape::ball(a),
        1 => SharedShape::cuboid(a, b, c),
        2 => SharedShape::capsule_y(a, b),
        3 => SharedShape::cylinder(a, b),
        4 => SharedShape::cone(a, b),
        5 => SharedShape::round_cuboid(a, b, c, 0.1),
        _ => SharedShape::new(random.link()),
    }
}

/// The same with other convex shapes, whose distances come from parry's GJK.
#[test]
fn straight_casts_meet_convex_shapes_in_time() {
    let (mut random, mut counts) = (Random::new(155), [0; 2]);
    for _ in 0..rounds(2000) {
        let (link, wall, pose) = (random.link(), convex(&mut random), random.pose(5.0));
        let velocity = link.start() - pose.translation + random.vector(1.5);
        let found = stops_in_time(&mut random, (&link, &*wall), pose, velocity, ITERATED);
        counts = [0, 1].map(|k| counts[k] + found[k]);
    }
    let [hits, misses] = counts;
    assert!(hits > rounds(1000) && misses > rounds(300), "{hits} hits, {misses} misses");
}

#[test]
fn options_mean_what_they_mean_in_parry() {
    let (mut random, ours) = (Random::new(152), ContinuumDispatcher::default());
    let (mut held, mut freed, mut limited) = (0, 0, 0);
    for _ in 0..2000 {
        let (link, triangle, pose, velocity) = scene(&mut random);
        let cast = |pose: &Pose, velocity, options| {
            ours.cast_shapes(pose, velocity, &link, &triangle, options).unwrap()
        };
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        // As long as it takes, and not a moment less.
        if let Some(hit) = cast(&pose, velocity, options).filter(|hit| hit.time_of_impact > 0.0) {
            let limit =
                |share: Real| ShapeCastOptions::with_max_time_of_impact(hit.time_of_impact * share);
            assert_eq!(
                cast(&pose, velocity, limit(1.0)).map(|hit| hit.time_of_impact),
                Some(hit.time_of_impact)
            );
            assert!(cast(&pose, velocity, limit(0.999)).is_none());
            limited += 1;
        }
        // What overlaps at the start.
        let near =
            Pose::from_parts(pose.rotation * -triangle.center() + link.start(), pose.rotation);
        let Some(contact) = ours.contact(&near, &link, &triangle, 0.0).unwrap() else { continue };
        let through = ShapeCastOptions { stop_at_penetration: false, ..options };
        let stopped = cast(&near, velocity, options).unwrap();
        // As parry has it, what just touches is not within.
        let status = if contact.dist < 0.0 {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        assert_eq!((stopped.time_of_impact, stopped.status), (0.0, status));
        let parts = contact.normal1.dot(velocity) >= 0.0;
        assert_eq!(cast(&near, velocity, through).is_none(), parts, "{contact:?} {velocity}");
        held += usize::from(!parts);
        freed += usize::from(parts);
    }
    assert!(held > 200 && freed > 200 && limited > 200, "{held} {freed} {limited}");
}

/// Casts down on a large face, where GJK's error grows with the face.
#[test]
fn the_error_does_not_grow_with_the_triangle() {
    let (mut random, ours) = (Random::new(153), ContinuumDispatcher::default());
    for extent in [5.0, 50.0, 500.0, 5e5] {
        let [a, b, c] =
            [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, z]| Vector::new(x, 0.0, z) * extent);
        let triangle = Triangle::new(a, b, c);
        for _ in 0..200 {
            let link =
                ModifiedCylinder::capsule(random.vector(1.0), random.vector(1.0), 0.5).unwrap();
            let lowest = link.start().y.min(link.end().y) - 0.5;
            let height = random.between(3.0, 9.0);
            let place = Pose::from_translation(Vector::new(0.1, height, 0.2));
            let hit = ours
                .cast_shapes(
                    &place,
                    -2.0 * Vector::Y,
                    &triangle,
                    &link,
                    ShapeCastOptions::default(),
                )
                .unwrap()
                .unwrap();
            let expected = 0.5 * (height + lowest);
            assert!(
                (hit.time_of_impact - expected).abs() <= EARLY + 1e-14 * extent,
                "{extent}: {hit:?} {expected}"
            );
        }
    }
}

/// Objects at rest never meet, however near they are; objects that separate or slide past never
/// meet either.
#[test]
fn what_does_not_come_nearer_does_not_meet() {
    let ours = ContinuumDispatcher::default();
    let link = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X, 0.5).unwrap();
    let triangle = Triangle::new(
        Vector::new(-9.0, 0.0, -9.0),
        Vector::new(9.0, 0.0, -9.0),
        Vector::new(0.0, 0.0, 9.0),
    );
    for gap in [1e-300, 1e-13, 1e-12, 1e-6, 1e-3, 1.0] {
        let place = Pose::from_translation(Vector::Y * (0.5 + gap));
        for velocity in [Vector::ZERO, Vector::Y, Vector::X, 3.0 * Vector::Z] {
            for stop_at_penetration in [true, false] {
                let options = ShapeCastOptions { stop_at_penetration, ..Default::default() };
                let hit = ours.cast_shapes(&place, velocity, &triangle, &link, options).unwrap();
                // Nothing is left of the smallest gap.
                let is_hit = gap < 1e-200 && stop_at_penetration;
                assert_eq!(hit.is_some(), is_hit, "{gap} {velocity} {hit:?}");
            }
        }
    }
}

/// Against a mesh: the first triangle that a cast against each alone meets.
#[test]
fn a_mesh_is_met_where_its_first_triangle_is() {
    let (mut random, ours, mesh) = (Random::new(154), ContinuumDispatcher::default(), floor_mesh());
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..200 {
        let link = random.link();
        let pose = Pose::from_translation(random.vector(1.0) + 4.0 * Vector::Y);
        let velocity = random.vector(1.0) - 6.0 * Vector::Y;
        let options = ShapeCastOptions::with_max_time_of_impact(1.0);
        let each = mesh.triangles().map(|triangle| {
            ours.cast_shapes(&pose, velocity, &triangle, &link, options)
                .unwrap()
                .map_or(Real::INFINITY, |hit| hit.time_of_impact)
        });
        let first = each.fold(Real::INFINITY, Real::min);
        let hit = ours.cast_shapes(&pose, velocity, &mesh, &link, options).unwrap();
        assert_eq!(hit.map_or(Real::INFINITY, |hit| hit.time_of_impact), first);
        hits += usize::from(hit.is_some());
        misses += usize::from(hit.is_none());
    }
    assert!(hits > 50 && misses > 10, "{hits} hits, {misses} misses");
}

/// What parry's own tests of its casts ask, with links in place of balls and capsules, and meshes
/// in place of cuboids.
mod as_parry_asks {
    use super::EARLY;
    use parry_continuum::parry::math::{Pose, Vector};
    use parry_continuum::parry::query::{
        QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeCastStatus,
    };
    use parry_continuum::parry::shape::{Cuboid, Shape, TriMesh};
    use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};

    fn cuboid(half_extents: Vector) -> TriMesh {
        let (vertices, indices) = Cuboid::new(half_extents).to_trimesh();
        TriMesh::new(vertices, indices).unwrap()
    }

    fn ball(radius: f64) -> ModifiedCylinder {
        ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, radius).unwrap()
    }

    /// A robot that moves, and a wall that does not.
    fn cast(
        pose: Pose,
        velocity: Vector,
        robot: &dyn Shape,
        wall: &TriMesh,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit> {
        let pos12 = pose.inverse();
        ContinuumDispatcher::default()
            .cast_shapes(&pos12, -(pos12.rotation * velocity), robot, wall, options)
            .unwrap()
    }

    /// A cube of 1e-10, from the same distances as a cube of 1.
    #[test]
    fn a_tiny_mesh_is_met_as_a_large_one_is() {
        let wall = cuboid(Vector::splat(0.5e-10));
        for unit in [1e-10, 1.0] {
            for (end, caps) in
                [(Vector::ZERO, "round"), (2.0 * Vector::X, "round"), (2.0 * Vector::X, "flat")]
            {
                let model = if caps == "flat" {
                    ModifiedCylinder::cylinder
                } else {
                    ModifiedCylinder::capsule
                };
                let link = model(-0.5 * end * unit, 0.5 * end * unit, 0.5 * unit).unwrap();
                let place = Pose::from_translation(Vector::Y * 3.0 * unit);
                let distance = ContinuumDispatcher::default()
                    .distance(&place.inverse(), &link, &wall)
                    .unwrap()
                    .distance;
                let expected = 2.5 * unit - 0.5e-10;
                assert!((distance - expected).abs() <= 1e-15 * unit, "{unit} {caps}: {distance}");
                let hit =
                    cast(place, -Vector::Y, &link, &wall, ShapeCastOptions::default()).unwrap();
                let early = expected - hit.time_of_impact;
                assert!((-1e-15 * unit..=EARLY * unit).contains(&early), "{unit} {caps}: {hit:?}");
                // Past it.
                let beside =
                    Pose::from_translation(Vector::new(0.0, 3.0, 0.6) * unit + Vector::Z * 1e-10);
                assert!(
                    cast(beside, -Vector::Y, &link, &wall, ShapeCastOptions::default()).is_none()
                );
            }
        }
    }

    /// Issue 26.
    #[test]
    fn a_target_distance_is_met_earlier() {
        let wall = cuboid(Vector::splat(0.5));
        for (target_distance, expected) in [(0.0, 2.0), (0.5, 1.5), (2.0, 0.0)] {
            let options = ShapeCastOptions { target_distance, ..Default::default() };
            let hit = cast(
                Pose::from_translation(-3.0 * Vector::X),
                Vector::X,
                &ball(0.5),
                &wall,
                options,
            )
            .unwrap();
            assert!((0.0..=EARLY).contains(&(expected - hit.time_of_impact)), "{hit:?}");
        }
    }

    /// Issue 106.
    #[test]
    fn what_just_touches_is_not_within() {
        let wall = cuboid(Vector::ONE);
        for (height, status) in [
            (1.5, ShapeCastStatus::Converged),
            (1.375, ShapeCastStatus::PenetratingOrWithinTargetDist),
        ] {
            let place = Pose::from_translation(Vector::Y * height);
            let hit =
                cast(place, -Vector::Y, &ball(0.5), &wall, ShapeCastOptions::default()).unwrap();
            assert_eq!((hit.time_of_impact, hit.status), (0.0, status));
        }
    }

    /// Issue 193: slightly through the top of a large cuboid, and not straight down.
    #[test]
    fn what_is_slightly_through_knows_the_face() {
        let wall = cuboid(Vector::new(20.0, 1.0, 20.0));
        let upright = ModifiedCylinder::capsule(-5.0 * Vector::Y, 5.0 * Vector::Y, 1.0).unwrap();
        for (link, height) in [
            (upright, 6.0 - 0.01),
            (upright, 6.0 - 0.02),
            (ball(1.0), 0.8),
            (ball(1.0), 1.0 - 0.200001),
        ] {
            let place = Pose::from_translation(Vector::Y * (height + 1.0));
            let velocity = Vector::new(0.1, 1.0, 0.0);
            let hit = cast(place, velocity, &link, &wall, ShapeCastOptions::default()).unwrap();
            assert!((hit.normal1 + Vector::Y).length() < 1e-9, "{height}: {hit:?}");
            assert!((hit.normal2 - Vector::Y).length() < 1e-9, "{height}: {hit:?}");
        }
    }
}

/// Rounding makes a velocity along the plane between two lead towards it, far away. They never
/// meet.
#[test]
fn what_moves_along_the_plane_between_two_never_meets() {
    let (mut random, mut asked) = (Random::new(173), 0);
    for _ in 0..500 {
        let radius = random.between(0.1, 1.0);
        let out =
            Vector::X * random.between(0.2, 0.8).sqrt() + Vector::Y * random.between(-1.0, 1.0);
        let axis = (out + Vector::Z * random.between(-1.0, 1.0)).normalize();
        // The barrel of the wall, which stands along y, and the rim of the link are 0.01 apart
        // along x.
        let reach = radius * (Vector::X - axis * axis.x).length();
        let start = Vector::new(0.11 + 0.01 + reach, random.between(-0.9, 0.9), 0.0);
        let link =
            ModifiedCylinder::new(start, start + axis, radius, [Cap::Flat, Cap::Round]).unwrap();
        let frame = random.pose(2.0);
        let link = link.transformed(&frame.inverse());
        let walls = [SharedShape::cylinder(0.98, 0.11), SharedShape::cuboid(0.11, 0.98, 0.5)];
        for wall in &walls {
            for way in [Vector::Y, -Vector::Y] {
                let there = frame.rotation.inverse() * way;
                let cast = |pos12: &Pose, velocity, g1: &dyn Shape, g2: &dyn Shape| {
                    let options = ShapeCastOptions::default();
                    ContinuumDispatcher::default().cast_shapes(pos12, velocity, g1, g2, options)
                };
                asked += 1;
                for hit in [
                    cast(&frame, way, &**wall, &link),
                    cast(&frame.inverse(), there, &link, &**wall),
                ] {
                    assert!(matches!(hit, Ok(None)), "{link:?} {frame:?} {hit:?}");
                }
            }
        }
    }
    assert_eq!(asked, 2000);
}
