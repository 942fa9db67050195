//! A moving robot for all queries of a scene: its shapes, its motion in the frames of the
//! structures, and a bound on where it goes.
//!
//! # Definitions
//! - **Part**: one of n equal parts of the motion's time, with the midpoint t. tau: half of its
//!   length.
//! - **Body**: a capsule around a piece of the robot in the shape at t
//!   ([`PlacedTube::outer`], with round ends). w: its way, tau V, where V bounds the speed of the
//!   centreline of the piece.
//! - d: the distance of a body from the bounding box of a structure.
//!
//! # Claim
//! If `d - w > margin` for all bodies of all parts, the robot keeps the margin at all times.
//!
//! **Proof.**
//! 1. At every time each point of the robot is within the radius of a point of the centreline: in a
//!    disc or a ball around that point.
//! 2. The body contains the ball around each point of its piece of the centreline. Along a chord
//!    the centreline is within `radius of the body - radius` of the axis (case 1 of
//!    `refine::bounding_body`). Case 2 makes the axis longer and the body wider. In case 3 the axis
//!    is the normal of the face: a point at the arc length s from it is between 0 and s behind the
//!    face, and at most k s^2 / 2 + a s beside the normal, which the radius of the body includes.
//! 3. Until another time of the part a point of the centreline moves by at most w. So the ball
//!    around it comes nearer by at most w, flat ends that become round included.
//! 4. If the structure moves, the box is that of the middle of the part, and the way of its points
//!    is added to w.
//!
//! **Rounding.** M: the largest coordinate of robot and structure in the scene, with radius, pose
//! and way. The body contains the ball up to rounding, by its own slack.
//! 1. The queries measure in the mesh's frame. A point there is less than 400 u M from its place
//!    here (`distance_cache`, step 3).
//! 2. The corners of a moved box err by less than 80 u M.
//! 3. The distance from a box is a lower bound. The subtractions err by less than 16 u M.
//!
//! The sum is less than the 1024 u M that are subtracted. If coordinates are so large that a place
//! in a mesh's frame could be out of range, the robot counts as near.

use super::bounding_box::BoundingBox;
use super::structure::Structure;
use super::structure_end::MovingStructure;
use crate::answer::ProximityError;
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::motion::{CarriedMotion, CommonFrame, DisplacementBound, Motion, Speed, check_speed};
use crate::pair::PlacedLink;
use crate::query::motion::{half_length, midpoint};
use crate::refine::{Piece, PlacedTube};
use crate::robot::{COORDINATE_LIMIT, RobotError};
use parry3d_f64::math::{Pose, Real, Vector};
use std::cell::RefCell;

/// How many shapes of a robot are kept. The queries of a scene share the shapes of the first
/// intervals of time; later intervals depend on what is near.
const MAX_SHAPES: usize = 64;

/// The most parts of the time that are bounded. A path of more motions has longer parts.
const MAX_PARTS: usize = 64;

/// Memory that is reused. Nothing in it enters a later answer.
#[derive(Clone, Debug, Default)]
pub(super) struct MovingRobotMemory {
    shapes: Vec<KnownShape>,
    tube: Option<Tube>,
    pieces: Vec<Piece>,
    swept: Vec<SweptBody>,
}

/// A shape at a time.
type KnownShape = (Real, Pose, Tube);

/// The shapes of one motion at some times.
#[derive(Debug)]
struct KnownShapes {
    shapes: Vec<KnownShape>,
    /// How many of them belong to this motion. The others are memory of earlier motions.
    used: usize,
}

impl KnownShapes {
    /// No shapes yet. Those of an earlier motion are memory that is written over.
    fn in_memory(shapes: Vec<KnownShape>) -> Self {
        Self { shapes, used: 0 }
    }

    fn into_memory(self) -> Vec<KnownShape> {
        self.shapes
    }

    fn at(&self, t: Real) -> Option<&(Real, Pose, Tube)> {
        self.shapes[..self.used].iter().find(|known| known.0.to_bits() == t.to_bits())
    }

