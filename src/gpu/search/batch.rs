//! A batch of robots on the device: the device finds candidates, the CPU measures them.
//!
//! # Definitions
//! - **Part**: up to [`PART`] links of one robot; a workgroup with a thread for each link.
//! - d(t): the distance of triangle t from a link. `lower`, `upper`, e: its bounds on the device
//!   and their error (see the module `bounds`), `lower - e <= d <= max(upper + e, 0)`.
//! - D: an upper bound on the distance that is wanted: `max(upper + e, 0)` of some triangle of the
//!   link (per link) or of the part (minimum), or the margin, rounded up (clears, within). D never
//!   grows.
//! - T: the lowest triangle with `upper + e < 0` so far, of the link or the part; none at first,
//!   and never for a margin. Such a triangle certainly touches.
//! - t is **wanted** if `lower <= D + e` and `t <= T`.
//!
//! # Algorithm
//! 1. **Pack**, on the CPU: the points and radii of a chunk of robots, in the search frame.
//! 2. **First pass**, on the device (`search`): visit the boxes that may hold a wanted triangle,
//!    the nearer child first. A thread keeps the wanted triangles it meets, up to [`ROOM`]. At the
//!    end it keeps only the triangles that are still wanted. For a margin, a triangle with
//!    `upper + e <= margin` settles the robot.
//! 3. **Second pass**, on the device (`gather`): the parts in which a wanted triangle found no room
//!    gather all wanted triangles for the final D and T. For all triangles within a margin this is
//!    the only pass.
//! 4. **Repeat**: if the candidates of a chunk find too little room, the chunk is searched once
//!    more, with the room that they need.
//! 5. **Measure**, on the CPU: all candidates, in double precision. The best is the answer.
//! 6. **Remainder**, on the CPU: robots that the device cannot represent, whose candidates do not
//!    fit, or whose loops the driver stopped take the search on the CPU. They are counted.
//!
//! Chunks overlap: the CPU packs a chunk and measures the chunk before while the device works.
//!
//! # Claim
//! The answers equal the answers of [`BvhSearch`](crate::proximity::BvhSearch) bit for bit.
//!
//! **Proof.** Let t be the nearest triangle of the link, or of the part with any of its links, at
//! distance d(t); of equals the lowest. It is wanted at all times:
//! 1. `lower(t) - e <= d(t)`, and d(t) is at most each `max(upper + e, 0)`, so `lower(t) <= D + e`.
//! 2. If T is a triangle, it touches. So d(t) = 0, and t is not higher than T.
//!
//! The same holds for every link of the part that has t. Boxes are left out only if they hold no
//! wanted triangle: claim 1 of `bounds`. So t is among the candidates, unless it found no room in
//! the first pass; then the part takes the second pass, where t is wanted too. The CPU measures all
//! candidates with the function that measures in every engine. For a margin, every triangle within
//! it is wanted, and a decision is settled early only if a link is certainly within it.

use super::bending::BendingQuery;
use super::bounds::FAR;
use super::device::{DeviceTree, SearchKernels};
#[cfg(doc)]
use super::kernels::ROOM;
use super::kernels::{
    BENDING_THREADS, FOUND, FULL, HIT, MOST_GATHERED, PART, Question, STOPPED, SearchQuery,
};
use super::robots::Packed;
use crate::answer::ProximityError;
use crate::gpu::opened::Opened;
use crate::mesh::SearchFrame;
use crate::threads::each;
use gpu_batch::wgpu::{BindGroup, Buffer, BufferUsages, ComputePassDescriptor};
use gpu_batch::{Clock, Device, DeviceFailure, READINGS, Record, Submitted, Watch};
use std::mem::take;
use std::ops::Range;
use std::time::Duration;

/// Robots that one task of the CPU takes.
const TASK_SIZE: usize = 64;
/// Bytes of a part, a head, an entry, the counters, and the limits of a part.
const PART_SIZE: u64 = 16;
const HEAD: u64 = 8;
const ENTRY: u64 = 8;
const COUNTERS: u64 = 16;
const LIMITS: u64 = 8 * PART as u64;
/// The least room for entries, for each kind of question: per link if the query answers each link,
/// else per part. The room of a chunk follows what the chunks before needed, and all of it is read
/// back. For a margin, few robots have a candidate.
const LEAST_ROOM: [u64; Question::KINDS] = [4, 16, 1, 32];
/// The least room for entries of a chunk.
const LEAST_ENTRIES: u64 = 1 << 10;
/// The most links of a robot on the device.
const MOST_LINKS: usize = 1 << 20;
/// The number of all candidates of a chunk fits into a word.
const _: () = assert!(MOST_LINKS as u64 * (MOST_GATHERED as u64) < 1 << 32);

