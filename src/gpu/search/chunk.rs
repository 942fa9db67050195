//! A chunk of robots on the device.
//!
//! # Algorithm
//! 1. **Lay out**: which link groups, points and radii each robot has, and where they begin.
//! 2. **Upload** link groups, shapes and radii. Steps 1 and 2 are in `chunk_upload`.
//! 3. **Submit**: compute the points if the shapes are sections; the passes of the question; copy
//!    the results to where the CPU can read them.
//!
//! A second search of the same robots needs step 3 alone.

use super::bounds::FAR;
use super::chunk_upload::{ChunkLayout, Inputs, Upload, fits, uniform};
use super::device::Searched;
use super::kernels::{BENDING_THREADS, GROUP_SIZE, Question, SearchQuery};
use super::robots::Packed;
use crate::answer::ProximityError;
use crate::mesh::SearchFrame;
use gpu_batch::wgpu::{BindGroup, Buffer, BufferUsages, ComputePassDescriptor};
use gpu_batch::{Clock, Device, DeviceFailure, READINGS, Record, Submitted, Watch};
use std::ops::Range;

/// Bytes of a head, which says what was found about a link group.
pub(super) const HEAD_BYTES: u64 = 8;
/// Bytes of an entry, which is a candidate.
pub(super) const ENTRY_BYTES: u64 = 8;
/// Bytes of the counters.
pub(super) const COUNTER_BYTES: u64 = 16;
/// Bytes of the limits that the first pass leaves to the second, for each link group.
const LIMIT_BYTES: u64 = 8 * GROUP_SIZE as u64;
/// The least number of entries of a chunk.
const LEAST_ENTRIES: u64 = 1 << 10;
/// The most entries of a chunk: the index of each entry and of each of its bytes is below 2^32.
const MOST_ENTRIES: u64 = 1 << 28;

/// A chunk of robots. Its memory is reused by a later chunk.
#[derive(Default)]
pub(super) struct Chunk {
    pub layout: ChunkLayout,
    /// The links or link groups that share the entries.
    pub items: u64,
    /// The most entries that come back.
    pub capacity: u32,
    upload: Upload,
    outputs: Option<Outputs>,
    pub submitted: Option<Submitted>,
}

/// The buffers of what comes back.
struct Outputs {
    /// The numbers of link groups and of entries that the buffers hold.
    sizes: [u64; 2],
    query: Buffer,
    heads: Buffer,
    entries: Buffer,
    counters: Buffer,
    readback: Buffer,
    clock: Option<Clock>,
    /// The bindings of the passes, inputs included.
    bindings: BindGroup,
}

/// The capacity for entries of a chunk of `items`, with `entries_per_item`. `largest` is the number
/// of bytes of the largest buffer.
pub(super) fn capacity_for(entries_per_item: u64, items: u64, largest: u64) -> u32 {
    let entries = (entries_per_item * items).max(LEAST_ENTRIES);
    entries.min(largest / ENTRY_BYTES).min(MOST_ENTRIES) as u32
}

