//! Bodies thrown onto walls in rapier's worlds, and what is observed of them step by step.
//!
//! # Definitions
//! - *Moving step*: the velocity after the step moves an end of the body by more than
//!   `SLOW` lengths a second.
//! - *Held step*: a moving step in which the end that moves fastest moves by less than 1 % of what
//!   its velocity says. The velocity is the one after the step, so no contact pushes it back.
//! - *Rise*: the largest energy above the least energy before, as a share of `m g u`, where `u` is
//!   the unit of length.

use crate::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::shape::{Compound, HeightField, TriMesh};
use parry_continuum::parry::utils::Array2;
use parry_continuum::rapier::rapier3d_f64::prelude::*;
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder, rapier};

/// The radius of all bodies. They are 3 long.
pub const RADIUS: Real = 0.08;
/// The speed below which an end counts as still, in lengths a second.
const SLOW: Real = 0.05;

/// What is thrown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ThrownBody {
    /// One link with round caps.
    RoundLink,
    /// One link with flat caps.
    FlatLink,
    /// The round link as a part of parry's compound.
    CompoundOfRoundLink,
    /// The flat link as a part of parry's compound.
    CompoundOfFlatLink,
    /// A capsule in place of the round link.
    CompoundOfCapsule,
    /// A bent chain of 12 links.
    Chain,
    /// The links of that chain as parry's compound.
    CompoundOfLinks,
    /// The chain with capsules in place of its links.
    CompoundOfCapsules,
}

impl ThrownBody {
    /// All bodies.
    pub const ALL: [Self; 8] = [
        Self::RoundLink,
        Self::CompoundOfRoundLink,
        Self::CompoundOfCapsule,
        Self::FlatLink,
        Self::CompoundOfFlatLink,
        Self::Chain,
        Self::CompoundOfLinks,
        Self::CompoundOfCapsules,
    ];

    /// What a table calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::RoundLink => "a link, round caps",
            Self::FlatLink => "a link, flat caps",
            Self::CompoundOfRoundLink => "that link as a compound",
            Self::CompoundOfFlatLink => "that link as a compound",
            Self::CompoundOfCapsule => "a capsule as a compound",
            Self::Chain => "a chain of 12 links",
            Self::CompoundOfLinks => "a compound of these links",
            Self::CompoundOfCapsules => "a compound of capsules",
        }
    }

    /// The compounds that this robot is compared with; none for a compound.
    pub fn compounds(self) -> &'static [Self] {
        match self {
            Self::RoundLink => &[Self::CompoundOfRoundLink, Self::CompoundOfCapsule],
            Self::FlatLink => &[Self::CompoundOfFlatLink],
            Self::Chain => &[Self::CompoundOfLinks, Self::CompoundOfCapsules],
            _ => &[],
        }
    }

    /// The robot whose mass the body has.
    fn robot(self) -> Self {
        let of = |robot: &Self| *robot == self || robot.compounds().contains(&self);
        Self::ALL.into_iter().find(of).unwrap_or(self)
    }

    fn shape(self, unit: Real) -> SharedShape {
        let (half, radius) = (1.4 * unit * Vector::Z, RADIUS * unit);
        let link = |cap| ModifiedCylinder::new(-half, half, radius, [cap; 2]).unwrap();
        let compound = |parts: &[SharedShape]| {
            let placed = parts.iter().map(|part| (Pose::IDENTITY, part.clone())).collect();
            SharedShape::new(Compound::new(placed))
        };
        let capsule =
            |link: &ModifiedCylinder| SharedShape::capsule(link.start(), link.end(), link.radius());
        let parts = |part: &dyn Fn(&ModifiedCylinder) -> SharedShape| {
            compound(&chain(unit).links().iter().map(part).collect::<Vec<_>>())
        };
        match self {
            Self::RoundLink => SharedShape::new(link(Cap::Round)),
            Self::FlatLink => SharedShape::new(link(Cap::Flat)),
            Self::CompoundOfRoundLink => compound(&[SharedShape::new(link(Cap::Round))]),
            Self::CompoundOfFlatLink => compound(&[SharedShape::new(link(Cap::Flat))]),
            Self::CompoundOfCapsule => compound(&[capsule(&link(Cap::Round))]),
            Self::Chain => SharedShape::new(chain(unit)),
            Self::CompoundOfLinks => parts(&|link| SharedShape::new(*link)),
            Self::CompoundOfCapsules => parts(&capsule),
        }
    }

    /// The ends of the body's axis.
    fn ends(self, unit: Real) -> [Vector; 2] {
        match self.robot() {
            Self::RoundLink | Self::FlatLink => [-1.4, 1.4].map(|z| z * unit * Vector::Z),
            _ => {
                let chain = chain(unit);
                [chain.links()[0].start(), chain.links()[11].end()]
            }
        }
    }
}

