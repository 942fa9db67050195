//! When a moving link meets a moving triangle or half-space: conservative advancement, never late.
//!
//! Both travel and turn at constant speeds. While they are apart there is a plane between them, whose normal is that of
//! their contact. It stays as it is (that of a half-space turns with it) for as long as [`closing`](super::closing)
//! proves of every end of the link and every corner that they stay on their sides. Then the two are measured again.
//! Close to each other the steps are Newton's, from the safe side. They end where the two are as close as
//! [`TOUCHING`] of their size or rounding.
//!
//! **What touches at the start.** A host that does not stop there wants to know when the link would go through: rapier
//! does, for fast bodies, and takes a hit at the very start for none. So what is cast is the link's *core*: the inside
//! of its axis, swollen by half of the room that it has. A core is clear at the start unless the link is through
//! already, and where it meets the other shape half of the room is left. (parry's cast says that the link is held at
//! the start, which frees it: it then passes the wall with the end that did not touch.)

use super::axial::unit;
use super::closing::{Closing, Reach, Support};
use super::footing::{centre, outward};
use super::link_triangle::{self, LinkTriangle};
use super::robot_pair::{in_range, links_of};
use crate::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{NonlinearRigidMotion, ShapeCastHit, ShapeCastStatus, Unsupported};
use parry3d_f64::shape::{Shape, SupportMap, Triangle};

/// The share of a link's size at which it counts as touching.
const TOUCHING: Real = 1e-9;
/// What rounding leaves of the largest coordinate.
const ROUNDING: Real = 64.0 * Real::EPSILON;
/// More than any motion takes that is not a grazing one. After that the moment reached is the answer: early, not late.
const MOST_STEPS: usize = 200;

/// The first hit of two shapes, if they are a link and a triangle, or a robot and a half-space, in either order.
///
/// # Errors
/// [`Unsupported`] for what is not finite, or out of range.
pub(super) fn cast(
    (motion1, g1): (&NonlinearRigidMotion, &dyn Shape),
    (motion2, g2): (&NonlinearRigidMotion, &dyn Shape),
    (start_time, end_time): (Real, Real),
    stop_at_penetration: bool,
) -> Option<Result<Option<ShapeCastHit>, Unsupported>> {
    let (links, wall, robot_is_first) = match pair(g1, g2) {
        Ok(found) => found?,
        Err(refused) => return Some(Err(refused)),
    };
    let (robot, motion) = if robot_is_first { (motion1, motion2) } else { (motion2, motion1) };
    let cast = Cast { robot, wall, motion, start_time, end_time };
    let mut first: Option<ShapeCastHit> = None;
    for (index, link) in links.iter().enumerate() {
        match cast.of(link, stop_at_penetration) {
            Ok(Some(hit)) if first.as_ref().is_none_or(|first| hit.time_of_impact < first.time_of_impact) => {
                first = Some(ShapeCastHit { subshape1: index as u32, ..hit });
            }
            Ok(_) => {}
            Err(refused) => return Some(Err(refused)),
        }
    }
    Some(Ok(first.map(|hit| if robot_is_first { hit } else { hit.swapped() })))
}

/// The links of the robot, the wall, and whether the robot is first.
type RobotAndWall<'a> = (&'a [ModifiedCylinder], Wall<'a>, bool);

fn pair<'a>(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Option<RobotAndWall<'a>>, Unsupported> {
    if let Some(pair) = LinkTriangle::of(g1, g2)? {
        let link = std::slice::from_ref(pair.link);
        return Ok(Some((link, Wall::Triangle(pair.triangle), pair.link_is_first)));
    }
    let (robot, half_space, robot_is_first) = match (g1.as_halfspace(), g2.as_halfspace()) {
        (None, Some(half_space)) => (g1, half_space, true),
        (Some(half_space), None) => (g2, half_space, false),
        _ => return Ok(None),
    };
    let Some(links) = links_of(robot) else { return Ok(None) };
    let normal = unit(half_space.normal).ok_or(Unsupported)?;
    Ok(Some((links, Wall::HalfSpace(normal), robot_is_first)))
}

