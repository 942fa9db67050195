//! The balls around a robot's links, and the halves of their axes, each number in a row of its own:
//! a pack of them is compared at once, in single precision.
//!
//! A ball costs a tenth of a capsule to compare, and of two robots most links are far apart. So all
//! links of up to [`SWEPT`] of each robot are compared by their balls. With d the way between two
//! centres, h1 and h2 the halves of the axes, and any normal n, the axes lie behind planes on
//! either side, so that the links are at least (<d, n> - |<h1, n>| - |<h2, n>|) / |n| - r1 - r2 apart. What the balls leave is asked for that with the shortest way between the axes, as far
//! as single precision knows it: next to nothing is left that is farther, unless long thin links
//! nearly meet. What is left then is measured.
//!
//! **Rounding.** All coordinates are below 2, and u is 2^-24. A centre errs by 7 u and half of an
//! axis by 4 u, as vectors, and d by 21 u; the product of n with d (shorter than 7) by 21 u more of
//! |n|, those with h by 15 u each, the sums and squares that are compared by as much as 50 u of a
//! length, both radii by u. Of two balls the half lengths err by 8 u each, and the rest by less
//! than that. The limit errs by u of itself; where that is more than 8 u, the limit is farther than
//! anything. Together that is 140 u, and [`SLACK`] is 256 u. What doubles add to it, and by how
//! much the measured limit may err, is next to nothing. Of robots that are much farther apart than
//! 2^16 times their size this tells no links apart: [`heights`](super::heights) does.
//!
//! A normal may vanish, or its square leave the range of numbers. So one that is shorter than 2^-30
//! is counted as if it were as long as that, which asks for more than is needed. The limit is never
//! negative, so with the slack of 2^-16 no square that is compared with is below 2^-92.

use super::pair_frame::PairFrame;
use crate::distance::lanes::{Lane, Pack, set_bits};
use crate::distance::{Vec3, dispatch, segment_parameters};
use crate::pair::{PlacedEnds, PlacedRobot};
use crate::robot::LinkNode;
use fearless_simd::Level;
use parry3d_f64::math::Real;
use std::ops::Range;

/// How many links of either robot are compared at once: a bit for each.
pub(super) const SWEPT: usize = 64;

/// The widest pack.
const WIDEST: usize = 16;

/// How many numbers there are for each link.
const ROWS: usize = 8;

/// What rounding can hide of a distance.
const SLACK: f32 = 256.0 * f32::EPSILON / 2.0;

/// What the square of a normal counts for at least.
const MIN_NORMAL_SQUARED: f64 = 1.0 / (1_u64 << 60) as f64;

/// The links of a robot where they are placed, and the balls around them in the frame of the
/// search.
#[derive(Clone, Debug, Default)]
pub(super) struct Balls {
    links: Vec<Option<PlacedEnds>>,
    /// Centres, halves of axes, half lengths and radii, one row behind the other.
    rows: Vec<f32>,
    /// How long each is.
    length: usize,
}

/// The centre of a link, from it to the end, and the length of that; and its radius.
#[derive(Clone, Copy)]
struct Ball<L> {
    centre: Vec3<L>,
    half: Vec3<L>,
    half_length: L,
    radius: L,
}

impl Balls {
    /// Forgets the last robot's.
    pub fn start(&mut self, links: usize) {
        self.links.clear();
        self.links.resize(links, None);
        self.length = links + WIDEST;
        if self.rows.len() < ROWS * self.length {
            self.rows.resize(ROWS * self.length, 0.0);
        }
    }

    /// Places what has not been placed of some links.
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

    /// A link that has been placed.
    pub fn link(&self, link: usize) -> Option<&PlacedEnds> {
        self.links.get(link)?.as_ref()
    }

    /// The rows, each from a link on.
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
    /// What `take` makes of the rows.
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
    /// The ball around one link, in every lane.
    #[inline(always)]
    fn splat(token: L::Token, rows: &[&[f32]; ROWS]) -> Self {
        Self::of(
            rows,
            #[inline(always)]
            |row| L::splat(token, row[0]),
        )
    }

    /// Those around a pack of links.
    #[inline(always)]
    fn load(token: L::Token, rows: &[&[f32]; ROWS], lane: usize) -> Self {
        Self::of(
            rows,
            #[inline(always)]
            |row| L::load(token, &row[lane..]),
        )
    }

    /// Whether planes part the axes of two links by more than a distance, which includes [`SLACK`].
    /// The `way` is from this one's centre to the other's.
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

/// Up to [`SWEPT`] links of one robot and as many of another.
pub(super) struct Sweep<'a> {
    pub balls: [&'a Balls; 2],
    pub links: [Range<usize>; 2],
    /// Of each of the first robot's links here, from which of the second's on it is asked for, by
    /// their numbers in the robots.
    pub queried_from: &'a [usize],
}

impl Sweep<'_> {
    /// Which pairs may be no farther apart than a limit in the frame: of each link of the first
    /// robot a bit for each of the second's. Returns how many there are.
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

    /// The two links that are asked for whose centres are nearest.
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

    /// Two links, and those pairs of one of them and a neighbour of the other that are asked for:
    /// no more than a pack.
    pub fn beside(&self, [one, other]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
        let [first, second] = &self.links;
        let ones = one.saturating_sub(1).max(first.start)..(one + 2).min(first.end);
        let others = other.saturating_sub(1).max(second.start)..(other + 2).min(second.end);
        let with_one = others.map(move |other| [one, other]);
        let with_other = ones.filter(move |&link| link != one).map(move |one| [one, other]);
        let is_asked = |&[one, other]: &[usize; 2]| other >= self.queried_from[one - first.start];
        with_one.chain(with_other).filter(is_asked)
    }

    /// Where among the second robot's links those are that are asked for with one of the first's.
    #[inline(always)]
    fn lanes(&self, row: usize) -> Range<usize> {
        let second = &self.links[1];
        self.queried_from[row].saturating_sub(second.start)..second.len()
    }

    /// Which lanes of a pack stand for links.
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

    /// A robot of up to so many links: with links of one size, or on a lattice, where they are
    /// parallel, aligned, crossing and equal, or of all sizes, the smallest near the origin.
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

    /// Nothing that is measured to be within a limit is left out, the limit itself included, and
    /// nothing that is farther by much more than the slack is kept.
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
            // From any link on, as of a robot beside itself.
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
