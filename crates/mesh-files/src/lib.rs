//! Reads triangle meshes from STL, OBJ, PLY and VTK files and from segmentations in NIfTI, NRRD and
//! MetaImage files; reads centrelines from VTK files, 3D Slicer's markups and text files.
//!
//! [`load`] reads a mesh; the file's extension selects the format. A mesh is complete: it has at
//! least one triangle, every vertex is finite, and every triangle names three different existing
//! vertices. Faces without area are left out, and [`Mesh::skipped_faces`] counts them. An error is
//! one line. [`Options::memory_limit`] limits the memory of reading. [`load_centreline`] reads
//! points along a line in the same way.
//!
//! This crate parses the formats itself, because the files of medical and robotics programs differ
//! from what the formats' crates accept. XML, JSON, base64, archives and surface nets are left
//! to crates.
#![warn(missing_debug_implementations, missing_docs)]

#[cfg(feature = "centrelines")]
mod centreline;
mod doubts;
mod ears;
mod error;
#[cfg(feature = "label-maps")]
mod label_map;
mod mesh;
mod obj;
mod ply;
mod polygon;
mod stl;
mod text;

#[cfg(feature = "centrelines")]
pub use centreline::{
    Centreline, centreline_from_bytes, load_centreline, load_shapes, load_table, table_from_bytes,
};
pub use doubts::{
    Bounds, Change, Misfits, RadiusDoubt, margin_doubt, misfits, radius_doubt, scales_radius,
    sharp_turns,
};
pub use error::{MeshFileError, list_labels};
#[cfg(feature = "label-maps")]
use label_map::Fault;
#[cfg(feature = "label-maps")]
pub use label_map::LabelVolume;
pub use mesh::{Frame, Mesh};
pub use obj::to_obj;
use std::borrow::Cow;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// The options for reading a file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The factor of every coordinate, for example 1000 for metres to millimetres. A label map
    /// states its unit: it is converted to millimetres before this factor applies.
    pub scale: f64,
    /// The label whose surface is read from a label map. `None` takes all voxels that are not 0 as
    /// inside. For a file of triangles a label is an error.
    pub label: Option<u32>,
    /// Whether to read a label map that does not state the position of its voxels. Its first voxel
    /// is then the origin, its axes are the axes of the voxels, and a voxel without a stated
    /// spacing has the sides 1. Its frame is unknown unless the file states it.
    pub allow_no_position: bool,
    /// The line to read from a centreline's file, counted from 0. A file with one line needs none.
    pub line: Option<usize>,
    /// The most memory, in bytes, that reading may take beside the file's own bytes. The default is
    /// 2 GiB.
    ///
    /// A file that would take more is refused before the memory is allocated, with
    /// [`MeshFileError::TooLarge`].
    /// - A label map takes 5 bytes for each voxel of the smallest box around the label, and at most
    ///   134 for each face between a voxel of the label and another voxel. Its voxels are never
    ///   stored as a whole, even if the file is a small archive.
    /// - A file of triangles takes memory in proportion to its size, not to the count in its
    ///   header. [`load_with`] refuses a file that is itself larger than the limit before it reads
    ///   the file.
    pub memory_limit: u64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            scale: 1.0,
            label: None,
            allow_no_position: false,
            line: None,
            memory_limit: 2 << 30,
        }
    }
}

impl Options {
    /// Returns default options with this factor of every coordinate.
    pub fn scaled(scale: f64) -> Self {
        Self { scale, ..Self::default() }
    }

    /// Returns the same options with this [`label`](Self::label). A file of triangles has no
    /// labels: a label is then an error.
    pub fn with_label(self, label: Option<u32>) -> Self {
        Self { label, ..self }
    }

    /// Returns the same options with this [`allow_no_position`](Self::allow_no_position).
    pub fn with_no_position_allowed(self, allow_no_position: bool) -> Self {
        Self { allow_no_position, ..self }
    }

