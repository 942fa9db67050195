//! A tube fitted to measured points.
//!
//! # Algorithm
//! 1. **Merge** consecutive points that are much closer to one another than most, and much closer
//!    than the deviation. They share one knot at their mean. Otherwise the shortest of 100,000
//!    distances would cost the spline all its digits.
//! 2. **Parameter.** The length of the polyline. Noise makes it far too long if points are dense,
//!    so steps 3 and 2 repeat with the lengths of the last spline ([`PASSES`] parameters in all).
//! 3. **Smooth.** A smoothing spline near the points; cross-validation chooses the weight (`best`).
//! 4. **Draw near.** If the spline is farther from a point than the stated deviation, forces draw
//!    it near (`within`).
//! 5. **Lay** the tube along the spline (`lay`).
//!
//! The number of splines does not depend on the points. Each takes time proportional to their
//! number.
//!
//! # What the bounds cover
//! All tubes whose centreline is within the deviation of the fitted one, point by point. Directions
//! are unknown.
//!
//! 1. **From outside.** For every direction a disc lies in the ball of its radius around its
//!    centre. So bodies around balls, enlarged by the deviation, contain the tube.
//! 2. **From inside.** Let q be the centreline's point nearest to x. Unless q is an end of its
//!    section, x lies in the plane of the disc at q, at most `|x - q| - r` away from it. And
//!    `|x - q|` is at most the deviation more than the distance of x from any point of the fitted
//!    curve. If q may be an end, its centre is still a point of the tube.
//! 3. **Flat faces.** Only here is the direction missed: the bounds are a radius apart. This is the
//!    cost of an unstated direction.
//!
//! With a stated `turn`, every direction near a face is within it of the fitted direction. The
//! derivation of bodies at a face then holds with the tilt `turn` (`refine::bounding_body`).

use super::Tube;
use super::centreline::NextPoint;
use super::curve_bound::CurveBound;
use super::section::stretch;
use super::smoothing_spline::{Knots, Smoother, SmoothingSpline};
use super::tube_builder::TubeBuilder;
use crate::distance::Scalar;
use crate::robot::{RobotError, check_segments, direction};
use parry3d_f64::math::{Real, Vector};

/// Least distance of knots, as a share of their mean distance.
const CLOSEST: Real = 1.0 / (1 << 20) as Real;

/// Points closer than this share of the mean distance are merged.
const CLOSE: Real = 1.0 / (1 << 10) as Real;

/// Number of parameters, each from the lengths of the previous spline.
const PASSES: u32 = 3;

/// Most steps of the search for forces per weight, and most weights.
const MAX_STEPS: u32 = 200;
const MAX_SOFTENED: u32 = 32;

/// Forces draw a point to this share of the deviation.
const WANTED: Real = 1.0 - 1.0 / 64.0;

/// The steps of the search for forces after which its pace is judged. Measured on noisy lines
/// and helices: 8 steps are as fast, 32 steps are 20 % slower.
const STEPS_OF_PACE: u32 = 16;

/// Most parts into which a segment is laid.
const MAX_PARTS: u32 = 64;

