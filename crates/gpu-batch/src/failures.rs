//! The failures of a device. Drivers report at any time, from any thread, and do not name the
//! command. So every user of the device gets every failure.

use crate::DeviceFailure;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The kinds, from the most severe on: a failure that follows from a more severe one says less.
const KINDS: [DeviceFailure; 3] =
    [DeviceFailure::Lost, DeviceFailure::OutOfMemory, DeviceFailure::Refused];

/// The failures of a device, shared by its callbacks and its users.
#[derive(Clone, Debug, Default)]
pub(crate) struct Failures(Arc<Mutex<Log>>);

#[derive(Debug, Default)]
struct Log {
    /// How many failures have been reported.
    reported: u64,
    /// The last report of each of [`KINDS`], counted from 1; 0 for none.
    last: [u64; KINDS.len()],
}

/// The failures of a [`Device`](crate::Device) that one user has already got.
#[derive(Debug)]
pub struct Watch {
    failures: Failures,
    heard: u64,
}

impl Failures {
    fn lock(&self) -> MutexGuard<'_, Log> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Passes a failure on to all users. What is no kind of its own here counts as a refusal.
    pub(crate) fn report(&self, failure: DeviceFailure) {
        let mut log = self.lock();
        log.reported += 1;
        let kind = KINDS.iter().position(|&kind| kind == failure).unwrap_or(KINDS.len() - 1);
        log.last[kind] = log.reported;
    }

    /// For a new user, who has to do with nothing that failed before. (But a lost device stays
    /// lost.)
    pub(crate) fn watch(&self) -> Watch {
        Watch { failures: self.clone(), heard: self.lock().reported }
    }

    /// Hears of everything that happens to `device` outside of error scopes.
    pub(crate) fn listen_to(&self, device: &wgpu::Device) {
        let failures = self.clone();
        device.set_device_lost_callback(move |_, _| failures.report(DeviceFailure::Lost));
        let failures = self.clone();
        device.on_uncaptured_error(Arc::new(move |error| failures.report(kind(&error))));
    }
}

impl Watch {
    /// Checks for failures since the last check. A lost device stays lost.
    ///
    /// # Errors
    /// The most severe failure.
    pub fn check(&mut self) -> Result<(), DeviceFailure> {
        let log = self.failures.lock();
        let heard = std::mem::replace(&mut self.heard, log.reported);
        let is_news = |(kind, last): &(DeviceFailure, u64)| {
            heard < *last || (*kind == DeviceFailure::Lost && 0 < *last)
        };
        KINDS.into_iter().zip(log.last).find(is_news).map_or(Ok(()), |(kind, _)| Err(kind))
    }
}

/// The failure behind an error.
fn kind(error: &wgpu::Error) -> DeviceFailure {
    match error {
        wgpu::Error::OutOfMemory { .. } => DeviceFailure::OutOfMemory,
        _ => DeviceFailure::Refused,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use DeviceFailure::{Lost, OutOfMemory, Refused};

    #[test]
    fn every_user_hears_of_a_failure_once() {
        let failures = Failures::default();
        let mut users = [failures.watch(), failures.watch()];
        failures.report(Refused);
        for user in &mut users {
            assert_eq!(user.check(), Err(Refused));
            assert_eq!(user.check(), Ok(()));
        }
        assert_eq!(failures.watch().check(), Ok(()));
    }

    #[test]
    fn the_gravest_failure_is_told_and_a_loss_for_ever() {
        let failures = Failures::default();
        let mut early = failures.watch();
        failures.report(OutOfMemory);
        failures.report(Refused);
        let mut late = failures.watch();
        failures.report(Refused);
        assert_eq!((early.check(), late.check()), (Err(OutOfMemory), Err(Refused)));
        failures.report(Lost);
        failures.report(Refused);
        for mut user in [early, late, failures.watch()] {
            assert_eq!((user.check(), user.check()), (Err(Lost), Err(Lost)));
        }
    }
}
