//! From a field to triangles: marching tetrahedra, and subdivision.
//!
//! Each cube of a grid is cut into six tetrahedra that share one diagonal (Kuhn's cut, the same in
//! every cube, so that neighbours match). On a tetrahedron the field is taken as linear; its zero
//! set is a triangle or a quadrilateral. No configuration is ambiguous, therefore the surface is
//! always closed and manifold. Its triangles are ugly; `remesh` makes them beautiful.

use parry_continuum::parry::math::{Real, Vector};
use rayon::prelude::*;
use std::collections::HashMap;

/// Vertices and triangles (counter-clockwise seen from outside).
pub type Mesh = (Vec<Vector>, Vec<[u32; 3]>);

/// A field, negative inside.
pub type Field<'a> = &'a (dyn Fn(Vector) -> Real + Sync);

/// The tetrahedra of a cube, by corner (bit 0: x, bit 1: y, bit 2: z). The second half has the
/// opposite orientation.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 4, 6, 7]];

/// Even permutations of a tetrahedron's corners that put corner i first, and even permutations that
/// put a given pair first.
const ONE_FIRST: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]];
const PAIR_FIRST: [[usize; 4]; 6] =
    [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 2, 0], [2, 3, 0, 1]];

/// The zero set of `field` within the box, which must enclose it, at the given grid spacing.
pub fn extract(field: Field, low: Vector, high: Vector, spacing: Real) -> Mesh {
    let count = ((high - low) / spacing).ceil().to_array().map(|n| n as usize + 1);
    let node = |x: usize, y: usize, z: usize| (z * count[1] + y) * count[0] + x;
    let place = |n: usize| {
        let (x, y, z) = (n % count[0], n / count[0] % count[1], n / (count[0] * count[1]));
        low + Vector::new(x as Real, y as Real, z as Real) * spacing
    };
    let nodes = count[0] * count[1] * count[2];
    let values: Vec<Real> = (0..nodes).into_par_iter().map(|n| field(place(n))).collect();

    let mut points = Vec::new();
    let mut triangles = Vec::new();
    let mut on_edge = HashMap::new();
    let mut cut = |a: usize, b: usize| {
        let (a, b) = (a.min(b), a.max(b));
        *on_edge.entry((a, b)).or_insert_with(|| {
            let t = values[a] / (values[a] - values[b]);
            points.push(place(a).lerp(place(b), t));
            points.len() as u32 - 1
        })
    };
    for z in 0..count[2] - 1 {
        for y in 0..count[1] - 1 {
            for x in 0..count[0] - 1 {
                let corner: [usize; 8] =
                    std::array::from_fn(|i| node(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)));
                let inside = corner.map(|n| values[n] < 0.0);
                if inside == [inside[0]; 8] {
                    continue;
                }
                for (index, tetrahedron) in TETRAHEDRA.iter().enumerate() {
                    let corners = tetrahedron.map(|i| corner[i]);
                    let inside = tetrahedron.map(|i| inside[i]);
                    for face in faces(inside) {
                        let mut face = face.map(|[a, b]| cut(corners[a], corners[b]));
                        if index >= 3 {
                            face.swap(1, 2);
                        }
                        triangles.push(face);
                    }
                }
            }
        }
    }
    (points, triangles)
}

/// The triangles that separate a tetrahedron's inner from its outer corners, each vertex as the
/// edge it lies on.
fn faces(inside: [bool; 4]) -> Vec<[[usize; 2]; 3]> {
    let lone = |i: usize| {
        let [a, b, c, d] = ONE_FIRST[i];
        [[a, b], [a, c], [a, d]]
    };
    match inside.iter().filter(|&&is| is).count() {
        1 => (0..4).filter(|&i| inside[i]).map(lone).collect(),
        3 => {
            let mirror = |[a, b, c]: [[usize; 2]; 3]| [a, c, b];
            (0..4).filter(|&i| !inside[i]).map(|i| mirror(lone(i))).collect()
        }
        2 => PAIR_FIRST
            .iter()
            .filter(|pair| inside[pair[0]] && inside[pair[1]])
            .flat_map(|&[i, j, k, l]| [[[i, k], [i, l], [j, l]], [[i, k], [j, l], [j, k]]])
            .collect(),
        _ => Vec::new(),
    }
}

/// The field's gradient where its value is `value`, by differences over `step`.
pub fn slope(field: Field, p: Vector, value: Real, step: Real) -> Vector {
    let ahead = [Vector::X, Vector::Y, Vector::Z].map(|e| field(p + e * step));
    (Vector::from(ahead) - Vector::splat(value)) / step
}

/// The point moved onto the zero set, to within `step`, by a few Newton steps along the gradient.
pub fn project(field: Field, mut p: Vector, step: Real) -> Vector {
    for _ in 0..4 {
        let value = field(p);
        if value.abs() < step {
            break;
        }
        let gradient = slope(field, p, value, step);
        if gradient == Vector::ZERO {
            break;
        }
        p -= gradient * (value / gradient.length_squared());
    }
    p
}

/// Each triangle cut into four at its edges' midpoints, the new vertices moved onto the zero set.
pub fn subdivide(field: Field, (mut points, triangles): Mesh, step: Real) -> Mesh {
    let mut middle = HashMap::new();
    let mut edges = Vec::new();
    let old = points.len() as u32;
    let mut on_edge = |a: u32, b: u32| {
        *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
            edges.push([a, b]);
            old + edges.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for [a, b, c] in triangles {
        let (ab, bc, ca) = (on_edge(a, b), on_edge(b, c), on_edge(c, a));
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    let halfway = |[a, b]: &[u32; 2]| points[*a as usize].midpoint(points[*b as usize]);
    let new: Vec<_> = edges.par_iter().map(|edge| project(field, halfway(edge), step)).collect();
    points.extend(new);
    (points, finer)
}
