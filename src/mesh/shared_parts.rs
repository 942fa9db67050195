//! Which triangles share a corner or an edge, by place.
//!
//! # Definitions
//! - *place* of a corner: its coordinates. Open corners within rounding of one another are at the
//!   same place ([`seams`](super::seams)).
//! - *part* of a triangle: one of its three corners or three edges. Two parts are the same if their
//!   ends lie at the same places.
//! - *ring* of a part: a circular list of all triangles with the same part, in which each names the
//!   next. Around an edge there may be any number of triangles (Weiler's radial edge).
//!
//! Only corners are numbered, by their places; an edge is the pair of its ends. So the rings stay
//! valid after a motion if the same vertices coincide as before, and if no open edges touch before
//! or after it.
//!
//! # Algorithm
//! 1. Number the places: a hash table gives each vertex the first vertex with its coordinates.
//! 2. Join the corners at each place to one ring.
//! 3. For each place, walk its ring and join the edges that lead to the same other place.
//! 4. Find the open edges, and where they touch. If open corners do, repeat steps 2 and 3 with the
//!    places that they have in common.

use super::seams::{OpenEdge, Seam, Seams, Touching};
use parry3d_f64::math::{Real, Vector};
use std::iter::{once, successors};

/// The number of parts of a triangle. Parts 0 to 2 are the corners a, b and c; parts 3 to 5 are the
/// edges ab, bc and ca.
pub(crate) const PARTS: usize = 6;

/// The part of a triangle that holds its nearest point, by the corners without a share in that
/// point. One bit per corner.
pub(crate) const PART_WITHOUT: [Option<u8>; 8] =
    [None, Some(4), Some(5), Some(2), Some(3), Some(1), Some(0), None];

/// No vertex.
const NONE: u32 = u32::MAX;

/// Which triangles share corners and edges.
#[derive(Clone)]
pub(crate) struct SharedParts {
    /// For each vertex the first vertex at the same place.
    corners: Vec<u32>,
    rings: Rings,
    open: Vec<OpenEdge>,
    /// What triangles share within rounding only, if they share anything so.
    seams: Option<Seams>,
}

/// A part of a triangle.
#[derive(Clone, Copy, PartialEq, Eq)]
struct SharedPart {
    triangle: u32,
    number: u8,
}

/// The next part in the ring of each part of a triangle.
#[derive(Clone, Copy)]
struct Next {
    triangles: [u32; PARTS],
    numbers: [u8; PARTS],
}

/// The rings of all triangles.
#[derive(Clone)]
struct Rings(Vec<Next>);

impl SharedParts {
    pub(crate) fn new(vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        let corners = first_at_same_place(vertices);
        let rings = Rings::new(&corners, indices);
        let open = rings.open_edges(&corners, indices);
        let mut parts = Self { corners, rings, open, seams: None };
        let touching = Touching::find(vertices, &parts.open);
        if !touching.is_empty() {
            if touching.unite_places(&mut parts.corners) {
                parts.rings = Rings::new(&parts.corners, indices);
            }
            let Self { corners, open, .. } = &parts;
            parts.seams = Some(Seams::new(vertices, indices, corners, open, &touching));
        }
        parts
    }

    /// Returns the first vertex at the place of a vertex.
    #[inline(always)]
    pub(crate) fn first_at(&self, vertex: u32) -> u32 {
        self.corners[vertex as usize]
    }

    /// Returns true if the same vertices coincide at these places and no open edges touch, before
    /// or now, so that the rings stay valid.
    pub(crate) fn stay(&self, vertices: &[Vector]) -> bool {
        self.seams.is_none()
            && first_at_same_place(vertices) == self.corners
            && Touching::find(vertices, &self.open).is_empty()
    }

    /// Returns true if a triangle shares a corner or a stretch only within rounding.
    #[inline(always)]
    pub(crate) fn is_loose(&self, triangle: u32) -> bool {
        self.seams.as_ref().is_some_and(|seams| seams.is_loose(triangle))
    }

