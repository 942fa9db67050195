//! An upper bound on the distance of a point of the mesh from a loose tube.
//!
//! # Definitions
//! - **Loose** tube: only its places are known. Its centreline is smooth and follows links to
//!   within the deviation e, place by place. Its discs are perpendicular to the centreline, in an
//!   unknown direction.
//! - x: the point of the mesh. q: a point of a link. d = |x - q|.
//! - **Run**: the links around q that share one radius r.
//!
//! # Claim
//! The distance of x from the tube is at most
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
use super::tube_point::TubePoint;
use parry3d_f64::math::{Real, Vector};

impl PlacedTube<'_> {
    /// As [`PlacedTube::near`], for a loose tube.
    pub(super) fn near_links(&self, number: u32, arc: Real, x: Vector) -> TubePoint {
        let section = self.section(number);
        let rounding = self.tube.error() + self.slack;
        let foot = self.tube.foot(section, arc, self.pose.inverse_transform_point(x));
        let [a, b] = foot.between.map(|point| self.pose * point);
        let place = a + (b - a) * foot.share;
        let way = place - x;
        let away = way.length();
        let reach = away + rounding;
        if [0, 1].into_iter().all(|end| self.is_before_end(number, end, x, reach + rounding)) {
            // NaN means unknown, not contact.
            let upper =
                if reach.is_nan() { Real::INFINITY } else { (reach - section.radius).max(0.0) };
            let point = if upper > 0.0 { x + way * (upper / away).min(1.0) } else { x };
            return TubePoint { upper, arc: foot.arc, point };
        }
        TubePoint { upper: reach, arc: foot.arc, point: place }
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
