//! One query on the device: links up, kernels in four steps, candidates back.
//!
//! 1. `sample`: the spheres of a sample of the triangles give each link a first limit.
//! 2. `nearest`: all triangles against all links. What its sphere does not rule out costs the distance from the axis
//!    and the bounds of a flat cap; each block of triangles keeps the least bounds.
//! 3. `reduce`: the least of all blocks is the link's limit.
//! 4. `collect`: in the blocks that may be as near, the discs of flat caps decide; what is as near comes back.

use super::buffers::Buffers;
use super::clock::{Clock, READINGS};
use super::link::PlacedLink;
use super::mesh::DeviceMesh;
use super::opened::Opened;
use super::plan::{CAPACITY, Plan};
use crate::proximity::DeviceFailure;
use parry3d_f64::math::Real;
use std::ops::Range;
use std::time::Duration;
use wgpu::{Buffer, ComputePipeline};

/// A triangle that may be the nearest, and its distance from the axis as the device computed it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub triangle: u32,
    pub distance: Real,
}

/// The candidates of one link.
#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    range: Range<usize>,
    /// Whether there are more than came back.
    pub too_many: bool,
}

/// Memory of the last query, here and on the device, used again.
#[derive(Default)]
pub(super) struct Query {
    buffers: Option<Buffers>,
    bytes: Vec<u8>,
    candidates: Vec<Candidate>,
    links: Vec<Candidates>,
    /// How long the kernels of the last query took, if the device keeps time.
    pub device_time: Option<Duration>,
}

impl Query {
    /// The candidates of a link of the last query.
    pub(super) fn candidates(&self, link: usize) -> (&[Candidate], bool) {
        let Candidates { range, too_many } = &self.links[link];
        (&self.candidates[range.clone()], *too_many)
    }

    /// Finds the candidates of every link. `nearest` is the kernel of step 2.
    ///
    /// # Errors
    /// The device has failed.
    pub(super) fn run(
        &mut self,
        gpu: &Opened,
        mesh: &DeviceMesh,
        links: &[PlacedLink],
        nearest: &ComputePipeline,
    ) -> Result<(), DeviceFailure> {
        self.links.clear();
        self.candidates.clear();
        self.device_time = gpu.device.tick.map(|_| Duration::ZERO);
        if links.is_empty() {
            return Ok(());
        }
        // Robots of nearly as many links share a plan, and with it the buffers.
        let plan = Plan::new(gpu, mesh, links.len().next_multiple_of(32));
        if self.buffers.as_ref().is_none_or(|buffers| buffers.plan != plan) {
            self.buffers = Some(Buffers::new(gpu, mesh, plan));
        }
        let Some(buffers) = self.buffers.take() else { return Ok(()) };
        for links in links.chunks(plan.links_per_submission) {
            // On failure the buffers are gone, and made anew for the next query.
            self.submit(gpu, mesh, &buffers, links, nearest)?;
        }
        self.buffers = Some(buffers);
        Ok(())
    }

    fn submit(
        &mut self,
        gpu: &Opened,
        mesh: &DeviceMesh,
        buffers: &Buffers,
        links: &[PlacedLink],
        nearest: &ComputePipeline,
    ) -> Result<(), DeviceFailure> {
        let device = &gpu.device;
        self.upload(gpu, mesh, buffers, links);
        let mut encoder = device.device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&buffers.found, 0, None);
        let timestamp_writes = buffers.clock.as_ref().map(Clock::writes);
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        let mut offset = 0;
        for round in links.chunks(buffers.plan.links_per_round as usize) {
            let offsets: Vec<_> = (0..mesh.parts.len())
                .map(|part| offset + part as u32 * device.limits.min_uniform_buffer_offset_alignment)
                .collect();
            offset += mesh.parts.len() as u32 * device.limits.min_uniform_buffer_offset_alignment;
            let count = round.len() as u32;
            let groups = count.div_ceil(buffers.plan.links_at_once);
            let mut dispatch = |kernel: &ComputePipeline, part: usize, x, y| {
                pass.set_pipeline(kernel);
                pass.set_bind_group(0, &buffers.groups[part], &[offsets[part]]);
                pass.dispatch_workgroups(x, y, 1);
            };
            let blocks = |part: usize| buffers.plan.blocks(mesh.parts[part].triangles);
            for part in 0..mesh.parts.len() {
                dispatch(&gpu.sample, part, count, 1);
            }
            for part in 0..mesh.parts.len() {
                dispatch(nearest, part, blocks(part), groups);
            }
            dispatch(&gpu.reduce, 0, count, 1);
            for part in 0..mesh.parts.len() {
                dispatch(&gpu.collect, part, blocks(part), groups);
            }
        }
        drop(pass);

