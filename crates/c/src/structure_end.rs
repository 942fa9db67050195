//! The end of a motion of a structure.

/// Where a structure of a scene is at the end of a motion: at a pose, or with other vertices.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_structure_end {
    /// The structure.
    pub structure: usize,
    /// The pose to which it moves as a whole, or NULL.
    pub pose: *const f64,
    /// The places to which its vertices move, in the mesh's frame, or NULL.
    pub vertices: *const f64,
    /// How many vertices there are; 0 with a pose.
    pub vertex_count: usize,
}
