//! The local minima of the distance between one link and a mesh.
//!
//! # What a local minimum is
//! Let d(x) be the distance of a point x from the link. Two triangles are joined at a corner or an edge that both have,
//! at the same place; the wall within a distance c is what of the mesh has d(x) <= c. As c grows, connected pieces of it
//! appear, grow and join. Where a piece appears there is a *local minimum*: the nearest point of the piece. A piece that
//! joins another before it has grown by more than rounding is none of its own: a flat wall along the link, whose
//! triangles are all as near as far as rounding can tell, is one piece, and so is a triangle's least point that lies on a
//! nearer neighbour. Of the two the one that is farther ends, so that the nearest point of each connected piece of wall
//! within the margin is always among the minima.
//!
//! Let t be the rounding of a distance, 64 u extent, far above what a measurement errs by. Then of the minima found
//!
//! 1. *none is missed*: from every point x of the wall a way on the wall leads to one of them, along which d never
//!    exceeds d(x) + t;
//! 2. *none is found twice*: a way from one to another exceeds the farther of the two by more than t;
//! 3. *each is one*: no point of a triangle that contains it is nearer, but for rounding.
//!
//! # Why it is enough to look at triangles, edges and corners
//! A link is convex, so d is a convex function, and what of a triangle has d <= c is convex: connected. Let T's least
//! distance be d(T), and that of a corner or an edge f be d(f). T is part of the wall within c from c = d(T) on, as one
//! piece. Two triangles that share f are joined by it exactly from c = d(f) on: their pieces then both contain f's
//! nearest point. So the pieces are the components of a graph with the triangles as nodes, which exist from d(T) on, and
//! an edge for each shared f, from d(f) >= max(d(T), d(T')) on.
//!
//! The triangles are taken nearest first. T starts a piece of its own. It meets a piece at each f that an earlier, nearer
//! triangle has. If d(f) is at most t above the farther of the two pieces' minima, that one ends there (the elder rule of
//! persistent homology). No pair is overlooked for being met too early: the minimum of a piece that could end is at least
//! d(f) - t >= d(T) - t, and all that is nearer than T has been seen. That is 2. For 1, follow the pieces: from x
//! straight to the least point of its triangle, and whenever a piece has ended, through its f to the one that it joined,
//! whose minimum is nearer. For 3, a triangle that contains the minimum of T shares there an f with d(f) <= d(T) + t, so
//! that one of the two pieces ended, T's if the other is nearer.
//!
//! Where T's least point lies on f, d(f) is d(T) and need not be computed; that spares nearly all of them.
//!
//! # Where link and wall overlap
//! There d = 0, and a piece is a connected piece of wall inside the link: it is one contact. Of its triangles the one
//! nearest to the axis comes first and stands for it, the lowest of equals.

use super::contact::Contact;
use super::measure_lanes::measure_each;
use super::mesh::Mesh;
use super::placed::{Nearest, PlacedLink, PlacedRobot};
use crate::ModifiedCylinder;
use crate::distance::Scalar;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

/// Memory that is used again.
#[derive(Clone, Default)]
pub(super) struct LocalMinima {
    /// The triangles within the margin.
    near: Vec<Ranked>,
    /// For each of them, nearest first, an earlier one of the same piece, or itself.
    piece: Vec<u32>,
    /// For each place of a corner its number, and the first triangle that has it.
    corners: HashMap<(u64, u64, u64), (u32, u32), BuildHasherDefault<Mix>>,
    /// For each edge, by the numbers of its corners, the first triangle that has it.
    edges: HashMap<(u32, u32), u32, BuildHasherDefault<Mix>>,
    /// The triangles that may be within the margin of one link.
    triangles: Vec<u32>,
}

/// A triangle within the margin.
#[derive(Clone, Copy)]
struct Ranked {
    /// The distance, or where it is 0 the axis distance less the radius.
    rank: Real,
    nearest: Nearest,
}

/// The contacts of a robot, link by link.
pub(super) struct RobotContacts<'a> {
    level: Level,
    mesh: &'a Mesh,
    robot: PlacedRobot<'a>,
    margin: Real,
    minima: &'a mut LocalMinima,
    out: &'a mut Vec<Contact>,
    /// The last link, and how long those before it are.
    last: usize,
    before: Real,
}

impl<'a> RobotContacts<'a> {
    /// `out` gets the contacts.
    pub(super) fn new(
        level: Level,
        mesh: &'a Mesh,
        robot: PlacedRobot<'a>,
        margin: Real,
        minima: &'a mut LocalMinima,
        out: &'a mut Vec<Contact>,
    ) -> Self {
        Self { level, mesh, robot, margin, minima, out, last: 0, before: 0.0 }
    }

    /// Adds the contacts of a link behind the last one, nearest first. `near` adds the triangles that may be within the
    /// margin; some may be farther away, and none may stand there twice. Returns how many they are.
    pub(super) fn add(&mut self, number: usize, near: impl FnOnce(&PlacedLink, &mut Vec<u32>)) -> u64 {
        let between = &self.robot.links()[self.last..number];
        self.before += between.iter().map(ModifiedCylinder::length).sum::<Real>();
        self.last = number;
        let link = self.robot.link(number);
        let mut triangles = std::mem::take(&mut self.minima.triangles);
        triangles.clear();
        near(&link, &mut triangles);
        let places = self.minima.find(self.level, &link, self.mesh, self.margin, &triangles);
        let (mesh, before) = (self.mesh, self.before);
        self.out.extend(places.map(|nearest| {
            Contact::new(number as u32, &link, mesh.corners(nearest.triangle), nearest, before)
        }));
        let count = triangles.len() as u64;
        self.minima.triangles = triangles;
        count
    }
}

