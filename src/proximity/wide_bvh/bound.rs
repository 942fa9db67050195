//! What a node knows of a child: a box and a disc around the same centre.

use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, Vec3};
use crate::proximity::link_lanes::{LinkLanes, magnitudes};
use crate::proximity::triangle_block::{BLOCK, load_vertices, splat};

/// How many numbers a bound has.
pub(super) const BOUND_ROWS: usize = 11;

/// What holds all triangles below a child. The fields are those of [`NodeBounds`].
#[derive(Clone, Copy)]
pub(super) struct NodeBound<E> {
    pub centre: Vec3<E>,
    pub half: Vec3<E>,
    pub normal: Vec3<E>,
    pub thickness: E,
    pub radius: E,
}

/// The bounds of a pack of children.
#[derive(Clone, Copy)]
pub(super) struct NodeBounds<L> {
    pub centre: Vec3<L>,
    /// Half extents of the box around the centre.
    pub half: Vec3<L>,
    /// The unit normal of the disc around the centre.
    pub normal: Vec3<L>,
    /// How far the triangles reach from the centre along the normal.
    pub thickness: L,
    /// How far they reach across the normal.
    pub radius: L,
}

impl<L: Pack> NodeBounds<L> {
    /// The squared distances between the axis of a link and what is bounded, from below but for rounding.
    ///
    /// Let v lead from the axis to a centre. The plane with normal v before the axis keeps as far from the
    /// centre as v is long, less e, where e is how far the triangles reach from the centre against v: at most
    /// (|v_n| thickness + |v_t| radius) / |v| for the disc, with v_n and v_t the parts of v along and across the
    /// disc's normal, and <|v|, half> / |v| for the box. The disc is nearly exact for a patch of wall, however it
    /// is turned. The distance between the boxes of child and axis serves the large children near the root.
    #[inline(always)]
    pub(super) fn squared_distances(&self, link: &LinkLanes<L>) -> L {
        let (ahead, squared) = self.ahead_of_plane(link);
        (ahead * ahead).over(squared).max(self.squared_gaps(link))
    }

    /// Which of them are below `limit` or may be, as bits, without a division; and how far the centres are from the
    /// axis, squared.
    ///
    /// No product falls below the range where that could tell: whatever the plane keeps at `limit` has a centre as far
    /// away, and `limit` is never less than the rounding of numbers near one.
    #[inline(always)]
    pub(super) fn may_meet(&self, link: &LinkLanes<L>, limit: L) -> (u64, L) {
        let (ahead, squared) = self.ahead_of_plane(link);
        let limit = limit * limit;
        // A centre on the axis rules nothing out.
        let near = self.squared_gaps(link).lt(limit) & !(limit * squared).lt(ahead * ahead);
        (L::bits(near), squared)
    }

    /// How far the children keep from the plane before the axis, in units of 1 / |v|, and |v|^2.
    #[inline(always)]
    fn ahead_of_plane(&self, link: &LinkLanes<L>) -> (L, L) {
        let zero = self.radius.zero();
        let v = link.offset_from_axis(self.centre);
        let normal_part = v.dot(self.normal);
        // Not the root of |v|^2 - v_n^2, which loses angles up to the root of the rounding.
        let across = v.along(self.normal, -normal_part).norm();
        let disc = normal_part.abs().mul_add(self.thickness, across * self.radius);
        let reach = disc.min(magnitudes(v).dot(self.half));
        let relative = self.centre - link.start;
        ((v.dot(relative) - link.link.reach_along(v) - reach).max(zero), v.norm_squared())
    }

    /// The squared distances between the boxes of the children and the axis.
    #[inline(always)]
    fn squared_gaps(&self, link: &LinkLanes<L>) -> L {
        let zero = self.radius.zero();
        let relative = self.centre - link.start;
        let middle = link.link.end * zero.lit(0.5);
        let gap = magnitudes(relative - middle) - self.half - magnitudes(middle);
        Vec3::new(gap.x.max(zero), gap.y.max(zero), gap.z.max(zero)).norm_squared()
    }
}

/// Added to every extent: the rounding of numbers near one.
fn rounding<E: Scalar>(like: E) -> E {
    like.lit(16.0 * E::UNIT_ROUNDOFF)
}

impl<E: Lane> NodeBound<E> {
    /// Around the triangles of a leaf, given by the rows of their coordinates.
    #[inline(always)]
    pub(super) fn of_leaf<L: Pack<Element = E>>(token: L::Token, rows: &[E; 9 * BLOCK]) -> Self {
        let first = load_vertices::<L>(token, rows, 0);
        let (mut low, mut high) = (first[0], first[0]);
        let zero = first[0].x.zero();
        let mut area = Vec3::zero(zero);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let [a, b, c] = load_vertices::<L>(token, rows, lane);
            low = lower(lower(low, a), lower(b, c));
            high = upper(upper(high, a), upper(b, c));
            area = area + (b - a).cross(c - a);
        }
        let mut bound = Self::between(fold(low, E::min), fold(high, E::max), fold(area, E::add));

