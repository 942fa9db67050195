//! The contact points of two links, if at most one link meets the other with a flat cap. Each point
//! is on both surfaces and has the right `dist`. The nearest has the exact distance, or the exact
//! depth of the overlap.
//!
//! The proof of a contact needs nothing of its making. For any unit vector the gap between the two
//! links' supports along it is a lower bound on their distance; so where the gap along the
//! contact's normal is the points' own distance, that is the distance. Where they overlap it is a
//! way out, and no sampled way out may be shorter.

use crate::draw::{Draw, U};
use continuum_testing::Random;
use continuum_testing::placements::Wall;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{ContactManifold, PersistentQueryDispatcher, PointQuery};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

/// How far a link reaches along a unit vector.
fn support(link: &ModifiedCylinder, along: Vector) -> Real {
    let axis = (link.end() - link.start()).normalize_or_zero();
    let across = (along - axis * axis.dot(along)).length();
    let ends = [(link.start(), -axis), (link.end(), axis)].into_iter().zip(link.caps());
    let reach = |((centre, outward), cap): ((Vector, Vector), Cap)| {
        let leans_out = cap == Cap::Round && outward.dot(along) >= 0.0;
        centre.dot(along) + link.radius() * if leans_out { 1.0 } else { across }
    };
    ends.map(reach).fold(Real::NEG_INFINITY, Real::max)
}

/// How far the second link begins beyond the first along a unit vector.
fn gap(first: &ModifiedCylinder, second: &ModifiedCylinder, along: Vector) -> Real {
    -support(second, -along) - support(first, along)
}

/// A link whose numbers are near one: not thin and not flat.
fn link(random: &mut Random, caps: [Cap; 2]) -> ModifiedCylinder {
    let start = random.vector(0.5);
    let end = start + random.direction() * random.between(0.3, 2.0);
    ModifiedCylinder::new(start, end, random.between(0.1, 0.6), caps).unwrap()
}

fn manifold(
    pose: &Pose,
    first: &ModifiedCylinder,
    second: &ModifiedCylinder,
) -> ContactManifold<(), ()> {
    let mut manifold = ContactManifold::new();
    let dispatcher = ContinuumDispatcher::default();
    dispatcher
        .contact_manifold_convex_convex(pose, first, second, None, None, 0.2, &mut manifold)
        .unwrap();
    manifold
}

const TOLERANCE: Real = 256.0 * U * 8.0;
/// A point that coincides with the nearest may stand for it: a millionth of the links' extent.
const SAME_POINT: Real = 1e-5;

