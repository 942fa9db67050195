//! How much more the parts of a tube may turn, and move ahead of faces, while the tube moves beside
//! itself.
//!
//! # Definitions
//! - tau: half of an interval of time.
//! - w: a bound on the turning rate. Each direction of the curve is within tau w of its direction
//!   at the middle. The curvature at other times is not bounded: the curve may be wavier.
//! - U: the turn between two places in the shape at the middle.
//!
//! # Claim
//! If U + 6 tau w < pi, two places are no local minimum of the distance at any time of the
//! interval. A face and a place are none if U + 6 tau w < pi / 2.
//!
//! **Proof.** Let x and y be a local minimum at some time, and c the unit vector from x to y. Let T
//! be the directions of the curve between them.
//! 1. Curve and chord form a closed curve. So the T and -c have a weighted mean of 0 with positive
//!    weights. So no vector m has both T . m > 0 for all T and -c . m > 0.
//! 2. Form a closed curve on the sphere of directions. It follows the directions at the middle from
//!    x to y (length U) and goes to T at y (tau w), to -c, to T at x, and back to the start (tau
//!    w). The two angles at -c sum to at most pi, or 3/2 pi if one place is a face
//!    (`query::robots::robot_with_itself`). If x and y coincide there is no c: the angle from T at
//!    y to T at x is at most pi. So the length L of the closed curve is at most U + 2 tau w + pi
//!    (or 3/2 pi).
//! 3. If L < 2 pi, the whole closed curve lies within L / 4 of one point m. Two points halve the
//!    curve, and m is the middle of the arc between them. A half turn around m takes a point z to
//!    z'. While angle(z, m) <= pi / 2, the angle between z and z' is 2 angle(z, m). By way of a
//!    halving point it is at most L / 2. So angle(z, m) <= L / 4 < pi / 2. The angle is continuous
//!    along the curve, so it never exceeds pi / 2.
//! 4. All T are within tau w of the closed curve. If L / 4 + tau w < pi / 2, m is a vector that
//!    step 1 excludes. So U + 6 tau w >= pi (or pi / 2).
//!
//! A pair is therefore kept if its turn is short of the required turn by at most 6 tau w. Two faces
//! that look at one another are kept at any turn, as at rest.
//!
//! # Further bounds
//! **Ahead of a face.** Let c be the centre of the face, n its normal and q the other place. Let d
//! be a bound on the displacement of q relative to c. The normal turns by at most tau w, so (q - c)
//! . n grows by at most d + (|q - c| + d) tau w.
//!
//! **Shortest segments between two convex parts.** The error is as in `tube_with_itself`. The
//! bodies are off by the displacement of both in addition, and the normal by tau w.
//!
//! **w of a pair.** The largest w between two places is replaced by the largest w from the base to
//! the second place, taken per section. So it holds for every pair.
//!
//! # Premises
//! At all times the tube bends by less than 1 / radius, and the joints of a chain are blunt enough.
//! A tested shape that violates this is refused.

use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// If the extra turn of some pair exceeds this in an interval, nearly all pairs of pieces are
/// queried. Half of the turn that faces require.
pub(crate) const MAX_EXTRA_TURN: Real = std::f64::consts::FRAC_PI_4;

/// How far each section moves and turns from the middle of an interval of time.
#[derive(Clone, Debug, Default)]
pub(crate) struct SectionMotions {
    sections: Vec<Section>,
}

/// A bound on the displacement of points and on the turn of directions (rad).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SectionMotion {
    pub points: Real,
    pub turn: Real,
}

#[derive(Clone, Copy, Debug)]
struct Section {
    moved: SectionMotion,
    /// The extra turn of a pair whose second place is in this section.
    growth: Real,
}

impl SectionMotions {
    pub(crate) fn clear(&mut self) {
        self.sections.clear();
    }

    /// Adds the next section.
    pub(crate) fn push(&mut self, moved: SectionMotion) {
        let growth = 6.0 * moved.turn * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        self.sections.push(Section { moved, growth: growth.max(self.max_extra_turn()) });
    }

    pub(crate) fn of(&self, section: u32) -> SectionMotion {
        self.sections[section as usize].moved
    }

    pub(crate) fn extra_turn(&self, section: u32) -> Real {
        self.sections[section as usize].growth
    }

    /// Returns the largest extra turn of any pair.
    pub(crate) fn max_extra_turn(&self) -> Real {
        self.sections.last().map_or(0.0, |last| last.growth)
    }

    /// Returns the section that moves farthest, and the largest displacement of any point.
    pub(crate) fn farthest(&self) -> (usize, Real) {
        let points = self.sections.iter().map(|section| section.moved.points).enumerate();
        points.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most })
    }
}
