//! The same work for every item of a slice, on all cores (feature `parallel`).

#[cfg(feature = "parallel")]
use rayon::prelude::*;

/// Does `work` on every item, which it gets with its place. An item should be worth some microseconds.
pub(crate) fn each<T: Send>(items: &mut [T], work: impl Fn(usize, &mut T) + Sync + Send) {
    #[cfg(feature = "parallel")]
    items.par_iter_mut().enumerate().for_each(|(place, item)| work(place, item));
    #[cfg(not(feature = "parallel"))]
    items.iter_mut().enumerate().for_each(|(place, item)| work(place, item));
}
