//! A mesh whose vertices move along straight lines at constant speed, and the search through it.
//!
//! # Definitions
//! - A vertex moves from x to y; at the time t in `[0, 1]` it is at `x + t (y - x)`.
//! - A *moving box* is a pair of boxes in the axes of the mesh's frame, at t = 0 and t = 1. At the
//!   time t each side lies at the share t between its two places.
//!
//! **Claim.** If a moving box holds some vertices at t = 0 and at t = 1, it holds them at all t.
//!
//! **Proof.** In each direction a, a vertex is at the share t between `a x` and `a y`. Each side of
//! the box moves likewise. The vertex is on the inner side of it at both ends, and so at t.
//!
//! So no box is refitted for an instant.
//!
//! # Search
//! The search is in double precision, nearest child first. It prunes a child by the larger of two
//! lower bounds: the gaps between box and link along the axes, and the plane test of `bound`.
//!
//! **Rounding.** For a box and a link with coordinates below `reach`, these bounds and an
//! interpolated vertex err by less than `64 u reach`. That error is subtracted from each bound.

use super::build::WideBvh;
use super::node::Child;
use crate::answer::Work;
use crate::distance::Scalar;
use crate::mesh::Mesh;
use crate::pair::{Best, PlacedLink};
use crate::robot::share_along;
use parry3d_f64::math::{Real, Vector};

/// The ranges of the three coordinates in a box.
#[derive(Clone, Copy, Debug)]
struct CoordinateRange {
    low: Vector,
    high: Vector,
}

impl CoordinateRange {
    const NOTHING: Self = Self { low: Vector::INFINITY, high: Vector::NEG_INFINITY };

    fn with(self, point: Vector) -> Self {
        Self { low: self.low.min(point), high: self.high.max(point) }
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// The boxes around the triangles below a child at t = 0 and t = 1.
type MovingBox = [CoordinateRange; 2];

/// Bounds on the speeds of the vertices of a mesh.
#[derive(Clone, Copy, Default)]
pub(crate) struct MeshSpeed {
    /// An upper bound on the speed of every vertex of a triangle.
    pub most: Real,
    /// The velocity that all these vertices share.
    pub shift: Vector,
    /// An upper bound on the difference from it.
    pub apart: Real,
}

/// The final vertices of a moving mesh, and boxes around its triangles.
#[derive(Clone, Default)]
pub(crate) struct MovingMesh {
    to: Vec<Vector>,
    /// The boxes of the nodes; `leaves` has those around leaves.
    nodes: Vec<MovingBox>,
    leaves: Vec<MovingBox>,
    pub(crate) speed: MeshSpeed,
    /// The largest coordinate of a triangle at either end.
    reach: Real,
    /// Scratch memory: children to visit, the nearest last.
    waiting: Vec<(Real, u32)>,
}

impl MovingMesh {
    /// Sets the final vertices, which the caller has checked. `tree` is any hierarchy of the mesh.
    pub(crate) fn set(&mut self, mesh: &Mesh, tree: &WideBvh<f32>, to: &[Vector]) {
        self.to.clear();
        self.to.extend_from_slice(to);
        self.leaves.clear();
        (self.speed, self.reach) = (MeshSpeed::default(), 0.0);
        let mut ways = CoordinateRange::NOTHING;
        mesh.used_vertices().for_each(|vertex| {
            let ends = [mesh.vertices()[vertex], to[vertex]];
            self.speed.most = self.speed.most.max((ends[1] - ends[0]).length());
            ways = ways.with(ends[1] - ends[0]);
            self.reach = self.reach.max(ends[0].abs().max(ends[1].abs()).max_element());
        });
        for leaf in &tree.leaves {
            let mut sides = [CoordinateRange::NOTHING; 2];
            for vertex in leaf.triangles().flat_map(|triangle| mesh.indices()[triangle as usize]) {
                let ends = [mesh.vertices()[vertex as usize], to[vertex as usize]];
                sides = [sides[0].with(ends[0]), sides[1].with(ends[1])];
            }
            self.leaves.push(sides);
        }
        // Covers the rounding of differences and a length.
        self.speed.most *= 1.0 + 8.0 * Real::UNIT_ROUNDOFF;
        // The box around all ways is within half of its diagonal of its centre. Vertices are
        // rounded by u at both ends.
        let rounding = 8.0 * Real::UNIT_ROUNDOFF * (self.reach + self.speed.most);
        let apart = (0.5 * (ways.high - ways.low)).length() + rounding;
        // Otherwise the vertices share too little.
        (self.speed.shift, self.speed.apart) = if apart <= 0.5 * self.speed.most {
            (0.5 * ways.low + 0.5 * ways.high, apart)
        } else {
            (Vector::ZERO, self.speed.most)
        };
        self.nodes.clear();
        self.nodes.resize(tree.nodes.len(), [CoordinateRange::NOTHING; 2]);
        // Children have higher numbers than their node.
        for (number, node) in tree.nodes.iter().enumerate().rev() {
            let mut sides = [CoordinateRange::NOTHING; 2];
            for child in node.children() {
                let below = self.sides(child);
                sides = [sides[0].and(below[0]), sides[1].and(below[1])];
            }
            self.nodes[number] = sides;
        }
    }

    pub(crate) fn reach(&self) -> Real {
        self.reach
    }

    fn sides(&self, child: Child) -> &MovingBox {
        match child {
            Child::Node(node) => &self.nodes[node as usize],
            Child::Leaf(leaf) => &self.leaves[leaf as usize],
        }
    }
}

/// A moving mesh at one instant.
pub(crate) struct MeshAt<'a> {
    pub moving: &'a mut MovingMesh,
    /// The time, from 0 to 1.
    pub share: Real,
}

impl MeshAt<'_> {
    /// The corners of a triangle at this instant.
    pub(crate) fn corners(&self, mesh: &Mesh, triangle: u32) -> [Vector; 3] {
        mesh.indices()[triangle as usize].map(|vertex| {
            let (from, to) = (mesh.vertices()[vertex as usize], self.moving.to[vertex as usize]);
            between(from, to, self.share)
        })
    }

