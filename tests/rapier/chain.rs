//! A chain as one collider: moved through the ventricle it raises its events at the steps that the
//! exact clearance says, and it makes no contacts with itself.

use continuum_demo::{ctr, ventricle};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum::{Chain, rapier};
use rapier3d_f64::prelude::*;
use std::collections::BTreeSet;
use std::sync::Mutex;

/// The events of a step.
#[derive(Default)]
struct Events(Mutex<Vec<bool>>);

impl EventHandler for Events {
    fn handle_collision_event(
        &self,
        _: &RigidBodySet,
        _: &ColliderSet,
        event: CollisionEvent,
        _: Option<&ContactPair>,
    ) {
        self.0.lock().unwrap().push(event.started());
    }

    fn handle_contact_force_event(
        &self,
        _: Real,
        _: &RigidBodySet,
        _: &ColliderSet,
        _: &ContactPair,
        _: Real,
    ) {
    }

    fn handle_soft_body_tear_event(&self, _: &SoftBodySet, _: &SoftBodyTearEvent) {}
}

/// The robot of the examples where it is meant to be, and how it sways from there: sideways into
/// the wall and back, twice.
fn sway(step: usize) -> Pose {
    let share = step as Real / 60.0 * std::f64::consts::TAU;
    Pose::from_translation(Vector::new(0.9, 0.5, -0.3) * 1.6 * (0.5 - 0.5 * share.cos()))
        * ventricle::entry()
}

#[test]
fn contact_starts_and_stops_at_the_right_steps() {
    let (vertices, triangles) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    let mut search =
        BvhSearch::new(&TriMesh::new(vertices.clone(), triangles.clone()).unwrap()).unwrap();
    let line = ctr::three_tubes().centreline(&ventricle::goal(), 30);
    let robot = Chain::from_centreline(&line.points, &line.radii).unwrap();

    let mut world = PhysicsWorld { gravity: Vector::ZERO, ..Default::default() };
    rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 1.0).unwrap();
    world.integration_parameters.dt = 1e-3;
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::trimesh_with_flags(vertices, triangles, flags).unwrap(),
    );
    let collider = ColliderBuilder::new(SharedShape::new(robot.clone()))
        .active_collision_types(ActiveCollisionTypes::KINEMATIC_FIXED)
        .active_events(ActiveEvents::COLLISION_EVENTS);
    let (body, collider) =
        world.insert(RigidBodyBuilder::kinematic_position_based().pose(sway(0)), collider);

    let (mut touching, mut starts, mut stops) = (false, 0, 0);
    let reach = world.integration_parameters.prediction_distance();
    for step in 0..120 {
        // The contacts of a step belong to the pose at its beginning.
        let clearance = search.minimum(&robot, &sway(step)).unwrap().distance;
        world.bodies[body].set_next_kinematic_position(sway(step + 1));
        let events = Events::default();
        world.step_with_events(&(), &events);
        let events = events.0.into_inner().unwrap();
        let expected = clearance < reach;
        // rapier also counts a contact that the velocity would bring within reach by the step's
        // end.
        let soon = search.minimum(&robot, &sway(step + 1)).unwrap().distance < reach;
        if expected == soon {
            let context = format!("step {step}: clearance {clearance}, events {events:?}");
            assert_eq!(events.contains(&true), expected && !touching, "{context}");
            assert_eq!(events.contains(&false), !expected && touching, "{context}");
        }
        if let Some(&started) = events.last() {
            assert_ne!(started, touching, "step {step}");
            touching = started;
            *(if started { &mut starts } else { &mut stops }) += 1;
        }
        let is_held = world.contact_pairs_with(collider).any(|pair| pair.has_any_active_contact());
        assert_eq!(is_held, touching);
    }
    assert_eq!((starts, stops), (2, 2));
}

/// Dropped on a floor, a tangle of links comes to rest: its links overlap at every joint, which is
/// not a contact.
#[test]
fn a_chain_has_no_contacts_with_itself() {
    let points = [
        Vector::ZERO,
        Vector::X,
        Vector::new(1.5, 0.0, 0.8),
        Vector::new(0.9, 0.0, 1.5),
        Vector::Z,
    ];
    let robot = Chain::from_centreline(&points, &[0.3; 4]).unwrap();
    let pose = Pose::from_translation(Vector::new(0.0, 0.4, 0.0));
    let ground = crate::drop::mesh(1.0, |_, _| 0.0);
    let mut drop =
        crate::drop::Drop::new(crate::drop::world(1.0), ground, SharedShape::new(robot), pose);
    for _ in 0..200 {
        drop.world.step();
        assert!(drop.world.contact_pairs_with(drop.collider).count() <= 1);
    }
    assert!(drop.is_asleep() && (drop.pose().translation.y - 0.3).abs() < 3e-4);
    assert!((drop.pose().translation - Vector::new(0.0, 0.3, 0.0)).length() < 0.01);
}

