//! Decides whether the closest place of two links of one robot is a local minimum of the distance.
//! The two links share no joint.
//!
//! ```text
//!       thick link        adjoining (thinner) link
//!      __________________
//!                        |____________
//!        ----- axis -----|-> n ------    p on the face, n its outward normal
//!      __________________|
//!             p --> w --> q              q on the other link, y on its axis
//! ```
//!
//! # Definitions
//! - An end of a link is **level** with the next link if their radii are equal within rounding
//!   ([`is_step`]). Otherwise the next link is **thinner** or **wider**.
//! - A **shoulder** is an end beyond which the robot is thinner. A **face** is a shoulder, or a
//!   flat end of the robot.
//! - The **adjoining** link is the link beyond an end. Beyond a shoulder, the links that continue
//!   it in a straight line with the same radius belong to it: where a straight link is cut changes
//!   nothing.
//! - `p`: the point of a face closest to the other link. `q`: that link's closest point. `y`: the
//!   place of `q` on its axis. `w = q - p`. In overlap `q` is replaced by `y`, so that `w` has a
//!   direction there too.
//!
//! # The rule
//! A face counts beside a link if all three conditions hold.
//!
//! 1. **Outwards.** `w . n >= 0` with the outward normal `n`. Otherwise the link's barrel behind
//!    the face is nearer.
//! 2. **Not descending.** The robot does not come nearer beyond `y`. If `y` is at an end and the
//!    next link is no thinner, the next link's direction `t` away from `y` must satisfy
//!    `w . t >= 0`. A wider link that begins round is nearer immediately, in every direction.
//! 3. **Not covered.** `p` is not in the adjoining link, caps included. Otherwise the adjoining
//!    link is at least as near, and decides. If several points are equally near, the face is
//!    covered only if all of them are in the adjoining link. The same holds at a shoulder of the
//!    other link if `q` lies there.
//!
//! If the other link's axis meets the face, `w = 0`. The face counts: no rule says which direction
//! is nearer.
//!
//! Two faces that face each other count if 1 and 3 hold for both.
//!
//! # Two links
//! A pair of links with a turn of at least pi counts at the closest places of their axes, or at a
//! face:
//!
//! 1. If inner places of both axes are as near within rounding (`JoinedLink::are_level`), the pair
//!    counts: there the way is perpendicular to both axes. Of parallel axes every place of the
//!    common stretch is as near, and the closest places that the narrow phase returns are any of
//!    them. Legs may be skew by up to 35 degrees: if the bend is their common perpendicular, places
//!    next to the bend are as near as the bend.
//! 2. Otherwise, if no closest place is at a face, the pair counts if condition 2 holds on both
//!    sides. If it fails, the robot comes nearer beyond that place, so the place is no local
//!    minimum.
//! 3. Otherwise the pair counts if a face counts beside the other link. The closest places of the
//!    axes do not decide this: a flat face may be nearest at its rim, far from its axis.
//!
//! In case 3 the closest points of the face and the other link are also the closest points of both
//! links. Both are convex: by condition 1 no point of the face's link lies ahead of `p` along `w`.
//!
//! **Level.** Axes run level if the way between them has a component of at most
//! `e + |w| (2^-24 + 4 e / l)` along each axis. Here `e` is the rounding of the coordinates and `l`
//! the length of the shorter link. The last term is the rounding of an axis; 2^-24 rad is the share
//! that counts as parallel in every frame.
//!
//! # Claim
//! A local minimum of the distance between two links, at a face of one of them, satisfies the rule.
//!
//! # Proof
//! - `p` is the closest point of its link, which is convex and lies behind the face: this gives 1.
//! - If 2 fails, moving on along the robot comes nearer immediately.
//! - If 3 fails, all equally near points also belong to the adjoining link, so it is at least as
//!   near. Its own pair with the other link is tested by the same rule. □
//!
//! While the robot moves, see `moving`.
//!
//! # Rounding
//! - `w` errs by at most `slack` ([`Tolerance::of_way`]), so `w . n` and `w . t` may be `-slack`.
//! - `p` errs by as much, so the adjoining link must contain it that far inside its radius. Ahead
//!   of flat ends `p` errs by rounding alone, since both bodies are discs in known planes: there
//!   `p` may be outside by that rounding.
//! - Between links nearer than [`NEAR`] errors, `w` is measured to the axis.

