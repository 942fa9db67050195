//! The first hit of a moving link and a moving convex shape: conservative advancement, never late.
//!
//! # Algorithm
//! Both shapes move and turn at constant speeds. The other shape is called the *wall*.
//!
//! 1. **Plane.** While the two are apart, their contact gives a plane between them that touches the
//!    wall. It moves and turns with the wall, which always stays behind it.
//! 2. **Advance.** [`plane_gap`](super::plane_gap) proves for how long both ends of the link stay
//!    on their side of the plane. For that time the link is clear.
//! 3. **Repeat** from the new placement. Close to each other the steps are Newton's, from the safe
//!    side. Stop if the distance is at most [`TOUCHING`] of the size, or rounding.
//!
//! (parry's cast bisects for a root along a direction, which need not be the first root. Its
//! tolerances cannot be met at late times, where it does not return.)
//!
//! # Contacts at the start
//! A host that does not stop at the start needs the time at which the link would pass through the
//! wall: rapier does this for fast bodies, and ignores a hit at the very start. So the link's
//! *core* is cast: the inside of its axis, enlarged by half of its distance to the wall. The core
//! is clear at the start, unless the link has passed through already. When the core meets the wall,
//! half of that distance is left. (parry's cast reports that the link is held at the start, which
//! frees it: it then passes a mesh with the end that did not touch.)
//!
//! # Sweeps of a physics engine
//! A solver lets bodies overlap by its allowed error without an impulse. If a sweep stopped there,
//! a body that slides along a wall, or even leaves it, would stop at each step and hang in the air.
//! So a [`StartContact::Skin`] cast ignores the link's outermost layer, its *skin*:
//!
//! 1. The link without its skin is cast, if that is clear at the start by half of the skin.
//! 2. Otherwise the core is cast, if its radius exceeds half of the skin. A link whose axis is
//!    nearer to the wall has passed through.
//!
//! **Claim.** While the solver does not push a link away from a wall, casts against that wall stop
//! it in at most six steps. **Proof.** A cast in case 1 stops only after the link has come nearer
//! by half of the skin, and the next step has case 2. Where a cast in case 2 stops, the inside of
//! the axis is as far from the wall as the core's radius, which is at most half of the radius, and
//! half of what that distance was before. So the sixth core has at most 1 / 64 of the radius, less
//! than half of [`SKIN`].

use super::axial::unit;
use super::link_pair::{LinkPair, links_of_pair};
use super::link_triangle::{self, LinkContact, LinkTrianglePair};
use super::plane_gap::{PlaneGap, Reach, Support};
use super::range::in_range;
use super::robot_surface::links_of;
use super::straight_cast::iterated_contact;
use super::support_points::{centre, outward};
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    NonlinearRigidMotion, QueryDispatcher, ShapeCastHit, ShapeCastStatus, Unsupported,
};
use parry3d_f64::shape::{Shape, SupportMap, Triangle};

/// The share of a link's size at which it counts as touching a triangle, a half-space or another
/// link.
const TOUCHING: Real = 1e-9;
/// The same for other shapes, whose contacts come from iterations.
const ITERATED: Real = 1e-5;
/// The thickness of the skin, as a share of the radius. A thinner skin stops more bodies before
/// they touch: they keep the velocity of the whole step and the height of a part of it, so their
/// energy rises. A thicker one lets a robot that is pressed into a wall sink in deeper. Measured
/// with 0.01, 0.05 and 0.25: chains thrown onto a half-space rise by 0.005, 0.0047 and 0.0023
/// lengths; a chain pressed with 100 times its weight sinks in by 0.06, 0.06 and 0.21 radii (a
/// compound by 0.07).
const SKIN: Real = 0.05;
/// Rounding error of a distance in contact, relative to the largest coordinate.
const TOUCH_ROUNDING: Real = 64.0 * Real::EPSILON;
/// Most steps: more than any motion needs, except a grazing one. Then the current time is the
/// answer, which is early and not late.
const MAX_STEPS: usize = 200;

