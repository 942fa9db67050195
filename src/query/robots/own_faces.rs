//! Branch and bound over the pairs of links of one robot that its faces may be near.
//!
//! # Definitions
//! - **Face**: the robot's base or tip, if it is flat, or the wider side of a step
//!   (`pair::JoinedLink`).
//! - **In the band**: a pair of links `i < j` that share no joint and turn by at least pi / 2.
//!   Unless all turns are queried, the turn is also less than pi: beyond, `Descent` finds the
//!   pair, and `JoinedLink::counts_beside` tests its faces. The faces of links in the band count by
//!   the rule of `JoinedLink::face_counts`.
//! - Two faces **look at one another** if the earlier one is the end of its link and the later one
//!   the start of its link. They are queried at any turn.
//! - **Node**: a run of links, the same as the node of the link tree with its number. It stores a
//!   ball around their axes, their largest radius, and a cone that contains the directions of its
//!   links and of one more on either side.
//!
//! # Pruning
//! A pair of nodes is skipped in four cases:
//! 1. Neither node has a face; or no pair is in the band and no two faces look at one another.
//! 2. The balls, each wider by its largest radius, are farther apart than the bound; or the
//!    capsules of the link tree are. A capsule is much narrower around links that lie in a row.
//! 3. The robot leads nearer everywhere. Let `w` be the segment from a face of one node to a place
//!    of the other, and `t` any direction of the latter's cone.
//!    - If all `w . t > 0`, the robot leads nearer backwards from every place, unless it stops
//!      there. So no link of the node may be the robot's first one, or have a thinner one before
//!      it.
//!    - If all `w . t < 0`, it leads nearer forwards in the same way.
//! 4. A pair was found at distance 0, and all links of the nodes are higher: no pair is better.
//!
//! **Claim.** If case 3 holds for the faces of either node beside the other, no pair of the two
//! nodes counts whose faces are queried.
//!
//! **Proof.** If the nearest place is inside a link, `w . t` is 0 there. At an end, rule 2 of
//! `JoinedLink` fails. □
//!
//! **All turns.** If all turns are queried, links with a turn of pi count without a face too. Their
//! pair is skipped if case 3 holds for either node: from its places the robot leads nearer, so
//! condition 2 of `JoinedLink` fails. Where axes run level, `w . t` is 0 within rounding, and case 3
//! does not hold.
//!
//! **Facing.** If all `w . t > 0`, the faces at ends of links face away; if all `w . t < 0`, the
//! faces at starts do.
//!
//! **Covered shoulders.** A shoulder that the segment reaches does not count if the adjoining link
//! contains its point (`least_covered`). The same holds for two faces that look at one another.
//!
//! **Flat faces that look at one another** are at least `w . t` apart: the later face lies in the
//! plane through its centre with the normal `t`. The same holds for the plane of the earlier face.
//! So they are skipped if the least `w . t` exceeds the bound, in either direction.
//!
//! # Bounds on `w . t`
//! Let `m` be the axis of the cone, `e` the largest distance of a direction from `m`, and `n` any
//! normal of the face. A point of a flat face is at most `f` from its centre and perpendicular to
//! `n`. So `w . t` is at least `v . t - f |t x n|`, where `v` leads between two places of the axes.
//! `|t x n|` is at most `|m x m'|` plus the two largest distances from the axes.
//!
//! **From the cone.** Let `least(x)` be the least `x . t` for all unit vectors `t` at most `e` from
//! `m`. Let `x . m > 0` and `e^2 <= 2`. The angles of `x` and of `t` from `m` add up to at most pi,
//! so `least(x) = (x . m) (1 - e^2 / 2) - |x cross m| e sqrt(1 - e^2 / 4)`, the cosine of a sum.
//! Always `least(x) >= x . m - |x| e`.
//!
//! **From balls.** Let `C` and `D` be the centres of the balls, and `a` and `b` their radii. Then
//! `v . t >= least(D - C) - a - b`.
//!
//! Upper bounds are the same with opposite signs.
//!
//! **Rounding.** Unit vectors err by 4 u, and sums of few lengths by few u of the reach: 64 u of
//! the largest coordinate covers all. Pairs that `JoinedLink` accepts as local minima within the
//! error of the segment are visited, too.

