//! The layout of a chunk of robots, and its upload in this layout.
//!
//! # Layout
//! - `groups`: a record for each link group.
//! - `numbers`: the points of all robots, then their radii and caps. The device computes the points
//!   of robots that are sections of constant curvature.
//! - `sections`: what these points are computed from.
//!
//! A **shape** is the points of a robot, or its sections ([`Packed`]). All cores write shapes and
//! radii, each into memory of its own, from which the driver copies them to the device.

use super::device::Searched;
use super::kernels::{GROUP_SIZE, MOST_GATHERED};
use super::robots::{BendingQuery, Packed};
use crate::answer::ProximityError;
use crate::threads::{each, threads};
use gpu_batch::wgpu::{
    BindGroup, Buffer, BufferSize, BufferUsages, QueueWriteBufferView, WriteOnly,
};
use gpu_batch::{Device, DeviceFailure, Record, Watch};
use std::ops::Range;

/// Robots that one task of the CPU takes.
pub(super) const TASK_SIZE: usize = 64;
/// Bytes of a link group.
pub(super) const GROUP_BYTES: u64 = 16;
/// The most links of a robot on the device.
const MOST_LINKS: usize = 1 << 20;
/// The number of candidates of a chunk fits into a `u32`, which counts them on the device.
const _: () = assert!(MOST_LINKS as u64 * (MOST_GATHERED as u64) < 1 << 32);

/// The layout of a chunk. Its memory is reused by a later chunk.
#[derive(Default)]
pub(super) struct ChunkLayout {
    /// The robots of the batch.
    pub robots: Range<usize>,
    /// The layout of each robot of the chunk.
    pub layouts: Vec<RobotLayout>,
    /// How many link groups all robots have.
    pub groups: u32,
    /// How many links all robots have.
    pub links: u64,
    /// How many `f32` all points take.
    pub points_size: u32,
    /// How many `f32` all radii and caps take.
    pub radii_size: u32,
    /// How the device computes the points, unless they are uploaded.
    pub bending: Option<BendingQuery>,
}

/// The layout of a robot in a chunk.
#[derive(Clone, Copy, Default)]
pub(super) struct RobotLayout {
    pub first_group: u32,
    /// The number of links, or 0 if the device does not search for the robot.
    pub links: u32,
    pub is_for_cpu: bool,
    /// The index of the first `f32` of its points, among the numbers of the chunk.
    points_at: u32,
    /// The index of the first `f32` of its radii and caps.
    radii_at: u32,
    /// Whether it uses the radii and caps of the robot before.
    shares_radii: bool,
}

/// The robots of the chunk that begins at `first`.
pub(super) fn chunk_from<R: Packed>(robots: R, first: usize) -> Range<usize> {
    const { assert!(R::CHUNK * GROUP_SIZE as usize <= MOST_LINKS) };
    let (mut end, mut groups) = (first, 0);
    while end < robots.len() {
        groups += robots.links(end).div_ceil(GROUP_SIZE as usize);
        if groups > R::CHUNK && end > first {
            break;
        }
        end += 1;
    }
    first..end
}

impl ChunkLayout {
    /// Lays out the robots of a chunk. All points come first, then all radii and caps.
    pub(super) fn lay_out(&mut self, robots: impl Packed, chunk: Range<usize>) {
        let first = chunk.start;
        self.layouts.clear();
        self.layouts.resize(chunk.len(), RobotLayout::default());
        let mut shares: Vec<_> = self.layouts.chunks_mut(TASK_SIZE).collect();
        each(&mut shares, |share, layouts| {
            for (robot, layout) in (first + share * TASK_SIZE..).zip(layouts.iter_mut()) {
                let links = robots.links(robot);
                layout.is_for_cpu = links > MOST_LINKS;
                layout.links = if layout.is_for_cpu { 0 } else { links as u32 };
                layout.shares_radii = robot > first && robots.is_like_before(robot);
            }
        });
        (self.groups, self.points_size, self.links) = (0, 0, 0);
        for layout in &mut self.layouts {
            (layout.points_at, layout.first_group) = (self.points_size, self.groups);
            self.points_size += layout.points_size();
            self.groups += layout.groups();
            self.links += u64::from(layout.links);
        }
        self.radii_size = 0;
        let mut last_radii_at = self.points_size;
        for layout in &mut self.layouts {
            if !layout.shares_radii {
                last_radii_at = self.points_size + self.radii_size;
            }
            self.radii_size += layout.radii_size();
            layout.radii_at = last_radii_at;
        }
        self.bending = robots.bending(chunk.len());
        self.robots = chunk;
    }