impl Tube {
    /// Fits the tube around a smooth curve within `deviation` of each of the measured `points`.
    ///
    /// - `points`: base to tip, in the robot's frame. They may be dense and may repeat.
    /// - `segment_radii`: one radius per segment. Steps in radius stay at their points.
    /// - `deviation`: the largest error of a point, for example five times the standard deviation
    ///   of a sensor, in the unit of the points.
    ///
    /// All bounds hold for every tube whose centreline is within `deviation` of the fitted one,
    /// point by point, with any shape in between. So they hold for the robot if it is within
    /// `deviation` of the curve that you see.
    ///
    /// Flat faces also depend on the centreline's direction. Unless it is stated by
    /// [`with_turn`](Self::with_turn), the lower bound takes a face for a ball and the upper bound
    /// takes it for its centre. So the two stay a radius apart there. Deviation and unknown
    /// direction are part of an answer's `uncertainty`, not of the tolerance.
    ///
    /// The curve is a cubic smoothing spline whose smoothness cross-validation chooses (see the
    /// source for references). [`residual`](Self::residual) is its distance from the points.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::math::Vector};
    ///
    /// let noise = |k: i32| {
    ///     Vector::new(f64::sin(f64::from(k * k)), f64::cos(f64::from(k * k)), 0.0) * 0.02
    /// };
    /// let points: Vec<_> =
    ///     (0..200).map(|k| Vector::Z * (f64::from(k) * 0.2) + noise(k)).collect();
    /// let tube = Tube::fit(&points, &[0.5; 199], 0.1)?;
    /// assert!(tube.residual() <= 0.1 && (tube.length() - 39.8).abs() < 0.1);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    ///
    /// # Errors
    /// - As [`Chain::from_centreline`](crate::Chain::from_centreline);
    /// - a deviation that is negative or not finite;
    /// - points so far apart that the curve within the deviation could turn by more than 1 rad in a
    ///   64th of the way from one to the next.
    pub fn fit(
        points: &[Vector],
        segment_radii: &[Real],
        deviation: Real,
    ) -> Result<Self, RobotError> {
        check_segments(points, segment_radii)?;
        if !(0.0..Real::INFINITY).contains(&deviation) {
            return Err(RobotError::Negative { parameter: "deviation", value: deviation });
        }
        // At a size near 1 around the first point, squares of lengths neither overflow nor
        // underflow.
        let origin = points[0];
        let reach = points
            .iter()
            .fold(0.0, |most: Real, point| (*point - origin).abs().max_element().max(most));
        if reach.is_nan() || reach <= 0.0 {
            return Err(RobotError::AllPointsEqual);
        }
        let (scale, largest) = (
            reach.power_of_two_to_unity(),
            points.iter().fold(0.0, |most: Real, point| point.abs().max_element().max(most)),
        );
        let near: Vec<_> = points.iter().map(|&point| (point - origin) * scale).collect();
        let spline = smooth(&near, segment_radii, deviation * scale);
        let mut tube = Self::empty();
        tube.residual = spline.largest_residual(&near) / scale;
        let rounding = 16.0 * Real::UNIT_ROUNDOFF * largest;
        lay(&mut tube, &spline, segment_radii, origin, scale, deviation * scale, rounding)?;
        tube.deviation = deviation;
        Ok(tube)
    }
}

/// Steps 1 to 4 for points scaled near 1.
pub(super) fn smooth(points: &[Vector], radii: &[Real], deviation: Real) -> SmoothingSpline {
    let merged = Merged::of(points, radii, deviation);
    let means = &merged.means;
    let mut knots = merged.knots_apart(means.windows(2).map(|pair| (pair[1] - pair[0]).length()));
    for _ in 1..PASSES {
        let (spline, _) = best(&knots, &merged);
        // The lengths of the spline between its knots, from two chords each.
        knots = merged.knots_apart((0..means.len() - 1).map(|k| {
            let middle = spline.at(k, 0.5)[0];
            (middle - spline.values[k]).length() + (spline.values[k + 1] - middle).length()
        }));
    }
    let (spline, weight) = best(&knots, &merged);
    merged.spread(within(deviation - merged.largest, spline, &knots, means, weight))
}

/// The points, where consecutive ones that are close to one another are merged (step 1).
struct Merged {
    means: Vec<Vector>,
    counts: Vec<Real>,
    /// The largest distance of a point from its mean, and the sum of all squared distances.
    largest: Real,
    scatter: Real,
}