use super::descent::PairLimit;
use super::pair_frame::{NodeCapsule, PairFrame};
use super::turn_sums::TurnSums;
use crate::distance::Scalar;
use crate::pair::{PlacedRobot, Tolerance};
use crate::robot::{ModifiedCylinder, is_step};
use parry3d_f64::math::{Real, Vector};

/// A run of links.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    first: usize,
    count: usize,
    centre: Vector,
    /// The largest distance of a point of the axes from the centre.
    reach: Real,
    /// The start of the first link and the end of the last one.
    /// The largest radius.
    radius: Real,
    /// The largest radius of a flat face.
    flat: Real,
    direction: Vector,
    /// The largest distance of a direction from `direction`.
    spread: Real,
    /// Whether some link has a face at its start, and at its end.
    some: [bool; 2],
    /// Whether some link has a round face at its start, and at its end.
    round: [bool; 2],
    /// Whether the robot ends or is thinner before some link, and behind some link.
    stops: [bool; 2],
    /// The cosine from which the adjoining links contain the shoulder points at starts, and at ends
    /// (`least_covered`): the largest over all links.
    covered: [Real; 2],
    /// The least radius of those adjoining links.
    adjoining: Real,
}

/// The result of [`Node::seen_from`].
struct Seen {
    /// Whether places of the node may be local minima.
    may_be_local: bool,
    /// Bounds on `w . t`.
    along: [Real; 2],
    /// Whether the segment to all places of the node leads forwards, or backwards; `None` if
    /// unknown.
    forwards: Option<bool>,
    /// Whether the adjoining links contain all shoulder points that the segment reaches.
    is_covered: bool,
}

/// Adjoining links count as thinner by this share, which covers the error of the segment.
const THINNER: Real = 1.0 / 256.0;

/// With at most this many links with a face, each is compared with all other links: cheaper than
/// the nodes of some dozen links.
const FEW: usize = 4;

/// State of a search; a later search reuses the memory.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnFaces {
    with_faces: Vec<usize>,
    /// The nodes in preorder, the first half's before the second's.
    nodes: Vec<Node>,
    /// The capsules of the link tree, in its frame.
    capsules: Vec<NodeCapsule>,
    frame: PairFrame,
    stack: Vec<[usize; 2]>,
    rounding: Real,
    #[cfg(test)]
    looked_at: usize,
    /// Visit every pair in the band and all faces that look at one another.
    #[cfg(test)]
    every_pair: bool,
}

/// Which pairs are visited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Band {
    /// Pairs with a face and a turn between pi / 2 and pi.
    Faces,
    /// All pairs with a turn of at least pi / 2.
    All,
}

impl OwnFaces {
    /// Prepares for a robot. Returns whether any pair may be queried.
    pub fn begin(&mut self, robot: &PlacedRobot, turns: &TurnSums, band: Band) -> bool {
        self.nodes.clear();
        #[cfg(test)]
        {
            self.looked_at = 0;
        }
        self.with_faces.clear();
        let count = robot.links().len();
        let (mut look, mut first_end) = (false, count);
        for link in 0..count {
            let [start, end] = faces(robot, link);
            if start || end {
                self.with_faces.push(link);
            }
            look |= start && link > first_end + 1;
            first_end = if end { first_end.min(link) } else { first_end };
        }
        let has_face = !self.with_faces.is_empty();
        has_face && look || (has_face || band == Band::All) && turns.quarter_from[0] < count
    }

