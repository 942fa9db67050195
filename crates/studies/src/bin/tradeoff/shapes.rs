//! The robot's shapes: joints drawn from a seed, and stations along the curve of each.

use continuum_demo::ctr::{Centreline, Joints, Robot};
use continuum_demo::steer::Random;
use parry_continuum::parry::math::{Real, Vector};
use std::f64::consts::TAU;

/// The largest extension of a shape: one of these shares of each section's length, each equally
/// likely.
pub const REACHES: [Real; 3] = [0.15, 0.3, 0.6];

/// Random joints: every extension and angle uniform within the reach.
pub fn draw(robot: &Robot, random: &mut Random) -> Joints {
    let reach = REACHES[(random.share() * REACHES.len() as Real) as usize];
    let extensions =
        robot.sections.iter().map(|section| section.length * reach * random.share()).collect();
    let tubes: usize = robot.sections.iter().map(|section| section.tubes.len()).sum();
    Joints { extensions, angles: (0..tubes).map(|_| TAU * random.share()).collect() }
}

/// The joints a step of a slow motion earlier: every section out by 0.1 mm less, every tube turned
/// by 0.01 rad less.
pub fn step_before(joints: &Joints) -> Joints {
    Joints {
        extensions: joints.extensions.iter().map(|out| (out - 0.1).max(0.9 * out)).collect(),
        angles: joints.angles.iter().map(|angle| angle - 0.01).collect(),
    }
}

/// How far from a flat face the samples lie that fix its direction, mm.
const AT_FACE: [Real; 2] = [0.01, 0.3];

/// Arc lengths along the robot, from 0 to its tip, and the radius between each two.
pub struct Stations {
    pub arc_lengths: Vec<Real>,
    pub radii: Vec<Real>,
}

impl Stations {
    /// Of each section that is out as `divide` says, which gets the section's extension and answers
    /// with ascending arc lengths, 0 left out and the extension included.
    fn of(robot: &Robot, joints: &Joints, divide: impl Fn(Real) -> Vec<Real>) -> Self {
        let (mut arc_lengths, mut radii, mut from) = (vec![0.0], Vec::new(), 0.0);
        for (section, &extension) in robot.sections.iter().zip(&joints.extensions) {
            if extension > 0.0 {
                let division = divide(extension);
                radii.extend(std::iter::repeat_n(section.radius, division.len()));
                arc_lengths.extend(division.iter().map(|s| from + s));
                from += extension;
            }
        }
        Self { arc_lengths, radii }
    }

    /// Even samples, at most `spacing` apart, and the samples that fix the directions of faces.
    pub fn even(robot: &Robot, joints: &Joints, spacing: Real) -> Self {
        let near = |extension: Real| AT_FACE.into_iter().filter(move |off| *off < 0.5 * extension);
        Self::of(robot, joints, |extension| {
            let count = (extension / spacing).ceil().max(1.0);
            let mut all: Vec<_> =
                (1..=count as usize).map(|k| extension * k as Real / count).collect();
            // At a section's start too, because the base has a face.
            all.extend(near(extension).flat_map(|off| [off, extension - off]));
            all.sort_by(Real::total_cmp);
            all.dedup();
            all
        })
    }

    /// No further than `spacing` apart, and ever closer towards the flat faces at which sections
    /// begin and end, to a hundredth of that: a face follows the direction of the segment that
    /// ends there.
    pub fn graded(robot: &Robot, joints: &Joints, spacing: Real) -> Self {
        Self::of(robot, joints, |extension| {
            let (mut from_face, mut at, mut step) = (Vec::new(), 0.0, 0.01 * spacing);
            while at + step < 0.5 * extension {
                at += step;
                from_face.push(at);
                step = (1.5 * step).min(spacing);
            }
            let before_end = from_face.iter().rev().map(|at| extension - at);
            from_face.iter().copied().chain(before_end).chain([extension]).collect()
        })
    }

    /// The directions of the curve at its ends.
    pub fn tangents(&self, robot: &Robot, joints: &Joints) -> [Vector; 2] {
        let curve = robot.curve(joints);
        [0.0, robot.length(joints)].map(|arc_length| curve.at(arc_length).1)
    }

    /// The curve through the stations, of tubes that do not twist.
    pub fn curve(&self, robot: &Robot, joints: &Joints) -> Centreline {
        let frames = robot.frames(joints, &self.arc_lengths);
        Centreline {
            points: frames.into_iter().map(|frame| frame.translation).collect(),
            radii: self.radii.clone(),
        }
    }
}