    /// Returns the nearest triangle of a link, or `best` if no triangle improves on it. The `start`
    /// triangle is tested first.
    pub(crate) fn nearest(
        &mut self,
        mesh: &Mesh,
        tree: &WideBvh<f32>,
        link: &PlacedLink,
        mut best: Best,
        start: Option<u32>,
        work: &mut Work,
    ) -> Best {
        if let Some(triangle) = start.filter(|triangle| (*triangle as usize) < mesh.len()) {
            best.measure(link, triangle, self.corners(mesh, triangle));
        }
        let axis = Axis::new(link, self.moving.reach);
        let mut waiting = std::mem::take(&mut self.moving.waiting);
        waiting.clear();
        waiting.push((0.0, Child::Node(0).pack()));
        while let Some((bound, child)) = waiting.pop() {
            if bound > best.bound() || best.triangle_limit() == 0 {
                continue;
            }
            match Child::unpack(child) {
                Child::Node(node) => {
                    work.nodes += 1;
                    let first = waiting.len();
                    for child in tree.nodes[node as usize].children() {
                        let bound = axis.bound(self.moving.sides(child), self.share);
                        if bound <= best.bound() {
                            waiting.push((bound, child.pack()));
                        }
                    }
                    waiting[first..].sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
                }
                Child::Leaf(leaf) => {
                    for triangle in tree.leaves[leaf as usize].triangles() {
                        work.visited += 1;
                        let corners = self.corners(mesh, triangle);
                        let sides = corners
                            .into_iter()
                            .fold(CoordinateRange::NOTHING, CoordinateRange::with);
                        if axis.bound(&[sides; 2], 0.0) <= best.bound() {
                            work.measured += 1;
                            best.measure(link, triangle, corners);
                        }
                    }
                }
            }
        }
        self.moving.waiting = waiting;
        best
    }

