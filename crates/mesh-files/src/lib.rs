//! Triangle meshes from STL, OBJ and PLY files and from segmentations in NIfTI, NRRD and MetaImage files; centrelines
//! from VTK's files and 3D Slicer's markups.
//!
//! [`load`] reads a mesh, by the file's extension. What comes back is whole: there is at least one triangle, every vertex is
//! finite, and every triangle names three different vertices that are there. What is wrong with a file is said in one
//! line. Faces without area are left out, and [`Mesh::skipped_faces`] counts them. How much memory reading may take is
//! limited by [`Options::memory_limit`]. [`load_centreline`] reads points along a line in the same way.
//!
//! STL and OBJ are read here, because their errors must name the line, and VTK's files, because no crate reads those of
//! version 5.1; PLY's grammar and NIfTI's header are left to the crates that know them.
#![warn(missing_debug_implementations, missing_docs)]

#[cfg(feature = "centrelines")]
mod centreline;
mod error;
#[cfg(feature = "label-maps")]
mod label_map;
mod mesh;
mod obj;
mod ply;
mod stl;
mod text;

#[cfg(feature = "centrelines")]
pub use centreline::{Centreline, centreline_from_bytes, load_centreline};
pub use error::MeshFileError;
#[cfg(feature = "label-maps")]
use label_map::Fault;
pub use mesh::{Frame, Mesh};
use std::path::Path;

/// How a file is read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Multiplies every coordinate, for example 1000 for metres to millimetres. A label map has a unit and comes in
    /// millimetres before it is multiplied.
    pub scale: f64,
    /// The label whose surface is taken from a label map; without one all voxels that are not 0 are inside. For a file
    /// of triangles it is an error.
    pub label: Option<u32>,
    /// Which line of a centreline's file is read, counted from 0. A file with one line needs none.
    pub line: Option<usize>,
    /// The most memory, in bytes, that reading may take beside the file's own bytes: 2 GiB unless something else is said.
    ///
    /// What would take more is refused before the memory is taken, with [`MeshFileError::TooLarge`]. A label map takes 5
    /// bytes for each voxel of the smallest box around the label, and at most 134 for each face between a voxel of the
    /// label and another one; its voxels are never kept as a whole, however small their archive is. A file of triangles
    /// takes memory in proportion to its size, whatever its header counts; one that is itself larger than the limit is
    /// refused by [`load_with`] before it is read.
    pub memory_limit: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self { scale: 1.0, label: None, line: None, memory_limit: 2 << 30 }
    }
}

impl Options {
    /// Every coordinate multiplied by `scale`.
    pub fn scaled(scale: f64) -> Self {
        Self { scale, ..Self::default() }
    }

    /// The same, but of a label map the surface of this label, or of all that are not 0. A file of triangles has no
    /// labels: asked for one, it is an error.
    pub fn with_label(self, label: Option<u32>) -> Self {
        Self { label, ..self }
    }

    /// The same, but of a file of several centrelines this one, counted from 0.
    pub fn with_line(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// The same, but with so many bytes of memory at most, beside those of the file.
    pub fn with_memory_limit(self, memory_limit: u64) -> Self {
        Self { memory_limit, ..self }
    }

    fn check_scale(&self) -> Result<(), MeshFileError> {
        let scale = self.scale;
        if scale > 0.0 && scale.is_finite() { Ok(()) } else { Err(MeshFileError::Scale { scale }) }
    }

    /// Multiplies the coordinates.
    ///
    /// # Errors
    /// A point is not finite, before or after that.
    fn scale_all(&self, file: &Path, points: &mut [[f64; 3]]) -> Result<(), MeshFileError> {
        let scale = self.scale;
        for (index, point) in points.iter_mut().enumerate() {
            let place = *point;
            *point = place.map(|x| x * scale);
            if !point.iter().all(|x| x.is_finite()) {
                let advice = if place.iter().all(|x| x.is_finite()) {
                    "choose a smaller scale"
                } else {
                    "repair that vertex"
                };
                return Err(MeshFileError::NotFinite { file: file.to_owned(), index, place, scale, advice });
            }
        }
        Ok(())
    }
}

/// What a file's extension says it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Stl,
    Obj,
    Ply,
    #[cfg(feature = "label-maps")]
    MetaImage,
    #[cfg(feature = "label-maps")]
    Nifti,
    #[cfg(feature = "label-maps")]
    Nrrd,
}

impl Format {
    fn of(path: &Path) -> Result<Self, MeshFileError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let file = path.to_owned();
        match name.rsplit_once('.').map_or("", |(_, extension)| extension) {
            "stl" => Ok(Self::Stl),
            "obj" => Ok(Self::Obj),
            "ply" => Ok(Self::Ply),
            #[cfg(feature = "label-maps")]
            "mha" | "mhd" => Ok(Self::MetaImage),
            #[cfg(feature = "label-maps")]
            "nii" => Ok(Self::Nifti),
            #[cfg(feature = "label-maps")]
            "gz" if name.ends_with(".nii.gz") => Ok(Self::Nifti),
            #[cfg(feature = "label-maps")]
            "nrrd" => Ok(Self::Nrrd),
            "nhdr" | "img" | "hdr" => Err(MeshFileError::InTwoFiles { file }),
            _ => Err(MeshFileError::UnknownFormat { file }),
        }
    }

    fn has_labels(self) -> bool {
        match self {
            Self::Stl | Self::Obj | Self::Ply => false,
            #[cfg(feature = "label-maps")]
            Self::MetaImage | Self::Nifti | Self::Nrrd => true,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stl => "STL",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            #[cfg(feature = "label-maps")]
            Self::MetaImage => "MetaImage",
            #[cfg(feature = "label-maps")]
            Self::Nifti => "NIfTI",
            #[cfg(feature = "label-maps")]
            Self::Nrrd => "NRRD",
        }
    }
}

