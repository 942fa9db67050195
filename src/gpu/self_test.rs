//! Whether a device's double precision deserves the name. Vulkan asks of it no more than of single precision.

use super::batch::{Batch, BatchKernel};
use super::device::Adapter;
use super::opened::Gpu;
use super::{GpuError, Precision};

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

/// The quotient of two numbers, and the square root of the first.
pub(super) const KERNEL: BatchKernel =
    BatchKernel::new("self_test", include_str!("shaders/kernels/self_test.wgsl"), 2, 2);

/// Compares the device's quotients and square roots with the CPU's.
///
/// # Errors
/// They differ by more than a few units in the last place, or the device failed.
pub(super) fn check_arithmetic(gpu: &Gpu) -> Result<(), GpuError> {
    let mut got = Vec::new();
    Batch::new(gpu, &KERNEL)?.run(OPERANDS.into_iter().flatten(), |results| got.extend(results))?;
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
