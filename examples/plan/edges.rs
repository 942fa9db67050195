//! The edges of a planner: motions in joint space, and two ways to check them.

use continuum_demo::ctr::{Joints, Robot};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::steer::Random;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::proximity::{BvhSearch, Decision, Scene};
use parry_continuum::{Motion, RigidMotion, RobotError, Speed, Tube};
use std::cell::Cell;
use std::f64::consts::{PI, TAU};
use std::time::{Duration, Instant};

/// How near to the margin an answer may stay open, mm. What stays open is not accepted.
pub const RESOLUTION: Real = 1e-3;

/// The least that a section is out, mm.
const LEAST: Real = 0.1;

/// What a turn of 1 rad counts beside an extension by 1 mm: about the robot's reach across, mm.
const REACH: Real = 8.0;

/// A place in joint space: three extensions, mm, and the angles of the two curved tubes, rad. The
/// straight tube's angle does not matter.
pub type Place = [Real; 5];

/// The robot drawn in.
pub const DRAWN_IN: Place = [LEAST, LEAST, LEAST, 0.0, 0.0];

/// The place of a robot's joints.
pub fn place(joints: &Joints) -> Place {
    let [first, second, third] = [0, 1, 2].map(|k| joints.extensions[k].max(LEAST));
    [first, second, third, joints.angles[0], joints.angles[1]]
}

/// The joints of a place.
pub fn joints(place: &Place) -> Joints {
    Joints { extensions: place[..3].to_vec(), angles: vec![place[3], place[4], 0.0] }
}

/// A random place. Tubes that are out are curved all along.
pub fn any_place(robot: &Robot, random: &mut Random) -> Place {
    let mut place = place(&robot.any_joints(random));
    place[0] = place[0].min(robot.sections[1].length - place[1]).max(LEAST);
    place
}

/// The way between two places: the tubes turn by the lesser angles.
pub fn way(from: &Place, to: &Place) -> Place {
    let turn = |k: usize| (to[k] - from[k] + PI).rem_euclid(TAU) - PI;
    [to[0] - from[0], to[1] - from[1], to[2] - from[2], turn(3), turn(4)]
}

/// The place a share of the way on.
pub fn along(from: &Place, way: &Place, share: Real) -> Place {
    std::array::from_fn(|k| from[k] + share * way[k])
}

/// How long a way is, mm.
pub fn length(way: &Place) -> Real {
    way.iter()
        .enumerate()
        .map(|(k, by)| if k < 3 { by * by } else { (REACH * by).powi(2) })
        .sum::<Real>()
        .sqrt()
}

/// How edges are checked.
#[derive(Clone, Copy, PartialEq)]
pub enum Check {
    /// By `Scene::clears_motion`.
    Proof,
    /// By shapes between which the tip moves so far, mm.
    Steps(Real),
}

/// What the edges took.
#[derive(Clone, Default)]
pub struct Costs {
    pub edges: u64,
    pub shapes: u64,
    pub kinematics: Duration,
    pub all: Duration,
}

/// Checks edges.
pub struct Edges<'a> {
    pub robot: &'a Robot,
    pub base: Pose,
    pub margin: Real,
    pub check: Check,
    /// The wall alone.
    pub search: BvhSearch,
    /// The wall, the vein, and the margins.
    pub scene: Scene,
    /// The other robot, which rests.
    pub other: Option<&'a Resting>,
    pub costs: Costs,
}

/// A robot that rests: its shape, and the same as a motion.
pub struct Resting {
    pub tube: Tube,
    pub motion: RigidMotion,
}

impl Edges<'_> {
    /// The motion between two places.
    pub fn motion(&self, from: &Place, to: &Place) -> Result<JointMotion, String> {
        let to = along(from, &way(from, to), 1.0);
        JointMotion::new(self.robot, [&joints(from), &joints(&to)], self.base)
            .ok_or_else(|| "a tube of the robot would be straight where it should be curved".into())
    }

    /// Whether the robot keeps the margin on the way, by this check.
    pub fn is_clear(&mut self, from: &Place, to: &Place) -> Result<bool, String> {
        let motion = Watched {
            motion: self.motion(from, to)?,
            shapes: Cell::default(),
            time: Cell::default(),
        };
        let begin = Instant::now();
        let is_clear = match self.check {
            Check::Proof => self.decide(&motion)? == Decision::Clear,
            Check::Steps(step) => self.is_clear_in_steps(&motion, step)?,
        };
        self.costs.all += begin.elapsed();
        self.costs.kinematics += motion.time.get();
        self.costs.shapes += motion.shapes.get();
        self.costs.edges += 1;
        Ok(is_clear)
    }

    /// Decides about a motion of the robot, beside the other one.
    pub fn decide(&mut self, motion: &dyn Motion) -> Result<Decision, String> {
        let mut motions = vec![motion];
        motions.extend(self.other.map(|other| &other.motion as &dyn Motion));
        Ok(self.scene.clears_motion(&motions, RESOLUTION).map_err(text)?.decision)
    }

    fn is_clear_in_steps(&mut self, motion: &Watched, step: Real) -> Result<bool, String> {
        let mut tube = motion.motion.tube(0.0).map_err(text)?;
        for t in motion.motion.steps(step) {
            let pose = motion.shape(t, &mut tube).map_err(text)?;
            if !self.is_clear_at(&tube, pose)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the robot keeps all margins in a shape.
    fn is_clear_at(&mut self, tube: &Tube, pose: Pose) -> Result<bool, String> {
        let mut tubes = vec![(tube, pose)];
        tubes.extend(self.other.map(|other| (&other.tube, Pose::IDENTITY)));
        Ok(self.scene.clears_tube(&tubes, RESOLUTION).map_err(text)? == Decision::Clear)
    }

    /// Which places keep all margins: the wall's first, on all cores.
    pub fn clear_places(&mut self, places: Vec<Place>) -> Result<Vec<Place>, String> {
        let tube = |place| Ok((self.robot.shape(&joints(place)).map_err(text)?, self.base));
        let tubes: Vec<_> = places.iter().map(tube).collect::<Result<_, String>>()?;
        let tubes: Vec<_> = tubes.iter().map(|(tube, pose)| (tube, *pose)).collect();
        let mut decisions = Vec::new();
        self.search
            .clears_tube_batch(&tubes, self.margin, RESOLUTION, &mut decisions)
            .map_err(text)?;
        let mut clear = Vec::new();
        for ((place, (tube, pose)), decision) in places.into_iter().zip(&tubes).zip(decisions) {
            if decision == Ok(Decision::Clear) && self.is_clear_at(tube, *pose)? {
                clear.push(place);
            }
        }
        Ok(clear)
    }
}

/// A motion that counts and times its shapes.
struct Watched {
    motion: JointMotion,
    shapes: Cell<u64>,
    time: Cell<Duration>,
}

impl Motion for Watched {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let begin = Instant::now();
        let pose = self.motion.shape(t, tube);
        self.time.set(self.time.get() + begin.elapsed());
        self.shapes.set(self.shapes.get() + 1);
        pose
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }
}

pub fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
