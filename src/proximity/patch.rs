//! What a hierarchy's node knows of a patch of the mesh: a box and a disc around the same centre.

use super::packed::{BLOCK, splat};
use super::soa::load_vertices;
use super::tree::Node;
use crate::distance::lanes::Pack;
use crate::distance::{Scalar, Vec3};
use std::ops::Add;

/// How many numbers a patch has.
pub(super) const PATCH_ROWS: usize = 11;

/// Added to every extent: the rounding of numbers near one.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// One patch; the fields are those of [`Patches`](super::packed::Patches).
pub(super) struct Patch {
    pub centre: Vec3<f32>,
    pub half: Vec3<f32>,
    pub normal: Vec3<f32>,
    pub thickness: f32,
    pub radius: f32,
}

impl Patch {
    /// Around the triangles of a leaf, given by the rows of their coordinates.
    #[inline(always)]
    pub(super) fn of_leaf<L: Pack<Element = f32>>(token: L::Token, rows: &[f32; 9 * BLOCK]) -> Self {
        let first = load_vertices::<L>(token, rows, 0);
        let (mut low, mut high) = (first[0], first[0]);
        let zero = first[0].x.zero();
        let mut area = Vec3::new(zero, zero, zero);
        for lane in (0..BLOCK).step_by(L::LANES) {
            let [a, b, c] = load_vertices::<L>(token, rows, lane);
            low = lower(lower(low, a), lower(b, c));
            high = upper(upper(high, a), upper(b, c));
            area = area + (b - a).cross(c - a);
        }
        let mut patch = Self::between(fold(low, f32::min), fold(high, f32::max), fold(area, Add::add));

        let centre = splat(token, patch.centre);
        let normal = splat(token, patch.normal);
        let (mut height, mut radial) = (zero, zero);
        for lane in (0..BLOCK).step_by(L::LANES) {
            for corner in load_vertices::<L>(token, rows, lane) {
                let relative = corner - centre;
                let along = relative.dot(normal);
                height = height.max(along.abs());
                radial = radial.max(relative.along(normal, -along).norm_squared());
            }
        }
        patch.thickness = fold_row(height, f32::max) + ROUNDING;
        patch.radius = fold_row(radial, f32::max).sqrt() + ROUNDING;
        patch
    }

    /// Around the patches of a node.
    pub(super) fn of_node(node: &Node) -> Self {
        let patches = || node.patches_in_use();
        // A larger patch has more of the wall's area and so more say.
        let normal = patches().map(|patch| patch.normal * (patch.radius * patch.radius)).reduce(|a, b| a + b);
        let zero = Vec3::new(0.0, 0.0, 0.0);
        let mut around = Self::between(
            patches().map(|patch| patch.centre - patch.half).reduce(lower).unwrap_or(zero),
            patches().map(|patch| patch.centre + patch.half).reduce(upper).unwrap_or(zero),
            normal.unwrap_or(zero),
        );
        for patch in patches() {
            let cosine = around.normal.dot(patch.normal).abs().min(1.0);
            // Not the root of 1 - cosine^2, which loses angles up to the root of the rounding. Without a normal a patch
            // reaches as far along any.
            let has_normals = around.normal.norm_squared() > 0.5 && patch.normal.norm_squared() > 0.5;
            let sine = if has_normals { around.normal.cross(patch.normal).norm() } else { 1.0 };
            // How far the smaller disc reaches along and across the larger one's normal.
            let along = cosine * patch.thickness + sine * patch.radius;
            let across = sine * patch.thickness + patch.radius;
            around.reach(patch.centre, along, across);
        }
        around
    }

    fn between(low: Vec3<f32>, high: Vec3<f32>, normal: Vec3<f32>) -> Self {
        let centre = low * 0.5 + high * 0.5;
        let rounding = Vec3::new(ROUNDING, ROUNDING, ROUNDING);
        let half = upper(high - centre, centre - low) + rounding;
        Self { centre, half, normal: normal.normalised(), thickness: 0.0, radius: 0.0 }
    }