enum Wall<'a> {
    Triangle(&'a Triangle),
    /// Its unit normal.
    HalfSpace(Vector),
}

/// A robot and a wall on their ways.
struct Cast<'a> {
    robot: &'a NonlinearRigidMotion,
    wall: Wall<'a>,
    motion: &'a NonlinearRigidMotion,
    start_time: Real,
    end_time: Real,
}

/// A link and the wall at one moment.
struct Moment {
    time: Real,
    /// Of the robot and of the wall, in the world.
    poses: [Pose; 2],
    /// The corners of a triangle in the link's frame.
    corners: [Vector; 3],
    distance: Real,
    /// In the link's and in the wall's frame.
    on_link: Vector,
    on_wall: Vector,
    /// From the link to the wall, in the link's frame.
    normal: Vector,
    /// What the distance must exceed to count.
    touching: Real,
}

impl Cast<'_> {
    /// The first hit, the link's side first.
    fn of(&self, link: &ModifiedCylinder, stop_at_start: bool) -> Result<Option<ShapeCastHit>, Unsupported> {
        let start = self.at(self.start_time, link)?;
        if start.distance > start.touching {
            return self.advance(link, start);
        }
        if stop_at_start {
            return Ok(Some(start.hit(ShapeCastStatus::PenetratingOrWithinTargetDist)));
        }
        let Some(core) = self.core(link)? else { return Ok(None) };
        let start = self.at(self.start_time, &core)?;
        self.advance(&core, start)
    }

    /// What must not touch the wall if the link does at the start: nothing if it is through already.
    fn core(&self, link: &ModifiedCylinder) -> Result<Option<ModifiedCylinder>, Unsupported> {
        let inset = link.radius().min(0.25 * link.length());
        let trimmed = [0, 1].map(|end| match link.caps()[end] {
            Cap::Round => centre(link, end),
            Cap::Flat => centre(link, end) - outward(link, end) * inset,
        });
        let wire = ModifiedCylinder::capsule(trimmed[0], trimmed[1], 0.0).map_err(|_| Unsupported)?;
        let start = self.at(self.start_time, &wire)?;
        let radius = 0.5 * start.distance.min(link.radius());
        if radius <= 2.0 * start.touching {
            return Ok(None);
        }
        ModifiedCylinder::capsule(trimmed[0], trimmed[1], radius).map(Some).map_err(|_| Unsupported)
    }

    /// The first moment from this on at which the two touch.
    fn advance(&self, link: &ModifiedCylinder, start: Moment) -> Result<Option<ShapeCastHit>, Unsupported> {
        let mut now = start;
        for _ in 0..MOST_STEPS {
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

    fn at(&self, time: Real, link: &ModifiedCylinder) -> Result<Moment, Unsupported> {
        let poses = [self.robot.position_at_time(time), self.motion.position_at_time(time)];
        let wall_to_link = poses[0].inv_mul(&poses[1]);
        let mut largest = link.radius();
        for place in [poses[0].translation, poses[1].translation, link.start(), link.end()] {
            largest = largest.max(in_range(place)?);
        }
        let (mut corners, distance, on_link, on_wall, normal);
        match &self.wall {
            Wall::Triangle(triangle) => {
                corners = triangle.vertices().map(|vertex| wall_to_link * vertex);
                for corner in corners {
                    largest = largest.max(in_range(corner)?);
                }
                let contact = link_triangle::contact(link, corners).ok_or(Unsupported)?;
                (distance, on_link, normal) = (contact.distance, contact.on_link, contact.normal);
                on_wall = wall_to_link.inverse_transform_point(contact.on_triangle);
            }
            Wall::HalfSpace(plane) => {
                corners = [Vector::ZERO; 3];
                normal = wall_to_link.rotation * -*plane;
                on_link = link.local_support_point_toward(normal);
                let over = wall_to_link.inverse_transform_point(on_link);
                distance = over.dot(*plane);
                on_wall = over - *plane * distance;
                corners[0] = wall_to_link * on_wall;
            }
        }
        let touching = TOUCHING * (link.length() + link.radius()) + ROUNDING * largest;
        Ok(Moment { time, poses, corners, distance, on_link, on_wall, normal, touching })
    }

    /// A time until which the link and the wall do not meet, at most `span`.
    fn clear_for(&self, link: &ModifiedCylinder, now: &Moment, span: Real) -> Real {
        let [robot_pose, wall_pose] = now.poses;
        let normal = robot_pose.rotation * now.normal;
        let axis = robot_pose.rotation * link.axis();
        let spin = self.robot.angvel;
        // How the axis turns.
        let tilt = spin - axis * spin.dot(axis);
        let (turn, corners) = match self.wall {
            Wall::Triangle(triangle) => (Vector::ZERO, triangle.vertices().as_slice()),
            Wall::HalfSpace(_) => (self.motion.angvel, [].as_slice()),
        };
        let mut clear = span;
        for end in 0..2 {
            let arm = robot_pose.rotation * (centre(link, end) - self.robot.local_center);
            let swing = spin.cross(arm);
            let velocity = self.robot.linvel + swing;
            let outward = robot_pose.rotation * outward(link, end);
            let is_round = link.caps()[end] == Cap::Round;
            let (reach, cap_bend) = if is_round && normal.dot(outward) >= 0.0 {
                (Reach::Radius(link.radius()), 0.0)
            } else {
                let turning = normal.cross(tilt - turn);
                let support = Support { radius: link.radius(), outward, is_round, normal, turning };
                let (tilts, turns) = (tilt.length(), turn.length());
                let bend = (tilts + turns) * (tilts + turns) + tilts * (spin.length() + turns);
                (Reach::Support(support), 0.5 * link.radius() * bend)
            };
            let end_bend = 0.5 * spin.length() * swing.length() + cap_bend;
            let mut consider = |gap, rate, bend| {
                clear = clear.min(Closing { gap, rate, bend: end_bend + bend, reach }.stays_open(clear));
            };
            match self.wall {
                Wall::Triangle(_) => {
                    for (corner, local) in corners.iter().zip(now.corners) {
                        let arm = wall_pose.rotation * (corner - self.motion.local_center);
                        let swing = self.motion.angvel.cross(arm);
                        let gap = (local - centre(link, end)).dot(now.normal);
                        let rate = (self.motion.linvel + swing - velocity).dot(normal);
                        consider(gap, rate, 0.5 * self.motion.angvel.length() * swing.length());
                    }
                }
                Wall::HalfSpace(_) => {
                    // The plane is as far from the wall's centre of rotation at all times.
                    let from_centre = robot_pose * centre(link, end) - wall_pose * self.motion.local_center;
                    let parting = self.motion.linvel - velocity;
                    let gap = (now.corners[0] - centre(link, end)).dot(now.normal);
                    let rate = parting.dot(normal) - turn.cross(normal).dot(from_centre);
                    let fastest = (self.motion.linvel - self.robot.linvel).length() + swing.length();
                    let furthest = from_centre.length() + fastest * span;
                    let turned = turn.length();
                    consider(gap, rate, turned * (fastest + 0.5 * turned * furthest));
                }
            }
        }
        clear
    }
}

impl Moment {
    fn hit(&self, status: ShapeCastStatus) -> ShapeCastHit {
        let to_wall = self.poses[1].rotation.inverse() * (self.poses[0].rotation * -self.normal);
        ShapeCastHit {
            time_of_impact: self.time,
            witness1: self.on_link,
            witness2: self.on_wall,
            normal1: self.normal,
            normal2: to_wall,
            status,
            subshape1: 0,
            subshape2: 0,
        }
    }
}
