//! Segmentations: a label for each voxel of a grid, and the surface of one label.

mod fault;
pub mod meta_image;
pub mod nifti;
pub mod nrrd;
mod voxels;

use crate::mesh::{Frame, Mesh};
use crate::text::shown;
use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SignedDistance, SurfaceNetsBuffer, surface_nets};
pub use fault::Fault;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, PathBuf};
use voxels::Voxels;

/// The maximum number of voxels. Their indices, with a margin around the grid, fit in 32 bits.
const MOST_VOXELS: u64 = 1 << 31;

/// The maximum number of labels that are listed: the lowest ones.
const MOST_LABELS: usize = 1000;

/// A label of a label map, and its volume.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LabelVolume {
    /// The label.
    pub label: u32,
    /// The number of voxels with this label.
    pub voxels: u64,
    /// Their volume in cubic millimetres, times the cube of the options' scale.
    pub volume: f64,
}

/// A label for each voxel, the first axis fastest, and the positions of the voxels.
pub struct Volume<'a> {
    sizes: [usize; 3],
    voxels: Voxels<'a>,
    place: Place,
    frame: Option<Frame>,
    states_unit: bool,
    /// Why the position is doubtful.
    doubt: Option<String>,
}

/// The map from a voxel's three indices to its centre in millimetres: the rows of a 3x4 matrix.
#[derive(Clone, Copy)]
struct Place([[f64; 4]; 3]);

impl Place {
    /// # Errors
    /// The matrix is not finite, or it brings all voxels into one plane.
    fn new(rows: [[f64; 4]; 3], name: &str) -> Result<Self, String> {
        let place = Self(rows);
        if !rows.iter().flatten().all(|x| x.is_finite()) {
            return Err(format!("its {name} is not finite"));
        }
        if place.turn() == 0.0 || !place.turn().is_finite() {
            return Err(format!("its {name} brings all voxels into one plane"));
        }
        Ok(place)
    }

    fn apply(&self, voxel: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * voxel[0] + row[1] * voxel[1] + row[2] * voxel[2] + row[3])
    }

    /// Returns the determinant: negative if the axes of the voxels are left-handed.
    fn turn(&self) -> f64 {
        let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = self.0;
        a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    }
}

/// Returns the map of a file that states only the spacing: the first voxel is the origin.
fn without_position([x, y, z]: [f64; 3]) -> [[f64; 4]; 3] {
    [[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]]
}

/// Returns the path of a file of voxels relative to its header, if it is in the same folder or
/// below it. The name may be quoted, and have the backslashes of Windows.
fn voxels_path(name: &str) -> Option<PathBuf> {
    let quoted = ['"', '\''].iter().find_map(|&mark| name.strip_prefix(mark)?.strip_suffix(mark));
    let path = PathBuf::from(quoted.unwrap_or(name).replace('\\', "/"));
    let is_below =
        path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    (!path.as_os_str().is_empty() && !is_list(name) && is_below).then_some(path)
}

/// Returns whether a name stands for several files: `LIST`, or a pattern such as `slice%03d.raw`.
fn is_list(name: &str) -> bool {
    let is_number =
        |rest: &str| rest.trim_start_matches(|c: char| c.is_ascii_digit()).starts_with('d');
    name.split_whitespace().next() == Some("LIST") || name.split('%').skip(1).any(is_number)
}

/// Returns the message for voxels that are not in the file, with the extension of one that has
/// them.
fn elsewhere(name: &str, extension: &str) -> String {
    let other = shown(name);
    if is_list(name) {
        format!(
            "its voxels are in several files, '{other}', which cannot be read; save one {extension}"
        )
    } else {
        format!(
            "its voxels are in a second file, '{other}'; keep it beside, or save one {extension}"
        )
    }
}

/// Returns the number of voxels, if it is within the limit.
fn count(sizes: [usize; 3]) -> Result<usize, String> {
    let count = sizes.iter().try_fold(1_u64, |product, &size| product.checked_mul(size as u64));
    match count {
        Some(0) => Err("it has no voxels".into()),
        Some(count) if count <= MOST_VOXELS => Ok(count as usize),
        _ => Err(format!(
            "its {} x {} x {} voxels are too many; crop it",
            sizes[0], sizes[1], sizes[2]
        )),
    }
}

/// Inside or outside. The surface passes half-way between the two, since a label has no finer
/// information.
#[derive(Clone, Copy)]
struct Voxel(bool);

impl From<Voxel> for f32 {
    fn from(voxel: Voxel) -> Self {
        if voxel.0 { -1.0 } else { 1.0 }
    }
}

impl SignedDistance for Voxel {
    fn is_negative(self) -> bool {
        self.0
    }
}

