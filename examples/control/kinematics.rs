//! The robot's points, and how they change with its joints.

use continuum_demo::ctr::{Joints, Robot, three_tubes};
use continuum_demo::ventricle;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::Contact;

/// Three extensions (mm) and three angles (rad).
pub const JOINTS: usize = 6;

/// Links of each section.
const LINKS: [usize; 3] = [12, 12, 6];

/// The robot at its joints, with the derivative of every point.
pub struct Kinematics {
    robot: Robot,
    joints: Joints,
    points: Vec<Vector>,
    /// For each joint, the velocity of every point.
    velocities: [Vec<Vector>; JOINTS],
    radii: Vec<Real>,
}

impl Kinematics {
    pub fn new() -> Self {
        let robot = three_tubes();
        let joints = robot.on_the_way(&ventricle::goal(), 0.97);
        let radii = robot.sections.iter().zip(LINKS);
        let radii =
            radii.flat_map(|(section, links)| std::iter::repeat_n(section.radius, links)).collect();
        let mut new =
            Self { robot, joints, points: Vec::new(), velocities: Default::default(), radii };
        new.update();
        new
    }

    /// Points and velocities at the joints as they are; the velocities by central differences.
    pub fn update(&mut self) {
        const STEP: Real = 1e-6;
        self.points = points(&self.robot, &self.joints);
        for joint in 0..JOINTS {
            let moved = |by: Real| {
                let mut joints = self.joints.clone();
                *value(&mut joints, joint) += by;
                points(&self.robot, &joints)
            };
            let (ahead, behind) = (moved(STEP), moved(-STEP));
            let velocity = |(ahead, behind): (&Vector, &Vector)| (ahead - behind) / (2.0 * STEP);
            self.velocities[joint] = ahead.iter().zip(&behind).map(velocity).collect();
        }
    }

    /// The joints after a tick.
    pub fn step(&mut self, speeds: &[Real; JOINTS], tick: Real) {
        for (joint, speed) in speeds.iter().enumerate() {
            let longest = self.robot.sections.get(joint).map(|section| section.length - 0.1);
            let value = value(&mut self.joints, joint);
            *value += speed * tick;
            if let Some(longest) = longest {
                *value = value.max(0.1).min(longest);
            }
        }
    }

    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    pub fn radii(&self) -> &[Real] {
        &self.radii
    }

    pub fn tip(&self) -> Vector {
        self.points[self.points.len() - 1]
    }

    pub fn tip_jacobian(&self) -> [Vector; JOINTS] {
        std::array::from_fn(|joint| self.velocities[joint][self.points.len() - 1])
    }

    /// How a contact's distance changes with each joint: that of the axis point and the turn of its
    /// link, n . J.
    pub fn rates(&self, robot: &Chain, pose: &Pose, contact: &Contact) -> Option<[Real; JOINTS]> {
        let link = contact.link as usize;
        let along = robot.links()[link].end() - robot.links()[link].start();
        let mut rates = [0.0; JOINTS];
        for (rate, velocities) in rates.iter_mut().zip(&self.velocities) {
            let (start, end) = (velocities[link], velocities[link + 1]);
            let velocity = pose.rotation * start.lerp(end, contact.fraction);
            let turn = pose.rotation * (along.cross(end - start) / along.length_squared());
            *rate = contact.rate(velocity, turn)?;
        }
        Some(rates)
    }
}

fn value(joints: &mut Joints, joint: usize) -> &mut Real {
    if joint < 3 { &mut joints.extensions[joint] } else { &mut joints.angles[joint - 3] }
}

/// The ends of the links; their number does not depend on the joints.
fn points(robot: &Robot, joints: &Joints) -> Vec<Vector> {
    let (mut arc_lengths, mut from) = (vec![0.0], 0.0);
    for (extension, links) in joints.extensions.iter().zip(LINKS) {
        arc_lengths.extend((1..=links).map(|k| from + extension * k as Real / links as Real));
        from += extension;
    }
    robot.frames(joints, &arc_lengths).into_iter().map(|frame| frame.translation).collect()
}