impl Merged {
    /// The segments between merged points vanish. So their radii must equal the radii of the
    /// segments before or behind them.
    fn of(points: &[Vector], radii: &[Real], deviation: Real) -> Self {
        let length: Real = points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum();
        let mean = length / (points.len() - 1) as Real;
        let close = (CLOSE * mean).min(deviation / 64.0);
        let mut merged = Self { means: Vec::new(), counts: Vec::new(), largest: 0.0, scatter: 0.0 };
        let mut from = 0;
        while let Some(first) = points.get(from) {
            let is_far = |point: &Vector| (*point - *first).length() > close;
            let near = points[from..].iter().position(is_far).unwrap_or(points.len() - from);
            let around = [from.checked_sub(1), Some(from + near - 1)];
            let around = around.map(|segment| radii.get(segment?));
            let inner = &radii[from..from + near - 1];
            let can_merge = inner.iter().all(|radius| around.contains(&Some(radius)));
            let group = &points[from..from + if can_merge { near } else { 1 }];
            from += group.len();
            let count = group.len() as Real;
            let offset = group.iter().map(|point| *point - *first).sum::<Vector>() / count;
            let mean = *first + offset;
            for point in group.iter().filter(|_| group.len() > 1) {
                let away = (*point - mean).length();
                merged.largest = merged.largest.max(away);
                merged.scatter += away * away;
            }
            merged.means.push(mean);
            merged.counts.push(count);
        }
        merged
    }

    /// Returns ascending knots with these distances, each at least [`CLOSEST`] of their mean.
    fn knots_apart(&self, lengths: impl Iterator<Item = Real> + Clone) -> Knots {
        let (sum, count) =
            lengths.clone().fold((0.0, 0), |(sum, count), length| (sum + length, count + 1));
        let least = CLOSEST * sum / Real::from(count);
        let mut places = vec![0.0];
        let mut last = 0.0;
        places.extend(lengths.map(|length| {
            last += length.max(least);
            last
        }));
        Knots { places, counts: self.counts.clone() }
    }

    /// Returns the spline with one knot per point again.
    fn spread(&self, spline: SmoothingSpline) -> SmoothingSpline {
        fn each<T: Copy>(counts: &[Real], all: &[T]) -> Vec<T> {
            let repeat = |(one, count): (&T, &Real)| std::iter::repeat_n(*one, *count as usize);
            all.iter().zip(counts).flat_map(repeat).collect()
        }
        let SmoothingSpline { knots, values, seconds } = &spline;
        SmoothingSpline {
            knots: each(&self.counts, knots),
            values: each(&self.counts, values),
            seconds: each(&self.counts, seconds),
        }
    }
}

/// Returns the spline with the best score, and its weight (step 3).
fn best(knots: &Knots, merged: &Merged) -> (SmoothingSpline, Real) {
    let weights = Weights::of(&knots.places);
    let score = |step| Smoother::new(knots, weights.at(step)).score(&merged.means, merged.scatter);
    let weight = weights.at(weights.best(score));
    (Smoother::new(knots, weight).spline(&merged.means), weight)
}

