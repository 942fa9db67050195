//! Groups of triangles, formed by a rule that the checker of a proof repeats.
//!
//! The first group contains all triangles. A group is halved in the order of its triangles' least
//! coordinates, along the axis on which these coordinates spread most.

use crate::mesh::Mesh;
use parry3d_f64::math::{Real, Vector};

/// The groups of a mesh that the search has used.
pub(crate) struct Groups<'a> {
    pub(super) mesh: &'a Mesh,
    /// The least coordinates of each triangle.
    low: Vec<[Real; 3]>,
    groups: Vec<Group>,
}

/// A set of triangles.
pub(super) struct Group {
    pub triangles: Vec<u32>,
    /// Their vertices without duplicates.
    pub vertices: Vec<Vector>,
    /// The corners of their bounding box.
    pub bounds: [Vector; 2],
    halves: Option<[usize; 2]>,
}

/// The group of all triangles.
pub(super) const ALL: usize = 0;

impl<'a> Groups<'a> {
    pub(crate) fn new(mesh: &'a Mesh) -> Self {
        let low = |triangle: u32| {
            let [a, b, c] = mesh.corners(triangle);
            // Maps -0 to 0.
            (a.min(b).min(c) + Vector::ZERO).to_array()
        };
        let all = 0..mesh.len() as u32;
        let mut groups = Self { mesh, low: all.clone().map(low).collect(), groups: Vec::new() };
        groups.add(all.collect());
        groups
    }

    pub(super) fn get(&self, group: usize) -> &Group {
        &self.groups[group]
    }

    fn add(&mut self, triangles: Vec<u32>) -> usize {
        let indices = self.mesh.indices();
        let mut vertices: Vec<u32> =
            triangles.iter().flat_map(|&triangle| indices[triangle as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let vertices: Vec<_> =
            vertices.iter().map(|&vertex| self.mesh.vertices()[vertex as usize]).collect();
        let nothing = [Vector::INFINITY, Vector::NEG_INFINITY];
        let bounds = vertices.iter().fold(nothing, |[low, high], &v| [low.min(v), high.max(v)]);
        self.groups.push(Group { triangles, vertices, bounds, halves: None });
        self.groups.len() - 1
    }

    /// Returns the two halves of a group of more than one triangle.
    pub(super) fn halves(&mut self, group: usize) -> [usize; 2] {
        if let Some(halves) = self.groups[group].halves {
            return halves;
        }
        let mut triangles = self.groups[group].triangles.clone();
        let spread = |axis: usize| {
            let all = triangles.iter().map(|&triangle| self.low[triangle as usize][axis]);
            let (least, most) =
                all.fold((Real::INFINITY, Real::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
            most - least
        };
        let spreads = [spread(0), spread(1), spread(2)];
        // Ties take the first axis.
        let axis =
            (1..3).fold(0, |axis, other| if spreads[other] > spreads[axis] { other } else { axis });
        let key = |triangle: &u32| self.low[*triangle as usize][axis];
        triangles.sort_unstable_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let second = triangles.split_off(triangles.len() / 2);
        let halves = [self.add(triangles), self.add(second)];
        self.groups[group].halves = Some(halves);
        halves
    }
}

impl Group {
    /// Returns the largest magnitude of a coordinate.
    pub(super) fn reach(&self) -> Real {
        self.bounds[0].abs().max(self.bounds[1].abs()).max_element()
    }

    /// Returns the least q . v over the vertices.
    pub(super) fn level(&self, q: Vector) -> Real {
        self.vertices.iter().fold(Real::INFINITY, |level, vertex| level.min(q.dot(*vertex)))
    }
}
