//! No NaN leaves a query whose input is finite: every number of an answer is finite and every
//! normal has a direction, or the pair is `Unsupported`. Shapes have degenerate sizes, and
//! placements are concentric, aligned and touching as often as general.

use crate::draw::Draw;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, Contact, ContactManifold, PersistentQueryDispatcher, QueryDispatcher,
};
use parry_continuum::parry::shape::{
    Cone, Cuboid, Cylinder, HalfSpace, RoundCuboid, RoundCylinder, RoundShape, Segment, Shape,
    SharedShape, Triangle,
};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};

/// A size, 0 as often as one in four.
fn size(random: &mut Random) -> Real {
    if random.chance(0.25) { 0.0 } else { [0.5, 0.3, random.between(0.01, 1.0)][random.index(3)] }
}

/// The number of kinds of shapes beside a robot.
const KINDS: usize = 16;

fn shape(random: &mut Random, kind: usize) -> Option<SharedShape> {
    let [a, b, c] = [0; 3].map(|_| size(random));
    let half = Vector::new(a, b, c);
    Some(match kind {
        0 => SharedShape::ball(a),
        1 => SharedShape::capsule_y(a, b),
        2 => SharedShape::new(Cylinder::new(a, b)),
        3 => SharedShape::new(Cuboid::new(half)),
        4 => SharedShape::new(Cone::new(a, b)),
        5 => {
            let round = RoundCylinder { inner_shape: Cylinder::new(a, b), border_radius: c };
            SharedShape::new(round)
        }
        6 => {
            let round = RoundCuboid { inner_shape: Cuboid::new(half), border_radius: c };
            SharedShape::new(round)
        }
        7 => SharedShape::new(RoundShape { inner_shape: Cone::new(a, b), border_radius: c }),
        8 => SharedShape::convex_hull(&[
            half,
            Vector::ZERO,
            Vector::X,
            random.vector(1.0),
            Vector::Y,
        ])?,
        9 => SharedShape::new(HalfSpace::new(random.direction())),
        10 => SharedShape::new(Segment::new(-half, half)),
        11 => SharedShape::new(Triangle::new(Vector::ZERO, half, random.vector(1.0))),
        12 => {
            let corners = vec![Vector::ZERO, half, random.vector(1.0), Vector::X];
            SharedShape::trimesh(corners, vec![[0, 1, 2], [1, 2, 3]]).ok()?
        }
        13 => SharedShape::new(random.link()),
        14 => {
            let points = [Vector::ZERO, a * Vector::X, Vector::ONE];
            SharedShape::new(Chain::from_centreline(&points, &[b; 2]).ok()?)
        }
        _ => SharedShape::compound(vec![
            (Pose::IDENTITY, SharedShape::new(Cylinder::new(a, b))),
            (Pose::translation(1.0, 0.0, 0.0), SharedShape::ball(c)),
        ]),
    })
}

/// A link of any form, as often one of plain sizes along an axis.
fn robot(random: &mut Random) -> ModifiedCylinder {
    if random.chance(0.5) {
        return random.link();
    }
    let (length, radius) = (size(random), size(random));
    if length == 0.0 {
        return ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, radius).unwrap();
    }
    let end = length * Vector::AXES[random.index(3)];
    ModifiedCylinder::new(Vector::ZERO, end, radius, random.caps()).unwrap()
}

fn pose(random: &mut Random) -> Pose {
    let place = match random.index(4) {
        0 => Vector::ZERO,
        1 => size(random) * Vector::AXES[random.index(3)],
        2 => Vector::new(size(random), -size(random), size(random)),
        _ => random.vector(1.5),
    };
    let turn = if random.chance(0.5) { Vector::ZERO } else { random.direction() * 2.0 };
    Pose::new(place, turn)
}

fn is_unit(normal: Vector) -> bool {
    (normal.length() - 1.0).abs() < 1e-3
}

fn is_sound(contact: &Contact) -> bool {
    contact.dist.is_finite()
        && contact.point1.is_finite()
        && contact.point2.is_finite()
        && is_unit(contact.normal1)
        && is_unit(contact.normal2)
}

