//! Packs of pairs of a link and a triangle or another link, in double precision. Each pair has its
//! own [`coordinates`](super::coordinates), with the same bits on every instruction set.

use super::coordinates::{Pair, Placed};
use super::placed_link::PlacedLink;
use crate::distance::lanes::Pack;
use crate::distance::{Axial, Closest, Face, Scalar, Vec3};
use crate::mesh::splat;
use fearless_simd::Simd;
use parry3d_f64::math::{Real, Vector};

/// The number of pairs that are computed together: the lanes of the widest pack of `f64`.
pub(crate) const BATCH: usize = 8;

/// Numbers of several pairs, each number in its own row.
pub(crate) type Rows<const N: usize> = [[Real; BATCH]; N];

/// Pairs in the mesh's frame: the triangle's vertices, the ends of the link's axis, the radius, and
/// 1 for each flat cap.
pub(crate) type PairRows = Rows<18>;

/// Writes a pair of a triangle and a link, in the mesh's frame.
pub(crate) fn put_pair(
    rows: &mut PairRows,
    lane: usize,
    corners: [Vector; 3],
    ends: [Vector; 2],
    radius: Real,
    flat: [bool; 2],
) {
    put_corners(rows, lane, corners);
    put_link(rows, 9, lane, ends, radius, flat);
}

/// Writes a link to the rows `row` to `row + 8`: the ends of its axis, its radius, and 1 for each
/// flat cap.
#[inline(always)]
pub(super) fn put_link<const N: usize>(
    rows: &mut Rows<N>,
    row: usize,
    lane: usize,
    ends: [Vector; 2],
    radius: Real,
    flat: [bool; 2],
) {
    put(rows, row, lane, ends[0]);
    put(rows, row + 3, lane, ends[1]);
    rows[row + 6][lane] = radius;
    let [start, end] = flat.map(Real::from);
    rows[row + 7][lane] = start;
    rows[row + 8][lane] = end;
}

/// Reads the links in the rows `row` to `row + 8`, with the bits of [`PlacedLink::between`], except
/// the axis, which is zero.
#[inline(always)]
pub(super) fn link<L: Pack<Element = f64>>(
    token: L::Token,
    rows: &[[Real; BATCH]],
    row: usize,
    lane: usize,
) -> Placed<L> {
    let start = point::<L>(token, rows, row, lane);
    let along = point::<L>(token, rows, row + 3, lane) - start;
    let radius = L::load(token, &rows[row + 6][lane..]);
    let [start_cap, end_cap] = [&rows[row + 7], &rows[row + 8]];
    let zero = radius.zero();
    let flat =
        [zero.lt(L::load(token, &start_cap[lane..])), zero.lt(L::load(token, &end_cap[lane..]))];
    let extent = along.largest().max(radius);
    Placed { start, along, axis: Vec3::zero(zero), radius, flat, extent }
}

/// Reads three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
fn point<L: Pack<Element = f64>>(
    token: L::Token,
    rows: &[[Real; BATCH]],
    row: usize,
    lane: usize,
) -> Vec3<L> {
    let [x, y, z] = [&rows[row], &rows[row + 1], &rows[row + 2]];
    Vec3::new(L::load(token, &x[lane..]), L::load(token, &y[lane..]), L::load(token, &z[lane..]))
}

/// Reads the vertices of triangles from the first nine rows.
#[inline(always)]
pub(crate) fn corners<L: Pack<Element = f64>, const N: usize>(
    token: L::Token,
    rows: &Rows<N>,
    lane: usize,
) -> [Vec3<L>; 3] {
    [
        point::<L>(token, rows, 0, lane),
        point::<L>(token, rows, 3, lane),
        point::<L>(token, rows, 6, lane),
    ]
}

/// Writes the vertices of a triangle to the first nine rows.
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

impl<L: Pack<Element = f64>> Placed<L> {
    /// Computes the axis, which flat caps and triangles need.
    #[inline(always)]
    pub(super) fn with_axis(self) -> Self {
        Self { axis: self.along.normalised(), ..self }
    }

    /// Returns one link in all lanes.
    #[inline(always)]
    pub(super) fn splat(token: L::Token, link: &PlacedLink) -> Self {
        let zero = L::splat(token, 0.0);
        let (yes, no) = (zero.le(zero), zero.lt(zero));
        Self {
            start: splat::<L>(token, link.start().into()),
            along: splat::<L>(token, link.along().into()),
            axis: splat::<L>(token, link.axis()),
            radius: L::splat(token, link.radius()),
            flat: [if link.flat()[0] { yes } else { no }, if link.flat()[1] { yes } else { no }],
            extent: L::splat(token, link.extent()),
        }
    }
}

/// A pack of pairs with their closest points.
pub(super) struct PairLanes<L: Scalar> {
    pub pair: Pair<L>,
    pub face: Face<L>,
    pub axial: Axial<L>,
    /// The closest points.
    pub closest: Closest<L>,
    /// The start of the link in the mesh's frame.
    start: Vec3<L>,
}

impl<L: Pack<Element = f64>> PairLanes<L> {
    /// Measures the pairs from `lane` on.
    #[inline(always)]
    pub(super) fn new(token: L::Token, rows: &PairRows, lane: usize) -> Self {
        let link = link(token, rows, 9, lane).with_axis();
        Self::between(&link, corners::<L, 18>(token, rows, lane))
    }

    /// Measures pairs of links and triangles in the mesh's frame.
    #[inline(never)] // compiled once for each instruction set, not for each kernel and unit as well
    pub(super) fn between(placed: &Placed<L>, corners: [Vec3<L>; 3]) -> Self {
        placed.radius.token().vectorize(
            #[inline(always)]
            || Self::measure(placed, corners),
        )
    }

    #[inline(always)]
    fn measure(placed: &Placed<L>, corners: [Vec3<L>; 3]) -> Self {
        let pair = placed.with(corners);
        let face = Face::new(pair.triangle);
        let axial = Axial::new(&pair.link, &face);
        // If no lane is beyond a flat cap, the discs decide nothing.
        let closest = if L::bits(axial.beyond_flat_cap()) == 0 {
            axial.without_caps(&pair.link)
        } else {
            axial.with_caps(&pair.link, &face)
        };
        Self { pair, face, axial, closest, start: placed.start }
    }

    /// Returns a point in the mesh's frame.
    #[inline(always)]
    pub(crate) fn placed(&self, point: Vec3<L>) -> Vec3<L> {
        self.start + point * self.pair.unit
    }
}
