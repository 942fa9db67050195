//! The memory layout of triangles: blocks of 16, one row per coordinate, loaded in packs.

use super::engine_mesh::Mesh;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Face, Vec3};
use crate::mesh::SearchFrame;
use parry3d_f64::math::Vector;

/// Triangles per block: the widest pack, so that every narrower one divides it.
pub(crate) const BLOCK: usize = 16;

/// Writes the corners of a triangle into its lane of a block, in the order of a [`Face`].
#[inline(always)] // with a known block length, no index is checked
pub(crate) fn place_face<E: Lane>(
    frame: &SearchFrame,
    mesh: &Mesh,
    triangle: u32,
    rows: &mut [E],
    lane: usize,
) {
    let corners = points_in(frame, mesh.corners(triangle));
    put(rotated(corners, Face::first_of(corners)), rows, lane);
}

/// Returns the corner of a triangle that [`place_face`] writes first.
pub(crate) fn first_of_face<E: Lane>(frame: &SearchFrame, mesh: &Mesh, triangle: u32) -> usize {
    Face::first_of(points_in::<E>(frame, mesh.corners(triangle)))
}

/// Three points in the precision of the search.
#[inline(always)]
pub(crate) fn points_in<E: Lane>(frame: &SearchFrame, [a, b, c]: [Vector; 3]) -> [Vec3<E>; 3] {
    [frame.point(a), frame.point(b), frame.point(c)]
}

/// Rotates the values of three corners or edges so that `first` comes first.
#[inline(always)]
pub(crate) fn rotated<T>([a, b, c]: [T; 3], first: usize) -> [T; 3] {
    match first {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// Writes three points into a lane of a block.
pub(crate) fn place_points<E: Lane>(
    frame: &SearchFrame,
    points: [Vector; 3],
    rows: &mut [E],
    lane: usize,
) {
    put(points_in(frame, points), rows, lane);
}

#[inline(always)]
fn put<E: Lane>(points: [Vec3<E>; 3], rows: &mut [E], lane: usize) {
    for (number, point) in points.into_iter().enumerate() {
        for (axis, value) in <[E; 3]>::from(point).into_iter().enumerate() {
            rows[(3 * number + axis) * BLOCK + lane] = value;
        }
    }
}

// Functions, not closures, below a dispatch: a closure may escape inlining, and is then compiled
// without the instruction set.

/// One point in every lane.
#[inline(always)]
pub(crate) fn splat<L: Pack>(token: L::Token, point: Vec3<L::Element>) -> Vec3<L> {
    Vec3::new(L::splat(token, point.x), L::splat(token, point.y), L::splat(token, point.z))
}

/// Three coordinates from the rows `row` to `row + 2`.
#[inline(always)]
pub(crate) fn load<L: Pack>(
    token: L::Token,
    rows: &[L::Element],
    row: usize,
    lane: usize,
) -> Vec3<L> {
    let rows = &rows[row * BLOCK + lane..];
    Vec3::new(
        L::load(token, rows),
        L::load(token, &rows[BLOCK..]),
        L::load(token, &rows[2 * BLOCK..]),
    )
}

/// Three vertices from the first nine rows.
#[inline(always)]
pub(crate) fn load_vertices<L: Pack>(
    token: L::Token,
    rows: &[L::Element],
    lane: usize,
) -> [Vec3<L>; 3] {
    [load(token, rows, 0, lane), load(token, rows, 3, lane), load(token, rows, 6, lane)]
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
            let mut rows = vec![E::default(); 9 * BLOCK];
            for lane in 0..BLOCK {
                place_face(&frame, &mesh, lane as u32, &mut rows, lane);
                let first = first_of_face::<E>(&frame, &mesh, lane as u32);
                firsts[first] += 1;
                let at = |row: usize| -> f64 { rows[row * BLOCK + lane].into() };
                let [a, b, c] = [0, 3, 6].map(|row| Vector::new(at(row), at(row + 1), at(row + 2)));
                let rounding = 1.0 + 8.0 * E::UNIT_ROUNDOFF;
                let longest = b.distance(c) * rounding;
                assert!(a.distance(b) <= longest && c.distance(a) <= longest, "{seed}: {lane}");
                let corners =
                    mesh.corners(lane as u32).map(|corner| <[E; 3]>::from(frame.point(corner)));
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
