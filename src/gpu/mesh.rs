//! A mesh in the device's memory, in as many parts as its largest buffer requires.

use super::layout::{FACE_VECTORS, THREADS};
use super::opened::Opened;
use crate::distance::Vec3;
use crate::distance::lanes::Lane;
use crate::mesh::{Mesh, SearchFrame};
use crate::threads::each;
use gpu_batch::Precision;
use gpu_batch::wgpu::{BindGroup, Buffer, BufferUsages};

/// Numbers per bounding sphere of a triangle, and per face.
const SPHERE: u64 = 4;
const FACE: u64 = 4 * FACE_VECTORS as u64;

/// The mesh in the search frame: moved to its centre and scaled to coordinates near 1.
#[derive(Debug)]
pub(super) struct DeviceMesh {
    pub parts: Vec<DevicePart>,
    is_current: bool,
}

/// A part: consecutive triangles.
#[derive(Debug)]
pub(super) struct DevicePart {
    /// The index of the first triangle in the mesh, and the number of triangles.
    pub first: u32,
    pub triangles: u32,
    pub spheres: Buffer,
    pub faces: Buffer,
    /// The mesh's vertices of these triangles, sorted, so that an upload reads memory in order.
    vertices: Vec<u32>,
    pub vertex_buffer: Buffer,
    group: BindGroup,
}

impl DeviceMesh {
    /// Allocates a mesh in parts of at most `most` triangles, or as many as a buffer holds. If
    /// memory runs out, the device's failures report it.
    pub(super) fn new(gpu: &Opened, mesh: &Mesh, most: usize) -> Self {
        let fit = (gpu.device.largest_binding() / (FACE * gpu.device.precision().size())) as usize;
        let mut places = vec![u32::MAX; mesh.vertices().len()];
        let mut parts = Vec::new();
        let mut first = 0;
        for part in mesh.indices().chunks(most.min(fit).max(1)) {
            parts.push(DevicePart::new(gpu, first, part, &mut places));
            first += part.len() as u32;
        }
        Self { parts, is_current: false }
    }

    /// Marks the uploaded vertices as stale.
    pub(super) fn invalidate(&mut self) {
        self.is_current = false;
    }

    /// Uploads the vertices if they are stale; the device computes the rest. A failure shows in the
    /// query that follows.
    pub(super) fn update(&mut self, gpu: &Opened, frame: &SearchFrame, mesh: &Mesh) {
        if std::mem::replace(&mut self.is_current, true) {
            return;
        }
        let mut encoder = gpu.device.raw().create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&gpu.prepare);
        let mut bytes = Vec::new();
        for part in &self.parts {
            match gpu.device.precision() {
                Precision::F32 => part.write(frame, mesh, f32::to_ne_bytes, &mut bytes),
                Precision::F64 => part.write(frame, mesh, f64::to_ne_bytes, &mut bytes),
            }
            gpu.device.queue().write_buffer(&part.vertex_buffer, 0, &bytes);
            pass.set_bind_group(0, &part.group, &[]);
            gpu.device.dispatch(&mut pass, part.triangles.div_ceil(THREADS));
        }
        drop(pass);
        gpu.device.queue().submit([encoder.finish()]);
    }

    /// The number of triangles.
    pub(super) fn triangles(&self) -> u64 {
        self.parts.iter().map(|part| u64::from(part.triangles)).sum()
    }
}

impl DevicePart {
    /// `places` maps each vertex of the mesh to its index in the part. All entries are unset before
    /// and after.
    fn new(gpu: &Opened, first: u32, triangles: &[[u32; 3]], places: &mut [u32]) -> Self {
        let indices = triangles.as_flattened();
        let mut vertices = Vec::new();
        for &index in indices {
            if std::mem::replace(&mut places[index as usize], 0) == u32::MAX {
                vertices.push(index);
            }
        }
        vertices.sort_unstable();
        for (place, &vertex) in (0..).zip(&vertices) {
            places[vertex as usize] = place;
        }
        let bytes: Vec<_> =
            indices.iter().flat_map(|&index| places[index as usize].to_ne_bytes()).collect();
        for &vertex in &vertices {
            places[vertex as usize] = u32::MAX;
        }

        let (device, count) = (&gpu.device, triangles.len() as u64);
        let size = device.precision().size();
        let uploaded = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let vertex_buffer = device.buffer(vertices.len() as u64 * 3 * size, uploaded);
        let index_buffer = device.buffer(bytes.len() as u64, uploaded);
        let spheres = device.buffer(count * SPHERE * size, BufferUsages::STORAGE);
        let faces = device.buffer(count * FACE * size, BufferUsages::STORAGE);
        device.queue().write_buffer(&index_buffer, 0, &bytes);
        let group = device.group(
            &gpu.prepare_layout,
            &[&vertex_buffer, &index_buffer, &spheres, &faces].map(Buffer::as_entire_binding),
        );
        Self {
            first,
            triangles: triangles.len() as u32,
            spheres,
            faces,
            vertices,
            vertex_buffer,
            group,
        }
    }

    /// Writes the vertices in the format of the shader.
    fn write<E: Lane, const SIZE: usize>(
        &self,
        frame: &SearchFrame,
        mesh: &Mesh,
        number: impl Fn(E) -> [u8; SIZE] + Sync + Send,
        to: &mut Vec<u8>,
    ) {
        to.resize(self.vertices.len() * 3 * SIZE, 0);
        let mut shares: Vec<_> = to
            .chunks_mut(Mesh::TASK_SIZE * 3 * SIZE)
            .zip(self.vertices.chunks(Mesh::TASK_SIZE))
            .collect();
        each(&mut shares, |_, (bytes, vertices)| {
            for (bytes, &vertex) in bytes.chunks_exact_mut(3 * SIZE).zip(*vertices) {
                let Vec3 { x, y, z } = frame.point::<E>(mesh.vertices()[vertex as usize]);
                bytes.copy_from_slice([x, y, z].map(&number).as_flattened());
            }
        });
    }
}
