//! The first hit of a link in straight motion and a triangle, another link or another convex shape:
//! Newton's steps, never late.
//!
//! # Definitions
//! - Neither shape turns. In the link's frame the other shape, the *wall*, moves at v.
//! - `n`: a unit vector from the link to the wall that separates them. `g`: the gap along n.
//! - `e`: the target distance. `s`: time.
//!
//! # Bound
//! After the time s the gap along the same n is `g + s <n, v>`, and the distance is at least that,
//! for every n. So if `g > e`, nothing is within e before `s = (g - e) / -<n, v>`; if
//! `<n, v> >= 0`, nothing ever is.
//!
//! # Algorithm
//! 1. **Measure** the two and take n.
//! 2. **Step** to the bound and repeat. Both shapes are convex, so their distance is a convex
//!    function of time, and these steps are Newton's. They approach from the safe side and never
//!    pass the first root.
//! 3. **Stop** if the distance exceeds the target by at most [`CastWall::TOUCHING`] of the link's
//!    size, or by rounding. The hit is early by at most that much, measured along n.
//!
//! # Contact at the start
//! If g is not above e, n gives no bound: the two touch. If the host does not stop at the start,
//! the contact is ignored if the two part along n, but only if n is known. Close points have no
//! direction between them; a pair that may part or not is held.
//!
//! (parry's cast follows a ray through the difference of the two shapes by tetrahedra. If these
//! have no volume, as for a link beside the flat side of a box, it may panic.)

use super::axial::unit;
use super::link_pair::{LinkPair, links_of_pair};
use super::link_triangle::{self, LinkContact, LinkTrianglePair};
use super::range::{in_range, largest};
use crate::robot::COORDINATE_LIMIT;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    ClosestPoints, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeCastStatus, Unsupported,
};
use parry3d_f64::shape::{Shape, SupportMap};

/// Rounding error of a distance after an advance, relative to the largest coordinate.
const ADVANCE_ROUNDING: Real = 64.0 * Real::EPSILON;
/// Most steps: more than any cast needs. A grazing cast halves its error with each step, others
/// square it.
const MAX_STEPS: usize = 200;

/// A wall that a link may meet, in the link's frame.
trait CastWall {
    /// The share of the smaller shape's size at which the two count as touching.
    const TOUCHING: Real;

    /// Returns the contact with the wall after it has moved by `shift`.
    fn contact(&self, shift: Vector) -> Result<LinkContact, Unsupported>;

    /// Returns where the wall begins along a unit vector, before it has moved.
    fn begins(&self, normal: Vector) -> Real;

    /// Returns the largest coordinate before it has moved.
    fn largest(&self) -> Result<Real, Unsupported>;

    /// Returns length plus radius if the wall is a link; the smaller size of the two counts.
    fn size(&self) -> Real {
        Real::INFINITY
    }
}

/// Returns the first hit of a link and a triangle. The second of the pair moves at `local_vel12` in
/// the frame of the first.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn cast_triangle(
    pair: &LinkTrianglePair,
    pos12: &Pose,
    local_vel12: Vector,
    options: ShapeCastOptions,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let way = WallPath::new(pair.link, pair.link_is_first, pos12, local_vel12);
    let corners = pair.triangle.vertices().map(|vertex| way.pose * vertex);
    way.cast(&TriangleWall { link: pair.link, corners }, options)
}

/// As [`cast_triangle`], for two links, or a link and a shape of parry that is a link; `None` for
/// other pairs.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn cast_link(
    pos12: &Pose,
    local_vel12: Vector,
    (g1, g2): (&dyn Shape, &dyn Shape),
    options: ShapeCastOptions,
) -> Result<Option<Option<ShapeCastHit>>, Unsupported> {
    let Some([first, second]) = links_of_pair(g1, g2) else { return Ok(None) };
    let way = WallPath::new(&first, true, pos12, local_vel12);
    way.cast(&LinkWall { link: &first, wall: second.transformed(pos12) }, options).map(Some)
}

/// As [`cast_triangle`], for a link and any convex shape, in either order; `None` for other pairs.
/// `dispatcher` computes their contacts.
///
/// # Errors
/// [`Unsupported`] for numbers out of range, or if the dispatcher refuses.
pub(super) fn cast_convex(
    dispatcher: &impl QueryDispatcher,
    pos12: &Pose,
    local_vel12: Vector,
    (g1, g2): (&dyn Shape, &dyn Shape),
    options: ShapeCastOptions,
) -> Result<Option<Option<ShapeCastHit>>, Unsupported> {
    for (robot, shape, link_is_first) in [(g1, g2, true), (g2, g1, false)] {
        if let (Some(link), Some(support)) = (robot.as_shape(), shape.as_support_map()) {
            let way = WallPath::new(link, link_is_first, pos12, local_vel12);
            let wall = ConvexWall { dispatcher, link, shape, support, pose: way.pose };
            return way.cast(&wall, options).map(Some);
        }
    }
    Ok(None)
}

/// A triangle.
struct TriangleWall<'a> {
    link: &'a ModifiedCylinder,
    corners: [Vector; 3],
}