    /// As [`run`](Self::run), for few faces: compares each link that has one with all other links.
    fn run_of_few(
        &self,
        robot: &PlacedRobot,
        turns: &TurnSums,
        mut limit: PairLimit,
        mut visit: impl FnMut([usize; 2], [bool; 2]) -> Option<PairLimit>,
    ) -> bool {
        let links = robot.links();
        let ball = |link: usize| {
            let (start, along) = (links[link].start(), links[link].end() - links[link].start());
            (start + along * 0.5, 0.5 * along.length() + links[link].radius())
        };
        for (number, &link) in self.with_faces.iter().enumerate() {
            let (centre, reach) = ball(link);
            let rounding = 64.0 * Real::UNIT_ROUNDOFF;
            for other in 0..links.len() {
                let pair = [link.min(other), link.max(other)];
                let [one, two] = pair;
                if two < one + 2 || self.with_faces[..number].contains(&other) {
                    continue;
                }
                let in_band = turns.quarter_from[one] <= two && two < turns.queried_from[one];
                let look = faces(robot, one)[1] && faces(robot, two)[0];
                if !in_band && !look {
                    continue;
                }
                let (there, extent) = ball(other);
                let largest = centre.abs().max(there.abs()).max_element() + reach + extent;
                let at_least = (there - centre).length() - reach - extent - rounding * largest;
                if limit.excludes(at_least, pair) {
                    continue;
                }
                match visit(pair, [in_band, look]) {
                    Some(next) => limit = next,
                    None => return false,
                }
            }
        }
        true
    }

    fn add(&mut self, robot: &PlacedRobot, turns: &TurnSums, first: usize, count: usize) {
        if count == 1 {
            self.nodes.push(Node::of_link(robot, turns, first));
            return;
        }
        let place = self.nodes.len();
        self.nodes.push(Node::default());
        self.add(robot, turns, first, count / 2);
        let second = self.nodes.len();
        self.add(robot, turns, first + count / 2, count - count / 2);
        let halves = [&self.nodes[place + 1], &self.nodes[second]];
        self.nodes[place] = Node::around(halves, turns);
    }

    /// Calls `visit` with pairs of links, the lower first, and two flags: whether the pair is in
    /// the band, and whether faces look at one another.
    ///
    /// Each call returns the next limit, beyond which pairs may be skipped, or `None` to stop.
    /// Returns false if it was stopped.
    pub fn run(
        &mut self,
        robot: &PlacedRobot,
        turns: &TurnSums,
        band: Band,
        mut limit: PairLimit,
        mut visit: impl FnMut([usize; 2], [bool; 2]) -> Option<PairLimit>,
    ) -> bool {
        #[cfg(test)]
        if self.every_pair {
            return run_of_all(robot, turns, band, visit);
        }
        if band == Band::Faces && self.with_faces.len() <= FEW {
            return self.run_of_few(robot, turns, limit, visit);
        }
        self.add(robot, turns, 0, robot.links().len());
        let root = &self.nodes[0];
        let largest = root.centre.abs().max_element() + root.reach + root.radius;
        self.rounding = 64.0 * Real::UNIT_ROUNDOFF * largest;
        self.frame = PairFrame::around([robot; 2]);
        let outline = |node: usize| self.frame.outline(robot, node);
        self.capsules.clear();
        self.capsules.extend((0..self.nodes.len()).map(outline));
        self.stack.clear();
        self.stack.push([0, 0]);
        while let Some(pair) = self.stack.pop() {
            let [one, two] = pair.map(|place| &self.nodes[place]);
            let kinds = self.asks(turns, band, limit, pair);
            #[cfg(test)]
            {
                self.looked_at += 1;
            }
            if kinds == [false; 2] {
                continue;
            }
            if one.count == 1 && two.count == 1 {
                match visit([one.first, two.first], kinds) {
                    Some(next) => limit = next,
                    None => return false,
                }
                continue;
            }
            if pair[0] == pair[1] {
                let [low, high] = self.halves(pair[0]);
                self.stack.extend([[low, low], [high, high], [low, high]]);
                continue;
            }
            let of_first = one.count > two.count || one.count == two.count && one.reach > two.reach;
            let halves = self.halves(pair[usize::from(!of_first)]);
            let pairs = halves.map(|half| if of_first { [half, pair[1]] } else { [pair[0], half] });
            let apart = pairs.map(|pair| {
                let [one, two] = pair.map(|place| &self.nodes[place]);
                (one.centre - two.centre).length() - one.reach - two.reach
            });
            self.stack.extend(if apart[0] <= apart[1] { [pairs[1], pairs[0]] } else { pairs });
        }
        true
    }

