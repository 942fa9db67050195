//! How long a device's kernels take, by its own clock.

use crate::Device;
use std::time::Duration;
use wgpu::{Buffer, BufferUsages, CommandEncoder, ComputePassTimestampWrites, QuerySet};

/// Bytes of two readings.
pub const READINGS: u64 = 16;

/// Two readings, at the beginning and the end of a pass.
#[derive(Debug)]
pub struct Clock {
    set: QuerySet,
    readings: Buffer,
}

impl Clock {
    /// None if the device has no clock.
    pub fn new(device: &Device) -> Option<Self> {
        device.tick()?;
        let descriptor =
            wgpu::QuerySetDescriptor { label: None, ty: wgpu::QueryType::Timestamp, count: 2 };
        Some(Self {
            set: device.raw().create_query_set(&descriptor),
            readings: device.buffer(READINGS, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
        })
    }

    /// What a pass needs to be timed.
    pub fn writes(&self) -> ComputePassTimestampWrites<'_> {
        ComputePassTimestampWrites {
            query_set: &self.set,
            beginning_of_pass_write_index: Some(0),
            end_of_pass_write_index: Some(1),
        }
    }

    /// Copies the readings to the front of `to`.
    pub fn copy(&self, encoder: &mut CommandEncoder, to: &Buffer) {
        encoder.resolve_query_set(&self.set, 0..2, &self.readings, 0);
        encoder.copy_buffer_to_buffer(&self.readings, 0, to, 0, Some(READINGS));
    }

    /// The time between two readings, if the device keeps time.
    pub fn time_between(device: &Device, readings: &[u8]) -> Option<Duration> {
        let (pairs, _) = readings.as_chunks::<8>();
        let (&[begin, end], _) = pairs.split_first_chunk::<2>()?;
        let ticks = u64::from_ne_bytes(end).saturating_sub(u64::from_ne_bytes(begin));
        Some(Duration::from_nanos((ticks as f64 * f64::from(device.tick()?)) as u64))
    }
}
