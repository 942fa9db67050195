//! Asks about each robot: one on this thread, a batch in chunks on all cores.

use super::compute::compute;
use super::pool::pool;
use crate::error::Refused;
use pyo3::prelude::*;
use std::ops::{Range, RangeInclusive};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The most robots that a worker takes at a time: enough that taking them is negligible.
const SHARE: usize = 8;

/// After about so long signals are looked at, and Python's other threads get their turn.
const CHUNK: Duration = Duration::from_millis(50);

/// A chunk that takes longer ends early: its robots may take much longer than those before it.
const LONGEST: Duration = Duration::from_millis(250);

/// The robots of a chunk are copied, so that there are no more of them than this.
pub(crate) const LARGEST_CHUNK: usize = 1 << 16;

/// The subjects of a query: one, or a batch.
pub(crate) trait Asked {
    /// A copy of some of them, which needs no GIL. It is filled again and again.
    type Block: Default + Sync;
    /// One of a block.
    type One<'a>;

    /// Fewer are answered on the thread that asks: to wake others would take longer.
    const FEW: usize = 16;

    /// How many the batch has; none where one was given by itself.
    fn count(&self) -> Option<usize>;

    /// Copies some of them.
    ///
    /// # Errors
    /// What was given has changed since.
    fn copy(&self, range: Range<usize>, block: &mut Self::Block) -> Result<(), Refused>;

    /// The one at this place in a block.
    fn one(block: &Self::Block, place: usize) -> Self::One<'_>;

    /// How many there are.
    fn len(&self) -> usize {
        self.count().unwrap_or(1)
    }

    /// The shape of an array that has a number for each, and then what `last` says.
    fn shape(&self, last: &[usize]) -> Vec<usize> {
        self.count().iter().chain(last).copied().collect()
    }
}

/// Who lends what one thread needs to ask.
pub(crate) trait Lender {
    type Session: Send;

    /// A session, to be given back.
    fn lend(&self, py: Python<'_>) -> PyResult<Self::Session>;

    /// Takes sessions back: as many as were lent, or fewer where a defect cost some of them.
    fn take_back(
        &self,
        py: Python<'_>,
        lent: usize,
        sessions: impl IntoIterator<Item = Self::Session>,
    );
}

impl<L: Lender> Lender for Arc<L> {
    type Session = L::Session;

    fn lend(&self, py: Python<'_>) -> PyResult<Self::Session> {
        (**self).lend(py)
    }

