//! A chunk of robots on the device: its layout, its upload and its submission.
//!
//! # Algorithm
//! 1. **Lay out**: which parts, points and radii each robot has, and where they begin.
//! 2. **Write** parts, shapes and radii, on all cores. Each core writes shapes and radii into
//!    memory of its own from which the driver copies them to the device.
//! 3. **Search**: compute the points if the shapes are sections; the passes of the question; copy
//!    the results to where the CPU can read them.
//!
//! A second search of the same robots needs step 3 alone.

use super::batch::Searched;
use super::bending::BendingQuery;
use super::bounds::FAR;
use super::kernels::{BENDING_THREADS, MOST_GATHERED, PART, Question, SearchQuery};
use super::robots::Packed;
use crate::answer::ProximityError;
use crate::mesh::SearchFrame;
use crate::threads::{each, threads};
use gpu_batch::wgpu::{
    BindGroup, Buffer, BufferSize, BufferUsages, ComputePassDescriptor, QueueWriteBufferView,
    WriteOnly,
};
use gpu_batch::{Clock, Device, DeviceFailure, READINGS, Record, Submitted, Watch};
use std::ops::Range;

/// Robots that one task of the CPU takes.
pub(super) const TASK_SIZE: usize = 64;
/// Bytes of a part, a head, an entry, the counters, and the limits of a part.
const PART_SIZE: u64 = 16;
pub(super) const HEAD: u64 = 8;
pub(super) const ENTRY: u64 = 8;
pub(super) const COUNTERS: u64 = 16;
const LIMITS: u64 = 8 * PART as u64;
/// The least room for entries.
const LEAST_ENTRIES: u64 = 1 << 10;
/// The most links of a robot on the device.
const MOST_LINKS: usize = 1 << 20;
/// The number of all candidates of a chunk fits into a word.
const _: () = assert!(MOST_LINKS as u64 * (MOST_GATHERED as u64) < 1 << 32);

/// A chunk of robots. Its memory is reused by a later chunk.
#[derive(Default)]
pub(super) struct Chunk {
    /// The robots of the batch.
    pub robots: Range<usize>,
    pub layouts: Vec<Layout>,
    pub parts: u32,
    /// What the room for entries is in proportion to: links or parts.
    pub items: u64,
    /// The number of entries that have room.
    pub room: u32,
    links: u64,
    /// The numbers of all points, and of all radii and caps.
    points: u32,
    radii: u32,
    /// How the device computes the points, unless they were uploaded.
    bending: Option<BendingQuery>,
    inputs: Option<Inputs>,
    outputs: Option<Outputs>,
    pub submitted: Option<Submitted>,
    part_bytes: Vec<u8>,
}

/// Where a robot of a chunk is.
#[derive(Clone, Copy, Default)]
pub(super) struct Layout {
    pub first_part: u32,
    /// The number of links, or 0 if the device is not asked about the robot.
    pub links: u32,
    pub is_left: bool,
    /// Where its points and its radii begin, in numbers.
    points: u32,
    radii: u32,
    /// Whether the radii equal the radii of the robot before.
    is_alike: bool,
}

/// What is uploaded: the buffers for a number of parts, of bytes of numbers, and of bytes of
/// sections.
struct Inputs {
    sizes: [u64; 3],
    parts: Buffer,
    numbers: Buffer,
    /// If the device computes the points.
    bending: Option<BendingBuffers>,
}

struct BendingBuffers {
    query: Buffer,
    sections: Buffer,
    group: BindGroup,
}

/// What comes back: the buffers for a number of parts and of entries. `group` has the inputs too.
struct Outputs {
    sizes: [u64; 2],
    query: Buffer,
    heads: Buffer,
    entries: Buffer,
    counters: Buffer,
    readback: Buffer,
    clock: Option<Clock>,
    group: BindGroup,
}

/// The chunk of robots from `first` on.
pub(super) fn chunk_from<R: Packed>(robots: R, first: usize) -> Range<usize> {
    const { assert!(R::CHUNK * PART as usize <= MOST_LINKS) };
    let (mut end, mut parts) = (first, 0);
    while end < robots.len() {
        parts += robots.links(end).div_ceil(PART as usize);
        if parts > R::CHUNK && end > first {
            break;
        }
        end += 1;
    }
    first..end
}

