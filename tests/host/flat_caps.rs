//! Two flat caps that meet: contact points around all that they have in common, on both caps, and
//! none nearer than the contact.

use crate::depths::gap;
use crate::draw::{CAPS, Draw};
use continuum_testing::placements::Wall;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{
    ContactManifold, PersistentQueryDispatcher, PointQuery, QueryDispatcher,
};
use parry_continuum::parry::shape::{Shape, SharedShape};
use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};
use std::f64::consts::{PI, TAU};

type Manifold = ContactManifold<(), ()>;

fn manifold(pose: &Pose, first: &dyn Shape, second: &dyn Shape) -> Manifold {
    let mut manifold = Manifold::new();
    let dispatcher = ContinuumDispatcher::default();
    dispatcher
        .contact_manifold_convex_convex(pose, first, second, None, None, 0.2, &mut manifold)
        .unwrap();
    manifold
}

/// A link along y with a flat cap at the height 0, from where it reaches up or down to a cap of any
/// kind.
fn post(radius: Real, way: Real, caps: usize) -> ModifiedCylinder {
    ModifiedCylinder::new(Vector::ZERO, Vector::Y * way, radius, [CAPS[0], CAPS[2]][caps]).unwrap()
}

/// How far two discs, `apart` along x, reach in common along a direction of their plane.
fn lens_support([r1, r2]: [Real; 2], apart: Real, turn: Real) -> Real {
    let way = Vector::new(turn.cos(), 0.0, turn.sin());
    let rim = |centre: Real, radius: Real| {
        (0..4000).map(move |k| {
            let at = TAU * Real::from(k) / 4000.0;
            Vector::new(centre + radius * at.cos(), 0.0, radius * at.sin())
        })
    };
    let in_both =
        |p: &Vector| p.length() < r1 + 1e-9 && (*p - Vector::X * apart).length() < r2 + 1e-9;
    rim(0.0, r1)
        .chain(rim(apart, r2))
        .filter(in_both)
        .map(|p| p.dot(way))
        .fold(Real::NEG_INFINITY, Real::max)
}

/// Upright posts, one on the other: the points lie on both caps and surround what they share. From
/// its middle they reach about as far, in any direction, as a square does in a circle.
#[test]
fn posts_stand_on_all_that_their_caps_share() {
    let mut random = Random::new(461);
    let (mut narrow, mut whole) = (0, 0);
    for round in 0..rounds(600) {
        let radii =
            [random.between(0.2, 1.0), if round % 3 == 0 { 0.5 } else { random.between(0.2, 1.0) }];
        let radii = if round % 6 == 0 { [0.5; 2] } else { radii };
        let most = radii[0] + radii[1];
        let apart =
            [0.0, random.log_between(1e-12, 1e-3), random.between(0.0, 0.97) * most][round % 3];
        let (below, above) = (post(radii[0], -2.0, round % 2), post(radii[1], 2.0, round / 2 % 2));
        let depth = random.between(-0.1, 0.1) * radii[0].min(radii[1]);
        let turn = Pose::rotation(Vector::Y * random.between(-PI, PI));
        let pose = Pose::from_translation(Vector::new(apart, -depth, 0.0)) * turn;
        let found = manifold(&pose, &below, &above);
        let context = || format!("{radii:?} {apart} {depth} {found:?}");
        if found.local_n1.y < 0.999 {
            // A narrow lens is left sideways.
            assert!(depth > 0.0, "{}", context());
            continue;
        }
        assert!((found.local_n1 - Vector::Y).length() < 1e-7, "{}", context());
        for point in &found.points {
            assert!((point.dist + depth).abs() < 1e-9, "{}", context());
            let on_second = pose * point.local_p2;
            assert!(
                point.local_p1.y.abs() < 1e-9 && (on_second.y + depth).abs() < 1e-9,
                "{}",
                context()
            );
            assert!(point.local_p1.length() < radii[0] + 1e-9, "{}", context());
            let from_second = on_second.with_y(0.0) - Vector::X * apart;
            assert!(from_second.length() < radii[1] + 1e-9, "{}", context());
        }
        let middle = 0.5 * ((-radii[0]).max(apart - radii[1]) + radii[0].min(apart + radii[1]));
        for k in 0..16 {
            let turn = TAU * Real::from(k) / 16.0;
            let way = Vector::new(turn.cos(), 0.0, turn.sin());
            let reach = found.points.iter().map(|point| point.local_p1.dot(way));
            let reach = reach.fold(Real::NEG_INFINITY, Real::max) - middle * turn.cos();
            let whole = lens_support(radii, apart, turn) - middle * turn.cos();
            assert!(reach > 0.65 * whole, "{turn} {reach} {whole} {}", context());
        }
        if apart > 0.5 * most { narrow += 1 } else { whole += 1 }
    }
    assert!(narrow > rounds(50) && whole > rounds(300), "{narrow} {whole}");
}