mod moving;

pub(crate) use moving::MovedLinks;

use super::placed_link::PlacedLink;
use super::two_links::NearestOfLinks;
use crate::distance::Scalar;
use crate::robot::{LEVEL, is_step};
use parry3d_f64::math::{Real, Vector};

/// A link and the links beyond its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JoinedLink {
    pub link: PlacedLink,
    pub beyond: [Option<PlacedLink>; 2],
}

/// The largest errors of the distance of two links of one robot, and of their closest points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tolerance {
    /// Of the difference of two points in the robot's frame.
    pub points: Real,
    /// Of the distance in the pair's own coordinates, in which the two links are measured. It is the
    /// same in every frame and in both orders of the links.
    pub pair: Real,
}

impl Tolerance {
    /// Returns the errors of two links whose points differ by at most `extent` in each coordinate
    /// ([`JoinedLink::tolerance`]).
    pub fn new(points: Real, extent: Real) -> Self {
        Self { points, pair: 32.0 * Real::UNIT_ROUNDOFF * extent }
    }

    /// Returns the largest error of a distance.
    pub fn of_distance(self) -> Real {
        self.points + self.pair
    }

    /// Returns the largest error, in any direction, of the measured vector between two convex
    /// bodies that are `distance` apart.
    ///
    /// **Claim.** The error is at most [`error_of_way`] of `pair`, plus `points`.
    ///
    /// **Proof.** The coordinates of the pair are differences of the given coordinates. They err by
    /// `pair` with all that is computed from them, wherever the robot is. Only the two points are
    /// then rounded in the robot's frame, which moves each end of the vector by less than half of
    /// `points`. □
    pub fn of_way(self, distance: Real) -> Real {
        self.points + error_of_way(self.pair, distance)
    }
}

/// Returns the largest error, in any direction, of the vector between two convex bodies that are
/// `distance` apart, if that vector leads between points of the two bodies and is longer than the
/// shortest by at most `error`.
///
/// **Definitions.** `e`: `error`. `d`: the distance. `w`: the vector; `|w| <= d + e`. `w*`: the
/// shortest such vector, `|w*| = d`.
///
/// **Proof.** `w` lies in the difference of the bodies, a convex set whose point closest to 0 is
/// `w*`. So `w . w* >= |w*|^2`, and
///
/// ```text
/// |w - w*|^2 <= |w|^2 - |w*|^2 <= (d + e)^2 - d^2 = e (2 d + e).
/// ```
///
/// The root is sharp: if axes run almost level, an error of `e` moves their closest places far.
fn error_of_way(error: Real, distance: Real) -> Real {
    // Two roots keep all products inside the range of numbers.
    error.sqrt() * (2.0 * distance + error).sqrt()
}

/// The square of the sine of the largest angle of axes that run beside one another: 35 degrees.
/// Robots with right angles, whose bends are perpendicular to both legs, are on either side.
const MOST_SKEW: Real = 1.0 / 3.0;

/// Below this many errors the vector between surfaces has no usable direction: it errs by more than
/// a sixth of its length.
const NEAR: Real = 64.0;

/// The closest places of a face and another link. The vector between them has a direction in
/// overlap too.
#[derive(Clone, Copy)]
struct Way {
    /// The point on the face.
    from: Vector,
    way: Vector,
    /// The place on the other link's axis.
    place: Vector,
    slack: Real,
    rounding: Real,
}

impl JoinedLink {
    /// Joins a link with the links before it, nearest first, and the links behind it.
    pub(crate) fn new(
        link: PlacedLink,
        before: impl Iterator<Item = PlacedLink>,
        behind: impl Iterator<Item = PlacedLink>,
    ) -> Self {
        let beyond = [adjoining(&link, 0, before), adjoining(&link, 1, behind)];
        Self { link, beyond }
    }

    /// Returns whether the robot is thinner beyond an end.
    fn is_shoulder(&self, end: usize) -> bool {
        self.beyond[end].is_some_and(|next| is_step(next.radius(), self.link.radius()))
    }

