//! How fast sections of constant curvature move while their curvature, its direction and their
//! length change.
//!
//! Let u(s, t) be the curvature vector at arc length s and time t in the frame R(s, t) that is
//! carried along the curve without twist: dR/ds = R [u]. With the frame's angular velocity W, the
//! mixed derivatives of R agree only if dW/ds = R du/dt, and the base stands still, so |W(s)| <=
//! integral from 0 to s of |du/dt|. The point c(s) at a fixed arc length has the velocity integral
//! W x c', by parts integral R du/dt x (c(s) - c(q)) dq, and c(s) is at most s - q away from c(q):
//!
//! |dc/dt| <= integral from 0 to s of |du/dt| (s - q) dq.
//!
//! u is constant in each section. Where section j ends, at the arc length b_j, it steps by J_j; as
//! b_j moves, so does the step, which adds |b_j'| J_j to the integral of |du/dt| there. A point at
//! a fixed share of a section moves along the curve besides, at the rate of its arc length s', and
//! its direction turns by the section's curvature times that:
//!
//! point <= sum over sections |u_j'| l_j (s - middle of j) + sum over steps |b_j'| J_j (s - b_j) +
//! |s'| turn  <= sum over sections |u_j'| l_j + sum over steps |b_j'| J_j + k |s'|
//!
//! where the last section counts as far as s. All terms grow with the lengths, so the longest
//! during the motion count. With lengths that change at constant rates, s' is linear in the share
//! and largest at an end of the piece.
//!
//! **Courses.** Of a point at a fixed share, it is simpler to count along the shares q of the
//! sections, from 0 to 1 in each: dR/dq = R [w] with w = l u, and dc/dq = l R e for the unit vector
//! e along the axis. Then dW/dq = R w', with no step anywhere, and as R' = [W] R,
//!
//! dW'/dq = W x R w' + R w'',   c'' = integral 2 l' W x R e + l (W' x R e + W x (W x R e)) dq
//!
//! where l changes at a constant rate. So with T the integral of |w'| from the base, and F that of
//! T |w'| + |w''|, which bound |W| and |W'|, the acceleration is at most the integral of 2 |l'| T +
//! l (F + T^2). In a section |w'| <= |l'| k + l |u'| and
//! |w''| <= 2 |l'| |u'| + l |u''|; between constants, T is linear in the share and F quadratic, and nothing falls along it.
//!
//! Along a section, d^2 c / dq^2 = l R (w x e) changes in time at most at the rate l (2 |l'| k + T
//! l k + l |u'|). So from one time to another, D apart, the way of a point differs from that in
//! proportion between two shares, d apart, by at most D d^2 / 8 times that.

use super::{Course, Motion, Speed, rigid_pose};
use crate::distance::Scalar;
use crate::robot::constant_curvature::check;
use crate::robot::{BendingSection, ConstantCurvature, RobotError, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// How a section of constant curvature changes during a motion, for [`bending_speed`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingRates {
    /// Its length where it is longest.
    pub length: Real,
    /// By how much its length grows from t = 0 to t = 1, at a constant rate; less than 0 if it
    /// becomes shorter.
    pub growth: Real,
    /// Its largest curvature, 1 / length.
    pub curvature: Real,
    /// How fast its curvature vector changes at most, in the frame that is carried along the curve
    /// without twist: of curvature k in the direction of the angle a, |k'| + k |a'| at most.
    pub bending: Real,
    /// The largest difference between its curvature vector and that of the next section.
    pub step: Real,
}

