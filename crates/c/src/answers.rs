//! Answers as C has them: flat structures with the fields of Python's answers.

use parry_continuum::parry::math::Vector;
use parry_continuum::proximity as rust;
use rust::{Between, SceneMotionContact, ScenePlace};

/// The index that stands for none.
pub const PC_NONE: u32 = u32::MAX;

/// Whether a margin is kept. `PC_CLEAR` and `PC_CONTACT` are proven.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum pc_decision {
    /// The margin is not kept.
    PC_CONTACT = -1,
    /// The robot comes within the resolution of the margin, or the question takes too much work.
    PC_UNDECIDED = 0,
    /// The margin is kept.
    PC_CLEAR = 1,
}

/// On which side of a mesh a point is.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum pc_side {
    /// It is proven to be inside.
    PC_INSIDE = -1,
    /// It is on the surface within rounding, or the mesh is too open to tell.
    PC_UNDECIDED_SIDE = 0,
    /// It is proven to be outside.
    PC_OUTSIDE = 1,
}

/// Why it stays open whether a motion keeps a margin.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum pc_undecided_reason {
    /// It is decided.
    PC_REASON_NONE = 0,
    /// A shape comes within the resolution of the margin.
    PC_REASON_NEAR = 1,
    /// The question has reached its limit of work: a coarser resolution helps.
    PC_REASON_WORK = 2,
}

/// Where a robot, or one of its links, is closest to a mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_minimum {
    /// The distance, 0 where they touch or overlap.
    pub distance: f64,
    /// The robot's closest point.
    pub on_robot: [f64; 3],
    /// The mesh's closest point.
    pub on_mesh: [f64; 3],
    /// How far along the centreline from the base.
    pub arc_length: f64,
    /// The segment of the input, from point `segment` to the next.
    pub segment: u32,
    /// The closest triangle.
    pub triangle: u32,
}

/// A contact of a robot with a mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_contact {
    /// The distance, 0 where they touch or overlap.
    pub distance: f64,
    /// The distance with a sign: negative where they overlap.
    pub depth: f64,
    /// The unit vector from the wall to the robot, or NaN.
    pub normal: [f64; 3],
    /// The robot's closest point.
    pub on_robot: [f64; 3],
    /// The mesh's closest point.
    pub on_mesh: [f64; 3],
    /// Where along the segment, from 0 to 1.
    pub fraction: f64,
    /// How far along the centreline from the base.
    pub arc_length: f64,
    /// The segment of the input.
    pub segment: u32,
    /// The triangle.
    pub triangle: u32,
}

/// The derivative of the least distance, in the mesh's frame.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_derivative {
    /// The distance, or minus the least translation that separates robot and mesh.
    pub value: f64,
    /// With respect to the point where the closest segment starts. NaN where neither side of the
    /// triangle is the robot's.
    pub start: [f64; 3],
    /// With respect to the point where the closest segment ends.
    pub end: [f64; 3],
    /// With respect to the radius of the closest segment.
    pub radius: f64,
    /// The closest segment. The derivative with respect to all other points is 0.
    pub segment: u32,
    /// Whether other points are as close, which have another derivative.
    pub kink: bool,
}

/// Whether a robot keeps a margin, and on which side of the mesh it is.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_inside_answer {
    /// The side of the first point of the centreline.
    pub base: pc_side,
    /// The side of the last point of the centreline.
    pub tip: pc_side,
    /// Whether every link keeps more than the margin, on either side.
    pub clears: bool,
    /// Whether a link touches the lid of an opening of the mesh.
    pub crosses_opening: bool,
    /// Whether the whole robot is inside and every link keeps the margin.
    pub holds: bool,
}

