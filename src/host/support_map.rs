//! The support map of a link, and its polygonal features for parry's generic algorithms.
//!
//! # Support map
//! The support point of a direction belongs to the end towards which the direction leans. On a half
//! ball it is one radius along the direction. On a disc it is one radius along the direction's
//! component perpendicular to the axis. (The other end's best point is at most the first end's rim,
//! shifted back along the axis.)
//!
//! # Polygonal features
//! They are approximations, because parry's clipping supports polygons of at most four vertices. A
//! flat cap is a square inscribed in its disc, with one corner at the requested azimuth. Everything
//! else is a segment along the barrel between support points of the two ends. Only contact
//! manifolds against shapes without a closed form use them; no distance, contact or ray does.

use super::axial::{axis_or_x, perpendicular, unit, unit_across};
use super::feature::{self, crest_end};
use super::support_points::centre;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::{PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, SupportMap};

/// Exact support points (see the head of this file). A direction of length zero gives the start
/// point.
impl SupportMap for ModifiedCylinder {
    fn local_support_point(&self, dir: Vector) -> Vector {
        unit(dir).map_or(self.start(), |dir| self.local_support_point_toward(dir))
    }

    fn local_support_point_toward(&self, dir: Vector) -> Vector {
        let axis = axis_or_x(self);
        let end = usize::from(axis.dot(dir) > 0.0);
        let offset = match self.caps()[end] {
            Cap::Round => dir,
            Cap::Flat => unit_across(dir, axis).unwrap_or(Vector::ZERO),
        };
        centre(self, end) + offset * self.radius()
    }
}

/// A polygon near the support point (see the head of this file).
impl PolygonalFeatureMap for ModifiedCylinder {
    fn local_support_feature(&self, dir: Vector, out_feature: &mut PolygonalFeature) {
        let axis = axis_or_x(self);
        let azimuth = unit_across(dir, axis).unwrap_or_else(|| perpendicular(axis));
        *out_feature = feature_at(self, axis, dir, azimuth);
    }

    fn local_support_feature_toward(
        &self,
        dir: Vector,
        hint: Vector,
        out_feature: &mut PolygonalFeature,
    ) {
        let axis = axis_or_x(self);
        let azimuth = unit_across(0.5 * hint - 0.5 * self.start(), axis)
            .or_else(|| unit_across(dir, axis))
            .unwrap_or_else(|| perpendicular(axis));
        *out_feature = feature_at(self, axis, dir, azimuth);
    }
}

/// Returns the polygon for the unit direction `dir` with a corner at `azimuth`.
fn feature_at(
    link: &ModifiedCylinder,
    axis: Vector,
    dir: Vector,
    azimuth: Vector,
) -> PolygonalFeature {
    let lean = axis.dot(dir);
    let end = usize::from(lean > 0.0);
    let radius = link.radius();
    let mut polygon = PolygonalFeature::default();
    // A direction within 60 degrees of a disc's normal gives the disc, as for parry's cylinder.
    if link.caps()[end] == Cap::Flat && lean.abs() >= 0.5 {
        let across = axis.cross(azimuth);
        for (corner, offset) in [azimuth, across, -azimuth, -across].into_iter().enumerate() {
            polygon.vertices[corner] = centre(link, end) + offset * radius;
            polygon.vids[corner] = feature::square_corner(end, corner);
            polygon.eids[corner] =
                PackedFeatureId::edge(feature::SQUARE + (4 * end + corner) as u32);
        }
        polygon.fid = feature::CAP[end].into();
        polygon.num_vertices = 4;
    } else {
        for corner in 0..2 {
            let leans_out = corner == end && lean != 0.0;
            let on_ball = link.caps()[corner] == Cap::Round && leans_out;
            let offset = if on_ball { dir } else { azimuth };
            polygon.vertices[corner] = centre(link, corner) + offset * radius;
            polygon.vids[corner] = crest_end(corner);
        }
        polygon.vertices[2] = polygon.vertices[1];
        polygon.vertices[3] = polygon.vertices[1];
        polygon.vids[2] = polygon.vids[1];
        polygon.vids[3] = polygon.vids[1];
        polygon.eids = [PackedFeatureId::edge(feature::BARREL_LINE); 4];
        polygon.fid = feature::BARREL.into();
        polygon.num_vertices = 2;
    }
    polygon
}
