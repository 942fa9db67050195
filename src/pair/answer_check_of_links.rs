//! Whether an answer is about two links as they are now. The robots may have moved since, or they
//! may be others.

use super::answer_check::ROUNDED;
use super::placed_link::PlacedLink;
use crate::answer::{ProximityError, RobotProximity};
use parry3d_f64::math::{Real, Vector};

impl RobotProximity {
    /// Whether this answer is that of these two links: each point lies in its link, and both the
    /// way between them and that between the links are as long as `distance`.
    ///
    /// # Errors
    /// It is not.
    pub(super) fn check_answer(&self, links: [PlacedLink; 2]) -> Result<(), ProximityError> {
        let [first, second] = &links;
        let measured = first.measure_link(second);
        // Every query gives what is measured, bit for bit.
        if self.distance == measured.distance
            && self.on_first == measured.on_first
            && self.on_second == measured.on_second
        {
            return Ok(());
        }
        let far = links.iter().flat_map(|link| [link.start(), link.end()]);
        let far = far.fold(0.0, |most: Real, point| most.max(point.abs().max_element()));
        let reach = far + first.radius().max(second.radius());
        // The extent is at most as far as the links reach on either side.
        let limit = ROUNDED * (far + 2.0 * reach);
        let check = |field, off: Real| {
            // Written so that NaN does not fit.
            if off <= limit {
                return Ok(());
            }
            Err(ProximityError::LinksDoNotFit { links: self.links, field, off, limit })
        };
        let points = [self.on_first, self.on_second];
        for ((field, point), link) in ["on_first", "on_second"].into_iter().zip(points).zip(&links)
        {
            // What is farther out than any link can neither overflow below, nor be measured.
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