/// Bounds on the clearance of a tube, or on the least clearance of a motion.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_clearance {
    /// The clearance is at least this.
    pub lower: f64,
    /// The clearance is at most this: 0 where the tube touches the mesh.
    pub upper: f64,
    /// The width of the bounds that stated errors cost and no finer tolerance removes.
    pub uncertainty: f64,
    /// The time of the shape that realises `upper`; 0 for a tube at rest.
    pub t: f64,
    /// A point of that shape.
    pub on_robot: [f64; 3],
    /// A point of the mesh, at most `upper` away.
    pub on_mesh: [f64; 3],
    /// How far along that shape's centreline from the base.
    pub arc_length: f64,
    /// The segment of the input there.
    pub segment: u32,
    /// The triangle there.
    pub triangle: u32,
    /// Whether the bounds are no farther apart than the tolerance and `uncertainty`.
    pub resolved: bool,
}

/// Whether a motion keeps a margin, until when, and which shape does not.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_motion_answer {
    /// Whether the margin is kept at every time from 0 to 1.
    pub decision: pc_decision,
    /// Why it is undecided.
    pub reason: pc_undecided_reason,
    /// The margin is kept before the first time, and may not be kept until the second.
    pub interval: [f64; 2],
    /// After a contact: the time of a shape that does not keep the margin; otherwise NaN.
    pub t: f64,
    /// The clearance of that shape is at most this.
    pub upper: f64,
    /// A point of that shape.
    pub on_robot: [f64; 3],
    /// A point of the mesh.
    pub on_mesh: [f64; 3],
    /// How far along that shape's centreline from the base.
    pub arc_length: f64,
    /// The segment of the input there, or `PC_NONE`.
    pub segment: u32,
    /// The triangle there, or `PC_NONE`.
    pub triangle: u32,
}

/// Where two robots, or two parts of one, are closest to each other.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_robot_proximity {
    /// The distance, 0 where they touch or overlap, and infinite where no parts of one robot could
    /// meet.
    pub distance: f64,
    /// The closest point of the first.
    pub on_first: [f64; 3],
    /// The closest point of the second.
    pub on_second: [f64; 3],
    /// How far along the centreline of each from its base.
    pub arc_lengths: [f64; 2],
    /// The link of each robot. Segments without length are no links.
    pub links: [u32; 2],
}

/// Bounds on how near two tubes are, or on how near two motions come.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_robot_clearance {
    /// The clearance is at least this.
    pub lower: f64,
    /// The clearance is at most this: 0 where they touch or overlap.
    pub upper: f64,
    /// The width of the bounds that stated errors cost and no finer tolerance removes.
    pub uncertainty: f64,
    /// The time of the shapes that realise `upper`; 0 for tubes at rest.
    pub t: f64,
    /// A point of the first robot.
    pub on_first: [f64; 3],
    /// A point of the second robot, at most `upper` away.
    pub on_second: [f64; 3],
    /// How far along the centreline of each from its base.
    pub arc_lengths: [f64; 2],
    /// Whether the bounds are no farther apart than the tolerance and `uncertainty`.
    pub resolved: bool,
}

/// Whether two moving robots, or two parts of one, keep a margin, and which shapes do not.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_robot_motion_answer {
    /// Whether the margin is kept at every time from 0 to 1.
    pub decision: pc_decision,
    /// Why it is undecided.
    pub reason: pc_undecided_reason,
    /// The margin is kept before the first time, and may not be kept until the second.
    pub interval: [f64; 2],
    /// After a contact: the time of two shapes that do not keep the margin; otherwise NaN.
    pub t: f64,
    /// The clearance of those shapes is at most this.
    pub upper: f64,
    /// A point of the first robot's shape.
    pub on_first: [f64; 3],
    /// A point of the second robot's shape.
    pub on_second: [f64; 3],
    /// How far along the centreline of each from its base.
    pub arc_lengths: [f64; 2],
}

/// Where robots are closest to one structure of a scene, in the scene's frame.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_structure_proximity {
    /// The distance of the closest robot.
    pub nearest: pc_minimum,
    /// The distance less the structure's margin, or NaN where it has none.
    pub slack: f64,
    /// The structure.
    pub structure: u32,
    /// The robot of the list that is closest.
    pub robot: u32,
}

