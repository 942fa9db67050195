//! A concentric tube robot while its joints move evenly from one place to another: its shapes, and
//! how fast it is.
//!
//! Where all tubes of a section are curved, its curvature vector is the sum over these tubes of w
//! u(a): w is the tube's share of their stiffness times its curvature, and u(a) a unit vector that
//! turns with the tube's angle a. So the vector changes at most at the rate b = sum of w |a'|, and
//! stays within b / 2 of its value at half time. That bounds curvatures and steps for
//! [`bending_speed`]. Its second derivative is at most the sum of w |a'|^2, which bounds
//! [`bending_displacement`].

use crate::ctr::{Curve, Joints, Robot};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{
    BendingRates, BendingSection, DisplacementBound, Motion, RobotError, Speed, Tube, TubeSection,
    bending_displacement, bending_speed,
};
use std::f64::consts::TAU;

/// A tube that turns by less than this over its whole length, in rad, counts as straight. What that
/// moves the tip by is a millionth of the robot's length at most.
const STRAIGHT: Real = 1e-6;

/// The motion of a robot whose extensions and angles change evenly, its base standing still.
#[derive(Clone, Debug)]
pub struct JointMotion {
    from: Joints,
    to: Joints,
    base: Pose,
    radii: Vec<Real>,
    /// For each section and each tube, the tube's part of the section's curvature.
    parts: Vec<Vec<Real>>,
    rates: Vec<BendingRates>,
    /// For each section, a bound on the second derivative of its curvature vector.
    bends: Vec<Real>,
}

impl JointMotion {
    /// The motion from one place to another; `base` is the robot's pose in the mesh's frame.
    ///
    /// None if a section is not out at one of the two, or a curved tube is straight somewhere in
    /// the robot: the lengths of the sections up to its own must not add up to more than its
    /// own can be.
    pub fn new(robot: &Robot, [from, to]: [&Joints; 2], base: Pose) -> Option<Self> {
        let count = robot.sections.len();
        let (mut end, mut tubes) = ([0.0; 2], Vec::new());
        for (k, section) in robot.sections.iter().enumerate() {
            let extensions = [from, to].map(|joints| joints.extensions[k]);
            end = [0, 1].map(|time| end[time] + extensions[time]);
            let longest = end[0].max(end[1]);
            for tube in &section.tubes {
                let is_straight = tube.curvature * longest.max(section.length) < STRAIGHT;
                if !is_straight && longest > section.length {
                    return None;
                }
                tubes.push((k, tube.stiffness, if is_straight { 0.0 } else { tube.curvature }));
            }
            if extensions.into_iter().any(|extension| extension <= 0.0) {
                return None;
            }
        }
        let part = |k: usize| {
            let stiffness: Real = tubes
                .iter()
                .filter(|(section, ..)| *section >= k)
                .map(|(_, stiffness, _)| stiffness)
                .sum();
            let part = |&(section, own, curvature): &(usize, Real, Real)| {
                if section >= k { own / stiffness * curvature } else { 0.0 }
            };
            tubes.iter().map(part).collect()
        };
        let mut motion = Self {
            from: from.clone(),
            to: to.clone(),
            base,
            radii: robot.sections.iter().map(|section| section.radius).collect(),
            parts: (0..count).map(part).collect(),
            rates: Vec::new(),
            bends: Vec::new(),
        };
        motion.rates = motion.rates();
        let squares =
            from.angles.iter().zip(&to.angles).map(|(from, to)| (to - from) * (to - from));
        let bend = |parts: &Vec<Real>| {
            parts.iter().zip(squares.clone()).map(|(part, turned)| part * turned).sum()
        };
        motion.bends = motion.parts.iter().map(bend).collect();
        Some(motion)
    }