    fn halves(&self, place: usize) -> [usize; 2] {
        // A tree over n links has 2 n - 1 nodes.
        [place + 1, place + 2 * (self.nodes[place].count / 2)]
    }

    /// Whether pairs of two nodes that are in the band may count, and whether faces that look at
    /// one another may.
    fn asks(&self, turns: &TurnSums, band: Band, limit: PairLimit, pair: [usize; 2]) -> [bool; 2] {
        let [one, two] = pair.map(|place| &self.nodes[place]);
        let last = two.first + two.count - 1;
        // Case 4.
        if last < one.first + 2 || limit.excludes(Real::NEG_INFINITY, [one.first, two.first]) {
            return [false; 2];
        }
        let bound = limit.distance();
        // Case 1.
        let mut in_band = last >= turns.quarter_from[one.first];
        if band == Band::Faces {
            let has_face = one.has_face() || two.has_face();
            in_band &= has_face && two.first < turns.queried_from[one.first + one.count - 1];
        }
        let look = one.some[1] && two.some[0];
        if !in_band && !look {
            return [false; 2];
        }
        let way = two.centre - one.centre;
        let away = way.length();
        // Case 2.
        if away - one.reach - two.reach - one.radius - two.radius - self.rounding > bound {
            return [false; 2];
        }
        if one.first == two.first {
            return [in_band, look];
        }
        let [capsule, other] = pair.map(|place| &self.capsules[place]);
        // Capsules are hardly farther apart than the centres.
        if away > bound && self.frame.outside(capsule.at_least(other)) - self.rounding > bound {
            return [false; 2];
        }
        // Case 3.
        let from_one = two.seen_from(one, way, away, self.rounding);
        let from_two = one.seen_from(two, -way, away, self.rounding);
        let at_face = one.may_see(&from_two) && from_one.may_be_local
            || two.may_see(&from_one) && from_two.may_be_local;
        let has_half_turn = last >= turns.queried_from[one.first];
        let beside =
            band == Band::All && has_half_turn && from_one.may_be_local && from_two.may_be_local;
        in_band &= at_face || beside;
        let is_covered = from_one.forwards == Some(true) && from_one.is_covered
            || from_two.forwards == Some(false) && from_two.is_covered;
        let are_flat = !one.round[1] && !two.round[0];
        let is_ahead = are_flat && from_one.along[0].max(-from_two.along[1]) > bound;
        [in_band, look && !is_covered && !is_ahead]
    }
}

impl Node {
    fn of_link(robot: &PlacedRobot, turns: &TurnSums, link: usize) -> Self {
        let links = robot.links();
        let (placed, direction) = (&links[link], turns.directions[link]);
        let [start, end] = [placed.start(), placed.end()];
        let beside = [link.checked_sub(1), Some(link + 1).filter(|&next| next < links.len())];
        let is_wider = |neighbour: Option<usize>| {
            neighbour.is_some_and(|neighbour| is_step(links[neighbour].radius(), placed.radius()))
        };
        let some = faces(robot, link);
        let flat = placed.flat();
        let round = [0, 1].map(|end: usize| some[end] && !flat[end]);
        let has_flat = (0..2).any(|end| some[end] && flat[end]);
        let (mut covered, mut adjoining) = ([Real::NEG_INFINITY; 2], Real::INFINITY);
        for end in [0, 1] {
            covered[end] = match beside[end] {
                Some(next) if is_wider(Some(next)) && !flat[end] => {
                    adjoining = adjoining.min(links[next].radius());
                    least_covered(placed.radius(), &links[next], end)
                }
                Some(next) if !is_wider(Some(next)) => Real::NEG_INFINITY,
                _ => Real::INFINITY,
            };
        }
        Self {
            first: link,
            count: 1,
            centre: start + (end - start) * 0.5,
            reach: 0.5 * (end - start).length(),
            radius: placed.radius(),
            flat: if has_flat { placed.radius() } else { 0.0 },
            direction,
            spread: spread(turns, link, 1, direction),
            some,
            round,
            stops: beside.map(|neighbour| neighbour.is_none() || is_wider(neighbour)),
            covered,
            adjoining,
        }
    }

