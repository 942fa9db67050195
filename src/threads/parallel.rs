//! The same work for many items, on all cores (feature `parallel`) or on one.

use super::pool;
use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

thread_local! {
    /// Whether this thread works alone, inside [`on_this_thread`].
    static IS_ALONE: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` on this thread alone: it neither waits for other threads of the pool nor takes up
/// their tasks.
pub(crate) fn on_this_thread<T>(work: impl FnOnce() -> T) -> T {
    /// Restores the previous flag, after a panic too.
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            IS_ALONE.set(self.0);
        }
    }
    let _before = Before(IS_ALONE.replace(true));
    work()
}

/// The number of threads that may work.
pub(crate) fn threads() -> usize {
    if IS_ALONE.get() { 1 } else { pool::threads() }
}

/// Calls `work` with the index of every item, and the item. An item should take some microseconds.
pub(crate) fn each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
    // Waking another thread takes longer than one item.
    if items.len() < 2 || threads() == 1 {
        return items.iter_mut().enumerate().for_each(|(place, item)| work(place, item));
    }
    // One thread takes each item, once. None works or waits while it holds the lock.
    let items: Vec<_> = items.iter_mut().map(|item| Mutex::new(Some(item))).collect();
    pool::each(items.len(), &|place| {
        let item = items[place].lock().unwrap_or_else(PoisonError::into_inner).take();
        item.into_iter().for_each(|item| work(place, item));
    });
}

/// Runs two closures, on two cores if that is worth it.
pub(crate) fn both(is_worth_it: bool, one: impl FnOnce() + Send, other: impl FnOnce() + Send) {
    if !is_worth_it || threads() == 1 {
        one();
        return other();
    }
    let (mut one, mut other) = (Some(one), Some(other));
    pool::join(&mut || one.take().into_iter().for_each(|one| one()), &mut || {
        other.take().into_iter().for_each(|other| other())
    });
}

/// Answers questions in chunks, each chunk with its own memory.
pub(crate) fn in_chunks<Q: Sync, A: Send, M: Default + Send>(
    questions: &[Q],
    answers: &mut [A],
    memories: &mut Vec<M>,
    answer: impl Fn(&mut M, &[Q], &mut [A]) + Sync,
) {
    let threads = threads();
    if threads == 1 {
        memories.resize_with(1, M::default);
        return answer(&mut memories[0], questions, answers);
    }
    // Four chunks per thread balance the load, because questions differ in their time.
    let share = questions.len().div_ceil(4 * threads).max(1);
    memories.resize_with(questions.len().div_ceil(share), M::default);
    let shares = questions.chunks(share).zip(answers.chunks_mut(share)).zip(memories);
    each(&mut shares.collect::<Vec<_>>(), |_, ((questions, answers), memory)| {
        answer(memory, questions, answers);
    });
}

/// Answers questions in chunks, each chunk with its own clone of `original`. Replaces the content
/// of `answers`; until a question is answered, its place holds `unanswered`.
#[cfg(feature = "robots")]
pub(crate) fn with_clones<S: Clone + Send + Sync, Q: Sync, A: Send>(
    original: &S,
    questions: &[Q],
    answers: &mut Vec<A>,
    unanswered: impl FnMut() -> A,
    ask: impl Fn(&mut S, &Q) -> A + Sync + Send,
) {
    answers.clear();
    answers.resize_with(questions.len(), unanswered);
    in_chunks(questions, answers, &mut Vec::new(), |own: &mut Option<S>, questions, answers| {
        let own = own.get_or_insert_with(|| original.clone());
        for (question, answer) in questions.iter().zip(answers) {
            *answer = ask(own, question);
        }
    });
}

#[cfg(all(test, feature = "parallel"))]
mod tests {
    use super::*;
    use std::collections::HashSet;
    use std::thread::{self, ThreadId};
    use std::time::Duration;

    /// The threads on which slow items run.
    fn threads_of_each() -> HashSet<ThreadId> {
        let seen = Mutex::new(HashSet::new());
        each(&mut [(); 64], |_, ()| {
            thread::sleep(Duration::from_millis(1));
            seen.lock().unwrap().insert(thread::current().id());
        });
        seen.into_inner().unwrap()
    }

    fn threads_of_both() -> [ThreadId; 2] {
        let mut ids = [thread::current().id(); 2];
        let [one, other] = &mut ids;
        let note = |id: &mut ThreadId| {
            thread::sleep(Duration::from_millis(20));
            *id = thread::current().id();
        };
        both(true, || note(one), || note(other));
        ids
    }

    fn threads_of_shares() -> HashSet<ThreadId> {
        let (mut answers, mut memories) = ([None; 64], Vec::<()>::new());
        in_chunks(&[(); 64], &mut answers, &mut memories, |(), _, answers| {
            thread::sleep(Duration::from_millis(1));
            answers.fill(Some(thread::current().id()));
        });
        answers.into_iter().flatten().collect()
    }

    /// A pool task that works alone has no helpers and takes up no other task. The flag is cleared
    /// at its end, and after a panic.
    #[test]
    fn who_is_alone_stays_on_one_thread() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(16).build().unwrap();
        pool.install(|| {
            let own = thread::current().id();
            on_this_thread(|| {
                on_this_thread(|| ());
                assert_eq!(threads(), 1);
                assert_eq!(threads_of_each(), HashSet::from([own]));
                assert_eq!(threads_of_both(), [own; 2]);
                assert_eq!(threads_of_shares(), HashSet::from([own]));
            });
            let failed = std::panic::catch_unwind(|| on_this_thread(|| panic!("meant")));
            assert!(failed.is_err());
            assert_eq!(threads(), 16);
            assert!(threads_of_each().len() > 1 && threads_of_shares().len() > 1);
            let [one, other] = threads_of_both();
            assert!(one != other);
        });
    }
}
