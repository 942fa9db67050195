//! One shape of the robot as each program takes it: models made of the same links.

use crate::scene::ctr::Centreline;
use crate::scene::timing;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Capsule, Cylinder};
use parry_continuum::{Chain, RobotError, simplify};

/// A model of the robot, and whose arithmetic asks for it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Model {
    Capsule,
    Cylinder,
    Modified,
    ParryCapsule,
    ParryCylinder,
    Spheres,
}

impl Model {
    pub const ALL: [Self; 6] = [
        Self::Capsule,
        Self::Cylinder,
        Self::Modified,
        Self::ParryCapsule,
        Self::ParryCylinder,
        Self::Spheres,
    ];

    /// Those of this crate.
    pub const OURS: [Self; 3] = [Self::Capsule, Self::Cylinder, Self::Modified];

    pub fn name(self) -> &'static str {
        match self {
            Self::Capsule => "K, capsules",
            Self::Cylinder => "Z, cylinders",
            Self::Modified => "Z*, modified",
            Self::ParryCapsule => "parry's Capsule",
            Self::ParryCylinder => "parry's Cylinder",
            Self::Spheres => "7 spheres a link",
        }
    }

    /// The chain of one of this crate's models.
    pub fn chain(self, points: &[Vector], radii: &[Real]) -> Result<Chain, RobotError> {
        match self {
            Self::Capsule | Self::ParryCapsule | Self::Spheres => Chain::capsules(points, radii),
            Self::Cylinder | Self::ParryCylinder => Chain::cylinders(points, radii),
            Self::Modified => Chain::from_centreline(points, radii),
        }
    }
}

/// The spheres that stand for a link in the way of the sphere chains: as many, evenly along the axis, ends included.
const SPHERES: usize = 7;

/// The robot with the fewest links within a tolerance.
pub struct Subject {
    pub points: Vec<Vector>,
    pub radii: Vec<Real>,
    /// In the order of [`Model::OURS`].
    pub chains: [Chain; 3],
    pub capsules: Vec<(Pose, Capsule)>,
    pub cylinders: Vec<(Pose, Cylinder)>,
    /// Centres and radii.
    pub spheres: Vec<(Vector, Real)>,
}

impl Subject {
    pub fn new(curve: &Centreline, tolerance: Real) -> Result<Self, RobotError> {
        let (points, radii) = simplify(&curve.points, &curve.radii, tolerance)?;
        let chains = [
            Model::Capsule.chain(&points, &radii)?,
            Model::Cylinder.chain(&points, &radii)?,
            Model::Modified.chain(&points, &radii)?,
        ];
        let links = chains[0].links();
        let capsule =
            |link: &parry_continuum::ModifiedCylinder| Capsule::new(link.start(), link.end(), link.radius());
        let capsules = links.iter().map(|link| (Pose::IDENTITY, capsule(link))).collect();
        let spheres = links
            .iter()
            .flat_map(|link| {
                let share = |k: usize| k as Real / (SPHERES - 1) as Real;
                (0..SPHERES).map(move |k| (link.start().lerp(link.end(), share(k)), link.radius()))
            })
            .collect();
        let cylinders = timing::cylinders(&chains[1]);
        Ok(Self { points, radii, chains, capsules, cylinders, spheres })
    }

    pub fn links(&self) -> usize {
        self.radii.len()
    }

    /// The chain that one of this crate's models makes.
    pub fn chain(&self, model: Model) -> &Chain {
        match model {
            Model::Cylinder | Model::ParryCylinder => &self.chains[1],
            Model::Modified => &self.chains[2],
            _ => &self.chains[0],
        }
    }
}
