//! Tests whether a motion fulfils the speeds and displacements that it states.
//!
//! # Algorithm
//! 1. **Sample** the shapes at even steps of time.
//! 2. **Compare** each shape with the previous one, with the shapes 2, 4, 8, ... steps earlier, and
//!    with the first. A single fine step shows little: points are known up to the stated error and
//!    the samples' deviation, and in a short time every motion stays within that. Over many steps
//!    the stated displacements add up, while the uncertainty of the two shapes counts once.
//! 3. **Ranges.** A bound holds for every place of the range for which it is stated. So each place
//!    is compared with the least bound over many ranges that contain it: the place alone, `[0, s]`,
//!    `[s, 1]`, the dyadic ranges at [`LEVELS`] levels, and one drawn range per step. A bound that
//!    considers one end of its range only is too low for some of them.
//! 4. **Common frame.** If the motion states a frame, each shape is also compared with the earlier
//!    one that the frame carries along. Only the speeds that are stated relative to the frame may
//!    remain.
//! 5. **Displacements.** A stated displacement is compared with three shapes: at both ends of its
//!    time, and at the middle, where a point of constant acceleration is farthest from it.

use super::rigid_path::rigid_pose;
use super::sampled_shape::{PlaceMotion, SampledPlace, SampledShape, places};
use super::{CommonFrame, Motion, SectionSignature, Speed};
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::RobotError;
use parry3d_f64::math::Real;

/// Tests the speeds and displacements that a motion states, at `steps` even steps of its time.
///
/// Call it in your tests. Finer steps are never harmful.
///
/// Points are compared at nine places in each section, and at its samples. From one shape to the
/// next, no point may move farther than the stated speed allows, and no direction may turn more.
/// The same holds for shapes that are 2, 4, 8 and more steps apart, and for each shape and the
/// first. A bound that is too low only for a moment, or only between two places, shows if the steps
/// are fine enough.
///
/// A stated speed holds for every place of its range of shares. So each place s is tested with
/// several ranges that contain it: s alone, \[0, s\], \[s, 1\], \[0, 1\], the halves, quarters and
/// eighths of the section, and one drawn range per step, the same in every run. The least of these
/// bounds counts, and the error names it.
///
/// A stated displacement ([`Motion::displacement`]) is compared with the shapes at the ends of its
/// time and at its middle. The ranges are the same as for speeds; the shapes are 1, 2, 4, 8 and
/// more steps apart.
///
/// A stated frame ([`Motion::common_frame`]) is tested like a speed: relative to the frame no place
/// may move or turn faster than [`Motion::speed_in_frame`] states.
///
/// Part of a measured displacement may be an error of the shapes. It does not count against the
/// motion:
///
/// - the error that the tube states for itself ([`Tube::with_error`](crate::Tube::with_error)),
///   twice;
/// - between samples, the distance of the curve from its chords. It is 0 at samples that keep their
///   shares of the section, and for a function.
///
/// A speed that is too low is found if it exceeds these errors at some place, from some shape to a
/// later one.
///
/// # Errors
/// - the first time and place at which the motion is faster than stated, with both speeds, or
///   farther from its stated displacement;
/// - a shape that cannot be made;
/// - sections that change.
/// ```
/// use parry_continuum::parry::math::{Pose, Real, Vector};
/// use parry_continuum::{Motion, RobotError, Speed, Tube, verify_motion};
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
/// assert!(matches!(
///     verify_motion(&Sideways, 10),
///     Err(RobotError::FasterThanStated { stated: 0.9, .. })
/// ));
/// ```
pub fn verify_motion(motion: &impl Motion, steps: u32) -> Result<(), RobotError> {
    verify(motion, steps)
}

