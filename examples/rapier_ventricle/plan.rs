//! The planned motion: the tubes extend along a planned shape, then the base is pushed on.

use continuum_demo::ctr::{Joints, Robot};
use continuum_demo::rod::RestShape;
use parry_continuum::parry::math::{Pose, Real, Vector};

/// Bending stiffness that stands for 1 in the robot's ratios, in mN mm^2: soft, as a robot of
/// polymer tubes is.
const STIFFNESS: Real = 9e4;

/// Speeds of the tubes and of the base, in mm/s, and the time at the end to come to rest in, in s.
const EXTENSION_SPEED: Real = 20.0;
const PUSH_SPEED: Real = 8.0;
const REST: Real = 0.4;

/// The plan.
pub struct Plan {
    pub robot: Robot,
    pub goal: Joints,
    /// The base in the mesh's frame.
    pub entry: Pose,
    /// How far the base is pushed in the end, in mm.
    pub push: Real,
    /// Arc lengths from the base at which a link of the whole robot ends, and its section.
    stations: Vec<(Real, usize)>,
}

/// Where the plan has got to.
#[derive(Clone, Copy)]
pub struct Progress {
    /// The length that is out, in mm.
    pub out: Real,
    /// How far the base has been pushed, in mm.
    pub pushed: Real,
}

impl Plan {
    /// A plan for about `links` links.
    pub fn new(robot: Robot, goal: Joints, entry: Pose, push: Real, links: usize) -> Self {
        let (whole, mut from, mut stations) = (robot.length(&goal), 0.0, Vec::new());
        for (section, &extension) in goal.extensions.iter().enumerate() {
            if extension > 0.0 {
                let count = (extension / whole * links as Real).round().max(1.0) as usize;
                let end = |k: usize| from + extension * k as Real / count as Real;
                stations.extend((1..=count).map(|k| (end(k), section)));
                from += extension;
            }
        }
        Self { robot, goal, entry, push, stations }
    }

    /// How long it all takes, in s.
    pub fn duration(&self) -> Real {
        self.robot.length(&self.goal) / EXTENSION_SPEED + self.push / PUSH_SPEED + REST
    }

    /// The state after `time` s. The first link is out from the beginning.
    pub fn at(&self, time: Real) -> Progress {
        let whole = self.robot.length(&self.goal);
        let first = self.stations.first().map_or(whole, |station| station.0);
        let out = (EXTENSION_SPEED * time).max(first).min(whole);
        let pushed = (PUSH_SPEED * (time - whole / EXTENSION_SPEED)).max(0.0).min(self.push);
        Progress { out, pushed }
    }

    /// The base's pose in the mesh's frame.
    pub fn base(&self, progress: Progress) -> Pose {
        self.entry * Pose::from_translation(Vector::Z * progress.pushed)
    }

    /// The kinematic shape: a joint at every station that is out, and the tip. A last link that
    /// would be shorter than a quarter of its final length is part of the one before.
    pub fn shape(&self, progress: Progress) -> RestShape {
        let joints =
            self.robot.on_the_way(&self.goal, progress.out / self.robot.length(&self.goal));
        let (mut arc_lengths, mut sections) = (vec![0.0], Vec::new());
        for (k, &(end, section)) in self.stations.iter().enumerate() {
            let start = if k == 0 { 0.0 } else { self.stations[k - 1].0 };
            if k == 0 || progress.out > start + 0.25 * (end - start) {
                arc_lengths.push(end);
                sections.push(section);
            }
        }
        if let Some(tip) = arc_lengths.last_mut() {
            *tip = progress.out;
        }
        let frames = self.robot.frames(&joints, &arc_lengths);
        RestShape {
            points: frames.iter().map(|frame| frame.translation).collect(),
            radii: sections.iter().map(|&section| self.robot.sections[section].radius).collect(),
            // The tubes of a section and of all further in lie in each other there.
            stiffness: sections
                .iter()
                .map(|&section| STIFFNESS * self.stiffness_from(section))
                .collect(),
        }
    }

    fn stiffness_from(&self, section: usize) -> Real {
        let tubes = self.robot.sections[section..].iter().flat_map(|section| &section.tubes);
        tubes.map(|tube| tube.stiffness).sum()
    }
}
