//! The nearest pairs of bodies.

use parry3d_f64::math::Real;

/// Pairs of body indices with lower bounds on their distances. Keeps the nearest `most` pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct NearestPairs {
    order: Vec<(Real, [u32; 2])>,
    most: usize,
    is_all: bool,
}

impl NearestPairs {
    pub(super) fn begin(&mut self, most: usize) {
        self.order.clear();
        (self.most, self.is_all) = (most, true);
    }

    pub(super) fn push(&mut self, at_least: Real, [i, j]: [usize; 2]) {
        self.order.push((at_least, [i as u32, j as u32]));
        if self.order.len() >= self.most.saturating_mul(2) {
            self.keep_nearest();
        }
    }

    /// Returns the pairs, the farthest first, and whether all pairs were kept.
    pub(super) fn farthest_first(&mut self) -> (impl Iterator<Item = [usize; 2]>, bool) {
        self.keep_nearest();
        self.order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
        (self.order.iter().map(|(_, pair)| pair.map(|place| place as usize)), self.is_all)
    }

    fn keep_nearest(&mut self) {
        if self.order.len() > self.most {
            self.order.select_nth_unstable_by(self.most, |a, b| a.0.total_cmp(&b.0));
            self.order.truncate(self.most);
            self.is_all = false;
        }
    }
}
