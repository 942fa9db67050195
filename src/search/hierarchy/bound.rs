//! The bounding volume of a child: an oriented box.
//!
//! A patch of wall is nearly flat. So a box with one side along the wall's normal is thin, however
//! the wall is turned.

use crate::distance::lanes::Pack;
use crate::distance::{Scalar, Vec3};
use crate::pair::LinkLanes;

/// How many numbers a bound has.
pub(crate) const BOUND_ROWS: usize = 12;

/// The box around all triangles below a child. The fields are as in [`NodeBounds`].
#[derive(Clone, Copy)]
pub(crate) struct NodeBound<E> {
    pub centre: Vec3<E>,
    pub half: Vec3<E>,
    pub normal: Vec3<E>,
    pub tangent: Vec3<E>,
}

/// The boxes of a pack of children.
#[derive(Clone, Copy)]
pub(crate) struct NodeBounds<L> {
    pub centre: Vec3<L>,
    /// The half extents along the normal, the tangent and the third axis.
    pub half: Vec3<L>,
    /// The axes of the box, orthonormal within rounding. The third axis is their cross product.
    pub normal: Vec3<L>,
    pub tangent: Vec3<L>,
}

impl<L: Pack> NodeBounds<L> {
    /// Returns lower bounds on the squared distances between the axis of a link and the boxes,
    /// within rounding.
    ///
    /// **Definitions.** c: the centre of a box; `h_i`: its half extents along its axes; v: the
    /// vector from the nearest point of the link's axis to c; `v_i`: its parts along the axes of
    /// the box.
    ///
    /// **Claim.** The distance is at least each of
    /// 1. the length of the vector of the *gaps* between box and link along the three axes of the
    ///    box;
    /// 2. the *plane* bound `|v| - (|v_1| h_1 + |v_2| h_2 + |v_3| h_3) / |v|`.
    ///
    /// **Proof.**
    /// 1. Each gap is at most the part of the distance along that axis. The three parts are
    ///    perpendicular.
    /// 2. The plane through the nearest point of the axis with normal v has the whole axis on the
    ///    side opposite to c. Its distance from c is `|v|`. The box reaches from c towards it by at
    ///    most the fraction.
    ///
    /// Bound 2 is sharper where the link is longer than the box, because the link may pass beside
    /// the box slantwise. `plane_may_exclude` is false where bound 2 excludes nothing.
    ///
    /// **Rounding**, in units of `u reach`, where reach is at least 1 and bounds all coordinates.
    /// The axes are of length one within `10 u` and perpendicular within `7 u`, so a length is that
    /// of its parts within `17 u`.
    /// 1. The gaps: 60 for the axes (17 times lengths of at most 3.5); 18 for three products with
    ///    `middle`, which itself errs by 5; 9 for the products with half the link's axis; 9 for the
    ///    differences.
    /// 2. The plane: 102 for the axes, as a box reaches at most 3 from its centre; 25 for products
    ///    with the link; 22 for the reach of the box; 7 for the differences; 10 for the square and
    ///    its division.
    ///
    /// So neither bound errs by more than three times the link's `error`, which is 64: see
    /// [`SearchLink::limit_of_bounds`](crate::pair::SearchLink::limit_of_bounds).
    #[inline(always)]
    pub(crate) fn squared_distances(&self, link: &LinkLanes<L>, plane_may_exclude: bool) -> L {
        let third = self.normal.cross(self.tangent);
        let gaps = self.squared_gaps(link, third);
        if !plane_may_exclude {
            return gaps;
        }
        let (ahead, squared) = self.ahead_of_plane(link, third);
        (ahead * ahead).over(squared).max(gaps)
    }

