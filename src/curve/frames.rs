//! A tube from frames: points of the centreline with the directions of the curve there. The
//! assumption about the curve between two frames is in `hermite_segment`.
//!
//! # Frames taken twice
//! Two frames may be at one place, for example where one section ends and the next begins. The
//! curve arrives in the direction of the first and leaves in the direction of the last. Let q be
//! the difference between the two directions.
//!
//! 1. `q > 2^-16`: refused. The curve would have a corner. The discs between the two directions
//!    would sweep the ball around the point, which no segment and no face accounts for.
//! 2. `q <= 2^-16`: rounding by matrices in single precision. Either direction may be the true one.
//!    Each disc is within `r q` of a disc of the tube, where r is the radius. A segment of length l
//!    that left in the other direction would be off by at most `4/27 q l`, the effect of q in an
//!    end tangent of a cubic. Both count in all bounds, like the gap between the points.

use super::Tube;
use super::hermite_segment::HermiteSegment;
use super::tube_builder::TubeBuilder;
use crate::distance::Scalar;
use crate::robot::{RobotError, check_segments, direction, is_same};
use parry3d_f64::math::{Real, Vector};

/// Largest difference between the directions of two frames at one place.
pub(super) const ONE_DIRECTION: Real = 1.0 / (1_u64 << 16) as Real;

