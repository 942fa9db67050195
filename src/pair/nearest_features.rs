//! The closest features of a link and a triangle, and the normal between them.
//!
//! # Definitions
//! - `q`: the axis point closest to the triangle. `p`: the triangle's point there. `F`: their
//!   distance. `r`: the link's radius.
//! - `x`, `y`: the closest points of the link and of the triangle. `u = 2^-53`.
//!
//! # Algorithm
//! 1. **Beside the link and beyond a round cap.** The link's closest point lies on the segment from
//!    `q` to `p`, at the distance `r` from `q`. The normal from wall to robot is `(q - p) / F`. In
//!    overlap it remains valid: no separating translation is shorter, as long as the overlap is at
//!    most as deep as a flat cap is away along the axis (see `distance/depth/foot.rs`).
//! 2. **Beyond a flat cap.** `x` and `y` are the closest points of the cap's disc, and the normal
//!    is `(x - y) / |x - y|`.
//! 3. **Without a gap**, or in overlap near a flat cap: the features decide (see
//!    `distance/depth/way_out.rs`).
//!
//! One text serves `f64`, packs of it and double-double numbers.
//!
//! # Rounding
//! **Normal.** The difference of two points at the distance `g` turns by about `4 u / g`, for
//! numbers near one. Below `g = 2^-8` this is too much, and the pair is computed again with 32
//! digits.
//!
//! **Gap.** Coordinates are below 2. Each is rounded by at most `u` in the input, and once more
//! relative to the link's start. So two points are at most `2 sqrt(3) 2 u < 7 u` farther apart or
//! nearer than they should be. A result errs by less than 9 u more, as measured
//! (`distance/touching.rs`). A gap of at most the sum, 16 u ([`GAP_ROUNDING`]), counts as none: its
//! direction, with any number of digits, is that of the rounding.
//!
//! # Kinks
//! Fix the normal `n`. The triangle's foremost part is where `<n, .>` is greatest, the link's
//! foremost part where it is least.
//!
//! **Claim.** The distance of two convex sets, and in overlap the translation along `n`, has a
//! derivative along every motion if exactly one pair of points attains it (Danskin's theorem). More
//! than one pair attains it only if both foremost parts are more than a point and overlap, seen
//! along `n`, in more than a point:
//!
//! - the link's part is a line of its side, with `n` perpendicular to the axis; the triangle's part
//!   is its face, or an edge parallel to the axis;
//! - the link's part is a flat cap, with `n` parallel to the axis; the triangle's part is an edge
//!   or its face.
//!
//! **Rounding.** A point that is farther by less than 64 u counts as equally near. Over a line of
//! length `l`, tilted by the angle `a` against a plane, the distance rises by `l sin a`; between
//! two lines at the angle `a` and the distance `F`, by `(l sin a)^2 / (2 F)`. A part no longer than
//! that is a point: all points of a cap without a radius are as near as its centre.
//!
//! The vertices of a triangle without area can move against each other: it counts as a kink too.

use super::coordinates::{Nearest, Pair};
use super::placed_link::{PlacedLink, place_exactly};
use crate::answer::{LinkFeature, TriangleFeature};
use crate::distance::depth::{GAP_ROUNDING, LinkTriangle, WayOut};
use crate::distance::{
    Axial, Closest, DoubleDouble, Face, Link, Mask, Scalar, Vec3, point_triangle, single,
};
use parry3d_f64::math::{Real, Vector};

/// The tolerance for ties, for numbers near one.
const TIE: Real = 64.0 * f64::UNIT_ROUNDOFF;

/// A normal from a shorter gap is computed again with more digits.
const SHORT: Real = 1.0 / 256.0;

/// The distance to a flat end where the end is round: more than any distance, for numbers near one.
const NO_END: Real = 16.0;

/// Parts that overlap by less than this share a single point: [`TIE`] allows each of their ends
/// this much.
const OVER_EACH_OTHER: Real = 16.0 * TIE;

/// The features of a link and a triangle: directions in the mesh's frame, lengths in the mesh's
/// unit.
pub(crate) struct NearestFeatures {
    pub link: LinkFeature,
    pub triangle: TriangleFeature,
    /// The fraction of the axis, from 0 to 1.
    pub fraction: Real,
    /// The unit vector from triangle to link.
    pub normal: Option<Vector>,
    /// In overlap, minus the length of the least translation that separates the two.
    pub depth: Real,
    /// From the axis point to the link's closest point.
    pub lever: Vector,
    pub kink: bool,
}

