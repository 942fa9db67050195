//! What a hierarchy's node knows of a patch of the mesh: a box and a disc around the same centre.

use super::packed::BLOCK;
use super::tree::{Leaf, Node};
use crate::distance::Vec3;

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
    /// Around the triangles of a leaf.
    pub(super) fn of_leaf(leaf: &Leaf) -> Self {
        let corners = || (0..BLOCK).flat_map(|lane| (0..3).map(move |corner| leaf.corner(lane, corner)));
        let area = |lane| {
            let [a, b, c] = [0, 1, 2].map(|corner| leaf.corner(lane, corner));
            (b - a).cross(c - a)
        };
        let normal = (0..BLOCK).map(area).reduce(|sum, area| sum + area);
        let mut patch = Self::between(
            corners().reduce(|a, b| each(a, b, f32::min)),
            corners().reduce(|a, b| each(a, b, f32::max)),
            normal,
        );
        for corner in corners() {
            patch.reach(corner, 0.0, 0.0);
        }
        patch
    }

    /// Around the patches of a node.
    pub(super) fn of_node(node: &Node) -> Self {
        let patches = || node.patches_in_use();
        // A larger patch has more of the wall's area and so more say.
        let normal = patches().map(|patch| patch.normal * (patch.radius * patch.radius)).reduce(|a, b| a + b);
        let mut around = Self::between(
            patches().map(|patch| patch.centre - patch.half).reduce(|a, b| each(a, b, f32::min)),
            patches().map(|patch| patch.centre + patch.half).reduce(|a, b| each(a, b, f32::max)),
            normal,
        );
        for patch in patches() {
            let cosine = around.normal.dot(patch.normal).abs().min(1.0);
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            // How far the smaller disc reaches along and across the larger one's normal.
            let along = cosine * patch.thickness + sine * patch.radius;
            let across = sine * patch.thickness + patch.radius;
            around.reach(patch.centre, along, across);
        }
        around
    }

    fn between(low: Option<Vec3<f32>>, high: Option<Vec3<f32>>, normal: Option<Vec3<f32>>) -> Self {
        let zero = Vec3::new(0.0, 0.0, 0.0);
        let (low, high) = (low.unwrap_or(zero), high.unwrap_or(zero));
        let centre = low * 0.5 + high * 0.5;
        let rounding = Vec3::new(ROUNDING, ROUNDING, ROUNDING);
        let half = each(high - centre, centre - low, f32::max) + rounding;
        Self { centre, half, normal: normal.unwrap_or(zero).normalised(), thickness: 0.0, radius: 0.0 }
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

/// A function of each coordinate.
fn each(a: Vec3<f32>, b: Vec3<f32>, f: impl Fn(f32, f32) -> f32) -> Vec3<f32> {
    Vec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z))
}