/// Returns the spline if it is within the deviation of each point, otherwise approximately the
/// smoothest spline that is (step 4).
///
/// That spline minimises the same sum under the condition that each residual is short enough. The
/// condition acts like a force on each point that is too far away: the result is the spline of the
/// points moved by the forces. As a function of the forces, the minimum has the residual as its
/// gradient, which changes by at most as much as the forces. So the forces are found by accelerated
/// gradient steps (A. Beck, M. Teboulle, SIAM Journal on Imaging Sciences 2, 2009), each shortened
/// by the admissible residual.
///
/// **Giving up a weight.** The residual converges to [`WANTED`] of the deviation, and usually as a
/// geometric sequence: its excess shrinks by a factor each step. If the excess would not be gone
/// after [`MAX_STEPS`] at the pace so far, a softer spline is tried at once. This choice decides
/// which spline is found, never whether it is within the deviation.
fn within(
    deviation: Real,
    mut spline: SmoothingSpline,
    knots: &Knots,
    points: &[Vector],
    mut weight: Real,
) -> SmoothingSpline {
    if spline.largest_residual(points) <= deviation {
        return spline;
    }
    let wanted = deviation * WANTED;
    let (mut forces, mut ahead) =
        (vec![Vector::ZERO; points.len()], vec![Vector::ZERO; points.len()]);
    for _ in 0..MAX_SOFTENED {
        let smoother = Smoother::new(knots, weight);
        // A softer spline yields to smaller forces. On a far too stiff spline, forces cause jerks
        // only.
        weight /= 16.0;
        smoother.fill(points.iter().copied(), &mut spline);
        let begun = spline.largest_residual(points);
        if begun > 4.0 * deviation {
            continue;
        }
        forces.fill(Vector::ZERO);
        ahead.fill(Vector::ZERO);
        let (mut pace, mut least): (Real, Real) = (1.0, begun);
        for step in 0..MAX_STEPS {
            let moved = points.iter().zip(&ahead).map(|(point, force)| *point + *force);
            smoother.fill(moved, &mut spline);
            let residual = spline.largest_residual(points);
            if residual <= deviation {
                return spline;
            }
            least = least.min(residual);
            if step % STEPS_OF_PACE == STEPS_OF_PACE - 1
                && is_too_slow(
                    [begun, least].map(|residual| residual - wanted),
                    step + 1,
                    deviation,
                )
            {
                break;
            }
            let next_pace = 0.5 * (1.0 + (1.0 + 4.0 * pace * pace).sqrt());
            let onward = (pace - 1.0) / next_pace;
            pace = next_pace;
            let both = points.iter().zip(&spline.values);
            for ((force, ahead), (point, value)) in forces.iter_mut().zip(&mut ahead).zip(both) {
                let pulled = *ahead + *point - *value;
                let size = pulled.length();
                let next =
                    if size > wanted { pulled * (1.0 - wanted / size) } else { Vector::ZERO };
                *ahead = next + (next - *force) * onward;
                *force = next;
            }
        }
    }
    Smoother::new(knots, 0.0).spline(points)
}

/// Returns whether an excess, which shrank from the first to the second number in `steps`, remains
/// too large after [`MAX_STEPS`] at this pace.
fn is_too_slow([begun, left]: [Real; 2], steps: u32, deviation: Real) -> bool {
    let share = libm::pow(left / begun, Real::from(MAX_STEPS) / Real::from(steps));
    begun * share > (1.0 - WANTED) * deviation
}

/// The weights that are tried: from a spline that follows each point to a straight line, in even
/// steps of their logarithm.
struct Weights {
    spacing: Real,
    shortest: Real,
    longest: Real,
}

impl Weights {
    const STEPS: u32 = 20;

    fn of(knots: &[Real]) -> Self {
        let length = knots[knots.len() - 1];
        let spacing = length / (knots.len() - 1) as Real;
        Self { spacing, shortest: 0.3 * spacing, longest: 2.0 * length }
    }

    /// Returns the weight at a step. A spline levels features shorter than
    /// `(weight spacing)^(1/4)`.
    fn at(&self, step: Real) -> Real {
        let Self { spacing, shortest, longest } = self;
        let over =
            shortest * libm::exp2(libm::log2(longest / shortest) * step / Real::from(Self::STEPS));
        over * over * (over * over / spacing)
    }

    /// Returns the step with the least score, to 1/16.
    fn best(&self, score: impl Fn(Real) -> Real) -> Real {
        let mut best = (Real::INFINITY, 0.0);
        let mut take = |step: Real| {
            let score = score(step);
            if score < best.0 {
                best = (score, step);
            }
            best.1
        };
        let mut at = 0.0;
        for step in 0..=Self::STEPS {
            at = take(Real::from(step));
        }
        for apart in [0.5, 0.25, 0.125, 0.0625] {
            let middle = at;
            take(middle - apart);
            at = take(middle + apart);
        }
        at
    }
}