    /// Returns the seams of a triangle.
    pub(crate) fn seams(&self, triangle: u32) -> &[Seam] {
        self.seams.as_ref().map_or(&[], |seams| seams.of(triangle))
    }

    /// Returns true if triangles share a corner or a stretch only within rounding.
    pub(crate) fn has_seams(&self) -> bool {
        self.seams.is_some()
    }

    /// Returns the places that lie between the ends of an open edge, within rounding. The places of
    /// the ends are given in ascending order.
    pub(crate) fn on_edge(&self, ends: [u32; 2]) -> impl Iterator<Item = u32> {
        self.seams.iter().flat_map(move |seams| seams.on_edge(ends))
    }

    /// Returns a bound on the distance between two corners at the place of a vertex.
    pub(crate) fn gap(&self, vertex: u32) -> Real {
        self.seams.as_ref().map_or(0.0, |seams| seams.gap(vertex))
    }

    /// Returns the other triangles with the same part.
    #[inline(always)]
    pub(crate) fn others(&self, triangle: u32, part: usize) -> impl Iterator<Item = u32> {
        self.rings.others(SharedPart { triangle, number: part as u8 }).map(|part| part.triangle)
    }

    /// Returns all triangles with the same part and the number of the part in each. The triangle
    /// itself comes first.
    pub(crate) fn ring(&self, triangle: u32, part: usize) -> impl Iterator<Item = (u32, usize)> {
        let own = SharedPart { triangle, number: part as u8 };
        let all = once(own).chain(self.rings.others(own));
        all.map(|part| (part.triangle, usize::from(part.number)))
    }

    /// Returns another triangle at an edge, and its corner opposite to that edge.
    pub(crate) fn across(&self, triangle: u32, edge: usize) -> Option<(u32, usize)> {
        let next = self.rings.next(SharedPart { triangle, number: edge as u8 });
        (next.triangle != triangle).then(|| (next.triangle, (usize::from(next.number) + 2) % 3))
    }
}

impl Rings {
    /// Joins the parts of all triangles whose corners have the same numbers.
    fn new(corners: &[u32], indices: &[[u32; 3]]) -> Self {
        let corner = |part: SharedPart| {
            corners[indices[part.triangle as usize][usize::from(part.number)] as usize]
        };
        let mut rings = Self::of_one(indices.len() as u32);
        // One part in the ring of each corner.
        let mut around = vec![None; corners.len()];
        for triangle in 0..indices.len() as u32 {
            for number in 0..3 {
                let part = SharedPart { triangle, number };
                let around = &mut around[corner(part) as usize];
                match *around {
                    Some(first) => rings.join(first, part),
                    None => *around = Some(part),
                }
            }
        }
        // For each corner the last corner from which an edge led to it, and that edge.
        let mut edges = vec![(NONE, SharedPart { triangle: 0, number: 0 }); corners.len()];
        for (from, &first) in (0..).zip(&around) {
            let mut next = first;
            while let Some(part @ SharedPart { triangle, number }) = next {
                let [after, before] = [(number + 1) % 3, (number + 2) % 3];
                for (end, edge) in [(after, number + 3), (before, before + 3)] {
                    let to = corner(SharedPart { triangle, number: end });
                    // Counts each edge once: from its lower end, or from its beginning if both ends
                    // are the same.
                    if to < from || (to == from && end == before) {
                        continue;
                    }
                    let edge = SharedPart { triangle, number: edge };
                    match &mut edges[to as usize] {
                        (last, first) if *last == from => rings.join(*first, edge),
                        none => *none = (from, edge),
                    }
                }
                next = Some(rings.next(part)).filter(|next| Some(*next) != first);
            }
        }
        rings
    }