#[test]
fn a_capsule_and_any_link_meet_exactly() {
    let mut random = Random::new(161);
    let (mut apart, mut overlapping, mut nothing, mut several) = (0, 0, 0, 0);
    for _ in 0..20_000 {
        let (first, second, pose) = if random.chance(0.5) {
            let (first, wall, pose) = random.aligned(Wall::Link);
            let second = wall.as_shape::<ModifiedCylinder>().unwrap();
            (
                first,
                ModifiedCylinder::capsule(second.start(), second.end(), second.radius()).unwrap(),
                pose,
            )
        } else {
            let any = random.caps();
            let (first, second) = (link(&mut random, any), link(&mut random, [Cap::Round; 2]));
            (
                first,
                second,
                Pose::new(random.vector(1.5), random.direction() * random.between(0.0, 3.0)),
            )
        };
        let is_capsule_first = random.chance(0.5);
        let (first, second, pose) =
            if is_capsule_first { (second, first, pose.inverse()) } else { (first, second, pose) };
        let placed = second.transformed(&pose);
        let capsule = if is_capsule_first { first } else { placed };
        let solid = if is_capsule_first { placed } else { first };
        // Where the capsule's axis is inside the other link there is no closed form.
        let deep = (0..=64).any(|k| {
            let at = capsule.start().lerp(capsule.end(), Real::from(k) / 64.0);
            solid.distance_to_local_point(at, true) < 0.05
        });
        if deep {
            continue;
        }
        let found = manifold(&pose, &first, &second);
        let context = || format!("{first:?} {second:?} {pose:?} {found:?}");
        let Some(least) = found.points.iter().map(|point| point.dist).reduce(Real::min) else {
            nothing += 1;
            // They are farther apart than the prediction, by some plane or by the sampled points.
            let points = (0..=200).map(|k| {
                let at = capsule.start().lerp(capsule.end(), Real::from(k) / 200.0);
                solid.distance_to_local_point(at, true) - capsule.radius()
            });
            assert!(points.fold(Real::INFINITY, Real::min) > 0.2, "{}", context());
            continue;
        };
        let proven = gap(&first, &placed, found.local_n1);
        assert!(
            (-TOLERANCE..SAME_POINT).contains(&(least - proven)),
            "{proven} {least} {}",
            context()
        );
        if least < 0.0 {
            overlapping += 1;
            for _ in 0..200 {
                let way =
                    (found.local_n1 + random.point() * random.log_between(1e-3, 10.0)).normalize();
                assert!(gap(&first, &placed, way) < proven + TOLERANCE, "{way} {}", context());
            }
        } else {
            apart += 1;
        }
        several += usize::from(found.points.len() > 1);
        for point in &found.points {
            let between = pose * point.local_p2 - point.local_p1;
            assert!((between - found.local_n1 * point.dist).length() < TOLERANCE, "{}", context());
            let off = [
                first.distance_to_local_point(point.local_p1, false),
                second.distance_to_local_point(point.local_p2, false),
            ];
            // Where the normal leans along an axis, what lies along the crest is lower by the
            // square of the lean.
            let leans = [&first, &placed]
                .map(|link| found.local_n1.dot(link.axis()).powi(2) * link.radius());
            // One all but as close stands for the nearest, with its distance.
            let stands_for = if point.dist == least { SAME_POINT } else { 0.0 };
            let enough = 1e-12 + leans[0] + leans[1] + stands_for;
            assert!(off.iter().all(|off| off.abs() < enough), "{off:?} {}", context());
        }
    }
    assert!(
        apart > 1000 && overlapping > 1000 && nothing > 1000 && several > 500,
        "{apart} {overlapping} {nothing} {several}"
    );
}

/// Barrels of links with flat caps, crossing at any angle, also where the overlap is near the caps.
#[test]
fn barrels_that_cross_meet_exactly() {
    let mut random = Random::new(162);
    let (mut shallow, mut near_caps) = (0, 0);
    for _ in 0..20_000 {
        let radii = [random.between(0.1, 0.5), random.between(0.1, 0.5)];
        let lengths = [random.between(0.3, 2.0), random.between(0.3, 2.0)];
        let [first, second] = [0, 1].map(|k| {
            let half = 0.5 * lengths[k] * Vector::X;
            ModifiedCylinder::new(-half, half, radii[k], [Cap::Flat; 2]).unwrap()
        });
        // Crossing points of the axes, `t` from the nearest flat ends, one above the other.
        let angle = random.between(0.05, 1.57);
        let inward = [random.log_between(1e-3, 0.4), random.log_between(1e-3, 0.4)];
        let places = [0, 1].map(|k| (0.5 - inward[k].min(0.5)) * lengths[k]);
        let dist = random.between(-0.5, 0.2) * radii[0].min(radii[1]);
        let turn = Pose::rotation(Vector::Y * angle);
        let height = Vector::Y * (radii[0] + radii[1] + dist);
        let pose = Pose::from_parts(height + Vector::X * places[0], turn.rotation)
            * Pose::from_translation(-Vector::X * places[1]);
        let to_flat = [0, 1].map(|k| inward[k].min(0.5) * lengths[k]);
        if to_flat[0].min(to_flat[1]) < 1e-6 - dist.min(0.0) {
            continue;
        }
        let found = manifold(&pose, &first, &second);
        let context = || format!("{to_flat:?} {dist} {first:?} {second:?} {pose:?} {found:?}");
        let least = found.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        assert!((-TOLERANCE..SAME_POINT).contains(&(least - dist)), "{least} {}", context());
        assert!((found.local_n1 - Vector::Y).length() < 1e-12, "{}", context());
        // They roll on one point; a second one at an end would come and go.
        assert!(angle < 0.4 || found.points.len() == 1, "{angle} {}", context());
        shallow += usize::from(dist < 0.0);
        near_caps += usize::from(to_flat[0].min(to_flat[1]) < 0.1);
        let placed = second.transformed(&pose);
        for _ in 0..100 {
            let way = (Vector::Y + random.point() * random.log_between(1e-3, 10.0)).normalize();
            assert!(gap(&first, &placed, way) < dist + TOLERANCE, "{way} {}", context());
        }
    }
    assert!(shallow > 2000 && near_caps > 5000, "{shallow} {near_caps}");
}

