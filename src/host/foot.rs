//! The foot of a contact on a link's axis. It decides whether the contact of the link equals the
//! contact of its capsule: see `distance/depth/foot.rs`.

use super::axial::axis_or_x;
use crate::distance::depth::to_flat;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};

/// A point of a link's axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisFoot {
    /// Distance along the axis to the nearest flat end; infinite if both ends are round.
    pub to_flat: Real,
}

impl AxisFoot {
    pub fn new(link: &ModifiedCylinder, on_axis: Vector) -> Self {
        let axis = axis_or_x(link);
        Self { to_flat: to_flat(on_axis - link.start(), link.end() - on_axis, axis, link.flat()) }
    }
}