/// A gentle bend of 12 links.
fn chain(unit: Real) -> Chain {
    let point = |k: u32| {
        let z = 0.237 * (Real::from(k) - 6.0);
        unit * Vector::new(0.1 * z * z, 0.03 * z * z * z, z)
    };
    Chain::capsules(&(0..=12).map(point).collect::<Vec<_>>(), &[RADIUS * unit; 12]).unwrap()
}

/// What the bodies are thrown onto.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wall {
    /// Two triangles like a roof.
    Mesh,
    /// The same with the flag that fixes internal edges.
    FlaggedMesh,
    /// A half-space.
    HalfSpace,
    /// The upper face of a box.
    Box,
    /// A bumpy height field.
    HeightField,
}

impl Wall {
    /// All walls.
    pub const ALL: [Self; 5] =
        [Self::Mesh, Self::FlaggedMesh, Self::HalfSpace, Self::Box, Self::HeightField];

    /// What a table calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::FlaggedMesh => "mesh with `FIX_INTERNAL_EDGES`",
            Self::HalfSpace => "half-space",
            Self::Box => "box",
            Self::HeightField => "height field",
        }
    }

    fn collider(self, unit: Real) -> ColliderBuilder {
        let mesh = |flags| ColliderBuilder::new(SharedShape::new(roof_with(unit, flags)));
        match self {
            Self::Mesh => mesh(TriMeshFlags::empty()),
            Self::FlaggedMesh => mesh(TriMeshFlags::FIX_INTERNAL_EDGES),
            Self::HalfSpace => ColliderBuilder::new(SharedShape::halfspace(Vector::Y)),
            Self::Box => {
                ColliderBuilder::cuboid(9.0 * unit, unit, 9.0 * unit).translation(-unit * Vector::Y)
            }
            Self::HeightField => {
                let mut heights = Array2::repeat(13, 13, 0.0);
                for (i, j) in (0..13).flat_map(|i| (0..13).map(move |j| (i, j))) {
                    heights[(i, j)] = 0.1 * (1.3 * i as Real).sin() * (1.1 * j as Real).cos();
                }
                let scale = unit * Vector::new(18.0, 1.0, 18.0);
                ColliderBuilder::new(SharedShape::new(HeightField::new(heights, scale)))
            }
        }
    }

    fn is_roof(self) -> bool {
        matches!(self, Self::Mesh | Self::FlaggedMesh)
    }

    /// Whether a place is above or below the wall, rather than beside it.
    fn is_over(self, at: Vector, unit: Real) -> bool {
        let [x, z] = [at.x.abs() / unit, at.z.abs() / unit];
        if self.is_roof() { x + z < 9.0 } else { x.max(z) < 7.0 }
    }

    /// A height above which a body has not passed.
    fn lowest(self, at: Vector, unit: Real) -> Real {
        let slope = if self.is_roof() { 2.0 / 9.0 } else { 0.0 };
        -slope * at.x.abs() - 0.5 * unit
    }
}

/// Two triangles with a common edge along z, like a roof.
pub fn roof(unit: Real) -> TriMesh {
    roof_with(unit, TriMeshFlags::empty())
}

fn roof_with(unit: Real, flags: TriMeshFlags) -> TriMesh {
    let corners = [(0.0, 0.0, -9.0), (0.0, 0.0, 9.0), (9.0, -2.0, 0.0), (-9.0, -2.0, 0.0)];
    let corners = corners.map(|(x, y, z)| unit * Vector::new(x, y, z));
    TriMesh::with_flags(corners.to_vec(), vec![[0, 1, 2], [1, 0, 3]], flags).unwrap()
}

/// How often and onto what.
#[derive(Clone, Copy, Debug)]
pub struct Throws {
    /// What the body is thrown onto.
    pub wall: Wall,
    /// The unit of length.
    pub unit: Real,
    /// Whether the body asks for continuous collision detection.
    pub ccd: bool,
    /// Steps of a throw.
    pub steps: usize,
    /// Steps a second.
    pub rate: Real,
}

/// What was observed of some throws.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Number of throws.
    pub throws: usize,
    /// Number of moving steps.
    pub moving: usize,
    /// Number of held steps.
    pub held: usize,
    /// The longest run of held steps.
    pub longest: usize,
    /// The largest rise of energy.
    pub rise: Real,
    /// The deepest overlap, in radii.
    pub depth: Real,
    /// Bodies that passed through the wall.
    pub passed: usize,
    /// Steps until the body slept, of the bodies that did.
    pub asleep: Vec<usize>,
}

impl Outcome {
    /// The held steps as a share of the moving steps.
    pub fn held_share(&self) -> Real {
        self.held as Real / self.moving.max(1) as Real
    }

