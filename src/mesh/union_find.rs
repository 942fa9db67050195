//! Union-find (Galler and Fischer). Each item names an earlier item of the same set, or itself if
//! it is the first.

/// Returns the first item of a set, and halves the path to it.
#[inline(always)]
pub(crate) fn find_root(joined: &mut [u32], mut place: u32) -> u32 {
    while joined[place as usize] != place {
        let next = joined[place as usize];
        joined[place as usize] = joined[next as usize];
        place = next;
    }
    place
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
