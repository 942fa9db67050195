//! Sizes and records that host and shaders share.

use gpu_batch::record;
use parry3d_f64::math::Real;

/// Threads per workgroup of a query.
pub(super) const THREADS: u32 = 256;
/// The most links per workgroup.
pub(super) const MOST_LINKS: u32 = 32;
/// The most triangles of a part that are sampled for the first limit of a link.
pub(super) const SAMPLES: u32 = 1 << 14;
/// The most candidates per link and part that come back.
pub(super) const CAPACITY: u32 = 64;
/// Words per link and part: the submission's mark, the number of candidates, and their triangles.
pub(super) const SLOT: u32 = 2 + CAPACITY;
/// Bytes for the bounds of one block and link.
pub(super) const BLOCK_BOUNDS: u64 = 8;

/// Vectors of four numbers per triangle (shared/face_record.wgsl).
pub(super) const FACE_VECTORS: u32 = 4;
/// A limit that excludes nothing: larger than any distance in a search frame, where coordinates are
/// near 1.
pub(super) const UNBOUNDED: f32 = f32::from_bits((127 + 100) << 23);

record! {
    /// The kernels' parameters for one round of links and one part of the mesh.
    pub(super) struct Round {
        /// The first link, and the number of links.
        pub first_link: u32,
        pub links: u32,
        /// Links per workgroup, and triangles per thread.
        pub links_at_once: u32,
        pub triangles_at_once: u32,
        /// The triangles of this part, the index of its first block, and the number of blocks of
        /// all parts.
        pub triangles: u32,
        pub first_block: u32,
        pub blocks: u32,
        /// The slot of the candidates of the first link and this part.
        pub first_slot: u32,
        /// The number of the submission.
        pub submission: u32,
    }
}

record! {
    /// A link, as shaders/shared/query.wgsl reads it.
    pub(super) struct LinkRecord {
        pub start: [Real; 3],
        pub length: Real,
        /// Relative to the start, as the axis is.
        pub end: [Real; 3],
        pub radius: Real,
        pub axis: [Real; 3],
        pub error: Real,
        pub flat_start: Real,
        pub flat_end: Real,
    }
}
