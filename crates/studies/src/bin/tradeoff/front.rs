//! What is worth its time: the combinations that no other beats in both time and error.

use crate::clock::Times;
use crate::outcome::{Outcome, TOLERANCES};
use crate::statistics::Errors;
use crate::subject::Model;

/// A model, a tolerance and a way to ask.
#[derive(Clone)]
pub struct Combination {
    pub model: Model,
    pub tolerance: f64,
    /// None of a tube.
    pub links: Option<usize>,
    pub way: &'static str,
    /// Seconds a query.
    pub time: f64,
    /// The largest error in magnitude, mm.
    pub error: f64,
}

/// Errors of each model at each tolerance, over the shapes that are free in truth.
pub fn errors(outcomes: &[Outcome]) -> Vec<[Errors; Model::ALL.len()]> {
    let free: Vec<_> = outcomes.iter().filter(|shape| shape.truth > 0.0).collect();
    let of = |tolerance: usize, model: usize| {
        Errors::of(free.iter().map(|shape| shape.each[tolerance].clearances[model] - shape.truth))
    };
    (0..TOLERANCES.len())
        .map(|tolerance| std::array::from_fn(|model| of(tolerance, model)))
        .collect()
}

/// Every combination that was timed.
pub fn combinations(times: &Times, errors: &[[Errors; Model::ALL.len()]]) -> Vec<Combination> {
    let mut all = Vec::new();
    for (index, ways) in times.queries.iter().enumerate() {
        for timed in ways {
            all.push(Combination {
                model: timed.model,
                tolerance: TOLERANCES[index],
                links: timed.links,
                way: timed.way,
                time: timed.time,
                error: errors[index][timed.model.index()].worst(),
            });
        }
    }
    all
}

/// The Pareto front of the combinations, from the fastest to the most accurate.
pub fn front(all: &[Combination]) -> Vec<Combination> {
    let mut sorted = all.to_vec();
    sorted.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error)));
    let mut best = f64::INFINITY;
    sorted.retain(|one| {
        let beats = one.error < best;
        best = best.min(one.error);
        beats
    });
    sorted
}
