//! An elastic robot in a rapier world: one body per link, joints that bend.
//!
//! Without forces the robot has its *rest shape*: the rest angle of each joint is the angle of the
//! kinematic centreline there. A joint holds its two links
//! together and turns them back towards that angle with the moment `EI / l` per radian, `EI` being
//! the bending stiffness of the tubes there and `l` the length of robot that the joint stands for;
//! so the chain of links bends as a beam does. Twist is resisted as bending is.
//!
//! Left out: that the tubes slide along and turn in each other under load, that they twist, shear
//! and lengthen, and friction. Masses are made up: everything is so slow and so damped that the
//! shape is an equilibrium at every step, which no mass enters. They are large enough for the
//! solver to be stable.

use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::{Chain, ModifiedCylinder, RobotError, rapier};
use rapier3d_f64::prelude::*;

/// Mass of a link in kg and, times mm^2, its moments of inertia.
const MASS: Real = 2e-4;
const INERTIA: Real = 2e-4;
/// How long a bent joint takes to straighten, in s, and how fast the surroundings take away motion,
/// per s.
const RELAXATION: Real = 2e-2;
const DAMPING: Real = 5.0;

/// The shape that the robot has without forces, in the frame of its base: the base at the origin,
/// along z.
pub struct RestShape {
    /// Joints and tip.
    pub points: Vec<Vector>,
    /// Of each link.
    pub radii: Vec<Real>,
    /// Bending stiffness of the tubes at each link, in mN mm^2.
    pub stiffness: Vec<Real>,
}

/// A link in the world.
struct Link {
    body: RigidBodyHandle,
    collider: ColliderHandle,
    joint: MultibodyJointHandle,
    /// Length, from the body's origin along its z.
    length: Real,
}

/// The robot.
pub struct Rod {
    base: RigidBodyHandle,
    links: Vec<Link>,
}

/// What the robot's colliders belong to. They meet the wall and not each other.
const ROBOT: Group = Group::GROUP_1;

impl Rod {
    /// A robot without links at `base`.
    pub fn new(world: &mut PhysicsWorld, base: Pose) -> Self {
        let base = world.insert_body(RigidBodyBuilder::fixed().pose(base));
        Self { base, links: Vec::new() }
    }

    /// Moves the base. rapier takes the root of a multibody along only if it is put there.
    pub fn push(&self, world: &mut PhysicsWorld, base: Pose) {
        world.bodies[self.base].set_position(base, true);
    }

    /// Gives the robot another rest shape, with as many links as before or more. New links appear
    /// at the tip, unbent.
    ///
    /// # Errors
    /// The shape is no chain.
    pub fn set_rest_shape(
        &mut self,
        world: &mut PhysicsWorld,
        rest: &RestShape,
    ) -> Result<(), RobotError> {
        let chain = Chain::from_centreline(&rest.points, &rest.radii)?;
        let (mut heading, mut direction) = (Rot3::IDENTITY, Vector::Z);
        for (k, link) in chain.links().iter().enumerate() {
            let turn = Rot3::from_rotation_arc(direction, link.axis());
            // Carried along without twist.
            let next = turn * heading;
            let bend = heading.inverse() * next;
            (heading, direction) = (next, link.axis());

            let start = if k == 0 { 0.0 } else { self.links[k - 1].length };
            let local = ModifiedCylinder::new(
                Vector::ZERO,
                Vector::Z * link.length(),
                link.radius(),
                link.caps(),
            )?;
            if let Some(old) = self.links.get_mut(k) {
                old.length = link.length();
                let collider = &mut world.colliders[old.collider];
                if collider.shape().as_shape::<ModifiedCylinder>() != Some(&local) {
                    collider.set_shape(SharedShape::new(local));
                }
            } else {
                self.grow(world, local, Pose::from_parts(Vector::Z * start, bend));
            }
            // Half a link on either side bends at an inner joint, half a link at the base.
            let half = |k: usize| 0.5 * self.links[k].length / rest.stiffness[k];
            let compliance = if k == 0 { half(0) } else { half(k - 1) + half(k) };
            if let Some((robot, id)) = world.multibody_joints.get_mut(self.links[k].joint)
                && let Some(link) = robot.link_mut(id)
            {
                link.joint.data.set_local_frame1(Pose::from_parts(Vector::Z * start, bend));
                (3..6).for_each(|axis| link.joint.set_spring(axis, 1.0 / compliance, 0.0));
                let first = link.assembly_id();
                robot.damping_mut().rows_mut(first, 3).fill(RELAXATION / compliance);
            }
        }
        Ok(())
    }

    /// A link more, at `place` in the frame of the one before.
    fn grow(&mut self, world: &mut PhysicsWorld, shape: ModifiedCylinder, place: Pose) {
        let before = self.links.last().map_or(self.base, |link| link.body);
        let pose = *world.bodies[before].position() * place;
        let middle = Vector::Z * 0.5 * shape.length();
        let body = RigidBodyBuilder::dynamic()
            .pose(pose)
            .additional_mass_properties(MassProperties::new(middle, MASS, Vector::splat(INERTIA)))
            .linear_damping(DAMPING)
            .angular_damping(DAMPING)
            .can_sleep(false);
        let collider = ColliderBuilder::new(SharedShape::new(shape))
            .density(0.0)
            .friction(0.0)
            .friction_combine_rule(CoefficientCombineRule::Min)
            .collision_groups(InteractionGroups::new(ROBOT, !ROBOT, InteractionTestMode::And));
        let (body, collider) = world.insert(body, collider);
        let joint =
            SphericalJointBuilder::new().local_anchor1(place.translation).contacts_enabled(false);
        if let Some(joint) = world.insert_multibody_joint(before, body, joint) {
            self.links.push(Link { body, collider, joint, length: shape.length() });
        }
    }

    /// The joints and the tip where they are, in the world.
    pub fn points(&self, world: &PhysicsWorld) -> Vec<Vector> {
        let joints = self.links.iter().map(|link| world.bodies[link.body].position().translation);
        joints.chain(self.tip(world).map(|(_, tip)| tip)).collect()
    }

    /// The force with which the wall holds each link, in mN.
    pub fn forces(&self, world: &PhysicsWorld) -> Vec<Real> {
        let force = |link: &Link| {
            let impulses = world.contact_pairs_with(link.collider).map(|pair| pair.total_impulse());
            impulses.sum::<Vector>().length() / world.integration_parameters.dt
        };
        self.links.iter().map(force).collect()
    }

    /// The body of the last link, and where its tip is in the world.
    pub fn tip(&self, world: &PhysicsWorld) -> Option<(RigidBodyHandle, Vector)> {
        self.links
            .last()
            .map(|link| (link.body, world.bodies[link.body].position() * (Vector::Z * link.length)))
    }
}

/// Prepares a world of millimetres, kilogrammes and seconds, so that forces are in mN, without
/// gravity.
///
/// # Errors
/// The size is no size.
pub fn world(size: Real) -> Result<PhysicsWorld, rapier::BadSize> {
    let mut world = PhysicsWorld { gravity: Vector::ZERO, ..Default::default() };
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, size)?;
    let parameters = &mut world.integration_parameters;
    parameters.dt = 1e-3;
    // The joints are part of the equations of motion; only contacts are left to iterate for.
    parameters.num_solver_iterations = 1;
    parameters.contact_softness.natural_frequency = 0.5 / parameters.dt;
    parameters.static_contact_softness.natural_frequency = 1.0 / parameters.dt;
    Ok(world)
}
