//! Two links of one robot that share no joint: whether the place where they are nearest is a local
//! minimum of the distance.
//!
//! # Definitions
//! - An end of a link is **level** with the next link if their radii are equal up to rounding
//!   ([`is_step`]), and otherwise the next link is **thinner** or **wider**.
//! - A **shoulder** is an end beyond which the robot is thinner. A **face** is a shoulder, or a
//!   flat end of the robot.
//! - The **adjoining** link is the one beyond an end.
//! - `p` is the point of a face that is nearest to the other link, `q` that link's point, `y` its
//!   place on the axis, and `w` the way from `p` to `q`. Where the links overlap `q` is `y`, so
//!   that `w` has a direction there too.
//!
//! # The rule
//! A face counts beside a link if all of these hold.
//!
//! 1. `w` leaves the face outwards: `w . n >= 0` with the outward normal `n`. Otherwise the link's
//!    barrel behind the face is nearer.
//! 2. The robot leads nowhere nearer from `y`. If `y` is at an end and the next link is no thinner,
//!    its direction `t` away from `y` must not descend: `w . t >= 0`. A wider link that begins
//!    round is nearer at once, whatever its direction.
//! 3. `p` is not in the adjoining link, caps included. Otherwise the adjoining link is at least as
//!    near, and decides. If several points are equally near, all of them must be in it. The same
//!    holds at a shoulder at which the other link has `q`.
//!
//! If the other link's axis meets the face, `w` is 0. The face counts: there is no rule to say
//! which way is nearer.
//!
//! Two faces that look at one another count if 1 and 3 hold for both.
//!
//! # Why nothing is missed
//! **Claim.** A local minimum of the distance between two links, at a face of the one, satisfies
//! the rule.
//!
//! **Proof.** `p` is nearest among all points of its link, which is convex and behind the face:
//! that gives 1. If 2 fails, moving on along the robot comes nearer at once. If 3 fails, all
//! equally near points belong to the adjoining link as well, and the adjoining link is at least as
//! near. Its own pair with the other link is judged by the same rule. □
//!
//! # While the robot moves
//! Let all points of both links move by `points` at most, together, and their directions turn by
//! `turn`. The way `w` then errs as if the bodies were known to `points` alone, and more by `|w|
//! turn` along a direction. If `w . t` stays above that for the link's own axis, `y` is its start
//! at all times; if it does for the axis before as well, and the link before is no thinner, the
//! robot leads nearer backwards at all times. The same holds forwards with the other sign. The
//! point of a round shoulder moves by its centre's way and by `r` times what the direction of `w`
//! turns: if the adjoining link holds it deeper than that and its own way, it always does.
//!
//! **Rounding.** `w` errs by at most `slack` ([`Tolerance::of_way`]); `w . n` and `w . t` may be so
//! far below 0. `p` errs as much, so the adjoining link must hold it that far within its radius.
//! Ahead of its flat ends `p` errs by rounding alone, as both are discs of known planes: there it
//! may be so far outside. The way between links nearer than [`NEAR`] errors is measured to the
//! axis.

use super::placed_link::PlacedLink;
use super::two_links::NearestOfLinks;
use crate::distance::Scalar;
use crate::robot::is_step;
use parry3d_f64::math::{Real, Vector};

/// A link and the links beyond its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JoinedLink {
    pub link: PlacedLink,
    pub beyond: [Option<PlacedLink>; 2],
}

/// By how much distances may err.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tolerance(pub Real);

impl Tolerance {
    /// By how much the way between two convex bodies may err in any direction, if it is so long.
    ///
    /// The measured points belong to the two bodies and are at most e farther apart than the
    /// nearest two, at the distance d. So the way w between them lies in the bodies' difference, a
    /// convex set, whose point nearest to 0 is the shortest way w*. There w . w* >= |w*|^2, and |w
    /// - w*|^2 <= |w|^2 - |w*|^2 <= (d + e)^2 - d^2 = e (2 d + e).
    pub fn of_way(self, distance: Real) -> Real {
        // Two roots, so that no product leaves the range of numbers.
        self.0.sqrt() * (2.0 * distance + self.0).sqrt()
    }
}

/// Of links that are nearer than so many errors the way between surfaces has no direction: it errs
/// by more than a sixth of itself.
const NEAR: Real = 64.0;

/// How much two links move and turn at most, together.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MovedLinks {
    /// How far all points move.
    pub points: Real,
    /// How far the points of the axes do.
    pub axes: Real,
    pub turn: Real,
}