        let centre = splat(token, bound.centre);
        let normal = splat(token, bound.normal);
        let (mut height, mut radial) = (zero, zero);
        for lane in (0..BLOCK).step_by(L::LANES) {
            for corner in load_vertices::<L>(token, rows, lane) {
                let relative = corner - centre;
                let along = relative.dot(normal);
                height = height.max(along.abs());
                radial = radial.max(relative.along(normal, -along).norm_squared());
            }
        }
        bound.thickness = fold_row(height, E::max) + rounding(bound.thickness);
        bound.radius = fold_row(radial, E::max).sqrt() + rounding(bound.radius);
        bound
    }

    /// Around the bounds of a node's children, of which there is at least one.
    pub(super) fn of_children(children: impl Iterator<Item = Self> + Clone) -> Self {
        let nothing = Vec3::zero(E::default());
        // A larger child has more of the wall's area and so more say.
        let normal = children.clone().map(|child| child.normal * (child.radius * child.radius));
        let mut around = Self::between(
            children.clone().map(|child| child.centre - child.half).reduce(lower).unwrap_or(nothing),
            children.clone().map(|child| child.centre + child.half).reduce(upper).unwrap_or(nothing),
            normal.reduce(|a, b| a + b).unwrap_or(nothing),
        );
        let one = E::default().one();
        let is_unit = |normal: Vec3<E>| one.lit(0.5).lt(normal.norm_squared());
        for child in children {
            let cosine = around.normal.dot(child.normal).abs().min(one);
            // Not the root of 1 - cosine^2, which loses angles up to the root of the rounding. Without a normal a child
            // reaches as far along any.
            let has_normals = is_unit(around.normal) && is_unit(child.normal);
            let sine = if has_normals { around.normal.cross(child.normal).norm() } else { one };
            // How far the smaller disc reaches along and across the larger one's normal.
            let along = cosine * child.thickness + sine * child.radius;
            let across = sine * child.thickness + child.radius;
            around.reach(child.centre, along, across);
        }
        around
    }

    fn between(low: Vec3<E>, high: Vec3<E>, normal: Vec3<E>) -> Self {
        let (half, zero) = (low.x.lit(0.5), low.x.zero());
        let centre = low * half + high * half;
        let slack = rounding(zero);
        let half = upper(high - centre, centre - low) + Vec3::new(slack, slack, slack);
        Self { centre, half, normal: normal.normalised(), thickness: zero, radius: zero }
    }

    /// Widens the disc to hold what reaches `along` and `across` the normal from `point`.
    fn reach(&mut self, point: Vec3<E>, along: E, across: E) {
        let relative = point - self.centre;
        let height = relative.dot(self.normal);
        let radial = (relative - self.normal * height).norm();
        self.thickness = self.thickness.max(height.abs() + along + rounding(height));
        self.radius = self.radius.max(radial + across + rounding(height));
    }
}

/// The lesser of each coordinate.
#[inline(always)]
fn lower<T: Scalar>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    Vec3::new(a.x.min(b.x), a.y.min(b.y), a.z.min(b.z))
}

/// The greater of each coordinate.
#[inline(always)]
fn upper<T: Scalar>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    Vec3::new(a.x.max(b.x), a.y.max(b.y), a.z.max(b.z))
}

/// One number of all lanes.
#[inline(always)]
fn fold_row<L: Pack>(row: L, both: fn(L::Element, L::Element) -> L::Element) -> L::Element
where
    L::Element: Lane,
{
    let mut lanes = [L::Element::default(); BLOCK];
    row.store(&mut lanes);
    lanes[1..L::LANES].iter().fold(lanes[0], |a, &b| both(a, b))
}

/// One point of all lanes.
#[inline(always)]
fn fold<L: Pack>(rows: Vec3<L>, both: fn(L::Element, L::Element) -> L::Element) -> Vec3<L::Element>
where
    L::Element: Lane,
{
    Vec3::new(fold_row(rows.x, both), fold_row(rows.y, both), fold_row(rows.z, both))
}

#[cfg(test)]
mod tests {
    use super::super::build::WideBvh;
    use super::super::node::{Child, Node, WIDTH};
    use super::*;
    use crate::proximity::mesh::Mesh;
    use crate::proximity::search_frame::SearchLink;
    use fearless_simd::Level;
    use parry3d_f64::math::{Rotation, Vector};

    /// The corners of all triangles below a child, in the precision of the search.
    fn corners_below(tree: &WideBvh<f32>, child: Child, out: &mut Vec<[f64; 3]>) {
        match child {
            Child::Leaf(leaf) => {
                let rows = &tree.leaves[leaf as usize].rows;
                let at = |corner: usize, lane: usize| {
                    [0, 1, 2].map(|x| f64::from(rows[(3 * corner + x) * BLOCK + lane]))
                };
                out.extend((0..3 * BLOCK).map(|k| at(k / BLOCK, k % BLOCK)));
            }
            Child::Node(node) => {
                tree.nodes[node as usize].children().for_each(|child| corners_below(tree, child, out));
            }
        }
    }

