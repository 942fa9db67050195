//! Whether a motion keeps to the speeds that it states, and to the courses.
//!
//! A single fine step shows little. A point between samples is known only to their deviation, and every point only to the
//! stated error; in a short time a motion of any speed stays within that. So shapes far apart in time are compared too: 1, 2,
//! 4 and more steps apart, and with the first shape. The ways that were stated for the steps between them add up, and what is
//! unknown of the two shapes counts once.
//!
//! A course is compared with three shapes: those at both ends of its time, and the one at its middle, where what moves at a constant
//! acceleration is farthest off.

use super::sampled::{Moved, Sampled, SampledPlace, places};
use super::{Motion, Sections, rigid_pose};
use crate::distance::Scalar;
use crate::robot::{RobotError, Tube};
use parry3d_f64::math::Real;

/// Checks the speeds and the courses that a motion states, by its shapes at `steps` even steps of its time. Call it in your tests.
///
/// Points are compared at nine places in each section, and at its samples. From one shape to the next no point may move
/// farther than the stated speed allows, and no direction may turn more. The same holds for shapes that are 2, 4, 8 and more
/// steps apart, and for each shape and the first. A bound that is too low only for a moment, or only between two places, shows
/// if the steps are fine enough. Steps cannot be too fine.
///
/// A stated course ([`Motion::course`]) is compared with the shapes at the ends of its time and at its middle, between steps and
/// between shapes that are 2, 4, 8 and more steps apart: at each place alone, and at each as a part of the whole section.
///
/// Some of what moves may be an error of the shapes, which does not count against the motion:
///
/// - the error that the tube states for itself ([`Tube::with_error`](crate::Tube::with_error)), twice;
/// - between samples, how far the curve may be from the lines between them. This is 0 at samples that keep their shares of
///   the section, and where the curve is a function.
///
/// A speed that is too low is found if it makes a larger difference than these, at some place, from some shape to a later
/// one.
///
/// # Errors
/// The first time and place at which the motion is faster than stated, with both speeds, or farther off its course; a shape that cannot be made; or
/// sections that change.
///
/// ```
/// use parry_continuum::{Motion, RobotError, Speed, Tube, parry::math::{Pose, Real, Vector}, verify_motion};
///
/// struct Sideways;
///
/// impl Motion for Sideways {
///     fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
///         tube.set_samples(&[Vector::ZERO, Vector::Z], &[0.1], None)?;
///         Ok(Pose::from_translation(Vector::X * t))
///     }
///     fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
///         Speed { point: 0.9, turn: 0.0 } // it moves by 1
///     }
/// }
///
/// assert!(matches!(verify_motion(&Sideways, 10), Err(RobotError::FasterThanStated { stated: 0.9, .. })));
/// ```
pub fn verify_motion(motion: &impl Motion, steps: u32) -> Result<(), RobotError> {
    let steps = steps.max(1);
    let (mut tube, mut sections, mut here) = (Tube::empty(), Sections::default(), Sampled::default());
    let (mut all, mut stated) = (Vec::new(), Vec::new());
    // The first shape; then the last one of every step, of every second one, of every fourth and so on.
    let mut kept = Vec::<Sampled>::new();
    for step in 0..=steps {
        let t = Real::from(step) / Real::from(steps);
        tube.forget_error();
        let pose = rigid_pose("motion", &motion.shape(t, &mut tube)?)?;
        sections.check(t, &tube)?;
        if step == 0 {
            all = places(&tube);
        }
        here.take(t, &tube, &pose, &all);
        if step > 0 {
            let times = [Real::from(step - 1) / Real::from(steps), t];
            stated.clear();
            stated.extend(all.iter().map(|place| way_and_angle(motion, place, times)));
            kept.iter_mut().for_each(|before| before.add(&stated));
            // Those of every 2^k steps, if this is one, and the first.
            let met = 2 + step.trailing_zeros() as usize;
            for before in kept.iter().take(met) {
                check(before, &here, &all, motion)?;
            }
            for steps in 1..met {
                let middle = (steps > 1).then(|| &kept[steps - 1]);
                check_courses([&kept[steps], &here], middle, &all, motion)?;
            }
        }
        let due = if step == 0 { 2 + steps.ilog2() as usize } else { 2 + step.trailing_zeros() as usize };
        kept.resize_with(kept.len().max(2 + steps.ilog2() as usize), Sampled::default);
        let first = usize::from(step > 0);
        for before in kept.iter_mut().take(due).skip(first) {
            before.clone_from(&here);
        }
    }
    Ok(())
}

