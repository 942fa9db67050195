//! One query on the device: upload the links, run four kernels, read the candidates.
//!
//! # Algorithm
//! 1. `sample`: the bounding spheres of a sample of the triangles give each link its first limit,
//!    an upper bound on its distance.
//! 2. `nearest`: all triangles against all links. A triangle whose sphere is beyond the limit is
//!    skipped. Any other costs the distance from the axis and the bounds of a flat cap. Each block
//!    of triangles keeps its least lower and its least upper bound.
//! 3. `reduce`: the link's limit is the least upper bound of all blocks, plus twice the error
//!    bound.
//! 4. `collect`: in the blocks that may be within the limit, the discs of flat caps decide. The
//!    triangles within the limit come back.

use super::buffers::Buffers;
use super::candidates::{CandidateTriangle, Candidates};
use super::layout::Round;
use super::link::DeviceLink;
use super::mesh::DeviceMesh;
use super::opened::Opened;
use super::plan::{Plan, Tuning};
use gpu_batch::wgpu::{self, Buffer, CommandEncoder, ComputePipeline};
use gpu_batch::{Clock, DeviceFailure, READINGS, Record, Watch};
use std::time::Duration;

/// Memory of a query, here and on the device, reused by the next.
pub(super) struct Query {
    tuning: Tuning,
    watch: Watch,
    /// The number of the last submission. It is odd, so its product with a number of blocks below
    /// 2^32 is never 0 modulo 2^32. Buffers are cleared to 0, so a slot that no kernel wrote is
    /// recognised.
    submission: u32,
    buffers: Option<Buffers>,
    bytes: Vec<u8>,
    candidates: Candidates,
    /// The time of the kernels of the last query, if the device keeps time.
    pub device_time: Option<Duration>,
}

impl Query {
    /// `watch` has already reported the failures before the first query.
    pub(super) fn new(tuning: Tuning, watch: Watch) -> Self {
        Self {
            tuning,
            watch,
            submission: 1,
            buffers: None,
            bytes: Vec::new(),
            candidates: Candidates::default(),
            device_time: None,
        }
    }

    /// The candidates of a link of the last query, sorted by triangle, and whether some did not
    /// come back.
    pub(super) fn candidates(&self, link: usize) -> (&[CandidateTriangle], bool) {
        self.candidates.of(link)
    }