/// A bound on the speed of a robot of sections of constant curvature whose base stands still,
/// between two shares of a section: what [`Motion::speed`] asks for.
///
/// What counts of the other sections is what lies before; so a motion of the tip alone leaves the
/// rest at rest, and a section that grows without a change of curvature moves along itself.
///
/// ```
/// use parry_continuum::{BendingRates, bending_speed};
///
/// // A section of 20 that is pushed out by 2, and one of 10 that turns its plane by 0.1 rad.
/// let first = BendingRates { length: 20.0, growth: 2.0, curvature: 0.0, bending: 0.0, step: 0.05 };
/// let second = BendingRates { length: 10.0, growth: 0.0, curvature: 0.05, bending: 0.005, step: 0.0 };
/// assert!((bending_speed(&[first, second], 0, [0.0, 0.5]).point - 1.0).abs() < 1e-9);
/// let tip = bending_speed(&[first, second], 1, [1.0, 1.0]);
/// // Its plane moves the tip by 0.005 x 10^2 / 2, the growth by 2, and the step that moves on by 2 x 0.05 x 10.
/// assert!((tip.point - (0.25 + 2.0 + 1.0)).abs() < 1e-9);
/// ```
pub fn bending_speed(sections: &[BendingRates], section: usize, shares: [Real; 2]) -> Speed {
    let (mut turn, mut point) = (0.0, 0.0);
    // How fast the arc length changes where the section begins and where it ends.
    let (mut start, mut end) = (0.0, 0.0);
    for (number, rates) in sections.iter().enumerate().take(section + 1) {
        let length = if number == section { rates.length * shares[1] } else { rates.length };
        // What has turned so far carries the rest with it.
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
    // Sums of positive terms, each of few roundings; rates of either sign may cancel, so theirs are
    // added.
    let growth: Real = sections.iter().take(section + 1).map(|rates| rates.growth.abs()).sum();
    let rounding = 8.0 * (section as Real + 2.0) * Real::UNIT_ROUNDOFF;
    let along = along + growth * rounding;
    let up = 1.0 + 4.0 * rounding;
    Speed { point: (point + along) * up, turn: (turn + curvature * along) * up }
}

/// Where a piece of a robot of sections of constant curvature goes whose base stands still and
/// whose lengths change at constant rates: what [`Motion::course`] asks for.
///
/// `bends` are, for each section, bounds on the second derivative of its curvature vector in the
/// frame that is carried along the curve without twist: 0 where that changes evenly, and k |a'|^2
/// if it is k long and turns evenly at the rate a'. What is not given counts as infinite. `point`
/// is the point at a share of this section at a time, in the mesh's frame.
///
/// ```
/// use parry_continuum::{BendingRates, bending_course, parry::math::Vector};
///
/// // Straight at first, a section of 10 that bends evenly by 0.02 x 10 = 0.2 rad in all.
/// let rates = BendingRates { length: 10.0, growth: 0.0, curvature: 0.02, bending: 0.02, step: 0.0 };
/// let point = |share: f64, t: f64| {
///     let curvature = 0.02 * t.max(1e-9);
///     let (sin, cos) = (curvature * 10.0 * share).sin_cos();
///     Vector::new((1.0 - cos) / curvature, 0.0, sin / curvature)
/// };
/// let course = bending_course(&[rates], &[0.0], 0, [1.0; 2], [0.0, 1.0], point);
/// // The tip moves across by about 0.02 x 10^2 / 2, and is never far from the straight way.
/// assert!((course.ways[0].x - 1.0).abs() < 0.01 && course.off < 0.03);
/// ```
pub fn bending_course(
    sections: &[BendingRates],
    bends: &[Real],
    section: usize,
    shares: [Real; 2],
    times: [Real; 2],
    point: impl Fn(Real, Real) -> Vector,
) -> Course {
    let bend = |number: usize| bends.get(number).map_or(Real::INFINITY, |bend| bend.abs());
    course(sections, bend, section, shares, times, point)
}

fn course(
    sections: &[BendingRates],
    bend: impl Fn(usize) -> Real,
    section: usize,
    shares: [Real; 2],
    times: [Real; 2],
    point: impl Fn(Real, Real) -> Vector,
) -> Course {
    // Bounds on how fast the frame turns, and on how fast that changes; and what `d^2 c / dq^2`
    // changes by.
    let (mut turn, mut change, mut acceleration, mut bow) = (0.0, 0.0, 0.0, 0.0);
    let mut reach = 0.0;
    for (number, rates) in sections.iter().enumerate().take(section + 1) {
        let q = if number == section { shares[1] } else { 1.0 };
        let &BendingRates { length, growth, curvature, bending, .. } = rates;
        let growth = growth.abs();
        let first = growth * curvature + length * bending;
        let second = 2.0 * growth * bending + length * bend(number);
        // The integrals of T, T^2 and F, where T is `turn` at first and F is `change`.
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
    // Sums and products of terms above 0; places are off by some roundings for each section.
    let roundings = 64.0 * (section as Real + 2.0) * Real::UNIT_ROUNDOFF;
    let off = 0.125 * (acceleration * apart * apart + bow * apart * between * between);
    Course::between(here, there, off * (1.0 + roundings) + reach * roundings)
}

/// The motion of a robot of sections of constant curvature, from one shape to another: lengths and
/// curvatures, in both directions, change evenly.
///
/// The base stands still at `pose` in the mesh's frame. A concentric tube robot or a tendon robot
/// is such one, if its actuators are driven so that curvatures change evenly; for other courses,
/// [`bending_speed`] gives the bounds.
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
    /// The motion from the sections `from` to the sections `to`.
    ///
    /// # Errors
    /// The two differ in number or in radii; a length that is not positive, or a number that is not
    /// finite; a pose whose rotation is not of unit length; or a section with a flat end whose
    /// curvature times its radius may be 1 or more.
    pub fn new(
        from: &[BendingSection],
        to: &[BendingSection],
        pose: Pose,
    ) -> Result<Self, RobotError> {
        // Radii that are not numbers are refused below.
        let same = |a: Real, b: Real| a == b || a.is_nan() && b.is_nan();
        let differs = |k: &usize| match (from.get(*k), to.get(*k)) {
            (Some(from), Some(to)) => !same(from.radius, to.radius),
            _ => true,
        };
        if let Some(index) = (0..from.len().max(to.len())).find(differs) {
            return Err(RobotError::SectionsDiffer { index });
        }
        check("from", from)?;
        check("to", to)?;
        let pose = rigid_pose("pose", &pose)?;
        let bend = |section: &BendingSection| Vector::new(section.bend[0], section.bend[1], 0.0);
        let rates = (0..from.len()).map(|k| BendingRates {
            length: from[k].length.max(to[k].length),
            growth: to[k].length - from[k].length,
            curvature: bend(&from[k]).length().max(bend(&to[k]).length()),
            bending: (bend(&to[k]) - bend(&from[k])).length(),
            // Norms of vectors that change evenly are convex in time.
            step: [from, to]
                .map(|all| all.get(k + 1).map_or(0.0, |next| (bend(next) - bend(&all[k])).length()))
                .into_iter()
                .fold(0.0, Real::max),
        });
        let motion = Self { from: from.to_vec(), to: to.to_vec(), rates: rates.collect(), pose };
        for t in [0.0, 1.0] {
            motion.shape(t, &mut Tube::empty())?;
        }
        Ok(motion)
    }

    /// The first sections at a time.
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

    fn course(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Option<Course> {
        if section >= self.from.len() {
            return None;
        }
        let [first, last] = times.map(|t| ConstantCurvature::new(&self.sections(t, section + 1)));
        let (first, last) = (first.ok()?, last.ok()?);
        let point = |share: Real, t: Real| {
            let robot = if t == times[0] { &first } else { &last };
            self.pose * robot.at_share(section, share)
        };
        // Curvatures change evenly.
        Some(course(&self.rates, |_| 0.0, section, shares, times, point))
    }
}