impl LocalMinima {
    /// The local minima of a link, nearest first.
    fn find(
        &mut self,
        level: Level,
        link: &PlacedLink,
        mesh: &Mesh,
        margin: Real,
        triangles: &[u32],
    ) -> impl Iterator<Item = &Nearest> {
        self.near.clear();
        measure_each(level, link, mesh, triangles, |nearest| {
            if nearest.distance <= margin {
                let touches = nearest.distance <= 0.0;
                let rank = if touches {
                    link.axis_depth(mesh.corners(nearest.triangle)).min(0.0)
                } else {
                    nearest.distance
                };
                self.near.push(Ranked { rank, nearest });
            }
        });
        let order = |a: &Ranked, b: &Ranked| {
            a.rank.total_cmp(&b.rank).then(a.nearest.triangle.cmp(&b.nearest.triangle))
        };
        self.near.sort_unstable_by(order);
        self.piece.clear();
        self.corners.clear();
        self.edges.clear();
        for place in 0..self.near.len() {
            self.join(link, mesh, place as u32);
        }
        let places = self.near.iter().zip(&self.piece).enumerate();
        places.filter(|(place, (_, piece))| *place as u32 == **piece).map(|(_, (ranked, _))| &ranked.nearest)
    }

    /// Joins a triangle with the pieces that nearer ones have made.
    fn join(&mut self, link: &PlacedLink, mesh: &Mesh, place: u32) {
        let Ranked { nearest, .. } = self.near[place as usize];
        let corners = mesh.corners(nearest.triangle);
        self.piece.push(place);
        let tie = 64.0 * f64::UNIT_ROUNDOFF * link.extent_with(corners);
        // The corners and edges that nearer triangles have, each by its two ends, and whether it holds the least point.
        let (mut shared, mut count) = ([(corners[0], corners[0], 0, false); 6], 0);
        let mut share = |from: Vector, to: Vector, with: u32| {
            shared[count] = (from, to, with, is_on(nearest.on_mesh, from, to, tie));
            count += 1;
        };
        let mut numbers = [0; 3];
        for (number, corner) in numbers.iter_mut().zip(corners) {
            let known = self.corners.len() as u32;
            match self.corners.entry(key(corner)) {
                Entry::Vacant(entry) => {
                    entry.insert((known, place));
                    *number = known;
                }
                Entry::Occupied(entry) => {
                    *number = entry.get().0;
                    share(corner, corner, entry.get().1);
                }
            }
        }
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let ends = (numbers[from].min(numbers[to]), numbers[from].max(numbers[to]));
            match self.edges.entry(ends) {
                Entry::Vacant(entry) => {
                    entry.insert(place);
                }
                Entry::Occupied(entry) => share(corners[from], corners[to], *entry.get()),
            }
        }
        // Those that hold its least point come first: they are met at its own distance.
        for met_there in [true, false] {
            for &(from, to, with, holds_least_point) in &shared[..count] {
                if holds_least_point != met_there {
                    continue;
                }
                let (mine, other) = (self.first_of(place), self.first_of(with));
                let farther = self.distance(mine).max(self.distance(other)) + tie;
                if mine != other
                    && nearest.distance <= farther
                    && (met_there || link.comes_within(farther, from, to))
                {
                    // The piece appeared where the nearer one did.
                    self.piece[mine.max(other) as usize] = mine.min(other);
                }
            }
        }
    }

    fn distance(&self, place: u32) -> Real {
        self.near[place as usize].nearest.distance
    }

    /// The triangle at which a piece appeared.
    fn first_of(&mut self, mut place: u32) -> u32 {
        while self.piece[place as usize] != place {
            let next = self.piece[place as usize];
            self.piece[place as usize] = self.piece[next as usize];
            place = next;
        }
        place
    }
}

/// The contacts of a robot, for an engine without a search of its own for them.
#[cfg(feature = "gpu")]
pub(crate) fn contacts_by_all_triangles(
    mesh: &Mesh,
    robot: PlacedRobot,
    margin: Real,
    out: &mut Vec<Contact>,
) {
    let mut minima = LocalMinima::default();
    let mut contacts = RobotContacts::new(Level::new(), mesh, robot, margin, &mut minima, out);
    for number in 0..robot.links().len() {
        contacts.add(number, |link, near| {
            let may_meet = |triangle: &u32| link.at_least(mesh.corners(*triangle)) <= margin;
            near.extend((0..mesh.len() as u32).filter(may_meet));
        });
    }
}

/// Whether a point lies on the segment between two, but for `tie`.
fn is_on(point: Vector, from: Vector, to: Vector, tie: Real) -> bool {
    let (edge, relative) = (to - from, point - from);
    let share = relative.dot(edge) / edge.length_squared();
    // 0 / 0 where the segment is a point: the comparison turns it into 0.
    let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
    (relative - edge * share).abs().max_element() <= tie
}

/// A place; 0 and -0 are the same.
fn key(point: Vector) -> (u64, u64, u64) {
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
