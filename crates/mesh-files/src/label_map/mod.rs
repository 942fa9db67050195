//! Segmentations: a number for each voxel of a grid, and the surface of one label.

pub mod nifti;
pub mod nrrd;
mod voxels;

use crate::mesh::{Frame, Mesh};
use fast_surface_nets::ndshape::RuntimeShape;
use fast_surface_nets::{SignedDistance, SurfaceNetsBuffer, surface_nets};
use std::collections::BTreeSet;

/// The most voxels that are read; their numbers, with room around, fit in 32 bits.
const MOST_VOXELS: u64 = 1 << 31;

/// Why a label map gave no surface.
pub enum Fault {
    /// What its format asks for is not there.
    Broken(String),
    /// A voxel holds this, which is no label.
    NotALabel(f64),
    /// No voxel is in the surface; the voxels have these labels.
    NoneOf(BTreeSet<u32>),
}

impl From<String> for Fault {
    fn from(reason: String) -> Self {
        Self::Broken(reason)
    }
}

impl From<&str> for Fault {
    fn from(reason: &str) -> Self {
        Self::Broken(reason.into())
    }
}

/// A label for each voxel, the first axis fastest, and where the voxels are.
pub struct Volume {
    sizes: [usize; 3],
    labels: Vec<u32>,
    place: Place,
    frame: Option<Frame>,
}

/// From a voxel's three numbers to its centre in millimetres: the rows of a 3x4 matrix.
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

    /// The determinant: negative where the axes of the voxels are left-handed.
    fn turn(&self) -> f64 {
        let [[a, b, c, _], [d, e, f, _], [g, h, i, _]] = self.0;
        a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    }
}

/// The number of voxels, if it is one that can be read.
fn count(sizes: [usize; 3]) -> Result<usize, String> {
    let count = sizes.iter().try_fold(1_u64, |product, &size| product.checked_mul(size as u64));
    match count {
        Some(0) => Err("it has no voxels".into()),
        Some(count) if count <= MOST_VOXELS => Ok(count as usize),
        _ => Err(format!("its {} x {} x {} voxels are too many; crop it", sizes[0], sizes[1], sizes[2])),
    }
}

/// Inside or outside. Surfaces pass half-way between the two, since the label says no more.
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

impl Volume {
    /// The surface of the voxels with this label, or of all that are not 0.
    pub fn surface(&self, label: Option<u32>) -> Result<Mesh, Fault> {
        let is_inside = |found: u32| label.map_or(found != 0, |label| found == label);
        let [width, height, _] = self.sizes;
        let mut low = [usize::MAX; 3];
        let mut high = [0; 3];
        for index in (0..self.labels.len()).filter(|&index| is_inside(self.labels[index])) {
            let voxel = [index % width, index / width % height, index / width / height];
            low = [0, 1, 2].map(|axis| low[axis].min(voxel[axis]));
            high = [0, 1, 2].map(|axis| high[axis].max(voxel[axis]));
        }
        if low[0] == usize::MAX {
            return Err(Fault::NoneOf(self.labels.iter().copied().collect()));
        }
        // One voxel of outside all around closes the surface at the border; a second one at the far sides, because the
        // faces there belong to a neighbouring block that does not exist.
        let room = [0, 1, 2].map(|axis| high[axis] - low[axis] + 4);
        count(room)?;
        let mut voxels = vec![Voxel(false); room.iter().product()];
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                let from = (z * height + y) * width;
                let to = ((z - low[2] + 1) * room[1] + y - low[1] + 1) * room[0] + 1;
                let row = &self.labels[from + low[0]..=from + high[0]];
                voxels[to..].iter_mut().zip(row).for_each(|(voxel, &found)| *voxel = Voxel(is_inside(found)));
            }
        }
        let room = room.map(|size| size as u32);
        let mut net = SurfaceNetsBuffer::default();
        let shape = RuntimeShape::<u32, 3>::new(room);
        surface_nets(&voxels, &shape, [0; 3], room.map(|size| size - 1), &mut net);

        let shift = low.map(|low| low as f64 - 1.0);
        let place = |p: &[f32; 3]| self.place.apply([0, 1, 2].map(|axis| f64::from(p[axis]) + shift[axis]));
        let turn = |&[a, b, c]: &[u32; 3]| if self.place.turn() < 0.0 { [a, c, b] } else { [a, b, c] };
        Ok(Mesh {
            vertices: net.positions.iter().map(place).collect(),
            triangles: net.indices.as_chunks().0.iter().map(turn).collect(),
            frame: self.frame,
        })
    }
}