/// Barrels that overlap by more across their axes than along them: the short way out is the flat
/// caps'.
#[test]
fn where_flat_caps_are_the_way_out_barrels_do_not_answer() {
    let mut random = Random::new(163);
    for _ in 0..500 {
        let (depth, overhang) = (random.between(0.2, 0.3), random.log_between(1e-3, 0.05));
        let first = ModifiedCylinder::cylinder(-Vector::X, Vector::ZERO, 0.5).unwrap();
        let second = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X, 0.5).unwrap();
        // The axes cross, seen from above, in the middle of what they have in common.
        let above = Pose::from_translation(Vector::new(-0.5 * overhang, 1.0 - depth, 0.0));
        let turn = Pose::rotation(Vector::Y * random.between(0.01, 0.05));
        let pose = above * turn * Pose::from_translation(-0.5 * overhang * Vector::X);
        let found = manifold(&pose, &first, &second);
        let least = found.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        assert!((-overhang - 0.06..0.0).contains(&least), "{overhang} {depth} {found:?}");
    }
}

/// Barrels that lie along each other touch at both ends of what they have in common, and the points
/// keep their names.
#[test]
fn parallel_barrels_touch_at_two_points() {
    let first = ModifiedCylinder::cylinder(-Vector::X, Vector::X, 0.25).unwrap();
    for caps in [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round]] {
        let second = ModifiedCylinder::new(Vector::ZERO, 3.0 * Vector::X, 0.5, caps).unwrap();
        let mut names = None;
        for tilt in [-0.02, -1e-9, 0.0, 1e-9, 0.02] {
            let pose = Pose::new(Vector::new(-0.5, 0.74, 0.01), Vector::new(0.0, 0.3 * tilt, tilt));
            let found = manifold(&pose, &first, &second);
            let mut places: Vec<_> = found
                .points
                .iter()
                .map(|point| (point.local_p1.x, point.fid1, point.fid2))
                .collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(places.len() == 2, "{caps:?} {tilt} {found:?}");
            assert!(
                (places[0].0 + 0.5).abs() < 0.03 && (places[1].0 - 1.0).abs() < 0.03,
                "{places:?}"
            );
            let now = [0, 1].map(|k| (places[k].1, places[k].2));
            assert_eq!(*names.get_or_insert(now), now, "{caps:?} {tilt}");
        }
    }
}

/// A barrel that lies across a flat cap is held where its crest comes over the rim and leaves it.
#[test]
fn a_barrel_across_a_flat_cap_touches_at_two_points() {
    let post = ModifiedCylinder::cylinder(-2.0 * Vector::Y, Vector::ZERO, 0.5).unwrap();
    let beam = ModifiedCylinder::capsule(-2.0 * Vector::X, 2.0 * Vector::X, 0.25).unwrap();
    let above = Pose::from_translation(Vector::new(0.1, 0.24, 0.3));
    for (pose, is_post_first) in [(above, true), (above.inverse(), false)] {
        let found = if is_post_first {
            manifold(&pose, &post, &beam)
        } else {
            manifold(&pose, &beam, &post)
        };
        let on_post = |k: usize| {
            let point = &found.points[k];
            if is_post_first { point.local_p1 } else { point.local_p2 }
        };
        assert_eq!(found.points.len(), 2, "{found:?}");
        let mut places = [on_post(0), on_post(1)];
        places.sort_by(|a, b| a.x.total_cmp(&b.x));
        for (place, x) in places.into_iter().zip([-0.4, 0.4]) {
            assert!((place - Vector::new(x, 0.0, 0.3)).length() < 1e-9, "{places:?}");
        }
        assert!(found.points.iter().all(|point| (point.dist + 0.01).abs() < 1e-12), "{found:?}");
    }
}