    /// Returns which boxes may be closer than `limit`, one bit each, without a division. Also
    /// returns the squared distances of the centres from the axis.
    ///
    /// The tests are as in [`squared_distances`](Self::squared_distances). No product that decides
    /// underflows. A box that the plane excludes at `limit` has a centre at least as far away. And
    /// `limit` is at least the rounding of numbers near one.
    #[inline(always)]
    pub(crate) fn may_meet(&self, link: &LinkLanes<L>, limit: L) -> (u64, L) {
        let third = self.normal.cross(self.tangent);
        let (ahead, squared) = self.ahead_of_plane(link, third);
        let limit = limit * limit;
        // A centre on the axis excludes nothing.
        let near = self.squared_gaps(link, third).lt(limit) & !(limit * squared).lt(ahead * ahead);
        (L::bits(near), squared)
    }

    /// Returns the plane bound times `|v|`, at least 0, and `|v|^2`.
    #[inline(always)]
    fn ahead_of_plane(&self, link: &LinkLanes<L>, third: Vec3<L>) -> (L, L) {
        let zero = self.half.x.zero();
        let v = link.offset_from_axis(self.centre);
        let reach = v.dot(self.normal).abs() * self.half.x;
        let reach = v.dot(self.tangent).abs().mul_add(self.half.y, reach);
        let reach = v.dot(third).abs().mul_add(self.half.z, reach);
        let relative = self.centre - link.start;
        ((v.dot(relative) - link.shape.reach_along(v) - reach).max(zero), v.norm_squared())
    }

    /// Returns the squared lengths of the gaps between the boxes and the axis, along the three axes
    /// of the boxes.
    #[inline(always)]
    fn squared_gaps(&self, link: &LinkLanes<L>, third: Vec3<L>) -> L {
        let half = link.shape.end * self.half.x.lit(0.5);
        let middle = link.start + half - self.centre;
        let along_normal = gap(middle, half, self.normal, self.half.x);
        let along_tangent = gap(middle, half, self.tangent, self.half.y);
        let along_third = gap(middle, half, third, self.half.z);
        Vec3::new(along_normal, along_tangent, along_third).norm_squared()
    }
}

