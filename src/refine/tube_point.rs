//! An upper bound on the distance of a point of the mesh from the tube.
//!
//! # Definitions
//! - x: the point. c: the centreline of a section. r: its radius.
//! - c(s): the point of c nearest to x.
//! - q: a point of c near x (`place`).
//! - h, p: the height of x above the plane of a flat face, and the distance of x from the face's
//!   axis.
//!
//! # Claim
//! The distance of x from the tube is at most max(0, |x - q| - r), unless x lies ahead of a flat
//! face (case 2) or near a round end that the face cuts off (case 4).
//!
//! **Proof.**
//! 1. **Disc or ball.** Let c(s) be inside the section. Then x - c(s) is perpendicular to the
//!    tangent, so x lies in the plane of the disc at s. Its distance from the disc is max(0, |x -
//!    c(s)| - r). The same holds at a round end, for its ball. It also holds at a flat end whose
//!    plane x is not ahead of: there c(s) is the end only if x lies in its plane. Since c(s) is
//!    nearest, |x - c(s)| <= |x - q|.
//! 2. **Flat face.** Let x be ahead of a flat face whose centre is c(s). The distance of x from the
//!    face is hypot(h, max(0, p - r)). This value is an upper bound in every case. If q is nearer
//!    to x than the face's centre, the centre is not c(s), and case 1 applies.
//! 3. **The centreline returns to x.** The discs around q may be nearer than the face even if the
//!    face's centre is nearer than q. Then some place m between the two is farther from x than q
//!    (`recedes_between`). The part of the section on q's side of m has no such face, so case 1
//!    applies to it.
//! 4. **Overhanging cap.** The section's own face cuts off the ball at its round end if the ball
//!    sticks out of it. Where face and round end are both near x, case 1 needs one of two
//!    conditions:
//!    - x is nearer to q than to the round end (`distance_to_overhanging_cap`);
//!    - x is behind the face: then the segment from x to the ball is behind it, too.
//! 5. **Part of a section**, cut anywhere. Let some place between q and a cut be farther from x
//!    than q. Then the nearest place of the part up to there is not that cut, and cases 1 to 4
//!    apply to it.
//!
//! **Rounding and errors.** q is known to the deviation of the curve from its samples (`near.off`).
//! The normal of a face is known to its tilt, which moves the rim by at most r tilt. If the normal
//! of a face is unknown, its centre still lies in the tube.
//!
//! # A loose tube: definitions
//! - **Loose** tube: only its places are known. Its centreline is smooth and follows links to
//!   within the deviation e, place by place. Its discs are perpendicular to the centreline, in an
//!   unknown direction.
//! - x: the point of the mesh. q: a point of a link. d = |x - q|.
//! - **Run**: the links around q that share one radius r.
//!
//! **Claim.** The distance of x from the tube is at most
//! - d + e, always: the tube's place that belongs to q is within e of q and is the centre of a
//!   disc;
//! - max(0, d + e - r), if at both ends of the run some link end, from q on, is farther than d + 2
//!   e from x.
//!
//! **Proof** of the second bound. Take the place of the run nearest to x. Inside the run, x lies in
//! the plane of the disc there, so its distance is at most d + e - r, or 0. An end of the run is
//! nearest only if it is not farther from x than the tube's own place of q. So it is not nearest if
//! the link's end is farther than d + 2 e. The end is also excluded if some place of the run
//! between q and the end is farther than that: the nearest place of the part up to there is inside,
//! or at the other end.

use super::placed_tube::PlacedTube;
use crate::curve::Section;
use crate::robot::length;
use parry3d_f64::math::{Real, Vector};

/// How many places between q and a face are tried. Each is half as far from q as the one before.
const MAX_TRIALS: u32 = 6;

/// A point of the tube near a point of the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TubePoint {
    /// An upper bound on the distance of the tube from the point of the mesh.
    pub upper: Real,
    pub arc: Real,
    pub point: Vector,
}

/// A place of the centreline near a point x.
struct NearPlace {
    arc: Real,
    place: Vector,
    /// From x to the place, and its length.
    way: Vector,
    away: Real,
    /// The distance of the curve from its interpolation there.
    off: Real,
}

impl NearPlace {
    /// The point of the tube on the way from the place to `x`, if the tube has all points within
    /// the radius of the place. `reach` is an upper bound on the distance of the place from `x`.
    fn minus_radius(&self, radius: Real, reach: Real, x: Vector) -> TubePoint {
        // NaN means unknown, not contact.
        let upper = if reach.is_nan() { Real::INFINITY } else { (reach - radius).max(0.0) };
        let point = if upper > 0.0 { x + self.way * (upper / self.away).min(1.0) } else { x };
        TubePoint { upper, arc: self.arc, point }
    }
}

