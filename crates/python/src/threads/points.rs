//! Asks about points, on all cores where they are many.

use super::compute::compute;
use super::each::{Lender, alone};
use super::engine::Engine;
use super::pool::pool;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::BvhSearch;
use pyo3::prelude::*;
use rayon::prelude::*;

/// Fewer points are answered on the thread that asks.
const FEW: usize = 256;

/// How many points pass between two checks for signals.
const CHUNK: usize = 1 << 16;

/// An answer about each point, in order.
pub(crate) fn ask_points<T: Send>(
    py: Python<'_>,
    engine: &Engine,
    points: &[Vector],
    answer: impl Fn(&BvhSearch, Vector) -> T + Sync,
) -> PyResult<Vec<T>> {
    let mut answers = Vec::with_capacity(points.len());
    for chunk in points.chunks(CHUNK) {
        if points.len() < FEW {
            alone(py, engine, |session| {
                answers.extend(chunk.iter().map(|&point| answer(&session.search, point)))
            })?;
            break;
        }
        let (pool, session) = (pool(py)?, engine.lend(py)?);
        let search = &session.search;
        let found = compute(py, || {
            pool.install(|| {
                chunk.par_iter().map(|&point| answer(search, point)).collect::<Vec<_>>()
            })
        });
        engine.take_back(py, 1, [session]);
        answers.extend(found?);
        py.check_signals()?;
    }
    Ok(answers)
}