/// One body per link, held by joints without contacts: a straight robot in free space stays as it
/// is.
#[test]
fn neighbouring_links_do_not_push_each_other() {
    let mut world = crate::drop::world(1.0);
    world.gravity = Vector::ZERO;
    let points: Vec<_> = (0..8).map(|k| Vector::X * (0.8 * k as Real)).collect();
    let robot = Chain::from_centreline(&points, &[0.3; 7]).unwrap();
    let bodies: Vec<_> = robot
        .links()
        .iter()
        .map(|link| {
            world
                .insert(RigidBodyBuilder::dynamic(), ColliderBuilder::new(SharedShape::new(*link)))
                .0
        })
        .collect();
    for (pair, link) in bodies.windows(2).zip(robot.links()) {
        let joint =
            SphericalJointBuilder::new().local_anchor1(link.end()).local_anchor2(link.end());
        world.insert_impulse_joint(pair[0], pair[1], joint.contacts_enabled(false));
    }
    for _ in 0..60 {
        world.step();
        let active =
            world.narrow_phase.contact_pairs().filter(|pair| pair.has_any_active_contact());
        assert_eq!(active.count(), 0);
    }
    assert!(bodies.iter().all(|&body| world.bodies[body].translation().length() < 1e-9));
}

/// The points of all contacts by the parts and the features that they are of.
fn identities(drop: &crate::drop::Drop) -> BTreeSet<[u32; 4]> {
    let mut found = BTreeSet::new();
    for pair in drop.world.contact_pairs_with(drop.collider) {
        for manifold in pair.rigid().iter().flat_map(|contacts| &contacts.manifolds) {
            let parts = [manifold.subshape1, manifold.subshape2];
            found.extend(
                manifold
                    .points
                    .iter()
                    .map(|point| [parts[0], parts[1], point.fid1.0, point.fid2.0]),
            );
        }
    }
    found
}

/// Pushed into a corner where neighbouring links are equally deep, a chain comes to rest on points
/// that stay the same.
#[test]
fn a_chain_in_a_corner_comes_to_rest() {
    let vertices = [(-9.0, 0.0), (9.0, 0.0), (9.0, 9.0), (-9.0, 9.0)];
    let floor = vertices.map(|(x, z)| Vector::new(x, 0.0, z));
    let wall = vertices.map(|(x, y)| Vector::new(x, y, 0.0));
    let faces = vec![[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    let zigzag = |bend: Real| {
        (0..6).map(|k| Vector::new(k as Real, 0.0, bend * (k % 2) as Real)).collect::<Vec<_>>()
    };
    for (name, points) in
        [("straight", zigzag(0.0)), ("zigzag", zigzag(0.3)), ("steep", zigzag(-0.8))]
    {
        for robot in
            [Chain::from_centreline(&points, &[0.3; 5]), Chain::capsules(&points, &[0.3; 5])]
        {
            let mesh = TriMesh::with_flags([floor, wall].concat(), faces.clone(), flags).unwrap();
            let mut world = crate::drop::world(1.0);
            world.gravity = Vector::new(0.0, -7.0, -7.0);
            let pose = Pose::from_translation(Vector::new(-2.5, 0.301, 1.2));
            let ground = ColliderBuilder::new(SharedShape::new(mesh));
            let mut drop =
                crate::drop::Drop::new(world, ground, SharedShape::new(robot.unwrap()), pose);
            for _ in 0..200 {
                drop.world.step();
                drop.world.bodies[drop.body].wake_up(true);
            }
            let (mut before, mut changes, mut fastest) = (identities(&drop), 0, 0.0_f64);
            for _ in 0..200 {
                drop.world.step();
                drop.world.bodies[drop.body].wake_up(true);
                let now = identities(&drop);
                changes += usize::from(now != before);
                before = now;
                fastest = fastest.max(drop.world.bodies[drop.body].linvel().length());
            }
            assert!(
                changes <= 2 && fastest < 1e-3 && before.len() > 2,
                "{name}: {changes} changes, speed {fastest}"
            );
        }
    }
}

/// Over a slot whose edges have no neighbours a rod lies still, under every flag of the mesh.
#[test]
fn rods_do_not_fall_through_a_slot() {
    let plate = |from: Real, to: Real| [(from, -4.0), (to, -4.0), (to, 4.0), (from, 4.0)];
    let vertices = [plate(-4.0, -0.2), plate(0.2, 4.0)].concat();
    let vertices: Vec<_> = vertices.into_iter().map(|(x, z)| Vector::new(x, 0.0, z)).collect();
    for flags in [
        TriMeshFlags::empty(),
        TriMeshFlags::FIX_INTERNAL_EDGES,
        TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
    ] {
        for round in [true, false] {
            for size in [1.0, 1e-3] {
                let points = [-1.5, -0.5, 0.6, 1.5].map(|z| Vector::Z * z * size);
                let radii = [0.5 * size; 3];
                let robot = if round {
                    Chain::capsules(&points, &radii)
                } else {
                    Chain::cylinders(&points, &radii)
                };
                let vertices = vertices.iter().map(|&vertex| vertex * size).collect();
                let faces = vec![[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6]];
                let mesh = TriMesh::with_flags(vertices, faces, flags).unwrap();
                let pose = Pose::from_translation(Vector::new(0.02, 0.48, 0.1) * size);
                let ground = ColliderBuilder::new(SharedShape::new(mesh));
                let world = crate::drop::world(size);
                let mut drop =
                    crate::drop::Drop::new(world, ground, SharedShape::new(robot.unwrap()), pose);
                for _ in 0..500 {
                    drop.world.step();
                }
                let height = drop.pose().translation.y / size;
                let expected = (0.25_f64 - 0.04).sqrt();
                let context = format!(
                    "{flags:?} {round} {size}: {height} for {expected}, {}",
                    drop.is_asleep()
                );
                assert!((height - expected).abs() < 0.01 && drop.is_asleep(), "{context}");
            }
        }
    }
}
