//! Every way to ask for the clearance: this crate's engines, parry, and spheres.

use crate::subject::{Model, Subject};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{self, ClosestPoints, PointQuery};
use parry_continuum::parry::shape::{Shape, TriMesh};
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};

/// What answers the question how far the robot is from the wall.
pub trait Clearance {
    fn clearance(&mut self, robot: &Subject, base: &Pose) -> Result<Real, String>;

    /// Is called before each question.
    fn prepare(&mut self) {}
}

/// A kind of query, by name, and its model.
pub struct Way<'a> {
    pub model: Model,
    pub name: &'static str,
    pub program: Box<dyn Clearance + 'a>,
}

/// What an engine can run on beside the CPU.
pub struct Device {
    /// What its engine is called here.
    pub way: &'static str,
    pub name: String,
    pub engine: Box<EngineOn>,
}

/// Makes an engine for a mesh and a model.
pub type EngineOn = dyn Fn(&TriMesh, Model) -> Result<Box<dyn Clearance>, String> + Sync;

/// Every way. An engine of this crate is a line in the list of engines.
pub fn all<'a>(mesh: &'a TriMesh, devices: &[Device]) -> Result<Vec<Way<'a>>, String> {
    let mut ways = Vec::new();
    for model in Model::OURS {
        let search = || BvhSearch::new(mesh).map_err(text);
        let engines: [(_, Box<dyn Clearance>); 4] = [
            ("search, first time", Box::new(Cold { engine: search()?, model })),
            ("search, again", Box::new(Engine { engine: search()?, model })),
            (
                "exhaustive, f32",
                Box::new(Engine { engine: Exhaustive::<f32>::new(mesh).map_err(text)?, model }),
            ),
            (
                "exhaustive, f64",
                Box::new(Engine { engine: Exhaustive::<f64>::new(mesh).map_err(text)?, model }),
            ),
        ];
        ways.extend(engines.into_iter().map(|(name, program)| Way { model, name, program }));
        for device in devices {
            ways.push(Way { model, name: device.way, program: (device.engine)(mesh, model)? });
        }
    }
    for (name, forgets) in [("search, first time", true), ("search, again", false)] {
        let program = Box::new(OfTube { engine: BvhSearch::new(mesh).map_err(text)?, forgets });
        ways.push(Way { model: Model::Tube, name, program });
    }
    for model in [Model::ParryCapsule, Model::ParryCylinder, Model::Spheres] {
        ways.push(Way { model, name: "parry's search", program: Box::new(Peer { mesh, model }) });
    }
    Ok(ways)
}

/// An engine of this crate.
pub struct Engine<E> {
    pub engine: E,
    pub model: Model,
}

impl<E: Proximity> Clearance for Engine<E> {
    fn clearance(&mut self, robot: &Subject, base: &Pose) -> Result<Real, String> {
        Ok(self.engine.minimum(robot.chain(self.model), base).map_err(text)?.distance)
    }
}

/// A search that forgets.
struct Cold {
    engine: BvhSearch,
    model: Model,
}

impl Clearance for Cold {
    fn clearance(&mut self, robot: &Subject, base: &Pose) -> Result<Real, String> {
        Ok(self.engine.minimum(robot.chain(self.model), base).map_err(text)?.distance)
    }

    fn prepare(&mut self) {
        self.engine.forget();
    }
}

/// The bounds of a tube.
struct OfTube {
    engine: BvhSearch,
    forgets: bool,
}

impl Clearance for OfTube {
    fn clearance(&mut self, robot: &Subject, base: &Pose) -> Result<Real, String> {
        robot.least_of_tube(&mut self.engine, base)
    }

    fn prepare(&mut self) {
        if self.forgets {
            self.engine.forget();
        }
    }
}

/// parry's queries, one link or sphere after the other; each may stop beyond the least clearance so
/// far.
pub struct Peer<'a> {
    pub mesh: &'a TriMesh,
    pub model: Model,
}

impl Clearance for Peer<'_> {
    fn clearance(&mut self, robot: &Subject, base: &Pose) -> Result<Real, String> {
        match self.model {
            Model::ParryCylinder => least(self.mesh, &robot.cylinders, base),
            Model::Spheres => Ok(least_of_spheres(self.mesh, &robot.spheres, base)),
            _ => least(self.mesh, &robot.capsules, base),
        }
    }
}

/// parry's clearance of links, each with its place in the robot.
pub fn least<S: Shape>(mesh: &TriMesh, links: &[(Pose, S)], base: &Pose) -> Result<Real, String> {
    let mut least = Real::INFINITY;
    for (place, link) in links {
        let place = *base * *place;
        if least == Real::INFINITY {
            least = query::distance(&place, link, &Pose::IDENTITY, mesh).map_err(text)?.distance;
            continue;
        }
        match query::closest_points(&place, link, &Pose::IDENTITY, mesh, least).map_err(text)? {
            ClosestPoints::Intersecting => return Ok(0.0),
            ClosestPoints::WithinMargin(one, other) => least = least.min((one - other).length()),
            ClosestPoints::Disjoint => {}
        }
    }
    Ok(least)
}

fn least_of_spheres(mesh: &TriMesh, spheres: &[(Vector, Real)], base: &Pose) -> Real {
    let mut least = Real::MAX;
    for &(centre, radius) in spheres {
        let centre = *base * centre;
        if let Some(found) = mesh.project_local_point_with_max_dist(centre, false, least + radius) {
            least = least.min((found.point - centre).length() - radius);
        }
        if least <= 0.0 {
            return 0.0;
        }
    }
    least
}

/// An error as one line.
pub fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}