impl CastWall for TriangleWall<'_> {
    const TOUCHING: Real = 1e-9;

    fn contact(&self, shift: Vector) -> Result<LinkContact, Unsupported> {
        let moved = self.corners.map(|corner| corner + shift);
        for corner in moved {
            in_range(corner)?;
        }
        link_triangle::contact(self.link, moved).ok_or(Unsupported)
    }

    fn begins(&self, normal: Vector) -> Real {
        self.corners.map(|corner| corner.dot(normal)).into_iter().fold(Real::INFINITY, Real::min)
    }

    fn largest(&self) -> Result<Real, Unsupported> {
        self.corners.into_iter().try_fold(0.0, |most: Real, corner| Ok(most.max(in_range(corner)?)))
    }
}

/// Another link.
struct LinkWall<'a> {
    link: &'a ModifiedCylinder,
    wall: ModifiedCylinder,
}

impl CastWall for LinkWall<'_> {
    const TOUCHING: Real = 1e-9;

    fn contact(&self, shift: Vector) -> Result<LinkContact, Unsupported> {
        let moved = self.wall.transformed(&Pose::from_translation(shift));
        LinkPair::between(self.link, &moved)?.link_contact().ok_or(Unsupported)
    }

    fn begins(&self, normal: Vector) -> Real {
        self.wall.local_support_point_toward(-normal).dot(normal)
    }

    fn size(&self) -> Real {
        self.wall.length() + self.wall.radius()
    }

    fn largest(&self) -> Result<Real, Unsupported> {
        let mut ends = [self.wall.start(), self.wall.end()].into_iter();
        ends.try_fold(self.wall.radius(), |most, end| Ok(most.max(in_range(end)?)))
    }
}

/// A convex shape whose contacts come from iterations.
struct ConvexWall<'a, D> {
    dispatcher: &'a D,
    link: &'a ModifiedCylinder,
    shape: &'a dyn Shape,
    support: &'a dyn SupportMap,
    pose: Pose,
}

impl<D: QueryDispatcher> CastWall for ConvexWall<'_, D> {
    const TOUCHING: Real = 1e-6;

    fn contact(&self, shift: Vector) -> Result<LinkContact, Unsupported> {
        let pose = Pose::from_translation(shift) * self.pose;
        iterated_contact(self.dispatcher, self.link, (self.shape, self.support), &pose)
    }

    fn begins(&self, normal: Vector) -> Real {
        self.support.support_point_toward(&self.pose, -normal).dot(normal)
    }

    fn largest(&self) -> Result<Real, Unsupported> {
        Ok(largest(&self.pose, self.link, self.shape))
    }
}

/// Returns the contact of a link and a convex shape at a pose in the link's frame. In an overlap
/// the distance is at most 0.
///
/// # Errors
/// [`Unsupported`] if the dispatcher refuses.
pub(super) fn iterated_contact(
    dispatcher: &dyn QueryDispatcher,
    link: &ModifiedCylinder,
    (shape, support): (&dyn Shape, &dyn SupportMap),
    pose: &Pose,
) -> Result<LinkContact, Unsupported> {
    let gap = |normal: Vector| {
        (support.support_point_toward(pose, -normal) - link.local_support_point_toward(normal))
            .dot(normal)
    };
    let apart = match dispatcher.closest_points(pose, link, shape, Real::MAX)? {
        ClosestPoints::Disjoint => return Err(Unsupported),
        ClosestPoints::Intersecting => None,
        ClosestPoints::WithinMargin(on_link, on_wall) => {
            let on_other = pose * on_wall;
            unit(on_other - on_link).map(|normal| {
                let distance = (on_other - on_link).dot(normal);
                LinkContact { distance, on_link, on_other, normal }
            })
        }
    };
    if let Some(apart) = &apart
        && gap(apart.normal) > 0.5 * apart.distance
    {
        return Ok(*apart);
    }
    // They overlap, or rounding has turned the direction between their close points.
    let contact = dispatcher.contact(pose, link, shape, Real::MAX)?.map(|contact| LinkContact {
        distance: if apart.is_some() { contact.dist } else { contact.dist.min(0.0) },
        on_link: contact.point1,
        on_other: pose * contact.point2,
        normal: contact.normal1,
    });
    let start = link.start();
    // If the two queries disagree on whether the shapes meet, they touch; the direction is unknown.
    let touch = LinkContact { distance: 0.0, on_link: start, on_other: start, normal: Vector::X };
    Ok(match (contact, apart) {
        (Some(contact), Some(apart)) if gap(contact.normal) < gap(apart.normal) => apart,
        (Some(contact), _) => contact,
        (None, apart) => apart.unwrap_or(touch),
    })
}

/// A link and the path of a wall, in the link's frame.
struct WallPath<'a> {
    link: &'a ModifiedCylinder,
    link_is_first: bool,
    /// The wall's pose.
    pose: Pose,
    velocity: Vector,
}