    /// Returns the same options with this [`line`](Self::line), counted from 0.
    pub fn with_line(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// Returns the same options with this [`memory_limit`](Self::memory_limit), in bytes.
    pub fn with_memory_limit(self, memory_limit: u64) -> Self {
        Self { memory_limit, ..self }
    }

    /// Checks the scale, as all functions that read a file do.
    ///
    /// # Errors
    /// The scale is not positive, or not finite.
    pub fn check_scale(&self) -> Result<(), MeshFileError> {
        let scale = self.scale;
        if scale > 0.0 && scale.is_finite() { Ok(()) } else { Err(MeshFileError::Scale { scale }) }
    }

    /// Multiplies the coordinates by the scale.
    ///
    /// # Errors
    /// A point is not finite, before or after the multiplication.
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
                return Err(MeshFileError::NotFinite {
                    file: file.to_owned(),
                    index,
                    place,
                    scale,
                    advice,
                });
            }
        }
        Ok(())
    }
}

/// The format that a file's extension names.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Stl,
    Obj,
    Ply,
    #[cfg(feature = "centrelines")]
    Vtk,
    #[cfg(feature = "centrelines")]
    VtkXml,
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
            #[cfg(feature = "centrelines")]
            "vtk" => Ok(Self::Vtk),
            #[cfg(feature = "centrelines")]
            "vtp" => Ok(Self::VtkXml),
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
            #[cfg(feature = "centrelines")]
            Self::Vtk | Self::VtkXml => false,
            #[cfg(feature = "label-maps")]
            Self::MetaImage | Self::Nifti | Self::Nrrd => true,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stl => "STL",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            #[cfg(feature = "centrelines")]
            Self::Vtk => "VTK",
            #[cfg(feature = "centrelines")]
            Self::VtkXml => "VTK XML",
            #[cfg(feature = "label-maps")]
            Self::MetaImage => "MetaImage",
            #[cfg(feature = "label-maps")]
            Self::Nifti => "NIfTI",
            #[cfg(feature = "label-maps")]
            Self::Nrrd => "NRRD",
        }
    }
}

/// Reads the mesh in a file.
///
/// # Errors
/// As [`load_with`].
pub fn load(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    load_with(path, &Options::default())
}

/// Reads the mesh in a file with these options.
///
/// # Errors
/// - The file cannot be read, its format is unknown, or its content is invalid.
/// - It contains no triangle, a vertex is not finite, or a triangle names a vertex that does not
///   exist.
/// - A label map has no voxel of the label, or is an image.
/// - A label is requested of a file of triangles.
/// - Reading takes more memory than the options allow.
/// - The scale is not a positive number.
pub fn load_with(path: impl AsRef<Path>, options: &Options) -> Result<Mesh, MeshFileError> {
    load_by(path.as_ref(), options, &|file| read_file(file, options).map(Cow::Owned))
}

/// Same as [`load_with`], for files that are in memory.
///
/// `content` returns the bytes of a file. It is called with `path`, or with the path of the header
/// or of the voxels if the format has them in two files.
///
/// # Errors
/// As [`load_with`]; a file for which `content` returns `None` is
/// [`Unreadable`](MeshFileError::Unreadable).
pub fn load_from<'a>(
    path: impl AsRef<Path>,
    content: impl Fn(&Path) -> Option<&'a [u8]>,
    options: &Options,
) -> Result<Mesh, MeshFileError> {
    load_by(path.as_ref(), options, &|file| match content(file) {
        Some(bytes) => Ok(Cow::Borrowed(bytes)),
        None => {
            let reason = "it is not given".into();
            Err(MeshFileError::Unreadable { file: file.to_owned(), reason })
        }
    })
}

/// Same as [`load_with`]. Also returns the files that were read: one, or header and voxels.
///
/// # Errors
/// As [`load_with`].
pub fn load_with_files(
    path: impl AsRef<Path>,
    options: &Options,
) -> Result<(Mesh, Vec<PathBuf>), MeshFileError> {
    let files = RefCell::new(Vec::new());
    let mesh = load_by(path.as_ref(), options, &|file| {
        files.borrow_mut().push(file.to_owned());
        read_file(file, options).map(Cow::Owned)
    })?;
    Ok((mesh, files.into_inner()))
}

fn load_by(path: &Path, options: &Options, reader: Reader) -> Result<Mesh, MeshFileError> {
    let (format, bytes) = read_whole(path, reader)?;
    parse(path, format, &bytes, options)
}

