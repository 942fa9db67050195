//! Checks whether an answer belongs to two links as they are now. The robots may have moved since,
//! or may be other robots.

use super::answer_check::ROUNDED;
use super::placed_link::PlacedLink;
use crate::answer::{ProximityError, RobotProximity};
use parry3d_f64::math::{Real, Vector};

impl RobotProximity {
    /// Checks this answer against two links: each point lies in its link, and `distance` is the
    /// distance both of the two points and of the two links.
    ///
    /// # Errors
    /// The answer does not fit.
    pub(super) fn check_answer(&self, links: [PlacedLink; 2]) -> Result<(), ProximityError> {
        let [first, second] = &links;
        let measured = first.measure_link(second);
        // Every query returns the measured result, bit for bit.
        if self.distance == measured.distance
            && self.witness.on_first == measured.on_first
            && self.witness.on_second == measured.on_second
        {
            return Ok(());
        }
        let far = links.iter().flat_map(|link| [link.start(), link.end()]);
        let far = far.fold(0.0, |most: Real, point| most.max(point.abs().max_element()));
        let reach = far + first.radius().max(second.radius());
        // The extent is at most the reach of the links on either side.
        let limit = ROUNDED * (far + 2.0 * reach);
        let check = |field, off: Real| {
            // Written so that NaN does not fit.
            if off <= limit {
                return Ok(());
            }
            Err(ProximityError::LinksDoNotFit { links: self.links, field, off, limit })
        };
        let points = [self.witness.on_first, self.witness.on_second];
        for ((field, point), link) in ["on_first", "on_second"].into_iter().zip(points).zip(&links)
        {
            // Points beyond the reach of the links are refused here: measuring them could overflow.
            if !point.abs().cmple(Vector::splat(2.0 * reach)).all() {
                check(field, (point - link.start()).abs().max_element())?;
            }
            let ball = PlacedLink::between(point, point, 0.0, [false; 2]);
            check(field, ball.measure_link(link).distance)?;
        }
        let [from, to] = points.map(|point| PlacedLink::between(point, point, 0.0, [false; 2]));
        check("distance", (from.measure_link(&to).distance - self.distance).abs())?;
        check("distance", (measured.distance - self.distance).abs())
    }
}