/// What the device has found about a robot.
pub(super) struct Found<'a> {
    /// A link is certainly within the margin.
    pub is_hit: bool,
    /// The links and triangles that may be the answer.
    pub candidates: &'a [(u32, u32)],
}

/// The mesh as a batch needs it.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a> {
    pub gpu: &'a Opened,
    pub kernels: &'a SearchKernels,
    pub tree: &'a DeviceTree,
    pub frame: &'a SearchFrame,
}

/// Memory of the batches, here and on the device, reused by the next.
pub(super) struct Batches {
    watch: Watch,
    /// Two chunks in turn.
    slots: [Slot; 2],
    /// The room for entries, for each kind of question: see [`LEAST_ROOM`].
    room: [u64; Question::KINDS],
    /// The robots of the last batch that the device left to the CPU.
    pub left: Vec<usize>,
    /// The time of the kernels of the last batch, if the device keeps time.
    pub device_time: Option<Duration>,
    /// Nodes, leaves and links of the last batch, if the kernels count them.
    pub work: [u64; 3],
}

/// A chunk of robots.
#[derive(Default)]
struct Slot {
    robots: Range<usize>,
    layouts: Vec<Layout>,
    parts: u32,
    links: u64,
    /// What the room for entries is in proportion to: links or parts.
    items: u64,
    room: u32,
    part_bytes: Vec<u8>,
    /// The numbers of all points.
    points: u32,
    shapes: Vec<u8>,
    radii: Vec<u8>,
    bending: Option<BendingQuery>,
    buffers: Option<SlotBuffers>,
    submitted: Option<Submitted>,
}

/// Where a robot of a chunk is.
#[derive(Clone, Copy, Default)]
struct Layout {
    first_part: u32,
    /// The number of links, or 0 if the device is not asked about the robot.
    links: u32,
    is_left: bool,
    /// The error of its points beside rounding.
    more_error: f32,
    /// Where its points and its radii begin, in numbers.
    points: u32,
    radii: u32,
    /// Whether the radii equal the radii of the robot before.
    is_alike: bool,
}

/// The buffers of a chunk, for a number of parts, of bytes of numbers, of entries, and of bytes of
/// shapes.
struct SlotBuffers {
    sizes: [u64; 4],
    query: Buffer,
    parts: Buffer,
    numbers: Buffer,
    heads: Buffer,
    entries: Buffer,
    counters: Buffer,
    readback: Buffer,
    clock: Option<Clock>,
    group: BindGroup,
    /// If the device computes the points.
    bending: Option<BendingBuffers>,
}

struct BendingBuffers {
    query: Buffer,
    shapes: Buffer,
    group: BindGroup,
}

impl Batches {
    /// `watch` has already reported the failures before the first batch.
    pub(super) fn new(watch: Watch) -> Self {
        Self {
            watch,
            slots: Default::default(),
            room: LEAST_ROOM,
            left: Vec::new(),
            device_time: None,
            work: [0; 3],
        }
    }

    /// Drops the buffers, after a failure or with another tree.
    pub(super) fn forget(&mut self) {
        self.slots = Default::default();
    }

