//! Speeds and displacements of sections of constant curvature while their curvature, its direction
//! and their length change.
//!
//! # Definitions
//! - `u(s, t)`: the curvature vector at arc length s and time t, in the frame `R(s, t)` carried
//!   along the curve without twist: `dR/ds = R [u]`. u is constant in each section.
//! - `W`: the frame's angular velocity. `c(s)`: the curve.
//! - `b_j`: the arc length of the end of section j. `J_j`: the step of u there. `l_j`: its length.
//! - `k`: the curvature of the section that contains the point. `s'`: the rate of its arc length.
//!
//! # Speed
//! **Claim.** For a point at a fixed share of a section,
//!
//! - `point <= sum of |u_j'| l_j (s - middle of j) + sum of |b_j'| J_j (s - b_j) + |s'|`;
//! - `turn  <= sum of |u_j'| l_j + sum of |b_j'| J_j + k |s'|`;
//!
//! with sums over sections and over steps. The last section counts up to s.
//!
//! **Proof.**
//! 1. The mixed derivatives of R agree only if `dW/ds = R du/dt`. The base is at rest, so
//!    `|W(s)| <= integral from 0 to s of |du/dt|`.
//! 2. The point c(s) at a fixed arc length has the velocity `integral of W x c'`. By parts this is
//!    `integral of R du/dt x (c(s) - c(q)) dq`, and `|c(s) - c(q)| <= s - q`. So
//!    `|dc/dt| <= integral from 0 to s of |du/dt| (s - q) dq`.
//! 3. As b_j moves, so does the step J_j. It adds `|b_j'| J_j` to the integral of |du/dt| there.
//! 4. A point at a fixed share also moves along the curve at the rate s', and its direction turns
//!    by k times that.
//!
//! All terms grow with the lengths, so the longest lengths during the motion count. If lengths
//! change at constant rates, s' is linear in the share and largest at an end of the piece.
//!
//! # Acceleration
//! For a point at a fixed share, use the shares q of the sections, from 0 to 1 in each. Let
//! `w = l u`, and e be the unit vector along the axis: `dR/dq = R [w]`, `dc/dq = l R e`. Then
//! `dW/dq = R w'` without a step anywhere. As `R' = [W] R`,
//!
//! - `dW'/dq = W x R w' + R w''`;
//! - `c'' = integral of 2 l' W x R e + l (W' x R e + W x (W x R e)) dq`, if l' is constant.
//!
//! Let T be the integral of `|w'|` from the base, and F the integral of `T |w'| + |w''|`. They
//! are upper bounds on `|W|` and `|W'|`. So the acceleration is at most the integral of
//! `2 |l'| T + l (F + T^2)`. In a section, `|w'| <= |l'| k + l |u'|` and
//! `|w''| <= 2 |l'| |u'| + l |u''|`. With constant bounds, T is linear in the share and F
//! quadratic; both are monotone along it.
//!
//! # Displacement along a piece
//! Along a section, `d^2 c / dq^2 = l R (w x e)` changes in time at most at the rate
//! `l (2 |l'| k + T l k + l |u'|)`. From one time to another, D apart, the displacement of a point
//! between two shares, d apart, differs from the interpolated one by at most `D d^2 / 8` times
//! that.

use super::rigid_path::rigid_pose;
use super::{DisplacementBound, Motion, Speed};
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::{BendingSection, ConstantCurvature, check_bending};
use crate::robot::{RobotError, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// How a section of constant curvature changes during a motion, for [`bending_speed`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingRates {
    /// Its largest length.
    pub length: Real,
    /// Its change of length from t = 0 to t = 1, at a constant rate; negative if it becomes
    /// shorter.
    pub growth: Real,
    /// Its largest curvature, 1 / length.
    pub curvature: Real,
    /// Upper bound on the rate of its curvature vector, in the frame carried along the curve
    /// without twist. For curvature k in the direction of the angle a it is at most
    /// `|k'| + k |a'|`.
    pub bending: Real,
    /// The largest difference between its curvature vector and the next section's.
    pub step: Real,
}