    /// Returns the node of two halves.
    fn around([one, two]: [&Self; 2], turns: &TurnSums) -> Self {
        let upwards = 1.0 + 16.0 * Real::UNIT_ROUNDOFF;
        let way = two.centre - one.centre;
        let away = way.length();
        // The ball around both balls.
        let (centre, reach) = if away + two.reach <= one.reach {
            (one.centre, one.reach)
        } else if away + one.reach <= two.reach {
            (two.centre, two.reach)
        } else {
            let reach = 0.5 * (away + one.reach + two.reach);
            (one.centre + way * ((reach - one.reach) / away), reach)
        };
        let direction = (one.direction + two.direction).normalize_or_zero();
        let either =
            |of: fn(&Self) -> [bool; 2]| [0, 1].map(|end: usize| of(one)[end] || of(two)[end]);
        Self {
            first: one.first,
            count: one.count + two.count,
            centre,
            reach: reach * upwards,
            radius: one.radius.max(two.radius),
            flat: one.flat.max(two.flat),
            direction,
            spread: spread(turns, one.first, one.count + two.count, direction),
            some: either(|node| node.some),
            round: either(|node| node.round),
            stops: either(|node| node.stops),
            covered: [0, 1].map(|end: usize| one.covered[end].max(two.covered[end])),
            adjoining: one.adjoining.min(two.adjoining),
        }
    }

    fn has_face(&self) -> bool {
        self.some != [false; 2]
    }

    /// Whether some face of the node may look towards the node that was seen.
    fn may_see(&self, seen: &Seen) -> bool {
        match seen.forwards {
            Some(true) => self.some[0],
            Some(false) => self.some[1],
            None => self.has_face(),
        }
    }

    /// Returns how the node lies as seen from the faces of another. `way` leads from the other's
    /// centre to this one's.
    fn seen_from(&self, other: &Self, way: Vector, away: Real, rounding: Real) -> Seen {
        let sine = self.direction.cross(other.direction).length() + self.spread + other.spread;
        let aside = other.flat * sine.min(1.0);
        let far = away + self.reach + other.reach + other.radius;
        // `JoinedLink::tolerance`: the extent of two links is at most `3 far` and a radius.
        let extent = 3.0 * far + self.radius;
        let slack = Tolerance::new(rounding, extent).of_way(far);
        let doubt = rounding + slack;
        // From balls.
        let middle = Projection::of(way, self.direction);
        let least = [1.0, -1.0].map(|sign| middle.least_in_cone(sign, self.spread));
        let off = self.reach + other.reach + aside + doubt;
        let along = [least[0] - off, off - least[1]];
        let forwards = match along {
            [least, _] if least > 0.0 => true,
            [_, most] if most < 0.0 => false,
            _ => return Seen { may_be_local: true, along, forwards: None, is_covered: false },
        };
        let end = usize::from(!forwards);
        let is_known = slack <= THINNER * self.adjoining;
        let cosine = self.covered[end].max(0.0);
        let is_covered = is_known && cosine < 1.0 && least[end] - off >= cosine * far;
        Seen {
            may_be_local: self.stops[end] && !is_covered,
            along,
            forwards: Some(forwards),
            is_covered,
        }
    }
}

/// A vector as seen along a direction `m`.
#[derive(Clone, Copy)]
struct Projection {
    along: Real,
    across: Real,
    length: Real,
}

impl Projection {
    fn of(vector: Vector, direction: Vector) -> Self {
        Self {
            along: vector.dot(direction),
            across: vector.cross(direction).length(),
            length: vector.length(),
        }
    }