impl Chunk {
    /// Uploads robots and has the device search for them. Writes the errors of bad robots to `out`,
    /// the answers of the batch.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last.
    #[expect(clippy::too_many_arguments, reason = "the batch, and one chunk of it")]
    pub(super) fn start<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        chunk: Range<usize>,
        question: Question,
        entries_per_item: u64,
        out: &mut [Result<A, ProximityError>],
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        self.layout.lay_out(robots, chunk);
        if self.upload.write(searched, robots, &mut self.layout, out, watch)? {
            // The bindings of the outputs name the inputs.
            self.outputs = None;
        }
        self.submit(searched, question, entries_per_item, watch)
    }

    /// Step 3, for the robots that were uploaded.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last.
    pub(super) fn submit(
        &mut self,
        searched: Searched,
        question: Question,
        entries_per_item: u64,
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        let Searched { gpu, kernels, frame, .. } = searched;
        let (device, groups) = (&gpu.device, u64::from(self.layout.groups));
        self.items = self.layout.items(question.is_about_links());
        self.capacity = capacity_for(entries_per_item, self.items, device.largest_binding());
        let Some(inputs) = self.upload.inputs.as_ref().filter(|_| groups > 0) else {
            return Ok(());
        };
        let sizes = [groups, self.capacity.into()];
        if !self.outputs.as_ref().is_some_and(|outputs| fits(outputs.sizes, sizes)) {
            self.outputs = None;
        }
        let outputs = self.outputs.get_or_insert_with(|| Outputs::new(searched, inputs, sizes));
        let [margin_up, margin_down] = margins(question, frame).map(f32::to_bits);
        let query = SearchQuery {
            groups: self.layout.groups,
            margin_up,
            margin_down,
            capacity: self.capacity,
        };
        write_record(device, &outputs.query, &query);

        let mut encoder = device.raw().create_command_encoder(&Default::default());
        encoder.clear_buffer(&outputs.heads, 0, Some(groups * HEAD_BYTES));
        encoder.clear_buffer(&outputs.counters, 0, None);
        let timestamp_writes = outputs.clock.as_ref().map(Clock::writes);
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes });
        if let Some((query, buffers)) = self.layout.bending.zip(inputs.bending.as_ref()) {
            write_record(device, &buffers.query, &query);
            pass.set_pipeline(&kernels.bend);
            pass.set_bind_group(0, &buffers.bindings, &[0]);
            let points = self.layout.points_size / 3;
            device.dispatch(&mut pass, points.div_ceil(BENDING_THREADS));
        }
        pass.set_bind_group(0, &outputs.bindings, &[0]);
        for kernel in &kernels.passes[question.kind()] {
            pass.set_pipeline(kernel);
            device.dispatch(&mut pass, self.layout.groups);
        }
        drop(pass);
        let (to, mut end) = (&outputs.readback, READINGS);
        for (from, size) in [
            (&outputs.counters, COUNTER_BYTES),
            (&outputs.heads, groups * HEAD_BYTES),
            (&outputs.entries, u64::from(self.capacity) * ENTRY_BYTES),
        ] {
            encoder.copy_buffer_to_buffer(from, 0, to, end, Some(size));
            end += size;
        }
        if let Some(clock) = &outputs.clock {
            clock.copy(&mut encoder, to);
        }
        self.submitted = Some(device.submit(watch, encoder.finish(), to, end)?);
        Ok(())
    }

    /// The buffer that the last submission fills.
    pub(super) fn readback(&self) -> Option<&Buffer> {
        self.outputs.as_ref().map(|outputs| &outputs.readback)
    }
}

fn write_record<R: Record>(device: &Device, buffer: &Buffer, record: &R) {
    let mut bytes = Vec::new();
    record.write(device.precision(), &mut bytes);
    device.queue().write_buffer(buffer, 0, &bytes);
}

/// The margin in the search frame, rounded up and rounded down.
fn margins(question: Question, frame: &SearchFrame) -> [f32; 2] {
    let Some(margin) = question.margin() else { return [FAR, 0.0] };
    let nearest = (margin * frame.scale).min(FAR.into()) as f32;
    let (up, down) = (nearest.next_up().min(FAR), nearest.next_down().max(0.0));
    [up, if nearest < FAR { down } else { FAR }]
}

impl Outputs {
    /// Buffers of at least these sizes.
    fn new(searched: Searched, inputs: &Inputs, needed: [u64; 2]) -> Self {
        let Searched { gpu, kernels, tree, .. } = searched;
        let (device, sizes) = (&gpu.device, needed.map(u64::next_power_of_two));
        let [groups, entries] = sizes;
        let down = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let query = uniform::<SearchQuery>(device);
        let heads = device.buffer(groups * HEAD_BYTES, down);
        let entry_buffer = device.buffer(entries * ENTRY_BYTES, down);
        let counters = device.buffer(COUNTER_BYTES, down);
        let limits = device.buffer(groups * LIMIT_BYTES, BufferUsages::STORAGE);
        let readback = device.buffer(
            READINGS + COUNTER_BYTES + groups * HEAD_BYTES + entries * ENTRY_BYTES,
            BufferUsages::MAP_READ | BufferUsages::COPY_DST,
        );
        let bindings = device.group(
            &kernels.query_layout,
            &[
                device.uniform_binding::<SearchQuery>(&query),
                tree.nodes.as_entire_binding(),
                tree.triangles.as_entire_binding(),
                inputs.groups.as_entire_binding(),
                inputs.numbers.as_entire_binding(),
                heads.as_entire_binding(),
                entry_buffer.as_entire_binding(),
                counters.as_entire_binding(),
                limits.as_entire_binding(),
            ],
        );
        Self {
            sizes,
            query,
            heads,
            entries: entry_buffer,
            counters,
            readback,
            clock: Clock::new(device),
            bindings,
        }
    }
}