fn verify(motion: &dyn Motion, steps: u32) -> Result<(), RobotError> {
    let steps = steps.max(1);
    let (mut tube, mut sections, mut here) =
        (Tube::empty(), SectionSignature::default(), SampledShape::default());
    let (mut all, mut stated) = (Vec::new(), Vec::new());
    let mut ranges = Ranges::default();
    // The first shape, then the last shape of every step, every second, every fourth, and so on.
    let mut kept = Vec::<SampledShape>::new();
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
            ranges.draw();
            let times = [Real::from(step - 1) / Real::from(steps), t];
            ranges.ways_and_angles(motion, &all, times, &mut stated);
            kept.iter_mut().for_each(|before| before.add(&stated));
            // The first shape, and one for each power of two that divides the step.
            let met = 2 + step.trailing_zeros() as usize;
            for before in kept.iter().take(met) {
                let times = [before.t, t];
                ranges.ways_and_angles(motion, &all, times, &mut stated);
                check(before, &here, &all, &stated)?;
                if let Some(frame) = motion.common_frame(times) {
                    let in_frame = |section, shares| motion.speed_in_frame(section, shares, times);
                    ranges.least(in_frame, &all, 1.0, &mut stated);
                    check_in_frame(&frame, before, &here, &all, &stated)?;
                }
            }
            for steps in 1..met {
                let middle = (steps > 1).then(|| &kept[steps - 1]);
                check_courses([&kept[steps], &here], middle, &all, motion, &ranges)?;
            }
        }
        let due =
            if step == 0 { 2 + steps.ilog2() as usize } else { 2 + step.trailing_zeros() as usize };
        kept.resize_with(kept.len().max(2 + steps.ilog2() as usize), SampledShape::default);
        let first = usize::from(step > 0);
        for before in kept.iter_mut().take(due).skip(first) {
            before.clone_from(&here);
        }
    }
    Ok(())
}

/// The ranges of shares for which bounds are requested.
#[derive(Default)]
struct Ranges {
    /// The number of draws.
    drawn: u32,
    /// A drawn range reaches these fractions of the way from a place to either end of the section.
    parts: [Real; 2],
}

/// Dyadic levels: the section in 1, 2, 4 and 8 parts.
const LEVELS: u32 = 4;

impl Ranges {
    /// Draws the range of the next step. The sequence is the same in every run.
    fn draw(&mut self) {
        self.drawn = self.drawn.wrapping_add(1);
        self.parts = [0, 1].map(|end| {
            // The multipliers of SplitMix64, Steele et al. 2014.
            let mut bits = (2 * u64::from(self.drawn) + end).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((bits ^ (bits >> 31)) >> 32) as Real / 2.0_f64.powi(32)
        });
    }

    /// Returns the ranges of a place: the place alone, all before it, all behind it, and the drawn
    /// range. For a chord between two places: the chord alone.
    fn of_place(&self, [from, to]: [Real; 2]) -> impl Iterator<Item = [Real; 2]> + use<> {
        let [before, behind] = self.parts;
        let drawn = [(from * (1.0 - before)).min(from), (to + (1.0 - to) * behind).clamp(to, 1.0)];
        let around = [[0.0, to], [from, 1.0], drawn].into_iter().filter(move |_| from == to);
        std::iter::once([from, to]).chain(around)
    }

    /// Writes for each place the least stated displacement and turn between two times, over all
    /// ranges that contain it.
    fn ways_and_angles(
        &self,
        motion: &dyn Motion,
        places: &[SampledPlace],
        times: [Real; 2],
        out: &mut Vec<[Real; 2]>,
    ) {
        let speed = |section, shares| motion.speed(section, shares, times);
        self.least(speed, places, times[1] - times[0], out);
    }

    /// [`ways_and_angles`](Self::ways_and_angles) for a stated speed, times `apart`.
    fn least(
        &self,
        speed: impl Fn(usize, [Real; 2]) -> Speed,
        places: &[SampledPlace],
        apart: Real,
        out: &mut Vec<[Real; 2]>,
    ) {
        let stated = |section: usize, shares: [Real; 2]| {
            let speed = speed(section, shares);
            [speed.point * apart, speed.turn * apart]
        };
        out.clear();
        let mut dyadic = Vec::new();
        let mut present = None;
        for &SampledPlace { section, shares } in places {
            if present != Some(section) {
                present = Some(section);
                dyadic.clear();
                dyadic.extend(dyadic_ranges().map(|range| (range, stated(section, range))));
            }
            let own = self.of_place(shares).map(|range| stated(section, range));
            let around =
                dyadic.iter().filter(|(range, _)| holds(*range, shares)).map(|(_, stated)| *stated);
            let least = own.chain(around).fold([Real::INFINITY; 2], |least, stated| {
                [0, 1].map(|k| smaller(least[k], stated[k]))
            });
            out.push(least);
        }
    }
}

/// Returns the smaller number; NaN if either is NaN.
fn smaller(a: Real, b: Real) -> Real {
    if a <= b || a.is_nan() { a } else { b }
}

/// Returns the dyadic ranges of a section, level by level.
fn dyadic_ranges() -> impl Iterator<Item = [Real; 2]> {
    (0..LEVELS).flat_map(|level| {
        let count = 1_u32 << level;
        (0..count).map(move |part| [part, part + 1].map(|end| Real::from(end) / Real::from(count)))
    })
}

