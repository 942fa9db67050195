//! Checks whether an answer belongs to a link and a triangle as they are now. The mesh may have
//! moved since, or may be another mesh.

use super::nearest::Nearest;
use super::placed_link::PlacedLink;
use crate::answer::{LinkProximity, ProximityError};
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// The tolerance, relative to the largest coordinate plus the extent.
///
/// In the pair's own coordinates a distance and its two points err by at most 16 u of the extent;
/// the largest measured error is 4.4 u. Each point is then rounded to the mesh's frame, by u of its
/// largest coordinate, so by less than 2 u of it in length. An answer that was written as text and
/// read again may be off by the same amount once more.
pub(super) const ROUNDED: Real = 16.0 * f64::UNIT_ROUNDOFF;

impl LinkProximity {
    /// Checks this answer against a link and a triangle: `on_robot` lies in the link, `on_mesh`
    /// lies on the triangle, and `distance` is the distance both of the two points and of the two
    /// shapes.
    ///
    /// # Errors
    /// The answer does not fit.
    pub(crate) fn check_answer(
        &self,
        link: &PlacedLink,
        corners: [Vector; 3],
    ) -> Result<(), ProximityError> {
        self.check_answer_of(&link.measure(self.witness.triangle, corners), || *link, corners)
    }

    /// Same as [`check_answer`](Self::check_answer), for a pair that is measured already.
    ///
    /// # Errors
    /// As [`check_answer`](Self::check_answer).
    #[inline(always)]
    pub(crate) fn check_answer_of(
        &self,
        measured: &Nearest,
        link: impl FnOnce() -> PlacedLink,
        corners: [Vector; 3],
    ) -> Result<(), ProximityError> {
        // Every engine returns the measured result, bit for bit.
        let is_that = self.distance == measured.distance
            && self.witness.on_mesh == measured.on_mesh
            && self.witness.on_robot == measured.on_robot;
        if is_that {
            Ok(())
        } else {
            self.check_rounded_answer(measured.distance, &link(), corners)
        }
    }

    /// Same as [`check_answer`](Self::check_answer), for an answer that was rounded or computed in
    /// another way.
    #[cold]
    fn check_rounded_answer(
        &self,
        measured: Real,
        link: &PlacedLink,
        corners: [Vector; 3],
    ) -> Result<(), ProximityError> {
        let (distance, on_robot, on_mesh) =
            (self.distance, self.witness.on_robot, self.witness.on_mesh);
        let [a, b, c] = corners;
        let points = [link.start(), link.end(), a, b, c];
        let largest =
            points.iter().fold(0.0, |most: Real, point| most.max(point.abs().max_element()));
        let limit = ROUNDED * (largest + link.extent_with(corners));
        let check = |field, off: Real| {
            // Written so that NaN does not fit.
            if off <= limit {
                return Ok(());
            }
            let (link, triangle) = (self.link as usize, self.witness.triangle as usize);
            Err(ProximityError::AnswerDoesNotFit { link, triangle, field, off, limit })
        };
        // Points beyond the reach of link and triangle are refused here: measuring them could
        // overflow.
        let reach = 2.0 * (largest + link.radius());
        for (field, point) in [("on_mesh", on_mesh), ("on_robot", on_robot)] {
            if !point.abs().cmple(Vector::splat(reach)).all() {
                check(field, (point - link.start()).abs().max_element())?;
            }
        }
        let ball = PlacedLink::between(on_mesh, on_mesh, 0.0, [false; 2]);
        check("on_mesh", ball.measure(0, corners).distance)?;
        check("on_robot", link.measure(0, [on_robot; 3]).distance)?;
        check("distance", (ball.measure(0, [on_robot; 3]).distance - distance).abs())?;
        check("distance", (measured - distance).abs())
    }
}
