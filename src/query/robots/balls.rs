//! Balls around a robot's links and half axes, in structure-of-arrays form: compared in SIMD packs,
//! in single precision.
//!
//! # Definitions
//! - r1, r2: the radii of two links. h1, h2: the vectors from their centres to their ends (half
//!   axes).
//! - d: the vector between their centres. n: any normal.
//!
//! # Algorithm
//! Comparing a ball costs a tenth of comparing a capsule, and most links of two robots are far
//! apart.
//! 1. Compare the balls of all pairs of up to [`SWEPT`] links of each robot.
//! 2. For the remaining pairs, let n be the shortest segment between the axes, in single precision.
//!    The axes lie behind planes on either side. So the distance of the links is at least
//!    `(<d, n> - |<h1, n>| - |<h2, n>|) / |n| - r1 - r2`. Almost no pair beyond the limit remains,
//!    unless long thin links nearly meet.
//! 3. The caller measures the remaining pairs.
//!
//! # Rounding
//! All coordinates are below 2, and u is 2^-24.
//! - **Inputs.** As vectors, a centre errs by 7 u, a half axis by 4 u, and d by 21 u. Both radii
//!   err by u.
//! - **Step 2.** The product of n with d (|d| < 7) errs by 21 u |n| more, those with h by 15 u |n|
//!   each. The sums and squares that are compared err by up to 50 u of a length.
//! - **Step 1.** The half lengths of two balls err by 8 u each, the rest by less than step 2.
//! - **Limit.** It errs by u of itself. If that exceeds 8 u, the limit is larger than any distance.
//!
//! The sum is 140 u, and [`SLACK`] is 256 u. The roundings of double precision and of the measured
//! limit are negligible. For robots that are much farther apart than 2^16 times their size this
//! test separates no links, and all pairs are measured: of two robots of 30 links 10^7 sizes apart,
//! `minimum` takes 21 us instead of 4 us, which a test in double precision would take.
//!
//! **Small normals.** A normal may vanish, or its square leave the range of numbers. A normal
//! shorter than 2^-30 counts as that long, which is conservative. The limit is never negative. With
//! the slack of 2^-16, no square in the comparison is below 2^-92.

use super::pair_frame::PairFrame;
use crate::distance::lanes::{Lane, Pack, set_bits};
use crate::distance::{Vec3, dispatch, segment_parameters};
use crate::pair::{PlacedEnds, PlacedRobot};
use crate::robot::LinkNode;
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// How many links of each robot are compared at once: one bit per link.
pub(super) const SWEPT: usize = 64;

/// The number of lanes of the widest pack.
const WIDEST: usize = 16;

/// How many numbers are stored per link.
const ROWS: usize = 8;

/// The bound on the rounding error of a distance in the frame.
const SLACK: f32 = 256.0 * f32::EPSILON / 2.0;

/// The least value used for the square of a normal.
const MIN_NORMAL_SQUARED: f64 = 1.0 / (1_u64 << 60) as f64;

/// The placed links of a robot, and the balls around them in the frame of the search.
#[derive(Clone, Debug, Default)]
pub(super) struct Balls {
    links: Vec<Option<PlacedEnds>>,
    /// Centres, half axes, half lengths and radii: one row after another.
    rows: Vec<f32>,
    /// The length of a row.
    length: usize,
}

/// The centre, half axis, half length and radius of a link.
#[derive(Clone, Copy)]
struct Ball<L> {
    centre: Vec3<L>,
    half: Vec3<L>,
    half_length: L,
    radius: L,
}

impl Balls {
    /// Forgets the links of the last robot.
    pub fn start(&mut self, links: usize) {
        self.links.clear();
        self.links.resize(links, None);
        self.length = links + WIDEST;
        if self.rows.len() < ROWS * self.length {
            self.rows.resize(ROWS * self.length, 0.0);
        }
    }

