//! The wall from a file, with its frame and unit.

use crate::Options;
use crate::frames::name;
use mesh_files::Frame;
use parry_continuum::parry::bounding_volume::Aabb;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, Proximity};
use std::error::Error;

pub struct Wall {
    pub search: BvhSearch,
    pub bounds: Aabb,
    /// By its file or by the option.
    pub frame: Option<Frame>,
    pub states_unit: bool,
}

impl Wall {
    pub fn load(my: &Options) -> Result<Self, Box<dyn Error>> {
        let file = my.mesh.display();
        let mesh =
            mesh_files::load_with(&my.mesh, &mesh_files::Options::default().with_label(my.label))?;
        if mesh.skipped_faces > 0 {
            eprintln!("note: left out of {file}: {} faces without area", mesh.skipped_faces);
        }
        let (stated, states_unit) = (mesh.frame, mesh.states_unit);
        let asked = my.mesh_frame.map(Frame::from);
        if let (Some(stated), Some(asked)) = (stated, asked)
            && stated != asked
        {
            return Err(
                format!("{file} says that it is {}; leave out --mesh-frame", name(stated)).into()
            );
        }
        let (vertices, triangles) = mesh.into_parts::<Vector>();
        let bounds = Aabb::from_points(vertices.iter().copied());
        let search = BvhSearch::from_triangles(&vertices, &triangles)?;
        Ok(Self { search, bounds, frame: stated.or(asked), states_unit })
    }

    /// One line.
    pub fn describe(&self) -> String {
        let [low, high] = [self.bounds.mins, self.bounds.maxs];
        let frame = self.frame.map_or("not stated", name);
        let unit = if self.states_unit { "mm" } else { "not stated" };
        let count = self.search.triangles().len();
        format!("{count} triangles from {low:.3} to {high:.3}, frame {frame}, unit {unit}")
    }
}
