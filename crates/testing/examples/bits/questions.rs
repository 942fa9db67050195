//! The questions. Only this file and `record.rs` name the library's methods.

use crate::draw::{centreline, hairpin, nudged, pose, radii, wall};
use crate::record::Record;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::query::{
    ContactManifold, PersistentQueryDispatcher, QueryDispatcher, ShapeCastOptions,
};
use parry_continuum::parry::shape::{Capsule, Shape, TriMesh};
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, RobotPair, Scene, SelfQuery};
use parry_continuum::{
    BendingSection, Chain, ConstantCurvature, ContinuumDispatcher, LinearMotion, RigidMotion, Tube,
};
use std::error::Error;

/// Robots of each kind.
const COUNT: usize = 60;
/// Steps of a control loop.
const STEPS: usize = 20;

/// The records of one group of questions.
fn records<const N: usize>(names: [&'static str; N]) -> [Record; N] {
    names.map(Record::new)
}

/// A mesh and its queries.
struct Anatomy {
    mesh: TriMesh,
    search: BvhSearch,
    exhaustive: Exhaustive<f32>,
    /// Finer than rounding is refused.
    resolution: f64,
}

impl Anatomy {
    fn new(random: &mut Random, offset: f64) -> Result<Self, Box<dyn Error>> {
        let (vertices, triangles) = wall(random, 24, offset);
        Ok(Self {
            search: BvhSearch::from_triangles(&vertices, &triangles)?,
            exhaustive: Exhaustive::from_triangles(&vertices, &triangles)?,
            mesh: TriMesh::new(vertices, triangles)?,
            resolution: 0.1 + 1e-8 * offset,
        })
    }
}

/// One chain and the mesh.
pub fn chains(offset: f64) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut all = records([
        "minimum",
        "per_link",
        "certify",
        "clears",
        "contacts",
        "derivatives",
        "exhaustive",
        "side",
    ]);
    let [minimum, per_link, certify, clears, contacts, derivatives, exhaustive, side] = &mut all;
    let random = &mut Random::new(7);
    let mut near = Anatomy::new(random, offset)?;
    let (mut links, mut found) = (Vec::new(), Vec::new());
    for _ in 0..COUNT {
        let chain = Chain::from_centreline(&centreline(random), &radii(random))?;
        let mut place = pose(random, offset);
        for _ in 0..STEPS {
            let closest = near.search.minimum(&chain, &place)?;
            minimum.add(&closest);
            let certificate = closest.certify(&chain, &place, &near.mesh)?;
            certify.add(&[certificate.lower, certificate.upper][..]);
            for margin in [0.0, 0.3, closest.distance] {
                clears.add(&near.search.clears(&chain, &place, margin)?);
            }
            near.search.per_link(&chain, &place, &mut links)?;
            per_link.add(&links[..]);
            near.search.contacts_within(&chain, &place, 1.0, 0.0, &mut found)?;
            contacts.add(&found[..]);
            near.search.contacts_within(&chain, &place, 1.0, 0.1, &mut found)?;
            contacts.add(&found[..]);
            let derivative = near.search.derivative(&chain, &place, &closest)?;
            derivatives.add(&derivative.map(|found| found.rate(Vector::X, Vector::Y)));
            place = nudged(random, &place);
        }
        near.exhaustive.per_link(&chain, &place, &mut links)?;
        exhaustive.add(&links[..]);
        exhaustive.add(&near.exhaustive.minimum(&chain, &place)?);
        side.add(&f64::from(near.search.side(place.translation) as u8));
    }
    Ok(all.into())
}

