//! The kernels of the search, compiled for a device.

use super::kernels::{Question, bend, corners, passes, refit};
use gpu_batch::wgpu::{BindGroupLayout, ComputePipeline};
use gpu_batch::{Binding, Device, DeviceError, Shader};

/// The compiled kernels of the search.
#[derive(Debug)]
pub(in crate::gpu) struct SearchKernels {
    pub(super) corners_layout: BindGroupLayout,
    pub(super) refit_layout: BindGroupLayout,
    pub query_layout: BindGroupLayout,
    pub bending_layout: BindGroupLayout,
    pub bend: ComputePipeline,
    pub(super) corners: ComputePipeline,
    pub(super) refit: ComputePipeline,
    /// The passes of each kind of question.
    pub passes: Vec<Vec<ComputePipeline>>,
}

impl SearchKernels {
    /// # Errors
    /// The driver does not compile a kernel.
    pub(in crate::gpu) fn new(device: &Device, counts_work: bool) -> Result<Self, DeviceError> {
        Self::with_passes(device, |kind| passes(kind, counts_work))
    }

    /// The kernels with these passes for each kind of question.
    ///
    /// # Errors
    /// The driver does not compile a kernel.
    pub(in crate::gpu) fn with_passes(
        device: &Device,
        passes: impl Fn(usize) -> Vec<Shader>,
    ) -> Result<Self, DeviceError> {
        use Binding::{Read, Uniform, Write};
        let corners_layout = device.layout(&[Read, Read, Write]);
        let refit_layout = device.layout(&[Uniform, Read, Read, Write]);
        let query_layout =
            device.layout(&[Uniform, Read, Read, Read, Read, Write, Write, Write, Write]);
        let bending_layout = device.layout(&[Uniform, Read, Write]);
        let compile = |kernel: Shader, layout: &BindGroupLayout| {
            device.compile(kernel.entry_point, &kernel, layout, &[])
        };
        let passes_of =
            |kind| passes(kind).into_iter().map(|pass| compile(pass, &query_layout)).collect();
        Ok(Self {
            corners: compile(corners(), &corners_layout)?,
            refit: compile(refit(), &refit_layout)?,
            passes: (0..Question::KINDS).map(passes_of).collect::<Result<_, _>>()?,
            bend: compile(bend(), &bending_layout)?,
            corners_layout,
            refit_layout,
            query_layout,
            bending_layout,
        })
    }
}