    /// A random motion whose tip ends `distance` away from where it begins, as edges of planners
    /// are. `share` gives random numbers from 0 to 1; the robot has three sections of a tube
    /// each.
    pub fn random(
        robot: &Robot,
        base: Pose,
        distance: Real,
        mut share: impl FnMut() -> Real,
    ) -> Self {
        let mut between = |low: Real, high: Real| low + (high - low) * share();
        let tip = |joints: &Joints| robot.frames(joints, &[robot.length(joints)])[0].translation;
        // So that the first two sections are no longer than the second can be.
        let longest = |k: usize| robot.sections[k].length.min(0.5 * robot.sections[1].length);
        loop {
            let reach = between(0.02, 0.7);
            let extension =
                |k: usize| (robot.sections[k].length * reach * between(0.02, 0.7)).min(longest(k));
            let from = Joints {
                extensions: (0..3).map(extension).collect(),
                angles: (0..3).map(|_| between(0.0, TAU)).collect(),
            };
            let way: Vec<_> =
                [10.0, 10.0, 10.0, 3.0, 3.0, 3.0].map(|most| between(-most, most)).into();
            let go = |share: Real| Joints {
                extensions: (0..3)
                    .map(|k| (from.extensions[k] + share * way[k]).clamp(0.02, longest(k)))
                    .collect(),
                angles: (0..3).map(|k| from.angles[k] + share * way[k + 3]).collect(),
            };
            let start = tip(&from);
            let moved = |share: Real| (tip(&go(share)) - start).length();
            if moved(1.0) < distance {
                continue;
            }
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                if moved(middle) < distance { low = middle } else { high = middle }
            }
            if let Some(motion) = Self::new(robot, [&from, &go(high)], base) {
                return motion;
            }
        }
    }

    fn rates(&self) -> Vec<BendingRates> {
        let (from, to) = (&self.from, &self.to);
        let turned: Vec<_> =
            from.angles.iter().zip(&to.angles).map(|(from, to)| (to - from).abs()).collect();
        let bending =
            |parts: &Vec<Real>| parts.iter().zip(&turned).map(|(part, turned)| part * turned).sum();
        let bending: Vec<Real> = self.parts.iter().map(bending).collect();
        let middle: Vec<_> = self.bends(&self.joints(0.5)).collect();
        let rates = (0..self.parts.len()).map(|k| BendingRates {
            length: from.extensions[k].max(to.extensions[k]),
            growth: to.extensions[k] - from.extensions[k],
            curvature: middle[k].length() + 0.5 * bending[k],
            bending: bending[k],
            step: middle.get(k + 1).map_or(0.0, |next| {
                (next - middle[k]).length() + 0.5 * (bending[k] + bending[k + 1])
            }),
        });
        rates.collect()
    }

    /// The joints at a time from 0 to 1.
    pub fn joints(&self, t: Real) -> Joints {
        let between = |from: &[Real], to: &[Real]| {
            from.iter().zip(to).map(|(from, to)| from + (to - from) * t).collect()
        };
        Joints {
            extensions: between(&self.from.extensions, &self.to.extensions),
            angles: between(&self.from.angles, &self.to.angles),
        }
    }

    /// The robot at a time from 0 to 1, in its own frame.
    ///
    /// # Errors
    /// As [`Tube::from_function`].
    pub fn tube(&self, t: Real) -> Result<Tube, RobotError> {
        let joints = self.joints(t);
        let lengths = joints.extensions.iter().copied();
        let sections: Vec<_> = self
            .bends(&joints)
            .zip(lengths.clone())
            .zip(&self.radii)
            .map(|((bend, length), &radius)| TubeSection {
                length,
                radius,
                curvature: bend.length(),
            })
            .collect();
        let curve = Curve::joined(lengths.zip(self.bends(&joints)));
        Tube::from_function(&sections, move |s| curve.at(s))
    }

    /// The sections at a time from 0 to 1.
    pub fn sections(&self, t: Real) -> Vec<BendingSection> {
        let joints = self.joints(t);
        let bends = self.bends(&joints).map(|bend| [bend.y, -bend.x]);
        let parts = joints.extensions.iter().zip(&self.radii).zip(bends);
        parts.map(|((&length, &radius), bend)| BendingSection { length, radius, bend }).collect()
    }

    /// The point of the tip at a time from 0 to 1, in the mesh's frame.
    pub fn tip(&self, t: Real) -> Vector {
        let joints = self.joints(t);
        let curve = Curve::joined(joints.extensions.iter().copied().zip(self.bends(&joints)));
        self.base * curve.at(joints.extensions.iter().sum()).0
    }

    /// Times between which the tip moves by at most `step`, without 0: the middle first, then the
    /// middles of the halves, so that contacts show early.
    pub fn steps(&self, step: Real) -> impl Iterator<Item = Real> + use<> {
        let tips: Vec<_> = (0..=8).map(|k| self.tip(Real::from(k) / 8.0)).collect();
        let moved: Real = tips.windows(2).map(|tips| (tips[1] - tips[0]).length()).sum();
        let count = (moved / step).ceil().max(1.0) as usize;
        let mut order: Vec<_> = (1..=count).collect();
        order.sort_by_key(|k| k.reverse_bits());
        order.into_iter().map(move |k| k as Real / count as Real)
    }

    /// The curvature vector of each section.
    fn bends(&self, joints: &Joints) -> impl Iterator<Item = Vector> {
        let towards = |angle: &Real| Vector::new(-angle.sin(), angle.cos(), 0.0);
        let towards: Vec<_> = joints.angles.iter().map(towards).collect();
        self.parts.iter().map(move |parts| {
            parts.iter().zip(&towards).map(|(part, towards)| *towards * *part).sum()
        })
    }
}

impl Motion for JointMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        *tube = self.tube(t)?;
        Ok(self.base)
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
        if section >= self.radii.len() {
            return None;
        }
        let curves = times.map(|t| {
            let joints = self.joints(t);
            let parts = joints.extensions.iter().copied().zip(self.bends(&joints));
            (Curve::joined(parts.take(section + 1)), joints.extensions)
        });
        let point = |share: Real, t: Real| {
            let (curve, lengths) = &curves[usize::from(t != times[0])];
            let start: Real = lengths[..section].iter().sum();
            self.base * curve.at(start + lengths[section] * share).0
        };
        Some(bending_displacement(&self.rates, &self.bends, section, shares, times, point))
    }
}