    fn take_back(
        &self,
        py: Python<'_>,
        lent: usize,
        sessions: impl IntoIterator<Item = Self::Session>,
    ) {
        (**self).take_back(py, lent, sessions);
    }
}

/// Answers about each robot, or motion, `width` of them for each, at least one, in order. `take`
/// gets them chunk by chunk, with the place of the first of them.
///
/// The first robot that is refused ends the batch. All robots see the same mesh, even if another
/// thread moves it.
pub(crate) fn ask_each<T: Clone + Send, L: Lender, Q: Asked>(
    py: Python<'_>,
    lender: &L,
    asked: &Q,
    (empty, width): (T, usize),
    answer: impl Fn(&mut L::Session, &Q::One<'_>, &mut [T]) -> Result<(), Refused> + Sync,
    take: impl FnMut(usize, &[T]),
) -> PyResult<()> {
    let ask = |block: &Q::Block, answers: &mut [T]| {
        Rows::<Q, _> { block, width, answer: &answer }.ask_lender(py, lender, asked, answers)
    };
    in_chunks(py, asked, (empty, width), Q::FEW..=LARGEST_CHUNK, ask, take)
}

/// The first robot that is refused, by its place in the chunk, and why.
pub(crate) type FirstRefused = Option<(usize, Refused)>;

/// How many robots of a chunk are answered, from the first on, at least one; and the first that is
/// refused.
pub(crate) type Answered = (usize, FirstRefused);

/// Has `ask` answer chunk after chunk. The first chunk has as many robots as `sizes` starts with;
/// the next are as long as fits [`CHUNK`].
pub(crate) fn in_chunks<T: Clone, Q: Asked>(
    py: Python<'_>,
    asked: &Q,
    (empty, width): (T, usize),
    sizes: RangeInclusive<usize>,
    mut ask: impl FnMut(&Q::Block, &mut [T]) -> PyResult<Answered>,
    mut take: impl FnMut(usize, &[T]),
) -> PyResult<()> {
    let of_batch = |robot: usize| asked.count().map(|_| robot);
    let (count, mut block, mut answers) = (asked.len(), Q::Block::default(), Vec::new());
    let (mut start, mut chunk) = (0, *sizes.start());
    while start < count {
        let wanted = count.min(start + chunk) - start;
        let begin = Instant::now();
        answers.clear();
        answers.resize(wanted * width, empty.clone());
        asked.copy(start..start + wanted, &mut block).map_err(|refused| refused.raise(py, None))?;
        let (done, refused) = ask(&block, &mut answers)?;
        if let Some((place, refused)) = refused {
            return Err(refused.raise(py, of_batch(start + place)));
        }
        take(start, &answers[..done * width]);
        let end = start + done;
        if asked.count().is_some() {
            py.check_signals()?;
        }
        if end == count {
            break;
        }
        let scale = CHUNK.as_secs_f64() / begin.elapsed().as_secs_f64().max(1e-9);
        chunk = ((done as f64 * scale.min(8.0)) as usize).clamp(2, *sizes.end());
        start = end;
    }
    Ok(())
}

/// One answer about each robot, or motion, in order. The first that is refused ends the batch.
pub(crate) fn answer_each<A: Clone + Send, L: Lender, Q: Asked>(
    py: Python<'_>,
    lender: &L,
    asked: &Q,
    answer: impl Fn(&mut L::Session, &Q::One<'_>) -> Result<A, Refused> + Sync,
) -> PyResult<Vec<A>> {
    let mut all = Vec::with_capacity(asked.len());
    let ask = |session: &mut L::Session, one: &Q::One<'_>, row: &mut [Option<A>]| {
        row[0] = Some(answer(session, one)?);
        Ok(())
    };
    ask_each(py, lender, asked, (None, 1), ask, |_, found| {
        all.extend(found.iter().flatten().cloned());
    })?;
    Ok(all)
}

/// The same, where one that is refused does not fail its batch: it has the `kind` of its error.
pub(crate) fn answer_each_or_kind<A: Clone + Send, L: Lender, Q: Asked>(
    py: Python<'_>,
    lender: &L,
    asked: &Q,
    answer: impl Fn(&mut L::Session, &Q::One<'_>) -> Result<A, Refused> + Sync,
) -> PyResult<Vec<Result<A, &'static str>>> {
    let is_batch = asked.count().is_some();
    answer_each(py, lender, asked, |session: &mut L::Session, one: &Q::One<'_>| {
        match answer(session, one) {
            Err(refused) if is_batch => Ok(Err(refused.kind())),
            found => found.map(Ok),
        }
    })
}

/// A session for one question, without the GIL.
pub(crate) fn alone<T: Send, L: Lender>(
    py: Python<'_>,
    lender: &L,
    ask: impl FnOnce(&mut L::Session) -> T + Send,
) -> PyResult<T> {
    let mut session = lender.lend(py)?;
    let answer = compute(py, || ask(&mut session));
    // What a defect leaves is not used again.
    lender.take_back(py, 1, answer.is_ok().then_some(session));
    answer
}

/// The robots of a chunk, and the query for each.
pub(crate) struct Rows<'a, Q: Asked, A> {
    pub block: &'a Q::Block,
    pub width: usize,
    pub answer: &'a A,
}

