//! The queries agree on aligned and touching placements, for every pair of the dispatcher's table,
//! in both orders. ([`pairs`](super::pairs) compares `distance` with other measurements.)

use continuum_testing::placements::{Placement, Wall};
use continuum_testing::{Random, rounds};
use parry_continuum::ContinuumDispatcher;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::*;
use parry_continuum::parry::shape::Shape;

/// Negative ones ask for an overlap as deep.
const PREDICTIONS: [Real; 9] = [-0.2, -1e-3, -1e-9, 0.0, 1e-12, 1e-6, 0.02, 0.5, Real::INFINITY];

/// Placements of each kind.
fn placements() -> usize {
    rounds(1000).max(100)
}

/// The allowed difference between two queries of the same pair: rounding, or the tolerance of
/// parry's GJK for shapes of size one.
fn tolerance(kind: Wall) -> Real {
    match kind {
        Wall::Triangle | Wall::Plate | Wall::BoxMesh | Wall::HeightField => 1e-11,
        Wall::Segment | Wall::Polyline | Wall::HalfSpace => 1e-11,
        Wall::Ball | Wall::Capsule | Wall::Cylinder | Wall::Link | Wall::Chain => 1e-11,
        _ => 3e-5,
    }
}

/// A placement in one of the two orders.
struct Asked<'a> {
    placement: &'a Placement,
    pos12: Pose,
    g1: &'a dyn Shape,
    g2: &'a dyn Shape,
}

impl Asked<'_> {
    #[track_caller]
    fn assert(&self, holds: bool, what: impl std::fmt::Debug) {
        let Placement { kind, touch, gap, tilt, .. } = self.placement;
        let shapes = (self.g1.as_typed_shape(), self.g2.as_typed_shape());
        assert!(
            holds,
            "{what:?}: {kind:?} {touch:?}, gap {gap:e}, tilt {tilt:e}, {:?} {shapes:?}",
            self.pos12
        );
    }

    fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        ContinuumDispatcher::default().contact(&self.pos12, self.g1, self.g2, prediction)
    }

    fn closest_points(&self, max_dist: Real) -> ClosestPoints {
        ContinuumDispatcher::default()
            .closest_points(&self.pos12, self.g1, self.g2, max_dist)
            .unwrap()
    }

    fn length(&self, point1: Vector, point2: Vector) -> Real {
        (point1 - self.pos12 * point2).length()
    }

    /// The least `dist` of the manifolds, made twice, because they are updated; infinite if there
    /// are no points.
    fn least_of_manifolds(&self, prediction: Real) -> Real {
        let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
        for _ in 0..2 {
            ContinuumDispatcher::default()
                .contact_manifolds(
                    &self.pos12,
                    self.g1,
                    self.g2,
                    prediction,
                    &mut manifolds,
                    &mut workspace,
                )
                .unwrap();
        }
        manifolds
            .iter()
            .flat_map(|m| &m.points)
            .map(|point| point.dist)
            .fold(Real::INFINITY, Real::min)
    }
}

/// Asks of each placement in both orders. Returns how many were apart, touched within 1e-9, and
/// overlapped by more.
fn each(kind: Wall, seed: u64, mut ask: impl FnMut(&Asked, Real)) -> [usize; 3] {
    let mut random = Random::new(seed);
    let mut seen = [0; 3];
    for _ in 0..placements() {
        let placement = random.placement(kind);
        let (robot, wall) = (&*placement.robot, &*placement.wall);
        let mut distances = [0.0; 2];
        for (order, (pos12, g1, g2)) in
            [(placement.pose, robot, wall), (placement.pose.inverse(), wall, robot)]
                .into_iter()
                .enumerate()
        {
            let asked = Asked { placement: &placement, pos12, g1, g2 };
            let distance =
                ContinuumDispatcher::default().distance(&pos12, g1, g2).unwrap().distance;
            distances[order] = distance;
            asked.assert(distance >= 0.0, distance);
            ask(&asked, distance);
        }
        assert!((distances[0] - distances[1]).abs() <= tolerance(kind), "{kind:?} {distances:?}");
        let place = if placement.gap > 1e-9 {
            0
        } else if placement.gap >= -1e-9 {
            1
        } else {
            2
        };
        seen[place] += 1;
    }
    assert!(seen.into_iter().all(|count| count > placements() / 10), "{kind:?} {seen:?}");
    seen
}