    fn keep(&mut self, t: Real, pose: Pose, tube: &Tube) {
        if self.used == MAX_SHAPES {
            return;
        }
        match self.shapes.get_mut(self.used) {
            Some(old) => {
                (old.0, old.1) = (t, pose);
                old.2.clone_from(tube);
            }
            None => self.shapes.push((t, pose, tube.clone())),
        }
        self.used += 1;
    }
}

/// A body around a piece of the robot, and how far the piece moves in half of a part.
#[derive(Clone, Debug)]
struct SweptBody {
    /// The part.
    times: [Real; 2],
    body: PlacedLink,
    /// The ball around the body.
    centre: Vector,
    radius: Real,
    way: Real,
    /// The largest coordinate of the body, with radius, pose and way.
    reach: Real,
}

impl SweptBody {
    /// A lower bound on the distance of the piece from a box during the part. `size`: the largest
    /// coordinate of the structure and its pose. A bound from the ball is enough if it is at least
    /// `wanted`.
    fn at_least(&self, around: &BoundingBox, size: Real, wanted: Real) -> Real {
        let largest = self.reach + size;
        let rounding = 1024.0 * Real::UNIT_ROUNDOFF * largest;
        // Written so that NaN is near.
        if largest < COORDINATE_LIMIT / 16.0 {
            let of_ball = around.distance_to_point(self.centre) - self.radius;
            let apart = of_ball - self.way - rounding;
            if apart >= wanted {
                return apart;
            }
            around.distance_to(&self.body) - self.way - rounding
        } else {
            Real::NEG_INFINITY
        }
    }
}

/// The bodies around a placed tube. `way` bounds how far a piece moves in half of the part.
fn sweep(
    placed: &PlacedTube,
    times: [Real; 2],
    pieces: &mut Vec<Piece>,
    swept: &mut Vec<SweptBody>,
    way: impl Fn(&Piece) -> Real,
) {
    let translation = placed.pose.translation.abs().max_element();
    placed.begin(Real::INFINITY, pieces);
    for piece in &*pieces {
        let (outer, way) = (placed.outer(piece).body, way(piece));
        let (start, end, radius) = (outer.start(), outer.end(), outer.radius());
        let body = PlacedLink::between(start, end, radius, [false; 2]);
        let largest = start.abs().max(end.abs()).max_element() + radius + way;
        let is_known = body.is_finite() && way < Real::INFINITY;
        let reach = if is_known { largest + translation } else { Real::INFINITY };
        let half = body.along() * 0.5;
        let (centre, radius) = (start + half, half.length() + radius);
        swept.push(SweptBody { times, body, centre, radius, way, reach });
    }
}

/// The bodies around a tube at rest.
pub(super) struct RestingTube(Vec<SweptBody>);

impl RestingTube {
    pub fn new(placed: &PlacedTube) -> Self {
        let mut swept = Vec::new();
        sweep(placed, [0.0, 1.0], &mut Vec::new(), &mut swept, |_| 0.0);
        Self(swept)
    }

    /// A lower bound on the distance of the tube from a structure.
    pub fn at_least(&self, structure: &Structure) -> Real {
        at_least(&self.0, structure)
    }
}

fn at_least(swept: &[SweptBody], structure: &Structure) -> Real {
    let (around, size) = (structure.around_in_scene(), structure.size());
    swept
        .iter()
        .fold(Real::INFINITY, |least, body| lesser(least, body.at_least(&around, size, least)))
}

/// Returns the lesser of two lower bounds; NaN, which counts as near, if one is NaN.
fn lesser(least: Real, bound: Real) -> Real {
    if least <= bound || least.is_nan() { least } else { bound }
}

/// A motion of a robot in a scene.
pub(super) struct MovingRobot<'a> {
    motion: &'a dyn Motion,
    shapes: RefCell<KnownShapes>,
    swept: Vec<SweptBody>,
}

impl<'a> MovingRobot<'a> {
    /// Bounds where the robot goes.
    ///
    /// # Errors
    /// The motion has no shape in the middle of a part, or the shape cannot be placed.
    pub fn new(
        motion: &'a dyn Motion,
        memory: &mut MovingRobotMemory,
    ) -> Result<Self, ProximityError> {
        let MovingRobotMemory { shapes, tube, pieces, swept } = memory;
        let shapes = KnownShapes::in_memory(std::mem::take(shapes));
        let mut swept = std::mem::take(swept);
        swept.clear();
        let mut robot = Self { motion, shapes: RefCell::new(shapes), swept };
        let bounded = robot.bound(tube.get_or_insert_with(Tube::empty), pieces);
        if let Err(error) = bounded {
            robot.give_back(memory);
            return Err(error);
        }
        Ok(robot)
    }

