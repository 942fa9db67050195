//! The wall: its file and its frame.

use crate::files::{Files, options, refused};
use crate::{flat, frame_of};
use continuum_demo::{steer, ventricle};
use mesh_files::{Bounds, Frame};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use wasm_bindgen::prelude::wasm_bindgen;

/// The wall and the engine that searches it.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Wall {
    pub(crate) search: BvhSearch,
    name: String,
    /// Where tubes come in, and in which direction; `None` until the first query about tubes.
    entry: Option<Pose>,
    stated_frame: Option<Frame>,
    chosen_frame: Option<Frame>,
    /// Whether the coordinates are millimetres by the file's own statement.
    pub(crate) is_millimetres: bool,
    labels: Vec<u32>,
    notes: Vec<String>,
}

#[wasm_bindgen]
impl Wall {
    /// A brain ventricle, in millimetres.
    ///
    /// # Errors
    /// None: the mesh is valid.
    pub fn ventricle() -> Result<Wall, String> {
        let (vertices, triangles) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
        let search =
            BvhSearch::from_triangles(&vertices, &triangles).map_err(|error| error.to_string())?;
        Ok(Self {
            search,
            name: "the ventricle".into(),
            entry: Some(ventricle::entry()),
            stated_frame: None,
            chosen_frame: None,
            is_millimetres: true,
            labels: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// Reads the wall in a file, by the rules of `mesh_files::load`.
    ///
    /// - `label`: the label of a segmentation; all that are not 0 without it.
    /// - `scale`: the factor of all coordinates.
    /// - `allow_no_position`: whether the first voxel is at the origin if the file states no
    ///   position.
    ///
    /// # Errors
    /// The file is invalid or of an unknown format, or a choice does not fit it.
    pub fn read(
        files: &Files,
        name: &str,
        label: Option<u32>,
        scale: Real,
        allow_no_position: bool,
    ) -> Result<Wall, String> {
        let options = options(scale).with_label(label).with_no_position_allowed(allow_no_position);
        let mesh = mesh_files::load_from(name, |file| files.get(file), &options)
            .map_err(|error| refused(&error))?;
        let mut notes = Vec::new();
        if mesh.skipped_faces > 0 {
            notes.push(format!("left out of {name}: {} faces without area", mesh.skipped_faces));
        }
        let labels = if mesh.labels.len() > 1 { mesh.labels.clone() } else { Vec::new() };
        if !labels.is_empty() {
            let count = labels.len();
            notes.push(format!("{name} has {count} labels, read as one surface; choose a label"));
        }
        notes.extend(mesh.doubts.iter().map(|doubt| format!("{name}: {doubt}")));
        let (stated_frame, is_millimetres) = (mesh.frame, mesh.states_unit && scale == 1.0);
        let (vertices, triangles) = mesh.into_parts::<Vector>();
        let search = BvhSearch::from_triangles(&vertices, &triangles)
            .map_err(|error| format!("{name}: {error}"))?;
        notes.extend(search.surface().doubts().iter().map(|doubt| format!("{name}: {doubt}")));
        Ok(Self {
            search,
            name: name.to_owned(),
            entry: None,
            stated_frame,
            chosen_frame: None,
            is_millimetres,
            labels,
            notes,
        })
    }

    /// Chooses the frame, RAS or LPS, if the file does not state it.
    ///
    /// # Errors
    /// The file states the other frame.
    pub fn choose_frame(&mut self, frame: Option<String>) -> Result<(), String> {
        let chosen = frame.as_deref().map(frame_of).transpose()?;
        Frame::resolve(self.stated_frame, chosen).map_err(|stated| {
            let (name, stated) = (&self.name, stated.name());
            format!("{name} says that it is {stated}; choose this frame for the wall")
        })?;
        self.chosen_frame = chosen;
        Ok(())
    }

    /// The frame that the file states: RAS, LPS or none.
    pub fn stated_frame(&self) -> Option<String> {
        self.stated_frame.map(|frame| frame.name().to_owned())
    }

    /// The labels that were read as one surface, if there are several.
    pub fn labels(&self) -> Vec<u32> {
        self.labels.clone()
    }

    /// What was left out of the file, what was merged, and why its inside may be doubtful.
    pub fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Why the unit of a margin may be wrong.
    pub fn margin_doubt(&self, margin: Real) -> Option<String> {
        mesh_files::margin_doubt(margin, &self.bounds()?)
    }

    /// Size, frame and unit, in one line.
    pub fn describe(&self) -> String {
        let count = self.search.triangles().len();
        let frame = self.frame().map_or("not stated", Frame::name);
        let unit = if self.is_millimetres { "mm" } else { "not stated, taken as mm" };
        let place = self.bounds().map_or_else(String::new, |Bounds { low, high }| {
            let [low, high] = [low, high].map(|p| p.map(|x| format!("{x:.1}")).join(", "));
            format!(" from ({low}) to ({high})")
        });
        format!("{count} triangles{place}; frame {frame}; unit {unit}")
    }

    pub fn vertices(&self) -> Vec<Real> {
        flat(self.search.vertices())
    }

    pub fn triangles(&self) -> Vec<u32> {
        self.search.triangles().as_flattened().to_vec()
    }

    /// The wall as the OBJ file that belongs to a proof.
    pub fn obj(&self) -> String {
        mesh_files::to_obj(self.search.vertices(), self.search.triangles())
    }
}

impl Wall {
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn frame(&self) -> Option<Frame> {
        self.stated_frame.or(self.chosen_frame)
    }

    pub(crate) fn bounds(&self) -> Option<Bounds> {
        Bounds::of_points(self.search.vertices().iter().map(|vertex| vertex.to_array()))
    }

    /// Where tubes come in: the point deepest inside, along the longest free line.
    pub(crate) fn entry(&mut self) -> Pose {
        let (vertices, triangles) = (self.search.vertices(), self.search.triangles());
        let find = || {
            let middle = vertices.iter().copied().sum::<Vector>() / vertices.len() as Real;
            let Ok(mesh) = TriMesh::new(vertices.to_vec(), triangles.to_vec()) else {
                return Pose::from_parts(middle, Rot3::IDENTITY);
            };
            let from = steer::deepest_point(&mesh).unwrap_or(middle);
            Pose::from_parts(
                from,
                Rot3::from_rotation_arc(Vector::Z, steer::clear_direction(&mesh, from)),
            )
        };
        *self.entry.get_or_insert_with(find)
    }
}