#[test]
fn points_distances_and_tests_of_touching_placements_agree() {
    for kind in Wall::ALL {
        let slack = tolerance(kind);
        each(kind, 301, |asked, distance| {
            let Asked { pos12, g1, g2, .. } = asked;
            let meets = ContinuumDispatcher::default().intersection_test(pos12, *g1, *g2).unwrap();
            asked.assert(!meets.intersecting || distance <= slack, ("meets", distance));
            match asked.closest_points(Real::MAX) {
                ClosestPoints::Intersecting => {
                    asked.assert(distance <= slack, ("closest meet", distance))
                }
                ClosestPoints::Disjoint => asked.assert(false, "no closest points"),
                ClosestPoints::WithinMargin(point1, point2) => {
                    let length = asked.length(point1, point2);
                    asked.assert((length - distance).abs() <= slack, ("closest", length, distance));
                }
            }
            for max_dist in PREDICTIONS {
                match asked.closest_points(max_dist) {
                    ClosestPoints::Intersecting => {
                        asked.assert(distance <= slack, (max_dist, distance))
                    }
                    ClosestPoints::Disjoint => {
                        asked.assert(distance >= max_dist - slack, (max_dist, distance))
                    }
                    ClosestPoints::WithinMargin(point1, point2) => {
                        let length = asked.length(point1, point2);
                        asked.assert(
                            length <= max_dist.max(-slack) + slack,
                            ("beyond", max_dist, length),
                        );
                    }
                }
            }
        });
    }
}

/// parry's contact is the distance of two points along its normal. For a face and an edge that are
/// level within rounding the points may be far apart across it.
#[test]
fn contacts_have_points_as_far_apart_as_they_state() {
    for (kind, seed) in [(Wall::Cuboid, 301), (Wall::Cuboid, 1), (Wall::Cone, 1)] {
        let (mut random, mut apart) = (Random::new(seed), 0);
        for _ in 0..1000 {
            let placement = random.placement(kind);
            let (pos12, g1, g2) = (placement.pose, &*placement.robot, &*placement.wall);
            let asked = Asked { placement: &placement, pos12, g1, g2 };
            let contact = asked.contact(0.02).unwrap();
            if let Some(contact) = contact.filter(|contact| contact.dist > 0.0) {
                apart += 1;
                let length = asked.length(contact.point1, contact.point2);
                asked.assert((length - contact.dist).abs() <= tolerance(kind), (contact, length));
            }
        }
        assert!(apart > 100, "{kind:?} {apart}");
    }
}

/// parry's GJK and EPA return `None` for some of them.
#[test]
fn an_unbounded_contact_finds_what_distance_finds() {
    for kind in Wall::ALL {
        let slack = tolerance(kind);
        each(kind, 302, |asked, distance| {
            for prediction in [Real::MAX, Real::INFINITY] {
                let contact = asked.contact(prediction).unwrap();
                let Some(contact) = contact else {
                    return asked.assert(false, ("no contact", distance));
                };
                let is_as_far = (contact.dist - distance).abs() <= slack;
                asked.assert(
                    is_as_far || distance <= slack && contact.dist <= slack,
                    (contact, distance),
                );
                let between = asked.pos12 * contact.point2 - contact.point1;
                asked.assert(
                    (between.dot(contact.normal1) - contact.dist).abs() <= 10.0 * slack,
                    contact,
                );
            }
        });
    }
}

#[test]
fn nothing_beyond_a_prediction_is_returned_and_nothing_within_is_lost() {
    for kind in Wall::ALL {
        let slack = tolerance(kind);
        let mut dropped = 0;
        each(kind, 303, |asked, _| {
            let all =
                asked.contact(Real::MAX).unwrap().map_or(Real::INFINITY, |contact| contact.dist);
            for prediction in PREDICTIONS {
                match asked.contact(prediction).unwrap() {
                    Some(contact) => {
                        asked.assert(
                            contact.dist <= prediction,
                            ("beyond", prediction, contact.dist),
                        );
                        asked.assert(
                            (contact.dist - all).abs() <= slack,
                            (prediction, contact.dist, all),
                        );
                    }
                    None => {
                        dropped += usize::from(prediction < 0.0);
                        asked.assert(all >= prediction - slack, ("lost", prediction, all));
                    }
                }
            }
        });
        assert!(dropped > placements() / 4, "{kind:?} {dropped}");
    }
}