/// Returns the two nearest neighbours of a segment on either side, if there are any.
fn around<'a>(
    number: usize,
    find: impl Fn(usize) -> Option<&'a HermiteSegment>,
) -> [[Option<&'a HermiteSegment>; 2]; 2] {
    let before = number.checked_sub(1).and_then(&find);
    let far = before.and(number.checked_sub(2)).and_then(&find);
    let behind = find(number + 1);
    [[before, far], [behind, behind.and_then(|_| find(number + 2))]]
}

impl Tube {
    /// Builds the tube around a smooth curve through `points` in the directions `tangents`.
    ///
    /// - `points`: places on the centreline, base to tip, in the robot's frame.
    /// - `tangents`: one direction per point, towards the tip, of any length. A forward kinematics
    ///   computes both.
    /// - `segment_radii`: one radius per segment.
    ///
    /// Directions determine the curve far better than points alone. Fewer points are needed, and
    /// the directions of flat faces are known at steps in radius too.
    ///
    /// Between two frames the curve may bend as the directions show there and in the neighbouring
    /// segments of the section, or anything in between. Its curvature may jump anywhere. In a
    /// section of one segment the bend changes in one sense only, evenly or in jumps. The bounds of
    /// each answer include the remaining uncertainty, which is nearly zero on an arc. A jump J of
    /// the curvature keeps the bounds about J l^2 / 14 apart in its segment of length l and in the
    /// two next to it; between sections of different radii it has no such effect. A bend
    /// shorter than a segment, or sharper than in its segment and the neighbours, is not covered:
    /// give more frames there.
    ///
    /// Repeated points and equal radii are merged as in [`from_samples`](Self::from_samples). A
    /// frame may be repeated with directions up to 2^-16 rad apart; all bounds include the
    /// difference.
    ///
    /// ```
    /// use parry_continuum::{Tube, parry::math::Vector};
    ///
    /// // An arc of radius 20, by three frames.
    /// let angles = [0.0_f64, 0.3, 0.6];
    /// let points = angles.map(|a| Vector::new(1.0 - a.cos(), 0.0, a.sin()) * 20.0);
    /// let tangents = angles.map(|a| Vector::new(a.sin(), 0.0, a.cos()));
    /// let tube = Tube::from_frames(&points, &tangents, &[0.5; 2])?;
    /// assert!((tube.length() - 12.0).abs() < 1e-3);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    ///
    /// # Errors
    /// - As [`from_samples`](Self::from_samples);
    /// - a wrong number of tangents, or a tangent that is zero or not finite;
    /// - two frames at one place with different directions: the curve would have a corner.
    pub fn from_frames(
        points: &[Vector],
        tangents: &[Vector],
        segment_radii: &[Real],
    ) -> Result<Self, RobotError> {
        let mut tube = Self::empty();
        check_segments(points, segment_radii)?;
        if tangents.len() != points.len() {
            return Err(RobotError::TangentsDiffer {
                points: points.len(),
                tangents: tangents.len(),
            });
        }
        let directions: Vec<_> = tangents.iter().map(|&tangent| direction(tangent)).collect();
        let is_bad = |tangent: &Vector| !tangent.is_finite() || *tangent == Vector::ZERO;
        if let Some(index) = directions.iter().position(is_bad) {
            return Err(RobotError::BadTangent {
                parameter: "tangents",
                index,
                value: tangents[index],
            });
        }
        // At a size near 1, squares of lengths neither overflow nor underflow.
        let reach =
            points.iter().fold(0.0, |reach: Real, point| point.abs().max_element().max(reach));
        let scale = reach.power_of_two_to_unity();
        let reach = reach * scale;
        let (rounding, one_place) =
            (4.0 * Real::UNIT_ROUNDOFF * reach, 32.0 * Real::UNIT_ROUNDOFF * reach);
        let (mut arches, mut last, mut gap) = (Vec::<HermiteSegment>::new(), 0, 0.0);
        let (mut leaving, mut most_turn): (_, Real) = (directions[0], 0.0);
        let (mut widest, mut longest): (Real, Real) = (0.0, 0.0);
        for (k, &radius) in segment_radii.iter().enumerate() {
            let (ends, arriving) =
                ([points[last] * scale, points[k + 1] * scale], directions[k + 1]);
            widest = widest.max(radius);
            let apart = (ends[1] - ends[0]).length();
            longest = longest.max(apart);
            if apart <= one_place {
                let turn = (arriving - directions[last]).length();
                if turn > ONE_DIRECTION {
                    let turn = 2.0 * libm::asin((0.5 * turn).min(1.0));
                    return Err(RobotError::TurnsTooSharply { index: k + 1, after: last, turn });
                }
                (gap, leaving, most_turn) = (apart.max(gap), arriving, turn.max(most_turn));
                continue;
            }
            arches.extend(HermiteSegment::between(
                k as u32,
                radius,
                ends,
                [leaving, arriving],
                rounding + gap,
            ));
            (last, leaving) = (k + 1, arriving);
        }
        let unscale = 1.0 / scale;
        let curve = std::mem::take(&mut tube.curve);
        let mut builder = TubeBuilder::begin(curve, std::mem::take(&mut tube.sections), points[0]);
        let mut stretch: Real = 1.0;
        for (number, arch) in arches.iter().enumerate() {
            let own = |k: usize| arches.get(k).filter(|other| is_same(arch.radius, other.radius));
            let any = |k: usize| arches.get(k);
            // A section of one segment uses the neighbours of other sections.
            let neighbours = around(number, own);
            let is_section = neighbours.iter().all(|side| side[0].is_none());
            let neighbours = if is_section { around(number, any) } else { neighbours };
            let known =
                arch.bound(arch.ball(neighbours), is_section, rounding + gap).map_err(|turn| {
                    let after = arch.segment as usize;
                    RobotError::TurnsTooSharply { index: after + arch.sharper_end(), after, turn }
                })?;
            stretch = stretch.max(known.stretch);
            let end = arches.get(number + 1).map_or(points[last] * scale, |next| next.start);
            builder.lay(
                arch.segment,
                arch.radius,
                arch.tangents,
                arch.points(known.bound, end, unscale),
            );
        }
        // 0.15 covers 4/27 and the excess of a segment's length over its chord.
        let turned = most_turn * (widest + 0.15 * longest * unscale);
        builder.finish(&mut tube, 0.0, stretch, gap * unscale + turned)?;
        Ok(tube)
    }
}