        let slots = (links.len() * mesh.parts.len()) as u64;
        let found = slots * (CAPACITY as u64 + 1) * 4;
        let distances = slots * CAPACITY as u64 * device.precision.size();
        encoder.copy_buffer_to_buffer(&buffers.found, 0, &buffers.readback, READINGS, Some(found));
        encoder.copy_buffer_to_buffer(
            &buffers.distances,
            0,
            &buffers.readback,
            READINGS + found,
            Some(distances),
        );
        if let Some(clock) = &buffers.clock {
            clock.copy(&mut encoder, &buffers.readback);
        }
        let size = READINGS + found + distances;
        device.run_and_read(encoder.finish(), &buffers.readback, size, |bytes| {
            let (readings, bytes) = bytes.split_at(READINGS as usize);
            let more = device.time_between(readings);
            self.device_time = self.device_time.zip(more).map(|(sum, more)| sum + more);
            let (found, distances) = bytes.split_at(found as usize);
            self.read(gpu, mesh, links, found, distances);
        })
    }

    fn upload(&mut self, gpu: &Opened, mesh: &DeviceMesh, buffers: &Buffers, links: &[PlacedLink]) {
        let (queue, plan) = (&gpu.device.queue, &buffers.plan);
        let mut write = |buffer: &Buffer, fill: &dyn Fn(&mut Vec<u8>)| {
            self.bytes.clear();
            fill(&mut self.bytes);
            queue.write_buffer(buffer, 0, &self.bytes);
        };
        write(&buffers.links, &|bytes| {
            let numbers = links.iter().flat_map(|link| link.record);
            numbers.for_each(|number| gpu.device.precision.write(number, bytes));
        });
        write(&buffers.limits, &|bytes| {
            links.iter().for_each(|link| bytes.extend(link.limit.to_bits().to_ne_bytes()));
        });
        write(&buffers.rounds, &|bytes| {
            let blocks = mesh.parts.iter().map(|part| plan.blocks(part.triangles)).sum();
            let mut first_link = 0;
            for round in links.chunks(plan.links_per_round as usize) {
                let (mut first_block, mut first_slot) = (0, first_link);
                for part in &mesh.parts {
                    let round: [u32; 8] = [
                        first_link,
                        round.len() as u32,
                        plan.links_at_once,
                        plan.triangles_at_once,
                        part.triangles,
                        first_block,
                        blocks,
                        first_slot,
                    ];
                    bytes.extend(round.iter().flat_map(|number| number.to_ne_bytes()));
                    let alignment = gpu.device.limits.min_uniform_buffer_offset_alignment as usize;
                    bytes.resize(bytes.len().next_multiple_of(alignment), 0);
                    first_block += plan.blocks(part.triangles);
                    first_slot += links.len() as u32;
                }
                first_link += round.len() as u32;
            }
        });
    }

    /// Sorts what came back into the candidates of each link.
    fn read(
        &mut self,
        gpu: &Opened,
        mesh: &DeviceMesh,
        links: &[PlacedLink],
        found: &[u8],
        distances: &[u8],
    ) {
        let word = |place: usize| {
            let bytes: [u8; 4] = found[4 * place..][..4].try_into().unwrap_or_default();
            u32::from_ne_bytes(bytes)
        };
        let slot_size = CAPACITY * gpu.device.precision.size() as usize;
        for link in 0..links.len() {
            let begin = self.candidates.len();
            let mut too_many = false;
            for (number, part) in mesh.parts.iter().enumerate() {
                let slot = number * links.len() + link;
                let count = word(slot * (CAPACITY + 1)) as usize;
                too_many |= count > CAPACITY;
                let computed = gpu.device.precision.read(&distances[slot * slot_size..][..slot_size]);
                for (place, distance) in computed.take(count).enumerate() {
                    let triangle = part.first + word(slot * (CAPACITY + 1) + 1 + place);
                    self.candidates.push(Candidate { triangle, distance });
                }
            }
            // They come in any order.
            self.candidates[begin..].sort_by_key(|candidate| candidate.triangle);
            self.links.push(Candidates { range: begin..self.candidates.len(), too_many });
        }
    }
}