/// A contact of a robot with a structure of a scene.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_scene_contact {
    /// The contact, in the scene's frame.
    pub contact: pc_contact,
    /// The structure.
    pub structure: u32,
    /// The robot of the list.
    pub robot: u32,
}

/// A place in a scene: of a structure and a robot, of two robots, or of a robot and itself.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_scene_place {
    /// A point of the first robot.
    pub on_first: [f64; 3],
    /// A point of the structure or the second robot.
    pub on_second: [f64; 3],
    /// How far along the centreline of each robot from its base; NaN for a structure.
    pub arc_lengths: [f64; 2],
    /// The structure, or `PC_NONE` between robots.
    pub structure: u32,
    /// The robot and `PC_NONE`, the two robots, or one robot twice.
    pub robots: [u32; 2],
    /// The triangle of the structure, or `PC_NONE`.
    pub triangle: u32,
}

/// The least slack in a scene: the distance less the margin.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_tightest {
    /// The least slack; infinite where nothing has a margin.
    pub slack: f64,
    /// Where it is.
    pub place: pc_scene_place,
}

/// Bounds on the least slack of tubes or motions in a scene.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_scene_clearance_answer {
    /// Every slack is at least this; infinite where nothing has a margin.
    pub lower: f64,
    /// The slack there is at most this.
    pub upper: f64,
    /// The width of the bounds that stated errors cost and no finer tolerance removes.
    pub uncertainty: f64,
    /// The time of the shapes that realise `upper`; 0 for tubes at rest.
    pub t: f64,
    /// Where it is.
    pub place: pc_scene_place,
    /// Whether the bounds are no farther apart than the tolerance and `uncertainty`.
    pub resolved: bool,
}

/// Whether robots that move in a scene keep all margins, and what does not.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_scene_motion_answer {
    /// Whether all margins are kept at every time from 0 to 1.
    pub decision: pc_decision,
    /// Why it is undecided.
    pub reason: pc_undecided_reason,
    /// All margins are kept before the first time, and may not be kept until the second.
    pub interval: [f64; 2],
    /// After a contact: the time of shapes that do not keep a margin; otherwise NaN.
    pub t: f64,
    /// The clearance of those shapes is at most this.
    pub upper: f64,
    /// Where it is.
    pub place: pc_scene_place,
}

/// What a mesh is as a surface, and what its file states.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct pc_surface {
    /// How many vertices it has.
    pub vertices: usize,
    /// How many triangles it has.
    pub triangles: usize,
    /// How many faces of its file are left out because they have no area.
    pub skipped_faces: usize,
    /// How many openings it has, through which a robot can leave.
    pub openings: usize,
    /// How many edges have more than two triangles.
    pub nonmanifold_edges: usize,
    /// How many edges have two triangles that face opposite ways.
    pub misoriented_edges: usize,
    /// Its frame: `PC_FRAME_UNKNOWN`, `PC_FRAME_RAS` or `PC_FRAME_LPS`.
    pub frame: u32,
    /// Whether it is closed, and all its triangles face the same way.
    pub is_sound: bool,
}

/// An answer with a place for robots of a batch that are refused.
pub(crate) trait Answer: Copy {
    /// Stands for a refused robot.
    const NONE: Self;
}

const NO_POINT: [f64; 3] = [f64::NAN; 3];

impl Answer for pc_minimum {
    const NONE: Self = Self {
        distance: f64::NAN,
        on_robot: NO_POINT,
        on_mesh: NO_POINT,
        arc_length: f64::NAN,
        segment: PC_NONE,
        triangle: PC_NONE,
    };
}

impl Answer for bool {
    const NONE: Self = false;
}

impl Answer for pc_decision {
    const NONE: Self = Self::PC_UNDECIDED;
}

impl Answer for pc_clearance {
    const NONE: Self = Self {
        lower: f64::NAN,
        upper: f64::NAN,
        uncertainty: f64::NAN,
        t: f64::NAN,
        on_robot: NO_POINT,
        on_mesh: NO_POINT,
        arc_length: f64::NAN,
        segment: PC_NONE,
        triangle: PC_NONE,
        resolved: false,
    };
}

