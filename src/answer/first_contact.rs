//! When a motion meets the mesh. Points are in the mesh's frame and unit.

use parry3d_f64::math::{Real, Vector};

/// When a motion first comes as close to the mesh as a margin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::motion_serialised::First", into = "super::motion_serialised::First")
)]
#[non_exhaustive]
pub enum FirstContact {
    /// The clearance is more than the margin at every time from 0 to 1.
    Never,
    /// It first is at most the margin between two times.
    #[non_exhaustive]
    Within {
        /// The clearance is more than the margin before this time.
        clear_until: Real,
        /// The time of a shape whose clearance is at most the margin.
        t: Real,
        /// The clearance of that shape is at most this, which is at most the margin.
        upper: Real,
        /// The arc length on its centreline at the place that realises `upper`.
        arc_length: Real,
        /// The section of constant radius at that place, counted from the base.
        section: u32,
        /// The triangle there.
        triangle: u32,
        /// A point of the tube that is `upper` away from `on_mesh`, or nearer.
        on_robot: Vector,
        /// A point of the triangle; the same as `on_robot` where `upper` is 0.
        on_mesh: Vector,
    },
    /// No such shape was found, but one whose clearance is at most the margin and the resolution; or one in which the end
    /// of a link becomes flat or round, so close to the mesh that this decides.
    #[non_exhaustive]
    Undecided {
        /// The first interval of time in which there is one. The clearance is more than the margin before it.
        interval: [Real; 2],
    },
}