    /// Returns the memory after the last query.
    pub fn give_back(self, memory: &mut MovingRobotMemory) {
        memory.shapes = self.shapes.into_inner().into_memory();
        memory.swept = self.swept;
    }

    fn bound(&mut self, tube: &mut Tube, pieces: &mut Vec<Piece>) -> Result<(), ProximityError> {
        let parts = self.motion.time_parts().clamp(1, MAX_PARTS);
        for part in 0..parts {
            let times = [part, part + 1].map(|end| end as Real / parts as Real);
            tube.forget_error();
            let pose = self.shape(midpoint(times), tube)?;
            let placed = PlacedTube::new(tube, &pose, 0.0)?;
            let carried = CarriedMotion::new(self.motion, times, half_length(times));
            sweep(&placed, times, pieces, &mut self.swept, |piece| {
                let (section, shares) = (piece.section as usize, placed.shares(piece));
                let speed = carried.speed((placed.tube, &placed.pose), section, shares).point;
                // An invalid speed bounds nothing here; the queries return it as an error.
                let speed = check_speed(section, speed).unwrap_or(Real::INFINITY);
                half_length(times) * speed * (1.0 + 8.0 * Real::UNIT_ROUNDOFF)
            });
        }
        Ok(())
    }

    /// A lower bound on the distance of the robot from a structure at all times.
    pub fn at_least(&self, structure: &Structure) -> Real {
        at_least(&self.swept, structure)
    }

    /// [`at_least`](Self::at_least) for a structure that moves.
    pub fn at_least_moving(&self, structure: &Structure, end: &MovingStructure) -> Real {
        let parts = self.swept.chunk_by(|one, other| one.times == other.times);
        let mut least = Real::INFINITY;
        for part in parts {
            let (around, way) = end.around(structure, part[0].times);
            let size = end.size() + way;
            for body in part {
                least = lesser(least, body.at_least(&around, size, least + way) - way);
            }
        }
        least
    }

    /// A lower bound on the distance from another robot that moves at the same time: by the boxes
    /// around the bodies of the parts that share a time. It errs as that from a structure does.
    ///
    /// The second number is the distance of the boxes around the middle shapes: it says which of
    /// two pairs is nearer if both bounds are 0.
    pub fn at_least_from(&self, other: &Self) -> [Real; 2] {
        let boxes = |robot: &Self| -> Vec<_> {
            let around = |part: &[SweptBody]| {
                let parts = [1.0, 0.0].map(|share| {
                    let bodies = part.iter().map(|SweptBody { body, way, .. }| {
                        let ends = [body.start(), body.end()].into_iter();
                        BoundingBox::points(ends).grown(body.radius() + share * way)
                    });
                    bodies.fold(BoundingBox::default(), BoundingBox::and)
                });
                let reach = part.iter().fold(0.0, |most: Real, body| most.max(body.reach));
                (part[0].times, parts, reach)
            };
            robot.swept.chunk_by(|one, other| one.times == other.times).map(around).collect()
        };
        let (here, there) = (boxes(self), boxes(other));
        let mut least = [Real::INFINITY; 2];
        for (times, [around, middle], reach) in &here {
            for (others, [beside, other], size) in &there {
                if times[0] >= others[1] || others[0] >= times[1] {
                    continue;
                }
                let largest = reach + size;
                if largest < COORDINATE_LIMIT / 16.0 {
                    let rounding = 1024.0 * Real::UNIT_ROUNDOFF * largest;
                    let gaps = [around.gap(beside) - rounding, middle.gap(other)];
                    least = [least[0].min(gaps[0]), least[1].min(gaps[1])];
                } else {
                    return [Real::NEG_INFINITY; 2];
                }
            }
        }
        least
    }

