//! How near a point of the mesh is at most to a tube of which only the places are known.
//!
//! The tube's centreline is smooth and within the deviation e of links, place by place. Its discs
//! stand across it, whichever way that is. Let q be a point of a link, and x be |x - q| = d away.
//! The tube's own place is within e of q, and the centre of a disc: the tube is at most d + e away
//! from x.
//!
//! Often it is nearer by its radius. Take the run of links with one radius to which q belongs.
//! Where the run's centreline is nearest to x inside, x is in the plane of the disc there, and d +
//! e - r away or in it. At an end of the run it is nearest only if that end is no farther from x
//! than q's own place, so not if the end of the links is more than d + 2 e away. Nor does an end
//! matter if some place of the run between q and it is farther from x than that: of the part of the
//! run up to there, the nearest place is inside or at the other end.

use super::placed_tube::PlacedTube;
use super::tube_point::TubePoint;
use parry3d_f64::math::{Real, Vector};

impl PlacedTube<'_> {
    /// The same as [`PlacedTube::near`] for a loose tube.
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
            // What is not known is no touch.
            let upper =
                if reach.is_nan() { Real::INFINITY } else { (reach - section.radius).max(0.0) };
            let point = if upper > 0.0 { x + way * (upper / away).min(1.0) } else { x };
            return TubePoint { upper, arc: foot.arc, point };
        }
        TubePoint { upper: reach, arc: foot.arc, point: place }
    }

    /// Whether a run of links with one radius is farther than `least` from `x` somewhere from a
    /// link on to that end.
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
