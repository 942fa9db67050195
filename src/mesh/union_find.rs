//! Things that are joined one after another (Galler and Fischer): each names an earlier one of the
//! same piece, or itself if it is the first.

/// The first of the piece that a thing is part of. The way there becomes shorter for those who ask
/// later.
#[inline(always)]
pub(crate) fn find_root(joined: &mut [u32], mut place: u32) -> u32 {
    while joined[place as usize] != place {
        let next = joined[place as usize];
        joined[place as usize] = joined[next as usize];
        place = next;
    }
    place
}

/// Joins the pieces of two things. Returns the first of the one, which is now the other's too, and
/// of that one before.
#[inline(always)]
pub(crate) fn unite(joined: &mut [u32], one: u32, other: u32) -> [u32; 2] {
    let (one, other) = (find_root(joined, one), find_root(joined, other));
    let firsts = [one.min(other), one.max(other)];
    joined[firsts[1] as usize] = firsts[0];
    firsts
}