/// The nearest places of a face and another link, whose way has a direction in overlap too.
#[derive(Clone, Copy)]
struct Way {
    /// On the face.
    from: Vector,
    way: Vector,
    /// On the other link's axis.
    place: Vector,
    slack: Real,
    rounding: Real,
}

impl Way {
    /// By how much it may err, while the points that it is between move.
    fn doubt(&self, points: Real) -> Real {
        self.slack + points + 2.0 * Tolerance(points).of_way(self.way.length() + points)
    }

    /// By how much more it may err along a direction of the robot that turns.
    fn turning(&self, moved: &MovedLinks) -> Real {
        (self.way.length() + moved.points) * moved.turn
    }
}

impl JoinedLink {
    /// Whether the robot is thinner beyond an end.
    fn is_shoulder(&self, end: usize) -> bool {
        self.beyond[end].is_some_and(|next| is_step(next.radius(), self.link.radius()))
    }

    pub(crate) fn is_face(&self, end: usize) -> bool {
        match &self.beyond[end] {
            Some(next) => is_step(next.radius(), self.link.radius()),
            None => self.link.flat()[end],
        }
    }

    /// By how much the distance of two links of one robot may be measured wrong, and the way
    /// between them be longer than the shortest.
    ///
    /// Let S be the largest coordinate of both links and their radius. The narrow phase errs by 16
    /// u of the pair's extent of at most 2 S; the links' coordinates in their pair's frame by
    /// sqrt(3) 4 u S, the points in the robot's frame and their difference by sqrt(3) 3 u S: 64 u S
    /// is enough.
    pub(crate) fn tolerance(&self, other: &Self) -> Tolerance {
        let reach = |link: &PlacedLink| {
            link.start().abs().max(link.end().abs()).max_element() + link.radius()
        };
        Tolerance(64.0 * Real::UNIT_ROUNDOFF * reach(&self.link).max(reach(&other.link)))
    }

    fn centre(&self, end: usize) -> Vector {
        [self.link.start(), self.link.end()][end]
    }

    /// The normal of a face, out of the link.
    pub(crate) fn outward(&self, end: usize) -> Vector {
        let axis = Vector::from(self.link.axis());
        if end == 0 { -axis } else { axis }
    }

    /// The ball around the centre of a face, which is all of a round one.
    pub(crate) fn ball(&self, end: usize) -> PlacedLink {
        let centre = self.centre(end);
        PlacedLink::between(centre, centre, self.link.radius(), [false; 2])
    }

    /// The nearest points of a face and a link.
    pub(crate) fn face_to_link(&self, end: usize, other: &PlacedLink) -> NearestOfLinks {
        if self.link.flat()[end] {
            self.link.face_to_link(end, other)
        } else {
            self.ball(end).measure_link(other)
        }
    }

    /// How far two faces are apart at least, but for rounding: as far as the second is ahead of a
    /// flat first one's plane. Its points are its centre and what is perpendicular to its
    /// normal, up to its radius away; of a round one, up to its radius in all directions.
    pub(crate) fn face_gap(&self, end: usize, other: &Self, other_end: usize) -> Real {
        if !self.link.flat()[end] {
            return 0.0;
        }
        let normal = self.outward(end);
        let ahead = (other.centre(other_end) - self.centre(end)).dot(normal);
        let sine = if other.link.flat()[other_end] {
            normal.cross(other.outward(other_end)).length()
        } else {
            1.0
        };
        ahead - other.link.radius() * sine
    }

    /// The nearest points of two faces.
    pub(crate) fn face_to_face(
        &self,
        end: usize,
        other: &Self,
        other_end: usize,
    ) -> NearestOfLinks {
        match (self.link.flat()[end], other.link.flat()[other_end]) {
            (true, true) => self.link.face_to_face([end, other_end], &other.link),
            (_, false) => self.face_to_link(end, &other.ball(other_end)),
            (false, true) => other.face_to_link(other_end, &self.ball(end)).swapped(),
        }
    }