impl<Q: Asked, A> Rows<'_, Q, A> {
    /// Asks about the robots of the block: a small batch on this thread, a large one on all cores.
    /// After [`LONGEST`] no more of them are begun.
    pub(crate) fn ask_lender<T: Send, L: Lender>(
        &self,
        py: Python<'_>,
        lender: &L,
        asked: &Q,
        answers: &mut [T],
    ) -> PyResult<Answered>
    where
        A: Fn(&mut L::Session, &Q::One<'_>, &mut [T]) -> Result<(), Refused> + Sync,
    {
        if asked.len() < Q::FEW {
            let begin = Instant::now();
            alone(py, lender, |session| {
                let mut done = 0;
                for row in answers.chunks_mut(self.width) {
                    if done > 0 && begin.elapsed() > LONGEST {
                        break;
                    }
                    if let Some(found) = self.ask(session, done, row) {
                        return (done, Some(found));
                    }
                    done += 1;
                }
                (done, None)
            })
        } else {
            self.ask_on_all_cores(py, lender, answers)
        }
    }

    /// Asks about the robots from the place `first` on, one for each row of answers. Returns the
    /// first that is refused.
    fn ask<S, T>(&self, session: &mut S, first: usize, answers: &mut [T]) -> FirstRefused
    where
        A: Fn(&mut S, &Q::One<'_>, &mut [T]) -> Result<(), Refused>,
    {
        answers.chunks_mut(self.width).zip(first..).find_map(|(row, place)| {
            (self.answer)(session, &Q::one(self.block, place), row)
                .err()
                .map(|refused| (place, refused))
        })
    }

    /// The same for the robots of the block, by a session on each core. Shares are taken in order
    /// and completed, so the answered robots are the first ones.
    fn ask_on_all_cores<T: Send, L: Lender>(
        &self,
        py: Python<'_>,
        lender: &L,
        answers: &mut [T],
    ) -> PyResult<Answered>
    where
        A: Fn(&mut L::Session, &Q::One<'_>, &mut [T]) -> Result<(), Refused> + Sync,
    {
        let begin = Instant::now();
        let pool = pool(py)?;
        let (threads, count) = (pool.current_num_threads(), answers.len() / self.width);
        // A few for each thread, because robots differ in the time they take.
        let share = (count / (4 * threads)).clamp(1, SHARE);
        let workers = threads.min(count.div_ceil(share));
        let mut sessions = (0..workers).map(|_| lender.lend(py)).collect::<PyResult<Vec<_>>>()?;
        let refused = Mutex::new(None::<(usize, Refused)>);
        let shares = Mutex::new(answers.chunks_mut(share * self.width).enumerate());
        let taken = AtomicUsize::new(0);
        // Its locks are this call's own, so a fork leaves them to nobody.
        let work = |session: &mut L::Session| {
            loop {
                if taken.load(Ordering::Relaxed) > 0 && begin.elapsed() > LONGEST {
                    return;
                }
                let next = shares.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((number, answers)) = next else { return };
                taken.fetch_add(1, Ordering::Relaxed);
                let Some(found) = self.ask(session, share * number, answers) else { continue };
                let mut refused = refused.lock().unwrap_or_else(PoisonError::into_inner);
                if refused.as_ref().is_none_or(|(place, _)| found.0 < *place) {
                    *refused = Some(found);
                }
                // Those before it are all taken, and those behind it do not count any more.
                shares.lock().unwrap_or_else(PoisonError::into_inner).by_ref().for_each(drop);
                return;
            }
        };
        let done = compute(py, || {
            pool.scope(|scope| {
                let work = &work;
                sessions.iter_mut().for_each(|session| scope.spawn(move |_| work(session)));
            });
        });
        lender.take_back(py, workers, done.is_ok().then_some(sessions).into_iter().flatten());
        done?;
        let done = count.min(share * taken.into_inner());
        Ok((done, refused.into_inner().unwrap_or_else(PoisonError::into_inner)))
    }
}
