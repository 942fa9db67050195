//! The GPU, in every precision that it has.

use crate::ways::{Device, Engine, text};
use parry_continuum::gpu::{Gpu, GpuExhaustive, Precision};

/// An entry for each precision; none where there is no GPU.
pub fn devices() -> Vec<Device> {
    let engines = [("GPU, f32", Precision::F32), ("GPU, f64", Precision::F64)];
    engines
        .into_iter()
        .filter_map(|(way, precision)| {
            let gpu = Gpu::open(precision).ok()?;
            let name = gpu.adapter().to_string();
            Some(Device {
                way,
                name,
                engine: Box::new(move |mesh, model| {
                    Ok(Box::new(Engine {
                        engine: GpuExhaustive::on(&gpu, mesh).map_err(text)?,
                        model,
                    }))
                }),
            })
        })
        .collect()
}