    pub(crate) fn is_face(&self, end: usize) -> bool {
        match &self.beyond[end] {
            Some(next) => is_step(next.radius(), self.link.radius()),
            None => self.link.flat()[end],
        }
    }

    /// Returns the largest errors of the distance and the closest points.
    ///
    /// Let `S` be the largest coordinate of both links plus their radius, and `X` a length that no
    /// coordinate difference of two of their points exceeds.
    /// - The coordinates of the pair err by less than 4 u X, and the narrow phase by 16 u X:
    ///   together by less than 32 u X.
    /// - The points in the robot's frame and their difference err by sqrt(3) 3 u S more, less than
    ///   16 u S.
    ///
    /// A robot that was rounded in another frame is another robot: two of its points are as far
    /// apart within 16 u S.
    pub(crate) fn tolerance(&self, other: &Self) -> Tolerance {
        let reach = |link: &PlacedLink| {
            link.start().abs().max(link.end().abs()).max_element() + link.radius()
        };
        let [one, two] = [&self.link, &other.link];
        let middle = |link: &PlacedLink| link.start() + 0.5 * link.along();
        let size = |link: &PlacedLink| link.along().length() + link.radius();
        let extent = (middle(two) - middle(one)).length() + size(one) + size(two);
        Tolerance::new(16.0 * Real::UNIT_ROUNDOFF * reach(one).max(reach(two)), extent)
    }

    fn centre(&self, end: usize) -> Vector {
        [self.link.start(), self.link.end()][end]
    }

    /// Returns the outward normal of a face.
    pub(crate) fn outward(&self, end: usize) -> Vector {
        let axis = Vector::from(self.link.axis());
        if end == 0 { -axis } else { axis }
    }

    /// Returns the ball around the centre of a face; a round face is a part of it.
    pub(crate) fn ball(&self, end: usize) -> PlacedLink {
        let centre = self.centre(end);
        PlacedLink::between(centre, centre, self.link.radius(), [false; 2])
    }

    /// Returns the closest points of a face and a link.
    pub(crate) fn face_to_link(&self, end: usize, other: &PlacedLink) -> NearestOfLinks {
        if self.link.flat()[end] {
            self.link.face_to_link(end, other)
        } else {
            self.ball(end).measure_link(other)
        }
    }

    /// Returns a lower bound on the distance of two faces, before rounding: how far the second lies
    /// ahead of the plane of a flat first face; 0 if the first is round.
    ///
    /// The points of a flat second face are its centre plus vectors of at most its radius across
    /// its normal; of a round one, plus vectors of at most its radius in all directions.
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

    /// Returns the closest points of two faces.
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

    /// Returns whether a face counts beside another link. `nearest` holds their closest points.
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

    /// Returns whether two faces that face each other count.
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

    /// Returns a link, without what is beyond its ends.
    pub(crate) fn alone(link: PlacedLink) -> Self {
        Self { link, beyond: [None; 2] }
    }

    /// Returns whether a pair that turns by pi or more counts (section "Two links"). `joined`
    /// returns both links with what is beyond their ends. It is asked only if a closest place of
    /// the axes is at an end.
    pub(crate) fn counts_beside(
        &self,
        other: &Self,
        tolerance: Tolerance,
        joined: impl FnOnce() -> [Self; 2],
    ) -> bool {
        let Some((ends, way, slack)) = self.closest_ends(other, tolerance) else { return true };
        if ends == [None; 2] {
            return true;
        }
        let [one, two] = &joined();
        let sides = [(one, ends[0], -way), (two, ends[1], way)];
        let is_inner_minimum = sides.into_iter().all(|(joined, end, way)| {
            end.is_none_or(|end| !joined.is_face(end) && joined.stays_beyond(end, way, slack))
        });
        is_inner_minimum || one.some_face_counts(two, tolerance)
    }

    /// Returns the end of each axis that is as near as the closest places of both, the way between
    /// those places, and its slack; `None` if the axes run level.
    fn closest_ends(
        &self,
        other: &Self,
        tolerance: Tolerance,
    ) -> Option<([Option<usize>; 2], Vector, Real)> {
        let (feet, _) = self.link.nearest_on_axes(&other.link);
        let way = feet[1] - feet[0];
        let slack = self.level_slack(other, way, LEVEL, tolerance);
        if self.are_level(other, way, slack) {
            return None;
        }
        let rise = self.level_slack(other, way, 0.0, tolerance);
        let ends = [
            self.end_closest_to(&other.link, feet[0], rise),
            other.end_closest_to(&self.link, feet[1], rise),
        ];
        Some((ends, way, slack))
    }

