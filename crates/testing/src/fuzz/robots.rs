//! Two robots, and one robot with itself: the closest pair of links is that of all pairs in
//! double-double numbers.

use super::source::Source;
use crate::narrow_phase::modified_cylinder_modified_cylinder;
use crate::precision::extent;
use parry_continuum::distance::{DoubleDouble, Vec3};
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{ProximityError, RobotPair, RobotProximity, SelfQuery};
use parry_continuum::{Cap, Chain, ModifiedCylinder, Tube};

/// Asserts that each pair's distance is within 16 units of its extent; that `minimum`, `per_link`,
/// `clears` and `contacts_within` agree with it and with one another, in both orders; and that the
/// bounds of both robots as tubes contain it. For a robot with itself: the answer is a pair of its
/// links.
pub fn robots(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let poses = [source.pose(), source.pose()];
    let (Some(a), Some(b)) = (robot(&mut source), robot(&mut source)) else { return };
    let margin = source.number();
    let mut pair = RobotPair::new();
    alone(&mut SelfQuery::new(), &a, margin);
    let Ok(found) = pair.minimum(&a, &poses[0], &b, &poses[1]) else {
        assert!(pair.clears(&a, &poses[0], &b, &poses[1], 1.0).is_err(), "{a:?} {b:?} {poses:?}");
        return;
    };
    let problem = || format!("{found:?}\n{a:?}\n{b:?}\n{poses:?}");
    let placed = |robot: &Chain, pose: &Pose| -> Vec<_> {
        robot.links().iter().map(|link| link.transformed(pose)).collect()
    };
    let (first, second) = (placed(&a, &poses[0]), placed(&b, &poses[1]));

    let mut each = Vec::new();
    pair.per_link(&a, &poses[0], &b, &poses[1], &mut each).expect("poses as before");
    let least = each
        .iter()
        .copied()
        .reduce(|best, next| if next.distance < best.distance { next } else { best });
    assert_eq!(least, Some(found), "{}", problem());
    for (one, nearest) in first.iter().zip(&each) {
        check(one, &second, nearest)
            .unwrap_or_else(|why| panic!("{why}: {nearest:?} {}", problem()));
    }
    assert_eq!(RobotPair::new().minimum(&a, &poses[0], &b, &poses[1]), Ok(found), "{}", problem());
    let turned = pair.minimum(&b, &poses[1], &a, &poses[0]).expect("poses as before").distance;
    let slack =
        first.iter().chain(&second).fold(0.0, |most: f64, link| most.max(slack(link, &first[0])));
    let bounds = found
        .certify(&a, &poses[0], &b, &poses[1])
        .unwrap_or_else(|why| panic!("{why}: {}", problem()));
    let holds = bounds.lower - slack <= found.distance && found.distance <= bounds.upper + slack;
    assert!(holds && bounds.upper - bounds.lower <= slack, "{bounds:?} {}", problem());
    assert!((turned - found.distance).abs() <= 2.0 * slack, "{turned:e} {}", problem());
    let d = found.distance;
    for margin in [0.0, d, d.next_up(), d.next_down().max(0.0)] {
        let clears = pair.clears(&a, &poses[0], &b, &poses[1], margin).expect("a good margin");
        assert_eq!(clears, d > margin, "{margin:e} {}", problem());
    }
    let mut places = Vec::new();
    match pair.contacts_within(&a, &poses[0], &b, &poses[1], margin, &mut places) {
        Err(error) => assert!(matches!(error, ProximityError::Negative { .. }), "{error}"),
        Ok(()) if d > margin => assert!(places.is_empty(), "{places:?} {}", problem()),
        Ok(()) => assert!(places.contains(&found), "{places:?} {}", problem()),
    }
    // If a pose moves a chain far, rounding turns the axes of its short links. The tube keeps its
    // faces.
    let here = Pose::IDENTITY;
    if let (Ok(truth), Ok(found)) = (
        RobotPair::new().minimum(&a, &here, &b, &here),
        pair.clearance(&Tube::from(&a), &here, &Tube::from(&b), &here, 0.0),
    ) {
        let truth = truth.distance;
        assert!(found.lower <= truth && truth <= found.upper, "{truth:e} {found:?} {}", problem());
    }
}

fn robot(source: &mut Source) -> Option<Chain> {
    let points: Vec<_> = (0..2 + source.below(5)).map(|_| source.point()).collect();
    let radii: Vec<_> = points[1..].iter().map(|_| source.number().abs()).collect();
    let robot = match source.below(4) {
        0 => Chain::capsules(&points, &radii),
        1 => Chain::cylinders(&points, &radii),
        _ => Chain::from_centreline(&points, &radii),
    };
    robot.ok()
}

/// Checks a robot with itself.
fn alone(query: &mut SelfQuery, robot: &Chain, margin: f64) {
    let Ok(found) = query.minimum(robot) else { return };
    assert_eq!(query.minimum(robot), Ok(found), "{robot:?}");
    let distance = found.map_or(f64::INFINITY, |found| found.distance);
    if let Some(RobotProximity { links: [i, j], .. }) = found {
        // At least one link lies between them.
        assert!(i + 1 < j && (j as usize) < robot.links().len(), "{found:?} {robot:?}");
        let [one, two] = [i, j].map(|link| &robot.links()[link as usize]);
        // The answer may belong to a face of a link, which is no nearer than the link.
        assert!(exactly(one, two) <= distance + slack(one, two), "{found:?} {robot:?}");
    }
    if let Ok(clears) = query.clears(robot, margin) {
        assert_eq!(clears, distance > margin, "{margin:e} {found:?} {robot:?}");
    }
}

fn exactly(one: &ModifiedCylinder, two: &ModifiedCylinder) -> f64 {
    let wide = DoubleDouble::from;
    let axis = |link: &ModifiedCylinder| {
        [link.start(), link.end()].map(|point| Vec3::from(point.to_array().map(wide)))
    };
    let flat = |link: &ModifiedCylinder| link.caps().map(|cap| cap == Cap::Flat);
    let (r, s) = (wide(one.radius()), wide(two.radius()));
    modified_cylinder_modified_cylinder(axis(one), r, flat(one), axis(two), s, flat(two))
        .distance
        .rounded()
}

/// Returns the rounding error of the distance of two links.
fn slack(one: &ModifiedCylinder, two: &ModifiedCylinder) -> f64 {
    let points = [one.start(), one.end(), two.start(), two.end()];
    16.0 * f64::EPSILON * extent(&points, one.radius().max(two.radius())) + 8.0 * f64::from_bits(1)
}

/// Returns an error unless an answer about a link is the distance of its pair and no other pair is
/// nearer.
fn check(
    one: &ModifiedCylinder,
    others: &[ModifiedCylinder],
    nearest: &RobotProximity,
) -> Result<(), String> {
    for (number, two) in others.iter().enumerate() {
        let (exact, slack) = (exactly(one, two), slack(one, two));
        if nearest.distance > exact + slack {
            return Err(format!("link {number} is nearer, {exact:e}"));
        }
        let is_own = number == nearest.links[1] as usize;
        if is_own && (nearest.distance - exact).abs() > slack {
            return Err(format!("the pair is {exact:e} apart"));
        }
    }
    Ok(())
}