/// The mesh in the file.
///
/// # Errors
/// As [`load_with`].
pub fn load(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    load_with(path, &Options::default())
}

/// The mesh in the file, read as the options say.
///
/// # Errors
/// The file cannot be read, is of unknown format or broken, or holds no triangle; a vertex is not finite; a triangle
/// names a vertex that is not there; a label map has no voxel of the label, or holds an image instead; a label is asked
/// of a file of triangles; it takes more memory than the options allow; or the scale is not a positive number.
pub fn load_with(path: impl AsRef<Path>, options: &Options) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    // The name first: a device may never end.
    let _format = Format::of(path)?;
    let bytes = read_file(path, options)?;
    #[cfg(feature = "label-maps")]
    if _format == Format::MetaImage
        && let Some(voxels) = label_map::meta_image::voxels_file(&bytes)
    {
        let voxels = read_file(&path.with_file_name(voxels), options)?;
        return from_bytes(path, &label_map::meta_image::in_one(&bytes, &voxels), options);
    }
    from_bytes(path, &bytes, options)
}

/// The bytes of a file that is no larger than the options allow.
fn read_file(path: &Path, options: &Options) -> Result<Vec<u8>, MeshFileError> {
    let unreadable = |reason: String| MeshFileError::Unreadable { file: path.to_owned(), reason };
    let kind = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !kind.is_file() {
        return Err(unreadable("it is not a file".into()));
    }
    if kind.len() > options.memory_limit {
        let (file, bytes, limit) = (path.to_owned(), kind.len(), options.memory_limit);
        return Err(MeshFileError::TooLarge { file, bytes, limit });
    }
    std::fs::read(path).map_err(|error| unreadable(error.to_string()))
}

/// As [`load_with`], for a file of this name that holds these bytes.
///
/// # Errors
/// As [`load_with`].
pub fn from_bytes(path: impl AsRef<Path>, bytes: &[u8], options: &Options) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    options.check_scale()?;
    let file = path.to_owned();
    let broken = |reason: String| {
        let (file, format) = (path.to_owned(), format.name());
        match text::looks_like(bytes) {
            Some(found) if found != format => MeshFileError::Misnamed { file, format, found },
            _ => MeshFileError::Broken { file, format, reason },
        }
    };
    #[cfg(feature = "label-maps")]
    let surface = |read: Result<label_map::Volume, Fault>| {
        read.and_then(|volume| volume.surface(options.label, options.memory_limit)).map_err(|fault| {
            let file = path.to_owned();
            match (fault, options.label) {
                (Fault::Broken(reason), _) => broken(reason),
                (Fault::TooLarge(bytes), _) => {
                    MeshFileError::TooLarge { file, bytes, limit: options.memory_limit }
                }
                (Fault::NotALabel(number), _) => MeshFileError::NotLabels { file, number },
                (Fault::NoneOf(present), Some(label)) => {
                    MeshFileError::NoSuchLabel { file, label, present: present.into_iter().collect() }
                }
                (Fault::NoneOf(_), None) => MeshFileError::NothingSegmented { file },
            }
        })
    };
    let mut mesh = match format {
        Format::Stl => stl::read(bytes).map_err(broken),
        Format::Obj => obj::read(bytes).map_err(broken),
        Format::Ply => ply::read(bytes).map_err(broken),
        #[cfg(feature = "label-maps")]
        Format::MetaImage => surface(label_map::meta_image::read(bytes)),
        #[cfg(feature = "label-maps")]
        Format::Nifti => surface(label_map::nifti::read(bytes)),
        #[cfg(feature = "label-maps")]
        Format::Nrrd => surface(label_map::nrrd::read(bytes)),
    }?;
    if let Some(label) = options.label.filter(|_| !format.has_labels()) {
        return Err(MeshFileError::WithoutLabels { file, format: format.name(), label });
    }
    if mesh.triangles.is_empty() {
        return Err(MeshFileError::Empty { file, skipped_faces: mesh.skipped_faces });
    }
    let count = mesh.vertices.len();
    if let Some(corner) = mesh.triangles.iter().flatten().find(|&&corner| corner as usize >= count) {
        let reason = format!("a triangle names vertex {corner}, but there are {count}, counted from 0");
        return Err(MeshFileError::Broken { file, format: format.name(), reason });
    }
    options.scale_all(path, &mut mesh.vertices)?;
    Ok(mesh)
}

/// Runs the code in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