    /// Returns the edges whose triangles all have the same third corner, each once. A triangle
    /// that has an end of the edge twice does not count.
    fn open_edges(&self, corners: &[u32], indices: &[[u32; 3]]) -> Vec<OpenEdge> {
        let place =
            |triangle: u32, corner: usize| corners[indices[triangle as usize][corner % 3] as usize];
        let (mut open, mut is_seen) = (Vec::new(), vec![false; 3 * indices.len()]);
        for triangle in 0..indices.len() as u32 {
            for edge in 0..3 {
                if is_seen[3 * triangle as usize + edge] {
                    continue;
                }
                let ends = [place(triangle, edge), place(triangle, edge + 1)];
                let (mut third, mut is_open) = (NONE, ends[0] != ends[1]);
                let own = SharedPart { triangle, number: edge as u8 + 3 };
                for part in once(own).chain(self.others(own)) {
                    let number = usize::from(part.number) - 3;
                    is_seen[3 * part.triangle as usize + number] = true;
                    let opposite = place(part.triangle, number + 2);
                    if !ends.contains(&opposite) {
                        is_open &= third == NONE || third == opposite;
                        third = opposite;
                    }
                }
                if is_open {
                    open.push(OpenEdge { triangle, ends });
                }
            }
        }
        open
    }

    /// Each part in a ring of its own.
    fn of_one(triangles: u32) -> Self {
        let alone = |triangle| Next { triangles: [triangle; PARTS], numbers: [0, 1, 2, 3, 4, 5] };
        Self((0..triangles).map(alone).collect())
    }

    #[inline(always)]
    fn next(&self, SharedPart { triangle, number }: SharedPart) -> SharedPart {
        let next = &self.0[triangle as usize];
        SharedPart {
            triangle: next.triangles[usize::from(number)],
            number: next.numbers[usize::from(number)],
        }
    }

    /// The other parts of a ring.
    #[inline(always)]
    fn others(&self, own: SharedPart) -> impl Iterator<Item = SharedPart> {
        let others = successors(Some(self.next(own)), |part| Some(self.next(*part)));
        others.take_while(move |part| *part != own)
    }

    /// Joins the rings of two parts; the rings must differ.
    fn join(&mut self, one: SharedPart, other: SharedPart) {
        let (after_one, after_other) = (self.next(one), self.next(other));
        self.set_next(one, after_other);
        self.set_next(other, after_one);
    }

    fn set_next(&mut self, SharedPart { triangle, number }: SharedPart, to: SharedPart) {
        let next = &mut self.0[triangle as usize];
        next.triangles[usize::from(number)] = to.triangle;
        next.numbers[usize::from(number)] = to.number;
    }
}

/// The ends of a triangle's part.
#[inline(always)]
pub(crate) fn ends_of<T: Copy>([a, b, c]: [T; 3], part: usize) -> [T; 2] {
    match part {
        0 => [a, a],
        1 => [b, b],
        2 => [c, c],
        3 => [a, b],
        4 => [b, c],
        _ => [c, a],
    }
}

/// For each vertex the first vertex at the same place.
fn first_at_same_place(vertices: &[Vector]) -> Vec<u32> {
    // Open addressing with linear probing. The table is at most half full.
    let mut firsts = vec![NONE; (2 * vertices.len()).next_power_of_two()];
    let last = firsts.len() - 1;
    let find = |(vertex, &point): (u32, &Vector)| {
        let place = place(point);
        let mut at = hash(place) as usize & last;
        loop {
            let first = &mut firsts[at];
            if *first == NONE {
                *first = vertex;
            }
            if *first == vertex || self::place(vertices[*first as usize]) == place {
                return *first;
            }
            at = (at + 1) & last;
        }
    };
    (0..).zip(vertices).map(find).collect()
}

/// A place as bits; 0 and -0 are the same.
fn place(point: Vector) -> [u64; 3] {
    (point + Vector::ZERO).to_array().map(Real::to_bits)
}

