//! Times of jobs that take turns, so that other load slows all of them alike.

use std::time::Instant;

/// A job; its argument is the number of the turn.
pub type Job<'a> = &'a mut dyn FnMut(usize);

/// The median time of each job in seconds, over this many turns.
pub fn in_turns<const N: usize>(turns: usize, mut jobs: [Job; N]) -> [f64; N] {
    let mut times = [const { Vec::new() }; N];
    for turn in 0..turns {
        for (job, times) in jobs.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            job(turn);
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}