impl NearestFeatures {
    /// Returns the features of a link and a triangle in the mesh's frame.
    pub(crate) fn of(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        Measured::new(link, corners).features(|| NearPair::exactly(link, corners))
    }
}

/// A link and a triangle, measured in `f64`.
#[derive(Clone, Copy)]
pub(crate) struct Measured {
    /// The pair; `kink` is not computed yet.
    pub pair: NearPair<Real>,
    closest: Closest<Real>,
    /// The length of 1 in the mesh's unit.
    unit: Real,
}

impl Measured {
    pub(crate) fn new(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let Pair { triangle, link, unit, .. } = link.pair(corners);
        let (pair, closest, _) = NearPair::new(triangle, link);
        Self { pair, closest, unit }
    }

    /// Returns the result of [`PlacedLink::measure`] for the same pair.
    pub(crate) fn nearest(&self, link: &PlacedLink, triangle: u32) -> Nearest {
        Pair::report(self.unit, link.start(), triangle, self.closest)
    }

    /// Returns the features. `exactly` supplies the pair with more digits, if `f64` is not enough.
    pub(crate) fn features(
        &self,
        exactly: impl FnOnce() -> NearPair<DoubleDouble>,
    ) -> NearestFeatures {
        let Self { pair, unit, .. } = self;
        if pair.parts.asks_way_out {
            return pair.parting().features(*unit, |number| number);
        }
        if !pair.parts.needs_digits(&pair.triangle, &pair.face, &pair.link) {
            return pair.features(*unit, |number| number);
        }
        let exact = exactly();
        if exact.parts.asks_way_out {
            return pair.parting().features(*unit, |number| number);
        }
        let depth = pair.parts.depth * unit;
        NearestFeatures { depth, ..exact.features(*unit, DoubleDouble::rounded) }
    }
}

/// The closest parts of a link and a triangle, in coordinates relative to the link's start and near
/// one.
#[derive(Clone, Copy)]
pub(crate) struct NearestParts<T: Scalar> {
    /// Whether the closest part is the cap at the start, and the cap at the end; the side if
    /// neither.
    pub caps: [T::Mask; 2],
    /// The closest vertex, the first that applies; otherwise the closest edge; otherwise the face.
    pub corners: [T::Mask; 3],
    pub edges: [T::Mask; 3],
    /// The fraction of the axis, from 0 to 1.
    pub fraction: T,
    /// The triangle's closest point.
    pub on_triangle: Vec3<T>,
    /// The unit vector from triangle to link, if `has_normal`.
    pub normal: Vec3<T>,
    pub has_normal: T::Mask,
    /// `F - r`; after `parting`, minus the length of the least translation.
    pub depth: T,
    /// From the axis point to the link's closest point.
    pub lever: Vec3<T>,
    /// The length of the difference that gives the normal.
    pub gap: T,
    /// Whether the link's closest point belongs to a flat cap.
    pub at_flat_cap: T::Mask,
    /// Whether case 3 of the file's head applies.
    pub asks_way_out: T::Mask,
}

