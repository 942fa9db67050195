//! Work on the threads of a pool. No other file uses one.

use rayon::prelude::*;

pub(super) use rayon::{current_num_threads as threads, join};

/// Calls `work` with the index of every item, and the item.
pub(super) fn each<T: Send>(items: &mut [T], work: &(dyn Fn(usize, &mut T) + Sync)) {
    items.par_iter_mut().enumerate().for_each(|(place, item)| work(place, item));
}

/// Answers questions in chunks of `share`, each with its own memory.
pub(super) fn in_chunks<Q: Sync, A: Send, M: Send>(
    share: usize,
    questions: &[Q],
    answers: &mut [A],
    memories: &mut [M],
    answer: impl Fn(&mut M, &[Q], &mut [A]) + Sync + Send,
) {
    let shares = questions.par_chunks(share).zip(answers.par_chunks_mut(share));
    shares
        .zip(memories)
        .for_each(|((questions, answers), memory)| answer(memory, questions, answers));
}
