//! How a pair of shapes is taken apart.

use parry3d_f64::shape::{CompositeShape, HeightField, Shape, Voxels};

/// The shape of a pair that consists of others.
pub(super) enum Parts<'a> {
    /// The first shape is a composite: a chain, a mesh, a polyline, a compound.
    Composite(&'a (dyn CompositeShape + Sync)),
    /// The first shape is a height field.
    Field(&'a HeightField),
    /// The first shape is made of voxels.
    Voxels(&'a Voxels),
    /// Only the second shape consists of others.
    OfSecond,
    /// Neither does.
    None,
}

impl<'a> Parts<'a> {
    /// The first shape is taken apart first.
    pub fn of(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Self {
        if let Some(composite) = g1.as_composite_shape() {
            Self::Composite(composite)
        } else if let Some(field) = g1.as_heightfield() {
            Self::Field(field)
        } else if let Some(voxels) = g1.as_voxels() {
            Self::Voxels(voxels)
        } else if has_parts(g2) {
            Self::OfSecond
        } else {
            Self::None
        }
    }
}

/// Whether `shape` consists of others.
pub(super) fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_composite_shape().is_some() || shape.as_heightfield().is_some() || shape.as_voxels().is_some()
}
