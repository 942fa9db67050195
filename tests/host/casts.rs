//! Casts stop where the distance is gone, and nothing was met before.

use crate::composites::composites;
use crate::draw::Draw;
use crate::scene::parts;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{NonlinearRigidMotion, QueryDispatcher, ShapeCastOptions};
use parry_continuum::parry::shape::{HeightField, Shape};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};

#[test]
fn casts_stop_at_the_first_part_that_is_met() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(43);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..20 {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in
                [(&robot, &other, pos12), (&other, &robot, pos12.inverse())]
            {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                if dispatcher.distance(&pos12, g1, g2).unwrap().distance < 1e-3 {
                    continue;
                }
                let (centre1, centre2) =
                    (g1.compute_local_aabb().center(), g2.compute_aabb(&pos12).center());
                let velocity = (centre1 - centre2) + random.vector(1.0);
                let options = ShapeCastOptions::with_max_time_of_impact(1.5);
                let at = |time: Real| {
                    let pose = Pose::from_translation(velocity * time) * pos12;
                    dispatcher.distance(&pose, g1, g2).unwrap().distance
                };
                // No point of the one comes nearer to the other than their speed allows.
                let mut time = 0.0;
                while time < 1.5 && at(time) > 1e-5 {
                    time += at(time) / velocity.length();
                }
                match dispatcher.cast_shapes(&pos12, velocity, g1, g2, options).unwrap() {
                    Some(hit) => {
                        hits += 1;
                        assert!(at(hit.time_of_impact) < 1e-3, "{name}: {hit:?}");
                        assert!(hit.time_of_impact > time - 1e-3, "{name}: {hit:?} for {time}");
                        let (ids1, ids2) = (parts(g1), parts(g2));
                        assert!(ids1.iter().any(|part| part.0 == hit.subshape1), "{name}: {hit:?}");
                        assert!(ids2.iter().any(|part| part.0 == hit.subshape2), "{name}: {hit:?}");
                    }
                    None => {
                        misses += 1;
                        assert!(
                            time >= 1.5 || at(time) > -1.0 && grazes(&at, time),
                            "{name}: {time}"
                        );
                    }
                }
            }
        }
    }
    assert!(hits > 100 && misses > 20, "{hits} hits, {misses} misses");
}

/// Whether the shapes part again at once.
fn grazes(at: &impl Fn(Real) -> Real, time: Real) -> bool {
    (1..=20).all(|i| at(time + 1e-3 * Real::from(i)) > 0.0)
}

/// The same motions as linear casts, and turning ones.
#[test]
fn nonlinear_casts_stop_at_the_first_part_that_is_met() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(44);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..rounds(6) {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in
                [(&robot, &other, pos12), (&other, &robot, pos12.inverse())]
            {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                if dispatcher.distance(&pos12, g1, g2).unwrap().distance < 1e-2 {
                    continue;
                }
                let turn = if random.chance(0.5) { random.vector(0.5) } else { Vector::ZERO };
                let approach = g1.compute_local_aabb().center() - g2.compute_aabb(&pos12).center();
                let still = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
                let moving = NonlinearRigidMotion::new(
                    pos12,
                    Vector::ZERO,
                    approach + random.vector(0.3),
                    turn,
                );
                let hit = dispatcher
                    .cast_shapes_nonlinear(&still, g1, &moving, g2, 0.0, 1.0, true)
                    .unwrap();
                let at = |time: Real| {
                    let pose = moving.position_at_time(time);
                    dispatcher.distance(&pose, g1, g2).unwrap().distance
                };
                // The first of a thousand moments at which they meet.
                let met = (0..=1000).map(|i| Real::from(i) / 1000.0).find(|&time| at(time) == 0.0);
                match hit {
                    Some(hit) => {
                        hits += 1;
                        assert!(
                            at(hit.time_of_impact) < 1e-3,
                            "{name}: {hit:?} at {}",
                            at(hit.time_of_impact)
                        );
                        assert!(
                            met.is_none_or(|met| hit.time_of_impact <= met + 1e-6),
                            "{name}: {hit:?} {met:?}"
                        );
                    }
                    None => {
                        misses += 1;
                        assert_eq!(met, None, "{name}: missed, first met at {met:?}");
                    }
                }
            }
        }
    }
    assert!(hits > rounds(50) && misses > rounds(5), "{hits} hits, {misses} misses");
}

/// A cast along a floor, which parry's own casts against height fields miss beyond the starting
/// cells.
#[test]
fn a_level_cast_meets_the_hill_at_the_other_end_of_the_field() {
    let heights: Vec<Real> =
        (0..81).map(|k| if k / 9 == 7 || k % 9 == 7 { 1.0 } else { 0.0 }).collect();
    let field = HeightField::new(Array2::new(9, 9, heights), Vector::new(8.0, 1.0, 8.0));
    let link = ModifiedCylinder::capsule(-0.1 * Vector::X, 0.1 * Vector::X, 0.05).unwrap();
    let pose = Pose::from_translation(Vector::new(-3.5, 0.5, -3.5));
    let options = ShapeCastOptions::default();
    let dispatcher = ContinuumDispatcher::default();
    let hit = dispatcher.cast_shapes(&pose, Vector::X, &field, &link, options).unwrap().unwrap();
    // The slope from x = 2 up to x = 3 is half way up at 2.5; the capsule's end is 0.1 ahead, and
    // its round cap touches the slope of 45 degrees earlier by 0.05 sqrt 2.
    let expected = 6.0 - 0.1 - 0.05 * 2.0_f64.sqrt();
    assert!((hit.time_of_impact - expected).abs() < 1e-4, "{hit:?}");
    let hill = field.triangle_at_id(hit.subshape1).unwrap();
    assert!(hill.compute_local_aabb().maxs.x > 2.0);
    let back = dispatcher
        .cast_shapes(&pose.inverse(), -Vector::X, &link, &field, options)
        .unwrap()
        .unwrap();
    assert!(
        (back.time_of_impact - hit.time_of_impact).abs() < 1e-9 && back.subshape2 == hit.subshape1
    );
}