    /// Returns a lower bound on the component of `sign` times the vector along all directions at
    /// most `spread` from `m` (`least` of the module head).
    fn least_in_cone(&self, sign: Real, spread: Real) -> Real {
        let along = sign * self.along;
        let loose = along - self.length * spread;
        let squared = spread * spread;
        if along <= 0.0 || squared > 2.0 {
            return loose;
        }
        let sine = spread * (1.0 - 0.25 * squared).sqrt();
        loose.max(along * (1.0 - 0.5 * squared) - self.across * sine)
    }
}

/// Returns the least cosine at which the adjoining link contains the point of a round shoulder;
/// more than 1 if it never does. The cosine is taken between the adjoining axis and the outward
/// direction v at the shoulder. The link contains the points of larger cosines, too.
///
/// **Derivation.** Let r be the shoulder's radius, a the radius of the adjoining link, l its
/// length, and c the cosine. The distance of the point r v from the link's axis is r sqrt(1 - c^2),
/// which must be at most a. If r > l, the point may be beyond the axis. There its squared distance
/// from the axis's end is r^2 - 2 r l c + l^2, which must be at most a^2.
fn least_covered(radius: Real, next: &ModifiedCylinder, far_end: usize) -> Real {
    // In units of the shoulder's radius.
    let (thin, length) = ((1.0 - THINNER) * next.radius() / radius, next.length() / radius);
    let aside = (1.0 - thin * thin).max(0.0).sqrt();
    if length >= 1.0 {
        return aside;
    }
    if next.flat()[far_end] {
        return Real::INFINITY;
    }
    aside.max((1.0 + length * length - thin * thin) / (2.0 * length))
}

/// How far the directions of links, and of one more on either side, are from another at most. Over
/// all nodes these are n log n directions: the cones of two halves would add up.
fn spread(turns: &TurnSums, first: usize, count: usize, direction: Vector) -> Real {
    let last = (first + count + 1).min(turns.directions.len());
    let around = &turns.directions[first.saturating_sub(1)..last];
    let farthest =
        around.iter().fold(0.0, |most: Real, next| most.max((*next - direction).length()));
    farthest + 16.0 * Real::UNIT_ROUNDOFF
}

/// Whether a link has a face at its start, and at its end.
pub(super) fn faces(robot: &PlacedRobot, link: usize) -> [bool; 2] {
    let links = robot.links();
    let placed = &links[link];
    let neighbours = [link.checked_sub(1).map(|before| &links[before]), links.get(link + 1)];
    [0, 1].map(|end: usize| match neighbours[end] {
        Some(next) => is_step(next.radius(), placed.radius()),
        None => placed.flat()[end],
    })
}

/// As [`OwnFaces::run`], without pruning.
#[cfg(test)]
fn run_of_all(
    robot: &PlacedRobot,
    turns: &TurnSums,
    band: Band,
    mut visit: impl FnMut([usize; 2], [bool; 2]) -> Option<PairLimit>,
) -> bool {
    let count = robot.links().len();
    (0..count).flat_map(|one| (one + 2..count).map(move |two| [one, two])).all(|pair| {
        let [one, two] = pair.map(|link| faces(robot, link));
        let mut in_band = pair[1] >= turns.quarter_from[pair[0]];
        if band == Band::Faces {
            let has_face = one != [false; 2] || two != [false; 2];
            in_band &= has_face && pair[1] < turns.queried_from[pair[0]];
        }
        let look = one[1] && two[0];
        !(in_band || look) || visit(pair, [in_band, look]).is_some()
    })
}

#[cfg(test)]
mod tests {
    use crate::query::robots::SelfMemory;
    use crate::query::robots::robot_with_itself::RobotWithItself;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::math::{Real, Vector};

    /// Returns the direction of a link; `share` is the part of the robot behind it.
    type Shape = fn(share: Real, link: usize) -> Vector;

