//! Linked lists of numbers that are concatenated in constant time.

use super::local_minima::NONE;

/// Disjoint lists: each number is in at most one list, and once.
#[derive(Clone, Default)]
pub(super) struct DisjointLists {
    /// For each list its first and its last number.
    ends: Vec<[u32; 2]>,
    /// For each number the next.
    next: Vec<u32>,
}

impl DisjointLists {
    /// Removes all lists and numbers.
    pub(super) fn clear(&mut self) {
        self.ends.clear();
        self.next.clear();
    }

    /// Adds an empty list; lists are numbered in order.
    pub(super) fn begin(&mut self) {
        self.ends.push([NONE; 2]);
    }

    /// Prepends a number that is in no list.
    pub(super) fn put(&mut self, list: u32, number: u32) {
        let (at, number_at) = (list as usize, number as usize);
        let [head, tail] = self.ends[at];
        self.next.resize(self.next.len().max(number_at + 1), NONE);
        self.next[number_at] = head;
        self.ends[at] = [number, if tail == NONE { number } else { tail }];
    }

    /// Appends the numbers of the list `from` to the list `to`, and empties `from`.
    pub(super) fn append(&mut self, from: u32, to: u32) {
        let [head, tail] = std::mem::replace(&mut self.ends[from as usize], [NONE; 2]);
        if head == NONE {
            return;
        }
        let [to_head, to_tail] = self.ends[to as usize];
        if to_head == NONE {
            self.ends[to as usize] = [head, tail];
        } else {
            self.next[to_tail as usize] = head;
            self.ends[to as usize] = [to_head, tail];
        }
    }

    /// Moves the numbers of a list to the end of `out`.
    pub(super) fn take(&mut self, list: u32, out: &mut Vec<u32>) {
        let [mut at, _] = std::mem::replace(&mut self.ends[list as usize], [NONE; 2]);
        while at != NONE {
            out.push(at);
            at = self.next[at as usize];
        }
    }

    /// Returns true if `is_such` holds for a number of a list, and moves the first such number to
    /// the front.
    pub(super) fn find(&mut self, list: u32, is_such: impl Fn(u32) -> bool) -> bool {
        let [head, tail] = self.ends[list as usize];
        let (mut before, mut at) = (NONE, head);
        while at != NONE && !is_such(at) {
            (before, at) = (at, self.next[at as usize]);
        }
        if at != NONE && before != NONE {
            self.next[before as usize] = self.next[at as usize];
            self.next[at as usize] = head;
            self.ends[list as usize] = [at, if at == tail { before } else { tail }];
        }
        at != NONE
    }
}
