//! The tree in the device's memory, and its refit.
//!
//! # Algorithm
//! 1. **Upload**, once: the topology, and the triangles as indices of vertices.
//! 2. **Refit**, at first and whenever the vertices have moved: upload the vertices in the search
//!    frame; fill the triangles (`corners`); fit the boxes of the nodes level by level, the lowest
//!    first (`refit`). A level reads boxes of lower levels only.

use super::compiled::SearchKernels;
use super::kernels::{REFIT_THREADS, RefitLevel};
use super::tree::SearchTree;
use crate::distance::Vec3;
use crate::gpu::opened::Opened;
use crate::mesh::{Mesh, SearchFrame};
use crate::threads::each;
use gpu_batch::wgpu::{BindGroup, Buffer, BufferUsages};
use gpu_batch::{Device, Record};

/// Bytes of a node, a triangle and a vertex.
const NODE: u64 = 64;
const TRIANGLE: u64 = 48;
const VERTEX: u64 = 12;
/// Items that are written to a buffer at once.
const AT_ONCE: usize = 1 << 18;

/// The mesh as a batch searches it.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a> {
    pub gpu: &'a Opened,
    pub kernels: &'a SearchKernels,
    pub tree: &'a DeviceTree,
    pub frame: &'a SearchFrame,
}

/// A tree in the device's memory.
#[derive(Debug)]
pub(super) struct DeviceTree {
    pub nodes: Buffer,
    pub triangles: Buffer,
    pub(super) vertices: Buffer,
    corners_group: BindGroup,
    refit_group: BindGroup,
    /// The nodes of each level, the lowest first.
    levels: Vec<u32>,
    is_current: bool,
    bytes: Vec<u8>,
}

impl DeviceTree {
    /// Whether the device has buffers for the triangles and the vertices.
    pub(super) fn has_room(gpu: &Opened, mesh: &Mesh) -> bool {
        let sizes = [mesh.len() as u64 * TRIANGLE, mesh.vertices().len() as u64 * VERTEX];
        sizes.iter().all(|&size| size <= gpu.device.largest_binding())
    }