/// Asks all queries. Returns whether the manifolds have points.
fn ask(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real, context: &str) -> bool {
    let dispatcher = ContinuumDispatcher::default();
    if let Ok(apart) = dispatcher.distance(pos12, g1, g2) {
        assert!(apart.distance.is_finite() && apart.distance >= 0.0, "{context}: {apart:?}");
    }
    if let Ok(ClosestPoints::WithinMargin(p1, p2)) =
        dispatcher.closest_points(pos12, g1, g2, prediction)
    {
        assert!(p1.is_finite() && p2.is_finite(), "{context}: {p1} {p2}");
    }
    if let Ok(Some(contact)) = dispatcher.contact(pos12, g1, g2, prediction) {
        assert!(is_sound(&contact), "{context}: {contact:?}");
    }
    let mut manifolds = Vec::<ContactManifold<(), ()>>::new();
    let answer = dispatcher.contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut None);
    let mut met = false;
    for manifold in manifolds.iter().filter(|manifold| !manifold.points.is_empty()) {
        met = answer.is_ok();
        let (n1, n2) = (manifold.local_n1, manifold.local_n2);
        assert!(is_unit(n1) && is_unit(n2), "{context}: {manifold:?}");
        for point in &manifold.points {
            let places = [point.local_p1, point.local_p2];
            let is_finite = point.dist.is_finite() && places.iter().all(|p| p.is_finite());
            assert!(is_finite, "{context}: {manifold:?}");
        }
    }
    met
}

#[test]
fn every_number_is_finite() {
    for kind in 0..KINDS {
        let mut random = Random::new(411 + kind as u64);
        let (draws, mut met, mut apart) = (rounds(2500_usize), 0, 0);
        for _ in 0..draws {
            let (link, pose) = (robot(&mut random), pose(&mut random));
            let Some(other) = shape(&mut random, kind) else { continue };
            let prediction = [0.0, 0.1, 1.0][random.index(3)];
            let context = format!("{link:?} {:?} {pose:?} {prediction}", other.as_typed_shape());
            let there = ask(&pose, &link, &*other, prediction, &context);
            let back = ask(&pose.inverse(), &*other, &link, prediction, &context);
            met += usize::from(there) + usize::from(back);
            apart += usize::from(!there) + usize::from(!back);
        }
        assert!(met > draws / 5 && apart > draws / 50, "kind {kind}: {met} {apart} of {draws}");
    }
}

/// The two smallest cases: the rim of a disc, and a ball inside a round cylinder.
#[test]
fn a_disc_and_a_concentric_ball_are_answered() {
    let ball = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.3).unwrap();
    let place = Vector::new(-0.371699422765307, 0.039521769789969415, -0.5457576308255477);
    let disc = Cylinder::new(0.0, 0.5);
    assert!(ask(&Pose::from_translation(place), &disc, &ball, 0.1, "disc"));
    // The nearest point of the disc is on its rim, 0.5 from the axis; the ball is 0.3 thick.
    let rim = 0.5 * Vector::new(place.x, 0.0, place.z).normalize();
    let contact = ContinuumDispatcher::default()
        .contact(&Pose::from_translation(place), &disc, &ball, 0.1)
        .unwrap()
        .unwrap();
    assert!((contact.dist - ((place - rim).length() - 0.3)).abs() < 1e-5, "{contact:?}");
    let round = RoundCylinder { inner_shape: Cylinder::new(0.4, 0.3), border_radius: 0.1 };
    let turned = Pose::from_parts(Vector::ZERO, Rot3::from_rotation_z(0.4));
    for pose in [Pose::IDENTITY, turned] {
        // 0.4 to the barrel or 0.5 to the caps, and the ball's radius.
        let contact = ContinuumDispatcher::default().contact(&pose, &ball, &round, 0.1);
        let contact = contact.unwrap().unwrap();
        assert!(is_sound(&contact) && (contact.dist + 0.7).abs() < 0.01 * 0.7, "{contact:?}");
        assert!(ask(&pose, &ball, &round, 0.1, "round cylinder"));
    }
    // A link across the disc's rim touches it, with any caps.
    for caps in [Cap::Flat, Cap::Round] {
        let link = ModifiedCylinder::new(-Vector::X, Vector::X, 0.1, [caps; 2]).unwrap();
        let at_rim = Pose::from_translation(Vector::new(0.5, 0.05, 0.0));
        assert!(ask(&at_rim, &disc, &link, 0.1, "link at the rim"));
    }
}