impl Answer for pc_motion_answer {
    const NONE: Self = Self {
        decision: pc_decision::PC_UNDECIDED,
        reason: pc_undecided_reason::PC_REASON_NONE,
        interval: [f64::NAN; 2],
        t: f64::NAN,
        upper: f64::NAN,
        on_robot: NO_POINT,
        on_mesh: NO_POINT,
        arc_length: f64::NAN,
        segment: PC_NONE,
        triangle: PC_NONE,
    };
}

impl Answer for pc_robot_proximity {
    const NONE: Self = Self {
        distance: f64::INFINITY,
        on_first: NO_POINT,
        on_second: NO_POINT,
        arc_lengths: [f64::NAN; 2],
        links: [PC_NONE; 2],
    };
}

impl Answer for pc_robot_motion_answer {
    const NONE: Self = Self {
        decision: pc_decision::PC_UNDECIDED,
        reason: pc_undecided_reason::PC_REASON_NONE,
        interval: [f64::NAN; 2],
        t: f64::NAN,
        upper: f64::NAN,
        on_first: NO_POINT,
        on_second: NO_POINT,
        arc_lengths: [f64::NAN; 2],
    };
}

impl Answer for pc_tightest {
    const NONE: Self = Self { slack: f64::NAN, place: pc_scene_place::NONE };
}

impl Answer for pc_scene_motion_answer {
    const NONE: Self = Self {
        decision: pc_decision::PC_UNDECIDED,
        reason: pc_undecided_reason::PC_REASON_NONE,
        interval: [f64::NAN; 2],
        t: f64::NAN,
        upper: f64::NAN,
        place: pc_scene_place::NONE,
    };
}

impl Answer for pc_scene_place {
    const NONE: Self = Self {
        on_first: NO_POINT,
        on_second: NO_POINT,
        arc_lengths: [f64::NAN; 2],
        structure: PC_NONE,
        robots: [PC_NONE; 2],
        triangle: PC_NONE,
    };
}

fn point(point: Vector) -> [f64; 3] {
    point.to_array()
}

impl From<rust::Decision> for pc_decision {
    fn from(decision: rust::Decision) -> Self {
        match decision {
            rust::Decision::Clear => Self::PC_CLEAR,
            rust::Decision::Contact => Self::PC_CONTACT,
            rust::Decision::Undecided => Self::PC_UNDECIDED,
        }
    }
}

impl From<rust::Side> for pc_side {
    fn from(side: rust::Side) -> Self {
        match side {
            rust::Side::Inside => Self::PC_INSIDE,
            rust::Side::Outside => Self::PC_OUTSIDE,
            rust::Side::Undecided => Self::PC_UNDECIDED_SIDE,
        }
    }
}

impl From<Option<rust::UndecidedReason>> for pc_undecided_reason {
    fn from(reason: Option<rust::UndecidedReason>) -> Self {
        match reason {
            None => Self::PC_REASON_NONE,
            Some(rust::UndecidedReason::Work) => Self::PC_REASON_WORK,
            Some(_) => Self::PC_REASON_NEAR,
        }
    }
}

impl From<&rust::LinkProximity> for pc_minimum {
    fn from(found: &rust::LinkProximity) -> Self {
        let witness = &found.witness;
        Self {
            distance: found.distance,
            on_robot: point(witness.on_robot),
            on_mesh: point(witness.on_mesh),
            arc_length: witness.arc_length,
            segment: witness.segment,
            triangle: witness.triangle,
        }
    }
}

impl From<&rust::Contact> for pc_contact {
    fn from(found: &rust::Contact) -> Self {
        let witness = &found.witness;
        Self {
            distance: found.distance,
            depth: found.depth,
            normal: found.normal.map_or(NO_POINT, point),
            on_robot: point(witness.on_robot),
            on_mesh: point(witness.on_mesh),
            fraction: found.fraction,
            arc_length: witness.arc_length,
            segment: witness.segment,
            triangle: witness.triangle,
        }
    }
}