    /// Uploads a tree. `None` if the device has no buffer that large. If memory runs out, the
    /// device's failures report it.
    pub(super) fn new(
        gpu: &Opened,
        kernels: &SearchKernels,
        mesh: &Mesh,
        tree: &SearchTree,
    ) -> Option<Self> {
        let device = &gpu.device;
        let [nodes, triangles, vertices] = [
            tree.nodes.len() as u64 * NODE,
            mesh.len() as u64 * TRIANGLE,
            mesh.vertices().len() as u64 * VERTEX,
        ];
        if nodes > device.largest_binding() || !Self::has_room(gpu, mesh) {
            return None;
        }
        let uploaded = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        // Tests read the boxes.
        let nodes = device.buffer(nodes, uploaded | BufferUsages::COPY_SRC);
        let triangles = device.buffer(triangles, BufferUsages::STORAGE);
        let vertices = device.buffer(vertices, uploaded);
        let corners_of = device.buffer(mesh.len() as u64 * 16, uploaded);
        let order = device.buffer(tree.nodes.len() as u64 * 4, uploaded);
        write(device, &nodes, &tree.nodes, |node| {
            let ([child0, child1], [lowest0, lowest1]) = (node.children, node.lowest);
            // Each vector of three numbers and the word after it.
            let words = [0, 0, 0, child0, 0, 0, 0, lowest0, 0, 0, 0, child1, 0, 0, 0, lowest1];
            words.map(u32::to_ne_bytes)
        });
        write(device, &corners_of, &tree.triangles, |&triangle| {
            let [a, b, c] = mesh.indices()[triangle as usize];
            [a, b, c, triangle].map(u32::to_ne_bytes)
        });
        write(device, &order, &tree.by_height, |&node| [node.to_ne_bytes()]);

        let stride = device.uniform_stride::<RefitLevel>() as usize;
        let (mut records, mut levels, mut first) = (Vec::new(), Vec::new(), 0);
        for &end in &tree.heights {
            let nodes = (end - first) as u32;
            RefitLevel { first: first as u32, nodes }.write(device.precision(), &mut records);
            records.resize(records.len().next_multiple_of(stride), 0);
            levels.push(nodes);
            first = end;
        }
        let level_buffer =
            device.buffer(records.len() as u64, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        device.queue().write_buffer(&level_buffer, 0, &records);
        let level = device.uniform_binding::<RefitLevel>(&level_buffer);
        let [order, triangles_binding, nodes_binding] =
            [&order, &triangles, &nodes].map(Buffer::as_entire_binding);
        let refit_group =
            device.group(&kernels.refit_layout, &[level, order, triangles_binding, nodes_binding]);
        let corners_group = device.group(
            &kernels.corners_layout,
            &[&vertices, &corners_of, &triangles].map(Buffer::as_entire_binding),
        );
        Some(Self {
            nodes,
            triangles,
            vertices,
            corners_group,
            refit_group,
            levels,
            is_current: false,
            bytes: Vec::new(),
        })
    }

    /// Marks the vertices as stale.
    pub(super) fn invalidate(&mut self) {
        self.is_current = false;
    }

    /// Step 2, if the vertices are stale. A failure shows in the query that follows.
    pub(super) fn update(
        &mut self,
        gpu: &Opened,
        kernels: &SearchKernels,
        frame: &SearchFrame,
        mesh: &Mesh,
    ) {
        if std::mem::replace(&mut self.is_current, true) {
            return;
        }
        let device = &gpu.device;
        place_vertices(frame, mesh, &mut self.bytes);
        device.queue().write_buffer(&self.vertices, 0, &self.bytes);
        let mut encoder = device.raw().create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&kernels.corners);
        pass.set_bind_group(0, &self.corners_group, &[]);
        device.dispatch(&mut pass, (mesh.len() as u32).div_ceil(REFIT_THREADS));
        pass.set_pipeline(&kernels.refit);
        for (level, &nodes) in (0..).zip(&self.levels) {
            let offset = level * device.uniform_stride::<RefitLevel>() as u32;
            pass.set_bind_group(0, &self.refit_group, &[offset]);
            device.dispatch(&mut pass, nodes.div_ceil(REFIT_THREADS));
        }
        drop(pass);
        device.queue().submit([encoder.finish()]);
    }
}

/// Writes the words of each item to a buffer.
fn write<T, const WORDS: usize>(
    device: &Device,
    buffer: &Buffer,
    items: &[T],
    words: impl Fn(&T) -> [[u8; 4]; WORDS],
) {
    let (mut bytes, mut offset) = (Vec::new(), 0);
    for items in items.chunks(AT_ONCE) {
        bytes.clear();
        items.iter().for_each(|item| bytes.extend_from_slice(words(item).as_flattened()));
        device.queue().write_buffer(buffer, offset, &bytes);
        offset += bytes.len() as u64;
    }
}

/// Writes the vertices in the search frame.
fn place_vertices(frame: &SearchFrame, mesh: &Mesh, to: &mut Vec<u8>) {
    const SIZE: usize = VERTEX as usize;
    to.resize(mesh.vertices().len() * SIZE, 0);
    let mut shares: Vec<_> = to
        .chunks_mut(Mesh::TASK_SIZE * SIZE)
        .zip(mesh.vertices().chunks(Mesh::TASK_SIZE))
        .collect();
    each(&mut shares, |_, (bytes, vertices)| {
        for (bytes, &vertex) in bytes.chunks_exact_mut(SIZE).zip(*vertices) {
            let Vec3 { x, y, z } = frame.point::<f32>(vertex);
            bytes.copy_from_slice([x, y, z].map(f32::to_ne_bytes).as_flattened());
        }
    });
}