    /// Answers all robots except the robots in [`Batches::left`]. `answer` gets a robot's number and
    /// what was found, and writes the answer. If it returns false, the robot is left to the CPU.
    ///
    /// # Errors
    /// The device has failed since the last batch, or did not answer.
    pub(super) fn run<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        question: Question,
        out: &mut [Result<A, ProximityError>],
        answer: impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool + Sync,
    ) -> Result<(), DeviceFailure> {
        self.left.clear();
        self.work = [0; 3];
        self.device_time = searched.gpu.device.tick().map(|_| Duration::ZERO);
        let (mut next, mut turn) = (0, 0);
        let mut pending = None;
        while next < robots.len() {
            let chunk = chunk_from(robots, next);
            next = chunk.end;
            self.slots[turn].pack(searched, robots, chunk, out);
            let room = self.room[question.kind()];
            self.slots[turn].submit(searched, question, room, &mut self.watch)?;
            if let Some(before) = pending.replace(turn) {
                self.finish(before, searched, question, out, &answer)?;
            }
            turn = 1 - turn;
        }
        pending.map_or(Ok(()), |last| self.finish(last, searched, question, out, &answer))
    }

    /// Steps 4 and 5, for the chunk in a slot.
    fn finish<A: Send>(
        &mut self,
        slot: usize,
        searched: Searched,
        question: Question,
        out: &mut [Result<A, ProximityError>],
        answer: &(impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool + Sync),
    ) -> Result<(), DeviceFailure> {
        let Self { watch, slots, room, left, device_time, work } = self;
        let slot = &mut slots[slot];
        let (first, device) = (slot.robots.start, &searched.gpu.device);
        left.extend((first..).zip(&slot.layouts).filter(|(_, layout)| layout.is_left).map(|x| x.0));
        let (room, least) = (&mut room[question.kind()], LEAST_ROOM[question.kind()]);
        let out = &mut out[slot.robots.clone()];
        // With too little room the chunk is searched once more.
        let mut is_last = false;
        while let Some((submitted, buffers)) = slot.submitted.take().zip(slot.buffers.as_ref()) {
            let (parts, layouts) = (slot.parts as usize, &slot.layouts);
            let mut is_read = false;
            device.read(watch, submitted, &buffers.readback, |bytes| {
                let (readings, bytes) = bytes.split_at(READINGS as usize);
                *device_time = device_time
                    .zip(Clock::time_between(device, readings))
                    .map(|(sum, more)| sum + more);
                let (counters, bytes) = bytes.split_at(COUNTERS as usize);
                let mut counters = words(counters).map(u64::from);
                let needed = counters.next().unwrap_or(0);
                *room = next_room(*room, least, needed, slot.items);
                let has_room = needed <= slot.room.into();
                is_read = is_last || has_room || slot.room_of(device, *room) <= slot.room;
                if !is_read {
                    return Ok(());
                }
                work.iter_mut().zip(counters).for_each(|(sum, more)| *sum += more);
                let (heads, entries) = bytes.split_at(parts * HEAD as usize);
                let heads = Heads { heads, entries, room: slot.room };
                let shares = out.chunks_mut(TASK_SIZE).zip(layouts.chunks(TASK_SIZE)).enumerate();
                let mut shares: Vec<_> = shares
                    .map(|(share, (out, layouts))| {
                        (first + share * TASK_SIZE, layouts, out, Ok(Vec::new()))
                    })
                    .collect();
                each(&mut shares, |_, (first, layouts, out, left)| {
                    *left = heads.answer(*first, layouts, out, answer);
                });
                for (.., share) in shares {
                    left.extend(share?);
                }
                Ok(())
            })?;
            if !is_read {
                is_last = true;
                slot.submit(searched, question, *room, watch)?;
            }
        }
        Ok(())
    }
}

/// The room for entries of each item after a chunk of `items` that needed `needed` entries. The
/// room grows at once and shrinks slowly, because all room of a chunk is read back.
fn next_room(room: u64, least: u64, needed: u64, items: u64) -> u64 {
    let each = (needed + needed / 8).div_ceil(items.max(1));
    each.max(room - room / 8).max(least)
}

/// The chunk of robots from `first` on.
fn chunk_from<R: Packed>(robots: R, first: usize) -> Range<usize> {
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

/// The words in some bytes of the device.
fn words(bytes: &[u8]) -> impl Iterator<Item = u32> + Clone + '_ {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word))
}

/// The pairs of words in some bytes of the device.
fn pairs(bytes: &[u8]) -> impl Iterator<Item = (u32, u32)> + Clone + '_ {
    let word = |pair: &[u8; 8], at| {
        u32::from_ne_bytes([pair[at], pair[at + 1], pair[at + 2], pair[at + 3]])
    };
    bytes.as_chunks::<8>().0.iter().map(move |pair| (word(pair, 0), word(pair, 4)))
}

/// What came back about the parts of a chunk.
#[derive(Clone, Copy)]
struct Heads<'a> {
    heads: &'a [u8],
    entries: &'a [u8],
    /// The number of entries that had room.
    room: u32,
}