impl<T: Scalar> NearestParts<T> {
    /// Returns the closest parts. `closest` holds the closest points if a flat cap decides.
    #[inline(always)]
    pub(crate) fn new(
        triangle: &[Vec3<T>; 3],
        link: &Link<T>,
        axial: &Axial<T>,
        closest: &Closest<T>,
    ) -> Self {
        let (zero, one) = (axial.s.zero(), axial.s.one());
        let (at_flat_cap, [_, at_end]) = (axial.beyond_flat_cap(), axial.at_flat);
        let (centre, _) = axial.cap(link);
        // The vector from the triangle's point to the link: to a flat cap, or to the axis.
        let from_cap = closest.point2 - closest.point1;
        let from_axis = link.end * axial.s - axial.on_triangle;
        let apart = Vec3::select(at_flat_cap, from_cap, from_axis);
        let (gap, depth) = (apart.norm(), axial.axis_squared.sqrt() - link.radius);
        let rounding = gap.lit(GAP_ROUNDING);
        // In an overlap the shortest way out leads through the side if both flat ends are farther
        // along the axis than the depth. Without an overlap the depth counts as 0.
        let (length, no_end) = (link.end.dot(link.axis), gap.lit(NO_END));
        let to_start = link.flat[0].select(axial.s * length, no_end);
        let to_end = link.flat[1].select((one - axial.s) * length, no_end);
        // The rounding of a short axis turns a wide cap.
        let turn = one.max(link.radius.over(length));
        let leaves_through_side =
            !at_flat_cap & (rounding * turn - depth.min(zero)).lt(to_start.min(to_end));
        let asks_way_out = gap.le(rounding) | (closest.distance.le(zero) & !leaves_through_side);
        let has_normal = zero.lt(apart.largest()) & !(!at_flat_cap & axial.axis_squared.le(zero));
        let normal = apart.normalised();
        // In an overlap the lever ends at the triangle. Its length does not matter: it is parallel
        // to the normal, so a turn moves its end across the normal only.
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
            depth,
            lever: Vec3::select(at_flat_cap, closest.point2 - centre, from_side),
            gap,
            at_flat_cap,
            asks_way_out,
        }
    }

    /// Returns whether this pair needs its features or more digits.
    #[inline(always)]
    pub(crate) fn needs_closer_look(
        &self,
        triangle: &[Vec3<T>; 3],
        face: &Face<T>,
        link: &Link<T>,
    ) -> T::Mask {
        self.asks_way_out | self.needs_digits(triangle, face, link)
    }

    /// Returns whether the gap is too short for these digits, or [`NearPair::is_kink`] needs more
    /// digits.
    ///
    /// A kink needs two foremost vertices, and a normal that is parallel to a flat cap's axis or
    /// perpendicular to the link's axis. Beside a link it also needs the third vertex or an edge
    /// along the link. A triangle without area always qualifies.
    ///
    /// **Rounding.** Points of the triangle whose distances `F` differ by rounding, at most 9 u,
    /// may be exchanged. The direction to them then turns by at most `sqrt(2 * 9 u / F)`, as the
    /// rest of the triangle is no nearer. A point at most `2 sqrt(3)` away therefore rises by less
    /// than `sqrt(12 * 18 u / F) = sqrt(216 u / F)`, and one of two points by at most twice that
    /// more than the other: `sqrt(4 * 216 u / F) = sqrt(864 u / F)`. For `F > u` this exceeds the
    /// `2 sqrt(3) * 8 u / F < 28 u / F` by which rounding turns the normal: 7 u of the points and u
    /// of their difference. 1024 leaves room for the rounding of this test.
    #[inline(always)]
    fn needs_digits(&self, triangle: &[Vec3<T>; 3], face: &Face<T>, link: &Link<T>) -> T::Mask {
        let tie = (self.gap.lit(1024.0 * T::UNIT_ROUNDOFF)).over(self.gap).sqrt();
        let [a, b, c] = *triangle;
        let [a_is_foremost, b_is_foremost, c_is_foremost] =
            are_foremost(triangle, self.normal, tie);
        let [ab, bc] = [a_is_foremost & b_is_foremost, b_is_foremost & c_is_foremost];
        let ca = c_is_foremost & a_is_foremost;
        let is_level = self.normal.dot(link.end).abs().le(tie);
        let edge = Vec3::select(ab, b - a, Vec3::select(bc, c - b, a - c));
        let is_kink_beside = is_level & ((ab & bc) | is_along(edge, link, self.gap, tie));
        let faces_cap = rise_over_cap(self.normal, link).le(tie);
        let may_be_kink =
            (ab | bc | ca) & (is_kink_beside | (self.at_flat_cap & (faces_cap | is_level)));
        self.gap.lt(self.gap.lit(SHORT)) | may_be_kink | !has_area(face)
    }
}

/// Returns whether a point is a vertex, within rounding. (A function, because a closure may not be
/// inlined.)
#[inline(always)]
fn is_at<T: Scalar>(point: Vec3<T>, corner: Vec3<T>) -> T::Mask {
    (point - corner).largest().le(point.x.lit(TIE))
}

/// Returns whether a point lies on an edge, within rounding.
#[inline(always)]
fn is_on<T: Scalar>(point: Vec3<T>, start: Vec3<T>, end: Vec3<T>) -> T::Mask {
    let (edge, from) = (end - start, point - start);
    from.along(edge, -share_of(from, edge)).largest().le(point.x.lit(TIE))
}

/// Returns the fraction, from 0 to 1, of the foot of a point on an edge. The point is relative to
/// the edge's start.
#[inline(always)]
fn share_of<T: Scalar>(from: Vec3<T>, edge: Vec3<T>) -> T {
    from.dot(edge).over(edge.norm_squared()).max(from.x.zero()).min(from.x.one())
}

/// Returns the foremost vertices along a normal, within rounding.
#[inline(always)]
fn are_foremost<T: Scalar>([a, b, c]: &[Vec3<T>; 3], normal: Vec3<T>, tie: T) -> [T::Mask; 3] {
    let [a, b, c] = [normal.dot(*a), normal.dot(*b), normal.dot(*c)];
    let top = a.max(b).max(c) - tie;
    [top.le(a), top.le(b), top.le(c)]
}