impl<'a> WallPath<'a> {
    fn new(
        link: &'a ModifiedCylinder,
        link_is_first: bool,
        pos12: &Pose,
        local_vel12: Vector,
    ) -> Self {
        if link_is_first {
            return Self { link, link_is_first, pose: *pos12, velocity: local_vel12 };
        }
        let pose = pos12.inverse();
        Self { link, link_is_first, pose, velocity: -(pose.rotation * local_vel12) }
    }

    /// Steps 1 to 3: returns the first hit.
    fn cast<W: CastWall>(
        &self,
        wall: &W,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        // A negative time admits no hit, not even an immediate one.
        if options.max_time_of_impact < 0.0 {
            return Ok(None);
        }
        let (link, velocity) = (self.link, self.velocity);
        let (mut time, mut status) = (0.0, ShapeCastStatus::OutOfIterations);
        let largest = link.radius().max(wall.largest()?);
        let size = wall.size().min(link.length() + link.radius());
        let mut contact = finite(wall.contact(Vector::ZERO)?)?;
        for step in 0..MAX_STEPS {
            let normal = contact.normal;
            let closing = -normal.dot(velocity);
            let excess = contact.distance - options.target_distance;
            let shift = velocity * time;
            let begins = wall.begins(normal) + shift.dot(normal);
            let gap = begins - link.local_support_point(normal).dot(normal);
            let ahead = gap.min(contact.distance) - options.target_distance;
            let (rounding, touching) = (self.rounding(largest, shift)?, W::TOUCHING * size);
            if step == 0 && (excess <= 0.0 || ahead <= rounding) {
                let is_known =
                    contact.distance < 0.0 || gap >= contact.distance - touching - rounding;
                let may_go = if options.stop_at_penetration {
                    excess > 0.0 && ahead > 0.0
                } else {
                    is_known
                };
                if may_go && closing <= 0.0 {
                    return Ok(None);
                }
                // As in parry, a pair that just touches is not within the distance.
                status = if excess < 0.0 {
                    ShapeCastStatus::PenetratingOrWithinTargetDist
                } else {
                    ShapeCastStatus::Converged
                };
                break;
            }
            if step > 0 && excess <= touching + rounding || ahead <= rounding {
                status = ShapeCastStatus::Converged;
                break;
            }
            let next = time + ahead / closing;
            // Written so that NaN, which arises only without motion, is never. A wall that would
            // have to come from beyond the range of both shapes never arrives either.
            let may_meet = closing > 0.0
                && next <= options.max_time_of_impact
                && is_within_reach(velocity * next);
            if !may_meet || self.has_passed(wall, velocity * next, options.target_distance, largest)
            {
                return Ok(None);
            }
            if next <= time {
                status = ShapeCastStatus::Converged;
                break;
            }
            time = next;
            contact = finite(wall.contact(velocity * time)?)?;
        }
        Ok(Some(self.hit(contact, time, status)))
    }

    /// Returns whether the wall, moved by `shift`, has passed the link for good; until then the
    /// link was clear. (A velocity almost parallel to the plane between the two leads far away,
    /// where iterations are meaningless.)
    fn has_passed<W: CastWall>(
        &self,
        wall: &W,
        shift: Vector,
        target: Real,
        largest: Real,
    ) -> bool {
        let Some(way) = unit(self.velocity) else { return false };
        let passed =
            wall.begins(way) + shift.dot(way) - self.link.local_support_point(way).dot(way);
        let places = [shift, self.link.start(), self.link.end()].into_iter();
        let largest = places.map(|place| place.abs().max_element()).fold(largest, Real::max);
        passed > target.max(0.0) + ADVANCE_ROUNDING * largest
    }

    /// Returns the rounding error of a distance after the wall has moved. `largest` is the wall's
    /// largest coordinate.
    fn rounding(&self, mut largest: Real, shift: Vector) -> Result<Real, Unsupported> {
        for place in [shift, self.link.start(), self.link.end()] {
            largest = largest.max(in_range(place)?);
        }
        Ok(ADVANCE_ROUNDING * largest)
    }

    fn hit(&self, contact: LinkContact, time: Real, status: ShapeCastStatus) -> ShapeCastHit {
        // The wall does not turn.
        let to_wall = self.pose.rotation.inverse();
        let shift = self.velocity * time;
        let hit = ShapeCastHit {
            time_of_impact: time,
            witness1: contact.on_link,
            witness2: to_wall * (contact.on_other - shift - self.pose.translation),
            normal1: contact.normal,
            normal2: to_wall * -contact.normal,
            status,
            subshape1: 0,
            subshape2: 0,
        };
        if self.link_is_first { hit } else { hit.swapped() }
    }
}

/// Returns whether a wall moved by `shift` can meet a link at all. The wall's coordinates are
/// within the limit, and a link extends to at most twice the limit.
fn is_within_reach(shift: Vector) -> bool {
    shift.abs().max_element() <= 4.0 * COORDINATE_LIMIT
}

fn finite(contact: LinkContact) -> Result<LinkContact, Unsupported> {
    if contact.distance.is_finite() && contact.normal.is_finite() {
        Ok(contact)
    } else {
        Err(Unsupported)
    }
}