    /// Places the links of a range that are not placed yet.
    pub fn place(&mut self, robot: &PlacedRobot, frame: &PairFrame, links: Range<usize>) {
        for link in links {
            if self.links[link].is_some() {
                continue;
            }
            let placed = robot.outline(&LinkNode::Leaf(link));
            let ([start, end], radius, _) = placed;
            let (start, end) = (frame.point(start), frame.point(end));
            let (centre, half) = ((start + end) * 0.5, (end - start) * 0.5);
            let sizes = [half.length(), frame.length(radius)];
            let numbers =
                [centre.x, centre.y, centre.z, half.x, half.y, half.z, sizes[0], sizes[1]];
            for (row, number) in numbers.into_iter().enumerate() {
                self.rows[row * self.length + link] = number as f32;
            }
            self.links[link] = Some(placed);
        }
    }

    /// Returns a link, if it is placed.
    pub fn link(&self, link: usize) -> Option<&PlacedEnds> {
        self.links.get(link)?.as_ref()
    }

    /// Returns the rows, each from `link` on.
    #[inline(always)]
    fn from(&self, link: usize) -> [&[f32]; ROWS] {
        let mut rows = [&self.rows[..]; ROWS];
        for (row, numbers) in rows.iter_mut().enumerate() {
            *numbers = &self.rows[row * self.length + link..][..self.length - link];
        }
        rows
    }
}

impl<L> Ball<L> {
    /// Builds a ball; `take` loads a number from a row.
    #[inline(always)]
    fn of(rows: &[&[f32]; ROWS], take: impl Fn(&[f32]) -> L) -> Self {
        let [x, y, z, u, v, w, half_length, radius] = rows;
        Self {
            centre: Vec3::new(take(x), take(y), take(z)),
            half: Vec3::new(take(u), take(v), take(w)),
            half_length: take(half_length),
            radius: take(radius),
        }
    }
}

impl<L: Pack<Element = f32>> Ball<L> {
    /// Loads one link into every lane.
    #[inline(always)]
    fn splat(token: L::Token, rows: &[&[f32]; ROWS]) -> Self {
        Self::of(
            rows,
            #[inline(always)]
            |row| L::splat(token, row[0]),
        )
    }

    /// Loads one link per lane.
    #[inline(always)]
    fn load(token: L::Token, rows: &[&[f32]; ROWS], lane: usize) -> Self {
        Self::of(
            rows,
            #[inline(always)]
            |row| L::load(token, &row[lane..]),
        )
    }

    /// Whether planes separate the axes of two links by more than `distance`, which includes
    /// [`SLACK`]. `way` leads from this centre to the other's.
    #[inline(always)]
    fn is_beyond(&self, other: &Self, way: Vec3<L>, distance: L) -> L::Mask {
        let [along, along_other] = [self.half, other.half].map(|half| half + half);
        let between_starts = other.half - self.half - way;
        let normal = segment_parameters(between_starts, along, along_other).gap;
        let ahead =
            normal.dot(way).abs() - normal.dot(self.half).abs() - normal.dot(other.half).abs();
        let squared = normal.norm_squared().max(ahead.lit(MIN_NORMAL_SQUARED));
        ahead.zero().lt(ahead) & (distance * distance * squared).lt(ahead * ahead)
    }
}

/// The comparison of up to [`SWEPT`] links of one robot with as many of another.
pub(super) struct Sweep<'a> {
    pub balls: [&'a Balls; 2],
    pub links: [Range<usize>; 2],
    /// For each of the first robot's links, the first of the second's that is queried with it (link
    /// numbers of the robots).
    pub queried_from: &'a [usize],
}

