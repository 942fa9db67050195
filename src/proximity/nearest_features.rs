//! Which features of a link and a triangle are nearest, and the normal between them.
//!
//! Let q be the axis point nearest to the triangle, p the triangle's point there and F their distance. Beside the link
//! and beyond a round cap the link's closest point lies on the way from q to p, one radius from q: the normal from wall
//! to robot is (q - p) / F, and it has a meaning as long as F > 0, even where the two overlap. Beyond a flat cap the
//! closest points x of the link and y of the triangle are those of the cap's disc, and the normal is (x - y) / |x - y|.
//!
//! One text for `f64` and for numbers of twice its digits. The difference of two points that are g apart turns by about
//! 4 u / g, for numbers near one; below a gap of 2^-8 that is too much, and the pair is done again with 32 digits.
//!
//! # Kinks
//! With the normal n fixed, let the triangle's foremost part be where <n, .> is greatest, and the link's where it is
//! least. The distance of two convex sets has a derivative along every motion if only one pair of points realises it
//! (Danskin's theorem), and more than one pair do only if both foremost parts are more than a point and share a
//! direction:
//!
//! - the link's is a line of its side, n being perpendicular to the axis; the triangle's its face, or an edge parallel
//!   to the axis;
//! - the link's is a flat cap, n being parallel to the axis; the triangle's an edge or its face.
//!
//! Rounding cannot tell a point that is farther by less than 64 u. Over a line of length l that is tilted by an angle a
//! against a plane the distance rises by l sin a; between two lines at an angle a, F apart, by (l sin a)^2 / (2 F).

