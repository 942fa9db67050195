//! Links and chains slide over the seams of flush meshes and height fields as over one face, and
//! still stop at the edge of a wall that stands in their way.

use crate::drop::world;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::{HeightField, HeightFieldFlags, TriMesh};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use rapier3d_f64::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// The radius of the bodies, which are 1 long.
const RADIUS: Real = 0.1;
/// Half of the width of a wall.
const HALF: Real = 3.0;

fn tile(flags: TriMeshFlags) -> SharedShape {
    let vertices = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)];
    let vertices = vertices.map(|(x, z)| Vector::new(x, 0.0, z)).to_vec();
    SharedShape::new(TriMesh::with_flags(vertices, vec![[0, 2, 1], [0, 3, 2]], flags).unwrap())
}

fn field() -> SharedShape {
    let flags = HeightFieldFlags::FIX_INTERNAL_EDGES;
    let size = Vector::new(2.0 * HALF, 1.0, 2.0 * HALF);
    SharedShape::new(HeightField::with_flags(Array2::repeat(4, 4, 0.0), size, flags))
}

/// The walls whose flags fix internal edges.
fn walls() -> [(&'static str, SharedShape); 3] {
    [
        ("one-sided mesh", tile(TriMeshFlags::FIX_INTERNAL_EDGES)),
        ("two-sided mesh", tile(TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED)),
        ("height field", field()),
    ]
}

/// Bodies along y.
fn bodies() -> [(&'static str, SharedShape); 3] {
    let half = 0.5 * Vector::Y;
    let link = |caps| SharedShape::new(ModifiedCylinder::new(-half, half, RADIUS, caps).unwrap());
    let points = [-0.5, -0.2, 0.1, 0.5].map(|y| Vector::new(0.0, y, 0.0));
    [
        ("flat link", link([Cap::Flat; 2])),
        ("round link", link([Cap::Round; 2])),
        ("chain", SharedShape::new(Chain::cylinders(&points, &[RADIUS; 3]).unwrap())),
    ]
}

/// Slides a body at `speed` along x, without friction, over two walls at x = -`shift` / 2 and
/// x = `shift` / 2, the second higher by `step`. Returns the least speed, and the largest change of
/// height.
fn slide(
    wall: &SharedShape,
    (shift, step): (Real, Real),
    body: SharedShape,
    from: Pose,
    speed: Real,
) -> [Real; 2] {
    let mut world = world(2.0 * RADIUS);
    world.gravity = Vector::Y * -9.81;
    for (x, y) in [(-0.5 * shift, 0.0), (0.5 * shift, step)] {
        let collider = ColliderBuilder::new(wall.clone()).friction(0.0);
        world.insert(RigidBodyBuilder::fixed(), collider.translation(Vector::new(x, y, 0.0)));
    }
    let thrown = RigidBodyBuilder::dynamic().pose(from).linvel(Vector::X * speed);
    let (body, _) = world.insert(thrown, ColliderBuilder::new(body).friction(0.0));
    let (mut slowest, mut change) = (speed, 0.0);
    for _ in 0..(3.0 / speed / world.integration_parameters.dt) as usize {
        world.step();
        let body = &world.bodies[body];
        slowest = body.linvel().x.min(slowest);
        change = (body.translation().y - from.translation.y).abs().max(change);
    }
    [slowest, change]
}

#[test]
fn bodies_slide_over_seams_as_over_one_face() {
    let lying = Rot3::from_rotation_z(FRAC_PI_2);
    let across = Rot3::from_rotation_x(FRAC_PI_2);
    for (wall_name, wall) in walls() {
        for (name, body) in bodies() {
            let upright = if name == "round link" { 0.5 + RADIUS } else { 0.5 };
            for (turn, height) in [
                (lying, RADIUS),
                (across, RADIUS),
                (Rot3::from_rotation_y(0.5) * lying, RADIUS),
                (Rot3::IDENTITY, upright),
            ] {
                let from = Pose::from_parts(Vector::new(-1.4, height, 0.13), turn);
                // Flush, and with tiles that overlap by 1.
                for shift in [2.0 * HALF, 2.0 * HALF - 1.0] {
                    for speed in [2.0, 20.0] {
                        let [slowest, change] =
                            slide(&wall, (shift, 0.0), body.clone(), from, speed);
                        let context = format!("{name} on a {wall_name}, {turn:?}, {shift} {speed}");
                        assert!(slowest > 0.999 * speed, "{context}: {slowest}");
                        assert!(change < 0.01 * RADIUS, "{context}: {change}");
                    }
                }
            }
        }
    }
}

/// A wall that is higher by a radius is no seam: its free edge stops what slides against it.
#[test]
fn a_step_still_stops_what_slides_against_it() {
    for (wall_name, wall) in walls() {
        for (name, body) in bodies().into_iter().filter(|(name, _)| *name != "round link") {
            let lying = Rot3::from_rotation_z(FRAC_PI_2);
            let from = Pose::from_parts(Vector::new(-1.4, RADIUS, 0.13), lying);
            let [slowest, _] = slide(&wall, (2.0 * HALF, RADIUS), body, from, 2.0);
            assert!(slowest < 0.1, "{name} on a {wall_name}: {slowest}");
        }
    }
}

/// What a rod does in a slot.
#[derive(Debug)]
struct InSlot {
    /// Whether it has left the slot.
    is_out: bool,
    /// The deepest that it was below its place on both edges, in radii.
    sunk: Real,
    is_asleep: bool,
}

/// A rod in a slot between two edges, `share` radii from its axis on either side, without friction.
/// Gravity is tilted: it pushes the rod sideways with `push` times the force that lifts it over an
/// edge.
fn in_slot(rod: SharedShape, share: Real, push: Real, flags: TriMeshFlags) -> InSlot {
    let plate = |from: Real, to: Real| [(from, -HALF), (to, -HALF), (to, HALF), (from, HALF)];
    let (half, rise) = (share * RADIUS, (1.0 - share * share).sqrt());
    let vertices = [plate(-HALF, -half), plate(half, HALF)].concat();
    let vertices = vertices.into_iter().map(|(x, z)| Vector::new(x, 0.0, z)).collect();
    let faces = vec![[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6]];
    let slot = TriMesh::with_flags(vertices, faces, flags).unwrap();
    let mut world = world(2.0 * RADIUS);
    world.gravity = 9.81 * Vector::new(push * share / rise, -1.0, 0.0);
    let slot = ColliderBuilder::new(SharedShape::new(slot)).friction(0.0);
    world.insert(RigidBodyBuilder::fixed(), slot);
    let along = Rot3::from_rotation_x(FRAC_PI_2);
    let from = Pose::from_parts(Vector::new(0.0, rise * RADIUS, 0.1), along);
    let collider = ColliderBuilder::new(rod).friction(0.0);
    let (body, _) = world.insert(RigidBodyBuilder::dynamic().pose(from), collider);
    let mut outcome = InSlot { is_out: false, sunk: 0.0, is_asleep: false };
    for _ in 0..400 {
        world.step();
        let body = &world.bodies[body];
        let [x, y] = [body.translation().x, body.translation().y].map(|at| at / RADIUS);
        outcome.sunk = outcome.sunk.max(rise - y);
        outcome.is_asleep = body.is_sleeping();
        if x > 1.0 {
            outcome.is_out = true;
            break;
        }
    }
    outcome
}

/// A rod that reaches less than 5 % of its radius below the edges of a slot lies on both faces:
/// with a flag they hold it from below, but not sideways. All other slots hold it like a groove.
#[test]
fn a_shallow_slot_holds_a_rod_from_below() {
    for flags in [
        TriMeshFlags::empty(),
        TriMeshFlags::FIX_INTERNAL_EDGES,
        TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
    ] {
        for (name, rod) in bodies() {
            // 1 - (1 - share^2)^(1/2) is 0.05 at a share of 0.312.
            for share in [0.2, 0.25, 0.33, 0.4] {
                let is_groove = share > 0.312 || flags.is_empty();
                for push in [0.0, 0.2, 0.8] {
                    let held = in_slot(rod.clone(), share, push, flags);
                    let context = format!("{name} {flags:?} {share} {push}: {held:?}");
                    assert_eq!(held.is_out, push > 0.0 && !is_groove, "{context}");
                    // While it slides out, the edges lift it to the height of the faces.
                    assert!(held.sunk < if held.is_out { 0.02 } else { 0.002 }, "{context}");
                    assert!(held.is_asleep || held.is_out, "{context}");
                }
            }
        }
    }
}
