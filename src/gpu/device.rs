//! An opened GPU.

use super::failures::{Failures, Watch};
use super::record::Record;
use super::wgsl::Shader;
use super::{GpuError, Precision};
use crate::answer::DeviceFailure;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A GPU as it is named to users.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Adapter {
    /// The name that the driver gives it.
    pub name: String,
    /// The interface through which it is used, such as Vulkan.
    pub interface: String,
    /// Whether it is a program on the CPU that takes a GPU's place: right, but not fast.
    pub is_software: bool,
}

impl std::fmt::Display for Adapter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, interface, is_software } = self;
        write!(f, "{name} ({interface}{})", if *is_software { ", in software" } else { "" })
    }
}

/// A device, its queue, and what one has to know of it.
#[derive(Debug)]
pub(super) struct Device {
    pub adapter: Adapter,
    pub precision: Precision,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub limits: wgpu::Limits,
    /// Nanoseconds of a tick, if the device keeps time.
    pub tick: Option<f32>,
    pub failures: Failures,
}

impl Device {
    /// The fastest GPU of this machine. The variables of `wgpu`, such as `WGPU_BACKEND`, narrow the choice.
    pub(super) fn open(precision: Precision) -> Result<Self, GpuError> {
        Self::open_of(wgpu::InstanceDescriptor::new_without_display_handle().with_env(), precision)
    }

    /// The fastest GPU of an instance.
    pub(super) fn open_of(
        instance: wgpu::InstanceDescriptor,
        precision: Precision,
    ) -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(instance);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|error| GpuError::NoAdapter { reason: error.to_string() })?;
        Self::open_on(&adapter, precision)
    }

    fn open_on(adapter: &wgpu::Adapter, precision: Precision) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let named = Adapter {
            name: info.name,
            interface: info.backend.to_string(),
            is_software: info.device_type == wgpu::DeviceType::Cpu,
        };
        let mut features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        if precision == Precision::F64 {
            if !adapter.features().contains(wgpu::Features::SHADER_F64) {
                return Err(GpuError::NoDoublePrecision { adapter: named.to_string() });
            }
            features |= wgpu::Features::SHADER_F64;
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("parry-continuum"),
            required_features: features,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|error| GpuError::NotOpened { adapter: named.to_string(), reason: error.to_string() })?;
        let failures = Failures::default();
        failures.listen_to(&device);
        let keeps_time = features.contains(wgpu::Features::TIMESTAMP_QUERY);
        let tick = keeps_time.then(|| queue.get_timestamp_period());
        Ok(Self { adapter: named, precision, limits: device.limits(), device, queue, tick, failures })
    }

    /// Compiles a kernel; `name` is for messages.
    pub(super) fn compile(
        &self,
        name: &str,
        kernel: &Shader,
        layout: &wgpu::BindGroupLayout,
        constants: &[(&str, f64)],
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        let scopes = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal]
            .map(|filter| self.device.push_error_scope(filter));
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(kernel.text.as_str().into()),
        });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
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
            Some(error) => Err(GpuError::Shader {
                adapter: self.adapter.to_string(),
                kernel: name.into(),
                message: error.to_string(),
            }),
        }
    }

    /// A layout of one bind group: a uniform with dynamic offset for `None`, else a storage buffer, `true` where a
    /// kernel may write to it.
    pub(super) fn layout(&self, bindings: &[Option<bool>]) -> wgpu::BindGroupLayout {
        let entry = |(binding, writable): (usize, &Option<bool>)| wgpu::BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: writable.map_or(wgpu::BufferBindingType::Uniform, |writable| {
                    wgpu::BufferBindingType::Storage { read_only: !writable }
                }),
                has_dynamic_offset: writable.is_none(),
                min_binding_size: None,
            },
            count: None,
        };
        let entries: Vec<_> = bindings.iter().enumerate().map(entry).collect();
        self.device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
    }

    pub(super) fn group(
        &self,
        layout: &wgpu::BindGroupLayout,
        bindings: &[wgpu::BindingResource],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = bindings
            .iter()
            .enumerate()
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: resource.clone(),
            })
            .collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    /// A buffer of at least so many bytes; never empty, because an empty one cannot be bound.
    pub(super) fn buffer(&self, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let size = size.max(16).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// The largest buffer that a kernel can see.
    pub(super) fn largest_binding(&self) -> u64 {
        self.limits.max_storage_buffer_binding_size.min(self.limits.max_buffer_size)
    }

    /// Bytes from one uniform of a kind to the next in a buffer.
    pub(super) fn uniform_stride<R: Record>(&self) -> u64 {
        R::size(self.precision).next_multiple_of(self.limits.min_uniform_buffer_offset_alignment.into())
    }

    /// Submits commands and has `read` take `size` bytes of `from`, a buffer for reading, once they are done.
    ///
    /// # Errors
    /// The device has failed since `watch` was asked last: `read` was not called. Or `read` says that there is nothing
    /// to read.
    pub(super) fn run_and_read(
        &self,
        watch: &mut Watch,
        commands: wgpu::CommandBuffer,
        from: &wgpu::Buffer,
        size: u64,
        read: impl FnOnce(&[u8]) -> Result<(), DeviceFailure>,
    ) -> Result<(), DeviceFailure> {
        watch.check()?;
        let submission = self.queue.submit([commands]);
        let failures = self.failures.clone();
        from.map_async(wgpu::MapMode::Read, 0..size, move |mapped| {
            if mapped.is_err() {
                failures.report(DeviceFailure::Refused);
            }
        });
        self.wait(submission);
        watch.check()?;
        let answer = match from.get_mapped_range(0..size) {
            Ok(bytes) => read(&bytes),
            Err(_) => Err(DeviceFailure::Unanswered),
        };
        from.unmap();
        answer
    }

    fn wait(&self, submission: wgpu::SubmissionIndex) {
        // `wgpu` panics when it finds a device lost while it waits; here that is an error like any other.
        let wait = wgpu::PollType::Wait { submission_index: Some(submission), timeout: None };
        if !matches!(catch_unwind(AssertUnwindSafe(|| self.device.poll(wait))), Ok(Ok(_))) {
            self.failures.report(DeviceFailure::Lost);
        }
    }
}
