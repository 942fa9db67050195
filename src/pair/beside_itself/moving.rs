//! Decides which pairs of links of one robot may count at some time while the robot moves.
//!
//! The rule at rest, `w`, `y`, `p` and `t` are those of the parent module.
//!
//! # Claims
//! Let all points of both links move by at most `points` together, and let their directions turn by
//! at most `turn`.
//! - `w` then errs as if the bodies were known within `points`, and along a direction of the robot
//!   by `|w| turn` more.
//! - If `w . t` exceeds this error for the link's own axis, `y` is its start at all times. If the
//!   same holds for the axis of the link before, and that link is no thinner, the robot leads
//!   nearer backwards at all times. The same holds forwards with the opposite sign.
//! - The point of a round shoulder moves by the displacement of its centre plus `r` times the turn
//!   of `w`. If the adjoining link contains the point deeper than this plus its own displacement,
//!   it contains the point at all times.

use super::{JoinedLink, Way, error_of_way};
use crate::pair::two_links::NearestOfLinks;
use crate::robot::is_step;
use parry3d_f64::math::{Real, Vector};

/// The largest motion of two links, added together.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MovedLinks {
    /// The largest displacement of all points.
    pub points: Real,
    /// The largest displacement of the points of the axes.
    pub axes: Real,
    pub turn: Real,
}

impl Way {
    /// Returns the largest error of the vector while its end points move by `points`.
    fn doubt(&self, points: Real) -> Real {
        self.slack + points + 2.0 * error_of_way(points, self.way.length() + points)
    }

    /// Returns the additional error along a direction of the robot that turns.
    fn turning(&self, moved: &MovedLinks) -> Real {
        (self.way.length() + moved.points) * moved.turn
    }
}

impl JoinedLink {
    /// Returns whether a face beside another link may count at some time while both move.
    pub(crate) fn face_may_count(&self, end: usize, other: &Self, moved: &MovedLinks) -> bool {
        let tolerance = self.tolerance(other);
        let nearest = self.face_to_link(end, &other.link);
        let is_round = !self.link.flat()[end] && other.link.flat() == [false; 2];
        // The choice between the two vectors depends on the distance, so test both. For round links
        // the closest points follow from axis and centre.
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

    /// Same as [`face_may_count`](Self::face_may_count), for two faces. The closest points of round
    /// faces follow from their centres at all times.
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
            let rounding = one.tolerance(two).points;
            let (place, way) = (two.centre(other_end), two.centre(other_end) - one.centre(end));
            let from = one.centre(end) + way.normalize_or_zero() * one.link.radius();
            let way = Way { from, way, place, slack: rounding, rounding };
            let doubt = rounding + moved.axes;
            way.way.length() <= doubt
                || way.way.dot(one.outward(end)) >= -doubt - way.turning(moved)
                    && !one.is_always_covered(end, &way, doubt, moved)
        })
    }

    /// Returns whether a pair that turns by pi or more may count at some time while both move.
    pub(crate) fn may_count_beside(&self, other: &Self, moved: &MovedLinks) -> bool {
        let (feet, _) = self.link.nearest_on_axes(&other.link);
        let (way, tolerance) = (feet[1] - feet[0], self.tolerance(other));
        let slack = tolerance.of_way(way.length());
        let way = Way { from: feet[0], way, place: feet[1], slack, rounding: tolerance.points };
        let back = Way { from: feet[1], way: -way.way, place: feet[0], ..way };
        let least = way.doubt(moved.axes) + way.turning(moved);
        let has_face = |joined: &Self| joined.is_face(0) || joined.is_face(1);
        if !has_face(self) && !has_face(other) {
            return !other.leads_nearer(&way, least) && !self.leads_nearer(&back, least);
        }
        // The end of the axis that is closest at all times; `None` if unknown.
        let end_of = |joined: &Self, way: Vector| {
            let along = way.dot(Vector::from(joined.link.axis()));
            (along.abs() > least).then_some(usize::from(along > 0.0))
        };
        let sides = [(self, other, end_of(self, way.way)), (other, self, end_of(other, -way.way))];
        let is_at_face =
            sides.iter().any(|(joined, _, end)| end.is_some_and(|end| joined.is_face(end)));
        !is_at_face
            || sides.into_iter().any(|(joined, beside, _)| {
                let is_face = |face: &usize| joined.is_face(*face);
                [0, 1]
                    .into_iter()
                    .filter(is_face)
                    .any(|face| joined.face_may_count(face, beside, moved))
            })
    }

    /// Returns whether the robot leads nearer from the place of `way` at all times, if `way` errs
    /// by at most `doubt` along any direction.
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

    /// Returns whether the adjoining link contains the point of a round face at all times.
    fn is_always_covered(&self, end: usize, way: &Way, doubt: Real, moved: &MovedLinks) -> bool {
        let Some(next) = &self.beyond[end] else { return false };
        if self.link.flat()[end] {
            return false;
        }
        // The direction of the vector turns by at most twice its relative error.
        let turned = 2.0 * doubt / way.way.length();
        let shift = self.link.radius() * turned + 2.0 * moved.axes + way.slack;
        turned <= 1.0 && next.holds(way.from, &Way { slack: shift, rounding: -shift, ..*way })
    }
}
