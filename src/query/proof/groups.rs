//! Groups of triangles, made by a rule that whoever checks a proof follows too: all of them are the
//! first group, and one is halved in the order of the triangles' least coordinates along the axis
//! along which these are spread most.

use crate::mesh::Mesh;
use parry3d_f64::math::{Real, Vector};

/// The groups of a mesh that were asked for.
pub(crate) struct Groups<'a> {
    pub(super) mesh: &'a Mesh,
    /// The least coordinates of each triangle's corners.
    low: Vec<[Real; 3]>,
    groups: Vec<Group>,
}

/// Some triangles.
pub(super) struct Group {
    pub triangles: Vec<u32>,
    /// Their corners, each once.
    pub vertices: Vec<Vector>,
    /// The corners of the box around them.
    pub bounds: [Vector; 2],
    halves: Option<[usize; 2]>,
}

/// The group of all triangles.
pub(super) const ALL: usize = 0;

impl<'a> Groups<'a> {
    pub(crate) fn new(mesh: &'a Mesh) -> Self {
        let low = |triangle: u32| {
            let [a, b, c] = mesh.corners(triangle);
            // 0 and -0 are one number.
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

    /// The two halves of a group of several triangles.
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
        // The first of equals.
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
    /// The largest coordinate.
    pub(super) fn reach(&self) -> Real {
        self.bounds[0].abs().max(self.bounds[1].abs()).max_element()
    }

    /// The least q . v of its corners.
    pub(super) fn level(&self, q: Vector) -> Real {
        self.vertices.iter().fold(Real::INFINITY, |level, vertex| level.min(q.dot(*vertex)))
    }
}