/// The room for the entries of a chunk of `items`, for this room for each item. `largest` is the
/// number of bytes of the largest buffer.
pub(super) fn room_for(room: u64, items: u64, largest: u64) -> u32 {
    let room = (room * items).max(LEAST_ENTRIES);
    // No rank of a candidate or a byte exceeds a word.
    room.min(largest / ENTRY).min(1 << 28) as u32
}

impl Chunk {
    /// Uploads robots and has the device search for them. Writes the errors of bad robots to `out`,
    /// the answers of the batch.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last.
    #[expect(clippy::too_many_arguments, reason = "the batch, and one chunk of it")]
    pub(super) fn submit<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        chunk: Range<usize>,
        question: Question,
        room: u64,
        out: &mut [Result<A, ProximityError>],
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        self.lay_out(robots, chunk);
        self.write(searched, robots, out, watch)?;
        self.search(searched, question, room, watch)
    }

    /// Step 1.
    pub(super) fn lay_out(&mut self, robots: impl Packed, chunk: Range<usize>) {
        let first = chunk.start;
        self.layouts.clear();
        self.layouts.resize(chunk.len(), Layout::default());
        let mut shares: Vec<_> = self.layouts.chunks_mut(TASK_SIZE).collect();
        each(&mut shares, |share, layouts| {
            for (robot, layout) in (first + share * TASK_SIZE..).zip(layouts.iter_mut()) {
                let links = robots.links(robot);
                layout.is_left = links > MOST_LINKS;
                layout.links = if layout.is_left { 0 } else { links as u32 };
                layout.is_alike = robot > first && robots.is_like_before(robot);
            }
        });
        (self.parts, self.points, self.links) = (0, 0, 0);
        for layout in &mut self.layouts {
            (layout.points, layout.first_part) = (self.points, self.parts);
            self.points += layout.points_size();
            self.parts += layout.links.div_ceil(PART);
            self.links += u64::from(layout.links);
        }
        self.radii = 0;
        let mut before = self.points;
        for layout in &mut self.layouts {
            if !layout.is_alike {
                before = self.points + self.radii;
            }
            self.radii += layout.radii_size();
            layout.radii = before;
        }
        self.bending = robots.bending(chunk.len());
        self.robots = chunk;
    }

    /// Step 2.
    fn write<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        out: &mut [Result<A, ProximityError>],
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        let Searched { gpu, frame, .. } = searched;
        let points = 4 * u64::from(self.points);
        let shapes: usize = self.layouts.iter().map(|layout| robots.shape_size(layout.links)).sum();
        let mut base = Vec::new();
        robots.write_base(frame, &mut base);
        let sizes = [
            u64::from(self.parts),
            points + 4 * u64::from(self.radii),
            if self.bending.is_some() { (base.len() + shapes) as u64 } else { 0 },
        ];
        if !self.inputs.as_ref().is_some_and(|inputs| fits(inputs.sizes, sizes)) {
            // The group of the outputs names the inputs.
            self.outputs = None;
            self.inputs = None;
        }
        let inputs = self.inputs.get_or_insert_with(|| Inputs::new(searched, sizes));
        let (device, queue) = (&gpu.device, gpu.device.queue());
        let mut upload = |buffer: &Buffer, offset: &mut u64, size: usize| {
            let Some(size) = BufferSize::new(size as u64) else { return Ok(None) };
            let view = device.upload(watch, buffer, *offset, size)?;
            *offset += size.get();
            Ok(Some(view))
        };
        self.part_bytes.resize(self.parts as usize * PART_SIZE as usize, 0);
        let mut all_parts = &mut self.part_bytes[..];
        let (mut radii_at, mut shapes_at) = (points, 0);
        let mut shape_buffer = &inputs.numbers;
        if let Some((_, bending)) = self.bending.zip(inputs.bending.as_ref()) {
            queue.write_buffer(&bending.sections, 0, &base);
            (shape_buffer, shapes_at) = (&bending.sections, base.len() as u64);
        }

        let first = self.robots.start;
        let share_size = self.layouts.len().div_ceil(threads()).max(TASK_SIZE);
        let mut shares = Vec::new();
        let outs = out[self.robots.clone()].chunks_mut(share_size);
        for (layouts, out) in self.layouts.chunks_mut(share_size).zip(outs) {
            let sum = |of: &dyn Fn(&Layout) -> usize| layouts.iter().map(of).sum();
            let parts = all_parts.split_off_mut(..sum(&Layout::parts_bytes)).unwrap_or_default();
            let radii = sum(&|layout| 4 * layout.radii_size() as usize);
            let radii = upload(&inputs.numbers, &mut radii_at, radii)?;
            let shapes = sum(&|layout| robots.shape_size(layout.links));
            let shapes = upload(shape_buffer, &mut shapes_at, shapes)?;
            shares.push((layouts, out, parts, radii, shapes));
        }
        each(&mut shares, |share, (layouts, out, parts, radii, shapes)| {
            let robots_of_share = first + share * share_size..;
            let (mut all_radii, mut all_shapes) = (whole(radii), whole(shapes));
            for ((robot, layout), out) in
                robots_of_share.zip(layouts.iter_mut()).zip(out.iter_mut())
            {
                let shape = take_front(&mut all_shapes, robots.shape_size(layout.links));
                let radii = take_front(&mut all_radii, 4 * layout.radii_size() as usize);
                let parts = parts.split_off_mut(..layout.parts_bytes()).unwrap_or_default();
                if layout.is_left {
                    continue;
                }
                robots.write_radii(robot, frame, radii);
                let mut more_error = 0.0;
                match robots.write_shape(robot, frame, shape) {
                    Ok(Some(error)) => more_error = error,
                    Ok(None) => (layout.links, layout.is_left) = (0, true),
                    Err(error) => {
                        *out = Err(error);
                        layout.links = 0;
                    }
                }
                layout.write_parts(more_error, parts);
            }
        });
        drop(shares);
        queue.write_buffer(&inputs.parts, 0, &self.part_bytes);
        Ok(())
    }

    /// Step 3, for the robots that were uploaded.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last.
    pub(super) fn search(
        &mut self,
        searched: Searched,
        question: Question,
        room: u64,
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        let Searched { gpu, kernels, frame, .. } = searched;
        let (device, parts) = (&gpu.device, u64::from(self.parts));
        self.items = if question.is_about_links() { self.links } else { parts };
        self.room = room_for(room, self.items, device.largest_binding());
        let room = u64::from(self.room);
        let Some(inputs) = self.inputs.as_ref().filter(|_| parts > 0) else { return Ok(()) };
        let sizes = [parts, room];
        if !self.outputs.as_ref().is_some_and(|outputs| fits(outputs.sizes, sizes)) {
            self.outputs = None;
        }
        let outputs = self.outputs.get_or_insert_with(|| Outputs::new(searched, inputs, sizes));
        let (margin, certain) = margins(question, frame);
        let query = SearchQuery { parts: self.parts, margin, certain, room: self.room };
        write_record(device, &outputs.query, &query);

        let mut encoder = device.raw().create_command_encoder(&Default::default());
        encoder.clear_buffer(&outputs.heads, 0, Some(parts * HEAD));
        encoder.clear_buffer(&outputs.counters, 0, None);
        let timestamp_writes = outputs.clock.as_ref().map(Clock::writes);
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes });
        if let Some((query, buffers)) = self.bending.zip(inputs.bending.as_ref()) {
            write_record(device, &buffers.query, &query);
            pass.set_pipeline(&kernels.bend);
            pass.set_bind_group(0, &buffers.group, &[0]);
            device.dispatch(&mut pass, (self.points / 3).div_ceil(BENDING_THREADS));
        }
        pass.set_bind_group(0, &outputs.group, &[0]);
        for kernel in &kernels.passes[question.kind()] {
            pass.set_pipeline(kernel);
            device.dispatch(&mut pass, self.parts);
        }
        drop(pass);
        let (to, mut end) = (&outputs.readback, READINGS);
        for (from, size) in [
            (&outputs.counters, COUNTERS),
            (&outputs.heads, parts * HEAD),
            (&outputs.entries, room * ENTRY),
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

impl Layout {
    /// Numbers of its points.
    fn points_size(&self) -> u32 {
        if self.links == 0 { 0 } else { 3 * (self.links + 1) }
    }

    /// Numbers of its radii and caps; 0 if they equal the radii and caps of the robot before.
    fn radii_size(&self) -> u32 {
        if self.is_alike { 0 } else { 2 * self.links }
    }

    fn parts_bytes(&self) -> usize {
        PART_SIZE as usize * self.links.div_ceil(PART) as usize
    }

    /// Writes its parts. Without links they ask nothing.
    fn write_parts(&self, more_error: f32, bytes: &mut [u8]) {
        let parts = bytes.chunks_exact_mut(PART_SIZE as usize);
        for (part, first) in parts.zip((0..).step_by(PART as usize)) {
            let links = self.links.saturating_sub(first).min(PART);
            let [points, radii] = [self.points + 3 * first, self.radii + 2 * first];
            let words = [points, radii, links, more_error.to_bits()];
            part.copy_from_slice(words.map(u32::to_ne_bytes).as_flattened());
        }
    }
}

/// Whether buffers are large enough, and not far too large.
fn fits<const N: usize>(have: [u64; N], need: [u64; N]) -> bool {
    have.into_iter()
        .zip(need)
        .all(|(have, need)| need <= have && (need == 0 || have <= 16 * need.max(1 << 10)))
}

/// A view as a slice; an empty one if there is none.
fn whole(view: &mut Option<QueueWriteBufferView>) -> WriteOnly<'_, [u8]> {
    view.as_mut().map_or_else(WriteOnly::default, |view| view.slice(..))
}

