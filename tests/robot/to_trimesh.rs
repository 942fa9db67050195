//! A link's outline is a closed mesh on its surface, outward, with the requested fineness.

use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::{Cap, ModifiedCylinder};
use std::collections::HashMap;
use std::f64::consts::PI;

const CAPS: [[Cap; 2]; 4] = [
    [Cap::Flat, Cap::Flat],
    [Cap::Flat, Cap::Round],
    [Cap::Round, Cap::Flat],
    [Cap::Round, Cap::Round],
];

/// Oblique links of all caps, long and short, and a ball.
fn links() -> Vec<ModifiedCylinder> {
    let start = Vector::new(0.3, -1.0, 2.0);
    let mut links = vec![ModifiedCylinder::capsule(start, start, 0.7).unwrap()];
    for caps in CAPS {
        for length in [3.0, 0.2] {
            for direction in [Vector::new(0.6, 0.0, -0.8), Vector::Z, -Vector::Z] {
                links.push(
                    ModifiedCylinder::new(start, start + direction * length, 0.7, caps).unwrap(),
                );
            }
        }
    }
    links
}

/// The signed volume: positive if triangles are counter-clockwise seen from outside.
fn volume(vertices: &[Vector], triangles: &[[u32; 3]]) -> Real {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| vertices[i as usize] - vertices[0]);
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(of).sum()
}

/// Cylinder and half balls, from the school book.
fn true_volume(link: &ModifiedCylinder) -> Real {
    let round_ends = link.caps().iter().filter(|&&cap| cap == Cap::Round).count() as Real;
    let r = link.radius();
    PI * r * r * link.length() + round_ends * (2.0 / 3.0) * PI * r * r * r
}

#[test]
fn no_triangle_is_degenerate() {
    for link in links() {
        let (vertices, triangles) = link.to_trimesh(12);
        for t in triangles {
            let [a, b, c] = t.map(|i| vertices[i as usize]);
            assert!(
                (b - a).cross(c - a).length() > 1e-3 * link.radius().powi(2),
                "{t:?} of {link:?}"
            );
        }
    }
}

#[test]
fn every_edge_is_shared_by_two_triangles_that_agree_on_the_outside() {
    for link in links() {
        for nsubdiv in [0, 3, 4, 5, 17, 32] {
            let (vertices, triangles) = link.to_trimesh(nsubdiv);
            let mut edges = HashMap::new();
            for t in &triangles {
                for edge in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    assert!((edge.0.max(edge.1) as usize) < vertices.len());
                    *edges.entry(edge).or_insert(0) += 1;
                }
            }
            for (&(a, b), &count) in &edges {
                assert_eq!(
                    (count, edges.get(&(b, a))),
                    (1, Some(&1)),
                    "edge {a} {b} of {link:?}, {nsubdiv}"
                );
            }
            // Closed and in one piece without handles.
            let euler = vertices.len() as i64 - edges.len() as i64 / 2 + triangles.len() as i64;
            assert_eq!(euler, 2);
        }
    }
}

#[test]
fn the_volume_converges_from_within() {
    for link in links() {
        let missing = |nsubdiv| {
            let (vertices, triangles) = link.to_trimesh(nsubdiv);
            1.0 - volume(&vertices, &triangles) / true_volume(&link)
        };
        let [coarse, fine, finest] = [16, 32, 64].map(missing);
        assert!(finest > 0.0 && finest < 0.01, "{finest} of {link:?}");
        // Second order: half the step, a quarter of the error.
        assert!((3.8..4.2).contains(&(coarse / fine)) && (3.9..4.1).contains(&(fine / finest)));
    }
}

#[test]
fn vertices_lie_on_the_surface() {
    for link in links() {
        let (vertices, _) = link.to_trimesh(24);
        let (axis, r) = (link.axis(), link.radius());
        let mut on_axis = 0;
        for v in vertices {
            let z = (v - link.start()).dot(axis);
            let rho = (v - link.start() - axis * z).length();
            let beyond = if z < link.length() / 2.0 { -z } else { z - link.length() };
            let cap = link.caps()[usize::from(z >= link.length() / 2.0)];
            let off = if link.length() == 0.0 {
                (v - link.start()).length() - r
            } else if rho < 1e-12 {
                on_axis += 1;
                beyond - if cap == Cap::Round { r } else { 0.0 }
            } else if cap == Cap::Round {
                rho.hypot(beyond.max(0.0)) - r
            } else {
                (rho - r).abs().max(beyond.abs())
            };
            assert!(off.abs() < 1e-14, "{v} is {off} off {link:?}");
        }
        assert!(link.length() == 0.0 || on_axis == 2);
    }
}

#[test]
fn parry_takes_it_as_a_mesh() {
    for link in links() {
        let (vertices, triangles) = link.to_trimesh(32);
        let mesh = TriMesh::new(vertices, triangles).unwrap();
        let (held, aabb) = (mesh.local_aabb(), link.local_aabb());
        let difference = (held.mins - aabb.mins).max(aabb.maxs - held.maxs);
        assert!((-1e-14..0.01).contains(&difference.max_element()), "{difference}");
    }
}

#[test]
fn a_wire_has_no_surface() {
    let wire = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X, 0.0).unwrap();
    assert_eq!(wire.to_trimesh(16), (vec![Vector::ZERO, Vector::X], vec![]));
}

#[test]
fn at_the_ends_of_the_range() {
    for exponent in [-300, 300, 480] {
        let scale = Real::powi(2.0, exponent);
        for link in links() {
            let scaled = ModifiedCylinder::new(
                link.start() * scale,
                link.end() * scale,
                link.radius() * scale,
                link.caps(),
            );
            let (vertices, triangles) = scaled.unwrap().to_trimesh(8);
            let (plain, same) = link.to_trimesh(8);
            assert_eq!(triangles, same);
            assert_eq!(vertices, plain.iter().map(|&v| v * scale).collect::<Vec<_>>());
        }
    }
}
