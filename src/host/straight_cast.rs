//! When a link that moves straight meets a triangle, another link or another convex shape: Newton's
//! steps, never late.
//!
//! Neither of the two turns. In the link's frame the other, the *wall*, moves at v; n is a unit
//! vector from the link to the wall that separates them, and g the gap between them along it. After
//! a time s the gap along the same n is g + s <n, v>, and the distance at least that, whatever n
//! is. So where g > e nothing is within the target distance e before s = (g - e) / -<n, v>, and
//! nothing ever is if <n, v> >= 0. There the two are measured again. Both are convex, hence so is
//! their distance as a function of time, of which these steps are Newton's: they come from the safe
//! side and do not pass the first root.
//!
//! Where g is not above e, n says nothing: the two touch. At the start, and if the host does not
//! stop there, they are let go when they part along n; but only if n is known. Points that are
//! close to one another have no direction between them, and two that may part or not are held.
//!
//! They end where the distance is above the target by no more than the wall's
//! [`CastWall::TOUCHING`] of the link's size, or by rounding: the hit is that much early at most,
//! measured along n.
//!
//! (parry's cast follows a ray through the difference of the two shapes by tetrahedra. Where these
//! have no volume, as with a link beside the flat side of a box, it may panic.)

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

/// What rounding leaves of the largest coordinate.
const ROUNDING: Real = 64.0 * Real::EPSILON;
/// More than any cast takes: a grazing one halves its error with each step, others square it.
const MAX_STEPS: usize = 200;

/// What a link may meet, in the link's frame.
trait CastWall {
    /// The share of the smaller link's size at which it counts as touching.
    const TOUCHING: Real;

    /// The contact with the wall after it has moved.
    fn contact(&self, shift: Vector) -> Result<LinkContact, Unsupported>;

    /// Where the wall begins along a unit vector before it has moved.
    fn begins(&self, normal: Vector) -> Real;

    /// The largest coordinate before it has moved.
    fn largest(&self) -> Result<Real, Unsupported>;

    /// Its length and radius where it is a link, of which the smaller of both counts.
    fn size(&self) -> Real {
        Real::INFINITY
    }
}

/// The first hit of a link and a triangle, of which the second of the pair moves at `local_vel12`
/// in the frame of the first.
///
/// # Errors
/// [`Unsupported`] for what is out of range.
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

/// The same of two links, or a link and a shape of parry's that is a link. Nothing if the shapes
/// are no such pair.
///
/// # Errors
/// [`Unsupported`] for what is out of range.
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

/// The same of a link and a convex shape of any kind, in either order. Nothing if the shapes are no
/// such pair. `dispatcher` gives their contacts.
///
/// # Errors
/// [`Unsupported`] for what is out of range or refused by the dispatcher.
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

/// The contact of a link and a convex shape at a pose in the link's frame. Where they overlap the
/// distance is 0 or less.
///
/// # Errors
/// [`Unsupported`] for what the dispatcher refuses.
pub(super) fn iterated_contact(
    dispatcher: &impl QueryDispatcher,
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
    // They overlap, or are so close that rounding has turned the way between their points.
    let contact = dispatcher.contact(pose, link, shape, Real::MAX)?.map(|contact| LinkContact {
        distance: if apart.is_some() { contact.dist } else { contact.dist.min(0.0) },
        on_link: contact.point1,
        on_other: pose * contact.point2,
        normal: contact.normal1,
    });
    let start = link.start();
    // Where the one says that they meet and the other does not, they touch; nobody knows along
    // what.
    let touch = LinkContact { distance: 0.0, on_link: start, on_other: start, normal: Vector::X };
    Ok(match (contact, apart) {
        (Some(contact), Some(apart)) if gap(contact.normal) < gap(apart.normal) => apart,
        (Some(contact), _) => contact,
        (None, apart) => apart.unwrap_or(touch),
    })
}

/// A link and the way of a wall, in the link's frame.
struct WallPath<'a> {
    link: &'a ModifiedCylinder,
    link_is_first: bool,
    /// The wall's.
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

    fn cast<W: CastWall>(
        &self,
        wall: &W,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        // Not even what touches at once comes in a time that has passed.
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
                // As parry has it, what just touches is not within.
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
            // Written so that NaN, which only comes of what does not move, is never. Nor is
            // anything met that would have to come from beyond the range of both.
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

    /// Whether the wall, moved so far, has the link behind it for good. Until then it was clear. (A
    /// velocity that is all but along the plane between the two leads far away, where
    /// iterations tell nothing any more.)
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
        passed > target.max(0.0) + ROUNDING * largest
    }

    /// What rounding can do to a distance after the wall, whose largest coordinate is given, has
    /// moved.
    fn rounding(&self, mut largest: Real, shift: Vector) -> Result<Real, Unsupported> {
        for place in [shift, self.link.start(), self.link.end()] {
            largest = largest.max(in_range(place)?);
        }
        Ok(ROUNDING * largest)
    }

    fn hit(&self, contact: LinkContact, time: Real, status: ShapeCastStatus) -> ShapeCastHit {
        // The wall's own frame does not turn.
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

/// Whether a wall that is moved so far can meet a link at all: the wall's coordinates are within
/// the limit, and a link reaches to twice the limit.
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
