//! Many small problems at once, a thread each: what the narrow phase's pairs and the root finders share.

use super::GpuError;
use super::clock::{Clock, READINGS};
use super::opened::Gpu;
use super::shaders::Kernel;
use crate::proximity::DeviceFailure;
use parry3d_f64::math::Real;
use std::time::Duration;
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, ComputePipeline};

/// Threads of a workgroup.
const THREADS: u64 = 64;

/// A kernel that turns records of numbers into records of numbers.
pub(super) struct Batch {
    gpu: Gpu,
    layout: BindGroupLayout,
    kernel: ComputePipeline,
    /// Numbers of a problem and of an answer.
    problem: u64,
    answer: u64,
    buffers: Option<Buffers>,
    bytes: Vec<u8>,
    pub device_time: Option<Duration>,
}

/// Buffers for so many problems.
struct Buffers {
    room: u64,
    problems: Buffer,
    answers: Buffer,
    readback: Buffer,
    clock: Option<Clock>,
    group: BindGroup,
}

impl Batch {
    pub(super) fn new(
        gpu: &Gpu,
        kernel: Kernel,
        coefficients: u32,
        constants: &[(&str, f64)],
        problem: u64,
        answer: u64,
    ) -> Result<Self, GpuError> {
        let layout = gpu.0.device.layout(&[Some(false), Some(true)]);
        let kernel = gpu.0.device.compile(kernel, coefficients, &layout, constants)?;
        let gpu = gpu.clone();
        Ok(Self { gpu, layout, kernel, problem, answer, buffers: None, bytes: Vec::new(), device_time: None })
    }

    /// Solves as many problems as `numbers` are for; the answers' numbers go to `take`.
    ///
    /// # Errors
    /// The device has failed.
    pub(super) fn run(
        &mut self,
        numbers: impl Iterator<Item = Real>,
        take: &mut dyn FnMut(&mut dyn Iterator<Item = Real>),
    ) -> Result<(), DeviceFailure> {
        let gpu = self.gpu.0.clone();
        let (device, size) = (&gpu.device, gpu.device.precision.size());
        self.device_time = device.tick.map(|_| Duration::ZERO);
        let mut bytes = std::mem::take(&mut self.bytes);
        bytes.clear();
        numbers.for_each(|number| device.precision.write(number, &mut bytes));
        let record = (self.problem * size) as usize;
        let largest = device.largest_binding() / (self.problem.max(self.answer) * size);
        let most = largest.min(1 << 22) as usize * record;
        for bytes in bytes.chunks(most.max(record)) {
            self.submit(bytes, (bytes.len() / record) as u64, take)?;
        }
        self.bytes = bytes;
        Ok(())
    }

    fn submit(
        &mut self,
        bytes: &[u8],
        count: u64,
        take: &mut dyn FnMut(&mut dyn Iterator<Item = Real>),
    ) -> Result<(), DeviceFailure> {
        let gpu = self.gpu.0.clone();
        let device = &gpu.device;
        // The kernel takes the number of problems from the buffer's size.
        let buffers = match self.buffers.take() {
            Some(buffers) if buffers.room == count => buffers,
            _ => self.make_buffers(count),
        };
        device.queue.write_buffer(&buffers.problems, 0, bytes);
        let mut encoder = device.device.create_command_encoder(&Default::default());
        let timestamp_writes = buffers.clock.as_ref().map(Clock::writes);
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        pass.set_pipeline(&self.kernel);
        pass.set_bind_group(0, &buffers.group, &[]);
        let workgroups = count.div_ceil(THREADS) as u32;
        let wide = workgroups.min(device.limits.max_compute_workgroups_per_dimension);
        pass.dispatch_workgroups(wide, workgroups.div_ceil(wide), 1);
        drop(pass);
        let answers = count * self.answer * device.precision.size();
        encoder.copy_buffer_to_buffer(&buffers.answers, 0, &buffers.readback, READINGS, Some(answers));
        if let Some(clock) = &buffers.clock {
            clock.copy(&mut encoder, &buffers.readback);
        }
        let time = &mut self.device_time;
        device.run_and_read(encoder.finish(), &buffers.readback, READINGS + answers, |bytes| {
            let (readings, bytes) = bytes.split_at(READINGS as usize);
            *time = time.zip(device.time_between(readings)).map(|(sum, more)| sum + more);
            take(&mut device.precision.read(bytes));
        })?;
        self.buffers = Some(buffers);
        Ok(())
    }

    fn make_buffers(&self, count: u64) -> Buffers {
        let device = &self.gpu.0.device;
        let (problem, answer) =
            (self.problem * device.precision.size(), self.answer * device.precision.size());
        let problems = device.buffer(count * problem, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let answers = device.buffer(count * answer, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let readback =
            device.buffer(READINGS + count * answer, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let group = device.group(&self.layout, &[problems.as_entire_binding(), answers.as_entire_binding()]);
        Buffers { room: count, problems, answers, readback, clock: Clock::new(device), group }
    }
}