impl Volume<'_> {
    /// Returns the surface of the voxels with this label, or of all that are not 0, if it takes at
    /// most `limit` bytes.
    pub fn surface(&self, label: Option<u32>, limit: u64) -> Result<Mesh, Fault> {
        let is_inside = |found: u32| label.map_or(found != 0, |label| found == label);
        let mut low = [usize::MAX; 3];
        let mut high = [0; 3];
        // With a requested label, counts all labels: the error message lists them.
        let mut counts = LabelCounts::default();
        self.each_run(&mut |found, run| {
            if label.is_some() || found != 0 {
                counts.add(found, run.len());
            }
            for voxel in run.filter(|_| is_inside(found)).map(|index| self.voxel(index)) {
                low = [0, 1, 2].map(|axis| low[axis].min(voxel[axis]));
                high = [0, 1, 2].map(|axis| high[axis].max(voxel[axis]));
            }
        })?;
        let labels = counts.0.into_keys().collect();
        if low[0] == usize::MAX {
            return Err(Fault::NoneOf(labels));
        }
        let labels = if label.is_none() { labels } else { Vec::new() };
        // A margin of one outside voxel closes the surface at the border. The far sides have a
        // second one, because the faces there belong to a neighbouring block that does not exist.
        let room = [0, 1, 2].map(|axis| high[axis] - low[axis] + 4);
        // One byte for each voxel here, and the index of a vertex in the net.
        let grid = 5 * count(room)? as u64;
        let allowed =
            |bytes: u64| if bytes <= limit { Ok(()) } else { Err(Fault::TooLarge(bytes)) };
        allowed(grid)?;
        let mut voxels = vec![Voxel(false); room.iter().product()];
        self.each_run(&mut |found, run| {
            for voxel in run.filter(|_| is_inside(found)).map(|index| self.voxel(index)) {
                let [x, y, z] = [0, 1, 2].map(|axis| voxel[axis] - low[axis] + 1);
                voxels[(z * room[1] + y) * room[0] + x] = Voxel(true);
            }
        })?;
        // Memory of the surface. Each face between two unlike voxels is a quadrilateral of the net:
        // two triangles, there and in the mesh, of 48 bytes. A vertex takes 64 bytes in both, and
        // lies in a cube of eight voxels that are not all alike. Such a cube has at least three of
        // the faces, and a face is in four cubes. So there are at most 4 / 3 vertices for each
        // face.
        let faces = faces(&voxels, room);
        let vertices = faces.div_ceil(3) * 4;
        allowed(grid + 48 * faces as u64 + 64 * vertices as u64)?;
        let mut net = SurfaceNetsBuffer::default();
        net.indices.reserve_exact(6 * faces);
        net.positions.reserve_exact(vertices);
        net.normals.reserve_exact(vertices);
        net.surface_points.reserve_exact(vertices);
        net.surface_strides.reserve_exact(vertices);
        let room = room.map(|size| size as u32);
        let shape = RuntimeShape::<u32, 3>::new(room);
        surface_nets(&voxels, &shape, [0; 3], room.map(|size| size - 1), &mut net);

        let shift = low.map(|low| low as f64 - 1.0);
        let place =
            |p: &[f32; 3]| self.place.apply([0, 1, 2].map(|axis| f64::from(p[axis]) + shift[axis]));
        let turn =
            |&[a, b, c]: &[u32; 3]| if self.place.turn() < 0.0 { [a, c, b] } else { [a, b, c] };
        Ok(Mesh {
            vertices: net.positions.iter().map(place).collect(),
            triangles: net.indices.as_chunks().0.iter().map(turn).collect(),
            frame: self.frame,
            states_unit: self.states_unit,
            skipped_faces: 0,
            labels,
            doubts: self.doubt.iter().cloned().collect(),
        })
    }

    /// Returns the labels except 0 with their volumes, the lowest [`MOST_LABELS`] if there are
    /// more.
    pub fn label_volumes(&self, scale: f64) -> Result<Vec<LabelVolume>, Fault> {
        let mut counts = LabelCounts::default();
        self.each_run(&mut |label, run| {
            if label != 0 {
                counts.add(label, run.len());
            }
        })?;
        if counts.0.is_empty() {
            return Err(Fault::NoneOf(Vec::new()));
        }
        let voxel = self.place.turn().abs() * scale.powi(3);
        let volume = |(label, voxels)| LabelVolume { label, voxels, volume: voxels as f64 * voxel };
        Ok(counts.0.into_iter().map(volume).collect())
    }

    /// Passes each run of voxels with the same label, in order, to a function: the label, and the
    /// indices of the voxels.
    fn each_run(&self, see: &mut dyn FnMut(u32, Range<usize>)) -> Result<(), Fault> {
        let mut first = 0;
        self.voxels.each(&mut |labels| {
            for run in labels.chunk_by(|a, b| a == b) {
                see(run[0], first..first + run.len());
                first += run.len();
            }
        })
    }

    /// Returns the three indices of the voxel with this index.
    fn voxel(&self, index: usize) -> [usize; 3] {
        let [width, height, _] = self.sizes;
        [index % width, index / width % height, index / width / height]
    }
}

/// The number of voxels of each label, for the lowest [`MOST_LABELS`] labels.
#[derive(Default)]
struct LabelCounts(BTreeMap<u32, u64>);

impl LabelCounts {
    fn add(&mut self, label: u32, voxels: usize) {
        *self.0.entry(label).or_default() += voxels as u64;
        // The kept labels only get lower, so a dropped label is dropped whenever it comes.
        if self.0.len() > MOST_LABELS {
            self.0.pop_last();
        }
    }
}

/// Returns the number of faces between a voxel inside and a voxel outside.
fn faces(voxels: &[Voxel], [width, height, _]: [usize; 3]) -> usize {
    // The outermost voxels are outside, so a neighbour across a row's end counts as outside too.
    let along =
        |step: usize| voxels.iter().zip(&voxels[step..]).filter(|(a, b)| a.0 != b.0).count();
    along(1) + along(width) + along(width * height)
}
