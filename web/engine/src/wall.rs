use crate::{Answers, Robot, flat};
use continuum_demo::{steer, ventricle};
use mesh_files::Options;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity, Side};
use wasm_bindgen::prelude::wasm_bindgen;

/// The wall and the engine that searches it.
#[wasm_bindgen]
pub struct Wall {
    search: BvhSearch,
    /// Where a robot comes in, and along which way.
    entry: Pose,
}

#[wasm_bindgen]
impl Wall {
    /// A brain ventricle, in millimetres.
    pub fn ventricle() -> Result<Wall, String> {
        let (vertices, triangles) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
        let search =
            BvhSearch::from_triangles(&vertices, &triangles).map_err(|error| error.to_string())?;
        Ok(Self { search, entry: ventricle::entry() })
    }

    /// A user's file: its name, whose extension states the format, and its bytes. A robot of tubes
    /// enters at the point that is deepest inside.
    ///
    /// # Errors
    /// The file is broken, or of an unknown format.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Wall, String> {
        let mesh = mesh_files::from_bytes(name, bytes, &Options::default())
            .map_err(|error| error.to_string())?;
        let (vertices, triangles) = mesh.into_parts::<Vector>();
        let search =
            BvhSearch::from_triangles(&vertices, &triangles).map_err(|error| error.to_string())?;
        let middle = vertices.iter().copied().sum::<Vector>() / vertices.len() as Real;
        let mesh = TriMesh::new(vertices, triangles).map_err(|error| error.to_string())?;
        let from = steer::deepest_point(&mesh).unwrap_or(middle);
        let turn = Rot3::from_rotation_arc(Vector::Z, steer::clear_direction(&mesh, from));
        Ok(Self { search, entry: Pose::from_parts(from, turn) })
    }

    pub fn vertices(&self) -> Vec<Real> {
        flat(self.search.vertices())
    }

    pub fn triangles(&self) -> Vec<u32> {
        self.search.triangles().as_flattened().to_vec()
    }

    /// How far each link is. A robot of tubes stands at the entry.
    ///
    /// # Errors
    /// The robot is out of range.
    pub fn ask(&mut self, robot: &Robot) -> Result<Answers, String> {
        let pose = if robot.stands_at_entry() { self.entry } else { Pose::IDENTITY };
        let mut links = Vec::new();
        self.search
            .per_link(robot.chain(), &pose, &mut links)
            .map_err(|error| error.to_string())?;
        let minimum =
            self.search.minimum(robot.chain(), &pose).map_err(|error| error.to_string())?;
        let base = robot
            .chain()
            .links()
            .first()
            .map_or(Side::Undecided, |link| self.search.side(pose * link.start()));
        Ok(Answers { links, minimum, base, robot: robot.chain().links().to_vec(), pose })
    }
}
