//! The same work for many items, on all cores (feature `parallel`).

use super::ProximityError;
#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Does `work` on every item, which it gets with its place. An item should be worth some microseconds.
pub(crate) fn each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync + Send) {
    // To wake another thread for one item would take longer than the item.
    if let [item] = items {
        return work(0, item);
    }
    #[cfg(feature = "parallel")]
    items.par_iter_mut().enumerate().for_each(|(place, item)| work(place, item));
    #[cfg(not(feature = "parallel"))]
    items.iter_mut().enumerate().for_each(|(place, item)| work(place, item));
}

/// Does two things, on two cores if it is worth it.
#[cfg(feature = "parallel")]
pub(crate) fn both(is_worth_it: bool, one: impl FnOnce() + Send, other: impl FnOnce() + Send) {
    if is_worth_it {
        rayon::join(one, other);
    } else {
        one();
        other();
    }
}

/// Does two things.
#[cfg(not(feature = "parallel"))]
pub(crate) fn both(_: bool, one: impl FnOnce(), other: impl FnOnce()) {
    one();
    other();
}

/// Answers questions in shares, each share with a memory of its own.
///
/// # Errors
/// Those of `answer` for the first share, in order, that has one.
pub(super) fn in_shares<Q: Sync, A: Send, M: Default + Send>(
    questions: &[Q],
    answers: &mut [A],
    memories: &mut Vec<M>,
    answer: impl Fn(&mut M, &[Q], &mut [A]) -> Result<(), ProximityError> + Sync + Send,
) -> Result<(), ProximityError> {
    #[cfg(feature = "parallel")]
    {
        // A few shares for each thread, because questions differ in the time they take.
        let share = questions.len().div_ceil(4 * rayon::current_num_threads()).max(1);
        memories.resize_with(questions.len().div_ceil(share), M::default);
        let shares = questions.par_chunks(share).zip(answers.par_chunks_mut(share));
        let results =
            shares.zip(memories).map(|((questions, answers), memory)| answer(memory, questions, answers));
        // Of two errors the left one, which is that of earlier questions.
        results.reduce(|| Ok(()), Result::and)
    }
    #[cfg(not(feature = "parallel"))]
    {
        memories.resize_with(1, M::default);
        memories.iter_mut().try_for_each(|memory| answer(memory, questions, answers))
    }
}
