//! An open GPU with the compiled kernels of a query.
use super::GpuError;
use super::search::SearchKernels;
use super::wgsl::{self, CONVEX};
use crate::threads::{Lazy, on_this_thread};
use gpu_batch::wgpu::{BindGroupLayout, ComputePipeline};
use gpu_batch::{Adapter, Binding, Device, DeviceError, DeviceFailure, Precision, Shader, Watch};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// The GPUs that are open, one for each precision.
static OPEN: [Mutex<Weak<Opened>>; 2] = [const { Mutex::new(Weak::new()) }; 2];

/// An open GPU with compiled kernels. Opening takes a moment, so engines for several meshes can
/// share one.
///
/// A clone is the same GPU.
#[derive(Clone)]
pub struct Gpu(pub(super) Arc<Opened>);

impl Gpu {
    /// Opens the fastest GPU of this machine for searches in this precision. While one is open and
    /// has not been lost, all callers on all threads share it.
    ///
    /// The distances have double precision either way. The environment variables of `wgpu`,
    /// such as `WGPU_BACKEND`, narrow the choice.
    ///
    /// # Errors
    /// There is no GPU; its driver refuses it or a kernel; or it lacks double precision and
    /// `precision` asks for it.
    pub fn open(precision: Precision) -> Result<Self, GpuError> {
        let is_open = |opened: &Opened| opened.device.watch().check().is_ok();
        let open = &OPEN[usize::from(precision == Precision::F64)];
        share(open, is_open, || Ok(Self::open_another(precision)?.0)).map(Self)
    }

    /// Opens a GPU that no other caller gets.
    ///
    /// # Errors
    /// As [`Gpu::open`].
    pub(super) fn open_another(precision: Precision) -> Result<Self, GpuError> {
        Ok(Self(Arc::new(Opened::new(Device::open(precision)?)?)))
    }

    /// The name and the backend of the GPU.
    pub fn adapter(&self) -> &Adapter {
        self.0.device.adapter()
    }

    /// The error for a mesh that does not fit into the memory.
    pub(super) fn too_large(&self, triangles: usize) -> GpuError {
        GpuError::MeshTooLarge { adapter: self.adapter().to_string(), triangles }
    }

    /// Checks the upload of a mesh.
    ///
    /// # Errors
    /// The mesh did not fit, or the device has failed.
    pub(super) fn check_upload(&self, watch: &mut Watch, triangles: usize) -> Result<(), GpuError> {
        watch.check().map_err(|failure| match failure {
            DeviceFailure::OutOfMemory => self.too_large(triangles),
            other => other.into(),
        })
    }

    /// The search precision.
    pub fn precision(&self) -> Precision {
        self.0.device.precision()
    }

    /// The device, for other kernels.
    #[cfg(feature = "laboratory")]
    #[doc(hidden)]
    pub fn device(&self) -> &Device {
        &self.0.device
    }
}

/// Returns what is open, if it is still usable; otherwise opens it on this thread alone, while
/// other callers wait. So nobody who holds the lock waits for a pool.
fn share<T, E>(
    shared: &Mutex<Weak<T>>,
    is_usable: impl Fn(&T) -> bool,
    open: impl FnOnce() -> Result<Arc<T>, E>,
) -> Result<Arc<T>, E> {
    let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(open) = shared.upgrade().filter(|open| is_usable(open)) {
        return Ok(open);
    }
    let opened = on_this_thread(open)?;
    *shared = Arc::downgrade(&opened);
    Ok(opened)
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
    search: Lazy<Result<SearchKernels, DeviceError>>,
}

impl Opened {
    pub(super) fn new(device: Device) -> Result<Self, DeviceError> {
        use Binding::{Read, Uniform, Write};
        let prepare_layout = device.layout(&[Read, Read, Write, Write]);
        let query_layout = device.layout(&[Uniform, Read, Write, Read, Read, Write, Write, Write]);
        let precision = device.precision();
        let prepare = wgsl::prepare(precision);
        let query =
            |kernel: Shader| device.compile(kernel.entry_point, &kernel, &query_layout, &[]);
        Ok(Self {
            prepare: device.compile(prepare.entry_point, &prepare, &prepare_layout, &[])?,
            sample: query(wgsl::sample(precision))?,
            nearest: query(wgsl::nearest(precision, CONVEX))?,
            reduce: query(wgsl::reduce(precision))?,
            collect: query(wgsl::collect(precision))?,
            prepare_layout,
            query_layout,
            search: Lazy::new(),
            device,
        })
    }

    /// The kernels of the search, compiled at first use.
    ///
    /// # Errors
    /// The driver does not compile one.
    pub(super) fn search(&self) -> Result<&SearchKernels, DeviceError> {
        let kernels = self.search.get_or_build(|| SearchKernels::new(&self.device, false));
        kernels.as_ref().map_err(Clone::clone)
    }

    /// Compiles the kernel that computes every pair in full, with this route from a segment to a
    /// disc.
    #[cfg(feature = "laboratory")]
    pub(super) fn every_pair(&self, route: &str) -> Result<ComputePipeline, DeviceError> {
        let kernel = wgsl::nearest(self.device.precision(), route);
        self.device.compile("nearest, every pair", &kernel, &self.query_layout, &[("CULLING", 0.0)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Sixteen threads at once open one. Without users it is closed; what is lost, or failed to
    /// open, is opened anew.
    #[test]
    fn many_threads_open_one() {
        let (shared, opened, barrier) =
            (Mutex::new(Weak::new()), AtomicUsize::new(0), Barrier::new(16));
        let open = |is_usable: bool| {
            let open = || Ok::<_, ()>(Arc::new(opened.fetch_add(1, Ordering::Relaxed)));
            share(&shared, |_| is_usable, open).unwrap()
        };
        let all: Vec<_> = std::thread::scope(|scope| {
            let wait_and_open = || {
                barrier.wait();
                open(true)
            };
            let threads: Vec<_> = (0..16).map(|_| scope.spawn(wait_and_open)).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(all.iter().all(|one| Arc::ptr_eq(one, &all[0])));
        assert_eq!(*open(false), 1, "the first is lost");
        drop(all);
        assert_eq!(*open(true), 2, "nobody has the second");
        assert_eq!(share(&shared, |_| true, || Err(7)), Err(7));
        assert_eq!(*open(true), 3);
    }
}