    /// Returns whether the held steps exceed those of the worst compound by at most 0.1 %, and the
    /// rise by at most 0.01.
    pub fn is_no_worse_than(&self, compounds: &[Self]) -> bool {
        let most = |of: fn(&Self) -> Real| compounds.iter().map(of).fold(0.0, Real::max);
        self.held_share() <= most(Self::held_share) + 1e-3
            && self.rise <= most(|outcome| outcome.rise) + 0.01
    }

    /// Adds other throws.
    pub fn add(&mut self, other: &Self) {
        self.throws += other.throws;
        self.moving += other.moving;
        self.held += other.held;
        self.longest = self.longest.max(other.longest);
        self.rise = self.rise.max(other.rise);
        self.depth = self.depth.max(other.depth);
        self.passed += other.passed;
        self.asleep.extend(&other.asleep);
    }
}

impl Throws {
    /// Throws a body once for each seed. The same seed is the same throw for all bodies.
    pub fn of(&self, body: ThrownBody, seeds: std::ops::Range<u64>) -> Outcome {
        let mut outcome = Outcome::default();
        for seed in seeds {
            let mut random = Random::new(seed);
            let place = Vector::new(
                random.between(-0.5, 0.5),
                random.between(1.6, 2.2),
                random.between(-0.5, 0.5),
            );
            let pose = Pose::new(self.unit * place, random.direction() * random.between(0.0, 3.1));
            let linvel = self.unit * 2.0 * random.point();
            let angvel = 2.0 * random.point();
            outcome.add(&self.throw(body, pose, (linvel, angvel)));
        }
        outcome
    }

    /// Throws a body once.
    pub fn throw(&self, body: ThrownBody, pose: Pose, velocity: (Vector, Vector)) -> Outcome {
        let unit = self.unit;
        let mut world = PhysicsWorld { gravity: -9.81 * unit * Vector::Y, ..Default::default() };
        let size = 2.0 * RADIUS * unit;
        rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, size).unwrap();
        world.integration_parameters.dt = 1.0 / self.rate;
        self.observe(&mut world, body, pose, velocity)
    }

    /// Throws a body once in a world without bodies.
    pub fn observe(
        &self,
        world: &mut PhysicsWorld,
        body: ThrownBody,
        pose: Pose,
        (linvel, angvel): (Vector, Vector),
    ) -> Outcome {
        let unit = self.unit;
        let (_, ground) = world.insert(RigidBodyBuilder::fixed(), self.wall.collider(unit));
        // One mass in all units. parry's sum over a compound exchanges the axes of small bodies.
        let density = 1.0 / (unit * unit * unit);
        let robot = body.robot().shape(unit);
        let mass = robot.mass_properties(density);
        let thrown = RigidBodyBuilder::dynamic()
            .pose(pose)
            .linvel(linvel)
            .angvel(angvel)
            .ccd_enabled(self.ccd);
        let collider = ColliderBuilder::new(body.shape(unit)).mass_properties(mass);
        let (handle, _) = world.insert(thrown, collider);
        let (ends, dt) = (body.ends(unit), world.integration_parameters.dt);
        let weight = mass.mass() * 9.81 * unit * unit;
        let mut outcome = Outcome { throws: 1, ..Default::default() };
        let (mut run, mut least) = (0, Real::INFINITY);
        for step in 0..self.steps {
            let before = *world.bodies[handle].position();
            world.step();
            let body = &world.bodies[handle];
            let after = *body.position();
            assert!(after.is_finite() && body.linvel().is_finite(), "{after:?}");
            if body.is_sleeping() {
                outcome.asleep.push(step);
                break;
            }
            if !self.wall.is_over(after.translation, unit) {
                break;
            }
            if after.translation.y < self.wall.lowest(after.translation, unit) {
                outcome.passed += 1;
                break;
            }
            let speeds = ends.map(|end| body.velocity_at_point(after * end).length());
            let fastest = usize::from(speeds[1] > speeds[0]);
            let moved = (after * ends[fastest] - before * ends[fastest]).length();
            let is_moving = speeds[fastest] > SLOW * unit;
            outcome.moving += usize::from(is_moving);
            let is_held = is_moving && moved < 0.01 * speeds[fastest] * dt;
            run = if is_held { run + 1 } else { 0 };
            outcome.held += usize::from(is_held);
            outcome.longest = outcome.longest.max(run);
            let energy =
                body.kinetic_energy() + body.gravitational_potential_energy(0.0, world.gravity);
            least = least.min(energy);
            outcome.rise = outcome.rise.max((energy - least) / weight);
            // parry's `contact` of a half-space and a compound of capsules mirrors the place.
            let wall = &world.colliders[ground];
            let pos12 = wall.position().inv_mul(&after);
            let contact =
                ContinuumDispatcher::default().contact(&pos12, wall.shape(), &*robot, 0.0);
            let depth = contact.unwrap().map_or(0.0, |contact| -contact.dist / (RADIUS * unit));
            outcome.depth = outcome.depth.max(depth);
        }
        outcome
    }
}