/// Returns the speed bound of a robot of constant-curvature sections whose base is at rest: the
/// value for [`Motion::speed`].
///
/// - `sections`: how each section changes, base to tip.
/// - `section`, `shares`: the piece, as for [`Motion::speed`].
///
/// Only sections before the piece contribute. So a motion of the tip alone leaves the rest at rest,
/// and a section that grows without a change of curvature moves along itself.
///
/// ```
/// use parry_continuum::{BendingRates, bending_speed};
///
/// // A section of 20 that is pushed out by 2, and one of 10 that turns its plane by 0.1 rad.
/// let first =
///     BendingRates { length: 20.0, growth: 2.0, curvature: 0.0, bending: 0.0, step: 0.05 };
/// let second =
///     BendingRates { length: 10.0, growth: 0.0, curvature: 0.05, bending: 0.005, step: 0.0 };
/// assert!((bending_speed(&[first, second], 0, [0.0, 0.5]).point - 1.0).abs() < 1e-9);
/// let tip = bending_speed(&[first, second], 1, [1.0, 1.0]);
/// // Plane: 0.005 x 10^2 / 2. Growth: 2. Moving step: 2 x 0.05 x 10.
/// assert!((tip.point - (0.25 + 2.0 + 1.0)).abs() < 1e-9);
/// ```
pub fn bending_speed(sections: &[BendingRates], section: usize, shares: [Real; 2]) -> Speed {
    let (mut turn, mut point) = (0.0, 0.0);
    // The rates of the arc length at the section's start and end.
    let (mut start, mut end) = (0.0, 0.0);
    for (number, rates) in sections.iter().enumerate().take(section + 1) {
        let length = if number == section { rates.length * shares[1] } else { rates.length };
        // The turn up to here moves the rest.
        point += turn * length + 0.5 * rates.bending * length * length;
        turn += rates.bending * length;
        start = end;
        end += rates.growth;
        if number < section {
            turn += end.abs() * rates.step;
        }
    }
    let along = |share: Real| (start + (end - start) * share).abs();
    let along = along(shares[0]).max(along(shares[1]));
    let curvature = sections.get(section).map_or(0.0, |rates| rates.curvature);
    // Covers the rounding of sums of positive terms. Rates of either sign may cancel, so their
    // rounding is added separately.
    let growth: Real = sections.iter().take(section + 1).map(|rates| rates.growth.abs()).sum();
    let rounding = 8.0 * (section as Real + 2.0) * Real::UNIT_ROUNDOFF;
    let along = along + growth * rounding;
    let up = 1.0 + 4.0 * rounding;
    Speed { point: (point + along) * up, turn: (turn + curvature * along) * up }
}

/// Returns the displacement bound of a robot of constant-curvature sections whose base is at rest
/// and whose lengths change at constant rates: the value for [`Motion::displacement`].
///
/// - `sections`: how each section changes, base to tip.
/// - `bends`: for each section a bound on the second derivative of its curvature vector, in the
///   frame carried along the curve without twist: 0 if the vector changes at a constant rate,
///   `k |a'|^2` if it has the length k and turns at the constant rate a'. Missing values count as
///   infinite.
/// - `section`, `shares`, `times`: the piece, as for [`Motion::displacement`].
/// - `point`: the point at a share of this section and a time, in the mesh's frame.
///
/// ```
/// use parry_continuum::{BendingRates, bending_displacement, parry::math::Vector};
///
/// // Straight at first, a section of 10 that bends evenly by 0.02 x 10 = 0.2 rad in all.
/// let rates =
///     BendingRates { length: 10.0, growth: 0.0, curvature: 0.02, bending: 0.02, step: 0.0 };
/// let point = |share: f64, t: f64| {
///     let curvature = 0.02 * t.max(1e-9);
///     let (sin, cos) = (curvature * 10.0 * share).sin_cos();
///     Vector::new((1.0 - cos) / curvature, 0.0, sin / curvature)
/// };
/// let course = bending_displacement(&[rates], &[0.0], 0, [1.0; 2], [0.0, 1.0], point);
/// // The tip moves across by about 0.02 x 10^2 / 2, and is never far from the straight way.
/// assert!((course.ways[0].x - 1.0).abs() < 0.01 && course.off < 0.03);
/// ```
pub fn bending_displacement(
    sections: &[BendingRates],
    bends: &[Real],
    section: usize,
    shares: [Real; 2],
    times: [Real; 2],
    point: impl Fn(Real, Real) -> Vector,
) -> DisplacementBound {
    let bend = |number: usize| bends.get(number).map_or(Real::INFINITY, |bend| bend.abs());
    displacement(sections, bend, section, shares, times, point)
}

fn displacement(
    sections: &[BendingRates],
    bend: impl Fn(usize) -> Real,
    section: usize,
    shares: [Real; 2],
    times: [Real; 2],
    point: impl Fn(Real, Real) -> Vector,
) -> DisplacementBound {
    // `turn` is T, `change` is F; `bow` is the rate of `d^2 c / dq^2`.
    let (mut turn, mut change, mut acceleration, mut bow) = (0.0, 0.0, 0.0, 0.0);
    let mut reach = 0.0;
    for (number, rates) in sections.iter().enumerate().take(section + 1) {
        let q = if number == section { shares[1] } else { 1.0 };
        let &BendingRates { length, growth, curvature, bending, .. } = rates;
        let growth = growth.abs();
        let first = growth * curvature + length * bending;
        let second = 2.0 * growth * bending + length * bend(number);
        // The integrals of T, T^2 and F from their values at the section's start.
        let turns = q * (turn + 0.5 * first * q);
        let squares = q * (turn * turn + turn * first * q + first * first * q * q / 3.0);
        let changes =
            q * (change + 0.5 * (turn * first + second) * q + first * first * q * q / 6.0);
        acceleration += 2.0 * growth * turns + length * (changes + squares);
        change += q * (turn * first + 0.5 * first * first * q + second);
        turn += first * q;
        bow = length * (2.0 * growth * curvature + turn * length * curvature + length * bending);
        reach += length;
    }
    let [here, there] = times.map(|t| shares.map(|share| point(share, t)));
    let (apart, between) = (times[1] - times[0], shares[1] - shares[0]);
    let reach =
        here.into_iter().chain(there).fold(reach, |most: Real, p| most.max(p.abs().max_element()));
    // Covers the rounding of sums and products of positive terms, and of places.
    let roundings = 64.0 * (section as Real + 2.0) * Real::UNIT_ROUNDOFF;
    let off = 0.125 * (acceleration * apart * apart + bow * apart * between * between);
    DisplacementBound::between(here, there, off * (1.0 + roundings) + reach * roundings)
}

