//! Which features of a link and a triangle are nearest, and the normal between them.
//!
//! Let q be the axis point nearest to the triangle, p the triangle's point there and F their distance. Beside the link
//! and beyond a round cap the link's closest point lies on the way from q to p, one radius from q: the normal from wall
//! to robot is (q - p) / F, and it has a meaning as long as F > 0, even where the two overlap. Beyond a flat cap the
//! closest points x of the link and y of the triangle are those of the cap's disc, and the normal is (x - y) / |x - y|.
//!
//! One text for `f64`, packs of it and numbers of twice its digits. The difference of two points that are g apart turns by about
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
use crate::distance::{Axial, Closest, DoubleDouble, Face, Link, Mask, Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// What rounding cannot tell, of numbers near one.
const TIE: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A normal from a shorter gap is computed again with more digits.
const SHORT: Real = 1.0 / 256.0;

/// What there is to tell of a link and a triangle, directions in the mesh's frame and lengths in its unit.
pub(super) struct NearestFeatures {
    pub link: LinkFeature,
    pub triangle: TriangleFeature,
    /// Where on the axis, from 0 to 1.
    pub fraction: Real,
    /// The unit vector from triangle to link.
    pub normal: Option<Vector>,
    /// F - r, except beyond a flat cap or where F is 0.
    pub depth: Option<Real>,
    /// From the axis point to the link's closest point.
    pub lever: Vector,
    pub kink: bool,
}

impl NearestFeatures {
    /// Of a link and a triangle in the mesh's frame.
    pub(super) fn of(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let pair = link.pair(corners);
        let near = NearPair::new(pair.triangle, pair.link);
        if near.parts.gap < SHORT {
            return NearPair::exactly(link, corners).features(pair.unit, DoubleDouble::rounded);
        }
        near.features(pair.unit, |number| number)
    }
}

/// Which parts of a link and a triangle are nearest, in coordinates from the link's start and near one.
#[derive(Clone, Copy)]
pub(super) struct NearestParts<T: Scalar> {
    /// Whether it is the cap at the start, or else the one at the end. The side where it is neither.
    pub caps: [T::Mask; 2],
    /// Which corner it is, the first of them; where it is none, which edge. The face where it is neither.
    pub corners: [T::Mask; 3],
    pub edges: [T::Mask; 3],
    /// Where on the axis, from 0 to 1.
    pub fraction: T,
    /// The triangle's closest point.
    pub on_triangle: Vec3<T>,
    /// The unit vector from triangle to link, where there is one.
    pub normal: Vec3<T>,
    pub has_normal: T::Mask,
    /// F - r, where there is a normal and no flat cap decides.
    pub depth: T,
    /// From the axis point to the link's closest point.
    pub lever: Vec3<T>,
    /// What the normal spans.
    pub gap: T,
    pub at_flat_cap: T::Mask,
    /// Whether a flat cap decides and touches.
    pub cap_touches: T::Mask,
}

impl<T: Scalar> NearestParts<T> {
    /// `closest` are the closest points where a flat cap decides.
    #[inline(always)]
    pub(super) fn new(
        triangle: &[Vec3<T>; 3],
        link: &Link<T>,
        axial: &Axial<T>,
        closest: &Closest<T>,
    ) -> Self {
        let (zero, one) = (axial.s.zero(), axial.s.one());
        let (at_flat_cap, [_, at_end]) = (axial.beyond_flat_cap(), axial.at_flat);
        let (centre, _) = axial.cap(link);
        let cap_touches = at_flat_cap & closest.distance.le(zero);
        let from_cap = closest.point2 - closest.point1;
        let from_axis = link.end * axial.s - axial.on_triangle;
        let gap = Vec3::select(at_flat_cap, from_cap, from_axis).norm();
        // Where a flat cap touches, the way to the axis is all that is left.
        let from_cap = Vec3::select(cap_touches, centre - axial.on_triangle, from_cap);
        let apart = Vec3::select(at_flat_cap, from_cap, from_axis);
        let meets = !at_flat_cap & axial.axis_squared.le(zero);
        let has_normal = zero.lt(apart.largest()) & !meets;
        let normal = apart.normalised();
        let from_side = Vec3::select(has_normal, normal * -gap.min(link.radius), Vec3::zero(zero));
        let on_triangle = Vec3::select(at_flat_cap, closest.point1, axial.on_triangle);
        let [a, b, c] = *triangle;
        Self {
            caps: [
                (at_flat_cap & !at_end) | (!at_flat_cap & axial.s.le(zero)),
                at_end | (!at_flat_cap & one.le(axial.s)),
            ],
            corners: [is_at(on_triangle, a), is_at(on_triangle, b), is_at(on_triangle, c)],
            edges: [is_on(on_triangle, a, b), is_on(on_triangle, b, c), is_on(on_triangle, c, a)],
            fraction: at_flat_cap.select(at_end.select(one, zero), axial.s),
            on_triangle,
            normal,
            has_normal,
            depth: gap - link.radius,
            lever: Vec3::select(at_flat_cap, closest.point2 - centre, from_side),
            gap,
            at_flat_cap,
            cap_touches,
        }
    }

    /// Where [`is_kink`] must be asked, or the gap is too short for these digits. A kink needs two corners that are
    /// foremost, and a normal that is parallel to a flat cap's axis or perpendicular to the link's; beside a link also
    /// the third corner or an edge along it.
    #[inline(always)]
    pub(super) fn needs_closer_look(&self, triangle: &[Vec3<T>; 3], link: &Link<T>) -> T::Mask {
        let tie = self.gap.lit(TIE);
        let [a, b, c] = *triangle;
        let [a_is_foremost, b_is_foremost, c_is_foremost] = are_foremost(triangle, self.normal, tie);
        let [ab, bc] = [a_is_foremost & b_is_foremost, b_is_foremost & c_is_foremost];
        let ca = c_is_foremost & a_is_foremost;
        let is_level = self.normal.dot(link.end).abs().le(tie);
        let edge = Vec3::select(ab, b - a, Vec3::select(bc, c - b, a - c));
        let is_kink_beside = is_level & ((ab & bc) | is_along(edge, link, self.gap));
        let faces_cap = (across(self.normal, link) * link.radius).le(tie);
        let may_be_kink = (ab | bc | ca) & (is_kink_beside | (self.at_flat_cap & (faces_cap | is_level)));
        self.gap.lt(self.gap.lit(SHORT)) | (may_be_kink & self.has_normal & !self.cap_touches)
    }
}

/// Whether a point is a corner, as far as rounding can tell. (Functions, because a closure may escape inlining.)
#[inline(always)]
fn is_at<T: Scalar>(point: Vec3<T>, corner: Vec3<T>) -> T::Mask {
    (point - corner).largest().le(point.x.lit(TIE))
}

/// Whether a point lies on an edge, as far as rounding can tell.
#[inline(always)]
fn is_on<T: Scalar>(point: Vec3<T>, start: Vec3<T>, end: Vec3<T>) -> T::Mask {
    let (edge, from) = (end - start, point - start);
    from.along(edge, -share_of(from, edge)).largest().le(point.x.lit(TIE))
}

/// Where on an edge, from 0 to 1, the foot of a point lies that is seen from the edge's start.
#[inline(always)]
fn share_of<T: Scalar>(from: Vec3<T>, edge: Vec3<T>) -> T {
    from.dot(edge).over(edge.norm_squared()).max(from.x.zero()).min(from.x.one())
}

/// Which corners are foremost along a normal, as far as rounding can tell.
#[inline(always)]
fn are_foremost<T: Scalar>([a, b, c]: &[Vec3<T>; 3], normal: Vec3<T>, tie: T) -> [T::Mask; 3] {
    let [a, b, c] = [normal.dot(*a), normal.dot(*b), normal.dot(*c)];
    let top = a.max(b).max(c) - tie;
    [top.le(a), top.le(b), top.le(c)]
}

/// How much of a normal is across a link's axis.
#[inline(always)]
fn across<T: Scalar>(normal: Vec3<T>, link: &Link<T>) -> T {
    normal.along(link.axis, -normal.dot(link.axis)).norm()
}

/// A link and a triangle, and what is nearest of them.
pub(super) struct NearPair<T: Scalar> {
    pub link: Link<T>,
    pub parts: NearestParts<T>,
    pub kink: bool,
    face: Face<T>,
    triangle: [Vec3<T>; 3],
}

impl NearPair<DoubleDouble> {
    /// With about 32 digits.
    pub(super) fn exactly(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let (triangle, link) = place_exactly(link, corners);
        Self::new(triangle, link)
    }
}

impl<T: Scalar<Mask = bool> + PartialEq> NearPair<T> {
    fn new(triangle: [Vec3<T>; 3], link: Link<T>) -> Self {
        let face = Face::new(triangle);
        let axial = Axial::new(&link, &face);
        let closest =
            if axial.beyond_flat_cap() { axial.with_caps(&link, &face) } else { axial.without_caps(&link) };
        let parts = NearestParts::new(&triangle, &link, &axial, &closest);
        let apart = if parts.at_flat_cap { axial.axis_squared.sqrt() } else { parts.gap };
        let kink = parts.has_normal
            && !parts.cap_touches
            && is_kink(&triangle, &link, parts.normal, apart, parts.at_flat_cap);
        Self { link, parts, kink, face, triangle }
    }

    /// The same with `f64`, in the mesh's frame, where 1 is `unit`.
    fn features(&self, unit: Real, rounded: impl Fn(T) -> Real) -> NearestFeatures {
        let Self { parts, kink, .. } = self;
        let vector = |v: Vec3<T>| Vec3::new(rounded(v.x), rounded(v.y), rounded(v.z));
        let has_depth = parts.has_normal && !parts.at_flat_cap;
        NearestFeatures {
            link: link_feature(parts.caps),
            triangle: triangle_feature(parts.corners, parts.edges),
            fraction: rounded(parts.fraction),
            normal: parts.has_normal.then(|| vector(parts.normal).into()),
            depth: has_depth.then(|| rounded(parts.depth) * unit),
            lever: (vector(parts.lever) * unit).into(),
            kink: *kink,
        }
    }

    /// The triangle's closest point, as a mean of its corners.
    pub(super) fn weights(&self) -> [T; 3] {
        let (point, corners) = (self.parts.on_triangle, &self.triangle);
        let (zero, one) = (point.x.zero(), point.x.one());
        let mut weights = [zero; 3];
        match triangle_feature(self.parts.corners, self.parts.edges) {
            TriangleFeature::Vertex(corner) => weights[usize::from(corner)] = one,
            TriangleFeature::Edge(corner) => {
                let corner = usize::from(corner);
                let next = (corner + 1) % 3;
                let share = share_of(point - corners[corner], corners[next] - corners[corner]);
                weights[corner] = one - share;
                weights[next] = share;
            }
            TriangleFeature::Face => {
                let foot = self.face.project(point);
                // The face's first vertex is another than the triangle's; the order is the same.
                let first = (0..3).find(|&corner| corners[corner] == self.face.vertices[0]).unwrap_or(0);
                weights[first] = one - foot.alpha - foot.beta;
                weights[(first + 1) % 3] = foot.alpha;
                weights[(first + 2) % 3] = foot.beta;
            }
        }
        weights
    }

    /// Whether the triangle has an area, so that only one mean of its corners is the closest point.
    pub(super) fn has_area(&self) -> bool {
        let longest = (self.face.vertices[2] - self.face.vertices[1]).norm();
        (longest.lit(TIE) * longest).lt(self.face.across.norm())
    }
}

/// The part of a link by what [`NearestParts`] tells of its caps.
pub(super) fn link_feature([start, end]: [bool; 2]) -> LinkFeature {
    match (start, end) {
        (true, _) => LinkFeature::StartCap,
        (_, true) => LinkFeature::EndCap,
        _ => LinkFeature::Side,
    }
}

/// The part of a triangle by what [`NearestParts`] tells of its corners and edges.
pub(super) fn triangle_feature(corners: [bool; 3], edges: [bool; 3]) -> TriangleFeature {
    let first = |parts: [bool; 3]| (0..).zip(parts).find(|(_, is_nearest)| *is_nearest).map(|(part, _)| part);
    let corner = first(corners).map(TriangleFeature::Vertex);
    corner.or(first(edges).map(TriangleFeature::Edge)).unwrap_or(TriangleFeature::Face)
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
    let is_foremost = are_foremost(triangle, normal, tie);
    let foremost = is_foremost.iter().filter(|foremost| **foremost).count();
    if foremost < 2 {
        return false;
    }
    if at_flat_cap && (across(normal, link) * link.radius).le(tie) {
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
    is_along(to - from, link, apart)
}

/// Whether an edge is as near to a link all along, `apart` from the axis, as far as rounding can tell.
#[inline(always)]
fn is_along<T: Scalar>(edge: Vec3<T>, link: &Link<T>, apart: T) -> T::Mask {
    let sine = edge.cross(link.axis).norm().over(edge.norm());
    let rise = edge.norm().min(link.end.norm()) * sine;
    (rise * rise).le(apart.lit(TIE) * apart * apart.lit(2.0))
}