/// A simple mix suffices: places are not chosen to collide.
fn hash(place: [u64; 3]) -> u64 {
    let mix = |hash: u64, bits: u64| {
        let mixed = (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        mixed ^ (mixed >> 32)
    };
    place.into_iter().fold(0, mix)
}

#[cfg(test)]
mod tests {
    use super::super::engine_mesh::Mesh;
    use super::*;
    use continuum_testing::Random;

    /// A few triangles between a few points, some of them at the same place. Some edges have three
    /// or more triangles, and some triangles have a corner twice.
    fn soup(random: &mut Random) -> (Vec<Vector>, Vec<[u32; 3]>) {
        let places: Vec<_> = (0..6).map(|_| (random.point() * 2.0).round()).collect();
        let vertices = (0..12)
            .map(|_| places[random.below(6) as usize] * [1.0, -1.0][random.below(2) as usize]);
        let vertices = vertices.collect();
        (vertices, (0..14).map(|_| [0; 3].map(|_| random.below(12))).collect())
    }

    #[test]
    fn rings_hold_all_that_have_a_part() {
        let (mut shared, mut several, mut twice) = (0, 0, 0);
        for seed in 0..500 {
            let (vertices, indices) = soup(&mut Random::new(seed));
            let parts = SharedParts::new(&vertices, &indices);
            let ends = |triangle: u32, part: usize| {
                let [from, to] = ends_of(
                    indices[triangle as usize].map(|vertex| vertices[vertex as usize]),
                    part,
                );
                // An edge is the same in both directions; an edge without length is not a corner.
                (part < 3, [from, to])
            };
            let is_same = |one: (bool, [Vector; 2]),
                           (is_corner, [from, to]): (bool, [Vector; 2])| {
                one == (is_corner, [from, to]) || one == (is_corner, [to, from])
            };
            for triangle in 0..indices.len() as u32 {
                for part in 0..PARTS {
                    let mut found: Vec<_> = parts.others(triangle, part).collect();
                    found.sort_unstable();
                    let of_all = (0..indices.len() as u32)
                        .flat_map(|other| (0..PARTS).map(move |part| (other, part)));
                    let same = of_all.filter(|&(other, part_there)| {
                        (other, part_there) != (triangle, part)
                            && is_same(ends(other, part_there), ends(triangle, part))
                    });
                    let expected: Vec<_> = same.map(|(other, _)| other).collect();
                    assert_eq!(found, expected, "{seed}: part {part} of {triangle}");
                    shared += usize::from(!found.is_empty());
                    several += usize::from(part > 2 && found.len() > 1);
                    twice += usize::from(found.contains(&triangle));
                }
            }
        }
        assert!(shared > 10_000 && several > 1000 && twice > 1000, "{shared} {several} {twice}");
    }

    /// After vertices coincide or separate, the shared parts follow from the new places.
    #[test]
    fn moved_vertices_meet_and_part() {
        let (mut stayed, mut changed) = (0, 0);
        for seed in 0..300 {
            let random = &mut Random::new(seed);
            let (vertices, indices) = soup(random);
            let mut mesh = Mesh::of(vertices.clone(), indices.clone());
            mesh.parts();
            // The parts are not built after every motion.
            for turn in 0..3 {
                let moved = match random.below(3) {
                    0 => vertices.iter().map(|vertex| *vertex * 1.5 + Vector::X).collect(),
                    1 => vertices.clone(),
                    _ => soup(random).0,
                };
                mesh.set_vertices(&moved);
                if turn == 1 {
                    continue;
                }
                let new = SharedParts::new(&moved, &indices);
                for triangle in 0..indices.len() as u32 {
                    for part in 0..PARTS {
                        let others =
                            |parts: &SharedParts| parts.others(triangle, part).collect::<Vec<_>>();
                        assert_eq!(
                            others(mesh.parts()),
                            others(&new),
                            "{seed}: part {part} of {triangle}"
                        );
                    }
                }
                let is_as_before = new.corners == SharedParts::new(&vertices, &indices).corners;
                *if is_as_before { &mut stayed } else { &mut changed } += 1;
            }
        }
        assert!(stayed > 100 && changed > 100, "{stayed} {changed}");
    }
}
