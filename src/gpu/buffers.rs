//! The device buffers of a query, reused by every query with the same plan.

use super::layout::{BLOCK_BOUNDS, CAPACITY, LinkRecord, Round, SLOT};
use super::mesh::DeviceMesh;
use super::opened::Opened;
use super::plan::Plan;
use gpu_batch::wgpu::{BindGroup, Buffer, BufferUsages};
use gpu_batch::{Clock, Precision, READINGS, Record};

/// Buffers for any query with this plan.
pub(super) struct Buffers {
    pub plan: Plan,
    pub rounds: Buffer,
    pub links: Buffer,
    pub limits: Buffer,
    pub found: Buffer,
    pub distances: Buffer,
    pub readback: Buffer,
    pub clock: Option<Clock>,
    /// One per part of the mesh.
    pub groups: Vec<BindGroup>,
}

impl Buffers {
    /// Bytes of the results of `links` links, without the distances.
    pub(super) fn found_size(links: usize, mesh: &DeviceMesh) -> u64 {
        (links * mesh.parts.len()) as u64 * u64::from(SLOT) * 4
    }

    /// Bytes of the distances.
    pub(super) fn distances_size(links: usize, mesh: &DeviceMesh, precision: Precision) -> u64 {
        (links * mesh.parts.len()) as u64 * u64::from(CAPACITY) * precision.size()
    }

    pub(super) fn new(gpu: &Opened, mesh: &DeviceMesh, plan: Plan) -> Self {
        let device = &gpu.device;
        let (links, parts) = (plan.links_per_submission as u64, mesh.parts.len() as u64);
        let rounds = links.div_ceil(u64::from(plan.links_per_round));
        let blocks: u64 =
            mesh.parts.iter().map(|part| u64::from(plan.blocks(part.triangles))).sum();
        let found = Self::found_size(plan.links_per_submission, mesh);
        let distances = Self::distances_size(plan.links_per_submission, mesh, device.precision());

        let up = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let down = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let rounds = device.buffer(
            rounds * parts * device.uniform_stride::<Round>(),
            BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        );
        let link_buffer = device.buffer(links * LinkRecord::size(device.precision()), up);
        let limits = device.buffer(links * 4, up);
        let block_bounds = device
            .buffer(u64::from(plan.links_per_round) * blocks * BLOCK_BOUNDS, BufferUsages::STORAGE);
        let found_buffer = device.buffer(found, down | BufferUsages::COPY_DST);
        let distance_buffer = device.buffer(distances, down);
        let readback = device
            .buffer(READINGS + found + distances, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let groups = mesh
            .parts
            .iter()
            .map(|part| {
                device.group(
                    &gpu.query_layout,
                    &[
                        device.uniform_binding::<Round>(&rounds),
                        link_buffer.as_entire_binding(),
                        limits.as_entire_binding(),
                        part.spheres.as_entire_binding(),
                        part.faces.as_entire_binding(),
                        block_bounds.as_entire_binding(),
                        found_buffer.as_entire_binding(),
                        distance_buffer.as_entire_binding(),
                    ],
                )
            })
            .collect();
        Self {
            plan,
            rounds,
            links: link_buffer,
            limits,
            found: found_buffer,
            distances: distance_buffer,
            readback,
            clock: Clock::new(device),
            groups,
        }
    }
}