impl PlacedTube<'_> {
    /// Returns an upper bound on the distance of `x` from a section, searching near `arc`.
    pub(crate) fn near(&self, number: u32, arc: Real, x: Vector) -> TubePoint {
        if self.tube.is_loose() {
            return self.near_links(number, arc, x);
        }
        self.near_between(number, arc, x, [None; 2])
    }

    /// As [`near`](Self::near), for the part of the section between two arc lengths; `None` means
    /// the end of the section.
    ///
    /// Returns infinity if the nearest place may be one of the two cuts.
    pub(super) fn near_between(
        &self,
        number: u32,
        arc: Real,
        x: Vector,
        limits: [Option<Real>; 2],
    ) -> TubePoint {
        let section = self.section(number);
        let rounding = self.tube.error() + self.slack;
        let near = self.near_place(section, arc, x);
        let reach = near.away + near.off + rounding;
        let mut best = TubePoint { upper: Real::INFINITY, arc: near.arc, point: x };
        let mut is_beside = true;
        // Case 5.
        for (end, limit) in limits.into_iter().enumerate() {
            let Some(limit) = limit else { continue };
            let is_within = if end == 0 { limit <= near.arc } else { near.arc <= limit };
            if !is_within || !self.recedes_between(section, [near.arc, limit], x, reach + rounding)
            {
                return best;
            }
        }
        for (end, face) in self.all_faces(section).iter().enumerate() {
            // Cases 2 to 4.
            let Some(face) = face.as_ref().filter(|_| limits[end].is_none()) else { continue };
            let face = self.face(face);
            let offset = x - face.centre;
            let ahead = offset.dot(face.outward);
            let from_centre = offset.length();
            let is_behind = ahead + from_centre * face.tilt + rounding <= 0.0;
            let to_cut_cap = self.distance_to_overhanging_cap(section, 1 - end, x);
            if is_behind || reach < from_centre.min(to_cut_cap) - rounding {
                continue;
            }
            let face_arc = if end == 0 { section.start } else { section.end };
            if reach < to_cut_cap - rounding
                && self.recedes_between(section, [near.arc, face_arc], x, reach + rounding)
            {
                continue;
            }
            is_beside = false;
            let across = offset - face.outward * ahead;
            let size = across.length();
            let rim = length(Vector::new(ahead, (size - section.radius).max(0.0), 0.0))
                + section.radius * face.tilt;
            // The face's centre and `place` belong to the tube for every normal. (The tilt may be
            // infinite; infinity times 0 is NaN.)
            let to_place = near.away + near.off;
            let least = if rim <= from_centre { rim } else { from_centre }.min(to_place);
            let upper = least + rounding;
            if upper < best.upper {
                best = TubePoint { upper, arc: face_arc, point: face.centre };
                if least == to_place {
                    best = TubePoint { upper, arc: near.arc, point: near.place };
                } else if least == rim {
                    let share = if size > section.radius { section.radius / size } else { 1.0 };
                    best.point = face.centre + across * share;
                }
            }
        }
        // Case 1.
        if is_beside {
            best = near.minus_radius(section.radius, reach, x);
        }
        best
    }

    /// Returns the place of a section near `arc` that is near `x`.
    fn near_place(&self, section: &Section, arc: Real, x: Vector) -> NearPlace {
        let foot = self.tube.foot(section, arc, self.pose.inverse_transform_point(x));
        let [a, b] = foot.between.map(|point| self.pose * point);
        let place = a + (b - a) * foot.share;
        let way = place - x;
        NearPlace { arc: foot.arc, place, way, away: way.length(), off: foot.off }
    }

    /// Whether some sampled place between two arc lengths is farther from `x` than `least`. Tries
    /// places closer and closer to `from`.
    fn recedes_between(
        &self,
        section: &Section,
        [from, to]: [Real; 2],
        x: Vector,
        least: Real,
    ) -> bool {
        let mut step = 0.5 * (to - from);
        for _ in 0..MAX_TRIALS {
            let tick = self.tube.tick(section, from + step);
            let arc = self.tube.arc(section, tick);
            let is_between = from.min(to) < arc && arc < from.max(to);
            if is_between {
                // The curve may be this far from its tick.
                let off = self.tube.bound(section, [tick - 1, tick + 1]).off;
                if (self.point(section, tick) - x).length() > least + off {
                    return true;
                }
            }
            step *= 0.5;
        }
        false
    }

    /// Returns the distance of `x` from a round end whose ball may stick out of the face at the
    /// section's other end. Returns infinity if there is no such ball.
    fn distance_to_overhanging_cap(&self, section: &Section, end: usize, x: Vector) -> Real {
        if section.faces[end].is_some()
            || section.end - section.start > section.room(1 - end) * section.stretch
        {
            return Real::INFINITY;
        }
        let tick = if end == 0 { section.first } else { section.last };
        (self.point(section, tick) - x).length()
    }

    /// As [`near`](Self::near), for a loose tube.
    fn near_links(&self, number: u32, arc: Real, x: Vector) -> TubePoint {
        let section = self.section(number);
        let rounding = self.tube.error() + self.slack;
        let near = self.near_place(section, arc, x);
        let reach = near.away + rounding;
        if [0, 1].into_iter().all(|end| self.is_before_end(number, end, x, reach + rounding)) {
            return near.minus_radius(section.radius, reach, x);
        }
        TubePoint { upper: reach, arc: near.arc, point: near.place }
    }

    /// Whether some link end between a link and that end of its run is farther than `least` from
    /// `x`.
    fn is_before_end(&self, number: u32, end: usize, x: Vector, least: Real) -> bool {
        let mut at = number;
        loop {
            let section = self.section(at);
            let tick = if end == 0 { section.first } else { section.last };
            if (self.point(section, tick) - x).length() > least {
                return true;
            }
            if section.faces[end].is_some() {
                return false;
            }
            at = if end == 0 { at - 1 } else { at + 1 };
        }
    }
}