impl Heads<'_> {
    /// Answers robots from the number `first` on. Returns the robots that are left to the CPU.
    ///
    /// # Errors
    /// A part was not answered.
    fn answer<A>(
        self,
        first: usize,
        layouts: &[Layout],
        out: &mut [Result<A, ProximityError>],
        answer: &impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool,
    ) -> Result<Vec<usize>, DeviceFailure> {
        let (mut left, mut candidates) = (Vec::new(), Vec::new());
        for ((number, layout), out) in (first..).zip(layouts).zip(out) {
            if layout.links == 0 {
                continue;
            }
            candidates.clear();
            let (mut is_hit, mut is_left) = (false, false);
            let parts = layout.links.div_ceil(PART) as usize;
            let heads = &self.heads[layout.first_part as usize * HEAD as usize..];
            for ((begin, status), first_link) in
                pairs(heads).take(parts).zip((0..).step_by(PART as usize))
            {
                match status {
                    HIT => is_hit = true,
                    FULL | STOPPED => is_left = true,
                    FOUND.. => {
                        let (begin, count) = (begin as usize, (status - FOUND) as usize);
                        if begin + count > self.room as usize {
                            return Err(DeviceFailure::Unanswered);
                        }
                        let bytes =
                            &self.entries[begin * ENTRY as usize..][..count * ENTRY as usize];
                        candidates.extend(
                            pairs(bytes).map(|(link, triangle)| (first_link + link, triangle)),
                        );
                    }
                    _ => return Err(DeviceFailure::Unanswered),
                }
            }
            let found = Found { is_hit, candidates: &candidates };
            // A hit settles a robot, regardless of its other parts.
            if is_left && !is_hit || !answer(number, found, out) {
                left.push(number);
            }
        }
        Ok(left)
    }
}

