//! How many there are of a batch.

use crate::error::Refused;
use pyo3::prelude::*;
use std::fmt::Display;

/// How many there are of what has these numbers of its parts, as numpy broadcasts: none or one of a
/// part stands for all. `None` if the numbers do not fit.
pub(crate) fn broadcast(one: Option<usize>, other: Option<usize>) -> Option<Option<usize>> {
    match (one, other) {
        (None, count) | (count, None) | (Some(1), count) | (count, Some(1)) => Some(count),
        (one, other) => (one == other).then_some(one),
    }
}

/// The length of a batch. Each of its parts has that length, or is one for the whole batch.
pub(crate) fn together<N: Default + Display>(
    py: Python<'_>,
    parts: impl IntoIterator<Item = (N, Option<usize>)>,
) -> PyResult<Option<usize>> {
    let (mut all, mut first) = (None, N::default());
    for (name, count) in parts {
        let Some(both) = broadcast(all, count) else {
            let [one, other] = [all, count].map(Option::unwrap_or_default);
            let text = format!(
                "`{first}` has {one} and `{name}` {other}; give as many of both, or one of either"
            );
            return Err(Refused::other("bad_shape", text).raise(py, None));
        };
        if both != all {
            (all, first) = (both, name);
        }
    }
    Ok(all)
}

/// The place of one for all, or of one of as many as there are.
pub(crate) fn place_in(count: Option<usize>, place: usize) -> usize {
    if matches!(count, None | Some(1)) { 0 } else { place }
}
