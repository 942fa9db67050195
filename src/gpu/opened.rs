use super::device::{Adapter, Device};
use super::shaders::{self, Kernel, QUARTIC};
use super::{GpuError, Precision};
use std::sync::{Arc, OnceLock};
use wgpu::{BindGroupLayout, ComputePipeline};

/// A GPU, opened and with its kernels compiled, which takes a moment; engines for several meshes can share it.
///
/// Copies stand for the same GPU.
#[derive(Clone)]
pub struct Gpu(pub(super) Arc<Opened>);

impl Gpu {
    /// The fastest GPU of this machine, to search in this precision. The environment variables of `wgpu`, such as
    /// `WGPU_BACKEND`, narrow the choice.
    ///
    /// # Errors
    /// There is no GPU, its driver refuses it or a kernel, or it lacks double precision and that was asked for.
    pub fn open(precision: Precision) -> Result<Self, GpuError> {
        let device = Device::open(precision)?;
        device.check_arithmetic()?;
        Ok(Self(Arc::new(Opened::new(device)?)))
    }

    /// Which GPU it is.
    pub fn adapter(&self) -> &Adapter {
        &self.0.device.adapter
    }

    /// The numbers with which it searches.
    pub fn precision(&self) -> Precision {
        self.0.device.precision
    }
}

/// A route to the disc of a flat cap: the paper's are there for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Discs {
    /// This crate's, without roots of a polynomial.
    #[default]
    Convex,
    /// The paper's quartic in closed form.
    ClosedForm,
    /// The paper's quartic by the companion matrix.
    Companion,
}

impl Discs {
    /// What tells the kernels by the quartic apart.
    pub(super) fn constant(self) -> Option<(&'static str, f64)> {
        (self == Self::Companion).then_some(("COMPANION", 1.0))
    }
}

/// A device with the kernels of a query.
pub(super) struct Opened {
    pub device: Device,
    pub prepare_layout: BindGroupLayout,
    pub query_layout: BindGroupLayout,
    pub prepare: ComputePipeline,
    pub sample: ComputePipeline,
    pub nearest: ComputePipeline,
    pub reduce: ComputePipeline,
    pub collect: ComputePipeline,
    /// By [`Discs`].
    every_pair: [OnceLock<Result<ComputePipeline, GpuError>>; 3],
}

impl Opened {
    fn new(device: Device) -> Result<Self, GpuError> {
        let (read, write) = (Some(false), Some(true));
        let prepare_layout = device.layout(&[read, read, write, write]);
        let query_layout = device.layout(&[None, read, write, read, read, write, write, write]);
        let query = |kernel: Kernel| device.compile(kernel, QUARTIC, &query_layout, &[]);
        Ok(Self {
            prepare: device.compile(shaders::PREPARE, QUARTIC, &prepare_layout, &[])?,
            sample: query(shaders::SAMPLE)?,
            nearest: query(shaders::NEAREST)?,
            reduce: query(shaders::REDUCE)?,
            collect: query(shaders::COLLECT)?,
            every_pair: Default::default(),
            prepare_layout,
            query_layout,
            device,
        })
    }

    /// The kernel that computes every pair in full, compiled when it is first asked for.
    pub(super) fn every_pair(&self, discs: Discs) -> Result<&ComputePipeline, GpuError> {
        let kernel = if discs == Discs::Convex { shaders::NEAREST } else { shaders::NEAREST_BY_QUARTIC };
        let mut constants = vec![("CULLING", 0.0)];
        constants.extend(discs.constant());
        let compile = || self.device.compile(kernel, QUARTIC, &self.query_layout, &constants);
        self.every_pair[discs as usize].get_or_init(compile).as_ref().map_err(Clone::clone)
    }
}