    /// How many link groups or links share the entries of a chunk.
    pub(super) fn items(&self, is_about_links: bool) -> u64 {
        if is_about_links { self.links } else { self.groups.into() }
    }
}

impl RobotLayout {
    pub(super) fn groups(&self) -> u32 {
        self.links.div_ceil(GROUP_SIZE)
    }

    /// How many `f32` its points take.
    fn points_size(&self) -> u32 {
        if self.links == 0 { 0 } else { 3 * (self.links + 1) }
    }

    /// How many `f32` its radii and caps take; 0 if it uses the radii and caps of the
    /// robot before.
    pub(super) fn radii_size(&self) -> u32 {
        if self.shares_radii { 0 } else { 2 * self.links }
    }

    pub(super) fn groups_bytes(&self) -> usize {
        GROUP_BYTES as usize * self.groups() as usize
    }

    /// Writes the link groups of the robot: the indices of points and radii, the number of links,
    /// and the error of the points. A group without links has no candidates.
    pub(super) fn write_groups(&self, more_error: f32, bytes: &mut [u8]) {
        let groups = bytes.chunks_exact_mut(GROUP_BYTES as usize);
        for (group, first_link) in groups.zip((0..).step_by(GROUP_SIZE as usize)) {
            let links = self.links.saturating_sub(first_link).min(GROUP_SIZE);
            let points_at = self.points_at + 3 * first_link;
            let radii_at = self.radii_at + 2 * first_link;
            let words = [points_at, radii_at, links, more_error.to_bits()];
            group.copy_from_slice(words.map(u32::to_ne_bytes).as_flattened());
        }
    }
}

/// The buffers of an upload.
pub(super) struct Inputs {
    /// What the buffers hold: a number of link groups, bytes of numbers, and bytes of sections.
    sizes: [u64; 3],
    pub groups: Buffer,
    pub numbers: Buffer,
    /// If the device computes the points.
    pub bending: Option<BendingBuffers>,
}

/// The buffers from which the device computes points.
pub(super) struct BendingBuffers {
    pub query: Buffer,
    sections: Buffer,
    pub bindings: BindGroup,
}

/// Memory of the upload here, which a later upload reuses.
#[derive(Default)]
pub(super) struct Upload {
    pub inputs: Option<Inputs>,
    group_bytes: Vec<u8>,
}