impl Slot {
    /// Step 1. Writes the errors of bad robots to `out`.
    fn pack<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        chunk: Range<usize>,
        out: &mut [Result<A, ProximityError>],
    ) {
        let (first, frame) = (chunk.start, searched.frame);
        self.layouts.clear();
        self.layouts.resize(chunk.len(), Layout::default());
        self.robots = chunk.clone();
        let mut shares: Vec<_> = self.layouts.chunks_mut(TASK_SIZE).collect();
        each(&mut shares, |share, layouts| {
            for (robot, layout) in (first + share * TASK_SIZE..).zip(layouts.iter_mut()) {
                let links = robots.links(robot);
                layout.is_left = links > MOST_LINKS;
                layout.links = if layout.is_left { 0 } else { links as u32 };
                layout.is_alike = robot > first && robots.is_like_before(robot);
            }
        });
        let (mut points, mut radii, mut parts) = (0, 0, 0);
        for layout in &mut self.layouts {
            (layout.points, layout.first_part) = (points, parts);
            points += 3 * (layout.links + 1);
            parts += layout.links.div_ceil(PART);
        }
        self.links = self.layouts.iter().map(|layout| u64::from(layout.links)).sum();
        let mut before = points;
        for layout in &mut self.layouts {
            if !layout.is_alike {
                before = points + radii;
                radii += 2 * layout.links;
            }
            layout.radii = before;
        }
        (self.parts, self.points) = (parts, points);
        self.bending = robots.bending(chunk.len());
        self.shapes.clear();
        robots.write_base(frame, &mut self.shapes);
        let base = self.shapes.len();
        let shapes: usize = self.layouts.iter().map(|one| robots.shape_size(one.links)).sum();
        for (bytes, size) in [
            (&mut self.part_bytes, parts as usize * PART_SIZE as usize),
            (&mut self.radii, 4 * radii as usize),
        ] {
            bytes.clear();
            bytes.resize(size, 0);
        }
        self.shapes.resize(base + shapes, 0);

        // Each task writes the parts, the shapes and the radii of its robots.
        let (mut all_shapes, mut all_radii) = (&mut self.shapes[base..], &mut self.radii[..]);
        let mut all_parts = &mut self.part_bytes[..];
        let mut shares = Vec::with_capacity(chunk.len().div_ceil(TASK_SIZE));
        let outs = out[chunk].chunks_mut(TASK_SIZE);
        for (layouts, out) in self.layouts.chunks_mut(TASK_SIZE).zip(outs) {
            let count = |of: &dyn Fn(&Layout) -> u32| layouts.iter().map(|l| of(l) as usize).sum();
            let shapes = layouts.iter().map(|layout| robots.shape_size(layout.links)).sum();
            let radii: usize = count(&|layout| if layout.is_alike { 0 } else { 2 * layout.links });
            let parts: usize = count(&|layout| layout.links.div_ceil(PART));
            let shapes = take_front(&mut all_shapes, shapes);
            let radii = take_front(&mut all_radii, 4 * radii);
            let parts = take_front(&mut all_parts, PART_SIZE as usize * parts);
            shares.push((layouts, out, shapes, radii, parts));
        }
        each(&mut shares, |share, (layouts, out, shapes, radii, parts)| {
            let robots_of_share = first + share * TASK_SIZE..;
            for ((robot, layout), out) in
                robots_of_share.zip(layouts.iter_mut()).zip(out.iter_mut())
            {
                let shape = take_front(shapes, robots.shape_size(layout.links));
                if layout.is_left {
                    continue;
                }
                let links = layout.links as usize;
                let own = if layout.is_alike { 0 } else { 8 * links };
                robots.write_radii(robot, frame, take_front(radii, own));
                let parts = take_front(parts, PART_SIZE as usize * links.div_ceil(PART as usize));
                match robots.write_shape(robot, frame, shape) {
                    Ok(Some(error)) => {
                        layout.more_error = error;
                        write_parts(parts, layout);
                    }
                    Ok(None) => (layout.links, layout.is_left) = (0, true),
                    Err(error) => {
                        *out = Err(error);
                        layout.links = 0;
                    }
                }
            }
        });
    }

    /// The room for the entries of the chunk, for this room for each item.
    fn room_of(&self, device: &Device, room: u64) -> u32 {
        let room = (room * self.items).max(LEAST_ENTRIES);
        // No rank of a candidate or a byte exceeds a word.
        room.min(device.largest_binding() / ENTRY).min(1 << 28) as u32
    }

    /// Steps 2 and 3.
    ///
    /// # Errors
    /// The device has failed since it was asked last.
    fn submit(
        &mut self,
        searched: Searched,
        question: Question,
        room: u64,
        watch: &mut Watch,
    ) -> Result<(), DeviceFailure> {
        let Searched { gpu, kernels, frame, .. } = searched;
        let device = &gpu.device;
        if self.parts == 0 {
            return Ok(());
        }
        let parts = u64::from(self.parts);
        self.items = if question.is_about_links() { self.links } else { parts };
        self.room = self.room_of(device, room);
        let room = u64::from(self.room);
        let points = 4 * u64::from(self.points);
        let numbers = points + self.radii.len() as u64;
        let [parts_size, numbers, room_size, shapes] =
            [parts, numbers, room, self.shapes.len() as u64].map(u64::next_power_of_two);
        let shapes = if self.bending.is_some() { shapes } else { 0 };
        let sizes = [parts_size, numbers, room_size, shapes];
        let buffers = match self.buffers.take() {
            Some(buffers) if fits(buffers.sizes, sizes) => buffers,
            _ => SlotBuffers::new(searched, sizes),
        };
        let (margin, certain) = margins(question, frame);
        let record = SearchQuery { parts: self.parts, margin, certain, room: self.room };
        let mut bytes = Vec::new();
        record.write(device.precision(), &mut bytes);
        device.queue().write_buffer(&buffers.query, 0, &bytes);
        device.queue().write_buffer(&buffers.parts, 0, &self.part_bytes);
        device.queue().write_buffer(&buffers.numbers, points, &self.radii);
        let bending = self.bending.zip(buffers.bending.as_ref());
        let shapes = bending.map_or(&buffers.numbers, |(_, buffers)| &buffers.shapes);
        device.queue().write_buffer(shapes, 0, &self.shapes);

        let mut encoder = device.raw().create_command_encoder(&Default::default());
        encoder.clear_buffer(&buffers.heads, 0, Some(parts * HEAD));
        encoder.clear_buffer(&buffers.counters, 0, None);
        let timestamp_writes = buffers.clock.as_ref().map(Clock::writes);
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: None, timestamp_writes });
        if let Some((query, buffers)) = bending {
            bytes.clear();
            query.write(device.precision(), &mut bytes);
            device.queue().write_buffer(&buffers.query, 0, &bytes);
            pass.set_pipeline(&kernels.bend);
            pass.set_bind_group(0, &buffers.group, &[0]);
            device.dispatch(&mut pass, (self.points / 3).div_ceil(BENDING_THREADS));
        }
        pass.set_bind_group(0, &buffers.group, &[0]);
        for kernel in &kernels.passes[question.kind()] {
            pass.set_pipeline(kernel);
            device.dispatch(&mut pass, self.parts);
        }
        drop(pass);
        let (to, mut end) = (&buffers.readback, READINGS);
        for (from, size) in [
            (&buffers.counters, COUNTERS),
            (&buffers.heads, parts * HEAD),
            (&buffers.entries, room * ENTRY),
        ] {
            encoder.copy_buffer_to_buffer(from, 0, to, end, Some(size));
            end += size;
        }
        if let Some(clock) = &buffers.clock {
            clock.copy(&mut encoder, to);
        }
        self.submitted = Some(device.submit(watch, encoder.finish(), to, end)?);
        self.buffers = Some(buffers);
        Ok(())
    }
}

