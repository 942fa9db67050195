//! The command's options, and its usage errors in one line.

use crate::messages;
use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Parser, ValueEnum};
use mesh_files::Frame;
use std::path::{Path, PathBuf};

/// Which way x and y point.
#[derive(Clone, Copy, ValueEnum)]
pub enum Axes {
    /// Left, posterior, superior: DICOM, ITK
    Lps,
    /// Right, anterior, superior: NIfTI, FreeSurfer
    Ras,
}

impl From<Axes> for Frame {
    fn from(axes: Axes) -> Self {
        match axes {
            Axes::Lps => Self::Lps,
            Axes::Ras => Self::Ras,
        }
    }
}

/// How far is a continuum robot from a wall, link by link?
///
/// All lengths are in the unit of the mesh. Links, segments, triangles and lines count from 0.
#[derive(Parser)]
#[command(name = "clearance", version, after_help = EXIT_STATUS)]
pub struct Options {
    /// The wall: an STL, OBJ, PLY, .vtp or .vtk file, or a segmentation in NIfTI, NRRD or
    /// MetaImage (in millimetres)
    #[arg(long, value_name = "FILE")]
    pub mesh: PathBuf,
    /// The label of the wall in a segmentation [default: all that are not 0, as one wall]
    #[arg(long, value_name = "NUMBER", value_parser = |s: &str| whole::<u32>(s))]
    pub label: Option<u32>,
    /// List the labels of the segmentation with their volumes, and stop
    #[arg(long, conflicts_with_all = ["centreline", "shapes", "inside"])]
    pub labels: bool,
    /// Accept a segmentation that does not state the position of its voxels: its first voxel
    /// becomes the origin
    #[arg(long)]
    pub allow_no_position: bool,
    /// Points along the robot, from base to tip. A text file (.csv, .tsv, .txt, .dat) has a line
    /// for each point: x,y,z and optionally the radius of the segment that begins there. A heading
    /// is optional: it names x,y,z, and r,a,s or l,p,s state the frame; a radius or diameter may
    /// have any column. A line that begins with # is skipped unless it is such a heading or states
    /// the frame. Or a .vtp, .vtk or .mrk.json file
    #[arg(
        long,
        visible_alias = "centerline",
        value_name = "FILE",
        required_unless_present_any = ["shapes", "labels"]
    )]
    pub centreline: Option<PathBuf>,
    /// The line to take from a .vtp, .vtk or .mrk.json file with several. A list of fiducials needs
    /// it too
    #[arg(long, value_name = "NUMBER", value_parser = |s: &str| whole::<usize>(s))]
    pub line: Option<usize>,
    /// Many robots instead of one: lines of shape,x,y,z and optionally the radius. Consecutive
    /// lines with the same number of a shape are one robot. Prints CSV, a line for each shape
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with_all = ["centreline", "tolerance", "plot", "prove"]
    )]
    pub shapes: Option<PathBuf>,
    /// The radius of all segments, in the unit of the mesh. A text file with a column of radii or
    /// diameters states them itself: then leave this out, or the column
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, value_parser = length)]
    pub radius: Option<f64>,
    /// Multiply the robot's coordinates and the radii in its file (not --radius), for example by
    /// 1000 for metres to millimetres
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true, value_parser = positive)]
    pub scale: Option<f64>,
    /// The frame of the centreline, if it is not the frame of the mesh and the file does not state
    /// it. x and y change sign between the two
    #[arg(long, conflicts_with = "pose", ignore_case = true)]
    pub frame: Option<Axes>,
    /// The frame of the mesh, if its file does not state it
    #[arg(long, value_name = "FRAME", ignore_case = true)]
    pub mesh_frame: Option<Axes>,
    /// A file with a 4x4 matrix, row by row, that brings the robot into the frame of the mesh
    #[arg(long, value_name = "FILE")]
    pub pose: Option<PathBuf>,
    /// Decide whether the robot is farther than this from the wall everywhere: a line with the
    /// verdict, and exit status 1 if it is not
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, value_parser = length)]
    pub margin: Option<f64>,
    /// Decide whether every link is inside the mesh, and keeps --margin if that is given: a line
    /// with the verdict, and exit status 1 if not. A link that touches the mesh or crosses an
    /// opening is not inside
    #[arg(long)]
    pub inside: bool,
    /// Also bound the clearance of the smooth curve through the points, between two bounds at most
    /// this far apart. --margin and --prove are then about the curve
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, value_parser = positive)]
    pub tolerance: Option<f64>,
    /// Draw the clearance along the robot into an SVG or PNG file
    #[arg(long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(picture))]
    pub plot: Option<PathBuf>,
    /// Write a CSV file with a line for each link, or for each shape of --shapes
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write a proof that the robot keeps --margin, and beside it the mesh as FILE.obj. Prints the
    /// command that checks the two
    #[arg(
        long,
        value_name = "FILE",
        requires = "margin",
        value_parser = PathBufValueParser::new().try_map(proof)
    )]
    pub prove: Option<PathBuf>,
    /// Print JSON, with all digits
    #[arg(long)]
    pub json: bool,
}

const EXIT_STATUS: &str = "Exit status: 0, or 1 if --margin is not kept or cannot be proven, or \
                           if a link is not --inside, or 2 after an error.";

impl Options {
    /// Reads the command line. Help goes to standard output; a usage error is one line on standard
    /// error, and exit status 2.
    pub fn read() -> Self {
        Self::try_parse().unwrap_or_else(|error| {
            if error.use_stderr() {
                let text = messages::in_one_line(&first_paragraph(&error.to_string()));
                eprintln!("{text} (--help lists the options)");
                std::process::exit(2);
            }
            error.exit()
        })
    }
}

/// Returns the first paragraph of an error of clap, and its tip.
fn first_paragraph(text: &str) -> String {
    let mut lines = text.lines().map(str::trim);
    let paragraph: Vec<_> = lines.by_ref().take_while(|line| !line.is_empty()).collect();
    let tip = lines.find_map(|line| line.strip_prefix("tip: ")).map(|tip| format!("; {tip}"));
    paragraph.join(" ") + &tip.unwrap_or_default()
}

fn whole<T: std::str::FromStr>(text: &str) -> Result<T, &'static str> {
    text.parse().map_err(|_| "write a whole number of at least 0")
}

fn length(text: &str) -> Result<f64, &'static str> {
    let length = text.parse().ok().filter(|length| (0.0..f64::INFINITY).contains(length));
    length.ok_or("write a number that is at least 0, with a point for decimals")
}

fn positive(text: &str) -> Result<f64, &'static str> {
    let number = text.parse().ok().filter(|&number| number > 0.0 && number < f64::INFINITY);
    number.ok_or("write a number greater than 0, with a point for decimals")
}

fn picture(path: PathBuf) -> Result<PathBuf, &'static str> {
    let is_known = has_ending(&path, "svg") || has_ending(&path, "png");
    if is_known { Ok(path) } else { Err("write a name that ends in .svg or .png") }
}

/// Whether a file name has this ending, in any case.
pub fn has_ending(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case(wanted))
}

fn proof(path: PathBuf) -> Result<PathBuf, &'static str> {
    if path.file_stem().is_none() || has_ending(&path, "obj") {
        Err("write the name of a file, such as proof.txt; the mesh is written beside it as .obj")
    } else {
        Ok(path)
    }
}
