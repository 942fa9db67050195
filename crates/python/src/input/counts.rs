//! How many there are of a batch.

/// How many there are of what has these numbers of its parts, as numpy broadcasts: none or one of a
/// part stands for all. `None` if the numbers do not fit.
pub(crate) fn broadcast(one: Option<usize>, other: Option<usize>) -> Option<Option<usize>> {
    match (one, other) {
        (None, count) | (count, None) | (Some(1), count) | (count, Some(1)) => Some(count),
        (one, other) => (one == other).then_some(one),
    }
}
