//! Tests whether a GPU's double precision is double precision: Vulkan requires no more accuracy of
//! it than of single precision.

use crate::{Adapter, Batch, Device, DeviceError, Kernel, Precision};

/// Dividends and divisors whose quotients and roots need every digit.
pub(crate) const OPERANDS: [[f64; 2]; 8] = [
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

impl Device {
    /// The fastest GPU of this machine, to compute in this precision. The environment variables of
    /// `wgpu`, such as `WGPU_BACKEND`, narrow the choice.
    ///
    /// # Errors
    /// There is no GPU, its driver refuses it, or it lacks the requested double precision.
    pub fn open(precision: Precision) -> Result<Self, DeviceError> {
        let device = Self::open_of(
            wgpu::InstanceDescriptor::new_without_display_handle().with_env(),
            precision,
        )?;
        check(&device)?;
        Ok(device)
    }
}

/// Compares the device's quotients and square roots with the CPU's.
///
/// # Errors
/// The results differ by more than a few units in the last place, or the device failed.
fn check(device: &Device) -> Result<(), DeviceError> {
    let kernel = Kernel::new("self_test", include_str!("shaders/self_test.wgsl"), 2, 2);
    let mut got = Vec::new();
    Batch::new(device, &kernel)?
        .run(OPERANDS.into_iter().flatten(), |results| got.extend(results))?;
    compare(&got, device.precision(), device.adapter())
}

/// Compares quotients and roots with the CPU's.
pub(crate) fn compare(
    got: &[f64],
    precision: Precision,
    adapter: &Adapter,
) -> Result<(), DeviceError> {
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
            return Err(DeviceError::WrongArithmetic { adapter, operation, got, expected });
        }
    }
    Ok(())
}
