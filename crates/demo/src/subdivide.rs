//! Finer meshes of the same surface: every triangle in four, and triangles in any order.

use crate::surface::Mesh;
use std::collections::HashMap;

/// Every triangle in four, at the middles of its edges.
pub fn in_four((mut vertices, indices): Mesh) -> Mesh {
    let mut middles = HashMap::new();
    let mut finer = Vec::with_capacity(indices.len() * 4);
    for [a, b, c] in indices {
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                vertices.push(vertices[i as usize].midpoint(vertices[j as usize]));
                vertices.len() as u32 - 1
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    (vertices, finer)
}

/// The same triangles in an order drawn by `seed`.
pub fn shuffled((vertices, mut indices): Mesh, seed: u64) -> Mesh {
    let mut state = seed;
    for last in (1..indices.len()).rev() {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        indices.swap(last, ((state >> 33) as usize) % (last + 1));
    }
    (vertices, indices)
}
