//! Robots of sections of constant curvature on the device: the derivation of their points' error,
//! and the host's part. `shaders/search/bending.wgsl` computes the points.
//!
//! # Definitions
//! - l: the length of a section in the search frame. b: its bend in rad, its curvature times its
//!   length. s: a share of the section, from 0 to 1; theta: the angle `|b| s`; h: `theta / 2`.
//! - Q: the quaternion of a frame; P: a point. The base has `Q_0` and `P_0`.
//! - R: `|P_0|` plus the length of the robot. r: the radius of a link, c: the length of its arc.
//! - u = 2^-24, and the arithmetic of a device: see the module `bounds`.
//!
//! # Formula
//! With `k = sin(h) / h`, a share of a section leads, in the frame of its start, to the point v and
//! turns the frame by the quaternion q ([`ConstantCurvature`] has the same in other words):
//!
//! ```text
//! v = l s (k^2 / 2 (b_x, b_y) s, k cos(h)),   q = (k / 2 (-b_y, b_x, 0) s, cos(h)),
//! P' = P + Q v Q*,   Q' = Q q.
//! ```
//!
//! cos(h) and k are polynomials of `h^2` of degree [`DEGREE`]. No section turns by more than 2 pi,
//! so `h <= pi` and the first term left out is below 2^-27.
//!
//! # Claim
//! Every computed point is within
//!
//! ```text
//! delta = u (2 R + sum_i (l_i (90 e^h_i + 7 D_i + 40) + 2 R)),
//! D_i = 1 + sum_(j < i) (40 e^h_j + 8)
//! ```
//!
//! of the robot's point, with h of the whole section. So every bound of a link errs by at most
//! `delta (1 + 4 r / c)` more than for the computed points (`more_error`).
//!
//! # Proof
//! In units of u, first order; the constants are rounded up by more than the second order, since
//! no robot with `16 delta > c` is computed here.
//!
//! 1. **Input.** l, b and s err by 7 of themselves together: rounding, a division of 5 and a
//!    product. So `h^2` errs by 17 of itself.
//! 2. **Polynomials.** Horner's rule errs by 18 of the sum of the terms' magnitudes, their
//!    coefficients by 1: 19 cosh(h) for cos(h), and 19 sinh(h) / h for k. The error of `h^2` adds
//!    8.5 h to the first and `17 m` to the second, with `m = min(1, h^2 / 6)`; the terms left out
//!    add 1.
//! 3. **q** errs by the error of cos(h), h times the error of k, and 9 h for the product:
//!    `19 e^h + 18.5 h + 17 m h + 1 < 40 e^h`.
//! 4. **v** errs by l times the error of cos(h), `1 + 2 |sin(h)|` times the error of k, 9 along z
//!    and `18 sin(h)^2 / h < 14` across: `l (38 e^h + 10.5 h + 51 m + 25) < 90 e^h l`.
//! 5. **Q**: four products a component, so 8 in all for a product of quaternions. `Q_0` is rounded
//!    by 1. So `Q_i` errs by `D_i`.
//! 6. **Q v Q\*** is computed as `v + 2 w (a x v) + 2 a x (a x v)` with `Q = (a, w)`. It errs by 40
//!    of `|v| <= l` by rounding, and by `6 D_i |v|` with Q.
//! 7. **P** is rounded by 2 R at the base, and at each sum.
//! 8. The chain that the CPU builds is placed in double precision, far from the origin of the mesh
//!    too. No robot is computed here whose places are rounded by more than 2^-8 u R there.
//!
//! A link is moved by delta at most, and its axis turns: a chord has at least 2 / pi of its arc,
//! because no segment turns by more than pi. So the axis turns by at most `2 delta / (0.63 c)`, and
//! the rim of a flat cap moves by less than `4 delta r / c` with it.

use super::bounds::{FLAT_ERROR, SearchCap, TURN_ERROR, UNIT};
use super::robots::{BendingQuery, Packed, bytes_of, is_fine};
use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::distance::lanes::Lane;
use crate::mesh::SearchFrame;
use crate::robot::{BendingSection, ConstantCurvature};
use crate::robot::{COORDINATE_LIMIT, Chain, RobotError};
use gpu_batch::wgpu::WriteOnly;
use gpu_batch::wgsl;
use parry3d_f64::math::{Pose, Real, Vector};
use std::f64::consts::{PI, TAU};

/// The degree of the polynomials.
const DEGREE: u32 = 9;
/// How many `f32` the base takes: its position, its quaternion, and one that is unused.
pub(super) const BASE_SIZE: u32 = 8;
/// The least ratio of two radii at which the wider link certainly ends in a flat cap.
const STEP: Real = 1.0 + 1.0 / 1_048_576.0;

