//! How far the points of a link have moved from one placement to another: an upper bound.

use crate::distance::Scalar;
use crate::pair::PlacedRobot;
use crate::robot::{LinkNode, ModifiedCylinder, length};
use parry3d_f64::math::{Real, Vector};
use std::slice;

/// A bound on the rounding of a distance that is known for one placement of a link and used for
/// another: 256 u, relative to the coordinates of mesh and link.
///
/// **Derivation.** Let all coordinates be at most 1.
/// - Each of the two distances errs by `16 u` of its extent, which is at most 2: `64 u`.
/// - The ends of a link and their differences err by `8 u` at each placement: `16 u`.
/// - The turn of a flat cap errs by `18 u` ([`ReferenceOutline::moved_to`]).
///
/// The sum of 98 u is less than half of the constant.
pub(crate) const MOVED_ROUNDING: Real = 256.0 * Real::UNIT_ROUNDOFF;

/// A link in the mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedOutline {
    /// The ends of the axis.
    pub ends: [Vector; 2],
    pub radius: Real,
    pub flat: [bool; 2],
}

/// A link at the placement from which its motion is measured.
#[derive(Clone, Copy)]
pub(crate) struct ReferenceOutline {
    link: PlacedOutline,
    /// A power of two that scales lengths to about 1, and its inverse.
    scale: Real,
    unit: Real,
    /// The inverse of twice the scaled length of the axis; 0 if both caps are round.
    per_length: Real,
}

/// The links of a robot with their numbers, from the tip to the base.
struct FromTip<'a> {
    robot: PlacedRobot<'a>,
    links: slice::Iter<'a, ModifiedCylinder>,
    /// The start of the link after this one, in the robot's frame and placed.
    shared: Option<[Vector; 2]>,
}

impl Iterator for FromTip<'_> {
    type Item = (usize, PlacedOutline);

    // A call costs as much as a link.
    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let link = self.links.next_back()?;
        let end = match self.shared {
            Some([point, placed]) if point == link.end() => placed,
            _ => self.robot.placed(link.end()),
        };
        let start = self.robot.placed(link.start());
        self.shared = Some([link.start(), start]);
        let ends = [start, end];
        let outline = PlacedOutline { ends, radius: link.radius(), flat: link.flat() };
        // The number of links before this one is its number.
        Some((self.links.len(), outline))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.links.size_hint()
    }
}

impl PlacedOutline {
    pub(crate) fn of(robot: PlacedRobot, link: usize) -> Self {
        Self::of_node(robot, &LinkNode::Leaf(link))
    }

    /// The capsule around all links, or the only link.
    pub(crate) fn around_all(robot: PlacedRobot) -> Self {
        Self::of_node(robot, &robot.link_tree()[0])
    }

    fn of_node(robot: PlacedRobot, node: &LinkNode) -> Self {
        let (ends, radius, flat) = robot.outline(node);
        Self { ends, radius, flat }
    }

    /// The robot as one link from its base to its tip, with the radius and caps of the last link.
    pub(crate) fn of_whole(robot: PlacedRobot) -> Self {
        let tip = &robot.links()[robot.links().len() - 1];
        Self { ends: robot.ends(), radius: tip.radius(), flat: tip.flat() }
    }

    /// All links with their numbers, from the tip to the base. An end that two links share is
    /// placed once.
    pub(crate) fn of_all(robot: PlacedRobot) -> impl Iterator<Item = (usize, Self)> {
        FromTip { robot, links: robot.links().iter(), shared: None }
    }

    /// The largest coordinate.
    pub(crate) fn extent(&self) -> Real {
        self.ends[0].abs().max(self.ends[1].abs()).max_element() + self.radius
    }

    /// The length with one radius added at each end.
    #[cfg(feature = "robots")]
    pub(crate) fn size(&self) -> Real {
        length(self.along()) + 2.0 * self.radius
    }

    pub(crate) fn along(&self) -> Vector {
        self.ends[1] - self.ends[0]
    }
}

impl ReferenceOutline {
    /// `mesh_reach` is the largest coordinate of the mesh.
    pub(crate) fn new(link: PlacedOutline, mesh_reach: Real) -> Self {
        let scale = (mesh_reach + link.extent()).power_of_two_to_unity();
        let per_length =
            if link.flat == [false; 2] { 0.0 } else { 0.5 / (length(link.along()) * scale) };
        Self { link, scale, unit: 1.0 / scale, per_length }
    }

