//! How a pair of shapes is taken apart.

use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{CompositeShape, HeightField, Shape, Voxels};

/// The shape of a pair that consists of others.
pub(super) enum Decomposition<'a> {
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

impl<'a> Decomposition<'a> {
    /// The first shape is taken apart first.
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

/// Whether parry finds the cells of a shape.
///
/// # Errors
/// [`Unsupported`] for height fields and voxels that a negative scale mirrors: of these parry looks
/// for cells between a box's upper corner and its lower one, where there are none.
pub(super) fn check_scale(shape: &dyn Shape) -> Result<(), Unsupported> {
    let scale = shape
        .as_heightfield()
        .map(HeightField::scale)
        .or_else(|| shape.as_voxels().map(Voxels::voxel_size));
    if scale.is_some_and(|scale| scale.min_element() < 0.0) { Err(Unsupported) } else { Ok(()) }
}

/// Whether `shape` consists of others.
pub(super) fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_composite_shape().is_some()
        || shape.as_heightfield().is_some()
        || shape.as_voxels().is_some()
}
