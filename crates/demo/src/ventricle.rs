//! A brain ventricle like a human one, grown from swept tubes: the two lateral ventricles with
//! their frontal, occipital and temporal horns, the foramina of Monro, the third ventricle with its
//! recesses, the aqueduct and the fourth ventricle with its lateral recesses.
//!
//! Millimetres; x to the right, y to the front, z up; the origin is in the middle of the third
//! ventricle. Sizes follow an adult's, with passages somewhat wider than average, so that a robot
//! of 2.5 mm fits through a foramen.

use crate::ctr::Joints;
use crate::field::{Body, Tube, knot, round};
use crate::remesh::remesh;
use crate::surface::{Field, Mesh, extract, subdivide};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use std::collections::BTreeMap;
use std::sync::Mutex;

/// The default number of triangles of [`mesh`], and the fewest that give a good mesh.
pub const DEFAULT_TRIANGLES: usize = 6000;

/// The box that encloses the ventricle.
const LOW: Vector = Vector::new(-44.0, -66.0, -62.0);
const HIGH: Vector = Vector::new(44.0, 44.0, 32.0);

/// Grid spacing of the first surface: about half the bore of the aqueduct.
const SPACING: Real = 1.6;

/// Difference step and detail limit of the field.
const STEP: Real = 1e-4;

/// Coarser surfaces are remeshed to size; finer ones subdivide such a surface.
const REMESHED: usize = 24_000;

/// The ventricle's wall with about `target_triangles` triangles ([`DEFAULT_TRIANGLES`] to some
/// millions), closed and oriented outwards. Fewer would not do for its thin passages.
pub fn mesh(target_triangles: usize) -> Mesh {
    let body = Ventricle::grow();
    let field = |p: Vector| body.value(p);
    let (mut coarse, mut halvings) = (target_triangles, 0);
    while coarse > REMESHED {
        coarse = target_triangles >> (2 * (halvings + 1));
        halvings += 1;
    }
    let mut mesh = remeshed(&field, coarse);
    for _ in 0..halvings {
        mesh = subdivide(&field, mesh, STEP);
    }
    mesh
}

/// The surface remeshed to `triangles` triangles. A process grows each size only once.
fn remeshed(field: Field, triangles: usize) -> Mesh {
    static GROWN: Mutex<BTreeMap<usize, Mesh>> = Mutex::new(BTreeMap::new());
    let grown = || GROWN.lock().expect("no holder of the lock panics");
    // Other threads wait until the mesh is grown. Tasks of the pool never wait: the pool grows it.
    static GROWING: Mutex<()> = Mutex::new(());
    let is_task = rayon::current_thread_index().is_some();
    let _growing = (!is_task).then(|| GROWING.lock().expect("growing does not panic"));
    if let Some(mesh) = grown().get(&triangles) {
        return mesh.clone();
    }
    let mesh = remesh(field, extract(field, LOW, HIGH, SPACING), triangles, STEP);
    grown().entry(triangles).or_insert(mesh).clone()
}

/// The robot's pose at its entry: a burr hole over the right frontal horn, the base 3 mm inside the
/// roof.
pub fn entry() -> Pose {
    let into = Vector::new(-0.46, -0.085, -0.884).normalize();
    Pose::from_parts(Vector::new(10.8, 13.72, 17.0), Rot3::from_rotation_arc(Vector::Z, into))
}

/// Where [`super::ctr::three_tubes`] goes from [`entry`]: down through the right foramen of Monro
/// into the third ventricle, and back along it to the mouth of the aqueduct. A random search found
/// it; it keeps 1 mm from the wall. Angles are whole degrees, as the page's sliders have them.
pub fn goal() -> Joints {
    let angles = [-31.0, -101.0, 0.0].map(Real::to_radians).to_vec();
    Joints { extensions: vec![13.2, 18.1, 10.4], angles }
}

/// Two frames of a pulsating wall: its vertices as they are, and moved outwards by a hundredth.
pub fn beat(vertices: &[Vector]) -> [Vec<Vector>; 2] {
    let centre = vertices.iter().sum::<Vector>() / vertices.len() as Real;
    [1.0, 1.01]
        .map(|size| vertices.iter().map(|&vertex| centre + (vertex - centre) * size).collect())
}

/// The ventricle as a field.
pub struct Ventricle {
    /// One side and the middle; the other side is its mirror image.
    half: Body,
}

impl Ventricle {
    /// Grows the ventricle.
    pub fn grow() -> Self {
        let tubes = [lateral(), third(), fourth()].into_iter().flatten().collect();
        Self { half: Body { tubes, blend: 4.0 } }
    }

    /// Negative inside, zero on the wall, near the wall the distance to it.
    pub fn value(&self, p: Vector) -> Real {
        // No brain is its own mirror image: a gentle bend makes the two sides differ.
        let bend = Vector::new(
            0.8 * (p.y / 19.0 + 0.6).sin() + 0.4 * (p.z / 12.0).sin(),
            0.7 * (p.x / 15.0 + 0.4).sin(),
            0.7 * (p.x / 21.0 - 0.5).sin() + 0.4 * (p.y / 9.0).sin(),
        );
        let p = p + bend;
        self.half.value(Vector::new(p.x.abs(), p.y, p.z))
    }
}

