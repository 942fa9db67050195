//! The directions of the least translation that separates a link from a triangle.
//!
//! ```text
//!      ________________
//!     |  link          |
//!     |          .|    |      ---> n
//!     |________.' |____|
//!            .'   | triangle
//!            |<------->|
//!             depth(n)
//! ```
//!
//! # Definitions
//! `depth(n)`: the translation of the triangle along the unit vector `n` that separates the two:
//! the last point of the link along `n` minus the first point of the triangle.
//!
//! # Claim
//! The least depth belongs to one of these normals or its opposite:
//!
//! | link | triangle | normal |
//! |---|---|---|
//! | any | face | the face's |
//! | flat cap | any | the axis |
//! | barrel | edge | perpendicular to both |
//! | barrel | vertex | from the axis to the vertex, perpendicular to the axis |
//! | half ball | edge | from the centre to the edge, perpendicular to the edge |
//! | half ball | vertex | from the centre to the vertex |
//! | rim | edge | perpendicular to the edge, by [`ellipse`](super::ellipse) |
//!
//! Last row: projected along the edge, the rim is half an ellipse and the edge a point. The normal
//! is the normal at the ellipse's point closest to this point.
//!
//! # Proof
//! The least depth is the distance from the origin to the surface of the Minkowski difference of
//! the two bodies. The difference is convex. Its surface consists of pieces, each the difference of
//! a piece of the link and a piece of the triangle. From inside a convex body a sharp edge is never
//! the closest point of the surface. So the closest point lies inside a smooth piece, where the
//! normal points at the origin. The rows are the smooth pieces. (A rim and a vertex differ by a
//! circle, which is sharp.)
//!
//! # Rounding
//! `depth` is evaluated for the rounded normal, so the translation always separates. The depth is
//! least there, so a small error of the normal changes it only by the square of that error.

use super::direction::{perpendicular, unit, unit_across};
use super::ellipse::way_out_above;
use crate::distance::Link;
use parry3d_f64::math::{Real, Vector, Vector2};

/// Passes the unit normals of the table, except the face's, and their opposites to `consider`, one
/// by one.
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
        // If the vertex is on the axis, all directions across are equally good.
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

/// Returns the normal of the last row: the disc around the origin that faces `outward`, and the
/// line along the unit vector `edge` through `point`.
pub(crate) fn across_rim(
    outward: Vector,
    radius: Real,
    point: Vector,
    edge: Vector,
) -> Option<Vector> {
    // The half axes of the projection: `long` is in the disc's plane, `short` points to the side
    // that the disc faces.
    let long = unit_across(outward.cross(edge), edge)?;
    let lean = outward.dot(edge);
    let short = unit_across(outward - edge * lean, edge)?;
    let place = Vector2::new(point.dot(long), point.dot(short)) / radius;
    let way = way_out_above(place, lean.abs())?;
    unit(long * way.x + short * way.y)
}