    /// Finds the candidates of every link; there is at least one link. `nearest` is the kernel of
    /// step 2.
    ///
    /// # Errors
    /// The device has failed since the last query, or did not answer.
    pub(super) fn run(
        &mut self,
        gpu: &Opened,
        mesh: &DeviceMesh,
        links: &[DeviceLink],
        nearest: &ComputePipeline,
    ) -> Result<(), DeviceFailure> {
        self.candidates.clear();
        self.device_time = gpu.device.tick().map(|_| Duration::ZERO);
        // Rounding up lets robots with nearly as many links share a plan, and so the buffers.
        let plan = Plan::new(gpu, mesh, links.len().next_multiple_of(32), &self.tuning);
        // A failure drops the buffers; the next query makes new ones.
        let buffers = match self.buffers.take() {
            Some(buffers) if buffers.plan == plan => buffers,
            _ => Buffers::new(gpu, mesh, plan),
        };
        for links in links.chunks(plan.links_per_submission) {
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
        links: &[DeviceLink],
        nearest: &ComputePipeline,
    ) -> Result<(), DeviceFailure> {
        let device = &gpu.device;
        self.submission = self.submission.wrapping_add(2);
        self.upload(gpu, mesh, buffers, links);
        let mut encoder = device.raw().create_command_encoder(&Default::default());
        encoder.clear_buffer(&buffers.found, 0, None);
        record_passes(&mut encoder, gpu, mesh, buffers, links.len(), nearest);
        let found = Buffers::found_size(links.len(), mesh);
        let distances = Buffers::distances_size(links.len(), mesh, device.precision());
        let (to, end) = (&buffers.readback, READINGS + found);
        encoder.copy_buffer_to_buffer(&buffers.found, 0, to, READINGS, Some(found));
        encoder.copy_buffer_to_buffer(&buffers.distances, 0, to, end, Some(distances));
        if let Some(clock) = &buffers.clock {
            clock.copy(&mut encoder, to);
        }
        let Self { watch, candidates, device_time, submission, .. } = self;
        device.run_and_read(watch, encoder.finish(), to, end + distances, |bytes| {
            let (readings, bytes) = bytes.split_at(READINGS as usize);
            *device_time = device_time
                .zip(Clock::time_between(device, readings))
                .map(|(sum, more)| sum + more);
            candidates.read(mesh, buffers, device.precision(), *submission, links.len(), bytes)
        })
    }

    fn upload(&mut self, gpu: &Opened, mesh: &DeviceMesh, buffers: &Buffers, links: &[DeviceLink]) {
        let (queue, plan, precision) = (gpu.device.queue(), &buffers.plan, gpu.device.precision());
        let bytes = &mut self.bytes;
        let mut write = |buffer: &Buffer, fill: &dyn Fn(&mut Vec<u8>)| {
            bytes.clear();
            fill(bytes);
            queue.write_buffer(buffer, 0, bytes);
        };
        write(&buffers.links, &|bytes| {
            links.iter().for_each(|link| link.record.write(precision, bytes))
        });
        write(&buffers.limits, &|bytes| {
            links.iter().for_each(|link| bytes.extend(link.limit.to_bits().to_ne_bytes()));
        });
        let (submission, stride) = (self.submission, gpu.device.uniform_stride::<Round>() as usize);
        write(&buffers.rounds, &|bytes| {
            let blocks = mesh.parts.iter().map(|part| plan.blocks(part.triangles)).sum();
            let mut first_link = 0;
            for round in links.chunks(plan.links_per_round as usize) {
                let (mut first_block, mut first_slot) = (0, first_link);
                for part in &mesh.parts {
                    let record = Round {
                        first_link,
                        links: round.len() as u32,
                        links_at_once: plan.links_at_once,
                        triangles_at_once: plan.triangles_at_once,
                        triangles: part.triangles,
                        first_block,
                        blocks,
                        first_slot,
                        submission,
                    };
                    record.write(precision, bytes);
                    bytes.resize(bytes.len().next_multiple_of(stride), 0);
                    first_block += plan.blocks(part.triangles);
                    first_slot += links.len() as u32;
                }
                first_link += round.len() as u32;
            }
        });
    }
}

/// Records the four steps for each round of links.
fn record_passes(
    encoder: &mut CommandEncoder,
    gpu: &Opened,
    mesh: &DeviceMesh,
    buffers: &Buffers,
    mut links: usize,
    nearest: &ComputePipeline,
) {
    let timestamp_writes = buffers.clock.as_ref().map(Clock::writes);
    let mut pass =
        encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
    let parts = 0..mesh.parts.len();
    let mut first_record = 0;
    while links > 0 {
        let round = links.min(buffers.plan.links_per_round as usize);
        let (count, groups) = (round as u32, (round as u32).div_ceil(buffers.plan.links_at_once));
        let mut dispatch = |kernel: &ComputePipeline, part: usize, x, y| {
            let offset = (first_record + part) as u64 * gpu.device.uniform_stride::<Round>();
            pass.set_pipeline(kernel);
            pass.set_bind_group(0, &buffers.groups[part], &[offset as u32]);
            pass.dispatch_workgroups(x, y, 1);
        };
        let blocks = |part: usize| buffers.plan.blocks(mesh.parts[part].triangles);
        parts.clone().for_each(|part| dispatch(&gpu.sample, part, count, 1));
        parts.clone().for_each(|part| dispatch(nearest, part, blocks(part), groups));
        dispatch(&gpu.reduce, 0, count, 1);
        parts.clone().for_each(|part| dispatch(&gpu.collect, part, blocks(part), groups));
        first_record += mesh.parts.len();
        links -= round;
    }
}
