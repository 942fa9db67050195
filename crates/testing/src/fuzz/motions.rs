//! Motions beside the shapes that they pass: tiny turns and large displacements, from starts that
//! touch. A motion that is proven clear must be clear at every sampled time.

use super::source::Source;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, MotionAnswer, Proximity, SelfQuery};
use parry_continuum::{Chain, LinearMotion, Motion, RigidMotion, Tube, verify_motion};

/// The number of times at which a motion is compared with its shapes.
const TIMES: u32 = 24;

/// Runs a chain that moves as a whole, or whose points move along lines.
pub fn motions(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let (vertices, indices) = source.wall();
    let Ok(mesh) = TriMesh::new(vertices, indices) else { return };
    let Ok(search) = BvhSearch::new(&mesh) else { return };
    let (points, radii) = source.centreline();
    let Ok(chain) = Chain::from_centreline(&points, &radii) else { return };
    if source.flag() {
        let from = source.pose();
        let to = source.nudged(from);
        let Ok(motion) = RigidMotion::new(Tube::from(&chain), [from, to]) else { return };
        check(&mut source, search, &mesh, &motion, |t| {
            let pose = motion.shape(t, &mut Tube::from(&chain)).ok()?;
            Some((chain.clone(), pose))
        });
    } else {
        let size = 2.0_f64.powi(-(source.below(40) as i32));
        let mut moved = |point: Vector| point + source.way() * size;
        let to: Vec<_> = points.iter().map(|&point| moved(point)).collect();
        let Ok(motion) = LinearMotion::chain(&points, &to, &radii) else { return };
        check(&mut source, search, &mesh, &motion, |t| {
            let between: Vec<_> =
                points.iter().zip(&to).map(|(from, to)| from.lerp(*to, t)).collect();
            if rounding_decides(&points, &to, &between) {
                return None;
            }
            Chain::from_centreline(&between, &radii).ok().map(|chain| (chain, Pose::IDENTITY))
        });
    }
}

/// Returns whether rounding decides, in an intermediate shape, the direction or the existence of a
/// segment. The motion itself derives both from its start and end.
fn rounding_decides(from: &[Vector], to: &[Vector], between: &[Vector]) -> bool {
    let reach =
        from.iter().chain(to).fold(0.0, |most: f64, point| point.abs().max_element().max(most));
    let segments = from.windows(2).zip(to.windows(2)).zip(between.windows(2));
    segments.into_iter().any(|((from, to), between)| {
        let is_there = from[0] != from[1] || to[0] != to[1];
        is_there && (between[1] - between[0]).length() <= 1e-12 * reach
    })
}

/// The shape at a time, as a chain.
type Shape<'a> = &'a dyn Fn(f64) -> Option<(Chain, Pose)>;

/// Asserts the answer about self contact: no sampled shape contradicts a proof of clearance, and
/// the named shape is within the margin.
fn beside_itself<M: Motion>(
    motion: &M,
    shape: Shape<'_>,
    margin: f64,
    resolution: f64,
    slack: impl Fn(f64) -> f64,
) {
    let mut query = SelfQuery::new();
    let answer = query.clears_motion(motion, margin, resolution);
    let again = query.clears_motion(motion, margin, resolution);
    assert_eq!(format!("{again:?}"), format!("{answer:?}"));
    let Ok(answer) = answer else { return };
    let problem = || format!("{answer:?} {margin:e}\n{:?}", [shape(0.0), shape(1.0)]);
    let nearest = |t: f64| {
        let (chain, _) = shape(t)?;
        let found = SelfQuery::new().minimum(&chain).ok()??;
        let turned =
            chain.links().iter().map(|link| link.radius() / link.length().max(f64::MIN_POSITIVE));
        Some((found, slack(turned.fold(0.0, f64::max))))
    };
    if let Some(contact) = answer.contact {
        assert!(contact.upper <= margin && (0.0..=1.0).contains(&contact.t), "{}", problem());
        if let Some((found, slack)) = nearest(contact.t) {
            assert!(found.distance <= contact.upper + slack, "{found:?} {}", problem());
        }
    }
    let clear_until = if answer.is_clear() { 2.0 } else { answer.interval[0] };
    for t in (0..=TIMES).map(|k| f64::from(k) / f64::from(TIMES)).filter(|&t| t < clear_until) {
        let Some((found, slack)) = nearest(t) else { continue };
        // Links with more joints between them keep the margin by their local minima only.
        let is_few = found.links[1] - found.links[0] <= 3;
        assert!(!is_few || found.distance > margin - slack, "{found:?} at {t} {}", problem());
    }
}

