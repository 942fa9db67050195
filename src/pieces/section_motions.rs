//! By how much more a tube's parts may turn, and come in front of faces, while the tube moves
//! beside itself.
//!
//! Let tau be half of an interval of time, and let each direction of the curve turn by no more than
//! tau w from where it is at the middle. Nothing is stated of the curvature at other times, and the
//! curve may be wavier then. But two places that turn by U between them at the middle, with U + 6
//! tau w < pi, are no local minimum of the distance at any time of the interval; nor are a face and
//! a place with U + 6 tau w < pi / 2.
//!
//! *Proof.* Let x and y be a local minimum at some time, c the unit vector from x to y, and T the
//! directions of the curve between the two.
//!
//! - Curve and chord are a closed curve: the T's and -c have a mean of 0 with positive weights. So
//!   no vector m has T . m > 0 for all T and -c . m > 0.
//! - On the sphere of directions a closed curve leads along the directions at the middle from x to
//!   y, which is U long, to T at y (tau w), to -c, to T at x, and to the direction of x at the
//!   middle (tau w). The two angles at -c are pi together at most, or 3/2 pi where one place is a
//!   face (`query::robots::robot_with_itself`); where x and y are one and there is no c, the way
//!   from T at y to T at x is pi at most. So the closed curve is L <= U + 2 tau w + pi long (or 3/2
//!   pi).
//! - If L < 2 pi, all of that curve lies within L / 4 of one point m, the middle of the arc between
//!   two points that halve it. Turned by pi around m, a point z comes to z', and the two are 2
//!   angle(z, m) apart as long as that angle is at most pi / 2. By way of one of the two halving
//!   points they are at most L / 2 apart. So the angle is at most L / 4 < pi / 2, and, as it
//!   changes evenly along the curve, never more than pi / 2.
//! - All T are within tau w of the curve. If L / 4 + tau w < pi / 2, m is what must not be. So U +
//!   6 tau w >= pi (or pi / 2).
//!
//! So a pair is kept if it turns by that much less than is asked for. Two faces that look at one
//! another are kept at any turn, as at rest.
//!
//! **In front of a face.** The other place q moves from the face's centre c by no more than both
//! move, d, and the normal turns by at most tau w: (q - c) . n grows by no more than d + (|q - c| +
//! d) tau w.
//!
//! **Ways between two convex parts** are as wrong as those of bodies that are farther off by how
//! far both move, with a normal that is off by tau w more (`tube_with_itself`).
//!
//! The largest w between two places is taken from the base on: that of a whole section, so that it
//! holds for every pair.
//!
//! **What is promised.** At all times the tube bends by less than 1 / radius, and the joints of a
//! chain are blunt enough. It is refused where a shape that is looked at does not.

use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// In an interval in which it may be more than this for some pair, nearly all pairs of pieces are
/// asked about: half of an angle that faces are asked for.
pub(crate) const MAX_EXTRA_TURN: Real = std::f64::consts::FRAC_PI_4;

/// How far the sections of a tube move and turn from the middle of an interval of time on.
#[derive(Clone, Debug, Default)]
pub(crate) struct SectionMotions {
    sections: Vec<Section>,
}

/// How far points move, and by how much a direction turns.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SectionMotion {
    pub points: Real,
    pub turn: Real,
}

#[derive(Clone, Copy, Debug)]
struct Section {
    moved: SectionMotion,
    /// By how much more a pair may turn, as far as it matters, the second place of which is here.
    growth: Real,
}

impl SectionMotions {
    pub(crate) fn clear(&mut self) {
        self.sections.clear();
    }

    /// The next section.
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

    /// That of any pair at most.
    pub(crate) fn max_extra_turn(&self) -> Real {
        self.sections.last().map_or(0.0, |last| last.growth)
    }

    /// The section that moves farthest, and how far any point does at most.
    pub(crate) fn farthest(&self) -> (usize, Real) {
        let points = self.sections.iter().map(|section| section.moved.points).enumerate();
        points.fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most })
    }
}