/// The right lateral ventricle and its foramen. The first half-width of each section points
/// sideways.
fn lateral() -> Vec<Tube> {
    let c_shape = Tube::new(vec![
        knot([14.5, 36.0, 2.0], [1.0, 0.0, 0.3], [2.2, 3.5]),
        knot([13.0, 30.0, 6.0], [1.0, 0.0, 0.4], [4.6, 7.0]),
        knot([11.5, 21.0, 11.5], [1.0, 0.0, 0.4], [5.6, 7.6]),
        knot([10.5, 11.0, 15.5], [1.0, 0.0, 0.4], [6.0, 6.6]),
        knot([11.0, 0.0, 18.0], [1.0, 0.0, 0.3], [6.6, 5.0]),
        knot([13.5, -12.0, 18.0], [1.0, 0.0, 0.3], [7.0, 5.0]),
        knot([18.5, -24.0, 14.0], [1.0, 0.3, 0.4], [7.2, 6.4]),
        knot([25.0, -31.0, 4.0], [1.0, 0.6, 0.3], [6.6, 6.6]),
        knot([29.5, -29.0, -7.0], [1.0, 0.4, 0.3], [5.2, 4.6]),
        knot([31.5, -19.0, -15.0], [1.0, 0.0, 0.3], [5.2, 3.2]),
        knot([31.0, -7.0, -19.0], [1.0, 0.0, 0.2], [4.8, 2.8]),
        knot([28.5, 3.0, -20.0], [1.0, 0.2, 0.2], [2.6, 2.0]),
    ]);
    let occipital = Tube::new(vec![
        knot([24.5, -29.0, 7.0], [1.0, 0.0, 0.0], [5.5, 6.5]),
        knot([24.5, -40.0, 5.0], [1.0, 0.2, 0.0], [4.8, 6.0]),
        knot([21.0, -51.0, 2.5], [1.0, 0.4, 0.0], [3.2, 4.4]),
        knot([17.5, -58.0, 0.5], [1.0, 0.4, 0.0], [1.8, 2.4]),
    ]);
    let foramen = Tube::new(vec![
        round([9.5, 13.0, 12.5], 4.2),
        round([6.0, 10.5, 8.5], 3.0),
        round([3.0, 8.5, 5.5], 2.8),
        round([0.0, 7.0, 3.0], 2.8),
    ]);
    vec![c_shape, occipital, foramen]
}

/// The third ventricle, a thin upright slab, with its recesses; the aqueduct that drains it.
fn third() -> Vec<Tube> {
    let across = [1.0, 0.0, 0.0];
    let slab = Tube::new(vec![
        knot([0.0, 11.5, -3.0], across, [2.4, 6.0]),
        knot([0.0, 5.0, -1.0], across, [3.2, 8.2]),
        knot([0.0, -4.0, -0.5], across, [3.4, 7.6]),
        knot([0.0, -12.0, 0.0], across, [2.8, 5.2]),
    ]);
    let infundibular = Tube::new(vec![
        knot([0.0, 8.0, -6.0], across, [2.6, 3.6]),
        knot([0.0, 10.0, -10.5], across, [2.2, 2.6]),
        knot([0.0, 11.5, -14.5], across, [1.8, 1.8]),
    ]);
    let optic = Tube::new(vec![
        knot([0.0, 10.5, -4.0], across, [2.4, 4.0]),
        knot([0.0, 14.5, -7.5], across, [2.0, 2.6]),
        knot([0.0, 16.5, -9.5], across, [1.7, 1.7]),
    ]);
    let pineal = Tube::new(vec![
        knot([0.0, -11.0, 2.0], across, [2.4, 3.0]),
        knot([0.0, -15.5, 3.0], across, [2.2, 2.4]),
        knot([0.0, -19.0, 3.2], across, [1.8, 1.8]),
    ]);
    let aqueduct = Tube::new(vec![
        round([0.0, -11.0, -1.5], 2.6),
        round([0.0, -16.5, -6.5], 1.7),
        round([0.0, -21.5, -13.5], 1.5),
        round([0.0, -25.5, -21.0], 1.6),
        round([0.0, -28.0, -27.0], 2.2),
    ]);
    vec![slab, infundibular, optic, pineal, aqueduct]
}

/// The fourth ventricle: a tent over a flat diamond, with its lateral recesses.
fn fourth() -> Vec<Tube> {
    let across = [1.0, 0.0, 0.0];
    let diamond = Tube::new(vec![
        knot([0.0, -27.0, -24.5], across, [1.8, 1.8]),
        knot([0.0, -29.5, -31.0], across, [5.4, 2.9]),
        knot([0.0, -31.5, -38.0], across, [8.6, 3.6]),
        knot([0.0, -32.5, -45.0], across, [5.2, 2.8]),
        knot([0.0, -33.0, -51.0], across, [2.8, 2.3]),
        knot([0.0, -33.5, -56.0], across, [1.9, 1.9]),
    ]);
    let tent = Tube::new(vec![
        knot([0.0, -32.0, -37.0], across, [4.6, 5.0]),
        knot([0.0, -37.5, -37.0], across, [3.0, 3.4]),
        knot([0.0, -41.5, -37.0], across, [2.0, 2.2]),
    ]);
    let recess = Tube::new(vec![
        round([6.0, -31.5, -38.5], 2.8),
        round([12.0, -30.0, -39.5], 2.0),
        round([16.0, -26.5, -40.5], 1.8),
    ]);
    vec![diamond, tent, recess]
}