/// Returns whether a range contains another one.
fn holds(range: [Real; 2], shares: [Real; 2]) -> bool {
    range[0] <= shares[0] && shares[1] <= range[1]
}

/// Compares an earlier shape with a later one (step 2).
///
/// # Errors
/// A place moved or turned faster than stated from the earlier shape to the later one.
fn check(
    before: &SampledShape,
    here: &SampledShape,
    places: &[SampledPlace],
    stated: &[[Real; 2]],
) -> Result<(), RobotError> {
    let times = [before.t, here.t];
    let (t, apart) = (0.5 * (times[0] + times[1]), times[1] - times[0]);
    for (number, (place, &whole)) in places.iter().zip(stated).enumerate() {
        let Some(PlaceMotion { way, angle }) = before.moved(here, number) else { continue };
        let steps = before.stated(number);
        // Covers the rounding of sums of fewer than 2^32 positive terms.
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

/// Compares an earlier shape, carried along by a frame, with a later one (step 4).
///
/// # Errors
/// A place moved or turned relative to the frame faster than stated.
fn check_in_frame(
    frame: &CommonFrame,
    before: &SampledShape,
    here: &SampledShape,
    places: &[SampledPlace],
    stated: &[[Real; 2]],
) -> Result<(), RobotError> {
    let (t, apart) = (0.5 * (before.t + here.t), here.t - before.t);
    for (number, (place, &[point, turn])) in places.iter().zip(stated).enumerate() {
        let Some(PlaceMotion { way, angle }) = before.moved_in(Some(frame), here, number) else {
            continue;
        };
        let Some(from) = before.point(number) else { continue };
        let most = frame.stray(from, apart, Speed { point, turn });
        let up = 1.0 + 64.0 * Real::UNIT_ROUNDOFF;
        for (found, stated, is_turn) in
            [(way / apart, most.point, false), (angle / apart, most.turn, true)]
        {
            // Written so that NaN is too low. A link that loses its length turns at any rate.
            let is_kept = found <= stated * up && (is_turn || point < Real::INFINITY);
            if !is_kept {
                let &SampledPlace { section, shares: [share, _] } = place;
                return Err(RobotError::LeavesFrame { t, section, share, found, stated, is_turn });
            }
        }
    }
    Ok(())
}

/// Compares stated displacements with the shapes at the end and in the middle (step 5).
///
/// # Errors
/// A place is farther from its stated displacement than stated, at the last shape or at the one
/// in the middle.
fn check_courses(
    [before, here]: [&SampledShape; 2],
    middle: Option<&SampledShape>,
    places: &[SampledPlace],
    motion: &dyn Motion,
    ranges: &Ranges,
) -> Result<(), RobotError> {
    let times = [before.t, here.t];
    let mut dyadic = Vec::new();
    let mut present = None;
    for (number, place) in places.iter().enumerate() {
        let &SampledPlace { section, shares: [share, end] } = place;
        if share < end {
            // The chord's start is a place of its own.
            continue;
        }
        if present != Some(section) {
            present = Some(section);
            dyadic.clear();
            dyadic.extend(
                dyadic_ranges().map(|range| (range, motion.displacement(section, range, times))),
            );
        }
        let own = ranges
            .of_place([share; 2])
            .map(|range| (range, motion.displacement(section, range, times)));
        let around = dyadic.iter().copied().filter(|(range, _)| holds(*range, [share; 2]));
        for (shares, bound) in own.chain(around) {
            let Some(bound) = bound else { continue };
            let length = shares[1] - shares[0];
            let way = bound.way(if length > 0.0 { (share - shares[0]) / length } else { 0.0 });
            let left = |from: &SampledShape, to: &SampledShape| {
                let share = (to.t - from.t) / (times[1] - times[0]);
                let (found, off) = from.way(to, number)?;
                Some((found - way * share).length() - off)
            };
            let parts = middle.map(|middle| [left(before, middle), left(middle, here)]);
            for found in parts.into_iter().flatten().chain([left(before, here)]).flatten() {
                // Covers a few roundings. Written so that NaN is too far.
                let stated = bound.off;
                let is_kept = found <= stated * (1.0 + 16.0 * Real::UNIT_ROUNDOFF);
                if !is_kept {
                    let t = 0.5 * (times[0] + times[1]);
                    return Err(RobotError::FartherOffThanStated {
                        t,
                        section,
                        share,
                        found,
                        stated,
                    });
                }
            }
        }
    }
    Ok(())
}