    /// Returns whether a face of two links counts beside the other one, where both are closest.
    fn some_face_counts(&self, other: &Self, tolerance: Tolerance) -> bool {
        let has_face = |joined: &Self| joined.is_face(0) || joined.is_face(1);
        if !has_face(self) && !has_face(other) {
            return false;
        }
        let nearest = self.link.measure_link(&other.link);
        let is_apart = nearest.distance > NEAR * tolerance.points;
        let sides = [(self, other, nearest), (other, self, nearest.swapped())];
        sides.into_iter().any(|(joined, other, nearest)| {
            [0, 1].into_iter().filter(|&end| joined.is_face(end)).any(|end| {
                if !is_apart {
                    let nearest = joined.face_to_link(end, &other.link);
                    return joined.face_counts(end, other, &nearest, tolerance);
                }
                let ahead = (nearest.on_first - joined.centre(end)).dot(joined.outward(end));
                ahead >= -tolerance.points && joined.face_counts(end, other, &nearest, tolerance)
            })
        })
    }

    /// Returns whether inner places of both axes are as near within rounding as their closest
    /// places, between which `way` leads: it is perpendicular to both within `slack`, and the axes
    /// run beside one another.
    ///
    /// The squared distance is convex in both places. So where the way is perpendicular to both
    /// axes, the distance is least. Axes that are skew by less than 35 degrees run beside one
    /// another: if the way is their bend, rounding puts its ends inside of both or not.
    fn are_level(&self, other: &Self, way: Vector, slack: Real) -> bool {
        let [one, two] = [&self.link, &other.link];
        let axes = [one, two].map(|link| Vector::from(link.axis()));
        if axes.iter().any(|axis| way.dot(*axis).abs() > slack) {
            return false;
        }
        let along = |place: Vector| (place - one.start()).dot(axes[0]);
        let [from, to] = [two.start(), two.end()].map(along);
        let common = from.max(to).min(along(one.end())) - from.min(to).max(0.0);
        common > 4.0 * slack && axes[0].cross(axes[1]).length_squared() < MOST_SKEW
    }

    /// Returns the component along an axis that a way perpendicular to it may have, if the axis is
    /// known within its rounding and `turned`; at most [`Tolerance::of_way`], which bounds all
    /// components while the robot moves.
    fn level_slack(&self, other: &Self, way: Vector, turned: Real, tolerance: Tolerance) -> Real {
        let distance = way.length();
        let shorter = self.link.along().length().min(other.link.along().length());
        let turned = turned + 4.0 * (tolerance.points / shorter);
        (tolerance.points + distance * turned).min(tolerance.of_way(distance))
    }

    /// Returns the end of the axis that is as near to another axis as `foot`, its closest place, up
    /// to rounding: there the way has at most the component `rise` out of the link.
    ///
    /// The distance to a convex set is a convex function of a place: between the foot and the end
    /// it rises nowhere more steeply than at the end. If the axes are almost parallel, rounding
    /// moves the foot far, but this component little.
    fn end_closest_to(&self, other: &PlacedLink, foot: Vector, rise: Real) -> Option<usize> {
        let from = [0, 1].map(|end| (foot - self.centre(end)).length());
        let end = usize::from(from[1] < from[0]);
        let centre = self.centre(end);
        let way = centre - (other.start() + other.along() * other.share_of(centre));
        (way.dot(self.outward(end)) <= rise).then_some(end)
    }

    /// Returns the end that a place of the axis lies at, within `slack`.
    fn end_at(&self, place: Vector, slack: Real) -> Option<usize> {
        let from = [0, 1].map(|end| (place - self.centre(end)).length());
        let end = usize::from(from[1] < from[0]);
        (from[end] <= slack).then_some(end)
    }