/// The gap along an axis between a segment, `half` to either side of `middle`, and a box that
/// reaches `reach` from the origin.
#[inline(always)]
fn gap<T: Scalar>(middle: Vec3<T>, half: Vec3<T>, axis: Vec3<T>, reach: T) -> T {
    (middle.dot(axis).abs() - half.dot(axis).abs() - reach).max(reach.zero())
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::build::WideBvh;
    use super::super::node::{Child, Node, WIDTH};
    use super::*;
    use crate::distance::dispatch;
    use crate::distance::lanes::Lane;
    use crate::mesh::{BLOCK, Mesh};
    use crate::pair::SearchLink;
    use fearless_simd::Level;
    use parry3d_f64::math::{Rotation, Vector};

    /// The corners of all triangles below a child, in the precision of the search.
    pub(crate) fn corners_below(tree: &WideBvh<f32>, child: Child, out: &mut Vec<[f64; 3]>) {
        match child {
            Child::Leaf(leaf) => {
                let rows = &tree.leaves[leaf as usize].rows;
                let at = |corner: usize, lane: usize| {
                    [0, 1, 2].map(|x| f64::from(rows[(3 * corner + x) * BLOCK + lane]))
                };
                out.extend((0..3 * BLOCK).map(|k| at(k / BLOCK, k % BLOCK)));
            }
            Child::Node(node) => {
                tree.nodes[node as usize]
                    .children()
                    .for_each(|child| corners_below(tree, child, out));
            }
        }
    }

    pub(crate) fn children(node: &Node<f32>) -> impl Iterator<Item = (Child, NodeBound<f32>)> + '_ {
        node.children().zip(node.bounds_in_use())
    }

    /// A wall of 64 x 64 squares that bends by the angle.
    pub(crate) fn wall(bend: f64, turn: Rotation) -> (Vec<Vector>, Vec<[u32; 3]>) {
        let point = |k: u32| {
            let (x, y) = (f64::from(k % 65) / 64.0 - 0.5, f64::from(k / 65) / 64.0 - 0.5);
            turn * Vector::new(x, y, bend * (x * x + 0.3 * x * y))
        };
        let squares = (0..64 * 65).filter(|k| k % 65 < 64);
        let triangles = squares.flat_map(|k| [[k, k + 1, k + 66], [k, k + 66, k + 65]]);
        ((0..65 * 65).map(point).collect(), triangles.collect())
    }

    /// Both tests find every child that holds a corner near a link, and they agree.
    #[test]
    fn no_child_near_a_link_is_left_out() {
        #[inline(always)]
        fn ask<L: Pack<Element = f32>>(
            token: L::Token,
            node: &Node<f32>,
            link: &SearchLink<f32>,
            limit: f32,
        ) -> [u64; 2] {
            let lanes = LinkLanes::<L>::new(token, link);
            let (mut may_meet, mut nearer) = (0, 0);
            for lane in (0..WIDTH).step_by(L::LANES) {
                let bounds = node.bounds::<L>(token, lane);
                let limit = L::splat(token, limit);
                may_meet |= bounds.may_meet(&lanes, limit).0 << lane;
                nearer |= L::bits(bounds.squared_distances(&lanes, true).lt(limit * limit)) << lane;
            }
            [may_meet, nearer]
        }
        let (mut near, mut far, mut differ) = (0_u32, 0_u32, 0_u32);
        for round in 0..40_u32 {
            let turn = Rotation::from_scaled_axis(Vector::new(0.3, 1.7, -0.6) * f64::from(round));
            let (vertices, triangles) = wall(10.0_f64.powf(-f64::from(round % 8) * 0.5), turn);
            let tree = WideBvh::<f32>::new(Level::new(), &Mesh::of(vertices, triangles));
            let share = |k: u32| f64::from((round * 7 + 1) * (k * 13 + 5) % 97) / 97.0 - 0.5;
            // Some reach far beyond the wall, where rounding is coarser.
            let spread = [1.0, 30.0][round as usize / 8 % 2];
            let ends = [0, 3].map(|k| {
                turn * Vector::new(share(k) * spread, share(k + 1) * spread, 0.2 * share(k + 2))
            });
            let radius = 0.01 * f64::from(round % 4);
            let Some(link) = SearchLink::between(ends, radius, [false; 2], &tree.frame) else {
                continue;
            };
            let start = Vector::from(<[f32; 3]>::from(link.start).map(f64::from));
            let end = start + Vector::from(<[f32; 3]>::from(link.along).map(f64::from));
            for node in &tree.nodes {
                let least = |(child, _)| {
                    let mut corners = Vec::new();
                    corners_below(&tree, child, &mut corners);
                    let distance = |corner: &[f64; 3]| {
                        crate::robot::distance_to_segment(Vector::from(*corner), start, end)
                    };
                    corners.iter().map(distance).fold(f64::INFINITY, f64::min)
                };
                let least: Vec<_> = children(node).map(least).collect();
                // The limits of a query, and for each child a limit just above the distance of its
                // nearest corner.
                let only_just = least.iter().map(|least| (*least as f32).next_up());
                for axis_limit in [0.0, 0.01, 0.1]
                    .map(|within| link.axis_limit(within))
                    .into_iter()
                    .chain(only_just)
                {
                    let limit = link.limit_of_bounds(axis_limit);
                    let level = Level::new();
                    let [may_meet, nearer] = dispatch!(level, simd => ask::<<f32 as Lane>::Pack<_>>(simd, node, &link, limit));
                    differ += (may_meet ^ nearer).count_ones();
                    for (lane, least) in least.iter().enumerate() {
                        if *least < f64::from(axis_limit) {
                            assert!(
                                may_meet & nearer & 1 << lane != 0,
                                "{round}: {least} and {axis_limit}"
                            );
                            near += 1;
                        } else if may_meet & 1 << lane == 0 {
                            far += 1;
                        }
                    }
                }
            }
        }
        assert!(near > 10_000 && far > 10_000, "{near} near, {far} left out");
        // Except where rounding decides.
        assert!(differ < near / 100, "{differ}");
    }
}
