//! The same work on the thread that asks for it.

/// The number of threads that may work.
pub(super) fn threads() -> usize {
    1
}

/// Runs two closures.
pub(super) fn join(one: impl FnOnce(), other: impl FnOnce()) {
    one();
    other();
}

/// Calls `work` with the index of every item, and the item.
pub(super) fn each<T>(items: &mut [T], work: &(dyn Fn(usize, &mut T) + Sync)) {
    items.iter_mut().enumerate().for_each(|(place, item)| work(place, item));
}

/// Answers questions in chunks of `share`, each with its own memory.
pub(super) fn in_chunks<Q, A, M>(
    share: usize,
    questions: &[Q],
    answers: &mut [A],
    memories: &mut [M],
    answer: impl Fn(&mut M, &[Q], &mut [A]),
) {
    let shares = questions.chunks(share).zip(answers.chunks_mut(share));
    shares
        .zip(memories)
        .for_each(|((questions, answers), memory)| answer(memory, questions, answers));
}