    /// The motion in the scene's frame.
    pub fn in_scene(&self) -> PlacedMotion<'_, 'a> {
        PlacedMotion { robot: self, scene_to_mesh: None }
    }

    /// The motion in the frame of a structure's mesh.
    pub fn in_mesh(&self, structure: &Structure) -> PlacedMotion<'_, 'a> {
        PlacedMotion { robot: self, scene_to_mesh: structure.scene_to_mesh() }
    }

    /// Writes the shape at time `t` to `tube` and returns its pose in the scene. A shape is made
    /// once for all queries, if it is one of the first.
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        if let Some((_, pose, known)) = self.shapes.borrow().at(t) {
            tube.clone_from(known);
            return Ok(*pose);
        }
        let pose = self.motion.shape(t, tube)?;
        self.shapes.borrow_mut().keep(t, pose, tube);
        Ok(pose)
    }
}

/// A robot's motion in some frame.
pub(super) struct PlacedMotion<'r, 'a> {
    robot: &'r MovingRobot<'a>,
    /// Maps the scene's frame to that frame; `None` if they are the same.
    scene_to_mesh: Option<Pose>,
}

impl Motion for PlacedMotion<'_, '_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let pose = self.robot.shape(t, tube)?;
        Ok(self.scene_to_mesh.map_or(pose, |scene_to_mesh| scene_to_mesh * pose))
    }

    /// Speeds are the same in every frame, up to the rounding of the frame's rotation.
    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.robot.motion.speed(section, shares, times);
        if self.scene_to_mesh.is_none() {
            return Speed { point, turn };
        }
        Speed { point: point * (1.0 + 16.0 * Real::UNIT_ROUNDOFF), turn }
    }

    /// The rotated bound. A rotation errs by less than 32 u of a length, and so does the length of
    /// its quaternion.
    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let DisplacementBound { ways, off } =
            self.robot.motion.displacement(section, shares, times)?;
        let Some(scene_to_mesh) = self.scene_to_mesh else {
            return Some(DisplacementBound { ways, off });
        };
        let rounding = 64.0 * Real::UNIT_ROUNDOFF * (ways[0].length() + ways[1].length());
        Some(DisplacementBound {
            ways: ways.map(|way| scene_to_mesh.rotation * way),
            off: off * (1.0 + 16.0 * Real::UNIT_ROUNDOFF) + rounding,
        })
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        let frame = self.robot.motion.common_frame(times)?;
        Some(self.scene_to_mesh.map_or(frame, |scene_to_mesh| frame.seen_from(&scene_to_mesh)))
    }

    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.robot.motion.speed_in_frame(section, shares, times);
        Speed { point: point * (1.0 + 16.0 * Real::UNIT_ROUNDOFF), turn }
    }

    fn time_parts(&self) -> usize {
        self.robot.motion.time_parts()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bound that is not a number counts as near, wherever it stands.
    #[test]
    fn a_bound_that_is_no_number_is_near() {
        let least = |bounds: [Real; 3]| bounds.into_iter().fold(Real::INFINITY, lesser);
        assert_eq!(least([3.0, 1.0, 2.0]), 1.0);
        for place in 0..3 {
            let mut bounds = [3.0, 1.0, 2.0];
            bounds[place] = Real::NAN;
            assert!(least(bounds).is_nan(), "{place}");
        }
    }

    /// Shapes of one motion are not those of the next in the same memory.
    #[test]
    fn the_next_motion_starts_without_shapes() {
        let shape = |x: Real| {
            let points = [Vector::ZERO, Vector::new(x, 0.0, 1.0)];
            Tube::from_samples(&points, &[0.1], None).unwrap()
        };
        let at = |x: Real| Pose::translation(x, 0.0, 0.0);
        let mut first = KnownShapes::in_memory(Vec::new());
        first.keep(0.5, at(1.0), &shape(1.0));
        first.keep(0.25, at(2.0), &shape(2.0));
        let mut second = KnownShapes::in_memory(first.into_memory());
        assert!(second.at(0.5).is_none() && second.at(0.25).is_none());
        second.keep(0.25, at(3.0), &shape(3.0));
        assert_eq!(second.at(0.25).map(|known| known.1), Some(at(3.0)));
        assert!(second.at(0.5).is_none());
    }
}
