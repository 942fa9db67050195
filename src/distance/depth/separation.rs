//! The least translation that separates a link from a triangle that it overlaps.
//!
//! Along the unit vector `n` the triangle has to be moved by `depth(n)`, the end of the link in the
//! direction `n` minus the beginning of the triangle. The least depth is the distance from the
//! origin to the surface of the difference of the two bodies, which is convex and whose surface
//! consists of pieces, each the difference of a piece of the link and a piece of the triangle. From
//! within a convex body a sharp edge is never the closest point of the surface, so the least depth
//! is that of a point inside a smooth piece, where the normal points at the origin. The pieces and
//! the normals that can be so:
//!
//! | link | triangle | normal |
//! |---|---|---|
//! | any | face | the face's |
//! | flat cap | any | the axis |
//! | barrel | edge | perpendicular to both |
//! | barrel | vertex | from the axis to the vertex, perpendicular to the axis |
//! | half ball | edge | from the centre to the edge, perpendicular to the edge |
//! | half ball | vertex | from the centre to the vertex |
//! | rim | edge | perpendicular to the edge; along it, the rim's shadow is half an ellipse and the edge a point, whose way out is that of [`ellipse`](super::ellipse) |
//!
//! (A rim and a vertex differ by a circle, which is sharp.) Whatever a normal's rounding, `depth`
//! is that of the normal as it stands, so the translation separates; and as the depth is least
//! there, a small error of the normal costs its square.

use super::direction::{perpendicular, unit, unit_across};
use super::ellipse::way_out_above;
use crate::distance::Link;
use parry3d_f64::math::{Real, Vector, Vector2};

/// The unit normals of the table and their opposites, handed one by one to `consider`.
pub(super) fn directions(
    link: &Link<Real>,
    triangle: [Vector; 3],
    mut consider: impl FnMut(Vector),
) {
    let [a, b, c] = triangle;
    let edges = [b - a, c - b, a - c].map(unit);
    let axis = unit(Vector::from(link.axis));
    let mut both_ways = |n: Option<Vector>| {
        if let Some(n) = n {
            consider(n);
            consider(-n);
        }
    };
    both_ways(axis);
    for edge in edges.into_iter().flatten() {
        both_ways(axis.and_then(|axis| unit_across(edge.cross(axis), edge)));
    }
    for vertex in triangle {
        // On the axis all ways out are as long.
        let lateral =
            axis.map(|axis| unit_across(vertex, axis).unwrap_or_else(|| perpendicular(axis)));
        both_ways(lateral);
    }
    for end in 0..2 {
        let centre = if end == 0 { Vector::ZERO } else { Vector::from(link.end) };
        for (corner, vertex) in triangle.into_iter().enumerate() {
            let offset = vertex - centre;
            if link.flat[end] {
                let outward = axis.map(|axis| if end == 0 { -axis } else { axis });
                let faced = outward.zip(edges[corner]);
                both_ways(faced.and_then(|(way, edge)| across_rim(way, link.radius, offset, edge)));
            } else {
                both_ways(unit(offset));
                both_ways(edges[corner].and_then(|edge| unit_across(offset, edge)));
            }
        }
    }
}

/// The last row of the table: the disc around the origin that faces `outward`, and the line along
/// the unit vector `edge` through `point`.
pub(crate) fn across_rim(
    outward: Vector,
    radius: Real,
    point: Vector,
    edge: Vector,
) -> Option<Vector> {
    // Half axes of the shadow: `long` is in the disc's plane, `short` is the way that the disc
    // faces.
    let long = unit_across(outward.cross(edge), edge)?;
    let lean = outward.dot(edge);
    let short = unit_across(outward - edge * lean, edge)?;
    let place = Vector2::new(point.dot(long), point.dot(short)) / radius;
    let way = way_out_above(place, lean.abs())?;
    unit(long * way.x + short * way.y)
}
