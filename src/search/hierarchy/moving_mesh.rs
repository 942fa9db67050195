//! A mesh whose vertices move straight and evenly, and the search through it at a moment.
//!
//! A vertex goes from x to y, and is at x + t (y - x) at the time t. In a direction a it is at the
//! share t between a x and a y, so a box that holds vertices at either end of the time, in the same
//! axes, holds them at all times if its sides move evenly too. So each box is known from two boxes,
//! and nothing is fitted again for a moment. The axes are those of the mesh's frame.
//!
//! The search is in double precision, the nearest child first. A child is left out by the gap
//! between its box and the axis of the body along each axis, or by a plane before the axis that
//! faces the box's centre (`bound`). Of a box and a link whose coordinates are below `reach` these
//! bounds, and a vertex on its way, err by less than 64 u reach, which counts against leaving out.

use super::build::WideBvh;
use super::node::Child;
use crate::answer::Work;
use crate::distance::Scalar;
use crate::mesh::Mesh;
use crate::pair::{Best, PlacedLink};
use parry3d_f64::math::{Real, Vector};

/// From where to where a coordinate reaches in a box.
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

/// The boxes around what is below a child, at both ends of the time.
type MovingBox = [CoordinateRange; 2];

/// Where the vertices of a mesh go, and boxes around its triangles on the way.
#[derive(Clone, Default)]
pub(crate) struct MovingMesh {
    to: Vec<Vector>,
    /// Those of the nodes, and of the leaves.
    nodes: Vec<MovingBox>,
    leaves: Vec<MovingBox>,
    /// No vertex of a triangle is faster.
    speed: Real,
    /// The largest coordinate of a triangle at either end.
    reach: Real,
    /// Memory: what waits for its turn, the nearest last.
    waiting: Vec<(Real, u32)>,
}

impl MovingMesh {
    /// Moves the vertices of a mesh to these places, which were checked; `tree` is any hierarchy of
    /// the mesh.
    pub(crate) fn set(&mut self, mesh: &Mesh, tree: &WideBvh<f32>, to: &[Vector]) {
        self.to.clear();
        self.to.extend_from_slice(to);
        self.leaves.clear();
        (self.speed, self.reach) = (0.0, 0.0);
        for leaf in &tree.leaves {
            let mut sides = [CoordinateRange::NOTHING; 2];
            for vertex in leaf.triangles().flat_map(|triangle| mesh.indices()[triangle as usize]) {
                let ends = [mesh.vertices()[vertex as usize], to[vertex as usize]];
                sides = [sides[0].with(ends[0]), sides[1].with(ends[1])];
                self.speed = self.speed.max((ends[1] - ends[0]).length());
                self.reach = self.reach.max(ends[0].abs().max(ends[1].abs()).max_element());
            }
            self.leaves.push(sides);
        }
        // Differences and a length.
        self.speed *= 1.0 + 8.0 * Real::UNIT_ROUNDOFF;
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

    pub(crate) fn speed(&self) -> Real {
        self.speed
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

/// A mesh that moves, at a moment.
pub(crate) struct MeshAt<'a> {
    pub moving: &'a mut MovingMesh,
    /// The time, from 0 to 1.
    pub share: Real,
}

impl MeshAt<'_> {
    /// The corners of a triangle.
    pub(crate) fn corners(&self, mesh: &Mesh, triangle: u32) -> [Vector; 3] {
        mesh.indices()[triangle as usize].map(|vertex| {
            let (from, to) = (mesh.vertices()[vertex as usize], self.moving.to[vertex as usize]);
            between(from, to, self.share)
        })
    }

    /// The triangle nearest to a link that improves on `best`. The triangle to `start` with comes
    /// first.
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

    /// Whether any triangle may be at most `bound` from a capsule; false only if none is.
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

    /// All triangles that may be at most `bound` from a link, in no order; false if they are more
    /// than `most`.
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

/// The axis of a link.
struct Axis {
    start: Vector,
    along: Vector,
    radius: Real,
    /// What rounding can do to a bound.
    error: Real,
}

impl Axis {
    fn new(link: &PlacedLink, reach: Real) -> Self {
        let (start, radius) = (link.start(), link.radius());
        let reach = reach.max(start.abs().max(link.end().abs()).max_element()) + radius;
        Self { start, along: link.along(), radius, error: 64.0 * Real::UNIT_ROUNDOFF * reach }
    }

    /// What the link keeps from a box at the least, or a little less; below 0 where nothing is
    /// known.
    fn bound(&self, sides: &MovingBox, share: Real) -> Real {
        let [low, high] = [
            between(sides[0].low, sides[1].low, share),
            between(sides[0].high, sides[1].high, share),
        ];
        let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let relative = centre - self.start;
        let middle = self.along * 0.5;
        let gaps = ((relative - middle).abs() - middle.abs() - half).max(Vector::ZERO);
        // The plane before the axis whose normal leads from its nearest place to the centre.
        let place = relative.dot(self.along) / self.along.length_squared();
        // 0 / 0 without a length: the comparison turns it into 0.
        let place = if place > 0.0 { place.min(1.0) } else { 0.0 };
        let ahead = relative - self.along * place;
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
