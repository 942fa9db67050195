//! The points of a link and a triangle that separate last, along the least translation.
//!
//! # Definitions
//! - `m`: the unit vector of the least translation, from link to triangle.
//! - The link's foremost part: its points farthest along `m`. The triangle's foremost part: its
//!   points least far along `m`. After the translation the two parts touch. Numbers are near one,
//!   so a point belongs to a part if it is behind by less than [`TIE`].
//!
//! | the link's part | condition | the point that separates last |
//! |---|---|---|
//! | a line of the barrel | `m` perpendicular to the axis | the point closest to the triangle's part |
//! | a flat cap | `m` along the axis | the point closest to the triangle's part |
//! | a point of a rim | `m` leans towards a flat cap | this point |
//! | a point of a half ball | `m` leans towards a round cap | this point |
//!
//! A cap or a barrel that is no larger than rounding is a point.
//!
//! # Uniqueness
//! The depth is the least over the normals of `separation` and of the face. If another direction is
//! equally short within rounding, the derivative of the depth depends on the motion. If the
//! opposite direction is equally short, the link is on neither side of the triangle: its axis lies
//! in the plane of the wall, or the wall cuts it in equal halves.

use super::{LinkTriangle, Way, separation, unit_across};
use crate::distance::{Link, Scalar, Vec3, point_triangle, segment_triangle};
use parry3d_f64::math::{Real, Vector};

/// The tolerance for ties, for numbers near one.
const TIE: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// Two directions closer than this count as one: their derivatives agree within a millionth.
const ONE_DIRECTION: Real = 1.0 / 1_048_576.0;

/// The least translation that separates a link from a triangle, in coordinates relative to the
/// link's start and near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WayOut {
    /// Minus the length of the translation; positive if the two are apart.
    pub gap: Real,
    /// The unit vector from link to triangle.
    pub normal: Vector,
    /// Whether the opposite direction is longer.
    pub has_side: bool,
    /// Whether no other direction is equally short.
    pub is_alone: bool,
    /// The axis fraction, from 0 to 1, of the link's point that separates last.
    pub fraction: Real,
    /// The vector from the axis point to that point.
    pub lever: Vector,
    /// The triangle's point that separates last.
    pub on_triangle: Vector,
    /// Whether the link's point belongs to a flat cap or its rim.
    pub at_flat_cap: bool,
}

impl WayOut {
    pub(crate) fn new(pair: &LinkTriangle) -> Self {
        let axis = [Vec3::zero(0.0), pair.link.end];
        let to_axis = segment_triangle(axis, pair.triangle.map(Vec3::from));
        let outward = super::unit(Vector::from(to_axis.point2) - Vector::from(to_axis.point1));
        let way = pair.least_translation(outward);
        let SeparatingWay { fraction, lever, on_triangle, at_flat_cap } = pair.parting(way);
        Self {
            gap: way.gap,
            normal: way.normal,
            has_side: pair.gap(-way.normal) < way.gap - TIE,
            is_alone: pair.is_alone(way),
            fraction,
            lever,
            on_triangle,
            at_flat_cap,
        }
    }
}

/// The points that separate last.
struct SeparatingWay {
    fraction: Real,
    lever: Vector,
    on_triangle: Vector,
    at_flat_cap: bool,
}

impl LinkTriangle {
    /// Returns whether no other direction is equally short.
    fn is_alone(&self, way: Way) -> bool {
        let mut is_alone = true;
        let mut consider = |n: Vector| {
            let is_other = (n - way.normal).abs().max_element() > ONE_DIRECTION;
            is_alone &= !is_other || self.gap(n) < way.gap - TIE;
        };
        for n in super::face_normal(self.triangle).into_iter().flat_map(|n| [n, -n]) {
            consider(n);
        }
        separation::directions(&self.link, self.triangle, consider);
        is_alone
    }

    fn parting(&self, Way { normal, .. }: Way) -> SeparatingWay {
        let Link { end, axis, radius, flat } = self.link;
        let (end, axis) = (Vector::from(end), Vector::from(axis));
        let part = self.foremost(normal);
        let (length, lean) = (end.dot(axis), axis.dot(normal));
        if length > TIE && (lean * length).abs() <= TIE {
            let found = segment_triangle([Vec3::zero(0.0), end.into()], part.map(Vec3::from));
            let along = Vector::from(found.point1).dot(axis);
            return SeparatingWay {
                fraction: (along / length).clamp(0.0, 1.0),
                lever: normal * radius,
                on_triangle: found.point2.into(),
                at_flat_cap: false,
            };
        }
        let at_end = lean > 0.0;
        let (centre, fraction) = if at_end { (end, 1.0) } else { (Vector::ZERO, 0.0) };
        let nearest_to =
            |point: Vector| Vector::from(point_triangle(point.into(), part.map(Vec3::from)).point2);
        let at_flat_cap = flat[usize::from(at_end)];
        let lateral = unit_across(normal, axis).filter(|_| at_flat_cap);
        let across = (normal - axis * lean).length();
        // The rounding of a short axis turns a wide cap.
        if at_flat_cap && (lateral.is_none() || across * radius.min(length) <= TIE) {
            let on_triangle = nearest_to(centre);
            let offset = on_triangle - centre;
            let radial = offset - axis * offset.dot(axis);
            let reach = radial.length();
            let lever = if reach > radius { radial * (radius / reach) } else { radial };
            return SeparatingWay { fraction, lever, on_triangle, at_flat_cap };
        }
        let lever = lateral.unwrap_or(normal) * radius;
        SeparatingWay { fraction, lever, on_triangle: nearest_to(centre + lever), at_flat_cap }
    }

    /// Returns the triangle's foremost part along a unit vector: a vertex, an edge or the whole
    /// triangle, with repeated vertices.
    fn foremost(&self, normal: Vector) -> [Vector; 3] {
        let heights = self.triangle.map(|vertex| vertex.dot(normal));
        let least = heights[0].min(heights[1]).min(heights[2]) + TIE;
        let first = (0..3).find(|&corner| heights[corner] <= least).unwrap_or(0);
        std::array::from_fn(|corner| {
            self.triangle[if heights[corner] <= least { corner } else { first }]
        })
    }
}
