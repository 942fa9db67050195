//! Aligned scenes: rods across and along the free edge of a plate and on boxes made of triangles,
//! and tubes on one axis that are pushed together. Nothing passes and nothing trembles, as with
//! parry's capsule and cylinder.

use crate::drop::world;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::{Cuboid, TriMesh};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use rapier3d_f64::prelude::*;

const RADIUS: Real = 0.25;
const CAPS: [[Cap; 2]; 4] =
    [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat]];

/// Rods 2 long around the origin, along a unit vector: links with all caps, a chain of two, parry's
/// capsule and cylinder.
fn rods(along: Vector) -> Vec<(String, SharedShape)> {
    let link = |caps: [Cap; 2]| ModifiedCylinder::new(-along, along, RADIUS, caps).unwrap();
    let mut rods: Vec<_> =
        CAPS.map(|caps| (format!("{caps:?}"), SharedShape::new(link(caps)))).into_iter().collect();
    let chain =
        Chain::from_centreline(&[-along, Vector::ZERO, along + 0.02 * Vector::Y], &[RADIUS; 2])
            .unwrap();
    rods.push(("chain".into(), SharedShape::new(chain)));
    rods.push(("parry's capsule".into(), SharedShape::capsule(-along, along, RADIUS)));
    // Which stands along y.
    let turned = Pose::from_rotation(Rot3::from_rotation_arc(Vector::Y, along));
    let cylinder = SharedShape::compound(vec![(turned, SharedShape::cylinder(1.0, RADIUS))]);
    rods.push(("parry's cylinder".into(), cylinder));
    rods
}

/// Drops a rod, which does not turn, at 4 lengths a second. Returns its lowest height, the last,
/// and by how much the last sixty differ.
fn dropped(rod: &SharedShape, ground: SharedShape, from: Vector, ccd: bool) -> [Real; 3] {
    let mut world = world(1.0);
    world.integration_parameters.dt = 1.0 / 60.0;
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(ground));
    let body =
        RigidBodyBuilder::dynamic().translation(from).linvel(Vector::Y * -4.0).lock_rotations();
    let (body, _) =
        world.insert(body.ccd_enabled(ccd).can_sleep(false), ColliderBuilder::new(rod.clone()));
    let heights: Vec<Real> = (0..180)
        .map(|_| {
            world.step();
            world.bodies[body].translation().y
        })
        .collect();
    let least = |heights: &[Real]| heights.iter().copied().fold(Real::INFINITY, Real::min);
    let most = |heights: &[Real]| heights.iter().copied().fold(Real::NEG_INFINITY, Real::max);
    [least(&heights), heights[179], most(&heights[120..]) - least(&heights[120..])]
}

/// What a rod of this radius does that is stopped at a height of 0.
#[track_caller]
fn assert_stopped([lowest, last, tremble]: [Real; 3], context: &str) {
    assert!(
        lowest > RADIUS - 0.15 && (last - RADIUS).abs() < 0.02,
        "{context} passes: {lowest} {last}"
    );
    assert!(tremble < 1e-3, "{context} trembles by {tremble}");
}

#[test]
fn a_rod_is_stopped_by_the_free_edge_of_a_plate() {
    let corners =
        [[-2.0, 0.0], [2.0, 0.0], [2.0, -3.0], [-2.0, -3.0]].map(|[x, y]| Vector::new(x, y, 0.0));
    let orders = [
        [[0, 1, 2], [0, 2, 3]],
        [[1, 0, 2], [2, 0, 3]],
        [[2, 0, 1], [3, 0, 2]],
        [[0, 2, 1], [3, 2, 0]],
    ];
    for along in [Vector::Z, Vector::X] {
        for (name, rod) in rods(along) {
            for order in orders {
                let plate =
                    SharedShape::new(TriMesh::new(corners.to_vec(), order.to_vec()).unwrap());
                for ccd in [false, true] {
                    let end =
                        dropped(&rod, plate.clone(), Vector::new(0.13, RADIUS + 0.61, 0.0), ccd);
                    assert_stopped(end, &format!("{name} along {along}, {order:?}, CCD {ccd}"));
                }
            }
        }
    }
}

#[test]
fn a_rod_along_the_edges_of_a_box_of_triangles_is_stopped() {
    let (vertices, triangles) = Cuboid::new(Vector::new(1.5, 1.0, 0.75)).to_trimesh();
    let lowered: Vec<_> = vertices.into_iter().map(|vertex| vertex - Vector::Y).collect();
    let ground = SharedShape::new(TriMesh::new(lowered, triangles).unwrap());
    for along in [Vector::X, Vector::Z] {
        for (name, rod) in rods(along) {
            // Over the middle, over an edge along it, over an edge across it.
            for place in
                [Vector::ZERO, Vector::Z * 0.75, Vector::X * 1.5, Vector::new(1.5, 0.0, 0.75)]
            {
                for ccd in [false, true] {
                    let end =
                        dropped(&rod, ground.clone(), place + Vector::Y * (RADIUS + 0.61), ccd);
                    assert_stopped(end, &format!("{name} along {along} at {place}, CCD {ccd}"));
                }
            }
        }
    }
}

/// They touch where their centres are as far apart as both are long, the rounding of caps included.
#[test]
fn tubes_on_one_axis_do_not_pass_through_each_other() {
    let ends = |caps: [Cap; 2]| {
        let link = ModifiedCylinder::new(-Vector::X, Vector::X, RADIUS, caps).unwrap();
        (SharedShape::new(link), if caps[1] == Cap::Round { 1.0 + RADIUS } else { 1.0 })
    };
    for first in CAPS {
        for second in CAPS {
            for (speed, ccd) in [(1.0, false), (4.0, false), (4.0, true)] {
                let mut world = world(1.0);
                world.gravity = Vector::ZERO;
                world.integration_parameters.dt = 1.0 / 60.0;
                let (left, reach1) = ends(first);
                // Its first end is the one that meets.
                let (right, reach2) =
                    (ends(second).0, if second[0] == Cap::Round { 1.0 + RADIUS } else { 1.0 });
                let mut insert = |shape, x: Real, way: Real| {
                    let body = RigidBodyBuilder::dynamic()
                        .translation(Vector::X * x)
                        .linvel(Vector::X * way * speed);
                    let body = body.lock_rotations().ccd_enabled(ccd).can_sleep(false);
                    let (body, _) = world.insert(body, ColliderBuilder::new(shape));
                    let mass = world.bodies[body].mass();
                    world.bodies[body].add_force(Vector::X * way * 10.0 * mass, true);
                    body
                };
                let bodies = [insert(left, -2.0, 1.0), insert(right, 2.0, -1.0)];
                let mut gaps = vec![];
                for _ in 0..240 {
                    world.step();
                    let [from, to] = bodies.map(|body| world.bodies[body].translation());
                    gaps.push((to - from).x - reach1 - reach2);
                }
                let context = format!("{first:?} {second:?} at {speed}, CCD {ccd}");
                let deepest = gaps.iter().copied().fold(Real::INFINITY, Real::min);
                assert!(
                    deepest > -0.2 && gaps[239].abs() < 0.03,
                    "{context} pass: {deepest} {}",
                    gaps[239]
                );
                let last = &gaps[180..];
                let tremble = last.iter().copied().fold(Real::NEG_INFINITY, Real::max)
                    - last.iter().copied().fold(Real::INFINITY, Real::min);
                assert!(tremble < 1e-3, "{context} tremble by {tremble}");
            }
        }
    }
}
