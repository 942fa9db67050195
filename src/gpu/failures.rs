//! What went wrong on a device, remembered until somebody asks: drivers report at any time, from any thread.

use crate::proximity::DeviceFailure;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Shared by a device's callbacks and its users.
#[derive(Clone, Default)]
pub(super) struct Failures(Arc<Mutex<Option<DeviceFailure>>>);

impl Failures {
    fn lock(&self) -> MutexGuard<'_, Option<DeviceFailure>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Remembers a failure; a loss outweighs all others.
    pub(super) fn report(&self, failure: DeviceFailure) {
        let mut first = self.lock();
        if failure == DeviceFailure::Lost || first.is_none() {
            *first = Some(failure);
        }
    }

    /// What has failed since the last check. A lost device stays lost.
    ///
    /// # Errors
    /// Something has failed.
    pub(super) fn check(&self) -> Result<(), DeviceFailure> {
        let mut first = self.lock();
        match *first {
            None => Ok(()),
            Some(failure) => {
                if failure != DeviceFailure::Lost {
                    *first = None;
                }
                Err(failure)
            }
        }
    }

    /// Hears of everything that happens to `device` outside of error scopes.
    pub(super) fn listen_to(&self, device: &wgpu::Device) {
        let failures = self.clone();
        device.set_device_lost_callback(move |_, _| failures.report(DeviceFailure::Lost));
        let failures = self.clone();
        device.on_uncaptured_error(Arc::new(move |error| failures.report(kind(&error))));
    }
}

/// The failure behind an error.
pub(super) fn kind(error: &wgpu::Error) -> DeviceFailure {
    match error {
        wgpu::Error::OutOfMemory { .. } => DeviceFailure::OutOfMemory,
        _ => DeviceFailure::Refused,
    }
}
