//! The wall from a file, with its frame and unit.

use crate::messages;
use crate::number::place;
use crate::options::Options;
use mesh_files::Frame;
use parry_continuum::parry::bounding_volume::Aabb;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, Proximity};
use std::path::PathBuf;

pub struct Wall {
    pub search: BvhSearch,
    pub bounds: Aabb,
    /// As its file or --mesh-frame states it.
    pub frame: Option<Frame>,
    pub states_unit: bool,
    /// The files that were read: one, or header and voxels.
    pub files: Vec<PathBuf>,
    /// What was left out or merged, a line each.
    pub notes: Vec<String>,
}

impl Wall {
    pub fn load(my: &Options) -> Result<Self, String> {
        let file = my.mesh.display();
        let options = mesh_files::Options::default()
            .with_label(my.label)
            .with_no_position_allowed(my.allow_no_position);
        let (mesh, files) = mesh_files::load_with_files(&my.mesh, &options)
            .map_err(|error| messages::of_file(&error))?;
        let mut notes = Vec::new();
        if mesh.labels.len() > 1 {
            let labels = mesh_files::list_labels(&mesh.labels);
            notes.push(format!("labels {labels} of {file} are merged; --label takes one of them"));
        }
        if mesh.skipped_faces > 0 {
            notes.push(format!("left out of {file}: {} faces without area", mesh.skipped_faces));
        }
        notes.extend(mesh.doubts.iter().map(|doubt| format!("{file}: {doubt}")));
        let states_unit = mesh.states_unit;
        let frame =
            Frame::resolve(mesh.frame, my.mesh_frame.map(Frame::from)).map_err(|stated| {
                format!("{file} says that it is {}; leave out --mesh-frame", stated.name())
            })?;
        let (vertices, triangles) = mesh.into_parts::<Vector>();
        let bounds = Aabb::from_points(vertices.iter().copied());
        let search = BvhSearch::from_triangles(&vertices, &triangles)
            .map_err(|error| format!("{file}: {error}"))?;
        Ok(Self { search, bounds, frame, states_unit, files, notes })
    }

    /// Returns the unit of length, if it is known.
    pub fn unit(&self) -> Option<&'static str> {
        self.states_unit.then_some("mm")
    }

    /// Describes the wall in one line.
    pub fn describe(&self) -> String {
        let [low, high] = [self.bounds.mins, self.bounds.maxs];
        let frame = self.frame.map_or("not stated", Frame::name);
        let unit = self.unit().unwrap_or("not stated");
        let count = self.search.triangles().len();
        let [low, high] = [low, high].map(|corner| place(corner, 3));
        format!("{count} triangles from {low} to {high}, frame {frame}, unit {unit}")
    }
}
