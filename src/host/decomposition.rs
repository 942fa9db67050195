//! How a pair of shapes is split into parts.

use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{CompositeShape, HeightField, Shape, Voxels};

/// Which shape of a pair is split.
pub(super) enum Decomposition<'a> {
    /// The first shape is a composite: a chain, a mesh, a polyline, a compound.
    Composite(&'a (dyn CompositeShape + Sync)),
    /// The first shape is a height field.
    Field(&'a HeightField),
    /// The first shape is made of voxels.
    Voxels(&'a Voxels),
    /// Only the second shape has parts.
    OfSecond,
    /// Neither shape has parts.
    None,
}

impl<'a> Decomposition<'a> {
    /// Splits the first shape first.
    ///
    /// # Errors
    /// As [`check_scale`].
    pub fn of(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Self, Unsupported> {
        check_scale(g1)?;
        check_scale(g2)?;
        Ok(if let Some(composite) = g1.as_composite_shape() {
            Self::Composite(composite)
        } else if let Some(field) = g1.as_heightfield() {
            Self::Field(field)
        } else if let Some(voxels) = g1.as_voxels() {
            Self::Voxels(voxels)
        } else if has_parts(g2) {
            Self::OfSecond
        } else {
            Self::None
        })
    }
}

/// Checks that parry finds the cells of a shape.
///
/// # Errors
/// [`Unsupported`] for height fields and voxels that a negative scale mirrors. parry searches their
/// cells from a box's upper corner to its lower one, where there are none.
pub(super) fn check_scale(shape: &dyn Shape) -> Result<(), Unsupported> {
    let scale = shape
        .as_heightfield()
        .map(HeightField::scale)
        .or_else(|| shape.as_voxels().map(Voxels::voxel_size));
    if scale.is_some_and(|scale| scale.min_element() < 0.0) { Err(Unsupported) } else { Ok(()) }
}

/// Returns whether `shape` has parts.
pub(super) fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_composite_shape().is_some()
        || shape.as_heightfield().is_some()
        || shape.as_voxels().is_some()
}