/// Returns how far a cap's rim rises over a plane with this normal, less the rounding of a short
/// axis, which turns a wide cap.
#[inline(always)]
fn rise_over_cap<T: Scalar>(normal: Vec3<T>, link: &Link<T>) -> T {
    let across = normal.along(link.axis, -normal.dot(link.axis)).norm();
    let one = across.one();
    let turn = link.radius.over(link.end.dot(link.axis)).max(one);
    across * link.radius * one.over(turn)
}

/// A link and a triangle with their closest parts.
#[derive(Clone, Copy)]
pub(crate) struct NearPair<T: Scalar> {
    pub link: Link<T>,
    pub parts: NearestParts<T>,
    pub kink: bool,
    face: Face<T>,
    triangle: [Vec3<T>; 3],
}

impl NearPair<DoubleDouble> {
    /// Returns the pair computed with about 32 digits.
    pub(crate) fn exactly(link: &PlacedLink, corners: [Vector; 3]) -> Self {
        let (triangle, link) = place_exactly(link, corners);
        let (pair, _, apart) = Self::new(triangle, link);
        Self { kink: pair.is_kink(pair.parts.normal, apart, pair.parts.at_flat_cap), ..pair }
    }
}

impl<T: Scalar<Mask = bool> + PartialEq> NearPair<T> {
    /// Returns the pair without its kink, its closest points, and the distance of the axis from the
    /// triangle.
    fn new(triangle: [Vec3<T>; 3], link: Link<T>) -> (Self, Closest<T>, T) {
        let face = Face::new(triangle);
        let axial = single::axial(&link, &face);
        let closest = if axial.beyond_flat_cap() {
            single::with_caps(&axial, &link, &face)
        } else {
            axial.without_caps(&link)
        };
        let parts = NearestParts::new(&triangle, &link, &axial, &closest);
        let apart = if parts.at_flat_cap { axial.axis_squared.sqrt() } else { parts.gap };
        (Self { link, parts, kink: false, face, triangle }, closest, apart)
    }

    /// Returns the features in `f64`, in the mesh's frame, where 1 is `unit`.
    fn features(&self, unit: Real, rounded: impl Fn(T) -> Real) -> NearestFeatures {
        let Self { parts, kink, .. } = self;
        let vector = |v: Vec3<T>| Vec3::new(rounded(v.x), rounded(v.y), rounded(v.z));
        NearestFeatures {
            link: link_feature(parts.caps),
            triangle: triangle_feature(parts.corners, parts.edges),
            fraction: rounded(parts.fraction),
            normal: parts.has_normal.then(|| vector(parts.normal).into()),
            depth: rounded(parts.depth) * unit,
            lever: (vector(parts.lever) * unit).into(),
            kink: *kink,
        }
    }

    /// Returns the triangle's closest point as weights of its vertices.
    pub(crate) fn weights(&self) -> [T; 3] {
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
                // The face begins at another vertex than the triangle, in the same order.
                let first =
                    (0..3).find(|&corner| corners[corner] == self.face.vertices[0]).unwrap_or(0);
                weights[first] = one - foot.alpha - foot.beta;
                weights[(first + 1) % 3] = foot.alpha;
                weights[(first + 2) % 3] = foot.beta;
            }
        }
        weights
    }

    /// Returns whether more than one pair of points attains the distance (a kink).
    ///
    /// `normal` is the unit vector from triangle to link, and `apart` the distance of the axis from
    /// the triangle.
    fn is_kink(&self, normal: Vec3<T>, apart: T, at_flat_cap: bool) -> bool {
        if !has_area(&self.face) {
            return true;
        }
        let (link, [a, b, c]) = (&self.link, self.triangle);
        let tie = apart.lit(TIE);
        let foremost = match are_foremost(&self.triangle, normal, tie) {
            [true, true, true] => [a, b, c],
            [true, true, _] => [a, b, b],
            [_, true, true] => [b, c, c],
            [true, _, true] => [c, a, a],
            _ => return false,
        };
        if at_flat_cap && tie.lt(link.radius) && rise_over_cap(normal, link).le(tie) {
            let centre = if self.parts.caps[1] { link.end } else { Vec3::zero(tie) };
            let offset = point_triangle(centre, foremost).point2 - centre;
            let radial = offset.along(link.axis, -offset.dot(link.axis)).norm();
            return (radial + apart.lit(OVER_EACH_OTHER)).lt(link.radius);
        }
        let length = link.end.dot(link.axis);
        if length.le(tie) || tie.lt(normal.dot(link.end).abs()) {
            return false;
        }
        let [a, b, c] = foremost;
        let shares = |[from, to]: [Vec3<T>; 2]| {
            let (start, end) = (from.dot(link.axis), to.dot(link.axis));
            let shared = length.min(start.max(end)) - apart.zero().max(start.min(end));
            is_along(to - from, link, apart, tie) && apart.lit(OVER_EACH_OTHER).lt(shared)
        };
        // A link beside the face may be as near to an edge.
        [[a, b], [b, c], [c, a]].into_iter().any(shares)
            || (b != c && apart.lit(OVER_EACH_OTHER).lt(self.above_face() * length))
    }

    /// Returns the fraction of the axis above the face, seen along the face's normal. A tie beyond
    /// its edges counts.
    fn above_face(&self) -> T {
        let (end, across) = (self.link.end, self.face.across);
        let [a, b, c] = self.face.vertices;
        let (mut from, mut to) = (end.x.zero(), end.x.one());
        for [start, other] in [[a, b], [b, c], [c, a]] {
            let inwards = across.cross(other - start);
            let (height, rise) =
                (-inwards.dot(start) + inwards.norm() * end.x.lit(TIE), inwards.dot(end));
            if end.x.zero().lt(rise) {
                from = from.max(-height.over(rise));
            } else if rise.lt(end.x.zero()) {
                to = to.min(height.over(-rise));
            } else if height.lt(end.x.zero()) {
                return end.x.zero();
            }
        }
        (to - from).max(end.x.zero())
    }
}