    const SHAPES: [(&str, Shape); 7] = [
        ("straight", |_, _| Vector::Z),
        ("arc", |share, _| {
            let (sin, cos) = (3.0 * share).sin_cos();
            Vector::new(sin, 0.0, cos)
        }),
        ("helix", |share, _| {
            let (sin, cos) = (40.0 * share).sin_cos();
            Vector::new(sin, 0.2, cos)
        }),
        ("zigzag", |_, link| {
            Vector::new(if link.is_multiple_of(2) { 0.2 } else { -0.2 }, 0.0, 1.0)
        }),
        ("sharp zigzag", |_, link| {
            Vector::new(if link.is_multiple_of(2) { 0.5 } else { -0.5 }, 0.0, 1.0)
        }),
        ("nearly closed ring", |share, _| {
            let (sin, cos) = (6.25 * share).sin_cos();
            Vector::new(sin, 0.0, cos)
        }),
        // It turns by many times pi, and leads nowhere back.
        ("long waves", |share, _| {
            let (sin, cos) = (1.2 * (60.0 * share).sin()).sin_cos();
            Vector::new(sin, 0.0, cos)
        }),
    ];

    fn work(
        shape: Shape,
        radius: impl Fn(Real, usize) -> Real,
        is_flat: bool,
        scale: Real,
        count: usize,
    ) -> (usize, bool) {
        let (mut at, mut points) = (Vector::ZERO, vec![Vector::ZERO]);
        for link in 0..count {
            at += shape(link as Real / count as Real, link).normalize() * (100.0 / count as Real);
            points.push(at);
        }
        let radii: Vec<_> =
            (0..count).map(|link| radius(link as Real / count as Real, link) * scale).collect();
        let robot = if is_flat {
            Chain::from_centreline(&points, &radii)
        } else {
            Chain::capsules(&points, &radii)
        };
        let robot = robot.expect("points that differ");
        let mut memory = SelfMemory::default();
        let found =
            RobotWithItself::new(&robot, &mut memory).expect("blunt joints").minimum(&mut memory);
        let looked_at = memory.faces().looked_at;
        // Without a bound, the shoulders of a corrugated robot are all looked at.
        let is_smooth = radii.windows(2).all(|pair| pair[1] <= pair[0]);
        if is_smooth {
            RobotWithItself::new(&robot, &mut memory)
                .expect("blunt joints")
                .clears(1e3, &mut memory);
        }
        (looked_at.max(memory.faces().looked_at), found.is_some())
    }

    /// With four times as many steps the number of visited node pairs grows as n log n, for every
    /// shape.
    #[test]
    fn the_work_grows_as_n_log_n() {
        for (name, shape) in SHAPES {
            for is_flat in [false, true] {
                for corrugated in [0.0, 0.3] {
                    let radius = |share: Real, link: usize| {
                        (1.0 - 0.3 * share)
                            * if link.is_multiple_of(2) { 1.0 } else { 1.0 - corrugated }
                    };
                    // Thin enough for the joints of the zigzags.
                    let [(few, _), (many, found)] = [250, 1000]
                        .map(|count| work(shape, radius, is_flat, 50.0 / count as Real, count));
                    println!("{name}, flat {is_flat}, {corrugated}: {few} {many} {found}");
                    // All pairs are half a million.
                    assert!(
                        many < 8 * few + 40_000,
                        "{name}, flat {is_flat}, {corrugated}: {few} {many}"
                    );
                }
            }
        }
    }

    /// In a nearly closed ring pairs of opposite links turn by pi and are no local minima. The
    /// search slides from one to the two tips, so it is bounded and need not look at all pairs.
    #[test]
    fn a_slide_bounds_the_search_of_a_ring() {
        let angles = (0..=1000).map(|k| 6.2 * Real::from(k) / 1000.0);
        let points: Vec<_> =
            angles.map(|a| Vector::new(100.0 * a.cos(), 100.0 * a.sin(), 0.0)).collect();
        let robot = Chain::capsules(&points, &[0.5; 1000]).unwrap();
        let mut memory = SelfMemory::default();
        let found = RobotWithItself::new(&robot, &mut memory).unwrap().minimum(&mut memory);
        assert!(found.is_some() && memory.faces().looked_at == 0, "{}", memory.faces().looked_at);
    }