impl From<rust::InsideAnswer> for pc_inside_answer {
    fn from(found: rust::InsideAnswer) -> Self {
        Self {
            base: found.base.into(),
            tip: found.tip.into(),
            clears: found.clears,
            crosses_opening: found.crosses_opening,
            holds: found.holds(),
        }
    }
}

macro_rules! clearance {
    ($($from:ident at $t:expr),*) => {$(
        impl From<&rust::$from> for pc_clearance {
            fn from(found: &rust::$from) -> Self {
                let (witness, t) = (&found.witness, $t);
                Self {
                    lower: found.lower,
                    upper: found.upper,
                    uncertainty: found.uncertainty,
                    t: t(found),
                    on_robot: point(witness.on_robot),
                    on_mesh: point(witness.on_mesh),
                    arc_length: witness.arc_length,
                    segment: witness.segment,
                    triangle: witness.triangle,
                    resolved: found.resolved,
                }
            }
        }
    )*};
}
clearance!(
    Clearance at |_: &rust::Clearance| 0.0,
    MotionClearance at |found: &rust::MotionClearance| found.t
);

macro_rules! robot_clearance {
    ($($from:ident at $t:expr),*) => {$(
        impl From<&rust::$from> for pc_robot_clearance {
            fn from(found: &rust::$from) -> Self {
                let (witness, t) = (&found.witness, $t);
                Self {
                    lower: found.lower,
                    upper: found.upper,
                    uncertainty: found.uncertainty,
                    t: t(found),
                    on_first: point(witness.on_first),
                    on_second: point(witness.on_second),
                    arc_lengths: witness.arc_lengths,
                    resolved: found.resolved,
                }
            }
        }
    )*};
}
robot_clearance!(
    RobotClearance at |_: &rust::RobotClearance| 0.0,
    RobotMotionClearance at |found: &rust::RobotMotionClearance| found.t
);

impl From<&rust::MotionAnswer> for pc_motion_answer {
    fn from(found: &rust::MotionAnswer) -> Self {
        let (decision, reason) = (found.decision.into(), found.reason.into());
        let answer = Self { decision, reason, interval: found.interval, ..Self::NONE };
        let Some(shape) = &found.contact else { return answer };
        Self {
            t: shape.t,
            upper: shape.upper,
            on_robot: point(shape.witness.on_robot),
            on_mesh: point(shape.witness.on_mesh),
            arc_length: shape.witness.arc_length,
            segment: shape.witness.segment,
            triangle: shape.witness.triangle,
            ..answer
        }
    }
}

impl From<&rust::RobotProximity> for pc_robot_proximity {
    fn from(found: &rust::RobotProximity) -> Self {
        let witness = &found.witness;
        Self {
            distance: found.distance,
            on_first: point(witness.on_first),
            on_second: point(witness.on_second),
            arc_lengths: witness.arc_lengths,
            links: found.links,
        }
    }
}

impl From<&rust::RobotMotionAnswer> for pc_robot_motion_answer {
    fn from(found: &rust::RobotMotionAnswer) -> Self {
        let (decision, reason) = (found.decision.into(), found.reason.into());
        let answer = Self { decision, reason, interval: found.interval, ..Self::NONE };
        let Some(shapes) = &found.contact else { return answer };
        Self {
            t: shapes.t,
            upper: shapes.upper,
            on_first: point(shapes.witness.on_first),
            on_second: point(shapes.witness.on_second),
            arc_lengths: shapes.witness.arc_lengths,
            ..answer
        }
    }
}

impl From<&rust::StructureProximity> for pc_structure_proximity {
    fn from(found: &rust::StructureProximity) -> Self {
        Self {
            nearest: (&found.nearest).into(),
            slack: found.slack.unwrap_or(f64::NAN),
            structure: found.structure,
            robot: found.robot,
        }
    }
}

