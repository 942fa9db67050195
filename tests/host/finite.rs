//! No NaN leaves a query whose input is finite: every number of an answer is finite and every
//! normal has a direction, or the pair is `Unsupported`. The pairs are those of the dispatcher's
//! table: a link or a chain beside each kind of shape. Shapes have degenerate sizes, and placements
//! are concentric, aligned and touching as often as general.

use crate::draw::Draw;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, Contact, ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher,
    QueryDispatcher, ShapeCastHit, ShapeCastOptions,
};
use parry_continuum::parry::shape::{
    Cone, Cuboid, Cylinder, HalfSpace, HeightField, RoundCuboid, RoundCylinder, RoundShape,
    Segment, Shape, SharedShape, Triangle,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use std::fmt::Arguments;

/// A size, 0 as often as one in four.
fn size(random: &mut Random) -> Real {
    if random.chance(0.25) { 0.0 } else { [0.5, 0.3, random.between(0.01, 1.0)][random.index(3)] }
}

/// The number of kinds of shapes beside a robot.
const KINDS: usize = 18;

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
        15 => SharedShape::polyline(vec![Vector::ZERO, half, random.vector(1.0)], None),
        16 => {
            let heights = Array2::new(2, 3, vec![0.0, a, 0.0, b, 0.0, random.unit()]);
            let scale = Vector::new(1.0, size(random), 1.0 + c);
            SharedShape::new(HeightField::new(heights, scale))
        }
        _ => SharedShape::compound(vec![
            (Pose::IDENTITY, SharedShape::new(Cylinder::new(a, b))),
            (Pose::translation(1.0, 0.0, 0.0), SharedShape::ball(c)),
        ]),
    })
}

/// A link or, one in four times, a chain.
fn robot(random: &mut Random) -> SharedShape {
    if !random.chance(0.25) {
        return SharedShape::new(link(random));
    }
    let (a, radii) = (size(random), [size(random), size(random)]);
    let points = [-0.5 * Vector::Z, a * Vector::X, 0.5 * Vector::Z];
    match Chain::from_centreline(&points, &radii) {
        Ok(chain) => SharedShape::new(chain),
        Err(_) => SharedShape::new(Chain::capsules(&points, &radii).unwrap()),
    }
}

/// A link of any form, as often one of plain sizes along an axis.
fn link(random: &mut Random) -> ModifiedCylinder {
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

fn assert_sound_hit(hit: Option<ShapeCastHit>, context: Arguments) {
    let Some(hit) = hit else { return };
    let vectors = [hit.witness1, hit.witness2, hit.normal1, hit.normal2];
    let is_finite = hit.time_of_impact.is_finite() && vectors.iter().all(|v| v.is_finite());
    assert!(is_finite, "{context}: {hit:?}");
}

/// Asks both casts: the second shape comes nearer, and the first one turns.
fn cast(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real, context: Arguments) {
    let dispatcher = ContinuumDispatcher::default();
    let options = ShapeCastOptions { target_distance: prediction, ..Default::default() };
    let towards = -pos12.translation;
    if let Ok(hit) = dispatcher.cast_shapes(pos12, towards, g1, g2, options) {
        assert_sound_hit(hit, context);
    }
    let turns = NonlinearRigidMotion { angvel: Vector::Y, ..NonlinearRigidMotion::identity() };
    let comes =
        NonlinearRigidMotion { start: *pos12, linvel: towards, ..NonlinearRigidMotion::identity() };
    for stop in [true, false] {
        if let Ok(hit) = dispatcher.cast_shapes_nonlinear(&turns, g1, &comes, g2, 0.0, 1.0, stop) {
            assert_sound_hit(hit, context);
        }
    }
}

/// Asks the queries of a placement. Returns whether the manifolds have points, or `None` if they
/// are `Unsupported`.
fn ask(
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    prediction: Real,
    context: Arguments,
) -> Option<bool> {
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
        met = true;
        let (n1, n2) = (manifold.local_n1, manifold.local_n2);
        assert!(is_unit(n1) && is_unit(n2), "{context}: {manifold:?}");
        for point in &manifold.points {
            let places = [point.local_p1, point.local_p2];
            let is_finite = point.dist.is_finite() && places.iter().all(|p| p.is_finite());
            assert!(is_finite, "{context}: {manifold:?}");
        }
    }
    answer.is_ok().then_some(met)
}

#[test]
fn every_number_is_finite() {
    for kind in 0..KINDS {
        let mut random = Random::new(411 + kind as u64);
        let (draws, mut met, mut apart) = (rounds(2500_usize), 0, 0);
        // The number of manifolds that are answered in both orders.
        let (mut answered, mut refused) = (0, 0);
        while answered < draws {
            let (robot, pose) = (robot(&mut random), pose(&mut random));
            let Some(other) = shape(&mut random, kind) else { continue };
            let prediction = [0.0, 0.1, 1.0][random.index(3)];
            let (link, chain) = (robot.as_shape::<ModifiedCylinder>(), robot.as_shape::<Chain>());
            let other_type = other.as_typed_shape();
            let context = format_args!("{link:?} {chain:?} {other_type:?} {pose:?} {prediction}");
            let orders: [(Pose, &dyn Shape, &dyn Shape); 2] =
                [(pose, &*robot, &*other), (pose.inverse(), &*other, &*robot)];
            let answers = orders.map(|(pos12, g1, g2)| {
                cast(&pos12, g1, g2, prediction, context);
                ask(&pos12, g1, g2, prediction, context)
            });
            refused += answers.iter().filter(|answer| answer.is_none()).count();
            let [Some(there), Some(back)] = answers else { continue };
            answered += 1;
            met += usize::from(there) + usize::from(back);
            apart += usize::from(!there) + usize::from(!back);
        }
        println!("kind {kind}: {answered} answered, {refused} refused; {met} met, {apart} apart");
        assert!(met > draws / 5 && apart > draws / 50, "kind {kind}: {met} {apart} of {draws}");
        assert!(refused < draws / 5, "kind {kind}: {refused} refused of {draws}");
    }
}

/// The two smallest cases: the rim of a disc, and a ball inside a round cylinder.
#[test]
fn a_disc_and_a_concentric_ball_are_answered() {
    let ball = ModifiedCylinder::capsule(Vector::ZERO, Vector::ZERO, 0.3).unwrap();
    let place = Vector::new(-0.371699422765307, 0.039521769789969415, -0.5457576308255477);
    let disc = Cylinder::new(0.0, 0.5);
    assert!(
        ask(&Pose::from_translation(place), &disc, &ball, 0.1, format_args!("disc")) == Some(true)
    );
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
        assert!(ask(&pose, &ball, &round, 0.1, format_args!("round cylinder")) == Some(true));
    }
    // A link across the disc's rim touches it, with any caps.
    for caps in [Cap::Flat, Cap::Round] {
        let link = ModifiedCylinder::new(-Vector::X, Vector::X, 0.1, [caps; 2]).unwrap();
        let at_rim = Pose::from_translation(Vector::new(0.5, 0.05, 0.0));
        assert!(ask(&at_rim, &disc, &link, 0.1, format_args!("link at the rim")) == Some(true));
    }
}
