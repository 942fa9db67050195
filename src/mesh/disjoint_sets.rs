//! Union-find over items that are numbered from 0: for each item an earlier one of its set, or
//! itself.

/// Returns the first item of a set, and halves the path to it.
#[inline(always)]
pub(crate) fn find_root(joined: &mut [u32], mut item: u32) -> u32 {
    while joined[item as usize] != item {
        let next = joined[item as usize];
        joined[item as usize] = joined[next as usize];
        item = next;
    }
    item
}

/// Unites the sets of two items. Returns the first item of the united set, then the former first
/// item of the other set; both are equal if the items were in one set.
#[inline(always)]
pub(crate) fn unite(joined: &mut [u32], one: u32, other: u32) -> [u32; 2] {
    let (one, other) = (find_root(joined, one), find_root(joined, other));
    let firsts = [one.min(other), one.max(other)];
    joined[firsts[1] as usize] = firsts[0];
    firsts
}