impl From<&rust::SceneContact> for pc_scene_contact {
    fn from(found: &rust::SceneContact) -> Self {
        Self { contact: (&found.contact).into(), structure: found.structure, robot: found.robot }
    }
}

impl pc_scene_place {
    fn of_structure(structure: u32, robot: u32, witness: &rust::Witness) -> Self {
        Self {
            on_first: point(witness.on_robot),
            on_second: point(witness.on_mesh),
            arc_lengths: [witness.arc_length, f64::NAN],
            structure,
            robots: [robot, PC_NONE],
            triangle: witness.triangle,
        }
    }

    fn of_robots(robots: [u32; 2], witness: &rust::PairWitness) -> Self {
        Self {
            on_first: point(witness.on_first),
            on_second: point(witness.on_second),
            arc_lengths: witness.arc_lengths,
            robots,
            ..Self::NONE
        }
    }
}

impl From<&ScenePlace> for pc_scene_place {
    fn from(place: &ScenePlace) -> Self {
        match place {
            ScenePlace::Structure { structure, robot, witness, .. } => {
                Self::of_structure(*structure, *robot, witness)
            }
            ScenePlace::Robots { robots, witness, .. } => Self::of_robots(*robots, witness),
            _ => Self::NONE,
        }
    }
}

impl From<Option<rust::Tightest>> for pc_tightest {
    fn from(found: Option<rust::Tightest>) -> Self {
        let Some(found) = found else {
            return Self { slack: f64::INFINITY, place: pc_scene_place::NONE };
        };
        let place = match &found.between {
            Between::Structure(found) => {
                pc_scene_place::of_structure(found.structure, found.robot, &found.nearest.witness)
            }
            Between::Robots { robots, nearest } => {
                pc_scene_place::of_robots(*robots, &nearest.witness)
            }
            _ => pc_scene_place::NONE,
        };
        Self { slack: found.slack, place }
    }
}

macro_rules! scene_clearance {
    ($($from:ident at $t:expr),*) => {$(
        impl From<Option<rust::$from>> for pc_scene_clearance_answer {
            fn from(found: Option<rust::$from>) -> Self {
                let t = $t;
                match &found {
                    Some(found) => Self {
                        lower: found.lower,
                        upper: found.upper,
                        uncertainty: found.uncertainty,
                        t: t(found),
                        place: (&found.place).into(),
                        resolved: found.resolved,
                    },
                    None => Self {
                        lower: f64::INFINITY,
                        upper: f64::INFINITY,
                        uncertainty: 0.0,
                        t: 0.0,
                        place: pc_scene_place::NONE,
                        resolved: true,
                    },
                }
            }
        }
    )*};
}
scene_clearance!(
    SceneClearance at |_: &rust::SceneClearance| 0.0,
    SceneMotionClearance at |found: &rust::SceneMotionClearance| found.t
);

impl From<&rust::SceneMotionAnswer> for pc_scene_motion_answer {
    fn from(found: &rust::SceneMotionAnswer) -> Self {
        let contact = found.contact.as_ref();
        let place = contact.map_or(pc_scene_place::NONE, |contact| match contact {
            SceneMotionContact::Structure { structure, robot, shape } => {
                pc_scene_place::of_structure(*structure, *robot, &shape.witness)
            }
            SceneMotionContact::Robots { robots, shapes } => {
                pc_scene_place::of_robots(*robots, &shapes.witness)
            }
            SceneMotionContact::Itself { robot, shapes } => {
                pc_scene_place::of_robots([*robot; 2], &shapes.witness)
            }
            _ => pc_scene_place::NONE,
        });
        Self {
            decision: found.decision.into(),
            reason: found.reason.into(),
            interval: found.interval,
            t: contact.map_or(f64::NAN, SceneMotionContact::t),
            upper: contact.map_or(f64::NAN, SceneMotionContact::upper),
            place,
        }
    }
}