    /// The same for links that are many times shorter than their radius: flat faces are far apart
    /// along the robot although the links around them overlap, and touching robots have one answer.
    #[test]
    fn the_work_grows_as_n_log_n_for_links_shorter_than_their_radius() {
        for (name, shape) in &SHAPES[..3] {
            for (is_flat, thinner) in [(true, 0.99), (true, 0.5), (false, 0.5)] {
                let radius =
                    |_: Real, link: usize| if link.is_multiple_of(2) { 1.0 } else { thinner };
                let [(few, _), (many, found)] =
                    [1000, 4000].map(|count| work(*shape, radius, is_flat, 0.4, count));
                println!("{name}, flat {is_flat}, {thinner}: {few} {many} {found}");
                // All pairs are 8 million.
                assert!(many < 6 * few + 20_000, "{name}, flat {is_flat}, {thinner}: {few} {many}");
            }
        }
    }

    /// Pruning changes no answer: random robots beside the same search over every pair.
    #[test]
    fn pruning_changes_no_answer() {
        let mut random = Random::new(17);
        let (mut apart, mut touching, mut free) = (0, 0, 0);
        for round in 0..3000 {
            let count = 6 + random.below(60) as usize;
            let bend = [0.0, 0.02, 0.2, 0.6][random.below(4) as usize];
            let alternate = [0.0, 0.1, 0.4][random.below(3) as usize];
            let axis = random.direction();
            let (mut way, mut at, mut points) = (Vector::Z, Vector::ZERO, vec![Vector::ZERO]);
            for link in 0..count {
                // Arcs and helices, zigzags, random walks.
                way = match round % 3 {
                    0 => (way + (axis.cross(way) + axis * 0.1) * bend).normalize_or(Vector::Z),
                    1 => (Vector::Z
                        + Vector::X * if link.is_multiple_of(2) { alternate } else { -alternate })
                    .normalize(),
                    _ => (way + random.point() * bend).normalize_or(Vector::Z),
                };
                at += way * random.between(0.9, 1.1);
                points.push(at);
            }
            let widest = [0.1, 0.5, 2.0, 8.0][random.below(4) as usize];
            let step = [1e-3, 0.01, 0.1, 0.5, 0.9][random.below(5) as usize];
            let kind = random.below(4);
            let radii: Vec<_> = (0..count)
                .map(|link| {
                    let share = link as Real / count as Real;
                    widest
                        * match kind {
                            0 => 1.0 - step * Real::from(u8::from(link.is_multiple_of(2))),
                            1 => 1.0 - step * share,
                            2 => 1.0 - step * random.unit(),
                            _ => 1.0 - step * Real::from(u8::from(share > 0.3 && share < 0.7)),
                        }
                })
                .collect();
            let robot = if random.below(2) == 0 {
                Chain::from_centreline(&points, &radii)
            } else {
                Chain::capsules(&points, &radii)
            };
            let Ok(robot) = robot else { continue };
            let mut memory = SelfMemory::default();
            let Ok(itself) = RobotWithItself::new(&robot, &mut memory) else { continue };
            let found = itself.minimum(&mut memory);
            let mut all = SelfMemory::default();
            all.faces_mut().every_pair = true;
            let Ok(itself) = RobotWithItself::new(&robot, &mut all) else { continue };
            let expected = itself.minimum(&mut all);
            assert_eq!(
                found.map(|found| (found.links, found.distance.to_bits())),
                expected.map(|found| (found.links, found.distance.to_bits())),
                "round {round}: {points:?} {radii:?}"
            );
            match found {
                Some(found) if found.distance > 0.0 => apart += 1,
                Some(_) => touching += 1,
                None => free += 1,
            }
            let distance = found.map_or(1.0, |found| found.distance);
            for margin in [0.0, 0.5 * distance, distance, 2.0 * distance] {
                let clears = found.is_none_or(|found| found.distance > margin);
                assert_eq!(itself.clears(margin, &mut memory), clears, "round {round}, {margin}");
            }
        }
        println!("{apart} {touching} {free}");
        assert!(apart > 500 && touching > 100 && free > 300, "{apart} {touching} {free}");
    }
}