impl Upload {
    /// Uploads the robots of a layout. Writes the errors of bad robots to `out`, the answers of the
    /// batch, and marks the robots that the device cannot search for. Returns whether the buffers
    /// are new.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last.
    pub(super) fn write<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        layout: &mut ChunkLayout,
        out: &mut [Result<A, ProximityError>],
        watch: &mut Watch,
    ) -> Result<bool, DeviceFailure> {
        let Searched { gpu, frame, .. } = searched;
        let points_bytes = 4 * u64::from(layout.points_size);
        let shapes: usize = layout.layouts.iter().map(|one| robots.shape_size(one.links)).sum();
        let mut base = Vec::new();
        robots.write_base(frame, &mut base);
        let needed = [
            u64::from(layout.groups),
            points_bytes + 4 * u64::from(layout.radii_size),
            if layout.bending.is_some() { (base.len() + shapes) as u64 } else { 0 },
        ];
        let are_new = !self.inputs.as_ref().is_some_and(|inputs| fits(inputs.sizes, needed));
        if are_new {
            self.inputs = None;
        }
        let inputs = self.inputs.get_or_insert_with(|| Inputs::new(searched, needed));
        let (device, queue) = (&gpu.device, gpu.device.queue());
        let mut upload = |buffer: &Buffer, offset: &mut u64, size: usize| {
            let Some(size) = BufferSize::new(size as u64) else { return Ok(None) };
            let view = device.upload(watch, buffer, *offset, size)?;
            *offset += size.get();
            Ok(Some(view))
        };
        self.group_bytes.resize(layout.groups as usize * GROUP_BYTES as usize, 0);
        let mut all_groups = &mut self.group_bytes[..];
        let (mut radii_at, mut shapes_at) = (points_bytes, 0);
        let mut shape_buffer = &inputs.numbers;
        if let Some((_, bending)) = layout.bending.zip(inputs.bending.as_ref()) {
            queue.write_buffer(&bending.sections, 0, &base);
            (shape_buffer, shapes_at) = (&bending.sections, base.len() as u64);
        }

        let first = layout.robots.start;
        let share_size = layout.layouts.len().div_ceil(threads()).max(TASK_SIZE);
        let mut shares = Vec::new();
        let outs = out[layout.robots.clone()].chunks_mut(share_size);
        for (layouts, out) in layout.layouts.chunks_mut(share_size).zip(outs) {
            let sum = |of: &dyn Fn(&RobotLayout) -> usize| layouts.iter().map(of).sum();
            let groups =
                all_groups.split_off_mut(..sum(&RobotLayout::groups_bytes)).unwrap_or_default();
            let radii = sum(&|one| 4 * one.radii_size() as usize);
            let radii = upload(&inputs.numbers, &mut radii_at, radii)?;
            let shapes = sum(&|one| robots.shape_size(one.links));
            let shapes = upload(shape_buffer, &mut shapes_at, shapes)?;
            shares.push((layouts, out, groups, radii, shapes));
        }
        each(&mut shares, |share, (layouts, out, groups, radii, shapes)| {
            let robots_of_share = first + share * share_size..;
            let (mut all_radii, mut all_shapes) = (whole(radii), whole(shapes));
            for ((robot, layout), out) in
                robots_of_share.zip(layouts.iter_mut()).zip(out.iter_mut())
            {
                let shape = take_front(&mut all_shapes, robots.shape_size(layout.links));
                let radii = take_front(&mut all_radii, 4 * layout.radii_size() as usize);
                let groups = groups.split_off_mut(..layout.groups_bytes()).unwrap_or_default();
                if layout.is_for_cpu {
                    continue;
                }
                robots.write_radii(robot, frame, radii);
                let mut more_error = 0.0;
                match robots.write_shape(robot, frame, shape) {
                    Ok(Some(error)) => more_error = error,
                    Ok(None) => (layout.links, layout.is_for_cpu) = (0, true),
                    Err(error) => {
                        *out = Err(error);
                        layout.links = 0;
                    }
                }
                layout.write_groups(more_error, groups);
            }
        });
        drop(shares);
        queue.write_buffer(&inputs.groups, 0, &self.group_bytes);
        Ok(are_new)
    }
}

impl Inputs {
    /// Buffers of at least these sizes.
    fn new(searched: Searched, needed: [u64; 3]) -> Self {
        let device = &searched.gpu.device;
        let sizes = needed.map(|size| if size == 0 { 0 } else { size.next_power_of_two() });
        let [groups, numbers, sections] = sizes;
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let number_buffer = device.buffer(numbers, usage);
        let bending = (sections > 0).then(|| {
            let query = uniform::<BendingQuery>(device);
            let sections = device.buffer(sections, usage);
            let bindings = device.group(
                &searched.kernels.bending_layout,
                &[
                    device.uniform_binding::<BendingQuery>(&query),
                    sections.as_entire_binding(),
                    number_buffer.as_entire_binding(),
                ],
            );
            BendingBuffers { query, sections, bindings }
        });
        Self {
            sizes,
            groups: device.buffer(groups * GROUP_BYTES, usage),
            numbers: number_buffer,
            bending,
        }
    }
}

/// A buffer for one record of parameters.
pub(super) fn uniform<R: Record>(device: &Device) -> Buffer {
    let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    device.buffer(device.uniform_stride::<R>(), usage)
}

/// Whether buffers are large enough, and at most 16 times too large.
pub(super) fn fits<const N: usize>(have: [u64; N], need: [u64; N]) -> bool {
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
