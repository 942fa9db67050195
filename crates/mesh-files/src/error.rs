//! The errors of reading a file, each one line long.

use std::path::PathBuf;
use thiserror::Error;

/// Why a file could not be read as a mesh or as a centreline. The message names the file and the
/// remedy.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file does not exist, must not be read, or is a directory or a device.
    #[error("cannot read {} ({reason}); check the path", file.display())]
    #[non_exhaustive]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The message of the operating system.
        reason: String,
    },
    /// The file's name does not identify a format.
    #[error("the format of {} is unknown; give a file that ends in .stl, .obj or .ply{SURFACES}{LABEL_MAPS}", file.display())]
    #[non_exhaustive]
    UnknownFormat {
        /// The file.
        file: PathBuf,
    },
    /// The name of a centreline's file does not identify a format.
    #[error("the format of {} is unknown; give a centreline that ends in .mrk.json, .vtp or .vtk, or a text with x,y,z in its lines that ends in .csv, .tsv, .txt or .dat", file.display())]
    #[non_exhaustive]
    UnknownCentreline {
        /// The file.
        file: PathBuf,
    },
    /// A centreline's file contains no line.
    #[error("{} holds no line; export the curve, not only its points or its surface", file.display())]
    #[non_exhaustive]
    NoLine {
        /// The file.
        file: PathBuf,
    },
    /// The line in a centreline's file has fewer than two points.
    #[error("{} holds a line of {count} point{}; give the points from base to tip, at least two", file.display(), if *count == 1 { "" } else { "s" })]
    #[non_exhaustive]
    TooFewPoints {
        /// The file.
        file: PathBuf,
        /// The number of points.
        count: usize,
    },
    /// A line of a text file lacks the numbers that are needed.
    #[error("line {line} of {} {problem}; write {expected}", file.display())]
    #[non_exhaustive]
    Line {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        problem: String,
        /// The expected columns.
        expected: &'static str,
    },
    /// A centreline's file contains points that are not marked as a curve.
    #[error("{} holds a markup of type {found}, which is no curve; if the order of its points is that of the line, \
             choose line 0", file.display())]
    #[non_exhaustive]
    NotACurve {
        /// The file.
        file: PathBuf,
        /// The type that the file names.
        found: String,
    },
    /// A centreline's file contains several lines, and the options choose none.
    #[error("{} holds {count} lines; choose one from 0 to {}", file.display(), count - 1)]
    #[non_exhaustive]
    SeveralLines {
        /// The file.
        file: PathBuf,
        /// The number of lines in the file.
        count: usize,
    },
    /// The options choose a line that the file does not have.
    #[error("{} has no line {line}, but {count}, counted from 0; choose one of them", file.display())]
    #[non_exhaustive]
    NoSuchLine {
        /// The file.
        file: PathBuf,
        /// The chosen line.
        line: usize,
        /// The number of lines in the file.
        count: usize,
    },
    /// The header and the data may be in two files.
    #[error("{} may have its data in a second file; load both from a folder, or save the segmentation as one file, \
             .nii.gz, .nrrd or .mha", file.display())]
    #[non_exhaustive]
    InTwoFiles {
        /// The file.
        file: PathBuf,
    },
    /// The file does not state the position of its voxels.
    #[error("{} does not say where its voxels are ({missing}); save it again with a position, or set \
             Options::allow_no_position, which puts its first voxel at the origin", file.display())]
    #[non_exhaustive]
    NoPosition {
        /// The file.
        file: PathBuf,
        /// What is missing.
        missing: String,
    },
    /// The content is invalid in the file's format.
    #[error("{} is not a valid {format} file ({reason}); export it again", file.display())]
    #[non_exhaustive]
    Broken {
        /// The file.
        file: PathBuf,
        /// The format that its name promises.
        format: &'static str,
        /// What is wrong, with the line number in text files.
        reason: String,
    },
    /// The content is of another format than the name promises.
    #[error("{} holds {found}, not {format}; give it the extension of what it holds", file.display())]
    #[non_exhaustive]
    Misnamed {
        /// The file.
        file: PathBuf,
        /// The format that its name promises.
        format: &'static str,
        /// The format that its first bytes indicate.
        found: &'static str,
    },
    /// The file contains no triangle.
    #[error("{} holds no triangles{}; export the surface, not only its points", file.display(), without_area(*skipped_faces))]
    #[non_exhaustive]
    Empty {
        /// The file.
        file: PathBuf,
        /// The number of faces; none has an area.
        skipped_faces: usize,
    },
    /// Reading would take more memory than the options allow.
    #[error("reading {} would take {} MiB of memory, but {} MiB are allowed; crop it or make it coarser, \
             or raise Options::memory_limit", file.display(), bytes.div_ceil(MIB), limit / MIB)]
    #[non_exhaustive]
    TooLarge {
        /// The file.
        file: PathBuf,
        /// An upper bound on the bytes that reading would take.
        bytes: u64,
        /// The bytes that are allowed.
        limit: u64,
    },
    /// A label map has no voxel with the requested label.
    #[error("{} has no voxel with label {label}, but with {}; choose one of them", file.display(), list_labels(present))]
    #[non_exhaustive]
    NoSuchLabel {
        /// The file.
        file: PathBuf,
        /// The requested label.
        label: u32,
        /// The labels of the voxels, 0 included, in ascending order; the lowest 1000 if there are
        /// more.
        present: Vec<u32>,
    },
    /// The options request a label, but a file of triangles has none.
    #[error("{} holds triangles without labels ({format}); ask for no label instead of {label}, or give the segmentation",
            file.display())]
    #[non_exhaustive]
    WithoutLabels {
        /// The file.
        file: PathBuf,
        /// The format that its name promises.
        format: &'static str,
        /// The requested label.
        label: u32,
    },
    /// Labels are listed of a file of triangles, which has none.
    #[error("{} holds triangles without labels ({format}); give the segmentation", file.display())]
    #[non_exhaustive]
    NoLabels {
        /// The file.
        file: PathBuf,
        /// The format that its name promises.
        format: &'static str,
    },
    /// All voxels of a label map are 0.
    #[error("{} holds no segment, because all its voxels are 0; export the segmentation again", file.display())]
    #[non_exhaustive]
    NothingSegmented {
        /// The file.
        file: PathBuf,
    },
    /// The voxels are the values of an image, not labels.
    #[error("{} holds {}; give the segmentation of the image", file.display(), no_labels(*number))]
    #[non_exhaustive]
    NotLabels {
        /// The file.
        file: PathBuf,
        /// The value of a voxel: not a whole number, negative, or beyond 32 bits.
        number: f64,
    },
    /// A vertex is not finite, in the file or after scaling.
    #[error("vertex {index} of {} is not finite ({}, {}, {}; scale {scale}); {advice}",
            file.display(), place[0], place[1], place[2])]
    #[non_exhaustive]
    NotFinite {
        /// The file.
        file: PathBuf,
        /// The vertex, counted from 0.
        index: usize,
        /// Its coordinates in the file.
        place: [f64; 3],
        /// The requested scale.
        scale: f64,
        /// What to change.
        advice: &'static str,
    },
    /// The scale is not a positive number.
    #[error(
        "the scale is {scale}; give a positive number, for example 1000 for metres to millimetres"
    )]
    #[non_exhaustive]
    Scale {
        /// The requested scale.
        scale: f64,
    },
}

