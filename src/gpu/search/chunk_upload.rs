//! The upload of a chunk of robots, in the layout of `chunk_layout`.
//!
//! # Memory
//! - `groups`: a record for each link group.
//! - `numbers`: the points of all robots, then their radii and caps. The device computes the points
//!   of robots that are sections of constant curvature.
//! - `sections`: what these points are computed from.
//!
//! A **shape** is the points of a robot, or its sections ([`Packed`]). All cores write shapes and
//! radii, each into memory of its own, from which the driver copies them to the device.

use super::chunk_layout::{ChunkLayout, GROUP_BYTES, RobotLayout, TASK_SIZE};
use super::device::Searched;
use super::robots::{BendingQuery, Packed};
use crate::answer::ProximityError;
use crate::threads::{each, threads};
use gpu_batch::wgpu::{
    BindGroup, Buffer, BufferSize, BufferUsages, QueueWriteBufferView, WriteOnly,
};
use gpu_batch::{Device, DeviceFailure, Record, Watch};

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