impl Sweep<'_> {
    /// Sets a bit in `near` for each pair that may be within `limit` (in the frame): one row per
    /// link of the first robot. Returns the number of bits.
    #[inline(never)] // compiled for each instruction set, not for each use as well
    pub fn near(&self, level: Level, limit: Real, near: &mut [u64; SWEPT]) -> u32 {
        dispatch!(level, simd => self.fill::<<f32 as Lane>::Pack<_>>(simd, limit as f32, near))
    }

    #[inline(always)]
    fn fill<L: Pack<Element = f32>>(
        &self,
        token: L::Token,
        limit: f32,
        near: &mut [u64; SWEPT],
    ) -> u32 {
        let limit = L::splat(token, limit + SLACK);
        let rows = self.balls[1].from(self.links[1].start);
        let mut count = 0;
        for (row, link) in self.links[0].clone().enumerate() {
            let one = Ball::<L>::splat(token, &self.balls[0].from(link));
            let mut near_one = 0;
            for lane in self.lanes(row).step_by(L::LANES) {
                let other = Ball::load(token, &rows, lane);
                let way = other.centre - one.centre;
                let squared = way.norm_squared();
                let apart = limit + one.radius + other.radius;
                let reach = apart + one.half_length + other.half_length;
                let mut bits =
                    L::bits(!(reach * reach).lt(squared)) & self.are_there(lane, L::LANES);
                if bits != 0 {
                    bits &= !L::bits(one.is_beyond(&other, way, apart));
                }
                near_one |= bits << lane;
            }
            near[row] = near_one;
            count += near_one.count_ones();
        }
        count
    }

    /// Returns the queried pair with the nearest centres.
    #[inline(never)] // compiled for each instruction set, not for each use as well
    pub fn nearest(&self, level: Level) -> Option<[usize; 2]> {
        dispatch!(level, simd => self.find::<<f32 as Lane>::Pack<_>>(simd))
    }

    #[inline(always)]
    fn find<L: Pack<Element = f32>>(&self, token: L::Token) -> Option<[usize; 2]> {
        let (mut least, mut found) = (f32::INFINITY, None);
        let mut distances = [0.0; WIDEST];
        let rows = self.balls[1].from(self.links[1].start);
        for (row, link) in self.links[0].clone().enumerate() {
            let one = Ball::<L>::splat(token, &self.balls[0].from(link));
            for first in self.lanes(row).step_by(L::LANES) {
                let squared = (Ball::load(token, &rows, first).centre - one.centre).norm_squared();
                let are_nearer = squared.lt(L::splat(token, least));
                let nearer = L::bits(are_nearer) & self.are_there(first, L::LANES);
                if nearer == 0 {
                    continue;
                }
                squared.store(&mut distances);
                for lane in set_bits(nearer) {
                    if distances[lane] < least {
                        least = distances[lane];
                        found = Some([link, self.links[1].start + first + lane]);
                    }
                }
            }
        }
        found
    }

    /// Returns a pair and the queried pairs of one of its links with a neighbour of the other: at
    /// most one pack.
    pub fn beside(&self, [one, other]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
        let [first, second] = &self.links;
        let ones = one.saturating_sub(1).max(first.start)..(one + 2).min(first.end);
        let others = other.saturating_sub(1).max(second.start)..(other + 2).min(second.end);
        let with_one = others.map(move |other| [one, other]);
        let with_other = ones.filter(move |&link| link != one).map(move |one| [one, other]);
        let is_asked = |&[one, other]: &[usize; 2]| other >= self.queried_from[one - first.start];
        with_one.chain(with_other).filter(is_asked)
    }

    /// Returns the range of the second robot's links queried with one of the first's.
    #[inline(always)]
    fn lanes(&self, row: usize) -> Range<usize> {
        let second = &self.links[1];
        self.queried_from[row].saturating_sub(second.start)..second.len()
    }

    /// Returns the lanes of a pack that hold links.
    #[inline(always)]
    fn are_there(&self, lane: usize, lanes: usize) -> u64 {
        u64::MAX >> (64 - (self.links[1].len() - lane).min(lanes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distance::lanes::tests::levels;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::math::{Pose, Vector};

    /// Returns a robot of up to `links` links: of one size; on a lattice, where links are parallel,
    /// aligned, crossing and equal; or of all sizes, the smallest near the origin.
    fn robot(random: &mut Random, links: u32, size: f64) -> Option<Chain> {
        let kind = random.below(3);
        let mut at = if kind == 2 { Vector::ZERO } else { random.point() * 2.0 };
        let mut points = vec![at * size];
        for _ in 0..1 + random.below(links) {
            let step = random.point()
                * if kind == 2 { (4.0 * at.length()).max(2.0_f64.powi(-100)) } else { 1.0 };
            at = if kind == 1 { ((at + step) * 2.0).round() * 0.5 } else { at + step };
            points.push(at * size);
        }
        let radius = size * [0.0, 0.02, 0.5][random.below(3) as usize];
        let radii = vec![radius; points.len() - 1];
        match random.below(2) {
            0 => Chain::capsules(&points, &radii).ok(),
            _ => Chain::cylinders(&points, &radii).ok(),
        }
    }

    /// Pairs measured within a limit are never skipped, the limit included. Pairs farther by much
    /// more than the slack are not kept.
    #[test]
    fn what_is_near_is_never_left_out() {
        let mut random = Random::new(8);
        let (mut kept, mut left_out) = (0_u64, 0_u64);
        for round in 0..400 {
            let size = 2.0_f64.powi(round % 41 - 20);
            let made = [robot(&mut random, 60, size), robot(&mut random, 60, size)];
            let [Some(a), Some(b)] = made else { continue };
            let first = if random.below(2) == 0 { Pose::IDENTITY } else { random.pose(size) };
            let second = random.pose(size * [0.0, 2.0, 50.0][round as usize % 3]);
            let poses = [first, if random.below(4) == 0 { first } else { second }];
            let [Ok(a), Ok(b)] = [PlacedRobot::new(&a, &poses[0]), PlacedRobot::new(&b, &poses[1])]
            else {
                panic!("both poses are rigid")
            };
            let frame = PairFrame::around([&a, &b]);
            let mut balls = [Balls::default(), Balls::default()];
            let counts = [a.links().len(), b.links().len()];
            for (balls, (robot, count)) in balls.iter_mut().zip([(&a, counts[0]), (&b, counts[1])])
            {
                balls.start(count);
                balls.place(robot, &frame, 0..count);
            }
            let distances: Vec<Vec<_>> = a
                .placed_links()
                .map(|one| b.placed_links().map(|two| one.measure_link(&two).distance).collect())
                .collect();
            let capsules = |one: usize, two: usize| {
                let (one, two) = (a.link(one), b.link(two));
                one.nearest_on_axes(&two).1 - one.radius() - two.radius()
            };
            // Queried from any link on, as for self contact.
            let queried_from: Vec<_> =
                (0..counts[0]).map(|link| if round % 2 == 0 { 0 } else { link }).collect();
            let links = [0..counts[0], 0..counts[1]];
            let sweep = Sweep { balls: [&balls[0], &balls[1]], links, queried_from: &queried_from };
            for _ in 0..4 {
                let some = random.below(counts[0] as u32) as usize;
                let limit = distances[some][random.below(counts[1] as u32) as usize];
                for level in levels() {
                    let mut near = [0; SWEPT];
                    let count = sweep.near(level, frame.length(limit), &mut near);
                    assert_eq!(
                        count,
                        near[..counts[0]].iter().map(|row| row.count_ones()).sum::<u32>()
                    );
                    assert!(
                        near.iter().all(|row| row >> counts[1] == 0),
                        "a bit for a link that is not there"
                    );
                    for (one, row) in distances.iter().enumerate() {
                        for (two, &distance) in row.iter().enumerate() {
                            let is_near = near[one] >> two & 1 == 1;
                            let is_asked = two >= queried_from[one];
                            assert!(!is_near || is_asked);
                            assert!(
                                is_near || !is_asked || distance > limit,
                                "{one} {two} in round {round}"
                            );
                            let beyond = frame.length(capsules(one, two) - limit);
                            assert!(
                                !is_near || beyond <= 128.0 * f64::from(SLACK),
                                "{one} {two} in round {round}"
                            );
                            kept += u64::from(is_near);
                            left_out += u64::from(is_asked && !is_near);
                        }
                    }
                    let all = (0..counts[0])
                        .flat_map(|one| (queried_from[one]..counts[1]).map(move |two| [one, two]));
                    let apart = |[one, two]: [usize; 2]| {
                        let centre = |balls: &Balls, link| {
                            balls.link(link).map(|(ends, ..)| (ends[0] + ends[1]) * 0.5)
                        };
                        let way = centre(&balls[0], one)
                            .zip(centre(&balls[1], two))
                            .map(|(one, two)| one - two);
                        way.map_or(0.0, Vector::length)
                    };
                    let least = all.map(apart).fold(f64::INFINITY, f64::min);
                    let found = sweep.nearest(level).map(apart);
                    let slack = f64::from(SLACK) / frame.length(1.0);
                    assert!(found.map_or(least == f64::INFINITY, |found| found <= least + slack));
                }
            }
        }
        assert!(kept > 100_000 && left_out > 100_000, "{kept} {left_out}");
    }
}
