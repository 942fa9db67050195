//! The solid angle of a mesh from a point, by its hierarchy: far nodes as a whole, near triangles
//! one by one.

use super::SolidAngle;
use super::solid_angle::{FarField, solid_angle};
use crate::answer::Side;
use crate::distance::Scalar;
use crate::distance::lanes::Lane;
use crate::mesh::Mesh;
use crate::search::hierarchy::{Child, WideBvh};
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::PI;

/// The error allowed for each node, in steradians, in the first attempts.
const ATTEMPTS: [Real; 3] = [0.1, 0.02, 0.004];

/// The largest error of a node in the last attempt.
const FINEST: Real = 0.0005;

/// The error allowed for all nodes together in the last attempt: a quarter of what would leave the
/// side undecided. So only triangles near the point do.
const LAST_ATTEMPT: Real = 0.25 * PI;

/// The far fields of all nodes and leaves of a hierarchy.
#[derive(Clone)]
pub(crate) struct FarFields {
    /// Brings the mesh to size one.
    scale: Real,
    nodes: Vec<FarField>,
    leaves: Vec<FarField>,
}

impl FarFields {
    /// One thread builds them, because others may wait for it ([`Lazy`](crate::threads::Lazy)).
    pub(crate) fn new<E: Lane>(tree: &WideBvh<E>, mesh: &Mesh) -> Self {
        let [low, high] = mesh.bounds();
        let scale = (high - low).max_element().power_of_two_to_unity();
        let of = |child: Child| {
            FarField::new(scale, tree.triangles_below(child).map(|triangle| mesh.corners(triangle)))
        };
        Self {
            scale,
            nodes: (0..tree.nodes.len() as u32).map(|node| of(Child::Node(node))).collect(),
            leaves: (0..tree.leaves.len() as u32).map(|leaf| of(Child::Leaf(leaf))).collect(),
        }
    }

    fn of(&self, child: Child) -> &FarField {
        match child {
            Child::Node(node) => &self.nodes[node as usize],
            Child::Leaf(leaf) => &self.leaves[leaf as usize],
        }
    }
}

/// A query for the side of a point.
pub(crate) struct Winding<'a, E> {
    pub mesh: &'a Mesh,
    pub tree: &'a WideBvh<E>,
    pub fields: &'a FarFields,
    pub point: Vector,
}

impl<E: Lane> Winding<'_, E> {
    /// Returns the side on which the point lies.
    pub(crate) fn side(&self) -> Side {
        if !self.point.is_finite() {
            return Side::Undecided;
        }
        let attempt = |error| {
            let mut sum = SolidAngle::default();
            self.add(Child::Node(0), error, &mut sum);
            sum.side()
        };
        let nodes = self.fields.nodes.len() + self.fields.leaves.len();
        let last = (LAST_ATTEMPT / nodes as Real).min(FINEST);
        ATTEMPTS.into_iter().chain([last]).find_map(attempt).unwrap_or(Side::Undecided)
    }

    /// Adds the solid angle of the triangles below `child`. Each node may err by `error`.
    fn add(&self, child: Child, error: Real, sum: &mut SolidAngle) {
        let from_afar = self.fields.of(child).solid_angle(self.fields.scale, self.point);
        if from_afar.error() <= error {
            *sum += from_afar;
            return;
        }
        match child {
            Child::Node(node) => {
                self.tree.nodes[node as usize]
                    .children()
                    .for_each(|child| self.add(child, error, sum));
            }
            Child::Leaf(_) => self.tree.triangles_below(child).for_each(|triangle| {
                *sum += solid_angle(self.mesh.corners(triangle), self.point);
            }),
        }
    }
}