/// How far a place may move, and by how much it may turn, between two times.
fn way_and_angle(motion: &impl Motion, place: &SampledPlace, times: [Real; 2]) -> [Real; 2] {
    let speed = motion.speed(place.section, place.shares, times);
    let apart = times[1] - times[0];
    [speed.point * apart, speed.turn * apart]
}

/// # Errors
/// Something moved faster than stated on the way from an earlier shape to a later one.
fn check(
    before: &Sampled,
    here: &Sampled,
    places: &[SampledPlace],
    motion: &impl Motion,
) -> Result<(), RobotError> {
    let times = [before.t, here.t];
    let (t, apart) = (0.5 * (times[0] + times[1]), times[1] - times[0]);
    for (number, place) in places.iter().enumerate() {
        let Some(Moved { way, angle }) = before.moved(here, number) else { continue };
        let (whole, steps) = (way_and_angle(motion, place, times), before.stated(number));
        // Sums of fewer than 2^32 terms above 0, each of which has a few roundings.
        let up = 1.0 + 2.0_f64.powi(34) * Real::UNIT_ROUNDOFF;
        let &SampledPlace { section, shares: [share, _] } = place;
        for (moved, [whole, steps], is_turn) in
            [(way, [whole[0], steps[0]], false), (angle, [whole[1], steps[1]], true)]
        {
            // Written so that NaN is too low.
            let is_kept = |stated: Real| moved <= stated * up;
            if is_kept(whole) && is_kept(steps) {
                continue;
            }
            let stated = if is_kept(whole) { steps } else { whole } / apart;
            let found = moved / apart;
            return Err(if is_turn {
                RobotError::TurnsFasterThanStated { t, section, share, found, stated }
            } else {
                RobotError::FasterThanStated { t, section, share, found, stated }
            });
        }
    }
    Ok(())
}

/// # Errors
/// A place is farther off its course between two shapes than stated, at the last one or at the one in the middle.
fn check_courses(
    [before, here]: [&Sampled; 2],
    middle: Option<&Sampled>,
    places: &[SampledPlace],
    motion: &impl Motion,
) -> Result<(), RobotError> {
    let times = [before.t, here.t];
    for (number, place) in places.iter().enumerate() {
        let &SampledPlace { section, shares: [share, end] } = place;
        let whole = (share == end).then_some([0.0, 1.0]);
        for shares in [Some([share; 2]), whole].into_iter().flatten() {
            let Some(course) = motion.course(section, shares, times) else { continue };
            let way = course.way(if shares[0] < shares[1] { share } else { 0.0 });
            let left = |from: &Sampled, to: &Sampled| {
                let share = (to.t - from.t) / (times[1] - times[0]);
                let (found, off) = from.way(to, number)?;
                Some((found - way * share).length() - off)
            };
            let parts = middle.map(|middle| [left(before, middle), left(middle, here)]);
            for found in parts.into_iter().flatten().chain([left(before, here)]).flatten() {
                // A few roundings of what is stated. Written so that NaN is too far off.
                let stated = course.off;
                let is_kept = found <= stated * (1.0 + 16.0 * Real::UNIT_ROUNDOFF);
                if !is_kept {
                    let t = 0.5 * (times[0] + times[1]);
                    return Err(RobotError::FartherOffThanStated { t, section, share, found, stated });
                }
            }
        }
    }
    Ok(())
}
