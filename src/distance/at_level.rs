//! Runs any kernel on packs of a chosen instruction set, to measure the accuracy of packs.

use super::lanes::{Lane, Pack};
use super::{Scalar, dispatch};
use fearless_simd::Level;

/// A kernel: one text for single numbers and for packs.
pub trait Kernel<const IN: usize, const OUT: usize> {
    /// Maps the numbers of a problem to the numbers of its answer.
    fn run<T: Scalar>(problem: [T; IN]) -> [T; OUT];
}

/// Returns the answers to all problems, computed one pack at a time.
#[allow(private_bounds)] // f32 or f64
pub fn at_level<K: Kernel<IN, OUT>, E: Lane, const IN: usize, const OUT: usize>(
    level: Level,
    problems: &[[E; IN]],
) -> Vec<[E; OUT]> {
    let mut answers = Vec::with_capacity(problems.len());
    dispatch!(level, simd => on_packs::<K, E::Pack<_>, IN, OUT>(simd, problems, &mut answers));
    answers
}

#[inline(always)]
fn on_packs<K: Kernel<IN, OUT>, L: Pack, const IN: usize, const OUT: usize>(
    token: L::Token,
    problems: &[[L::Element; IN]],
    answers: &mut Vec<[L::Element; OUT]>,
) where
    L::Element: Lane,
{
    let mut lanes = vec![L::Element::default(); L::LANES];
    for pack in problems.chunks(L::LANES) {
        let problem = std::array::from_fn(|number| {
            // The last pack is filled with its last problem.
            for (lane, value) in lanes.iter_mut().enumerate() {
                *value = pack[lane.min(pack.len() - 1)][number];
            }
            L::load(token, &lanes)
        });
        let answer = K::run(problem);
        let first = answers.len();
        answers.resize(first + pack.len(), [L::Element::default(); OUT]);
        for (number, value) in answer.into_iter().enumerate() {
            value.store(&mut lanes);
            for (answer, value) in answers[first..].iter_mut().zip(&lanes) {
                answer[number] = *value;
            }
        }
    }
}