/// Returns the labels of a label map with their volumes, in ascending order, without the label 0:
/// the lowest 1000 if there are more.
///
/// The scale of the options multiplies lengths, so volumes grow by its cube; the label is ignored.
///
/// # Errors
/// As [`load_with`] for a label map; or the file holds triangles.
#[cfg(feature = "label-maps")]
pub fn load_labels(
    path: impl AsRef<Path>,
    options: &Options,
) -> Result<Vec<LabelVolume>, MeshFileError> {
    let path = path.as_ref();
    let (format, bytes) = read_whole(path, &|file| read_file(file, options).map(Cow::Owned))?;
    labels(path, format, &bytes, options)
}

/// Same as [`load_labels`], for the content of a file with this name.
///
/// # Errors
/// As [`load_labels`].
#[cfg(feature = "label-maps")]
pub fn labels_from_bytes(
    path: impl AsRef<Path>,
    bytes: &[u8],
    options: &Options,
) -> Result<Vec<LabelVolume>, MeshFileError> {
    let path = path.as_ref();
    labels(path, Format::of(path)?, bytes, options)
}

#[cfg(feature = "label-maps")]
fn labels(
    path: &Path,
    format: Format,
    bytes: &[u8],
    options: &Options,
) -> Result<Vec<LabelVolume>, MeshFileError> {
    let options = &options.with_label(None);
    options.check_scale()?;
    volume(format, bytes, options)
        .and_then(|volume| volume.label_volumes(options.scale))
        .map_err(|fault| label_map_error(fault, path, format, bytes, options))
}

/// Returns the bytes of a file.
type Reader<'r, 'a> = &'r dyn Fn(&Path) -> Result<Cow<'a, [u8]>, MeshFileError>;

/// The format and the content of a file.
type Content<'a> = (Format, Cow<'a, [u8]>);

/// Returns the format and the content of a file. A label map has its voxels, which may be in a
/// second file.
fn read_whole<'a>(path: &Path, reader: Reader<'_, 'a>) -> Result<Content<'a>, MeshFileError> {
    #[cfg(feature = "label-maps")]
    if let Some(whole) = two_files(path, reader) {
        return whole;
    }
    // Check the name first: reading a device may never end.
    let format = Format::of(path)?;
    let bytes = reader(path)?;
    #[cfg(feature = "label-maps")]
    let bytes = with_voxels(path, format, bytes, reader)?;
    Ok((format, bytes))
}

/// Returns a label map as one file, if its name says that header and voxels are in two files.
#[cfg(feature = "label-maps")]
fn two_files<'a>(
    path: &Path,
    reader: Reader<'_, 'a>,
) -> Option<Result<Content<'a>, MeshFileError>> {
    let extension = path.extension()?.to_str()?;
    let file = |own: &str| {
        let is_upper = extension.chars().all(char::is_uppercase);
        reader(&path.with_extension(if is_upper { own.to_uppercase() } else { own.into() }))
    };
    if label_map::nifti::is_pair(extension) {
        let both = file("hdr").and_then(|header| Ok((header, file("img")?)));
        return Some(both.and_then(|(header, voxels)| {
            let whole = label_map::nifti::in_one(&header, &voxels);
            let broken =
                |reason| MeshFileError::Broken { file: path.to_owned(), format: "NIfTI", reason };
            Ok((Format::Nifti, Cow::Owned(whole.map_err(broken)?)))
        }));
    }
    if extension.eq_ignore_ascii_case("nhdr") {
        let whole = reader(path).and_then(|bytes| with_voxels(path, Format::Nrrd, bytes, reader));
        return Some(whole.map(|bytes| (Format::Nrrd, bytes)));
    }
    None
}

/// Returns the file with the voxels that its header places in another file.
#[cfg(feature = "label-maps")]
fn with_voxels<'a>(
    path: &Path,
    format: Format,
    bytes: Cow<'a, [u8]>,
    reader: Reader<'_, 'a>,
) -> Result<Cow<'a, [u8]>, MeshFileError> {
    use label_map::{meta_image, nrrd};
    let voxels = |name: std::path::PathBuf| reader(&path.with_file_name(name));
    Ok(match format {
        Format::MetaImage => match meta_image::voxels_file(&bytes) {
            Some(name) => Cow::Owned(meta_image::in_one(&bytes, &voxels(name)?)),
            None => bytes,
        },
        Format::Nrrd => match nrrd::voxels_file(&bytes) {
            Some(name) => Cow::Owned(nrrd::in_one(&bytes, &voxels(name)?)),
            None => bytes,
        },
        _ => bytes,
    })
}