impl NearPair<Real> {
    /// Returns the same pair with the features of the least translation (case 3 of the file's
    /// head).
    pub(crate) fn parting(mut self) -> Self {
        let [a, b, c] = self.triangle;
        let way = WayOut::new(&LinkTriangle::new(self.link, [a, b, c].map(Vector::from)));
        let (normal, on_triangle) = (Vec3::from(-way.normal), Vec3::from(way.on_triangle));
        self.parts = NearestParts {
            caps: [way.fraction <= 0.0, way.fraction >= 1.0],
            corners: self.triangle.map(|corner| is_at(on_triangle, corner)),
            edges: [[a, b], [b, c], [c, a]].map(|[from, to]| is_on(on_triangle, from, to)),
            fraction: way.fraction,
            on_triangle,
            normal,
            has_normal: way.has_side,
            depth: way.gap,
            lever: way.lever.into(),
            gap: way.gap.abs(),
            at_flat_cap: way.at_flat_cap,
            asks_way_out: true,
        };
        let apart = way.gap.abs().max((way.gap + self.link.radius).abs());
        self.kink = !way.is_alone || self.is_kink(normal, apart, way.at_flat_cap);
        self
    }
}

/// Returns whether the triangle has an area, so that only one mean of its vertices is the closest
/// point.
#[inline(always)]
fn has_area<T: Scalar>(face: &Face<T>) -> T::Mask {
    let longest = face.vertices[2] - face.vertices[1];
    (longest.norm_squared() * longest.x.lit(TIE)).lt(face.across.norm())
}

/// Returns the feature of a link from the caps of [`NearestParts`].
pub(crate) fn link_feature([start, end]: [bool; 2]) -> LinkFeature {
    match (start, end) {
        (true, _) => LinkFeature::StartCap,
        (_, true) => LinkFeature::EndCap,
        _ => LinkFeature::Side,
    }
}

/// Returns the feature of a triangle from the vertices and edges of [`NearestParts`].
pub(crate) fn triangle_feature(corners: [bool; 3], edges: [bool; 3]) -> TriangleFeature {
    let first = |parts: [bool; 3]| {
        (0..).zip(parts).find(|(_, is_nearest)| *is_nearest).map(|(part, _)| part)
    };
    let corner = first(corners).map(TriangleFeature::Vertex);
    corner.or(first(edges).map(TriangleFeature::Edge)).unwrap_or(TriangleFeature::Face)
}

/// Returns whether all points of an edge are equally near to a link, within rounding. `apart` is
/// the distance from the axis.
#[inline(always)]
fn is_along<T: Scalar>(edge: Vec3<T>, link: &Link<T>, apart: T, tie: T) -> T::Mask {
    let sine = edge.cross(link.axis).norm().over(edge.norm());
    let rise = edge.norm().min(link.end.norm()) * sine;
    // At distance 0 the distance of an edge point is its own rise.
    rise.le(tie) | (rise * rise).le(tie * apart * apart.lit(2.0))
}