use super::feature::{LinkFeature, TriangleFeature};
use super::placed::{PlacedLink, place_exactly};
use crate::distance::{Axial, DoubleDouble, Face, Link, Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// What rounding cannot tell, of numbers near one.
const TIE: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A normal from a shorter gap is computed again with more digits.
const SHORT: Real = 1.0 / 256.0;

/// What there is to tell of the closest points, directions in the mesh's frame and lengths in its unit.
pub(super) struct NearestFeatures<T> {
    pub link: LinkFeature,
    pub triangle: TriangleFeature,
    /// Where on the axis, from 0 to 1.
    pub fraction: T,
    /// The triangle's closest point, as a mean of its corners.
    pub weights: [T; 3],
    /// The unit vector from triangle to link.
    pub normal: Option<Vec3<T>>,
    /// F - r, except beyond a flat cap or where F is 0.
    pub depth: Option<T>,
    /// From the axis point to the link's closest point.
    pub lever: Vec3<T>,
    /// The cap, where a flat one decides.
    pub flat_cap: Option<FlatCap<T>>,
    pub kink: bool,
    /// Whether the triangle has an area, so that only one mean of its corners is the closest point.
    pub has_area: bool,
}

/// A flat cap that decides.
#[derive(Clone, Copy)]
pub(super) struct FlatCap<T> {
    /// Along the link.
    pub axis: Vec3<T>,
    /// How long the link is, in units of the pair.
    pub length: T,
    pub touches: bool,
}

impl NearestFeatures<Real> {
    /// Of a link and a triangle in the mesh's frame.
    pub(super) fn of(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let pair = link.pair(corners);
        let (found, gap) = NearestFeatures::local(&pair.triangle, &pair.link);
        let found = if gap < SHORT { NearestFeatures::exactly(link, corners).rounded() } else { found };
        Self { depth: found.depth.map(|depth| depth * pair.unit), lever: found.lever * pair.unit, ..found }
    }
}

impl NearestFeatures<DoubleDouble> {
    /// With about 32 digits, in units of the pair.
    pub(super) fn exactly(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let (triangle, link) = place_exactly(link, corners);
        NearestFeatures::local(&triangle, &link).0
    }

    fn rounded(self) -> NearestFeatures<Real> {
        let vector = |v: Vec3<DoubleDouble>| Vec3::new(v.x.rounded(), v.y.rounded(), v.z.rounded());
        NearestFeatures {
            link: self.link,
            triangle: self.triangle,
            fraction: self.fraction.rounded(),
            weights: self.weights.map(DoubleDouble::rounded),
            normal: self.normal.map(vector),
            depth: self.depth.map(DoubleDouble::rounded),
            lever: vector(self.lever),
            flat_cap: None,
            kink: self.kink,
            has_area: self.has_area,
        }
    }
}

impl<T: Scalar<Mask = bool> + PartialEq> NearestFeatures<T> {
    /// In coordinates from the link's start and near one; and the gap that the normal spans.
    fn local(triangle: &[Vec3<T>; 3], link: &Link<T>) -> (Self, T) {
        let face = Face::new(*triangle);
        let axial = Axial::new(link, &face);
        let (zero, one) = (axial.s.zero(), axial.s.one());
        let longest = (face.vertices[2] - face.vertices[1]).norm();
        let has_area = (one.lit(TIE) * longest).lt(face.across.norm());
        if axial.beyond_flat_cap() {
            let closest = axial.with_caps(link, &face);
            let (centre, _) = axial.cap(link);
            let apart = closest.point2 - closest.point1;
            let gap = apart.norm();
            let touches = closest.distance.le(zero);
            // Where they touch, the way to the axis is all that is left.
            let apart = if touches { centre - axial.on_triangle } else { apart };
            let (normal, at_end) = (direction(apart), axial.at_flat[1]);
            let (feature, weights) = triangle_feature(triangle, &face, closest.point1);
            let lever = closest.point2 - centre;
            let kink = normal.is_some_and(|normal| {
                !touches && is_kink(triangle, link, normal, axial.axis_squared.sqrt(), true)
            });
            let found = Self {
                link: if at_end { LinkFeature::EndCap } else { LinkFeature::StartCap },
                triangle: feature,
                fraction: if at_end { one } else { zero },
                weights,
                normal,
                depth: None,
                lever,
                flat_cap: Some(FlatCap { axis: link.axis, length: link.end.norm(), touches }),
                kink,
                has_area,
            };
            return (found, gap);
        }
        let apart = link.end * axial.s - axial.on_triangle;
        let gap = apart.norm();
        let normal = if axial.axis_squared.le(zero) { None } else { direction(apart) };
        let (feature, weights) = triangle_feature(triangle, &face, axial.on_triangle);
        let found = Self {
            link: if axial.s.le(zero) {
                LinkFeature::StartCap
            } else if one.le(axial.s) {
                LinkFeature::EndCap
            } else {
                LinkFeature::Side
            },
            triangle: feature,
            fraction: axial.s,
            weights,
            normal,
            depth: normal.map(|_| gap - link.radius),
            lever: normal.map_or(Vec3::zero(zero), |normal| normal * -gap.min(link.radius)),
            flat_cap: None,
            kink: normal.is_some_and(|normal| is_kink(triangle, link, normal, gap, false)),
            has_area,
        };
        (found, gap)
    }
}

/// The unit vector of a vector that is not zero.
fn direction<T: Scalar<Mask = bool>>(of: Vec3<T>) -> Option<Vec3<T>> {
    of.x.zero().lt(of.largest()).then(|| of.normalised())
}

/// The part of the triangle that a point of it lies on, and the point as a mean of the corners. What is within rounding
/// of an edge lies on it.
fn triangle_feature<T: Scalar<Mask = bool> + PartialEq>(
    corners: &[Vec3<T>; 3],
    face: &Face<T>,
    point: Vec3<T>,
) -> (TriangleFeature, [T; 3]) {
    let (zero, one) = (point.x.zero(), point.x.one());
    let tie = one.lit(TIE);
    let mut weights = [zero; 3];
    for (corner, place) in corners.iter().enumerate() {
        if (point - *place).largest().le(tie) {
            weights[corner] = one;
            return (TriangleFeature::Vertex(corner as u8), weights);
        }
    }
    for corner in 0..3 {
        let next = (corner + 1) % 3;
        let edge = corners[next] - corners[corner];
        let from = point - corners[corner];
        let share = from.dot(edge).over(edge.norm_squared()).max(zero).min(one);
        if from.along(edge, -share).largest().le(tie) {
            weights[corner] = one - share;
            weights[next] = share;
            return (TriangleFeature::Edge(corner as u8), weights);
        }
    }
    let foot = face.project(point);
    // The face's first vertex is another than the triangle's; the order is the same.
    let first = (0..3).find(|&corner| corners[corner] == face.vertices[0]).unwrap_or(0);
    weights[first] = one - foot.alpha - foot.beta;
    weights[(first + 1) % 3] = foot.alpha;
    weights[(first + 2) % 3] = foot.beta;
    (TriangleFeature::Face, weights)
}

/// Whether more than one pair of points is as near, with the unit vector `normal` from triangle to link and the axis
/// `apart` from the triangle.
fn is_kink<T: Scalar<Mask = bool>>(
    triangle: &[Vec3<T>; 3],
    link: &Link<T>,
    normal: Vec3<T>,
    apart: T,
    at_flat_cap: bool,
) -> bool {
    let tie = apart.lit(TIE);
    let heights = triangle.map(|corner| normal.dot(corner));
    let top = heights[0].max(heights[1]).max(heights[2]) - tie;
    let is_foremost = heights.map(|height| top.le(height));
    let foremost = is_foremost.iter().filter(|foremost| **foremost).count();
    if foremost < 2 {
        return false;
    }
    let across = normal.along(link.axis, -normal.dot(link.axis)).norm();
    if at_flat_cap && (across * link.radius).le(tie) {
        return apart.zero().lt(link.radius);
    }
    let has_axis = apart.zero().lt(link.end.norm_squared());
    if !has_axis || !normal.dot(link.end).abs().le(tie) {
        return false;
    }
    if foremost == 3 {
        return true;
    }
    let [from, to] = match is_foremost {
        [true, true, _] => [triangle[0], triangle[1]],
        [_, true, true] => [triangle[1], triangle[2]],
        _ => [triangle[2], triangle[0]],
    };
    let edge = to - from;
    let sine = edge.cross(link.axis).norm().over(edge.norm());
    let rise = edge.norm().min(link.end.norm()) * sine;
    (rise * rise).le(tie * apart * apart.lit(2.0))
}
