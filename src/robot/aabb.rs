//! The tight bounding box of a link.
//!
//! # Definitions
//! - `n`: the outward unit axis at an end. `e`: a unit vector along a coordinate axis.
//!
//! # Formula
//! A link is the convex hull of its two ends: a disc each, plus the outward half ball at a round
//! end. So its box is the box of the two ends. From the end's centre along e,
//!
//! - the disc reaches `r |n x e|`;
//! - the half ball reaches `r` if `n . e >= 0`, and otherwise no further than the disc.

use super::scale::direction;
use super::{Cap, ModifiedCylinder};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Vector};

impl ModifiedCylinder {
    /// Returns the smallest axis-aligned box that contains the link, in the link's own frame.
    ///
    /// Each side is right within a few units in the last place of its coordinate and the radius.
    pub fn local_aabb(&self) -> Aabb {
        let axis = direction(self.end() - self.start());
        let square = axis * axis;
        let disc = Vector::new(square.y + square.z, square.z + square.x, square.x + square.y)
            .map(|s| s.sqrt());
        let [back, front] = self.caps();
        let (low_at_start, high_at_start) = self.reach(disc, -axis, back);
        let (low_at_end, high_at_end) = self.reach(disc, axis, front);
        Aabb::new(
            (self.start() - low_at_start).min(self.end() - low_at_end),
            (self.start() + high_at_start).max(self.end() + high_at_end),
        )
    }

    /// Returns the smallest axis-aligned box of the link moved by `pose`.
    pub fn aabb(&self, pose: &Pose) -> Aabb {
        self.transformed(pose).local_aabb()
    }

    /// Returns how far an end reaches along each negative and each positive coordinate axis.
    fn reach(&self, disc: Vector, outward: Vector, cap: Cap) -> (Vector, Vector) {
        let r = self.radius();
        let side = |outward: f64, disc: f64| {
            r * if cap == Cap::Round && outward >= 0.0 { 1.0 } else { disc }
        };
        let sides = |outward: Vector| {
            Vector::new(side(outward.x, disc.x), side(outward.y, disc.y), side(outward.z, disc.z))
        };
        (sides(-outward), sides(outward))
    }
}
