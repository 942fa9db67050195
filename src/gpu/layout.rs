//! What the host and the shaders both know: sizes, and records.

use gpu_batch::record;
use parry3d_f64::math::Real;

/// Threads of a workgroup of a query.
pub(super) const THREADS: u32 = 256;
/// Links of a workgroup at most.
pub(super) const MOST_LINKS: u32 = 32;
/// Triangles of a part that the first limit of a link is taken from, at most.
pub(super) const SAMPLES: u32 = 1 << 14;
/// Candidates of a link and part that come back.
pub(super) const CAPACITY: u32 = 64;
/// Words of a link and part: what says that it was written, how many candidates there are, and
/// their triangles.
pub(super) const SLOT: u32 = 2 + CAPACITY;
/// Bytes for the bounds of a block and a link.
pub(super) const BLOCK_BOUNDS: u64 = 8;

/// Vectors of four numbers that a triangle takes in memory (shared/face_record.wgsl).
pub(super) const FACE_VECTORS: u32 = 4;
/// More than any distance near one.
pub(super) const FAR: f32 = f32::from_bits((127 + 100) << 23);

record! {
    /// What the kernels know of the links of a round and a part of the mesh.
    pub(super) struct Round {
        /// The first link, and how many there are.
        pub first_link: u32,
        pub links: u32,
        /// How many links a workgroup takes, and how many triangles each of its threads.
        pub links_at_once: u32,
        pub triangles_at_once: u32,
        /// The triangles of this part, its first block of all blocks, and how many blocks all parts have.
        pub triangles: u32,
        pub first_block: u32,
        pub blocks: u32,
        /// Where the candidates of the first link and this part go.
        pub first_slot: u32,
        /// The number of the submission.
        pub submission: u32,
    }
}

record! {
    /// What shaders/shared/query.wgsl reads of a link.
    pub(super) struct LinkRecord {
        pub start: [Real; 3],
        pub length: Real,
        /// From the start, as the axis.
        pub end: [Real; 3],
        pub radius: Real,
        pub axis: [Real; 3],
        pub error: Real,
        pub flat_start: Real,
        pub flat_end: Real,
    }
}