/// Bytes of a mebibyte.
const MIB: u64 = 1 << 20;

/// Describes the voxels of a file that has this value.
fn no_labels(number: f64) -> String {
    if number < 0.0 && number.fract() == 0.0 {
        format!("a voxel of {number}, and labels are at least 0 (-1 is read as background)")
    } else {
        format!("an image, in which a voxel is {number}, and not labels")
    }
}

/// Explains why a file with faces has no triangles.
fn without_area(skipped_faces: usize) -> String {
    match skipped_faces {
        0 => String::new(),
        1 => ", but a face without area".into(),
        _ => format!(", but {skipped_faces} faces without area"),
    }
}

/// Lists the first ten labels, for a message.
pub fn list_labels(labels: &[u32]) -> String {
    const SHOWN: usize = 10;
    let more = if labels.len() > SHOWN { ", ..." } else { "" };
    labels.iter().take(SHOWN).map(u32::to_string).collect::<Vec<_>>().join(", ") + more
}

/// The formats that optional features add, for an error message.
const SURFACES: &str = if cfg!(feature = "centrelines") { ", in .vtp or .vtk" } else { "" };
const LABEL_MAPS: &str = if cfg!(feature = "label-maps") {
    ", or a label map that ends in .nii, .nii.gz, .hdr, .nrrd, .nhdr, .mha or .mhd"
} else {
    ""
};
