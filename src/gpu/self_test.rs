//! Whether a device's double precision deserves the name. Vulkan asks of it no more than of single precision.

use super::device::{Adapter, Device};
use super::{GpuError, Precision, shaders};
use wgpu::BufferUsages;

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

impl Device {
    /// Compares the device's quotients and square roots with the CPU's.
    ///
    /// # Errors
    /// They differ by more than a few units in the last place, or the device failed.
    pub(super) fn check_arithmetic(&self) -> Result<(), GpuError> {
        let count = 2 * OPERANDS.len();
        let size = count as u64 * self.precision.size();
        let mut bytes = Vec::new();
        OPERANDS.iter().flatten().for_each(|&value| self.precision.write(value, &mut bytes));
        let operands = self.buffer(size, BufferUsages::STORAGE | BufferUsages::COPY_DST);
        let results = self.buffer(size, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let readback = self.buffer(size, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
        self.queue.write_buffer(&operands, 0, &bytes);

        let layout = self.layout(&[Some(false), Some(true)]);
        let pipeline = self.compile(shaders::SELF_TEST, shaders::QUARTIC, &layout, &[])?;
        let group = self.group(&layout, &[operands.as_entire_binding(), results.as_entire_binding()]);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&results, 0, &readback, 0, Some(size));
        let mut got = Vec::new();
        self.run_and_read(encoder.finish(), &readback, size, |bytes| got.extend(self.precision.read(bytes)))?;
        compare(&got, self.precision, &self.adapter)
    }
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
