//! When a link that moves straight meets a triangle: Newton's steps, never late.
//!
//! Neither of the two turns. In the link's frame the triangle moves at v; n is a unit vector from the link to the triangle
//! that separates them, and g the gap between them along it. After a time s the gap along the same n is g + s <n, v>, and
//! the distance at least that, whatever n is. So nothing is within the target distance e before s = (g - e) / -<n, v>,
//! and nothing ever is if <n, v> >= 0. There the two are measured again. Both are convex, hence so is their distance as a
//! function of time, of which these steps are Newton's: they come from the safe side and do not pass the first root.
//!
//! They end where the distance is above the target by no more than [`TOUCHING`] of the link's size, or by rounding: the
//! hit is that much early at most, measured along n.

use super::link_triangle::{self, LinkContact, LinkTriangle};
use super::range::in_range;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ShapeCastHit, ShapeCastOptions, ShapeCastStatus, Unsupported};
use parry3d_f64::shape::SupportMap;

/// The share of a link's size at which it counts as touching.
const TOUCHING: Real = 1e-9;
/// What rounding leaves of the largest coordinate.
const ROUNDING: Real = 64.0 * Real::EPSILON;
/// More than any cast takes: a grazing one halves its error with each step, others square it.
const MOST_STEPS: usize = 200;

/// The first hit of a link and a triangle, of which the second of the pair moves at `local_vel12` in the frame of the
/// first.
///
/// # Errors
/// [`Unsupported`] for what is out of range.
pub(super) fn cast(
    pair: &LinkTriangle,
    pos12: &Pose,
    local_vel12: Vector,
    options: ShapeCastOptions,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let (pose, velocity) = if pair.link_is_first {
        (*pos12, local_vel12)
    } else {
        let pose = pos12.inverse();
        (pose, -(pose.rotation * local_vel12))
    };
    let link = pair.link;
    let corners = pair.triangle.vertices().map(|vertex| pose * vertex);
    let (mut time, mut status) = (0.0, ShapeCastStatus::OutOfIterations);
    let mut moved = corners;
    let mut contact = at(pair, moved)?;
    for step in 0..MOST_STEPS {
        let closing = -contact.normal.dot(velocity);
        let excess = contact.distance - options.target_distance;
        if step == 0 && excess <= 0.0 {
            if !options.stop_at_penetration && closing <= 0.0 {
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
        if step > 0 && excess <= touching(pair, corners, velocity * time)? {
            status = ShapeCastStatus::Converged;
            break;
        }
        let nearest =
            moved.map(|corner| corner.dot(contact.normal)).into_iter().fold(Real::INFINITY, Real::min);
        let gap = nearest - link.local_support_point(contact.normal).dot(contact.normal);
        let next = time + (gap.min(contact.distance) - options.target_distance) / closing;
        // Written so that NaN, which only comes of what does not move, is never.
        let may_meet = closing > 0.0 && next <= options.max_time_of_impact;
        if !may_meet {
            return Ok(None);
        }
        if next <= time {
            status = ShapeCastStatus::Converged;
            break;
        }
        time = next;
        moved = corners.map(|corner| corner + velocity * time);
        contact = at(pair, moved)?;
    }
    Ok(Some(hit(pair, &pose, velocity * time, contact, time, status)))
}

/// The contact with the triangle of these corners, in the link's frame.
fn at(pair: &LinkTriangle, corners: [Vector; 3]) -> Result<LinkContact, Unsupported> {
    for corner in corners {
        in_range(corner)?;
    }
    let contact = link_triangle::contact(pair.link, corners).ok_or(Unsupported)?;
    if contact.distance.is_finite() && contact.normal.is_finite() { Ok(contact) } else { Err(Unsupported) }
}

/// What the distance may exceed the target by and still count.
fn touching(pair: &LinkTriangle, corners: [Vector; 3], shift: Vector) -> Result<Real, Unsupported> {
    let link = pair.link;
    let mut largest = link.radius();
    for place in corners.into_iter().chain([shift, link.start(), link.end()]) {
        largest = largest.max(in_range(place)?);
    }
    Ok(TOUCHING * (link.length() + link.radius()) + ROUNDING * largest)
}

fn hit(
    pair: &LinkTriangle,
    pose: &Pose,
    shift: Vector,
    contact: LinkContact,
    time: Real,
    status: ShapeCastStatus,
) -> ShapeCastHit {
    // The triangle's own frame does not turn.
    let to_triangle = pose.rotation.inverse();
    let hit = ShapeCastHit {
        time_of_impact: time,
        witness1: contact.on_link,
        witness2: to_triangle * (contact.on_triangle - shift - pose.translation),
        normal1: contact.normal,
        normal2: to_triangle * -contact.normal,
        status,
        subshape1: 0,
        subshape2: 0,
    };
    if pair.link_is_first { hit } else { hit.swapped() }
}
