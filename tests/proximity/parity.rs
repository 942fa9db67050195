//! How often a mesh winds around a point, exactly: the triangles that a ray crosses, in whole
//! numbers.

use parry_continuum::parry::math::Vector;
use parry_continuum::parry::shape::TriMesh;

/// Coordinates are multiples of this, and at most 2.
const GRID: f64 = 1.0 / (1_u64 << 38) as f64;

/// The nearest point of the grid.
pub fn on_grid(point: Vector) -> Vector {
    (point / GRID).round() * GRID
}

fn whole(point: Vector) -> [i128; 3] {
    (point / GRID).to_array().map(|coordinate| coordinate as i128)
}

/// The triangles of a mesh on the grid.
pub struct Parity(Vec<[Vector; 3]>);

impl Parity {
    pub fn new(mesh: &TriMesh) -> Self {
        assert!(
            mesh.vertices()
                .iter()
                .all(|&vertex| vertex == on_grid(vertex) && vertex.max_element() <= 2.0)
        );
        Self(mesh.triangles().map(|triangle| [triangle.a, triangle.b, triangle.c]).collect())
    }

    /// The winding number around a point of the grid; none on the mesh, or if rays along all axes
    /// meet edges.
    pub fn winding(&self, point: Vector) -> Option<i32> {
        (0..3).find_map(|axis| self.crossed(point, axis))
    }

    /// By the ray along an axis.
    fn crossed(&self, point: Vector, axis: usize) -> Option<i32> {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut sum = 0;
        for corners in &self.0 {
            let [a, b, c] = corners;
            let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
            let beside = |axis: usize| point[axis] < low[axis] || point[axis] > high[axis];
            if point[axis] > high[axis] || beside(next) || beside(last) {
                continue;
            }
            let at = whole(point);
            let [a, b, c] = corners.map(|corner| {
                let corner = whole(corner);
                [axis, next, last].map(|axis| corner[axis] - at[axis])
            });
            let turn = |p: [i128; 3], q: [i128; 3]| p[1] * q[2] - p[2] * q[1];
            let turns = [turn(b, c), turn(c, a), turn(a, b)];
            let (some_left, some_right) =
                (turns.iter().any(|&t| t > 0), turns.iter().any(|&t| t < 0));
            if some_left && some_right {
                continue;
            }
            if turns.contains(&0) {
                return None;
            }
            let ahead = turns[0] * a[0] + turns[1] * b[0] + turns[2] * c[0];
            if ahead == 0 {
                return None;
            }
            if (ahead > 0) == some_left {
                sum += if some_left { 1 } else { -1 };
            }
        }
        Some(sum)
    }
}
