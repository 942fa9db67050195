//! What else is in the generated ventricle: a vein with a margin of its own, and an endoscope that
//! rests in the frontal horn.

use super::edges::{Resting, text};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::Cylinder;
use parry_continuum::proximity::{BvhSearch, Scene};
use parry_continuum::{Chain, RigidMotion, Tube};

/// The vein's ends and radius, mm: along the floor of the lateral ventricle towards the foramen.
const VEIN: [Vector; 2] = [Vector::new(11.0, -8.0, 15.0), Vector::new(10.5, 4.0, 14.5)];
const VEIN_RADIUS: Real = 0.7;

/// The ends and the radius, mm, of the part of the endoscope that is inside.
const ENDOSCOPE: [Vector; 2] = [Vector::new(12.8, 29.0, 6.5), Vector::new(11.7, 22.0, 11.0)];
const ENDOSCOPE_RADIUS: Real = 1.0;

/// A scene with the wall alone, which has the margin.
pub fn scene(wall: &BvhSearch, margin: Real) -> Result<Scene, String> {
    let mut scene = Scene::new();
    scene.add("wall", wall.clone(), Some(margin)).map_err(text)?;
    scene.set_robot_margin(Some(margin)).map_err(text)?;
    Ok(scene)
}

/// Adds the vein.
pub fn add_vein(scene: &mut Scene, margin: Real) -> Result<(), String> {
    let way = VEIN[1] - VEIN[0];
    let (vertices, triangles) = Cylinder::new(0.5 * way.length(), VEIN_RADIUS).to_trimesh(24);
    let vein = BvhSearch::from_triangles(&vertices, &triangles).map_err(text)?;
    let number = scene.add("vein", vein, Some(margin)).map_err(text)?;
    let turn = Rot3::from_rotation_arc(Vector::Y, way.normalize());
    scene.set_pose(number, &Pose::from_parts(VEIN[0].midpoint(VEIN[1]), turn)).map_err(text)
}

/// The endoscope.
pub fn endoscope() -> Result<Resting, String> {
    let tube = Tube::from(&Chain::capsules(&ENDOSCOPE, &[ENDOSCOPE_RADIUS]).map_err(text)?);
    let motion = RigidMotion::new(tube.clone(), [Pose::IDENTITY; 2]).map_err(text)?;
    Ok(Resting { tube, motion })
}
