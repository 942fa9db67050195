use super::device::{Adapter, Device};
use super::wgsl::{CONVEX, Shader};
use super::{GpuError, Precision};
use std::sync::Arc;
use wgpu::{BindGroupLayout, ComputePipeline};

/// A GPU, opened and with its kernels compiled, which takes a moment; engines for several meshes can share it.
///
/// Copies stand for the same GPU.
#[derive(Clone)]
pub struct Gpu(pub(super) Arc<Opened>);

impl Gpu {
    /// Which GPU it is.
    pub fn adapter(&self) -> &Adapter {
        &self.0.device.adapter
    }

    /// The numbers with which it searches.
    pub fn precision(&self) -> Precision {
        self.0.device.precision
    }
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu")
            .field("adapter", self.adapter())
            .field("precision", &self.precision())
            .finish_non_exhaustive()
    }
}

/// A device with the kernels of a query.
#[derive(Debug)]
pub(super) struct Opened {
    pub device: Device,
    pub prepare_layout: BindGroupLayout,
    pub query_layout: BindGroupLayout,
    pub prepare: ComputePipeline,
    pub sample: ComputePipeline,
    pub nearest: ComputePipeline,
    pub reduce: ComputePipeline,
    pub collect: ComputePipeline,
}

impl Opened {
    pub(super) fn new(device: Device) -> Result<Self, GpuError> {
        let (read, write) = (Some(false), Some(true));
        let prepare_layout = device.layout(&[read, read, write, write]);
        let query_layout = device.layout(&[None, read, write, read, read, write, write, write]);
        let precision = device.precision;
        let prepare = Shader::prepare(precision);
        let query = |kernel: Shader| device.compile(kernel.entry_point, &kernel, &query_layout, &[]);
        Ok(Self {
            prepare: device.compile(prepare.entry_point, &prepare, &prepare_layout, &[])?,
            sample: query(Shader::sample(precision))?,
            nearest: query(Shader::nearest(precision, CONVEX))?,
            reduce: query(Shader::reduce(precision))?,
            collect: query(Shader::collect(precision))?,
            prepare_layout,
            query_layout,
            device,
        })
    }

    /// The kernel that computes every pair in full, by this route from a segment to a disc.
    pub(super) fn every_pair(&self, route: &str) -> Result<ComputePipeline, GpuError> {
        let kernel = Shader::nearest(self.device.precision, route);
        self.device.compile("nearest, every pair", &kernel, &self.query_layout, &[("CULLING", 0.0)])
    }
}
