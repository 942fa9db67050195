//! Medians of the GPU's own times, beside medians of the whole calls.

use std::time::{Duration, Instant};

/// The medians of a job: of the device's clock, if it has one, and of the whole call.
#[derive(Clone, Copy)]
pub struct Timed {
    pub device: Option<Duration>,
    pub whole: Duration,
}

/// A job that returns what the device's clock says.
pub type Job<'a> = &'a mut dyn FnMut() -> Result<Option<Duration>, String>;

/// Medians of each of the jobs, called in turns until `enough` has passed (at least 3 rounds), and
/// before that untimed for as long (at least one round): a GPU at rest runs at a fraction of its
/// clock.
pub fn medians(jobs: &mut [Job], enough: Duration) -> Result<Vec<Timed>, String> {
    let start = Instant::now();
    while {
        jobs.iter_mut().try_for_each(|job| job().map(|_| ()))?;
        start.elapsed() < enough
    } {}
    let mut times = vec![(Vec::new(), Vec::new()); jobs.len()];
    let start = Instant::now();
    for round in 0.. {
        if round >= 3 && start.elapsed() >= enough {
            break;
        }
        for (job, (device, whole)) in jobs.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            device.extend(job()?);
            whole.push(begin.elapsed());
        }
    }
    let median = |mut times: Vec<Duration>| {
        times.sort();
        times.get(times.len() / 2).copied()
    };
    Ok(times
        .into_iter()
        .map(|(device, whole)| Timed {
            device: median(device),
            whole: median(whole).unwrap_or_default(),
        })
        .collect())
}

/// Milliseconds with three digits, or a dash.
pub fn milliseconds(time: Option<Duration>) -> String {
    let Some(time) = time else { return "-".into() };
    let value = time.as_secs_f64() * 1e3;
    let digits = (2.0 - value.max(1e-9).log10().floor()).clamp(0.0, 4.0) as usize;
    format!("{value:.digits$}")
}
