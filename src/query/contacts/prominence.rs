//! Which local minima are prominent: how far every way on the mesh to a nearer one leads away first.
//!
//! # What is left out
//! A rough wall has a local minimum at each of its bumps. Let p be the prominence that is asked for, and take the minima
//! of one link nearest first. The minimum C, at the distance d(C), is *left out* if a way on the wall leads from it to one
//! that is kept, along which the distance stays below d(C) + p and within the margin, and if the normals of the two differ
//! by 60 degrees at most. So
//!
//! 1. *each wall stays*: a minimum that is left out has a nearer one that stands for it, is joined with it by a way that
//!    rises by less than p, and pushes the link within 60 degrees of the same direction. In particular the nearest of each
//!    connected piece of wall within the margin is kept, and so are both sides of a groove;
//! 2. *none is left that is shallow*: a way from a minimum that is kept to a nearer one with such a normal rises by p at
//!    least, or leads beyond the margin;
//! 3. *the choice is the only one* with these two properties, because it is made from the nearest on.
//!
//! A contact without a normal stands for itself alone.
//!
//! # Passes
//! What of a triangle is within a distance c is convex, because the link is. So two triangles are joined by a corner or an
//! edge f that both have exactly from c = d(f) on (see `local_minima`): a way that stays within c can follow a chain of
//! triangles each of which shares with the next an f with d(f) <= c. The least distance of f is a *pass*, and the pieces
//! of wall within c are what passes up to c join. Between its ends an edge may be nearer than at them, and is a pass of its
//! own; else the nearer of its ends is one.
//!
//! C asks for the pieces of wall below d(C) + p. As the minima are taken nearest first, these distances rise, and one sweep
//! over the passes serves them all: each pass waits for the first minimum that may use it. All triangles that may be within
//! the margin take part, those on slopes too. Passes are measured in double precision, an edge always from the same end, so
//! that they are the same bit for bit in all engines.
//!
//! The pass f counts as within the margin if it is so by more than what rounding can do to its distance. Then every
//! triangle that has f is found by every engine.
//!
//! # How much work it is
//! The corners near the link are measured, each once. They join most of what there is, and a minimum for which one stands
//! by then is left out: with more joined there would be one too. Only for the others edges are measured that may be nearer
//! between their ends, as far as they would join what is not joined yet; bounds tell for which minimum that is first needed.
//! So the work grows with the triangles within the margin. Of those that are kept in one piece a minimum asks one after
//! another, first the one that answered last: where there are many, most have such a normal.

use super::local_minima::NONE;
use super::passes::{Passes, Surroundings};
use crate::answer::Contact;
use crate::mesh::{first_of, join};
use fearless_simd::Level;
use parry3d_f64::math::Real;

/// The cosine of the angle between normals beyond which no contact stands for another.
const LEAST_COSINE: Real = 0.5;

/// Which contacts a caller wants.
#[derive(Clone, Copy)]
pub(crate) struct Asked {
    /// How far away they may be.
    pub margin: Real,
    /// How prominent each must be.
    pub prominence: Real,
}

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct Prominence {
    /// The distances below which the minima look around, nearest first.
    below: Vec<Real>,
    passes: Passes,
    pieces: Pieces,
}

/// Pieces of wall, each with the minima in it that are kept.
#[derive(Clone, Default)]
pub(super) struct Pieces {
    /// For each place of a triangle an earlier one of the same piece, or itself.
    joined: Vec<u32>,
    /// For each piece the first and the last of its minima.
    kept: Vec<[u32; 2]>,
    /// For each minimum the next that is kept of the same piece.
    next: Vec<u32>,
}

impl Prominence {
    /// For each contact of one link, nearest first, whether it is kept. `keep` gets the answers.
    pub(super) fn choose(
        &mut self,
        level: Level,
        around: Surroundings,
        asked: Asked,
        contacts: &[Contact],
        keep: &mut Vec<bool>,
    ) {
        if contacts.len() < 2 {
            keep.extend(contacts.iter().map(|_| true));
            return;
        }
        let Self { below, passes, pieces } = self;
        below.clear();
        below.extend(contacts.iter().map(|contact| contact.distance + asked.prominence));
        passes.find(level, around, asked.margin, below);
        pieces.begin(passes.pieces(around));
        for (minimum, contact) in (0..).zip(contacts) {
            passes.join_certain(around, minimum, pieces);
            let place = around.place(contact.triangle).filter(|_| contact.normal.is_some());
            let stands_for_it = |other: u32| {
                let normals = contact.normal.zip(contacts[other as usize].normal);
                normals.is_some_and(|(one, other)| LEAST_COSINE <= one.dot(other))
            };
            let mut is_left_out = place.is_some_and(|place| pieces.find(place, stands_for_it));
            if let Some(place) = place.filter(|_| !is_left_out) {
                passes.join_others(level, around, asked.margin, below, minimum, pieces);
                is_left_out = pieces.find(place, stands_for_it);
            }
            pieces.add(minimum, place.filter(|_| !is_left_out));
            keep.push(!is_left_out);
        }
    }
}

impl Pieces {
    /// Each of so many places is a piece of its own, and nothing is kept.
    fn begin(&mut self, places: usize) {
        self.joined.clear();
        self.joined.extend(0..places as u32);
        self.kept.clear();
        self.kept.resize(places, [NONE; 2]);
        self.next.clear();
    }

    /// Whether two places are in one piece.
    pub(super) fn are_joined(&mut self, one: usize, other: usize) -> bool {
        first_of(&mut self.joined, one as u32) == first_of(&mut self.joined, other as u32)
    }

    /// Joins the pieces of two places.
    pub(super) fn join(&mut self, one: usize, other: usize) {
        let [first, second] = join(&mut self.joined, one as u32, other as u32).map(|place| place as usize);
        if first == second {
            return;
        }
        let ([head, tail], [other_head, other_tail]) = (self.kept[first], self.kept[second]);
        self.kept[first] = match [head, other_head] {
            [_, NONE] => [head, tail],
            [NONE, _] => [other_head, other_tail],
            _ => {
                self.next[tail as usize] = other_head;
                [head, other_tail]
            }
        };
    }

    /// Whether one that is kept in the piece of a place `stands_for` the minimum there. It becomes the first of the piece.
    fn find(&mut self, place: usize, stands_for: impl Fn(u32) -> bool) -> bool {
        let piece = first_of(&mut self.joined, place as u32) as usize;
        let [head, tail] = self.kept[piece];
        let (mut before, mut at) = (NONE, head);
        while at != NONE && !stands_for(at) {
            (before, at) = (at, self.next[at as usize]);
        }
        if at != NONE && before != NONE {
            self.next[before as usize] = self.next[at as usize];
            self.next[at as usize] = head;
            self.kept[piece] = [at, if at == tail { before } else { tail }];
        }
        at != NONE
    }

    /// Adds the next minimum: to those that are kept in the piece of a place, or to none.
    fn add(&mut self, minimum: u32, place: Option<usize>) {
        self.next.push(NONE);
        if let Some(place) = place {
            let piece = first_of(&mut self.joined, place as u32) as usize;
            let [head, tail] = self.kept[piece];
            self.next[minimum as usize] = head;
            self.kept[piece] = [minimum, if tail == NONE { minimum } else { tail }];
        }
    }
}