/// Takes the front off a slice.
fn take_front<'a>(slice: &mut WriteOnly<'a, [u8]>, count: usize) -> WriteOnly<'a, [u8]> {
    slice.split_off(..count).unwrap_or_default()
}

fn write_record<R: Record>(device: &Device, buffer: &Buffer, record: &R) {
    let mut bytes = Vec::new();
    record.write(device.precision(), &mut bytes);
    device.queue().write_buffer(buffer, 0, &bytes);
}

/// The margin in the search frame, rounded up and rounded down, as bits.
fn margins(question: Question, frame: &SearchFrame) -> (u32, u32) {
    let Some(margin) = question.margin() else { return (FAR.to_bits(), 0) };
    let nearest = (margin * frame.scale).min(FAR.into()) as f32;
    let (up, down) = (nearest.next_up().min(FAR), nearest.next_down().max(0.0));
    (up.to_bits(), if nearest < FAR { down } else { FAR }.to_bits())
}

impl Inputs {
    /// Buffers of at least these sizes.
    fn new(searched: Searched, needed: [u64; 3]) -> Self {
        let device = &searched.gpu.device;
        let sizes = needed.map(|size| if size == 0 { 0 } else { size.next_power_of_two() });
        let [parts, numbers, sections] = sizes;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let number_buffer = device.buffer(numbers, usage);
        let bending = (sections > 0).then(|| {
            let query = uniform::<BendingQuery>(device);
            let sections = device.buffer(sections, usage);
            let group = device.group(
                &searched.kernels.bending_layout,
                &[
                    device.uniform_binding::<BendingQuery>(&query),
                    sections.as_entire_binding(),
                    number_buffer.as_entire_binding(),
                ],
            );
            BendingBuffers { query, sections, group }
        });
        Self {
            sizes,
            parts: device.buffer(parts * PART_SIZE, usage),
            numbers: number_buffer,
            bending,
        }
    }
}

