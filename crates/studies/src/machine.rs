//! What the program runs on, and how much memory it holds.

use continuum_demo::levels::levels;
use std::fs;

/// The processor, its cores, and the instructions that the engines use there.
pub fn description() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        info.lines()
            .find(|line| line.starts_with(name))
            .and_then(|line| line.split_once(':'))
            .map(|(_, value)| value)
    };
    let model = field("model name").map_or("an unnamed processor", str::trim);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let widest = levels().first().map_or("no SIMD", |level| level.0);
    format!("{model}, {cores} cores, {widest}")
}

/// Bytes of memory held now, where the system says so.
pub fn memory() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kilobytes| kilobytes * 1024.0)
}