    /// Returns true if any triangle may be at most `bound` from a capsule. Conservative: false is
    /// exact.
    pub(crate) fn may_meet(
        &mut self,
        tree: &WideBvh<f32>,
        capsule: &PlacedLink,
        bound: Real,
    ) -> bool {
        let axis = Axis::new(capsule, self.moving.reach);
        let mut waiting = std::mem::take(&mut self.moving.waiting);
        waiting.clear();
        waiting.push((0.0, Child::Node(0).pack()));
        let mut is_met = false;
        while let Some((_, child)) = waiting.pop() {
            let Child::Node(node) = Child::unpack(child) else {
                is_met = true;
                break;
            };
            let near = tree.nodes[node as usize].children();
            let near =
                near.filter(|child| axis.bound(self.moving.sides(*child), self.share) <= bound);
            waiting.extend(near.map(|child| (0.0, child.pack())));
        }
        self.moving.waiting = waiting;
        is_met
    }

    /// Adds to `found` all triangles that may be at most `bound` from a link, in no order. Returns
    /// false if there are more than `most`.
    pub(crate) fn gather(
        &mut self,
        mesh: &Mesh,
        tree: &WideBvh<f32>,
        link: &PlacedLink,
        bound: Real,
        most: usize,
        found: &mut Vec<u32>,
    ) -> bool {
        let axis = Axis::new(link, self.moving.reach);
        let mut waiting = std::mem::take(&mut self.moving.waiting);
        waiting.clear();
        waiting.push((0.0, Child::Node(0).pack()));
        while let Some((_, child)) = waiting.pop() {
            match Child::unpack(child) {
                Child::Node(node) => {
                    let near = tree.nodes[node as usize].children();
                    let near = near
                        .filter(|child| axis.bound(self.moving.sides(*child), self.share) <= bound);
                    waiting.extend(near.map(|child| (0.0, child.pack())));
                }
                Child::Leaf(leaf) => {
                    found.extend(tree.leaves[leaf as usize].triangles().filter(|&triangle| {
                        let sides = self
                            .corners(mesh, triangle)
                            .into_iter()
                            .fold(CoordinateRange::NOTHING, CoordinateRange::with);
                        axis.bound(&[sides; 2], 0.0) <= bound
                    }))
                }
            }
            if found.len() > most {
                break;
            }
        }
        self.moving.waiting = waiting;
        found.len() <= most
    }
}

fn between(from: Vector, to: Vector, share: Real) -> Vector {
    from + (to - from) * share
}

/// The axis and radius of a link.
struct Axis {
    start: Vector,
    along: Vector,
    radius: Real,
    /// An upper bound on the rounding of a lower bound.
    error: Real,
}

impl Axis {
    fn new(link: &PlacedLink, reach: Real) -> Self {
        let (start, radius) = (link.start(), link.radius());
        let reach = reach.max(start.abs().max(link.end().abs()).max_element()) + radius;
        Self { start, along: link.along(), radius, error: 64.0 * Real::UNIT_ROUNDOFF * reach }
    }

    /// Returns a lower bound on the distance of the link from a box. Below 0 it says nothing.
    fn bound(&self, sides: &MovingBox, share: Real) -> Real {
        let [low, high] = [
            between(sides[0].low, sides[1].low, share),
            between(sides[0].high, sides[1].high, share),
        ];
        let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let relative = centre - self.start;
        let middle = self.along * 0.5;
        let gaps = ((relative - middle).abs() - middle.abs() - half).max(Vector::ZERO);
        // The plane through the nearest point of the axis, with its normal towards the centre.
        let ahead = relative - self.along * share_along(relative, self.along);
        let away = ahead.length();
        let beyond = if away > 0.0 {
            let normal = ahead / away;
            let reached = normal.dot(self.along).max(0.0);
            normal.dot(relative) - reached - normal.abs().dot(half)
        } else {
            0.0
        };
        gaps.length().max(beyond) - self.radius - self.error
    }
}
