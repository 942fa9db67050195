//! One shape of the robot as each program takes it: models made of the same links.

use continuum_demo::ctr::Centreline;
use continuum_demo::timing;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{Capsule, Cylinder};
use parry_continuum::proximity::BvhSearch;
use parry_continuum::{Chain, RobotError, Tube, simplify};

/// A model of the robot, and the library that computes with it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Model {
    Capsule,
    Cylinder,
    Modified,
    ParryCapsule,
    ParryCylinder,
    Spheres,
    /// The curve itself, between bounds.
    Tube,
}

impl Model {
    pub const ALL: [Self; 7] = [
        Self::Capsule,
        Self::Cylinder,
        Self::Modified,
        Self::ParryCapsule,
        Self::ParryCylinder,
        Self::Spheres,
        Self::Tube,
    ];

    /// The models of links by this crate.
    pub const OURS: [Self; 3] = [Self::Capsule, Self::Cylinder, Self::Modified];

    /// Its place in [`Model::ALL`], and in [`Model::OURS`].
    pub fn index(self) -> usize {
        self as usize
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Capsule => "capsules",
            Self::Cylinder => "cylinders",
            Self::Modified => "fitted caps",
            Self::ParryCapsule => "parry's Capsule",
            Self::ParryCylinder => "parry's Cylinder",
            Self::Spheres => "7 spheres a link",
            Self::Tube => "tube",
        }
    }
}

/// The spheres that stand for a link in the way of the sphere chains: as many, evenly along the
/// axis, ends included.
const SPHERES: usize = 7;

/// The robot with few links within a tolerance.
pub struct Subject {
    /// In the order of [`Model::OURS`].
    chains: [Chain; 3],
    pub capsules: Vec<(Pose, Capsule)>,
    pub cylinders: Vec<(Pose, Cylinder)>,
    /// Centres and radii.
    pub spheres: Vec<(Vector, Real)>,
    /// The tube through all points, and how far apart the bounds of its clearance may be.
    pub tube: Tube,
    pub tolerance: Real,
}

impl Subject {
    /// Of a curve and its directions at both ends.
    pub fn new(
        curve: &Centreline,
        tangents: [Vector; 2],
        tolerance: Real,
    ) -> Result<Self, RobotError> {
        let (points, radii) = simplify(&curve.points, &curve.radii, tolerance)?;
        let chains = [
            Chain::capsules(&points, &radii)?,
            Chain::cylinders(&points, &radii)?,
            Chain::from_centreline(&points, &radii)?,
        ];
        let links = chains[0].links();
        let capsule = |link: &parry_continuum::ModifiedCylinder| {
            Capsule::new(link.start(), link.end(), link.radius())
        };
        let capsules = links.iter().map(|link| (Pose::IDENTITY, capsule(link))).collect();
        let spheres = links
            .iter()
            .flat_map(|link| {
                let share = |k: usize| k as Real / (SPHERES - 1) as Real;
                (0..SPHERES).map(move |k| (link.start().lerp(link.end(), share(k)), link.radius()))
            })
            .collect();
        let cylinders = timing::cylinders(&chains[1]);
        let tube = Tube::from_samples(&curve.points, &curve.radii, Some(tangents))?;
        Ok(Self { chains, capsules, cylinders, spheres, tube, tolerance })
    }

    /// The lower of the two bounds on the tube's clearance, which is the one to rely on.
    pub fn least_of_tube(&self, search: &mut BvhSearch, base: &Pose) -> Result<Real, String> {
        let found = search
            .clearance(&self.tube, base, self.tolerance)
            .map_err(|error| error.to_string())?;
        Ok(found.lower)
    }

    /// How many links a model has; none of a tube.
    pub fn links(&self, model: Model) -> Option<usize> {
        (model != Model::Tube).then(|| self.chain(model).links().len())
    }

    /// The chain of one of this crate's models; of another model, the one with the same links, or
    /// what is nearest to it.
    pub fn chain(&self, model: Model) -> &Chain {
        match model {
            Model::Capsule | Model::ParryCapsule | Model::Spheres => &self.chains[0],
            Model::Cylinder | Model::ParryCylinder => &self.chains[1],
            Model::Modified | Model::Tube => &self.chains[2],
        }
    }
}
