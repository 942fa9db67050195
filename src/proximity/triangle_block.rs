//! How triangles stand in memory: several together, each coordinate in a row of its own, to be loaded in packs.

use super::mesh::Mesh;
use super::search_frame::SearchFrame;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, Vec3};
use parry3d_f64::math::Vector;

/// How many triangles stand together in a block: the widest pack, so that any narrower one divides it.
pub(super) const BLOCK: usize = 16;

/// How many triangles stand together in a leaf of a hierarchy. Measured: with 16 or 32, more are met in vain than the nodes
/// cost that are spared.
pub(super) const LEAF: usize = 8;

/// Writes the corners of a triangle into its lane, in the order in which a [`Face`] has them.
pub(super) fn place_face<E: Lane, const N: usize>(
    frame: &SearchFrame,
    mesh: &Mesh,
    triangle: u32,
    rows: &mut [[E; N]],
    lane: usize,
) {
    let corners = mesh.corners(triangle).map(|corner| frame.point(corner));
    put(from_on(corners, Face::first_of(corners)), rows, lane);
}

/// Which corner of a triangle [`place_face`] writes first.
pub(super) fn first_of_face<E: Lane>(frame: &SearchFrame, mesh: &Mesh, triangle: u32) -> usize {
    Face::first_of(mesh.corners(triangle).map(|corner| frame.point::<E>(corner)))
}

/// What there is for each of three corners or edges, from one of them on.
#[inline(always)]
pub(super) fn from_on<T>(mut three: [T; 3], first: usize) -> [T; 3] {
    three.rotate_left(first);
    three
}

/// Writes the corners of a triangle into its lane.
pub(super) fn place_triangle<E: Lane, const N: usize>(
    frame: &SearchFrame,
    mesh: &Mesh,
    triangle: u32,
    rows: &mut [[E; N]],
    lane: usize,
) {
    place_points(frame, mesh.corners(triangle), rows, lane);
}

/// Writes three points into a lane.
pub(super) fn place_points<E: Lane, const N: usize>(
    frame: &SearchFrame,
    points: [Vector; 3],
    rows: &mut [[E; N]],
    lane: usize,
) {
    put(points.map(|point| frame.point(point)), rows, lane);
}

fn put<E: Lane, const N: usize>(points: [Vec3<E>; 3], rows: &mut [[E; N]], lane: usize) {
    let values = points.into_iter().flat_map(<[E; 3]>::from);
    rows.iter_mut().zip(values).for_each(|(row, value)| row[lane] = value);
}

// Functions and not closures below a dispatch: a closure may escape inlining, and its code would then be compiled
// without the instruction set.

/// One point in every lane.
#[inline(always)]
pub(super) fn splat<L: Pack>(token: L::Token, point: Vec3<L::Element>) -> Vec3<L> {
    Vec3::new(L::splat(token, point.x), L::splat(token, point.y), L::splat(token, point.z))
}

/// Three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
pub(super) fn load<L: Pack, const N: usize>(
    token: L::Token,
    rows: &[[L::Element; N]],
    row: usize,
    lane: usize,
) -> Vec3<L> {
    Vec3::new(
        L::load(token, &rows[row][lane..]),
        L::load(token, &rows[row + 1][lane..]),
        L::load(token, &rows[row + 2][lane..]),
    )
}

/// Three vertices from the first nine rows.
#[inline(always)]
pub(super) fn load_vertices<L: Pack, const N: usize>(
    token: L::Token,
    rows: &[[L::Element; N]],
    lane: usize,
) -> [Vec3<L>; 3] {
    [load(token, rows, 0, lane), load(token, rows, 3, lane), load(token, rows, 6, lane)]
}

/// Writes three coordinates to the rows `row` to `row + 2`.
#[inline(always)]
pub(super) fn store<L: Pack, const N: usize>(
    vector: Vec3<L>,
    rows: &mut [[L::Element; N]],
    row: usize,
    lane: usize,
) {
    vector.x.store(&mut rows[row][lane..]);
    vector.y.store(&mut rows[row + 1][lane..]);
    vector.z.store(&mut rows[row + 2][lane..]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;

    /// The corner opposite the longest edge comes first, and the others follow in their order.
    fn check<E: Lane>() {
        let mut firsts = [0; 3];
        for seed in 0..1000 {
            let mut random = Random::new(seed);
            // Some are slivers.
            let thin = [1.0, 1e-3, 1e-6][random.below(3) as usize];
            let mut corner = || random.point() * Vector::new(1.0, thin, thin);
            let corners = (0..3 * BLOCK).map(|_| corner()).collect();
            let triangles = (0..BLOCK as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mesh = Mesh::of(corners, triangles);
            let frame = SearchFrame::new(&mesh);
            let mut rows = [[E::default(); BLOCK]; 9];
            for lane in 0..BLOCK {
                place_face(&frame, &mesh, lane as u32, &mut rows, lane);
                let first = first_of_face::<E>(&frame, &mesh, lane as u32);
                firsts[first] += 1;
                let at = |row: usize| -> f64 { rows[row][lane].into() };
                let [a, b, c] = [0, 3, 6].map(|row| Vector::new(at(row), at(row + 1), at(row + 2)));
                let rounding = 1.0 + 8.0 * E::UNIT_ROUNDOFF;
                let longest = b.distance(c) * rounding;
                assert!(a.distance(b) <= longest && c.distance(a) <= longest, "{seed}: {lane}");
                let corners = mesh.corners(lane as u32).map(|corner| <[E; 3]>::from(frame.point(corner)));
                for (number, placed) in [a, b, c].into_iter().enumerate() {
                    assert_eq!(
                        corners[(first + number) % 3].map(Into::into),
                        placed.to_array(),
                        "{seed}: {lane}"
                    );
                }
            }
        }
        assert!(firsts.iter().all(|&count| count > 4000), "{firsts:?}");
    }

    #[test]
    fn corners_stand_in_the_order_of_their_faces() {
        check::<f32>();
        check::<f64>();
    }
}