/// Turned about its axis by a little, or shifted by a little, a post keeps the names of its points.
#[test]
fn points_of_caps_keep_their_names() {
    let mut random = Random::new(462);
    for radii in [[0.5, 0.5], [0.3, 0.6], [0.6, 0.3]] {
        let (below, above) = (post(radii[0], -2.0, 0), post(radii[1], 2.0, 1));
        let names = |pose: &Pose| {
            let found = manifold(pose, &below, &above);
            let mut names: Vec<_> =
                found.points.iter().map(|point| (point.fid1.0, point.fid2.0)).collect();
            names.sort_unstable();
            names
        };
        let before = names(&Pose::IDENTITY);
        assert!(before.len() >= 4, "{before:?}");
        for _ in 0..100 {
            let pose = Pose::new(random.vector(1e-4), random.vector(1e-7));
            assert_eq!(names(&pose), before, "{radii:?} {pose:?}");
        }
    }
}

/// Any two links, aligned or not: each point is on the plane of a cap or the barrel it says, `dist`
/// from its partner along the normal, and the nearest is the contact, which the gap along its
/// normal proves.
#[test]
fn no_point_of_two_links_is_nearer_than_their_contact() {
    let mut random = Random::new(463);
    let dispatcher = ContinuumDispatcher::default();
    let (mut apart, mut overlapping, mut points) = (0, 0, 0);
    for round in 0..6000 {
        let (first, wall, pose) = if round % 2 == 0 {
            random.aligned(if round % 4 == 0 { Wall::Link } else { Wall::Cylinder })
        } else {
            let wall = SharedShape::new(random.link());
            (random.link(), wall, random.pose(2.0))
        };
        let contact = dispatcher.contact(&pose, &first, &*wall, 0.2).unwrap();
        let found = manifold(&pose, &first, &*wall);
        let context =
            || format!("{first:?} {:?} {pose:?} {contact:?} {found:?}", wall.as_typed_shape());
        let Some(contact) = contact else {
            assert!(found.points.is_empty(), "{}", context());
            continue;
        };
        assert_eq!(found.local_n1, contact.normal1, "{}", context());
        let least = found.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        assert!((least - contact.dist).abs() < 1e-11, "{least} {}", context());
        let proven = gap(&pose, &first, &*wall, contact.normal1);
        // Of what all but touches, the steps towards the normal may end a little early.
        let slack = if contact.dist > 0.0 { 1e-9 } else { 1e-12 };
        assert!(contact.dist - proven < slack, "{proven} {}", context());
        if contact.dist > 0.0 {
            apart += 1
        } else {
            overlapping += 1
        }
        for point in &found.points {
            points += 1;
            let between = pose * point.local_p2 - point.local_p1;
            assert!((between - found.local_n1 * point.dist).length() < 1e-12, "{}", context());
        }
        if contact.dist > 0.0 {
            let off = [
                first.distance_to_local_point(contact.point1, true),
                wall.distance_to_local_point(contact.point2, true),
            ];
            assert!(off.iter().all(|&off| off < 1e-7), "{off:?} {}", context());
        }
    }
    assert!(apart > 800 && overlapping > 1000 && points > 4000, "{apart} {overlapping} {points}");
}
