//! The options of the example programs: the anatomy, and the robot's pose in it.

use crate::command::whole;
use crate::{steer, ventricle};
use clap::Args;
use mesh_files::Options;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use std::path::PathBuf;

#[derive(Args)]
pub struct Anatomy {
    /// Real anatomy: an STL, OBJ or PLY file in millimetres, or a NIfTI or NRRD label map
    /// [default: a generated ventricle]
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,

    /// Multiply the file's coordinates by this, for example by 1000 from metres to millimetres
    #[arg(
        long,
        value_name = "FACTOR",
        default_value_t = 1.0,
        requires = "mesh",
        value_parser = factor,
        allow_negative_numbers = true
    )]
    scale: Real,

    /// The label of the wall in a label map [default: all that are not 0]
    #[arg(long, value_name = "NUMBER", requires = "mesh", value_parser = whole(0..=u32::MAX))]
    label: Option<u32>,

    /// About how many triangles the generated ventricle has
    #[arg(long, value_name = "COUNT", default_value_t = ventricle::DEFAULT_TRIANGLES as u32, conflicts_with = "mesh",
          value_parser = whole(ventricle::DEFAULT_TRIANGLES as u32..=20_000_000))]
    triangles: u32,

    /// Where the robot's base is, in the mesh's frame [default: the burr hole, or the deepest
    /// point inside a file's mesh]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    base: Option<Vector>,

    /// Where the robot points at its base [default: into the burr hole, or along the longest free
    /// line]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    axis: Option<Vector>,
}

fn vector(text: &str) -> Result<Vector, String> {
    let numbers: Result<Vec<Real>, _> =
        text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, z]) if Vector::new(x, y, z).is_finite() => Ok(Vector::new(x, y, z)),
        _ => Err("write three numbers, for example 68.6,105.2,104.6".into()),
    }
}

fn factor(text: &str) -> Result<Real, String> {
    text.parse().map_err(|_| "write a number, for example 1000 for metres to millimetres".into())
}

fn direction(text: &str) -> Result<Vector, String> {
    vector(text)?
        .try_normalize()
        .ok_or("a direction needs a length; write for example 0,0,-1".into())
}

impl Anatomy {
    /// The wall. How many faces of its file were left out, because they have no area, goes to the
    /// standard error.
    pub fn load(&self) -> Result<TriMesh, String> {
        let (points, triangles) = match &self.mesh {
            Some(path) => {
                let options = Options::scaled(self.scale).with_label(self.label);
                let mesh =
                    mesh_files::load_with(path, &options).map_err(|error| error.to_string())?;
                if mesh.skipped_faces > 0 {
                    eprintln!(
                        "note: left out of {}: {} faces without area",
                        path.display(),
                        mesh.skipped_faces
                    );
                }
                mesh.into_parts()
            }
            None => ventricle::mesh(self.triangles as usize),
        };
        TriMesh::new(points, triangles).map_err(|error| error.to_string())
    }

    /// What the wall is, as a title names it.
    pub fn name(&self) -> String {
        let file = self.mesh.as_ref().and_then(|path| path.file_name());
        file.map_or("a generated brain ventricle".into(), |name| {
            name.to_string_lossy().into_owned()
        })
    }

    /// Whether the robot starts where the generated ventricle has its entry.
    pub fn is_planned(&self) -> bool {
        self.mesh.is_none() && self.base.is_none() && self.axis.is_none()
    }

    /// The robot's pose from the options; the mesh supplies what they omit.
    pub fn pose(&self, mesh: &TriMesh) -> Result<Pose, String> {
        if self.is_planned() {
            return Ok(ventricle::entry());
        }
        let base = match (self.base, &self.mesh) {
            (Some(base), _) => base,
            (None, None) => ventricle::entry().translation,
            (None, Some(path)) => steer::deepest_point(mesh).ok_or(format!(
                "{} encloses nothing, so a start inside cannot be found; name one with --base x,y,z and --axis x,y,z",
                path.display()
            ))?,
        };
        let axis = self.axis.unwrap_or_else(|| steer::clear_direction(mesh, base));
        Ok(Pose::from_parts(base, Rot3::from_rotation_arc(Vector::Z, axis)))
    }
}

/// What to say when no goal was found from `base`.
pub fn no_goal(none: &steer::NoGoal, base: &Pose) -> String {
    match none {
        steer::NoGoal::NoRoom => format!(
            "the robot has no room at {} along {}: every shape touches the wall; \
             move it with --base and --axis, or bring the mesh to millimetres with --scale",
            show(base.translation),
            show(base.rotation * Vector::Z)
        ),
        steer::NoGoal::Robot(error) => error.to_string(),
        steer::NoGoal::Query(error) => error.to_string(),
    }
}

/// A point as text.
pub fn show(v: Vector) -> String {
    format!("({:.2}, {:.2}, {:.2})", v.x, v.y, v.z)
}