    /// Widens the disc to hold what reaches `along` and `across` the normal from `point`.
    fn reach(&mut self, point: Vec3<f32>, along: f32, across: f32) {
        let relative = point - self.centre;
        let height = relative.dot(self.normal);
        let radial = (relative - self.normal * height).norm();
        self.thickness = self.thickness.max(height.abs() + along + ROUNDING);
        self.radius = self.radius.max(radial + across + ROUNDING);
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
fn fold_row<L: Pack<Element = f32>>(row: L, both: fn(f32, f32) -> f32) -> f32 {
    let mut lanes = [0.0; BLOCK];
    row.store(&mut lanes);
    lanes[1..L::LANES].iter().fold(lanes[0], |a, &b| both(a, b))
}

/// One point of all lanes.
#[inline(always)]
fn fold<L: Pack<Element = f32>>(rows: Vec3<L>, both: fn(f32, f32) -> f32) -> Vec3<f32> {
    Vec3::new(fold_row(rows.x, both), fold_row(rows.y, both), fold_row(rows.z, both))
}

#[cfg(test)]
mod tests {
    use super::super::tree::{Child, Node, Tree};
    use super::*;
    use fearless_simd::Level;
    use parry3d_f64::math::{Rotation, Vector};

    /// The corners of all triangles below a child, in the precision of the search.
    fn corners_below(tree: &Tree, child: u32, out: &mut Vec<[f64; 3]>) {
        match Child::unpack(child) {
            Child::Leaf(leaf) => {
                let rows = &tree.leaves[leaf as usize].rows;
                let at = |corner: usize, lane: usize| {
                    [0, 1, 2].map(|x| f64::from(rows[(3 * corner + x) * BLOCK + lane]))
                };
                out.extend((0..3 * BLOCK).map(|k| at(k / BLOCK, k % BLOCK)));
            }
            Child::Node(node) => {
                children(&tree.nodes[node as usize]).for_each(|(child, _)| corners_below(tree, child, out))
            }
        }
    }

    fn children(node: &Node) -> impl Iterator<Item = (u32, Patch)> + '_ {
        node.children.iter().copied().zip(node.patches_in_use())
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

    /// Angles between normals of which the cosine rounds to one are angles all the same.
    #[test]
    fn every_patch_holds_its_triangles() {
        let (mut checked, mut slight) = (0, 0);
        for round in 0..60 {
            let bend = 10.0_f64.powf(-f64::from(round % 12) * 0.5);
            let turn = Rotation::from_scaled_axis(Vector::new(0.3, 1.7, -0.6) * f64::from(round));
            let (vertices, triangles) = wall(bend, turn);
            let tree = Tree::new(Level::new(), &vertices, &triangles);
            for (child, patch) in tree.nodes.iter().flat_map(children) {
                let [centre, half, normal] =
                    [patch.centre, patch.half, patch.normal].map(|v| <[f32; 3]>::from(v).map(f64::from));
                let mut corners = Vec::new();
                corners_below(&tree, child, &mut corners);
                for corner in corners {
                    let offset = Vector::from(corner) - Vector::from(centre);
                    let along = offset.dot(Vector::from(normal));
                    let across = (offset - Vector::from(normal) * along).length();
                    assert!(
                        along.abs() <= f64::from(patch.thickness),
                        "bend {bend}: {along} beyond {}",
                        patch.thickness
                    );
                    assert!(
                        across <= f64::from(patch.radius),
                        "bend {bend}: {across} beyond {}",
                        patch.radius
                    );
                    assert!(offset.abs().cmple(Vector::from(half)).all());
                    checked += 1;
                }
                slight +=
                    usize::from(matches!(Child::unpack(child), Child::Node(_)) && patch.thickness < 1e-3);
            }
        }
        assert!(
            checked > 100_000 && slight > 100,
            "{checked} corners, {slight} nearly flat patches of patches"
        );
    }
}
