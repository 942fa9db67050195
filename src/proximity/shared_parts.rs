//! The corners and edges of a mesh, each with one number for all triangles that have it at the same place.

use parry3d_f64::math::{Real, Vector};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hash, Hasher};

/// The numbers of a triangle's corners and then of its edges: those from the first corner to the second, from the second
/// to the third and from the third to the first.
pub(super) type Parts = [u32; 6];

/// The part of a triangle that holds its nearest point if some of its corners have no share in it, by the bits of these
/// corners: an edge or a corner, as a place in [`Parts`].
pub(super) const PART_WITHOUT: [Option<u8>; 8] =
    [None, Some(4), Some(5), Some(2), Some(3), Some(1), Some(0), None];

/// The parts of all triangles.
#[derive(Clone)]
pub(super) struct SharedParts {
    /// The number of each vertex.
    corners: Vec<u32>,
    of: Vec<Parts>,
    count: u32,
}

impl SharedParts {
    pub(super) fn new(vertices: &[Vector], indices: &[[u32; 3]]) -> Self {
        let (corners, count) = number_corners(vertices);
        let mut edges = Numbers { known: HashMap::default(), count };
        let of = indices.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| corners[vertex as usize]);
            let mut edge = |from: u32, to: u32| edges.of((from.min(to), from.max(to)));
            [a, b, c, edge(a, b), edge(b, c), edge(c, a)]
        });
        let of = of.collect();
        Self { corners, of, count: edges.count }
    }

    /// Whether they are the same with the vertices at these places.
    pub(super) fn stay(&self, vertices: &[Vector]) -> bool {
        number_corners(vertices).0 == self.corners
    }

    /// The parts of a triangle.
    #[inline(always)]
    pub(super) fn of(&self, triangle: u32) -> &Parts {
        &self.of[triangle as usize]
    }

    /// How many parts there are: no number is as large.
    pub(super) fn count(&self) -> usize {
        self.count as usize
    }
}

/// The ends of a triangle's part.
#[inline(always)]
pub(super) fn ends_of([a, b, c]: [Vector; 3], part: usize) -> [Vector; 2] {
    match part {
        0 => [a, a],
        1 => [b, b],
        2 => [c, c],
        3 => [a, b],
        4 => [b, c],
        _ => [c, a],
    }
}

/// A number for each vertex, the same for those at the same place, and how many there are.
fn number_corners(vertices: &[Vector]) -> (Vec<u32>, u32) {
    let mut places = Numbers { known: HashMap::default(), count: 0 };
    let corners = vertices.iter().map(|&corner| places.of(place(corner))).collect();
    (corners, places.count)
}

/// Numbers in the order in which they are asked for.
struct Numbers<K> {
    known: HashMap<K, u32, BuildHasherDefault<Mix>>,
    count: u32,
}

impl<K: Hash + Eq> Numbers<K> {
    fn of(&mut self, key: K) -> u32 {
        let next = self.count;
        let number = *self.known.entry(key).or_insert(next);
        self.count += u32::from(number == next);
        number
    }
}

/// A place; 0 and -0 are the same.
fn place(point: Vector) -> (u64, u64, u64) {
    let [x, y, z] = (point + Vector::ZERO).to_array().map(Real::to_bits);
    (x, y, z)
}

/// A quick hash for places and numbers: nobody chooses them to collide.
#[derive(Clone, Copy, Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(byte.into()));
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(number.into());
    }

    fn write_u64(&mut self, number: u64) {
        let mixed = (self.0 ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 32);
    }
}
