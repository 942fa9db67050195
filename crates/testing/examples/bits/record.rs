//! Answers as numbers, mixed into one hash a question.

use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::{Contact as ParryContact, ShapeCastHit};
use parry_continuum::proximity::{
    Between, Clearance, Contact, Decision, LinkProximity, MotionAnswer, MotionClearance, Proof,
    RobotClearance, RobotMotionAnswer, RobotProximity, Tightest, Witness,
};

/// All numbers of one kind of question, in the order of the answers (FNV-1a).
pub struct Record {
    pub name: &'static str,
    pub numbers: usize,
    pub hash: u64,
}

/// What a record can take: an answer is the numbers that must be the same on every run.
pub trait Answer {
    fn visit(&self, add: &mut impl FnMut(f64));
}

impl Record {
    pub fn new(name: &'static str) -> Self {
        Self { name, numbers: 0, hash: 0xcbf2_9ce4_8422_2325 }
    }

    pub fn add(&mut self, answer: &(impl Answer + ?Sized)) {
        let Self { numbers, hash, .. } = self;
        answer.visit(&mut |number| {
            *numbers += 1;
            for byte in number.to_bits().to_le_bytes() {
                *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        });
    }
}

impl Answer for f64 {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(*self);
    }
}

impl Answer for bool {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(f64::from(u8::from(*self)));
    }
}

impl Answer for Vector {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.to_array().into_iter().for_each(add);
    }
}

impl Answer for Pose {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.translation.visit(add);
        self.rotation.to_array().into_iter().for_each(add);
    }
}

/// An answer that is absent counts as infinite.
impl<A: Answer> Answer for Option<A> {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        match self {
            Some(answer) => answer.visit(add),
            None => add(f64::INFINITY),
        }
    }
}

/// An error counts as one number of its own.
impl<A: Answer, E> Answer for Result<A, E> {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        match self {
            Ok(answer) => answer.visit(add),
            Err(_) => add(f64::NEG_INFINITY),
        }
    }
}

impl<A: Answer> Answer for [A] {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.iter().for_each(|answer| answer.visit(add));
    }
}

impl Answer for Witness {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.on_robot.visit(add);
        self.on_mesh.visit(add);
        [f64::from(self.triangle), self.arc_length].visit(add);
    }
}

impl Answer for LinkProximity {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        [f64::from(self.link), self.distance].visit(add);
        self.witness.visit(add);
    }
}

impl Answer for Contact {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        [f64::from(self.link), self.distance, self.fraction].visit(add);
        self.depth.visit(add);
        self.normal.visit(add);
        self.lever.visit(add);
        self.witness.visit(add);
    }
}

impl Answer for Decision {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(match self {
            Self::Clear => 1.0,
            Self::Undecided => 0.0,
            Self::Contact => -1.0,
        });
    }
}

impl Answer for Clearance {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        [self.lower, self.upper].visit(add);
        self.resolved.visit(add);
        self.witness.visit(add);
    }
}

impl Answer for MotionAnswer {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.decision.visit(add);
        self.interval.visit(add);
    }
}

impl Answer for RobotMotionAnswer {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.decision.visit(add);
        self.interval.visit(add);
    }
}

impl Answer for MotionClearance {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        [self.lower, self.upper].visit(add);
        self.resolved.visit(add);
    }
}

impl Answer for RobotProximity {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.links.map(f64::from).visit(add);
        add(self.distance);
        self.witness.on_first.visit(add);
        self.witness.on_second.visit(add);
    }
}

impl Answer for RobotClearance {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        [self.lower, self.upper].visit(add);
        self.resolved.visit(add);
        self.witness.on_first.visit(add);
        self.witness.on_second.visit(add);
    }
}

impl Answer for Tightest {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(self.slack);
        match &self.between {
            Between::Structure(found) => {
                [found.structure, found.robot].map(f64::from).visit(add);
                found.nearest.visit(add);
            }
            Between::Robots { robots, nearest, .. } => {
                robots.map(f64::from).visit(add);
                nearest.visit(add);
            }
            _ => add(f64::NAN),
        }
    }
}

impl Answer for Proof {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        self.to_string().bytes().for_each(|byte| add(f64::from(byte)));
    }
}

impl Answer for ParryContact {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(self.dist);
        [self.point1, self.point2, self.normal1, self.normal2].visit(add);
    }
}

impl Answer for ShapeCastHit {
    fn visit(&self, add: &mut impl FnMut(f64)) {
        add(self.time_of_impact);
        [self.witness1, self.witness2, self.normal1, self.normal2].visit(add);
    }
}
