//! The clearance of many shapes: the true one, and that of every model at every tolerance.

use crate::shapes::Stations;
use crate::subject::{Model, Subject};
use crate::ways::{Clearance, Peer, least, text};
use continuum_demo::ctr::{Joints, Robot};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Capsule, Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};
use rayon::prelude::*;

/// The tolerances of `simplify` that are compared, mm.
pub const TOLERANCES: [Real; 7] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0];

/// The tolerance at which parry is also measured in metres.
pub const METRES_AT: usize = 4;

/// Spacing of the curve that is simplified, mm. Its chords stay within 0.1^2 x 0.052 / 8 = 7e-5 mm
/// of the arcs.
pub const INPUT_SPACING: Real = 0.1;

/// Largest spacing of the reference's stations, mm.
pub const REFERENCE_SPACING: Real = 0.05;

/// The truth and the answers of one shape.
pub struct Outcome {
    /// The clearance of the true shape.
    pub truth: Real,
    /// Whether the base's face, not what is further out, is nearest to the wall.
    pub at_base: bool,
    /// Whether it is the base's round cap that is nearest in the model of capsules.
    pub cap_at_base: bool,
    pub each: [AtTolerance; TOLERANCES.len()],
    /// parry's clearances of capsules and cylinders with all lengths in metres, as millimetres.
    pub metres: [Real; 2],
}

/// The answers of one shape at one tolerance.
#[derive(Clone, Copy, Default)]
pub struct AtTolerance {
    /// In the order of [`Model::ALL`].
    pub clearances: [Real; Model::ALL.len()],
    /// By how much the rim of a flat face is out of place at most, because the face follows the
    /// last link.
    pub tilt: Real,
}

/// The chain of the true shape: flat links so short that it is the swept tube.
pub fn reference(robot: &Robot, joints: &Joints, spacing: Real) -> Result<Chain, String> {
    let curve = Stations::graded(robot, joints, spacing).curve(robot, joints);
    Chain::cylinders(&curve.points, &curve.radii).map_err(text)
}

/// The outcomes of the shapes, in their order, on all cores.
pub fn outcomes(
    robot: &Robot,
    shapes: &[Joints],
    mesh: &TriMesh,
    base: &Pose,
) -> Result<Vec<Outcome>, String> {
    let vertices = mesh.vertices().iter().map(|&vertex| vertex * 1e-3).collect();
    let metres = TriMesh::new(vertices, mesh.indices().to_vec()).map_err(text)?;
    let of_some = |shapes: &[Joints]| -> Result<Vec<Outcome>, String> {
        let mut search = BvhSearch::new(mesh).map_err(text)?;
        shapes
            .iter()
            .map(|joints| outcome(robot, joints, mesh, &metres, base, &mut search))
            .collect()
    };
    let some: Result<Vec<_>, _> = shapes.par_chunks(64).map(of_some).collect();
    Ok(some?.into_iter().flatten().collect())
}

fn outcome(
    robot: &Robot,
    joints: &Joints,
    mesh: &TriMesh,
    metres: &TriMesh,
    base: &Pose,
    search: &mut BvhSearch,
) -> Result<Outcome, String> {
    let chain = reference(robot, joints, REFERENCE_SPACING)?;
    let nearest = search.minimum(&chain, base).map_err(text)?;
    let stations = Stations::even(robot, joints, INPUT_SPACING);
    let (curve, tangents) = (stations.curve(robot, joints), stations.tangents(robot, joints));
    let faces = faces(robot, joints);
    let mut outcome = Outcome {
        truth: nearest.distance,
        at_base: base.inverse_transform_point(nearest.witness.on_robot).z < 1e-3,
        cap_at_base: false,
        each: Default::default(),
        metres: [0.0; 2],
    };
    for (index, (each, tolerance)) in outcome.each.iter_mut().zip(TOLERANCES).enumerate() {
        let subject = Subject::new(&curve, tangents, tolerance).map_err(text)?;
        each.tilt = tilt(&subject, &faces);
        for (clearance, model) in each.clearances.iter_mut().zip(Model::ALL) {
            *clearance = if Model::OURS.contains(&model) {
                let found = search.minimum(subject.chain(model), base).map_err(text)?;
                if model == Model::Capsule {
                    outcome.cap_at_base =
                        base.inverse_transform_point(found.witness.on_robot).z < 0.0;
                }
                found.distance
            } else if model == Model::Tube {
                subject.least_of_tube(search, base)?
            } else {
                Peer { mesh, model }.clearance(&subject, base)?
            };
        }
        if index == METRES_AT {
            outcome.metres = in_metres(&subject, metres, base)?.map(|clearance| clearance * 1e3);
        }
    }
    Ok(outcome)
}

/// parry's clearances of capsules and cylinders, all lengths in metres.
fn in_metres(subject: &Subject, mesh: &TriMesh, base: &Pose) -> Result<[Real; 2], String> {
    let smaller = |pose: &Pose| Pose::from_parts(pose.translation * 1e-3, pose.rotation);
    let capsule =
        |c: &Capsule| Capsule::new(c.segment.a * 1e-3, c.segment.b * 1e-3, c.radius * 1e-3);
    let cylinder = |c: &Cylinder| Cylinder::new(c.half_height * 1e-3, c.radius * 1e-3);
    let capsules: Vec<_> =
        subject.capsules.iter().map(|(at, link)| (smaller(at), capsule(link))).collect();
    let cylinders: Vec<_> =
        subject.cylinders.iter().map(|(at, link)| (smaller(at), cylinder(link))).collect();
    Ok([least(mesh, &capsules, &smaller(base))?, least(mesh, &cylinders, &smaller(base))?])
}

/// A flat face of the true shape: where, facing which way, and how wide.
struct Face {
    place: Vector,
    direction: Vector,
    radius: Real,
}

fn faces(robot: &Robot, joints: &Joints) -> Vec<Face> {
    let mut end = 0.0;
    let mut ends = vec![0.0];
    ends.extend(joints.extensions.iter().map(|extension| {
        end += extension;
        end
    }));
    let radii = robot.sections.iter().map(|section| section.radius);
    let base = robot.sections[0].radius;
    let frames = robot.frames(joints, &ends);
    let face = |(frame, radius): (&Pose, Real)| Face {
        place: frame.translation,
        direction: frame.rotation * Vector::Z,
        radius,
    };
    frames.iter().zip([base].into_iter().chain(radii)).map(face).collect()
}

/// By how much the rim of a face is out of place, at most.
fn tilt(subject: &Subject, faces: &[Face]) -> Real {
    let links = subject.chain(Model::Modified).links();
    let at = |face: &Face| {
        let ends = |link: &&parry_continuum::ModifiedCylinder| {
            link.radius() == face.radius
                && (link.end().distance(face.place) < 1e-9
                    || link.start().distance(face.place) < 1e-9)
        };
        links
            .iter()
            .find(ends)
            .map_or(0.0, |link| face.radius * link.axis().cross(face.direction).length())
    };
    faces.iter().map(at).fold(0.0, Real::max)
}
