//! Opening a GPU, and whether its double precision deserves the name. Vulkan asks of it no more than of single precision.

use super::batch::{Batch, BatchKernel};
use super::device::{Adapter, Device};
use super::opened::{Gpu, Opened};
use super::wgsl::SELF_TEST;
use super::{GpuError, Precision};
use std::sync::Arc;

impl Gpu {
    /// The fastest GPU of this machine, to search in this precision. The environment variables of `wgpu`, such as
    /// `WGPU_BACKEND`, narrow the choice.
    ///
    /// # Errors
    /// There is no GPU, its driver refuses it or a kernel, or it lacks double precision and that was asked for.
    pub fn open(precision: Precision) -> Result<Self, GpuError> {
        let gpu = Self(Arc::new(Opened::new(Device::open(precision)?)?));
        check_arithmetic(&gpu)?;
        Ok(gpu)
    }
}

/// Dividends and divisors whose quotients and roots need every digit.
pub(super) const OPERANDS: [[f64; 2]; 8] = [
    [1.0, 3.0],
    [2.0, 7.0],
    [0.1, 1.1],
    [1e-12, 3e5],
    [12_345.678_9, 9.876_543_21],
    [std::f64::consts::PI, std::f64::consts::E],
    [1.0 + f64::EPSILON, 1.0 - f64::EPSILON],
    [5e11, 7e-3],
];

/// How many units in the last place a result may be off.
const TOLERANCE: f64 = 4.0;

/// Compares the device's quotients and square roots with the CPU's.
///
/// # Errors
/// They differ by more than a few units in the last place, or the device failed.
fn check_arithmetic(gpu: &Gpu) -> Result<(), GpuError> {
    let kernel = BatchKernel::new("self_test", SELF_TEST, 2, 2);
    let mut got = Vec::new();
    Batch::new(gpu, &kernel)?.run(OPERANDS.into_iter().flatten(), |results| got.extend(results))?;
    compare(&got, gpu.precision(), gpu.adapter())
}

/// Compares quotients and roots with the CPU's.
pub(super) fn compare(got: &[f64], precision: Precision, adapter: &Adapter) -> Result<(), GpuError> {
    let unit = match precision {
        Precision::F32 => f32::EPSILON.into(),
        Precision::F64 => f64::EPSILON,
    };
    let expected = OPERANDS.iter().flat_map(|&[x, y]| {
        [(x / y, format!("{x:e} / {y:e}")), (x.sqrt(), format!("the square root of {x:e}"))]
    });
    for ((expected, operation), &got) in expected.zip(got) {
        // Written so that NaN fails.
        let right = (got - expected).abs() <= TOLERANCE * unit * expected;
        if !right {
            let adapter = adapter.to_string();
            return Err(GpuError::WrongArithmetic { adapter, operation, got, expected });
        }
    }
    Ok(())
}
