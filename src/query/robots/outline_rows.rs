//! The capsules around a robot's links, each number in a row of its own: a pack of them is compared at once.

use super::outlines::Outline;
use crate::distance::lanes::Pack;
use crate::distance::{Unfused, Vec3, dispatch};
use crate::pair::TOGETHER;
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// Capsules around links: where the axis starts, the way along it, and the radius.
#[derive(Clone, Debug, Default)]
pub(super) struct OutlineRows {
    /// One row behind the other.
    rows: Vec<Real>,
    /// How long each is.
    length: usize,
}

impl OutlineRows {
    /// For so many links, and for a pack that goes beyond the last. There is room for them when the first comes.
    pub fn start(&mut self, links: usize) {
        self.length = links + TOGETHER;
    }

    pub fn put(&mut self, link: usize, outline: &Outline) {
        let Outline { start, along, radius } = *outline;
        let numbers = [start.x, start.y, start.z, along.x, along.y, along.z, radius];
        if self.rows.len() < numbers.len() * self.length {
            self.rows.resize(numbers.len() * self.length, 0.0);
        }
        for (row, number) in numbers.into_iter().enumerate() {
            self.rows[row * self.length + link] = number;
        }
    }

    /// The rows, each from one of the links on.
    #[inline(always)]
    fn from(&self, link: usize) -> [&[Real]; 7] {
        std::array::from_fn(|row| &self.rows[row * self.length + link..][..self.length - link])
    }
}

/// What `take` makes of the rows.
#[inline(always)]
fn outline<L: Pack<Element = Real>>(rows: &[&[Real]; 7], take: impl Fn(&[Real]) -> L) -> Outline<L> {
    let [x, y, z, u, v, w, radius] = rows;
    let point = |x, y, z| Vec3::new(take(x), take(y), take(z));
    Outline { start: point(x, y, z), along: point(u, v, w), radius: take(radius) }
}

/// How far up to [`TOGETHER`] links of one robot are from as many of another.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Block {
    /// Lower bounds on the distances.
    pub at_least: [[Real; TOGETHER]; TOGETHER],
    /// A bit for each pair whose bound is not above the limit.
    near: u64,
}

impl Block {
    /// Compares links from `firsts` on, `counts` of either robot. The unit is what 1 of the rows stands for.
    #[inline(never)] // compiled for each instruction set, not for each use as well
    pub fn compare(
        &mut self,
        level: Level,
        rows: [&OutlineRows; 2],
        firsts: [usize; 2],
        counts: [usize; 2],
        [unit, limit]: [Real; 2],
    ) {
        dispatch!(level, simd => self.fill::<Unfused<_>>(simd, rows, firsts, counts, [unit, limit]));
    }

    #[inline(always)]
    fn fill<L: Pack<Element = Real>>(
        &mut self,
        token: L::Token,
        rows: [&OutlineRows; 2],
        firsts: [usize; 2],
        counts: [usize; 2],
        numbers: [Real; 2],
    ) {
        let [unit, limit] = numbers.map(|number| L::splat(token, number));
        let rows = [0, 1].map(|robot| rows[robot].from(firsts[robot]));
        self.near = 0;
        for first in 0..counts[0] {
            let one = outline(&rows[0], |row| L::splat(token, row[first]));
            for lane in (0..counts[1]).step_by(L::LANES) {
                let others = outline(&rows[1], |row| L::load(token, &row[lane..]));
                let at_least = one.at_least(&others) * unit;
                at_least.store(&mut self.at_least[first][lane..]);
                let are_near = L::bits(!limit.lt(at_least)) << lane & ((1 << counts[1]) - 1);
                self.near |= are_near << (TOGETHER * first);
            }
        }
    }

    /// The pairs that are near, by their places among the links that were compared, in order.
    pub fn near(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let mut left = self.near;
        std::iter::from_fn(move || {
            let pair = (left != 0).then(|| left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some([pair / TOGETHER, pair % TOGETHER])
        })
    }
}
