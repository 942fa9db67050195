//! How near a point of the mesh is to the tube at most.
//!
//! Let s be where a section's centreline is nearest to x. Inside the section x - c(s) is
//! perpendicular to the tangent, so x is in the plane of the disc at s and |x - c(s)| - r away from
//! it, or in it. The same holds at a round end, for its ball, and at a flat end of whose plane x is
//! not ahead: there s is an end only if x is in its plane. And as s is the nearest place, any point
//! q of the centreline will do as a bound: x is at most |x - q| - r away.
//!
//! What remains is an x ahead of a flat face whose centre is the nearest place. Then, and whenever
//! it is nearer, the face itself decides: x is h ahead and p across of its centre, and hypot(h,
//! max(0, p - r)) away. If q is nearer to x than the face's centre, that centre is not the nearest
//! place.
//!
//! Where the centreline leads back to x, though, the discs around q may be nearer than the face,
//! even if the face's centre is nearer than q. Then some place between the two is farther from x
//! than q. From that place on, the rest of the section has no such face, and all of the above holds
//! for it.
//!
//! A ball at a round end is cut off by the section's own face, should it stick out of that. So
//! where both are near, x must also be nearer to q than to the round end, or else behind the face:
//! then the way from x to the ball is, too.
//!
//! **Of a part of a section**, whose ends are anywhere in it, the nearest place is not one of these
//! ends if on the way to it some place is farther from x than q. Of the part up to there, all of
//! the above holds.
//!
//! q is known to the deviation of the curve from its samples, and a face's normal to its tilt,
//! which moves a rim by r times that. Of a face whose normal is not known the centre is in the
//! tube, at least.

use super::placed_tube::PlacedTube;
use crate::robot::{Section, length};
use parry3d_f64::math::{Real, Vector};

/// How many places between a face and a place are tried, each half as far from the latter as the
/// one before.
const MAX_TRIALS: u32 = 6;

/// A point of the tube near a point of the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TubePoint {
    /// The tube is at most this far from the point of the mesh.
    pub upper: Real,
    pub arc: Real,
    pub point: Vector,
}

impl PlacedTube<'_> {
    /// How near `x` is to a section at most, looking from an arc length nearby.
    pub(crate) fn near(&self, number: u32, arc: Real, x: Vector) -> TubePoint {
        if self.tube.is_loose() {
            return self.near_links(number, arc, x);
        }
        self.near_between(number, arc, x, [None; 2])
    }

    /// The same of the part of a section between two arc lengths, where it does not go to an end.
    /// Infinity is the answer if the nearest place may be one of these two.
    pub(super) fn near_between(
        &self,
        number: u32,
        arc: Real,
        x: Vector,
        limits: [Option<Real>; 2],
    ) -> TubePoint {
        let section = self.section(number);
        let rounding = self.tube.error() + self.slack;
        let foot = self.tube.foot(section, arc, self.pose.inverse_transform_point(x));
        let [a, b] = foot.between.map(|point| self.pose * point);
        let place = a + (b - a) * foot.share;
        let way = place - x;
        let away = way.length();
        let reach = away + foot.off + rounding;
        let mut best = TubePoint { upper: Real::INFINITY, arc: foot.arc, point: x };
        let mut is_beside = true;
        for (end, limit) in limits.into_iter().enumerate() {
            let Some(limit) = limit else { continue };
            let is_within = if end == 0 { limit <= foot.arc } else { foot.arc <= limit };
            if !is_within || !self.recedes_between(section, [foot.arc, limit], x, reach + rounding)
            {
                return best;
            }
        }
        for (end, face) in self.all_faces(section).iter().enumerate() {
            let Some(face) = face.as_ref().filter(|_| limits[end].is_none()) else { continue };
            let face = self.face(face);
            let offset = x - face.centre;
            let ahead = offset.dot(face.outward);
            let from_centre = offset.length();
            let is_behind = ahead + from_centre * face.tilt + rounding <= 0.0;
            let crowded = self.distance_to_overhanging_cap(section, 1 - end, x);
            if is_behind || reach < from_centre.min(crowded) - rounding {
                continue;
            }
            let face_arc = if end == 0 { section.start } else { section.end };
            if reach < crowded - rounding
                && self.recedes_between(section, [foot.arc, face_arc], x, reach + rounding)
            {
                continue;
            }
            is_beside = false;
            let across = offset - face.outward * ahead;
            let size = across.length();
            let rim = length(Vector::new(ahead, (size - section.radius).max(0.0), 0.0))
                + section.radius * face.tilt;
            // However the face is turned, its centre is there, and the place. (The tilt may be
            // infinite, and times 0 NaN.)
            let beside = away + foot.off;
            let least = if rim <= from_centre { rim } else { from_centre }.min(beside);
            let upper = least + rounding;
            if upper < best.upper {
                best = TubePoint { upper, arc: face_arc, point: face.centre };
                if least == beside {
                    best = TubePoint { upper, arc: foot.arc, point: place };
                } else if least == rim {
                    let share = if size > section.radius { section.radius / size } else { 1.0 };
                    best.point = face.centre + across * share;
                }
            }
        }
        if is_beside {
            // What is not known is no touch.
            let upper =
                if reach.is_nan() { Real::INFINITY } else { (reach - section.radius).max(0.0) };
            let point = if upper > 0.0 { x + way * (upper / away).min(1.0) } else { x };
            best = TubePoint { upper, arc: foot.arc, point };
        }
        best
    }

    /// Whether the centreline is seen to be farther from `x` than `least` somewhere between two arc
    /// lengths, near the first if not farther on.
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
                // The curve may be so far from the tick.
                let off = self.tube.bound(section, [tick - 1, tick + 1]).off;
                if (self.point(section, tick) - x).length() > least + off {
                    return true;
                }
            }
            step *= 0.5;
        }
        false
    }

    /// How far a round end is from `x`, if its ball may stick out of the face at the section's
    /// other end.
    fn distance_to_overhanging_cap(&self, section: &Section, end: usize, x: Vector) -> Real {
        if section.faces[end].is_some()
            || section.end - section.start > section.room(1 - end) * section.stretch
        {
            return Real::INFINITY;
        }
        let tick = if end == 0 { section.first } else { section.last };
        (self.point(section, tick) - x).length()
    }
}
