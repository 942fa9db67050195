//! The buffers of a query, which serve every query of the same shape.

use super::clock::{Clock, READINGS};
use super::mesh::DeviceMesh;
use super::opened::Opened;
use super::plan::{BLOCK_BOUNDS, CAPACITY, Plan};
use wgpu::{BindGroup, Buffer, BufferUsages};

/// Buffers that serve any query with this plan, of at most these sizes.
pub(super) struct Buffers {
    pub plan: Plan,
    pub rounds: Buffer,
    pub links: Buffer,
    pub limits: Buffer,
    pub found: Buffer,
    pub distances: Buffer,
    pub readback: Buffer,
    pub clock: Option<Clock>,
    /// One for each part of the mesh.
    pub groups: Vec<BindGroup>,
}

/// Numbers of a link.
const LINK: u64 = 16;
/// Bytes of a round's description.
const ROUND: u64 = 32;

impl Buffers {
    pub(super) fn new(gpu: &Opened, mesh: &DeviceMesh, plan: Plan) -> Self {
        let device = &gpu.device;
        let (links, parts) = (plan.links_per_submission as u64, mesh.parts.len() as u64);
        let (size, slots) = (device.precision.size(), links * parts);
        let rounds = links.div_ceil(u64::from(plan.links_per_round));
        let alignment = u64::from(device.limits.min_uniform_buffer_offset_alignment);
        let blocks: u64 = mesh.parts.iter().map(|part| u64::from(plan.blocks(part.triangles))).sum();
        let (found, distances) = (slots * (CAPACITY as u64 + 1) * 4, slots * CAPACITY as u64 * size);

        let up = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let down = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let rounds = device
            .buffer(rounds * parts * alignment.max(ROUND), BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let link_buffer = device.buffer(links * LINK * size, up);
        let limits = device.buffer(links * 4, up);
        let block_bounds =
            device.buffer(u64::from(plan.links_per_round) * blocks * BLOCK_BOUNDS, BufferUsages::STORAGE);
        let found_buffer = device.buffer(found, down | BufferUsages::COPY_DST);
        let distance_buffer = device.buffer(distances, down);
        let readback =
            device.buffer(READINGS + found + distances, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let groups = mesh
            .parts
            .iter()
            .map(|part| {
                let round = wgpu::BufferBinding {
                    buffer: &rounds,
                    offset: 0,
                    size: std::num::NonZeroU64::new(ROUND),
                };
                device.group(
                    &gpu.query_layout,
                    &[
                        wgpu::BindingResource::Buffer(round),
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
