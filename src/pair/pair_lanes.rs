//! Pairs of links and triangles in double precision, a pack at a time, each in coordinates of its own: those of
//! [`PlacedLink::pair`](super::PlacedLink::pair), with the same bits on every instruction set.

use crate::distance::lanes::Pack;
use crate::distance::{Axial, Closest, Face, Link, Scalar, Vec3, gives_direction};
use parry3d_f64::math::{Real, Vector};

/// How many pairs are computed together: the widest pack of `f64`.
pub(crate) const TOGETHER: usize = 8;

/// What is known of each of several pairs, each number in a row of its own.
pub(crate) type Rows<const N: usize> = [[Real; TOGETHER]; N];

/// Pairs in the mesh's frame: the corners of the triangle, the ends of the link's axis, the radius, and 1 for each flat
/// cap.
pub(crate) type PairRows = Rows<18>;

/// Writes a pair with a link between two points in the mesh's frame.
pub(crate) fn put_pair(
    rows: &mut PairRows,
    lane: usize,
    corners: [Vector; 3],
    ends: [Vector; 2],
    radius: Real,
    flat: [bool; 2],
) {
    put_corners(rows, lane, corners);
    put(rows, 9, lane, ends[0]);
    put(rows, 12, lane, ends[1]);
    rows[15][lane] = radius;
    let [start, end] = flat.map(Real::from);
    rows[16][lane] = start;
    rows[17][lane] = end;
}

/// Three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
fn point<L: Pack<Element = f64>>(
    token: L::Token,
    rows: &[[Real; TOGETHER]],
    row: usize,
    lane: usize,
) -> Vec3<L> {
    let [x, y, z] = [&rows[row], &rows[row + 1], &rows[row + 2]];
    Vec3::new(L::load(token, &x[lane..]), L::load(token, &y[lane..]), L::load(token, &z[lane..]))
}

/// The corners of triangles, in the first nine rows.
#[inline(always)]
pub(crate) fn corners<L: Pack<Element = f64>, const N: usize>(
    token: L::Token,
    rows: &Rows<N>,
    lane: usize,
) -> [Vec3<L>; 3] {
    [point::<L>(token, rows, 0, lane), point::<L>(token, rows, 3, lane), point::<L>(token, rows, 6, lane)]
}

/// Writes the corners of a triangle to the first nine rows.
#[inline(always)]
pub(crate) fn put_corners<const N: usize>(rows: &mut Rows<N>, lane: usize, corners: [Vector; 3]) {
    for (place, point) in corners.into_iter().enumerate() {
        put(rows, 3 * place, lane, point);
    }
}

/// Writes three coordinates to the rows `row` to `row + 2`.
#[inline(always)]
fn put<const N: usize>(rows: &mut Rows<N>, row: usize, lane: usize, point: Vector) {
    rows[row][lane] = point.x;
    rows[row + 1][lane] = point.y;
    rows[row + 2][lane] = point.z;
}

/// Writes three coordinates to the rows `row` to `row + 2`.
#[inline(always)]
pub(crate) fn store<L: Pack<Element = f64>, const N: usize>(
    rows: &mut Rows<N>,
    row: usize,
    lane: usize,
    point: Vec3<L>,
) {
    point.x.store(&mut rows[row][lane..]);
    point.y.store(&mut rows[row + 1][lane..]);
    point.z.store(&mut rows[row + 2][lane..]);
}

/// A pack of pairs, from the links' starts and near one.
pub(crate) struct PairLanes<L: Scalar> {
    pub triangle: [Vec3<L>; 3],
    pub link: Link<L>,
    pub face: Face<L>,
    pub axial: Axial<L>,
    /// The closest points.
    pub closest: Closest<L>,
    /// What 1 is in the mesh's unit.
    pub unit: L,
    /// The largest coordinate of link and triangle from the link's start, or the radius, in the mesh's unit.
    pub extent: L,
    /// The start of the link in the mesh's frame.
    start: Vec3<L>,
}

impl<L: Pack<Element = f64>> PairLanes<L> {
    /// Those from the lane `lane` on.
    #[inline(always)]
    pub(crate) fn new(token: L::Token, rows: &PairRows, lane: usize) -> Self {
        let start = point::<L>(token, rows, 9, lane);
        let along = point::<L>(token, rows, 12, lane) - start;
        let radius = L::load(token, &rows[15][lane..]);
        let zero = radius.zero();
        let flat = [zero.lt(L::load(token, &rows[16][lane..])), zero.lt(L::load(token, &rows[17][lane..]))];
        let extent = along.largest().max(radius);
        let placed = PlacedLanes { start, along, axis: along.normalised(), radius, flat, extent };
        placed.with(corners::<L, 18>(token, rows, lane))
    }

    /// A point in the mesh's frame.
    #[inline(always)]
    pub(crate) fn placed(&self, point: Vec3<L>) -> Vec3<L> {
        self.start + point * self.unit
    }
}

/// Links in the mesh's frame, as [`PlacedLink`](super::PlacedLink).
#[derive(Clone, Copy)]
pub(crate) struct PlacedLanes<L: Scalar> {
    pub start: Vec3<L>,
    pub along: Vec3<L>,
    pub axis: Vec3<L>,
    pub radius: L,
    pub flat: [L::Mask; 2],
    pub extent: L,
}

impl<L: Pack<Element = f64>> PlacedLanes<L> {
    /// The pairs with triangles in the mesh's frame.
    #[inline(always)]
    pub(crate) fn with(&self, [a, b, c]: [Vec3<L>; 3]) -> PairLanes<L> {
        let Self { start, along, axis, radius, flat, extent } = *self;
        let [a, b, c] = [a - start, b - start, c - start];
        let extent = a.largest().max(b.largest()).max(c.largest()).max(extent);
        let scale = extent.power_of_two_to_unity();
        let triangle = [a * scale, b * scale, c * scale];
        let end = along * scale;
        let axis = Vec3::select(gives_direction(end.norm_squared()), axis, Vec3::zero(extent.zero()));
        let link = Link { end, axis, radius: radius * scale, flat };
        let face = Face::new(triangle);
        let axial = Axial::new(&link, &face);
        // Where no lane is beyond a flat cap the discs decide nothing.
        let closest = if L::bits(axial.beyond_flat_cap()) == 0 {
            axial.without_caps(&link)
        } else {
            axial.with_caps(&link, &face)
        };
        PairLanes { triangle, link, face, axial, closest, unit: scale.one() / scale, extent, start }
    }
}
