//! What a robot that kept away is known to keep when it has moved a little, without a search.
//!
//! Once every link kept more than `apart` from the mesh. Each point of a link now is near a point of the link then: no
//! point of an axis moves farther than the farther of its ends; the ball around it moves along; and where a flat cap makes
//! it a disc, that turns with the axis, by at most r |a' - a| at its rim, which is at most 2 r |d' - d| / (|d'| + |d|) for
//! the ways d and d' from start to end (Dunkl and Williams, 1964). A radius that has grown adds its growth. So each link
//! keeps more than `apart` less the sum of these.
//!
//! A search for a little more than the margin costs little more, and then speaks for the next queries too. How much more
//! follows from how far the robot moves from one query to the next. Where something is in between, queries search for the
//! margin alone, and a search that is less wide is tried later, ever more rarely.

use crate::proximity::placed::PlacedRobot;
use crate::robot::{LinkNode, length};
use parry3d_f64::math::{Real, Vector};

/// How many queries a wider search is to speak for at the most.
const QUERIES: Real = 8.0;
/// A search that failed is tried again after so many queries at the latest.
const LONGEST_REST: u32 = 63;
/// What rounding can do to two distances and to what is between them, for coordinates of size one: 16 u of the extent, which
/// is at most two, for each distance, and 8 u for the ends of each link and their differences.
const ROUNDING: Real = 128.0 * f64::EPSILON;

/// The robot that kept away, and how far.
#[derive(Clone)]
pub(super) struct LastClear {
    /// Its links in the mesh's frame; none where nothing is known.
    links: Vec<Outline>,
    apart: Real,
    /// The largest coordinate of the links.
    extent: Real,
    /// The first and the last link of the last query.
    before: Option<[Outline; 2]>,
    /// How many queries the next wider search is to speak for.
    queries: Real,
    /// How many queries are not to try one, and how many it was after the last that failed.
    rest: u32,
    last_rest: u32,
}

impl Default for LastClear {
    fn default() -> Self {
        Self {
            links: Vec::new(),
            apart: 0.0,
            extent: 0.0,
            before: None,
            queries: QUERIES,
            rest: 0,
            last_rest: 0,
        }
    }
}

#[derive(Clone, Copy)]
struct Outline {
    ends: [Vector; 2],
    radius: Real,
    flat: [bool; 2],
}

impl LastClear {
    pub(super) fn forget(&mut self) {
        let mut links = std::mem::take(&mut self.links);
        links.clear();
        *self = Self { links, ..Self::default() };
    }

    /// Whether every link certainly keeps more than `margin` away, by what is known. `reach` is the largest coordinate of
    /// the mesh.
    pub(super) fn still_keeps(&self, robot: PlacedRobot, margin: Real, reach: Real) -> bool {
        if self.links.is_empty() || self.links.len() != robot.links().len() {
            return false;
        }
        let known = self.apart - ROUNDING * (reach + 2.0 * self.extent);
        // The tip moves most, so it comes first.
        let mut pairs = self.links.iter().rev().zip(outlines(robot));
        // The links now reach no farther than those then and what they have moved.
        pairs
            .all(|(then, now)| then.flat == now.flat && known - (1.0 + ROUNDING) * moved(then, &now) > margin)
    }

    /// What to search for instead of `margin`, so that the answer speaks for the next queries too. None where the margin
    /// alone is better.
    pub(super) fn wider(&mut self, robot: PlacedRobot, margin: Real, reach: Real) -> Option<Real> {
        let ends = [0, robot.links().len() - 1].map(|link| outline(robot, link));
        let before = self.before.replace(ends)?;
        if self.rest > 0 {
            self.rest -= 1;
            return None;
        }
        let moved = moved(&before[0], &ends[0]).max(moved(&before[1], &ends[1]));
        let rounding = ROUNDING * (reach + 2.0 * extent(&ends[0]).max(extent(&ends[1])));
        let wider = margin + self.queries * moved + 4.0 * rounding;
        (wider < Real::INFINITY).then_some(wider)
    }

    /// Takes over that every link keeps more than `apart` away.
    pub(super) fn keep(&mut self, robot: PlacedRobot, apart: Real) {
        self.apart = apart;
        self.links.clear();
        self.links.extend(outlines(robot));
        self.links.reverse();
        self.extent = self.links.iter().map(extent).fold(0.0, Real::max);
        self.last_rest = 0;
    }

    /// Takes over that a wider search met something.
    pub(super) fn miss(&mut self) {
        self.links.clear();
        self.queries = (0.5 * self.queries).max(1.0);
        self.last_rest = (2 * self.last_rest + 1).min(LONGEST_REST);
        self.rest = self.last_rest;
    }
}

fn outline(robot: PlacedRobot, link: usize) -> Outline {
    let (ends, radius, flat) = robot.outline(&LinkNode::Leaf(link));
    Outline { ends, radius, flat }
}

/// All links from the tip to the base, each end placed once where two share it.
fn outlines(robot: PlacedRobot) -> impl Iterator<Item = Outline> {
    let mut shared: Option<(Vector, Vector)> = None;
    robot.links().iter().rev().map(move |link| {
        let end = match shared {
            Some((point, placed)) if point == link.end() => placed,
            _ => robot.placed(link.end()),
        };
        let start = robot.placed(link.start());
        shared = Some((link.start(), start));
        Outline { ends: [start, end], radius: link.radius(), flat: link.flat() }
    })
}

fn extent(link: &Outline) -> Real {
    link.ends[0].abs().max(link.ends[1].abs()).max_element() + link.radius
}

/// How far a point of the link can be from all points of the link before. Not a number where that can't be told.
fn moved(then: &Outline, now: &Outline) -> Real {
    let [start, end] = [now.ends[0] - then.ends[0], now.ends[1] - then.ends[1]];
    let grown = (now.radius - then.radius).max(0.0);
    let turned = if now.flat == [false; 2] {
        0.0
    } else {
        let [long, longer] = [then, now].map(|link| length(link.ends[1] - link.ends[0]));
        2.0 * now.radius * length(end - start) / (long + longer)
    };
    length(start).max(length(end)) + turned + grown
}