/// Robots of sections of constant curvature, in one pose. Each section has as many links as there
/// are segments.
pub(super) struct BentRobots<'a, S> {
    robots: &'a [S],
    /// The number of sections of most robots. The device gets no others.
    pub each: usize,
    pub segments: usize,
    /// A rigid pose.
    pub pose: Pose,
}

impl<S> Copy for BentRobots<'_, S> {}
impl<S> Clone for BentRobots<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<'a, S: AsRef<[BendingSection]>> BentRobots<'a, S> {
    pub(super) fn new(robots: &'a [S], segments: usize, pose: Pose) -> Self {
        let each = majority(robots.iter().map(|sections| sections.as_ref().len()));
        Self { robots, each, segments: segments.max(1), pose }
    }

    pub(super) fn sections(self, robot: usize) -> &'a [BendingSection] {
        self.robots[robot].as_ref()
    }

    /// The robot as a chain.
    ///
    /// # Errors
    /// A section is invalid, or its points make no chain.
    pub(super) fn chain(self, robot: usize) -> Result<Chain, RobotError> {
        ConstantCurvature::new(self.sections(robot))?.chain(self.segments)
    }

    /// `more_error` of the links of a robot. `None` if the device cannot search for the robot: the
    /// number of its sections differs, a number is invalid or nearly out of range, a section bends
    /// too much, or the bounds would be loose.
    fn more_error(self, sections: &[BendingSection], frame: &SearchFrame) -> Option<f32> {
        if sections.len() != self.each || sections.is_empty() {
            return None;
        }
        let [unit, flat_error, turn_error] = [UNIT, FLAT_ERROR, TURN_ERROR].map(Real::from);
        let base = ((self.pose.translation - frame.centre) * frame.scale).length();
        let all: Real = sections.iter().map(|section| section.length).sum();
        let reach = base + all * frame.scale;
        // The largest coordinate in the mesh's frame, where the chain is placed and measured.
        let largest = self.pose.translation.abs().max_element() + all;
        let (mut error, mut turn) = (2.0 * reach, 1.0);
        // Of the link that is shortest beside its radius, and of the shortest and the thickest.
        let (mut thickness, mut shortest, mut thickest) = (0.0, Real::INFINITY, 0.0);
        for &BendingSection { length, radius, bend: [x, y] } in sections {
            let (arc, radius) = (length * frame.scale, radius * frame.scale);
            let angle = Vector::new(x, y, 0.0).length() * length;
            let per_link = arc / self.segments as Real;
            // NaN is no angle, no length and no radius either.
            let is_computed = angle <= TAU
                && angle <= PI * self.segments as Real
                && arc > 0.0
                && (0.0..=<f32 as Lane>::FARTHEST).contains(&radius);
            if !is_computed {
                return None;
            }
            let growth = libm::exp(0.5 * angle);
            error += arc * (90.0 * growth + 7.0 * turn + 40.0) + 2.0 * reach;
            turn += 40.0 * growth + 8.0;
            thickness = Real::max(thickness, radius / per_link);
            shortest = Real::min(shortest, per_link);
            thickest = Real::max(thickest, radius);
        }
        let delta = unit * error;
        let more = delta * (1.0 + 4.0 * thickness);
        let reach = reach.max(thickest).max(1.0);
        let bounds = reach * (flat_error + turn_error * thickness / 0.6);
        let is_resolved = is_fine(frame)
            && largest + thickest / frame.scale <= 0.5 * COORDINATE_LIMIT
            // The rounding of a placed robot in double precision (`PlacedRobot`).
            && 384.0 * Real::UNIT_ROUNDOFF * largest * frame.scale
                <= Real::from(f32::EPSILON) * 1e-3 * reach.max(1.0)
            && reach <= <f32 as Lane>::FARTHEST
            && 16.0 * delta <= shortest
            // Few robots are so near the margin that the CPU must build their chains.
            && bounds + more <= frame.typical;
        is_resolved.then(|| (more as f32).next_up())
    }

    /// The caps of a link: flat at both ends of the robot and at the wider side of a step in
    /// radius. Algorithm 1 may choose either cap elsewhere.
    pub(super) fn caps(self, sections: &[BendingSection], link: usize) -> [SearchCap; 2] {
        let (section, segment) = (link / self.segments, link % self.segments);
        let is_wider = |other: Option<&BendingSection>| {
            other.is_none_or(|other| sections[section].radius > other.radius * STEP)
        };
        let is_start = segment == 0
            && is_wider(section.checked_sub(1).and_then(|before| sections.get(before)));
        let is_end = segment + 1 == self.segments && is_wider(sections.get(section + 1));
        [is_start, is_end].map(|is_flat| if is_flat { SearchCap::Flat } else { SearchCap::Either })
    }
}

