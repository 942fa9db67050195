//! The result of a query on the device: for each link, the few triangles that may be the nearest.

use super::Precision;
use super::buffers::Buffers;
use super::layout::{CAPACITY, SLOT};
use super::mesh::DeviceMesh;
use gpu_batch::DeviceFailure;
use parry3d_f64::math::Real;
use std::ops::Range;

/// A triangle that may be the nearest, and its distance from the axis as the device computed it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CandidateTriangle {
    pub triangle: u32,
    pub distance: Real,
}

/// The candidates of all links.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    all: Vec<CandidateTriangle>,
    links: Vec<LinkSlots>,
}

#[derive(Clone, Debug, Default)]
struct LinkSlots {
    range: Range<usize>,
    /// Whether some candidates did not come back.
    too_many: bool,
}

impl Candidates {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.links.clear();
    }

    /// The candidates of a link, sorted by triangle, and whether some did not come back.
    pub(super) fn of(&self, link: usize) -> (&[CandidateTriangle], bool) {
        let LinkSlots { range, too_many } = &self.links[link];
        (&self.all[range.clone()], *too_many)
    }

    /// Appends the candidates of the next `links` links, as kernels/collect.wgsl wrote them for
    /// this submission.
    ///
    /// # Errors
    /// Not every block has written its mark into a slot, so the slot is no answer.
    pub(super) fn read(
        &mut self,
        mesh: &DeviceMesh,
        buffers: &Buffers,
        precision: Precision,
        submission: u32,
        links: usize,
        bytes: &[u8],
    ) -> Result<(), DeviceFailure> {
        let (found, distances) = bytes.split_at(Buffers::found_size(links, mesh) as usize);
        let (words, _) = found.as_chunks::<4>();
        let word = |place: usize| u32::from_ne_bytes(words[place]);
        let (slot_words, slot_bytes) =
            (SLOT as usize, CAPACITY as usize * precision.size() as usize);
        for link in 0..links {
            let begin = self.all.len();
            let mut too_many = false;
            for (number, part) in mesh.parts.iter().enumerate() {
                let slot = number * links + link;
                let first = slot * slot_words;
                if word(first) != submission.wrapping_mul(buffers.plan.blocks(part.triangles)) {
                    return Err(DeviceFailure::Unanswered);
                }
                let count = word(first + 1);
                too_many |= count > CAPACITY;
                let computed = precision.read(&distances[slot * slot_bytes..][..slot_bytes]);
                for (place, distance) in computed.take(count as usize).enumerate() {
                    let triangle = part.first + word(first + 2 + place);
                    self.all.push(CandidateTriangle { triangle, distance });
                }
            }
            // The kernel writes them in any order.
            self.all[begin..].sort_by_key(|candidate| candidate.triangle);
            self.links.push(LinkSlots { range: begin..self.all.len(), too_many });
        }
        Ok(())
    }
}