/// Curves, motions and proofs beside the mesh.
pub fn curves(offset: f64) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut all = records(["clearance", "clears_tube", "sections", "motion", "least", "proofs"]);
    let [clearance, decisions, sections, motions, least, proofs] = &mut all;
    let random = &mut Random::new(8);
    let mut near = Anatomy::new(random, offset)?;
    for _ in 0..COUNT {
        let (points, radii) = (centreline(random), radii(random));
        let tube = Tube::from_samples(&points, &radii, None)?;
        let mut place = pose(random, offset);
        for _ in 0..STEPS / 4 {
            clearance.add(&near.search.clearance(&tube, &place, 0.01)?);
            decisions.add(&near.search.clears_tube(&tube, &place, 0.2, near.resolution));
            place = nudged(random, &place);
        }
        let bend = [0.3 * random.unit(), random.unit()];
        let section =
            ConstantCurvature::new(&[BendingSection { length: 3.0, radius: 0.2, bend }])?.tube()?;
        sections.add(&near.search.clearance(&section, &place, 0.001)?);
        let to: Vec<_> = points.iter().map(|point| *point + 0.1 * random.point()).collect();
        let bending = LinearMotion::chain(&points, &to, &radii)?;
        motions.add(&near.search.clears_motion(&bending, 0.01, near.resolution)?);
        least.add(&near.search.clearance_of_motion(&bending, near.resolution));
        let after = Pose::from_parts(
            place.translation,
            (place.rotation * Rotation::from_xyzw(0.01, 0.02, 0.0, 1.0)).normalize(),
        );
        let turning = RigidMotion::new(tube.clone(), [place, after])?;
        motions.add(&near.search.time_of_contact(&turning, 0.1, near.resolution)?);
        let chain = Chain::from_centreline(&points, &radii)?;
        proofs.add(&near.search.prove(&chain, &place, 0.1)?);
        proofs.add(&near.search.prove_tube(&tube, &place, 0.1, near.resolution)?);
        proofs.add(&near.search.prove_motion(&turning, 0.1, near.resolution)?);
    }
    Ok(all.into())
}

/// Two robots, and one and itself.
pub fn pairs(offset: f64) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut all =
        records(["pair", "pair_clears", "pair_within", "pair_tubes", "pair_motions", "self"]);
    let [pair, clears, within, tubes, motions, own] = &mut all;
    let random = &mut Random::new(9);
    let (mut robots, mut itself) = (RobotPair::new(), SelfQuery::new());
    let mut found = Vec::new();
    let resolution = 0.05 + 1e-8 * offset;
    for _ in 0..COUNT {
        let lines = [centreline(random), centreline(random)];
        let radii = [radii(random), radii(random)];
        let chain = |k: usize| Chain::from_centreline(&lines[k], &radii[k]);
        let [a, b] = [chain(0)?, chain(1)?];
        let mut places = [pose(random, offset), pose(random, offset)];
        for _ in 0..STEPS {
            let [on_a, on_b] = &places;
            let nearest = robots.minimum(&a, on_a, &b, on_b)?;
            pair.add(&nearest);
            for margin in [0.0, 0.3, nearest.distance] {
                clears.add(&robots.clears(&a, on_a, &b, on_b, margin)?);
            }
            robots.contacts_within(&a, on_a, &b, on_b, 0.5, &mut found)?;
            within.add(&found[..]);
            robots.per_link(&a, on_a, &b, on_b, &mut found)?;
            pair.add(&found[..]);
            places[0] = nudged(random, &places[0]);
        }
        let tube = |k: usize| Tube::from_samples(&lines[k], &radii[k], None);
        let [first, second] = [tube(0)?, tube(1)?];
        let [on_a, on_b] = &places;
        tubes.add(&robots.clearance(&first, on_a, &second, on_b, resolution));
        tubes.add(&robots.clears_tubes(&first, on_a, &second, on_b, 0.1, resolution));
        let after = places.map(|place| nudged(random, &place));
        let moving = |tube, k: usize| RigidMotion::new(tube, [places[k], after[k]]);
        let [first, second] = [moving(first, 0)?, moving(second, 1)?];
        motions.add(&robots.clears_motions(&first, &second, 0.1, resolution));
        let bent = hairpin(random);
        let chain = Chain::from_centreline(&bent, &radii[0])?;
        own.add(&itself.minimum(&chain));
        own.add(&itself.clears(&chain, 0.2));
        let tube = Tube::from_samples(&bent, &radii[0], None)?;
        own.add(&itself.clears_tube(&tube, 0.1, 0.05));
        let to: Vec<_> = bent.iter().map(|point| *point + 0.02 * random.point()).collect();
        own.add(&itself.clears_motion(&LinearMotion::chain(&bent, &to, &radii[0])?, 0.05, 0.05));
    }
    Ok(all.into())
}