/// Whether a mesh may have turned or refused the normal of a contact.
fn has_constraints(placement: &Placement) -> bool {
    placement.wall.as_trimesh().is_some_and(|mesh| mesh.triangle_normal_constraints(0).is_some())
}

#[test]
fn the_least_distance_of_a_manifold_is_the_contacts() {
    for kind in Wall::ALL {
        let slack = tolerance(kind);
        let mut compared = 0;
        each(kind, 304, |asked, _| {
            if has_constraints(asked.placement) {
                return;
            }
            for prediction in PREDICTIONS.into_iter().filter(|prediction| prediction.is_finite()) {
                let least = asked.least_of_manifolds(prediction);
                match asked.contact(prediction).unwrap() {
                    Some(contact) if contact.dist < prediction - slack => {
                        compared += 1;
                        let is_least = (least - contact.dist).abs() <= slack;
                        asked.assert(is_least, (prediction, least, contact.dist));
                    }
                    Some(_) => {}
                    None => asked.assert(least >= prediction - slack, ("extra", prediction, least)),
                }
                let is_within = least <= prediction + 1e-12 || least == Real::INFINITY;
                asked.assert(is_within, ("beyond", prediction, least));
            }
        });
        assert!(compared > 3 * placements() / 4, "{kind:?} {compared}");
    }
}

/// What is nearer than this may count as touching at the start of a nonlinear cast: 1e-5 of the
/// sizes.
const NONLINEAR_TOUCH: Real = 1e-4;

/// Along the way between the closest points, at speed 1, the two meet after just that distance; the
/// opposite way convex ones never do.
#[test]
fn casts_along_the_way_between_meet_after_the_distance() {
    let dispatcher = ContinuumDispatcher::default();
    for kind in Wall::ALL {
        let slack = tolerance(kind).max(3e-9);
        let (mut apart, mut overlapping) = (0, 0);
        each(kind, 305, |asked, distance| {
            let Asked { pos12, g1, g2, .. } = *asked;
            let contact = asked.contact(Real::MAX).unwrap().unwrap();
            let way = contact.normal1;
            for stop_at_penetration in [true, false] {
                let options = ShapeCastOptions { stop_at_penetration, ..Default::default() };
                let cast = |way| dispatcher.cast_shapes(&pos12, way, g1, g2, options).unwrap();
                let still = |way: Vector, start: Pose| NonlinearRigidMotion {
                    linvel: way,
                    ..NonlinearRigidMotion::constant_position(start)
                };
                let end = 2.0 * distance + 1.0;
                let (rests, comes) = (still(Vector::ZERO, Pose::IDENTITY), still(-way, pos12));
                let turning = dispatcher.cast_shapes_nonlinear(
                    &rests,
                    g1,
                    &comes,
                    g2,
                    0.0,
                    end,
                    stop_at_penetration,
                );
                let turning = turning.unwrap().map(|hit| hit.time_of_impact);
                if distance > 10.0 * slack {
                    apart += 1;
                    let time = cast(-way).map(|hit| hit.time_of_impact);
                    let in_time = time.is_some_and(|time| (time - distance).abs() <= slack);
                    asked.assert(in_time, ("straight", distance, time));
                    // Of others another part may lie that way.
                    let both_convex = g1.is_convex() && g2.is_convex();
                    asked.assert(!both_convex || cast(way).is_none(), ("away", distance));
                    // Where they count as touching, what is cast is the core.
                    if stop_at_penetration || distance > NONLINEAR_TOUCH {
                        let not_late = turning.is_some_and(|time| time <= distance + slack);
                        asked.assert(not_late, ("nonlinear", distance, turning));
                    }
                } else if contact.dist < -10.0 * slack && stop_at_penetration {
                    overlapping += 1;
                    for way in [way, -way] {
                        let time = cast(way).map(|hit| hit.time_of_impact);
                        asked.assert(time == Some(0.0), ("overlapping", contact.dist, time));
                    }
                    asked.assert(
                        turning == Some(0.0),
                        ("overlapping, nonlinear", contact.dist, turning),
                    );
                }
            }
        });
        assert!(
            apart > 3 * placements() / 8 && overlapping > placements() / 4,
            "{kind:?} {apart} {overlapping}"
        );
    }
}