fn check<M: Motion>(
    source: &mut Source,
    mut search: BvhSearch,
    mesh: &TriMesh,
    motion: &M,
    shape: impl Fn(f64) -> Option<(Chain, Pose)>,
) {
    let shape: Shape<'_> = &shape;
    let Ok(mut exact) = BvhSearch::new(mesh) else { return };
    // The distance, and the error of a rim where rounding turns a link that is shorter than thick.
    let mut distance_and_rim = |t: f64| {
        let (chain, pose) = shape(t)?;
        let turned =
            chain.links().iter().map(|link| link.radius() / link.length().max(f64::MIN_POSITIVE));
        let rim = turned.fold(0.0, f64::max);
        exact.minimum(&chain, &pose).ok().map(|found| (found.distance, rim))
    };
    let Some((start, _)) = distance_and_rim(0.0) else { return };
    let (vertices, indices) = (mesh.vertices(), mesh.indices());
    let ends = [shape(0.0), shape(1.0)];
    let problem = || format!("\n{ends:?}\n{vertices:?} {indices:?}");
    let length = shape(0.0).map_or(1.0, |(chain, _)| Tube::from(&chain).length());
    // Intermediate poses are rounded.
    let largest = vertices.iter().map(|vertex| vertex.abs().max_element()).fold(length, f64::max);
    let slack = |rim: f64| (1e-12 + 1e-14 * rim) * largest;
    assert_eq!(verify_motion(motion, 7), Ok(()), "its own speed is refused{}", problem());
    let margin = match source.below(6) {
        0 => 0.0,
        1 => start,
        2 => start.next_down().max(0.0),
        3 => 0.999 * start,
        4 => f64::INFINITY,
        _ => source.number().abs(),
    };
    let resolution = length * [1e-1, 1e-2, 1e-3][source.below(3)];
    beside_itself(motion, shape, margin, resolution, slack);
    let answer = search.clears_motion(motion, margin, resolution);
    let first = search.time_of_contact(motion, margin, resolution);
    // Compared as text, in which NaN equals NaN.
    let again = [
        search.clears_motion(motion, margin, resolution),
        search.time_of_contact(motion, margin, resolution),
    ];
    assert_eq!(
        format!("{again:?}"),
        format!("{:?}", [&answer, &first]),
        "asked again{}",
        problem()
    );
    // The time until which the answer claims clearance.
    let clear_until = [
        match &answer {
            Ok(MotionAnswer { decision: Decision::Clear, .. }) => Some(2.0),
            Ok(MotionAnswer { contact: Some(shape), .. }) => {
                let (t, upper) = (shape.t, shape.upper);
                assert!(
                    (0.0..=1.0).contains(&t) && upper <= margin,
                    "{answer:?} {margin}{}",
                    problem()
                );
                let there = distance_and_rim(t);
                assert!(
                    there.is_none_or(|(there, rim)| there <= upper + slack(rim)),
                    "{there:?} {answer:?}{}",
                    problem()
                );
                None
            }
            Ok(MotionAnswer { interval, .. }) => Some(interval[0]),
            _ => None,
        },
        match &first {
            Ok(MotionAnswer { decision: Decision::Clear, .. }) => Some(2.0),
            Ok(MotionAnswer { interval: [clear_until, t], contact: Some(shape), .. }) => {
                let is_right = clear_until <= t && *t == shape.t && shape.upper <= margin;
                assert!(is_right, "{first:?} {margin}{}", problem());
                Some(*clear_until)
            }
            Ok(MotionAnswer { interval, .. }) => Some(interval[0]),
            _ => None,
        },
    ];
    for k in 0..=TIMES {
        let t = f64::from(k) / f64::from(TIMES);
        let Some((there, rim)) = distance_and_rim(t) else { continue };
        for clear_until in clear_until.into_iter().flatten().filter(|&until| t < until) {
            let is_clear = there > margin - slack(rim);
            assert!(is_clear, "{there} at {t}, clear of {margin} until {clear_until}{}", problem());
        }
    }
    let decisions = [answer, first].map(|answer| answer.map(|answer| answer.decision));
    let contradict = decisions == [Ok(Decision::Clear), Ok(Decision::Contact)]
        || decisions == [Ok(Decision::Contact), Ok(Decision::Clear)];
    assert!(!contradict, "{answer:?} {first:?}{}", problem());
}