    /// Returns the vector from a face to another link; `None` if the link's axis meets the face.
    fn way(
        &self,
        end: usize,
        other: &PlacedLink,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> Option<Way> {
        let slack = tolerance.of_way(nearest.distance);
        if nearest.distance > NEAR * tolerance.points {
            let way = nearest.on_second - nearest.on_first;
            let place = other.start() + other.along() * other.share_of(nearest.on_second);
            let way = Way { from: nearest.on_first, way, place, slack, rounding: tolerance.points };
            return Some(self.in_the_middle(end, way, other));
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
        // The point of a round face lies on its surface.
        let from =
            if self.link.flat()[end] { from } else { from + way * (self.link.radius() / distance) };
        let way = Way { from, way, place: to, slack, rounding: tolerance.points };
        Some(self.in_the_middle(end, way, other))
    }

    /// Returns the two ends of the stretch of a flat face that is as near to another link, which
    /// runs level with the face; `None` if one point is nearest.
    fn level_stretch(&self, end: usize, way: &Way, other: &PlacedLink) -> Option<[Vector; 2]> {
        let is_ahead = way.way.cross(self.outward(end)).length() <= way.slack;
        let is_level = way.way.dot(Vector::from(other.axis())).abs() <= way.slack;
        (self.link.flat()[end] && is_ahead && is_level).then(|| {
            let shift = way.from - way.place;
            [other.start(), other.end()].map(|to| self.on_face_towards(end, way.from, to + shift))
        })
    }

    /// Returns the way from the middle of the points that are as near, so that the place is at an
    /// end of the other link only if all of them are.
    fn in_the_middle(&self, end: usize, way: Way, other: &PlacedLink) -> Way {
        let Some([one, two]) = self.level_stretch(end, &way, other) else { return way };
        let shift = 0.5 * ((one - way.from) + (two - way.from));
        Way { from: way.from + shift, place: way.place + shift, ..way }
    }

    /// Returns the vector from a face to another face.
    fn way_to_face(
        &self,
        end: usize,
        other: &Self,
        other_end: usize,
        nearest: &NearestOfLinks,
        tolerance: Tolerance,
    ) -> Way {
        let place = other.centre(other_end);
        if nearest.distance > NEAR * tolerance.points {
            let (way, slack) =
                (nearest.on_second - nearest.on_first, tolerance.of_way(nearest.distance));
            return Way { from: nearest.on_first, way, place, slack, rounding: tolerance.points };
        }
        let way = place - self.centre(end);
        let distance = way.length();
        let from = if self.link.flat()[end] || distance == 0.0 {
            nearest.on_first
        } else {
            self.centre(end) + way * (self.link.radius() / distance)
        };
        Way { from, way, place, slack: tolerance.of_way(distance), rounding: tolerance.points }
    }

    /// Returns whether the robot does not come nearer beyond the place of `way` (rule 2).
    fn stays(&self, way: &Way) -> bool {
        let end = self.end_at(way.place, way.slack);
        end.is_none_or(|end| self.stays_beyond(end, way.way, way.slack))
    }

    /// Returns whether the robot does not come nearer beyond an end. `way` leads there.
    fn stays_beyond(&self, end: usize, way: Vector, slack: Real) -> bool {
        let Some(next) = &self.beyond[end] else { return true };
        let [here, there] = [self.link.radius(), next.radius()];
        let is_round = !next.flat()[end ^ 1];
        if is_step(here, there) && is_round {
            return false;
        }
        let axis = Vector::from(next.axis());
        let on = if end == 0 { -axis } else { axis };
        is_step(there, here) || way.dot(on) >= -slack
    }

    /// Returns whether the link beyond contains the point where another face is closest to a
    /// shoulder.
    fn is_shoulder_covered(&self, way: &Way) -> bool {
        let Some(end) = self.end_at(way.place, way.slack) else { return false };
        // The closest point of a flat end may be anywhere on it.
        if !self.is_shoulder(end) || self.link.flat()[end] {
            return false;
        }
        let point = way.place - way.way.normalize_or_zero() * self.link.radius();
        self.beyond[end].is_some_and(|next| next.holds(point, way))
    }

    /// Returns whether the adjoining link contains all points of a face that are closest to another
    /// link (rule 3).
    fn is_covered(&self, end: usize, way: &Way, other: &PlacedLink) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if !next.holds(way.from, way) {
            return false;
        }
        if !self.link.flat()[end] {
            return true;
        }
        if let Some(ends) = self.level_stretch(end, way, other) {
            // Points along the other link's axis, for the length of both.
            return ends.into_iter().all(|point| next.holds(point, way));
        }
        let normal = self.outward(end);
        if way.way.cross(normal).length() > way.slack {
            // One point of the rim.
            return true;
        }
        // The closest place is an end of the other link: one point, or all points ahead of its flat
        // end.
        let axis = Vector::from(other.axis());
        let is_level = axis.cross(normal).length() * other.radius() <= way.slack;
        let is_flat = other.flat() != [false; 2];
        !(is_level && is_flat) || self.is_area_covered(end, way, way.place, other.radius())
    }

    /// Returns whether the adjoining link contains all points of a flat face that lie ahead of a
    /// parallel disc around `middle`.
    fn is_area_covered(&self, end: usize, way: &Way, middle: Vector, radius: Real) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        let (normal, centre) = (self.outward(end), self.centre(end));
        let aside = middle - centre;
        let aside = aside - normal * aside.dot(normal);
        let size = aside.length();
        let outwards = if size > 0.0 { aside / size } else { normal.any_orthonormal_vector() };
        // The two points on the line through both centres are at least as far from the adjoining
        // axis as all others.
        let [far, back] = [size + radius, radius - size].map(|reach| reach.min(self.link.radius()));
        [far, -back].into_iter().all(|reach| next.holds(centre + outwards * reach, way))
    }