impl<S: AsRef<[BendingSection]> + Sync> Packed for BentRobots<'_, S> {
    /// The device gets three numbers of a section where it gets three of each point of a chain, so
    /// small chunks would mostly wait.
    const CHUNK: usize = 1 << 15;

    fn len(self) -> usize {
        self.robots.len()
    }

    fn links(self, _: usize) -> usize {
        self.each.saturating_mul(self.segments)
    }

    fn is_like_before(self, robot: usize) -> bool {
        let radii = |robot| self.sections(robot).iter().map(|section| section.radius);
        radii(robot).eq(radii(robot - 1))
    }

    fn write_radii(self, robot: usize, frame: &SearchFrame, bytes: WriteOnly<[u8]>) {
        let sections = self.sections(robot);
        let (pairs, _) = bytes.into_chunks::<8>();
        for (link, pair) in pairs.into_iter().enumerate() {
            let Some(section) = sections.get(link / self.segments) else { return };
            let radius = (section.radius * frame.scale) as f32;
            pair.write(bytes_of([radius, SearchCap::code(self.caps(sections, link))]));
        }
    }

    fn bending(self, robots: usize) -> Option<BendingQuery> {
        Some(BendingQuery {
            robots: robots as u32,
            sections: self.each as u32,
            segments: self.segments as u32,
        })
    }

    fn write_base(self, frame: &SearchFrame, bytes: &mut Vec<u8>) {
        let place = frame.point::<f32>(self.pose.translation);
        let turn = self.pose.rotation;
        let [x, y, z, w] = [turn.x, turn.y, turn.z, turn.w].map(|number| number as f32);
        let base = [place.x, place.y, place.z, x, y, z, w, 0.0];
        bytes.extend::<[u8; 4 * BASE_SIZE as usize]>(bytes_of(base));
    }

    fn shape_size(self, links: u32) -> usize {
        if links == 0 { 0 } else { 12 * self.each }
    }

    fn write_shape(
        self,
        robot: usize,
        frame: &SearchFrame,
        bytes: WriteOnly<[u8]>,
    ) -> Result<Option<f32>, ProximityError> {
        let sections = self.sections(robot);
        let Some(error) = self.more_error(sections, frame) else {
            ConstantCurvature::new(sections)?;
            return Ok(None);
        };
        let (rows, _) = bytes.into_chunks::<12>();
        for (row, section) in rows.into_iter().zip(sections) {
            let BendingSection { length, bend: [x, y], .. } = *section;
            let numbers = [length * frame.scale, x * length, y * length];
            row.write(bytes_of(numbers.map(|number| number as f32)));
        }
        Ok(Some(error))
    }
}

/// The number that more than half of all are, if there is one; else any of them. (Boyer and Moore:
/// each number cancels another one.)
fn majority(numbers: impl Iterator<Item = usize>) -> usize {
    let (mut most, mut lead) = (0, 0_usize);
    for number in numbers {
        match lead.checked_sub(1) {
            _ if number == most => lead += 1,
            Some(less) => lead = less,
            None => (most, lead) = (number, 1),
        }
    }
    most
}

/// The coefficients of cos(h) and of sin(h) / h as polynomials of `h^2`, the constant first.
pub(super) fn coefficients() -> [[f32; DEGREE as usize + 1]; 2] {
    let mut factorial = 1.0_f64;
    let (mut cosine, mut sinc) = ([0.0; DEGREE as usize + 1], [0.0; DEGREE as usize + 1]);
    for (k, (cosine, sinc)) in (0..=DEGREE).zip(cosine.iter_mut().zip(&mut sinc)) {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let next = factorial * f64::from(2 * k + 1);
        (*cosine, *sinc) = ((sign / factorial) as f32, (sign / next) as f32);
        factorial = next * f64::from(2 * k + 2);
    }
    [cosine, sinc]
}

/// The constants and polynomials of the kernel.
pub(super) fn constants() -> String {
    let [cosine, sinc] = coefficients().map(|coefficients| {
        let (last, others) = coefficients.split_last().unwrap_or((&0.0, &[]));
        let last = format!("{last:e}f");
        others.iter().rev().fold(last, |inner, first| format!("{first:e}f + t * ({inner})"))
    });
    let function = |name, text| format!("fn {name}(t: f32) -> f32 {{\n    return {text};\n}}\n");
    wgsl::constant("BASE_SIZE", format_args!("{BASE_SIZE}u"))
        + &function("cosine_of_root", cosine)
        + &function("sinc_of_root", sinc)
}
