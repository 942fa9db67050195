//! Many small problems at once, one thread per problem.

use crate::clock::{Clock, READINGS};
use crate::failures::Watch;
use crate::kernel::{ANSWER_HEAD, BATCH_THREADS, Head};
use crate::record::Record;
use crate::{Binding, Device, DeviceError, DeviceFailure, Kernel, Precision};
use std::time::Duration;
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, ComputePipeline};

/// The most problems of a submission.
const MOST_PROBLEMS: u64 = 1 << 22;
/// This many submissions have distinct numbers, which single precision represents exactly.
const SUBMISSIONS: u32 = (1 << f32::MANTISSA_DIGITS) - 1;

/// A kernel on a GPU that answers many problems at once, one thread per problem.
pub struct Batch {
    device: Device,
    watch: Watch,
    pub(crate) layout: BindGroupLayout,
    pub(crate) kernel: ComputePipeline,
    /// Numbers of a problem, and of an answer with its head.
    problem: u64,
    answer: u64,
    submission: u32,
    room: Option<Room>,
    device_time: Option<Duration>,
}

/// Buffers for a number of problems.
struct Room {
    problems: u64,
    head: Buffer,
    problem_buffer: Buffer,
    answer_buffer: Buffer,
    readback: Buffer,
    clock: Option<Clock>,
    group: BindGroup,
}

impl std::fmt::Debug for Batch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { device, problem, answer, .. } = self;
        f.debug_struct("Batch")
            .field("device", device)
            .field("problem", problem)
            .field("answer", &(answer - u64::from(ANSWER_HEAD)))
            .finish_non_exhaustive()
    }
}

impl Batch {
    /// Prepares a kernel.
    ///
    /// # Errors
    /// The driver does not compile it.
    pub fn new(device: &Device, kernel: &Kernel) -> Result<Self, DeviceError> {
        let layout = device.layout(&[Binding::Uniform, Binding::Read, Binding::Write]);
        Ok(Self {
            watch: device.watch(),
            kernel: device.compile(
                kernel.name,
                &kernel.shader(device.precision()),
                &layout,
                &[],
            )?,
            layout,
            problem: kernel.problem().into(),
            answer: kernel.answer().into(),
            submission: 0,
            room: None,
            device_time: None,
            device: device.clone(),
        })
    }

    /// Answers as many problems as `numbers` make, in their order; `take` gets the numbers of each
    /// answer.
    ///
    /// # Errors
    /// The GPU has failed. Answers that `take` has got by then are right.
    pub fn run(
        &mut self,
        numbers: impl IntoIterator<Item = f64>,
        mut take: impl FnMut(&[f64]),
    ) -> Result<(), DeviceFailure> {
        let device = self.device.clone();
        self.device_time = device.tick().map(|_| Duration::ZERO);
        let mut bytes = Vec::new();
        numbers.into_iter().for_each(|number| device.precision().write(number, &mut bytes));
        let record = self.problem * device.precision().size();
        bytes.truncate(bytes.len() - bytes.len() % record as usize);
        let largest =
            device.largest_binding() / (self.problem.max(self.answer) * device.precision().size());
        let most = largest.clamp(1, MOST_PROBLEMS) * record;
        for bytes in bytes.chunks(most as usize) {
            self.submit(bytes, bytes.len() as u64 / record, &mut take)?;
        }
        Ok(())
    }

    /// How long the GPU computed for the last problems, without transfers; `None` if it keeps no
    /// time.
    pub fn device_time(&self) -> Option<Duration> {
        self.device_time
    }

    fn submit(
        &mut self,
        bytes: &[u8],
        problems: u64,
        take: &mut impl FnMut(&[f64]),
    ) -> Result<(), DeviceFailure> {
        let device = self.device.clone();
        // On failure the buffers are gone, and made anew for the next problems.
        let room = match self.room.take() {
            Some(room) if room.problems == problems => room,
            _ => self.make_room(problems),
        };
        self.submission = self.submission % SUBMISSIONS + 1;
        let submission = self.submission;
        let mut head = Vec::new();
        Head { problems: problems as u32, submission }.write(device.precision(), &mut head);
        device.queue().write_buffer(&room.head, 0, &head);
        device.queue().write_buffer(&room.problem_buffer, 0, bytes);
        let mut encoder = device.raw().create_command_encoder(&Default::default());
        let timestamp_writes = room.clock.as_ref().map(Clock::writes);
        let mut pass = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        pass.set_pipeline(&self.kernel);
        pass.set_bind_group(0, &room.group, &[0]);
        let workgroups = problems.div_ceil(BATCH_THREADS.into()) as u32;
        device.dispatch(&mut pass, workgroups);
        drop(pass);
        let size = problems * self.answer * device.precision().size();
        encoder.copy_buffer_to_buffer(&room.answer_buffer, 0, &room.readback, READINGS, Some(size));
        if let Some(clock) = &room.clock {
            clock.copy(&mut encoder, &room.readback);
        }
        let (time, answer) = (&mut self.device_time, self.answer as usize);
        device.run_and_read(
            &mut self.watch,
            encoder.finish(),
            &room.readback,
            READINGS + size,
            |bytes| {
                let (readings, bytes) = bytes.split_at(READINGS as usize);
                *time =
                    time.zip(Clock::time_between(&device, readings)).map(|(sum, more)| sum + more);
                read(device.precision(), bytes, answer, submission, take)
            },
        )?;
        self.room = Some(room);
        Ok(())
    }

    fn make_room(&self, problems: u64) -> Room {
        let device = &self.device;
        let size = device.precision().size();
        let head = device
            .buffer(Head::size(device.precision()), BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let problem_buffer = device
            .buffer(problems * self.problem * size, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let answers = problems * self.answer * size;
        let answer_buffer = device.buffer(answers, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let readback =
            device.buffer(READINGS + answers, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        let group = device.group(
            &self.layout,
            &[&head, &problem_buffer, &answer_buffer].map(Buffer::as_entire_binding),
        );
        Room {
            problems,
            head,
            problem_buffer,
            answer_buffer,
            readback,
            clock: Clock::new(device),
            group,
        }
    }
}

/// Takes the answers. Each answer of this submission begins with the submission's number.
///
/// # Errors
/// An answer has another number.
fn read(
    precision: Precision,
    bytes: &[u8],
    answer: usize,
    submission: u32,
    take: &mut impl FnMut(&[f64]),
) -> Result<(), DeviceFailure> {
    let mut numbers = Vec::with_capacity(answer);
    for answer in bytes.chunks_exact(answer * precision.size() as usize) {
        numbers.clear();
        numbers.extend(precision.read(answer));
        let (head, numbers) = numbers.split_at(ANSWER_HEAD as usize);
        if head != [f64::from(submission)] {
            return Err(DeviceFailure::Unanswered);
        }
        take(numbers);
    }
    Ok(())
}