/// Returns the first hit of a link and a convex shape, or of a robot and a half-space, in either
/// order; `None` for other pairs.
///
/// `dispatcher` computes the contacts with walls other than triangles and half-spaces.
///
/// # Errors
/// [`Unsupported`] for numbers that are not finite or out of range, or if the dispatcher refuses.
pub(super) fn cast(
    dispatcher: &dyn QueryDispatcher,
    (motion1, g1): (&NonlinearRigidMotion, &dyn Shape),
    (motion2, g2): (&NonlinearRigidMotion, &dyn Shape),
    (start_time, end_time): (Real, Real),
    start: StartContact,
) -> Result<Option<Option<ShapeCastHit>>, Unsupported> {
    let Some((links, wall, robot_is_first)) = pair(g1, g2)? else { return Ok(None) };
    let (robot, motion) = if robot_is_first { (motion1, motion2) } else { (motion2, motion1) };
    let cast = Cast { dispatcher, robot, wall, motion, start_time, end_time };
    let mut first: Option<ShapeCastHit> = None;
    for (index, link) in links.iter().enumerate() {
        let Some(hit) = cast.of(link, start)? else { continue };
        if first.is_none_or(|first| hit.time_of_impact < first.time_of_impact) {
            first = Some(ShapeCastHit { subshape1: index as u32, ..hit });
        }
    }
    Ok(Some(first.map(|hit| if robot_is_first { hit } else { hit.swapped() })))
}

/// What a cast does with a contact at the start.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum StartContact {
    /// It is the hit.
    Stops,
    /// The core is cast.
    Core,
    /// The link's skin does not count, and the core is cast if that touches.
    Skin,
}

/// The links of the robot, the wall, and whether the robot is first.
type RobotAndWall<'a> = (&'a [ModifiedCylinder], MovingWall<'a>, bool);

fn pair<'a>(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Option<RobotAndWall<'a>>, Unsupported> {
    if let Some(pair) = LinkTrianglePair::of(g1, g2)? {
        let link = std::slice::from_ref(pair.link);
        return Ok(Some((link, MovingWall::Triangle(pair.triangle), pair.link_is_first)));
    }
    for (robot, wall, robot_is_first) in [(g1, g2, true), (g2, g1, false)] {
        let Some(links) = links_of(robot) else { continue };
        if let Some(half_space) = wall.as_halfspace() {
            let normal = unit(half_space.normal).ok_or(Unsupported)?;
            return Ok(Some((links, MovingWall::HalfSpace(normal), robot_is_first)));
        }
        if let (Some(link), Some([_, other])) = (robot.as_shape(), links_of_pair(robot, wall)) {
            return Ok(Some((std::slice::from_ref(link), MovingWall::Link(other), robot_is_first)));
        }
        if let (Some(link), Some(support)) = (robot.as_shape(), wall.as_support_map()) {
            return Ok(Some((
                std::slice::from_ref(link),
                MovingWall::Convex(wall, support),
                robot_is_first,
            )));
        }
    }
    Ok(None)
}

/// Returns the link without its outermost layer.
fn without_skin(link: &ModifiedCylinder, skin: Real) -> Result<ModifiedCylinder, Unsupported> {
    let inset = skin.min(0.25 * link.length());
    let [start, end] = [0, 1].map(|end| match link.caps()[end] {
        Cap::Round => centre(link, end),
        Cap::Flat => centre(link, end) - outward(link, end) * inset,
    });
    ModifiedCylinder::new(start, end, link.radius() - skin, link.caps()).map_err(|_| Unsupported)
}

enum MovingWall<'a> {
    Triangle(&'a Triangle),
    /// The half-space's unit normal.
    HalfSpace(Vector),
    Link(ModifiedCylinder),
    Convex(&'a dyn Shape, &'a dyn SupportMap),
}

/// A moving robot and a moving wall.
struct Cast<'a> {
    dispatcher: &'a dyn QueryDispatcher,
    robot: &'a NonlinearRigidMotion,
    wall: MovingWall<'a>,
    motion: &'a NonlinearRigidMotion,
    start_time: Real,
    end_time: Real,
}

/// A link and the plane that bounds the wall, at one time.
struct CastMoment {
    time: Real,
    /// The poses of the robot and of the wall in the world.
    poses: [Pose; 2],
    distance: Real,
    /// The distance at which the two count as touching.
    touching: Real,
    /// Points of the link and of the wall's plane, in the link's frame.
    on_link: Vector,
    on_wall: Vector,
    /// From the link to the wall, in the link's frame.
    normal: Vector,
}