/// Returns the bytes of a file, if it is no larger than the options allow.
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

/// Same as [`load_with`], for the content of a file with this name.
///
/// # Errors
/// As [`load_with`].
pub fn from_bytes(
    path: impl AsRef<Path>,
    bytes: &[u8],
    options: &Options,
) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    parse(path, Format::of(path)?, bytes, options)
}

fn parse(
    path: &Path,
    format: Format,
    bytes: &[u8],
    options: &Options,
) -> Result<Mesh, MeshFileError> {
    options.check_scale()?;
    let file = path.to_owned();
    let broken = |reason: String| broken(reason, path, format, bytes);
    let mut mesh = match format {
        Format::Stl => stl::read(bytes).map_err(broken),
        Format::Obj => obj::read(bytes).map_err(broken),
        Format::Ply => ply::read(bytes).map_err(broken),
        #[cfg(feature = "centrelines")]
        Format::Vtk => centreline::surface(centreline::vtk_legacy::read(bytes)).map_err(broken),
        #[cfg(feature = "centrelines")]
        Format::VtkXml => {
            centreline::surface(centreline::vtk_xml::read(bytes, options.memory_limit))
                .map_err(broken)
        }
        #[cfg(feature = "label-maps")]
        Format::MetaImage | Format::Nifti | Format::Nrrd => volume(format, bytes, options)
            .and_then(|volume| volume.surface(options.label, options.memory_limit))
            .map_err(|fault| label_map_error(fault, path, format, bytes, options)),
    }?;
    if let Some(label) = options.label.filter(|_| !format.has_labels()) {
        return Err(MeshFileError::WithoutLabels { file, format: format.name(), label });
    }
    if mesh.triangles.is_empty() {
        return Err(MeshFileError::Empty { file, skipped_faces: mesh.skipped_faces });
    }
    let count = mesh.vertices.len();
    if let Some(corner) = mesh.triangles.iter().flatten().find(|&&corner| corner as usize >= count)
    {
        let reason =
            format!("a triangle names vertex {corner}, but there are {count}, counted from 0");
        return Err(MeshFileError::Broken { file, format: format.name(), reason });
    }
    options.scale_all(path, &mut mesh.vertices)?;
    Ok(mesh)
}

/// Returns the error for an invalid content, or for a name that promises another format.
fn broken(reason: String, path: &Path, format: Format, bytes: &[u8]) -> MeshFileError {
    let (file, format) = (path.to_owned(), format.name());
    match text::looks_like(bytes) {
        Some(found) if found != format => MeshFileError::Misnamed { file, format, found },
        _ => MeshFileError::Broken { file, format, reason },
    }
}

/// Returns the voxels of a label map.
#[cfg(feature = "label-maps")]
fn volume<'a>(
    format: Format,
    bytes: &'a [u8],
    options: &Options,
) -> Result<label_map::Volume<'a>, Fault> {
    match format {
        Format::MetaImage => label_map::meta_image::read(bytes, options.allow_no_position),
        Format::Nifti => label_map::nifti::read(bytes, options.allow_no_position),
        Format::Nrrd => label_map::nrrd::read(bytes, options.allow_no_position),
        _ => Err(Fault::NoLabels),
    }
}

/// Returns the error for a label map that gives no surface.
#[cfg(feature = "label-maps")]
fn label_map_error(
    fault: Fault,
    path: &Path,
    format: Format,
    bytes: &[u8],
    options: &Options,
) -> MeshFileError {
    let file = path.to_owned();
    match (fault, options.label) {
        (Fault::Broken(reason), _) => broken(reason, path, format, bytes),
        (Fault::NoLabels, _) => MeshFileError::NoLabels { file, format: format.name() },
        (Fault::NoPosition(missing), _) => MeshFileError::NoPosition { file, missing },
        (Fault::TooLarge(bytes), _) => {
            MeshFileError::TooLarge { file, bytes, limit: options.memory_limit }
        }
        (Fault::NotALabel(number), _) => MeshFileError::NotLabels { file, number },
        (Fault::NoneOf(present), Some(label)) => {
            MeshFileError::NoSuchLabel { file, label, present }
        }
        (Fault::NoneOf(_), None) => MeshFileError::NothingSegmented { file },
    }
}

/// Runs the code in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