/// The motion of a robot of constant-curvature sections from one shape to another.
///
/// Lengths and both components of curvature change at constant rates. The base is at rest at `pose`
/// in the mesh's frame. Concentric tube robots and tendon robots move like this if their actuators
/// change the curvatures at constant rates. For other motions [`bending_speed`] gives the bounds.
///
/// ```
/// use parry_continuum::{BendingMotion, BendingSection, parry::math::Pose, verify_motion};
///
/// let straight = BendingSection { length: 30.0, radius: 1.0, bend: [0.0, 0.0] };
/// let bent = BendingSection { length: 32.0, radius: 1.0, bend: [0.03, 0.01] };
/// let motion = BendingMotion::new(&[straight], &[bent], Pose::IDENTITY)?;
/// verify_motion(&motion, 100)?;
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct BendingMotion {
    from: Vec<BendingSection>,
    to: Vec<BendingSection>,
    rates: Vec<BendingRates>,
    pose: Pose,
}

impl BendingMotion {
    /// Builds the motion from the sections `from` to the sections `to`; `pose` is the base's pose
    /// in the mesh's frame.
    ///
    /// # Errors
    /// - different numbers of sections, or different radii;
    /// - a length that is not positive, or a number that is not finite;
    /// - a pose whose quaternion is not of unit length;
    /// - a section with a flat end whose curvature times radius may be 1 or more.
    pub fn new(
        from: &[BendingSection],
        to: &[BendingSection],
        pose: Pose,
    ) -> Result<Self, RobotError> {
        // A NaN radius is refused below.
        let same = |a: Real, b: Real| a == b || a.is_nan() && b.is_nan();
        let differs = |k: &usize| match (from.get(*k), to.get(*k)) {
            (Some(from), Some(to)) => !same(from.radius, to.radius),
            _ => true,
        };
        if let Some(index) = (0..from.len().max(to.len())).find(differs) {
            return Err(RobotError::SectionsDiffer { index });
        }
        check_bending("from", from)?;
        check_bending("to", to)?;
        let pose = rigid_pose("pose", &pose)?;
        let bend = |section: &BendingSection| Vector::new(section.bend[0], section.bend[1], 0.0);
        let rates = (0..from.len()).map(|k| BendingRates {
            length: from[k].length.max(to[k].length),
            growth: to[k].length - from[k].length,
            curvature: length(bend(&from[k])).max(length(bend(&to[k]))),
            bending: length(bend(&to[k]) - bend(&from[k])),
            // The norm of a vector that changes at a constant rate is convex in time.
            step: [from, to]
                .map(|all| all.get(k + 1).map_or(0.0, |next| length(bend(next) - bend(&all[k]))))
                .into_iter()
                .fold(0.0, Real::max),
        });
        let motion = Self { from: from.to_vec(), to: to.to_vec(), rates: rates.collect(), pose };
        for t in [0.0, 1.0] {
            motion.shape(t, &mut Tube::empty())?;
        }
        Ok(motion)
    }

    /// Returns the first `count` sections at a time.
    fn sections(&self, t: Real, count: usize) -> Vec<BendingSection> {
        let between = |from: Real, to: Real| from + (to - from) * t;
        let sections =
            self.from.iter().zip(&self.to).take(count).map(|(from, to)| BendingSection {
                length: between(from.length, to.length),
                radius: from.radius,
                bend: [0, 1].map(|axis| between(from.bend[axis], to.bend[axis])),
            });
        sections.collect()
    }
}

impl Motion for BendingMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        *tube = ConstantCurvature::new(&self.sections(t, self.from.len()))?.into_tube()?;
        Ok(self.pose)
    }

    fn speed(&self, section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
        bending_speed(&self.rates, section, shares)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        if section >= self.from.len() {
            return None;
        }
        let [first, last] = times.map(|t| ConstantCurvature::new(&self.sections(t, section + 1)));
        let (first, last) = (first.ok()?, last.ok()?);
        let point = |share: Real, t: Real| {
            let robot = if t == times[0] { &first } else { &last };
            self.pose * robot.at_share(section, share)
        };
        // Curvature vectors change at constant rates.
        Some(displacement(&self.rates, |_| 0.0, section, shares, times, point))
    }
}
