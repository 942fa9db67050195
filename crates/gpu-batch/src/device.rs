//! An opened GPU.

use crate::failures::{Failures, Watch};
use crate::record::Record;
use crate::{Adapter, Binding, DeviceError, DeviceFailure, Precision, Shader};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// A GPU, opened in one precision. Clones refer to the same GPU.
#[derive(Clone)]
pub struct Device(Arc<Opened>);

/// A device, its queue and its properties.
struct Opened {
    adapter: Adapter,
    precision: Precision,
    device: wgpu::Device,
    queue: wgpu::Queue,
    limits: wgpu::Limits,
    tick: Option<f32>,
    failures: Failures,
}

/// Commands that a device has been given, and how many bytes can be read after them.
#[derive(Debug)]
pub struct Submitted {
    submission: wgpu::SubmissionIndex,
    size: u64,
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device")
            .field("adapter", self.adapter())
            .field("precision", &self.precision())
            .finish_non_exhaustive()
    }
}

impl Device {
    /// The fastest GPU of an instance.
    pub(crate) fn open_of(
        instance: wgpu::InstanceDescriptor,
        precision: Precision,
    ) -> Result<Self, DeviceError> {
        let instance = wgpu::Instance::new(instance);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| DeviceError::NoAdapter { reason: error.to_string() })?;
        Self::open_on(&adapter, precision)
    }

    fn open_on(adapter: &wgpu::Adapter, precision: Precision) -> Result<Self, DeviceError> {
        let info = adapter.get_info();
        let named = Adapter {
            name: info.name,
            interface: info.backend.to_string(),
            is_software: info.device_type == wgpu::DeviceType::Cpu,
        };
        let mut features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        if precision == Precision::F64 {
            if !adapter.features().contains(wgpu::Features::SHADER_F64) {
                return Err(DeviceError::NoDoublePrecision { adapter: named.to_string() });
            }
            features |= wgpu::Features::SHADER_F64;
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("gpu-batch"),
            required_features: features,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
                DeviceError::NotOpened { adapter: named.to_string(), reason: error.to_string() }
            })?;
        let failures = Failures::default();
        failures.listen_to(&device);
        let keeps_time = features.contains(wgpu::Features::TIMESTAMP_QUERY);
        let tick = keeps_time.then(|| queue.get_timestamp_period());
        let limits = device.limits();
        Ok(Self(Arc::new(Opened {
            adapter: named,
            precision,
            device,
            queue,
            limits,
            tick,
            failures,
        })))
    }

    /// The GPU.
    pub fn adapter(&self) -> &Adapter {
        &self.0.adapter
    }

    /// The precision in which it computes.
    pub fn precision(&self) -> Precision {
        self.0.precision
    }

    /// The `wgpu` device.
    pub fn raw(&self) -> &wgpu::Device {
        &self.0.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.0.queue
    }

    /// The limits of the device.
    pub fn limits(&self) -> &wgpu::Limits {
        &self.0.limits
    }

    /// Nanoseconds of a tick of its clock, if it keeps time.
    pub fn tick(&self) -> Option<f32> {
        self.0.tick
    }

    /// A watch for a new user, which reports failures from now on.
    pub fn watch(&self) -> Watch {
        self.0.failures.watch()
    }

    /// Compiles a kernel, with values for its overrides; `name` is for messages.
    ///
    /// # Errors
    /// The driver does not compile it.
    pub fn compile(
        &self,
        name: &str,
        kernel: &Shader,
        layout: &wgpu::BindGroupLayout,
        constants: &[(&str, f64)],
    ) -> Result<wgpu::ComputePipeline, DeviceError> {
        let device = self.raw();
        let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal]
            .map(|filter| device.push_error_scope(filter));
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(kernel.text.as_str().into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(kernel.entry_point),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        let [validation, internal] = scopes;
        let (internal, validation) =
            (pollster::block_on(internal.pop()), pollster::block_on(validation.pop()));
        match validation.or(internal) {
            None => Ok(pipeline),
            Some(error) => Err(DeviceError::Shader {
                adapter: self.adapter().to_string(),
                kernel: name.into(),
                message: error.to_string(),
            }),
        }
    }

    /// A layout of one bind group.
    pub fn layout(&self, bindings: &[Binding]) -> wgpu::BindGroupLayout {
        let entries: Vec<_> =
            (0..).zip(bindings).map(|(number, binding)| binding.entry(number)).collect();
        self.raw().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        })
    }

    /// A bind group: the resource at each place of a layout.
    pub fn group(
        &self,
        layout: &wgpu::BindGroupLayout,
        bindings: &[wgpu::BindingResource],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = (0..)
            .zip(bindings)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
            .collect();
        self.raw().create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    /// A buffer of at least this size in bytes; never empty, because an empty one cannot be bound.
    pub fn buffer(&self, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let size = size.max(16).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        self.raw().create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// The largest buffer that a kernel can use, in bytes: a power of two, so that a size rounded
    /// up to one still fits.
    pub fn largest_binding(&self) -> u64 {
        let limits = self.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        1 << most.max(1).ilog2()
    }

    /// Bytes from one uniform of a kind to the next in a buffer.
    pub fn uniform_stride<R: Record>(&self) -> u64 {
        R::size(self.precision())
            .next_multiple_of(self.limits().min_uniform_buffer_offset_alignment.into())
    }

    /// The binding of a buffer of uniforms. Each dispatch names one uniform by its offset.
    pub fn uniform_binding<'a, R: Record>(
        &self,
        buffer: &'a wgpu::Buffer,
    ) -> wgpu::BindingResource<'a> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset: 0,
            size: std::num::NonZeroU64::new(R::size(self.precision())),
        })
    }

    /// Dispatches at least `workgroups` workgroups, in rows that the device allows.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, workgroups: u32) {
        let wide = workgroups.clamp(1, self.limits().max_compute_workgroups_per_dimension);
        pass.dispatch_workgroups(wide, workgroups.div_ceil(wide), 1);
    }

    /// Memory of `size` bytes, at least one, that the device copies to a place in `buffer` before
    /// the next submitted commands. The memory may be written on any thread, and counts once it is
    /// dropped. Offset and size are multiples of 4.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last, or does not have the memory.
    pub fn upload(
        &self,
        watch: &mut Watch,
        buffer: &wgpu::Buffer,
        offset: u64,
        size: wgpu::BufferSize,
    ) -> Result<wgpu::QueueWriteBufferView, DeviceFailure> {
        let view = self.queue().write_buffer_with(buffer, offset, size);
        view.ok_or_else(|| {
            self.poll(wgpu::PollType::Poll);
            watch.check().err().unwrap_or(DeviceFailure::OutOfMemory)
        })
    }

    /// Submits commands and has `read` take `size` bytes of `from`, a buffer for reading, once they
    /// are done.
    ///
    /// # Errors
    /// The device has failed since the last check of `watch`, and `read` was not called; or `read`
    /// reports that there is nothing to read.
    pub fn run_and_read(
        &self,
        watch: &mut Watch,
        commands: wgpu::CommandBuffer,
        from: &wgpu::Buffer,
        size: u64,
        read: impl FnOnce(&[u8]) -> Result<(), DeviceFailure>,
    ) -> Result<(), DeviceFailure> {
        let submitted = self.submit(watch, commands, from, size)?;
        self.read(watch, submitted, from, read)
    }

    /// Submits commands, after which `size` bytes of `from`, a buffer for reading, can be read. The
    /// device works on them while the caller goes on.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last. Nothing was submitted.
    pub fn submit(
        &self,
        watch: &mut Watch,
        commands: wgpu::CommandBuffer,
        from: &wgpu::Buffer,
        size: u64,
    ) -> Result<Submitted, DeviceFailure> {
        watch.check()?;
        let submission = self.queue().submit([commands]);
        let failures = self.0.failures.clone();
        from.map_async(wgpu::MapMode::Read, 0..size, move |mapped| {
            if mapped.is_err() {
                failures.report(DeviceFailure::Refused);
            }
        });
        Ok(Submitted { submission, size })
    }

    /// Waits for what was submitted and has `read` take the bytes of its buffer.
    ///
    /// # Errors
    /// As [`run_and_read`](Self::run_and_read).
    pub fn read(
        &self,
        watch: &mut Watch,
        submitted: Submitted,
        from: &wgpu::Buffer,
        read: impl FnOnce(&[u8]) -> Result<(), DeviceFailure>,
    ) -> Result<(), DeviceFailure> {
        self.wait(submitted.submission);
        watch.check()?;
        let answer = match from.get_mapped_range(0..submitted.size) {
            Ok(bytes) => read(&bytes),
            Err(_) => Err(DeviceFailure::Unanswered),
        };
        from.unmap();
        answer
    }

    fn wait(&self, submission: wgpu::SubmissionIndex) {
        self.poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: None });
    }

    fn poll(&self, how: wgpu::PollType) {
        // `wgpu` panics when it finds a device lost while it waits; here that is an error like any
        // other.
        if !matches!(catch_unwind(AssertUnwindSafe(|| self.raw().poll(how))), Ok(Ok(_))) {
            self.0.failures.report(DeviceFailure::Lost);
        }
    }
}