/// Lays the tube along the spline (step 5).
///
/// # Errors
/// The tube turns by more than 1 rad within a part, or bends within its radius next to a face.
fn lay(
    tube: &mut Tube,
    spline: &SmoothingSpline,
    radii: &[Real],
    origin: Vector,
    scale: Real,
    deviation: Real,
    rounding: Real,
) -> Result<(), RobotError> {
    let place = |point: Vector| origin + point * (1.0 / scale);
    let curve = std::mem::take(&mut tube.curve);
    let mut builder =
        TubeBuilder::begin(curve, std::mem::take(&mut tube.sections), place(spline.values[0]));
    // Chords leave the curve by little compared with the deviation.
    let target = (deviation / 64.0).max(2.0_f64.powi(-24));
    let (mut stretched, mut gap): (Real, Real) = (1.0, 0.0);
    let mut last = spline.values[0];
    for (k, &radius) in radii.iter().enumerate() {
        let h = spline.knots[k + 1] - spline.knots[k];
        let bend = spline.seconds[k].length().max(spline.seconds[k + 1].length());
        let chord = (spline.values[k + 1] - spline.values[k]).length();
        let wanted = (h * (bend / (8.0 * target)).sqrt()).max(2.0 * h * bend).ceil();
        let parts = (wanted as u32).clamp(1, MAX_PARTS);
        let mut next = Vec::new();
        for part in 0..parts {
            let [from, to] = [part, part + 1].map(|part| Real::from(part) / Real::from(parts));
            let point = if part + 1 == parts { spline.values[k + 1] } else { spline.at(k, to)[0] };
            let length = (point - last).length();
            if length <= 2.0 * rounding * scale {
                gap = gap.max(length);
                continue;
            }
            let most = [from, to]
                .map(|share| {
                    (spline.seconds[k] * (1.0 - share) + spline.seconds[k + 1] * share).length()
                })
                .into_iter()
                .fold(0.0, Real::max);
            let halfway = spline.at(k, 0.5 * (from + to))[1].length();
            // If the spline may stand still, it may turn at once.
            let slowest = (halfway - 0.5 * most * h / Real::from(parts)).max(0.0);
            let curvature =
                if most > 0.0 { most / (slowest * slowest) * (1.0 + 1e-12) } else { 0.0 };
            let turn = curvature * length;
            // Written so that NaN is too much.
            if turn.is_nan() || turn > 1.0 {
                return Err(RobotError::TurnsTooSharply { index: k, after: k, turn });
            }
            stretched = stretched.max(stretch(turn));
            next.push(NextPoint {
                point: place(point),
                length: length / scale,
                bound: CurveBound { curvature: curvature * scale, off: rounding },
            });
            last = point;
        }
        if next.is_empty() {
            gap = gap.max(chord);
            continue;
        }
        let ends = [0.0, 1.0].map(|share| direction(spline.at(k, share)[1]));
        builder.lay(k as u32, radius, ends, next.into_iter());
    }
    builder.finish(tube, Real::INFINITY, stretched, gap / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An excess that shrinks by a constant factor each step is given up exactly if it is too large
    /// after all steps.
    #[test]
    fn a_search_is_given_up_if_its_pace_leaves_an_excess() {
        let (deviation, begun): (Real, Real) = (0.3, 0.7);
        let allowed = (1.0 - WANTED) * deviation;
        for left in [0.01, 0.5, 0.99, 1.01, 2.0, 50.0] {
            let factor = libm::pow(left * allowed / begun, 1.0 / Real::from(MAX_STEPS));
            for steps in [1, STEPS_OF_PACE, 5 * STEPS_OF_PACE, MAX_STEPS] {
                let now = begun * libm::pow(factor, Real::from(steps));
                assert_eq!(
                    is_too_slow([begun, now], steps, deviation),
                    left > 1.0,
                    "{left} {steps}"
                );
            }
        }
        assert!(is_too_slow([begun, begun], STEPS_OF_PACE, deviation), "no progress");
    }
}
