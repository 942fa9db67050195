//! Which shape of a pair is split into parts.

use super::robot_surface::links_of;
use parry3d_f64::query::Unsupported;
use parry3d_f64::shape::{CompositeShape, Compound, HeightField, Shape};

/// Which shape of a pair is split.
pub(super) enum Decomposition<'a> {
    /// The first shape is a composite: a chain, a mesh, a polyline, a compound.
    Composite(&'a (dyn CompositeShape + Sync)),
    /// The first shape is a height field.
    Field(&'a HeightField),
    /// Only the second shape has parts.
    OfSecond,
}

impl<'a> Decomposition<'a> {
    /// Splits the first shape first. `None` if neither shape has parts.
    ///
    /// # Errors
    /// As [`check_pair`].
    pub fn of(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Option<Self>, Unsupported> {
        check_pair(g1, g2)?;
        Ok(if let Some(composite) = g1.as_composite_shape() {
            Some(Self::Composite(composite))
        } else if let Some(field) = g1.as_heightfield() {
            Some(Self::Field(field))
        } else {
            has_parts(g2).then_some(Self::OfSecond)
        })
    }
}

/// Checks that a pair can be split.
///
/// # Errors
/// - [`Unsupported`] for a link and voxels: parry's routines for voxels have absolute tolerances.
/// - [`Unsupported`] for a height field that a negative scale mirrors. parry searches its cells
///   from a box's upper corner to its lower one, where there are none.
pub(super) fn check_pair(g1: &dyn Shape, g2: &dyn Shape) -> Result<(), Unsupported> {
    let has_link = |shape: &dyn Shape| {
        let parts = shape.as_compound().map(Compound::shapes).unwrap_or_default();
        links_of(shape).is_some() || parts.iter().any(|(_, part)| links_of(&**part).is_some())
    };
    let is_mirrored = |shape: &dyn Shape| {
        shape.as_heightfield().is_some_and(|field| field.scale().min_element() < 0.0)
    };
    let is_refused = is_mirrored(g1)
        || is_mirrored(g2)
        || g1.as_voxels().is_some() && has_link(g2)
        || g2.as_voxels().is_some() && has_link(g1);
    if is_refused { Err(Unsupported) } else { Ok(()) }
}

/// Returns whether `shape` has parts.
pub(super) fn has_parts(shape: &dyn Shape) -> bool {
    shape.as_composite_shape().is_some() || shape.as_heightfield().is_some()
}
