//! Two links of robots: their distance within a bound, their flat faces and their axes; the answer
//! of a measured pair, and whether an answer belongs to two links as they are now.

use super::answer_check::{ROUNDED, check_reach, check_within};
use super::coordinates::BOUND_ROUNDING;
use super::placed_link::PlacedLink;
use super::two_links::NearestOfLinks;
use crate::answer::{PairWitness, ProximityError, RobotProximity};
use crate::distance::{Link, Scalar, TwoLinks, Vec3, single};
use parry3d_f64::math::{Real, Vector};

impl NearestOfLinks {
    /// Returns the same result with the links exchanged.
    pub(crate) fn swapped(self) -> Self {
        Self { on_first: self.on_second, on_second: self.on_first, ..self }
    }

    /// Returns the answer about two links with these indices.
    pub(crate) fn answer(
        &self,
        links: [usize; 2],
        [first, second]: [&PlacedLink; 2],
    ) -> RobotProximity {
        let Self { distance, on_first, on_second } = *self;
        let arc_lengths = [first.arc_length_of(on_second), second.arc_length_of(on_first)];
        RobotProximity {
            links: links.map(|link| link as u32),
            distance,
            witness: PairWitness { on_first, on_second, arc_lengths },
        }
    }
}

impl PlacedLink {
    /// Returns the closest points of the flat face at an end of this link and another link.
    ///
    /// A link whose length underflows beside the other has no direction: it is measured whole.
    pub(crate) fn face_to_link(&self, end: usize, other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        let has_direction = pair.first.axis.norm_squared() > 0.0;
        let closest = if has_direction {
            pair.closest_to_cap(end_of(&pair.first, end), |mask| mask)
        } else {
            single::two_links(&pair, &pair.axes())
        };
        self.nearest_of_links(unit, &closest)
    }

    /// Returns the closest points of the flat faces at one end of each link. A link without a
    /// direction is measured whole.
    pub(crate) fn face_to_face(&self, ends: [usize; 2], other: &Self) -> NearestOfLinks {
        let (pair, unit) = self.with_link(other);
        let [first, second] =
            [pair.first.axis, pair.second.axis].map(|axis| axis.norm_squared() > 0.0);
        if !second {
            return self.face_to_link(ends[0], other);
        }
        if !first {
            return other.face_to_link(ends[1], self).swapped();
        }
        let centres =
            [end_of(&pair.first, ends[0]), pair.second_start + end_of(&pair.second, ends[1])];
        self.nearest_of_links(unit, &pair.closest_caps(centres))
    }

    /// Returns the closest points of two links if they are at most `bound` apart. The capsules
    /// around the links are tested first.
    pub(crate) fn measure_link_within(&self, bound: Real, other: &Self) -> Option<NearestOfLinks> {
        let (pair, unit) = self.with_link(other);
        let axes = pair.axes();
        if capsules_apart(&pair, axes.gap.norm()) * unit > bound {
            return None;
        }
        let nearest = self.nearest_of_links(unit, &single::two_links(&pair, &axes));
        (nearest.distance <= bound).then_some(nearest)
    }

    /// Returns whether the capsules around two links may be at most `bound` apart.
    pub(crate) fn may_be_within(&self, bound: Real, other: &Self) -> bool {
        let (pair, unit) = self.with_link(other);
        capsules_apart(&pair, pair.axes().gap.norm()) * unit <= bound
    }

    /// Returns the closest points of two axes, and their distance.
    pub(crate) fn nearest_on_axes(&self, other: &Self) -> ([Vector; 2], Real) {
        let (pair, unit) = self.with_link(other);
        let axes = pair.axes();
        let feet = [self.start() + self.along() * axes.s, other.start() + other.along() * axes.t];
        (feet, axes.gap.norm() * unit)
    }
}

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
        let links_of_answer = self.links;
        let check = check_within(limit, |field, off| ProximityError::LinksDoNotFit {
            links: links_of_answer,
            field,
            off,
            limit,
        });
        let points = [self.witness.on_first, self.witness.on_second];
        for ((field, point), link) in ["on_first", "on_second"].into_iter().zip(points).zip(&links)
        {
            check_reach(&check, field, point, link, 2.0 * reach)?;
            let ball = PlacedLink::between(point, point, 0.0, [false; 2]);
            check(field, ball.measure_link(link).distance)?;
        }
        let [from, to] = points.map(|point| PlacedLink::between(point, point, 0.0, [false; 2]));
        check("distance", (from.measure_link(&to).distance - self.distance).abs())?;
        check("distance", (measured.distance - self.distance).abs())
    }
}

/// Returns a lower bound on the distance of the capsules around two links. `axes` is the distance
/// of the axes.
#[inline(always)]
pub(super) fn capsules_apart<T: Scalar>(pair: &TwoLinks<T>, axes: T) -> T {
    axes - pair.first.radius - pair.second.radius - axes.lit(BOUND_ROUNDING)
}

/// Returns an end of a link, relative to its start.
fn end_of(link: &Link<Real>, end: usize) -> Vec3<Real> {
    if end == 0 { Vec3::zero(0.0) } else { link.end }
}