    /// Returns an upper bound m on the distance of any point of the link `now` from the link then.
    /// NaN if the caps differ.
    ///
    /// **Definitions.** d, d': the vectors from start to end, then and now. a, a': their
    /// directions. r: the radius now. `x = |d' - d| / (2 |d|)`.
    ///
    /// **Claim.** `m = s + t + g`.
    /// - s is the larger displacement of the two ends.
    /// - `t = 2 r x (1 + 2 x)` with x limited to 1/2; 0 if both caps are round.
    /// - g is the growth of the radius, at least 0.
    ///
    /// **Proof.**
    /// 1. No point of the axis moves farther than the farther of its ends. The ball around that
    ///    point moves with it: s.
    /// 2. A radius that grows adds its growth: g.
    /// 3. At a flat cap the ball becomes a disc, which turns with the axis. Its rim moves by at
    ///    most `r |a' - a| <= 2 r |d' - d| / (|d'| + |d|)` (Dunkl and Williams, 1964).
    /// 4. Since `|d'| >= |d| - |d' - d|`, the bound of 3 is at most `2 r x / (1 - x)`. For
    ///    `x <= 1/2` that is at most `2 r x (1 + 2 x)`, which is `2 r` at 1/2. No turn moves the
    ///    rim farther than `2 r`.
    ///
    /// **Rounding.** d and d' err by u of themselves, and so x by less than `3 u` for `x <= 1/2`.
    /// The derivative of t is at most `6 r`, so t errs by `18 u r`, which [`MOVED_ROUNDING`] times
    /// the extent includes. A square vanishes if its root is below 2^-537 of the extent and the
    /// mesh. The radius of a flat cap is less than 2^400 lengths of its axis, so at most 2^-136 of
    /// the extent is lost.
    #[inline(always)] // in the loop over all links
    pub(crate) fn moved_to(&self, now: &PlacedOutline) -> Real {
        let then = &self.link;
        if now.flat != then.flat {
            return Real::NAN;
        }
        let squared = |way: Vector| (way * self.scale).length_squared();
        let [start, end] =
            [squared(now.ends[0] - then.ends[0]), squared(now.ends[1] - then.ends[1])];
        let grown = (now.radius - then.radius).max(0.0);
        let turned = if now.flat == [false; 2] {
            0.0
        } else {
            let x = squared(now.along() - then.along()).sqrt() * self.per_length;
            // NaN counts as 1/2: no turn exceeds half a revolution.
            let x = if x < 0.5 { x } else { 0.5 };
            2.0 * now.radius * (x * (1.0 + 2.0 * x))
        };
        start.max(end).sqrt() * self.unit + turned + grown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::{Vec3, point_modified_cylinder};
    use continuum_testing::Random;

    /// A point of a link on its rims, or on the half balls of its round ends.
    fn extreme(random: &mut Random, link: &PlacedOutline) -> Vector {
        let (end, direction) = (random.below(2) as usize, random.direction());
        let outward = link.along().normalize() * [-1.0, 1.0][end];
        let ahead = direction.dot(outward);
        let flat = (direction - outward * ahead).normalize();
        let out = if link.flat[end] { flat } else { direction * ahead.signum() };
        link.ends[end] + out * link.radius
    }

    /// No point of a moved link is farther from the link then than the bound, in any unit of
    /// length. Some points are nearly as far.
    #[test]
    fn no_point_has_moved_farther_than_told() {
        let (mut nearly, mut turned, mut jumps) = (0, 0, 0);
        for seed in 0..20_000_u64 {
            let random = &mut Random::new(seed);
            let size = [1.0, 2.0_f64.powi(-460), 2.0_f64.powi(300)][seed as usize % 3];
            let flat = [0; 2].map(|_| random.below(2) == 0);
            let (start, way) =
                (random.point(), random.direction() * 10.0_f64.powf(random.between(-2.0, 0.5)));
            let radius = 10.0_f64.powf(random.between(-2.0, 0.5));
            let step = 10.0_f64.powf(random.between(-4.0, 0.5));
            let (shift, turn) = match random.below(3) {
                0 => (Vector::ZERO, random.direction()),
                1 => (random.direction(), Vector::ZERO),
                _ => (random.point(), random.point()),
            };
            let grown = if random.below(3) == 0 { random.between(-0.5, 0.5) * radius } else { 0.0 };
            let link = |from: Vector, way: Vector, radius: Real| PlacedOutline {
                ends: [from * size, (from + way) * size],
                radius: radius * size,
                flat,
            };
            let then = link(start, way, radius);
            let now =
                link(start + shift * step, way + turn * (step * way.length()), radius + grown);
            let told = ReferenceOutline::new(then, 4.0 * size).moved_to(&now);
            let [from, to] = then.ends.map(Vec3::from);
            let farthest = (0..40).map(|_| {
                let point = Vec3::from(extreme(random, &now));
                point_modified_cylinder(point, from, to, then.radius, flat).distance
            });
            let farthest = farthest.fold(0.0, Real::max);
            assert!(farthest <= told + 1e-12 * size, "seed {seed}: {farthest:e} of {told:e}");
            nearly += u32::from(farthest > 0.9 * told);
            turned += u32::from(
                shift == Vector::ZERO && radius > 3.0 * way.length() && farthest > 0.6 * told,
            );
            jumps += u32::from((now.along() - then.along()).length() > way.length() * size);
        }
        assert!(nearly > 1000 && turned > 300 && jumps > 1000, "{nearly} {turned} {jumps}");
    }
}