    /// Returns where the line from a point of a flat face towards another point, moved into the
    /// plane of the face, leaves the face, or that point if it is on the face.
    fn on_face_towards(&self, end: usize, from: Vector, to: Vector) -> Vector {
        let (centre, radius, normal) = (self.centre(end), self.link.radius(), self.outward(end));
        let along = to - from;
        let along = along - normal * along.dot(normal);
        // In units of the radius, so that all products stay in range.
        let (offset, direction) = ((from - centre) / radius, along / radius);
        let (a, b) = (direction.length_squared(), offset.dot(direction));
        let root = (b * b - a * (offset.length_squared() - 1.0)).max(0.0).sqrt();
        let share = if a > 0.0 { ((root - b) / a).clamp(0.0, 1.0) } else { 0.0 };
        from + along * share
    }

    /// Returns whether the adjoining link contains all points of a face that are closest to another
    /// face (rule 3).
    fn is_face_covered(&self, end: usize, way: &Way, other: &Self, other_end: usize) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if !next.holds(way.from, way) {
            return false;
        }
        let is_flat = self.link.flat()[end];
        if !is_flat || !other.link.flat()[other_end] {
            return true;
        }
        // Two parallel discs are equally near over an area; crossing discs meet along a chord.
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

/// Returns the adjoining link at an end. `beyond` iterates over the links beyond that end.
///
/// A point of a shoulder is at most its radius away, so a longer run need not be continued.
fn adjoining(
    link: &PlacedLink,
    end: usize,
    mut beyond: impl Iterator<Item = PlacedLink>,
) -> Option<PlacedLink> {
    let mut run = beyond.next()?;
    let far_end = |link: &PlacedLink| [link.start(), link.end()][end];
    while is_step(run.radius(), link.radius()) && run.along().length() < link.radius() {
        let Some(next) = beyond.next() else { break };
        let (joint, radius) = (far_end(&run), run.radius());
        let [near, far] = [[run.start(), run.end()][1 - end], far_end(&next)];
        let ends = if end == 0 { [far, near] } else { [near, far] };
        let flat =
            [0, 1].map(|side: usize| if side == end { next.flat() } else { run.flat() }[side]);
        let both = PlacedLink::between(ends[0], ends[1], radius, flat);
        let largest = ends[0].abs().max(ends[1].abs()).max_element() + radius;
        let aside = (joint - near).cross(Vector::from(both.axis())).length();
        let is_straight =
            aside <= 64.0 * Real::UNIT_ROUNDOFF * largest && run.along().dot(next.along()) > 0.0;
        if is_step(radius, next.radius()) || is_step(next.radius(), radius) || !is_straight {
            break;
        }
        run = both;
    }
    Some(run)
}

impl PlacedLink {
    /// Returns whether the link certainly contains a point of a face.
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