impl Outputs {
    /// Buffers of at least these sizes.
    fn new(searched: Searched, inputs: &Inputs, needed: [u64; 2]) -> Self {
        let Searched { gpu, kernels, tree, .. } = searched;
        let (device, sizes) = (&gpu.device, needed.map(u64::next_power_of_two));
        let [parts, entries] = sizes;
        let down = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let query = uniform::<SearchQuery>(device);
        let heads = device.buffer(parts * HEAD, down);
        let entry_buffer = device.buffer(entries * ENTRY, down);
        let counters = device.buffer(COUNTERS, down);
        let limits = device.buffer(parts * LIMITS, BufferUsages::STORAGE);
        let readback = device.buffer(
            READINGS + COUNTERS + parts * HEAD + entries * ENTRY,
            BufferUsages::MAP_READ | BufferUsages::COPY_DST,
        );
        let group = device.group(
            &kernels.query_layout,
            &[
                device.uniform_binding::<SearchQuery>(&query),
                tree.nodes.as_entire_binding(),
                tree.triangles.as_entire_binding(),
                inputs.parts.as_entire_binding(),
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
            group,
        }
    }
}

fn uniform<R: Record>(device: &Device) -> Buffer {
    let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    device.buffer(device.uniform_stride::<R>(), usage)
}