impl Cast<'_> {
    /// Returns the first hit, the link's side first.
    fn of(
        &self,
        link: &ModifiedCylinder,
        start: StartContact,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let skin = if start == StartContact::Skin { SKIN * link.radius() } else { 0.0 };
        let swept = if skin > 0.0 { without_skin(link, skin)? } else { *link };
        let now = self.at(self.start_time, &swept)?;
        if now.distance > now.touching + 0.5 * skin {
            return self.advance(&swept, now);
        }
        if start == StartContact::Stops {
            return Ok(Some(now.hit(ShapeCastStatus::PenetratingOrWithinTargetDist)));
        }
        // The iterations cannot resolve a core thinner than what counts as touching.
        let thinnest = (2.0 * now.touching).max(0.5 * skin);
        let Some(core) = self.core(link, thinnest)? else { return Ok(None) };
        let now = self.at(self.start_time, &core)?;
        self.advance(&core, now)
    }

    /// Returns the core of a link that touches the wall at the start; `None` if its radius is at
    /// most `thinnest`: the link has passed through.
    fn core(
        &self,
        link: &ModifiedCylinder,
        thinnest: Real,
    ) -> Result<Option<ModifiedCylinder>, Unsupported> {
        let inset = link.radius().min(0.25 * link.length());
        let trimmed = [0, 1].map(|end| match link.caps()[end] {
            Cap::Round => centre(link, end),
            Cap::Flat => centre(link, end) - outward(link, end) * inset,
        });
        let capsule = |radius| {
            ModifiedCylinder::capsule(trimmed[0], trimmed[1], radius).map_err(|_| Unsupported)
        };
        let start = self.at(self.start_time, &capsule(0.0)?)?;
        let radius = 0.5 * start.distance.min(link.radius());
        if radius > thinnest { capsule(radius).map(Some) } else { Ok(None) }
    }

    /// Steps 1 to 3: returns the first hit from `start` on.
    fn advance(
        &self,
        link: &ModifiedCylinder,
        start: CastMoment,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let mut now = start;
        for _ in 0..MAX_STEPS {
            if now.distance <= now.touching {
                return Ok(Some(now.hit(ShapeCastStatus::Converged)));
            }
            let left = self.end_time - now.time;
            let clear = self.clear_for(link, &now, left);
            if clear >= left {
                return Ok(None);
            }
            let next = now.time + clear;
            if next.is_nan() || next <= now.time {
                break;
            }
            now = self.at(next, link)?;
        }
        Ok(Some(now.hit(ShapeCastStatus::OutOfIterations)))
    }

    fn at(&self, time: Real, link: &ModifiedCylinder) -> Result<CastMoment, Unsupported> {
        let poses = [self.robot.position_at_time(time), self.motion.position_at_time(time)];
        let pos12 = poses[0].inv_mul(&poses[1]);
        let mut largest = link.radius();
        for place in [poses[0].translation, poses[1].translation, link.start(), link.end()] {
            largest = largest.max(in_range(place)?);
        }
        let size = link.length() + link.radius();
        let (distance, on_link, on_wall, normal, share);
        match self.wall {
            MovingWall::Triangle(triangle) => {
                let corners = triangle.vertices().map(|vertex| pos12 * vertex);
                for corner in corners {
                    largest = largest.max(in_range(corner)?);
                }
                let contact = link_triangle::contact(link, corners).ok_or(Unsupported)?;
                (distance, on_link, normal) = (contact.distance, contact.on_link, contact.normal);
                (on_wall, share) = (contact.on_other, TOUCHING);
            }
            MovingWall::HalfSpace(plane) => {
                normal = pos12.rotation * -plane;
                on_link = link.local_support_point_toward(normal);
                distance = (pos12.translation - on_link).dot(normal);
                (on_wall, share) = (on_link + normal * distance, TOUCHING);
            }
            MovingWall::Link(other) => {
                share = TOUCHING;
                let other = other.transformed(&pos12);
                largest = largest
                    .max(other.radius())
                    .max(in_range(other.start())?)
                    .max(in_range(other.end())?);
                let contact = LinkPair::between(link, &other)?.link_contact().ok_or(Unsupported)?;
                (on_link, normal) = (contact.on_link, contact.normal);
                (on_wall, distance) =
                    touched_plane(link, &contact, |n| other.local_support_point_toward(n));
            }
            MovingWall::Convex(shape, support) => {
                share = ITERATED;
                let contact = iterated_contact(self.dispatcher, link, (shape, support), &pos12)?;
                (on_link, normal) = (contact.on_link, contact.normal);
                let support = |n| support.support_point_toward(&pos12, n);
                (on_wall, distance) = touched_plane(link, &contact, support);
            }
        }
        let touching = share * size + TOUCH_ROUNDING * largest;
        if !(normal.is_finite() && distance.is_finite()) {
            return Err(Unsupported);
        }
        Ok(CastMoment { time, poses, distance, touching, on_link, on_wall, normal })
    }

    /// Step 2: returns a time during which the link stays before the wall's plane, at most `span`.
    fn clear_for(&self, link: &ModifiedCylinder, now: &CastMoment, span: Real) -> Real {
        let [robot_pose, wall_pose] = now.poses;
        let normal = robot_pose.rotation * now.normal;
        let axis = robot_pose.rotation * link.axis();
        let (spin, turn) = (self.robot.angvel, self.motion.angvel);
        let drift = self.motion.linvel - self.robot.linvel;
        // The angular velocity of the axis itself.
        let tilt = spin - axis * spin.dot(axis);
        let (tilts, turns) = (tilt.length(), turn.length());
        let mut clear = span;
        for end in 0..2 {
            let outward = robot_pose.rotation * outward(link, end);
            let is_round = link.caps()[end] == Cap::Round;
            let (reach, cap_bend) = if is_round && normal.dot(outward) >= 0.0 {
                (Reach::Radius(link.radius()), 0.0)
            } else {
                let turning = normal.cross(tilt - turn);
                let support = Support { radius: link.radius(), outward, is_round, normal, turning };
                let bend = (tilts + turns) * (tilts + turns) + tilts * (spin.length() + turns);
                (Reach::Support(support), 0.5 * link.radius() * bend)
            };
            // Relative to the wall's centre of rotation, whose distance from the plane is constant.
            let place = robot_pose * centre(link, end) - wall_pose * self.motion.local_center;
            let swing =
                spin.cross(robot_pose.rotation * (centre(link, end) - self.robot.local_center));
            let fastest = drift.length() + swing.length();
            let furthest = place.length() + fastest * span;
            clear = clear.min(
                PlaneGap {
                    gap: (now.on_wall - centre(link, end)).dot(now.normal),
                    rate: (drift - swing).dot(normal) - turn.cross(normal).dot(place),
                    bend: cap_bend
                        + 0.5 * spin.length() * swing.length()
                        + turns * (fastest + 0.5 * turns * furthest),
                    reach,
                }
                .time_open(clear),
            );
        }
        clear
    }
}

/// Returns a point of the plane across a contact's normal that touches the wall, and the link's
/// distance from that plane, both from support points. 0 for an overlap.
fn touched_plane(
    link: &ModifiedCylinder,
    contact: &LinkContact,
    wall: impl Fn(Vector) -> Vector,
) -> (Vector, Real) {
    if contact.distance <= 0.0 {
        return (contact.on_other, 0.0);
    }
    let normal = contact.normal;
    let before = (wall(-normal) - contact.on_other).dot(normal);
    let on_wall = contact.on_other + normal * before;
    (on_wall, (on_wall - link.local_support_point_toward(normal)).dot(normal))
}

impl CastMoment {
    fn hit(&self, status: ShapeCastStatus) -> ShapeCastHit {
        let link_to_wall = self.poses[1].inv_mul(&self.poses[0]);
        ShapeCastHit {
            time_of_impact: self.time,
            witness1: self.on_link,
            witness2: link_to_wall * self.on_wall,
            normal1: self.normal,
            normal2: link_to_wall.rotation * -self.normal,
            status,
            subshape1: 0,
            subshape2: 0,
        }
    }
}