    fn children(node: &Node<f32>) -> impl Iterator<Item = (Child, NodeBound<f32>)> + '_ {
        node.children().zip(node.bounds_in_use())
    }

    /// A wall of 64 x 64 squares that bends by the angle.
    fn wall(bend: f64, turn: Rotation) -> (Vec<Vector>, Vec<[u32; 3]>) {
        let point = |k: u32| {
            let (x, y) = (f64::from(k % 65) / 64.0 - 0.5, f64::from(k / 65) / 64.0 - 0.5);
            turn * Vector::new(x, y, bend * (x * x + 0.3 * x * y))
        };
        let squares = (0..64 * 65).filter(|k| k % 65 < 64);
        let triangles = squares.flat_map(|k| [[k, k + 1, k + 66], [k, k + 66, k + 65]]);
        ((0..65 * 65).map(point).collect(), triangles.collect())
    }

    /// What may meet a link is never fewer children than hold a corner near it, and the two ways to ask agree.
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
                nearer |= L::bits(bounds.squared_distances(&lanes).lt(limit * limit)) << lane;
            }
            [may_meet, nearer]
        }
        let (mut near, mut far, mut differ) = (0, 0, 0);
        for round in 0..40_u32 {
            let turn = Rotation::from_scaled_axis(Vector::new(0.3, 1.7, -0.6) * f64::from(round));
            let (vertices, triangles) = wall(10.0_f64.powf(-f64::from(round % 8) * 0.5), turn);
            let tree = WideBvh::<f32>::new(Level::new(), &Mesh::of(vertices, triangles));
            let share = |k: u32| f64::from((round * 7 + 1) * (k * 13 + 5) % 97) / 97.0 - 0.5;
            let ends = [0, 3].map(|k| turn * Vector::new(share(k), share(k + 1), 0.2 * share(k + 2)));
            let radius = 0.01 * f64::from(round % 4);
            let Some(link) = SearchLink::between(ends, radius, [false; 2], &tree.frame) else { continue };
            let start = Vector::from(<[f32; 3]>::from(link.start).map(f64::from));
            let end = start + Vector::from(<[f32; 3]>::from(link.along).map(f64::from));
            for node in &tree.nodes {
                for within in [0.0, 0.01, 0.1] {
                    let limit = link.axis_limit(within);
                    let level = Level::new();
                    let [may_meet, nearer] = fearless_simd::dispatch!(level, simd => ask::<<f32 as Lane>::Pack<_>>(simd, node, &link, limit));
                    differ += (may_meet ^ nearer).count_ones();
                    for (lane, (child, _)) in children(node).enumerate() {
                        let mut corners = Vec::new();
                        corners_below(&tree, child, &mut corners);
                        let distance = |corner: &[f64; 3]| {
                            crate::robot::distance_to_segment(Vector::from(*corner), start, end)
                        };
                        let least = corners.iter().map(distance).fold(f64::INFINITY, f64::min);
                        if least < f64::from(limit - link.error) {
                            assert!(may_meet & nearer & 1 << lane != 0, "{round}: {least} and {limit}");
                            near += 1;
                        } else if may_meet & 1 << lane == 0 {
                            far += 1;
                        }
                    }
                }
            }
        }
        assert!(near > 300 && far > 10_000, "{near} near, {far} left out");
        // But for what rounding decides.
        assert!(differ <= 3, "{differ}");
    }

    /// Angles between normals of which the cosine rounds to one are angles all the same.
    #[test]
    fn every_bound_holds_its_triangles() {
        let (mut checked, mut slight) = (0, 0);
        for round in 0..60 {
            let bend = 10.0_f64.powf(-f64::from(round % 12) * 0.5);
            let turn = Rotation::from_scaled_axis(Vector::new(0.3, 1.7, -0.6) * f64::from(round));
            let (vertices, triangles) = wall(bend, turn);
            let tree = WideBvh::new(Level::new(), &Mesh::of(vertices, triangles));
            for (child, bound) in tree.nodes.iter().flat_map(children) {
                let [centre, half, normal] =
                    [bound.centre, bound.half, bound.normal].map(|v| <[f32; 3]>::from(v).map(f64::from));
                let mut corners = Vec::new();
                corners_below(&tree, child, &mut corners);
                for corner in corners {
                    let offset = Vector::from(corner) - Vector::from(centre);
                    let along = offset.dot(Vector::from(normal));
                    let across = (offset - Vector::from(normal) * along).length();
                    assert!(
                        along.abs() <= f64::from(bound.thickness),
                        "bend {bend}: {along} beyond {}",
                        bound.thickness
                    );
                    assert!(
                        across <= f64::from(bound.radius),
                        "bend {bend}: {across} beyond {}",
                        bound.radius
                    );
                    assert!(offset.abs().cmple(Vector::from(half)).all());
                    checked += 1;
                }
                slight += usize::from(matches!(child, Child::Node(_)) && bound.thickness < 1e-3);
            }
        }
        assert!(checked > 100_000 && slight > 100, "{checked} corners, {slight} nearly flat bounds of nodes");
    }
}