    /// Whether a face counts beside another link, `nearest` to it.
    pub(crate) fn face_counts(
        &self,
        end: usize,
        other: &Self,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> bool {
        let Some(way) = self.way(end, &other.link, nearest, tolerance) else { return true };
        way.way.dot(self.outward(end)) >= -way.slack
            && other.stays(&way)
            && !self.is_covered(end, &way, &other.link)
            && !other.is_shoulder_covered(&way)
    }

    /// Whether two faces that look at one another count.
    pub(crate) fn faces_count(
        &self,
        end: usize,
        other: &Self,
        other_end: usize,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> bool {
        let sides = [
            (self, end, other, other_end, *nearest),
            (other, other_end, self, end, nearest.swapped()),
        ];
        sides.into_iter().all(|(one, end, two, two_end, nearest)| {
            let way = one.way_to_face(end, two, two_end, &nearest, tolerance);
            way.way.dot(one.outward(end)) >= -way.slack
                && !one.is_face_covered(end, &way, two, two_end)
        })
    }

    /// Whether a face beside another link may count at some time, while both move.
    pub(crate) fn face_may_count(&self, end: usize, other: &Self, moved: &MovedLinks) -> bool {
        let tolerance = self.tolerance(other);
        let nearest = self.face_to_link(end, &other.link);
        let is_round = !self.link.flat()[end] && other.link.flat() == [false; 2];
        // Which way counts depends on the distance, so neither may. Round links are nearest where
        // axis and centre are.
        let of_axis =
            self.way(end, &other.link, &NearestOfLinks { distance: 0.0, ..nearest }, tolerance);
        let of_bodies =
            if is_round { of_axis } else { self.way(end, &other.link, &nearest, tolerance) };
        [of_bodies, of_axis].into_iter().any(|way| {
            way.is_none_or(|way| {
                let doubt = way.doubt(if is_round { moved.axes } else { moved.points });
                let along = doubt + way.turning(moved);
                way.way.dot(self.outward(end)) >= -along
                    && !other.leads_nearer(&way, along)
                    && !self.is_always_covered(end, &way, doubt, moved)
            })
        })
    }

    /// The same of two faces. Of round ones the centres are nearest at all times.
    pub(crate) fn faces_may_count(
        &self,
        end: usize,
        other: &Self,
        other_end: usize,
        moved: &MovedLinks,
    ) -> bool {
        if self.link.flat()[end] || other.link.flat()[other_end] {
            return true;
        }
        let sides = [(self, end, other, other_end), (other, other_end, self, end)];
        sides.into_iter().all(|(one, end, two, other_end)| {
            let rounding = one.tolerance(two).0;
            let (place, way) = (two.centre(other_end), two.centre(other_end) - one.centre(end));
            let from = one.centre(end) + way.normalize_or_zero() * one.link.radius();
            let way = Way { from, way, place, slack: rounding, rounding };
            let doubt = rounding + moved.axes;
            way.way.length() <= doubt
                || way.way.dot(one.outward(end)) >= -doubt - way.turning(moved)
                    && !one.is_always_covered(end, &way, doubt, moved)
        })
    }

    /// Whether a pair that turns by pi or more may count at some time, while both move.
    pub(crate) fn may_count_beside(&self, other: &Self, moved: &MovedLinks) -> bool {
        let has_face = |joined: &Self| joined.is_face(0) || joined.is_face(1);
        if !has_face(self) && !has_face(other) {
            return true;
        }
        let (feet, _) = self.link.nearest_on_axes(&other.link);
        let (way, tolerance) = (feet[1] - feet[0], self.tolerance(other));
        let slack = tolerance.of_way(way.length());
        let way = Way { from: feet[0], way, place: feet[1], slack, rounding: tolerance.0 };
        let least = way.doubt(moved.axes) + way.turning(moved);
        // The end at which the nearest place is at all times; none if that is not known.
        let end_of = |joined: &Self, way: Vector| {
            let along = way.dot(Vector::from(joined.link.axis()));
            (along.abs() > least).then_some(usize::from(along > 0.0))
        };
        let sides = [(self, other, end_of(self, way.way)), (other, self, end_of(other, -way.way))];
        let is_at_face =
            sides.iter().any(|(joined, _, end)| end.is_some_and(|end| joined.is_face(end)));
        !is_at_face
            || sides.into_iter().any(|(joined, beside, end)| {
                let may_be_at =
                    |face: &usize| joined.is_face(*face) && end.is_none_or(|end| end == *face);
                [0, 1]
                    .into_iter()
                    .filter(may_be_at)
                    .any(|face| joined.face_may_count(face, beside, moved))
            })
    }

    /// Whether the robot leads nearer from the place that a way leads to, at all times, if the way
    /// errs by `doubt` along any direction.
    fn leads_nearer(&self, way: &Way, doubt: Real) -> bool {
        let along = way.way.dot(Vector::from(self.link.axis()));
        if along.abs() <= doubt {
            return false;
        }
        let end = usize::from(along < 0.0);
        let Some(next) = &self.beyond[end] else { return false };
        let [here, there] = [self.link.radius(), next.radius()];
        let before = way.way.dot(Vector::from(next.axis())) * along.signum();
        !is_step(there, here) && before > doubt
    }

    /// Whether the adjoining link holds the point of a round face at all times.
    fn is_always_covered(&self, end: usize, way: &Way, doubt: Real, moved: &MovedLinks) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if self.link.flat()[end] {
            return false;
        }
        // The direction of the way turns by twice what it errs by, as a share of it, at most.
        let turned = 2.0 * doubt / way.way.length();
        let shift = self.link.radius() * turned + 2.0 * moved.axes + way.slack;
        turned <= 1.0 && next.holds(way.from, &Way { slack: shift, rounding: -shift, ..*way })
    }

    /// Whether a pair that turns by pi or more counts: where the axes are nearest at a face, by the
    /// rule for faces.
    pub(crate) fn counts_beside(&self, other: &Self, tolerance: Tolerance) -> bool {
        let (feet, _) = self.link.nearest_on_axes(&other.link);
        let [one, two] = [(self, feet[0]), (other, feet[1])].map(|(joined, foot)| {
            let end = joined.end_at(foot, tolerance.0);
            end.filter(|&end| joined.is_face(end))
        });
        let of_face = |joined: &Self, end: usize, other: &Self| {
            let nearest = joined.face_to_link(end, &other.link);
            joined.face_counts(end, other, &nearest, tolerance)
        };
        match (one, two) {
            (None, None) => true,
            (Some(end), None) => of_face(self, end, other),
            (None, Some(end)) => of_face(other, end, self),
            (Some(one), Some(two)) => of_face(self, one, other) || of_face(other, two, self),
        }
    }

    /// The end that a place of the axis is at, up to so much.
    fn end_at(&self, place: Vector, slack: Real) -> Option<usize> {
        let from = [0, 1].map(|end| (place - self.centre(end)).length());
        let end = usize::from(from[1] < from[0]);
        (from[end] <= slack).then_some(end)
    }

    /// The way from a face to another link; none if the link's axis meets the face.
    fn way(
        &self,
        end: usize,
        other: &PlacedLink,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> Option<Way> {
        let slack = tolerance.of_way(nearest.distance);
        if nearest.distance > NEAR * tolerance.0 {
            let way = nearest.on_second - nearest.on_first;
            let place = other.start() + other.along() * other.share_of(nearest.on_second);
            return Some(Way { from: nearest.on_first, way, place, slack, rounding: tolerance.0 });
        }
        let axis = PlacedLink::between(other.start(), other.end(), 0.0, [false; 2]);
        let (from, to) = if self.link.flat()[end] {
            let nearest = self.link.face_to_link(end, &axis);
            (nearest.on_first, nearest.on_second)
        } else {
            let centre = self.centre(end);
            let (feet, _) =
                PlacedLink::between(centre, centre, 0.0, [false; 2]).nearest_on_axes(&axis);
            (centre, feet[1])
        };
        let (way, distance) = (to - from, (to - from).length());
        let slack = tolerance.of_way(distance);
        if distance <= slack {
            return None;
        }
        // A round face has its point on the surface.
        let from =
            if self.link.flat()[end] { from } else { from + way * (self.link.radius() / distance) };
        Some(Way { from, way, place: to, slack, rounding: tolerance.0 })
    }

    /// The way from a face to another face.
    fn way_to_face(
        &self,
        end: usize,
        other: &Self,
        other_end: usize,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> Way {
        let place = other.centre(other_end);
        if nearest.distance > NEAR * tolerance.0 {
            let (way, slack) =
                (nearest.on_second - nearest.on_first, tolerance.of_way(nearest.distance));
            return Way { from: nearest.on_first, way, place, slack, rounding: tolerance.0 };
        }
        let way = place - self.centre(end);
        let distance = way.length();
        let from = if self.link.flat()[end] || distance == 0.0 {
            nearest.on_first
        } else {
            self.centre(end) + way * (self.link.radius() / distance)
        };
        Way { from, way, place, slack: tolerance.of_way(distance), rounding: tolerance.0 }
    }

    /// Whether the robot leads nowhere nearer from the place that a way leads to.
    fn stays(&self, way: &Way) -> bool {
        let Some(end) = self.end_at(way.place, way.slack) else { return true };
        let Some(next) = &self.beyond[end] else { return true };
        let [here, there] = [self.link.radius(), next.radius()];
        let is_round = !next.flat()[end ^ 1];
        if is_step(here, there) && is_round {
            return false;
        }
        let axis = Vector::from(next.axis());
        let on = if end == 0 { -axis } else { axis };
        is_step(there, here) || way.way.dot(on) >= -way.slack
    }

    /// Whether the point where another face is nearest to a shoulder is in the link beyond.
    fn is_shoulder_covered(&self, way: &Way) -> bool {
        let Some(end) = self.end_at(way.place, way.slack) else { return false };
        // What is nearest on a flat end may be anywhere on it.
        if !self.is_shoulder(end) || self.link.flat()[end] {
            return false;
        }
        let point = way.place - way.way.normalize_or_zero() * self.link.radius();
        self.beyond[end].is_some_and(|next| next.holds(point, way))
    }

    /// Whether all points of a face that are nearest to another link are in the adjoining link.
    fn is_covered(&self, end: usize, way: &Way, other: &PlacedLink) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if !next.holds(way.from, way) {
            return false;
        }
        if !self.link.flat()[end] {
            return true;
        }
        let along = way.way.cross(self.outward(end)).length() <= way.slack;
        let axis = Vector::from(other.axis());
        if !along {
            // One point of the rim.
            return true;
        }
        if way.way.dot(axis).abs() > way.slack {
            // Where the other link ends: one point, or all ahead of its flat end.
            let is_level = axis.cross(self.outward(end)).length() * other.radius() <= way.slack;
            let is_flat = other.flat() != [false; 2];
            return !(is_level && is_flat)
                || self.is_area_covered(end, way, way.place, other.radius());
        }
        // Along the other's axis, as far as both reach.
        let ends = [other.start(), other.end()]
            .map(|to| self.on_face_towards(end, way.from, to - way.way));
        ends.into_iter().all(|point| next.holds(point, way))
    }

    /// Whether the adjoining link holds all points of a flat face ahead of which is a parallel disc
    /// around `middle`.
    fn is_area_covered(&self, end: usize, way: &Way, middle: Vector, radius: Real) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        let (normal, centre) = (self.outward(end), self.centre(end));
        let aside = middle - centre;
        let aside = aside - normal * aside.dot(normal);
        let size = aside.length();
        let outwards = if size > 0.0 { aside / size } else { normal.any_orthonormal_vector() };
        // The two points on the line through both centres are farthest from the adjoining axis, or
        // farther than all.
        let [far, back] = [size + radius, radius - size].map(|reach| reach.min(self.link.radius()));
        [far, -back].into_iter().all(|reach| next.holds(centre + outwards * reach, way))
    }

    /// Where the line from a point of a face to another point leaves the face, or that point.
    fn on_face_towards(&self, end: usize, from: Vector, to: Vector) -> Vector {
        let (centre, radius) = (self.centre(end), self.link.radius());
        // In radii, so that no product leaves the range of numbers.
        let (offset, direction) = ((from - centre) / radius, (to - from) / radius);
        let (a, b) = (direction.length_squared(), offset.dot(direction));
        let root = (b * b - a * (offset.length_squared() - 1.0)).max(0.0).sqrt();
        let share = if a > 0.0 { ((root - b) / a).clamp(0.0, 1.0) } else { 0.0 };
        from + (to - from) * share
    }

    /// Whether all points of a face that are nearest to another face are in the adjoining link.
    fn is_face_covered(&self, end: usize, way: &Way, other: &Self, other_end: usize) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if !next.holds(way.from, way) {
            return false;
        }
        let is_flat = self.link.flat()[end];
        if !is_flat || !other.link.flat()[other_end] {
            return true;
        }
        // Two discs: parallel ones are as near over an area, and those that cross meet along a
        // chord.
        let [normal, facing] = [self.outward(end), other.outward(other_end)];
        let (centre, radius) = (other.centre(other_end), self.link.radius());
        let line = normal.cross(facing);
        let sine = line.length();
        if sine * radius.max(other.link.radius()) <= way.slack {
            return self.is_area_covered(end, way, centre, other.link.radius());
        }
        if (way.from - centre).dot(facing).abs() > way.slack {
            // One point of the rim.
            return true;
        }
        let ends = [1.0, -1.0].map(|sign| {
            let beyond = way.from + line * (sign * 4.0 * radius / sine);
            self.on_face_towards(end, way.from, beyond)
        });
        ends.into_iter().all(|point| next.holds(point, way))
    }
}

impl PlacedLink {
    /// Whether the link holds a point of a face, as far as that is known.
    fn holds(&self, point: Vector, &Way { slack, rounding, .. }: &Way) -> bool {
        let axis = Vector::from(self.axis());
        let along = (point - self.start()).dot(axis);
        let length = self.along().dot(axis);
        let beyond = [-along, along - length];
        let is_within = |end: usize| {
            let centre = [self.start(), self.end()][end];
            if self.flat()[end] {
                beyond[end] <= rounding
            } else {
                beyond[end] <= 0.0 || (point - centre).length() <= self.radius() - slack
            }
        };
        let across = (point - self.start()) - axis * along;
        let is_beside = across.length() <= self.radius() - slack;
        is_beside && is_within(0) && is_within(1)
    }
}
