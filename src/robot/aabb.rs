//! The tight box around a link.
//!
//! A link is convex: the hull of what its two ends hold, a disc each, and on round ends the outward
//! half ball. So the box is that of the two ends. With n the end's outward unit axis and e a unit
//! vector along a coordinate axis, the disc reaches r |n x e| from its centre along e, and the half
//! ball reaches r if n . e >= 0 and no further than the disc otherwise.

use super::scale::direction;
use super::{Cap, ModifiedCylinder};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::{Pose, Vector};

impl ModifiedCylinder {
    /// The smallest box along the coordinate axes of the link's own frame that holds the link.
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

    /// The smallest box along the coordinate axes of the frame that `pose` leads to, for the link
    /// moved there.
    pub fn aabb(&self, pose: &Pose) -> Aabb {
        self.transformed(pose).local_aabb()
    }

    /// How far an end with the outward axis `outward` reaches downwards and upwards along each
    /// coordinate axis.
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