/// Whether buffers are large enough, and not far too large.
fn fits(have: [u64; 4], need: [u64; 4]) -> bool {
    have.into_iter()
        .zip(need)
        .all(|(have, need)| need <= have && (need == 0 || have <= 16 * need.max(1 << 10)))
}

/// Takes the front off a slice.
fn take_front<'a>(slice: &mut &'a mut [u8], count: usize) -> &'a mut [u8] {
    let (front, rest) = take(slice).split_at_mut(count);
    *slice = rest;
    front
}

fn write_parts(bytes: &mut [u8], layout: &Layout) {
    for (bytes, first) in
        bytes.chunks_exact_mut(PART_SIZE as usize).zip((0..).step_by(PART as usize))
    {
        let links = (layout.links - first).min(PART);
        let error = layout.more_error.to_bits();
        let words = [layout.points + 3 * first, layout.radii + 2 * first, links, error];
        bytes.copy_from_slice(words.map(u32::to_ne_bytes).as_flattened());
    }
}

/// The margin in the search frame, rounded up and rounded down, as bits.
fn margins(question: Question, frame: &SearchFrame) -> (u32, u32) {
    let Some(margin) = question.margin() else { return (FAR.to_bits(), 0) };
    let nearest = (margin * frame.scale).min(FAR.into()) as f32;
    let (up, down) = (nearest.next_up().min(FAR), nearest.next_down().max(0.0));
    (up.to_bits(), if nearest < FAR { down } else { FAR }.to_bits())
}

impl SlotBuffers {
    fn new(searched: Searched, sizes: [u64; 4]) -> Self {
        let Searched { gpu, kernels, tree, .. } = searched;
        let (device, [parts, numbers, entries, shapes]) = (&gpu.device, sizes);
        let up = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let down = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let query = device.buffer(
            device.uniform_stride::<SearchQuery>(),
            BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        );
        let part_buffer = device.buffer(parts * PART_SIZE, up);
        let number_buffer = device.buffer(numbers, up);
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
                part_buffer.as_entire_binding(),
                number_buffer.as_entire_binding(),
                heads.as_entire_binding(),
                entry_buffer.as_entire_binding(),
                counters.as_entire_binding(),
                limits.as_entire_binding(),
            ],
        );
        let bending = (shapes > 0).then(|| {
            let query = device.buffer(
                device.uniform_stride::<BendingQuery>(),
                BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            );
            let shapes = device.buffer(shapes, up);
            let group = device.group(
                &kernels.bending_layout,
                &[
                    device.uniform_binding::<BendingQuery>(&query),
                    shapes.as_entire_binding(),
                    number_buffer.as_entire_binding(),
                ],
            );
            BendingBuffers { query, shapes, group }
        });
        Self {
            sizes,
            bending,
            query,
            parts: part_buffer,
            numbers: number_buffer,
            heads,
            entries: entry_buffer,
            counters,
            readback,
            clock: Clock::new(device),
            group,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_room_grows_at_once_and_shrinks_slowly() {
        for (needed, items) in [(0, 1), (400, 100), (1000, 100), (102_400, 100)] {
            let room = next_room(4, 4, needed, items);
            assert!(room >= 4 && room * items >= needed, "{needed}: {room}");
        }
        let mut room = next_room(4, 4, 102_400, 100);
        let after = next_room(room, 4, 100, 100);
        assert!(room / 2 < after && after < room, "{room} {after}");
        for _ in 0..100 {
            room = next_room(room, 4, 100, 100);
        }
        assert!(room < 8, "{room}");
    }
}