/// Two structures and two robots.
pub fn scenes(offset: f64) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut all = records(["scene_clears", "scene_tightest", "scene_structures", "scene_contacts"]);
    let [clears, tightest, structures, contacts] = &mut all;
    let random = &mut Random::new(10);
    let mut scene = Scene::new();
    for (name, margin) in [("wall", Some(0.2)), ("vessel", Some(0.5)), ("skull", None)] {
        let (vertices, triangles) = wall(random, 16, offset);
        scene.add(name, BvhSearch::from_triangles(&vertices, &triangles)?, margin)?;
    }
    scene.set_robot_margin(Some(0.1))?;
    let (mut all_structures, mut found) = (Vec::new(), Vec::new());
    for _ in 0..COUNT {
        let mut chain = || Chain::from_centreline(&centreline(random), &radii(random));
        let [a, b] = [chain()?, chain()?];
        let mut places = [pose(random, offset), pose(random, offset)];
        for _ in 0..STEPS {
            let robots = [(&a, places[0]), (&b, places[1])];
            clears.add(&scene.clears(&robots)?);
            tightest.add(&scene.tightest(&robots)?);
            scene.per_structure(&robots, &mut all_structures)?;
            for found in &all_structures {
                structures.add(&found.nearest);
                structures.add(&found.slack);
            }
            scene.contacts_within(&robots, 0.3, 0.0, &mut found)?;
            found.iter().for_each(|found| contacts.add(&found.contact));
            places = places.map(|place| nudged(random, &place));
        }
        scene.set_pose(1, &Pose::from_translation(0.1 * random.point()))?;
    }
    Ok(all.into())
}

/// parry's questions through the dispatcher.
pub fn hosts(offset: f64) -> Result<Vec<Record>, Box<dyn Error>> {
    let mut all =
        records(["host_distance", "host_contact", "host_manifolds", "host_casts", "host_masses"]);
    let [distance, contact, manifolds, casts, masses] = &mut all;
    let random = &mut Random::new(11);
    let near = Anatomy::new(random, 0.0)?;
    let dispatcher = ContinuumDispatcher::default();
    let capsule = Capsule::new(Vector::ZERO, Vector::new(0.5, 0.5, 1.0), 0.2);
    for _ in 0..COUNT {
        let chain = Chain::from_centreline(&centreline(random), &radii(random))?;
        let other = Chain::from_centreline(&centreline(random), &radii(random))?;
        let link = chain.links()[3];
        let properties = chain.mass_properties(1.0);
        masses.add(&properties.local_com);
        masses.add(&properties.inv_mass);
        let shapes: [&dyn Shape; 4] = [&near.mesh, &other, &link, &capsule];
        // A manifold's points depend on nothing but the pair, so its list is made anew.
        for shape in shapes {
            let place = pose(random, 0.01 * offset.min(1.0));
            distance.add(&dispatcher.distance(&place, &chain, shape)?.distance);
            distance.add(&dispatcher.intersection_test(&place, &chain, shape)?.intersecting);
            contact.add(&dispatcher.contact(&place, &chain, shape, 0.5)?);
            let (velocity, options) =
                (random.point(), ShapeCastOptions::with_max_time_of_impact(5.0));
            casts.add(&dispatcher.cast_shapes(&place, velocity, &chain, shape, options)?);
            let mut list: Vec<ContactManifold<(), ()>> = Vec::new();
            dispatcher.contact_manifolds(&place, &chain, shape, 0.1, &mut list, &mut None)?;
            for manifold in &list {
                for point in &manifold.points {
                    manifolds.add(&point.dist);
                    manifolds.add(&[point.local_p1, point.local_p2][..]);
                }
            }
        }
    }
    Ok(all.into())
}
