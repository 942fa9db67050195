//! How deep a link and another convex shape overlap: the dispatcher's table of excesses, for
//! aligned, coaxial, coplanar and crossing placements as for any, tilted or not.
//!
//! For any unit vector the gap between the two supports along it is what a translation along it has
//! to close: so what a contact says must be the gap along its own normal (then it separates), and
//! no way out that a dense search finds may be shorter by more than the table says. The supports
//! are written anew here.

use crate::draw::{CAPS, Draw};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{
    Contact, ContactManifold, PersistentQueryDispatcher, QueryDispatcher,
};
use parry_continuum::parry::shape::{Shape, SharedShape};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};
use std::collections::BTreeMap;

/// How far a shape reaches along a unit vector.
pub fn support(shape: &dyn Shape, along: Vector) -> Real {
    let Some(link) = shape.as_shape::<ModifiedCylinder>() else {
        return shape.as_support_map().unwrap().local_support_point_toward(along).dot(along);
    };
    let axis = (link.end() - link.start()).normalize_or_zero();
    let across = (along - axis * axis.dot(along)).length();
    let ends = [(link.start(), -axis), (link.end(), axis)].into_iter().zip(link.caps());
    let reach = |((centre, outward), cap): ((Vector, Vector), Cap)| {
        let leans_out = cap == Cap::Round && outward.dot(along) >= 0.0;
        centre.dot(along) + link.radius() * if leans_out { 1.0 } else { across }
    };
    ends.map(reach).fold(Real::NEG_INFINITY, Real::max)
}

/// How far the second begins beyond the first along a unit vector.
pub fn gap(pose: &Pose, first: &dyn Shape, second: &dyn Shape, along: Vector) -> Real {
    let back = pose.rotation.inverse() * -along;
    -support(second, back) - pose.translation.dot(-along) - support(first, along)
}

/// The widest gap that a walk finds from many directions.
fn searched(random: &mut Random, gap: impl Fn(Vector) -> Real) -> (Real, Vector) {
    let mut starts: Vec<_> =
        (0..400).map(|_| random.direction()).map(|way| (gap(way), way)).collect();
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best = starts[0];
    for mut at in starts.into_iter().take(6) {
        let mut step = 0.1;
        for _ in 0..90 {
            let (u, v) = at.1.any_orthonormal_pair();
            let around = (0..6).map(|k| Real::from(k) * std::f64::consts::TAU / 6.0 + step);
            let next = around
                .map(|turn| (at.1 + (u * turn.cos() + v * turn.sin()) * step).normalize())
                .map(|way| (gap(way), way))
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap();
            if next.0 > at.0 { at = next } else { step *= 0.6 }
        }
        if at.0 > best.0 {
            best = at;
        }
    }
    best
}

/// The name of the other shape, and by how much a depth may exceed the least one, as a share of the
/// sizes.
const EXCESS: [(&str, Real); 9] = [
    ("round link", 1e-12),
    ("flat link", 1e-6),
    ("capsule", 1e-12),
    ("cylinder", 1e-6),
    ("cuboid", 1e-6),
    ("polyhedron", 1e-6),
    ("cone", 1e-2),
    ("round cuboid", 1e-6),
    ("round cylinder", 1e-2),
];

fn size(random: &mut Random) -> Real {
    [0.25, 0.5, 1.0, random.between(0.1, 1.0)][random.index(4)]
}

fn other(random: &mut Random, name: &str) -> SharedShape {
    let [a, b, c] = [0; 3].map(|_| size(random));
    let link = |caps| {
        SharedShape::new(ModifiedCylinder::new(-a * Vector::Y, a * Vector::Y, b, caps).unwrap())
    };
    match name {
        "round link" => link([Cap::Round; 2]),
        "flat link" => link([CAPS[0], CAPS[2], CAPS[3]][random.index(3)]),
        "capsule" => SharedShape::capsule_y(a, b),
        "cylinder" => SharedShape::cylinder(a, b),
        "cuboid" => SharedShape::cuboid(a, b, c),
        "polyhedron" => {
            let points: Vec<_> =
                (0..8 + random.index(20)).map(|_| random.direction() * a).collect();
            SharedShape::convex_hull(&points).unwrap()
        }
        "cone" => SharedShape::cone(a, b),
        "round cuboid" => SharedShape::round_cuboid(a, b, c, 0.125),
        _ => SharedShape::round_cylinder(a, b, 0.125),
    }
}

/// A place of the other shape, whose axis is y, before a link along y around the origin.
fn place(random: &mut Random) -> (&'static str, Pose) {
    let tilt = if random.chance(0.5) { 0.0 } else { random.log_between(1e-15, 1e-3) };
    let way = [Vector::X, Vector::Y, Vector::Z, random.direction()][random.index(4)] * tilt;
    let shift = |random: &mut Random| [0.0, 0.25, 0.5, random.between(-1.5, 1.5)][random.index(4)];
    let any = random.vector(1.0);
    let turn = [
        Vector::ZERO,
        Vector::X * std::f64::consts::FRAC_PI_2,
        Vector::X,
        Vector::X * std::f64::consts::PI,
    ][random.index(4)];
    let (name, translation, turn) = match random.index(6) {
        0 => ("coaxial", Vector::Y * shift(random), Vector::ZERO),
        1 => ("parallel", Vector::new(shift(random), shift(random), 0.0), Vector::ZERO),
        2 => ("crossing", Vector::ZERO, turn),
        3 => ("coplanar", Vector::new(0.0, shift(random), shift(random)), turn),
        4 => ("aligned", Vector::new(shift(random), shift(random), shift(random)), turn),
        _ => ("any", any, random.direction() * random.between(0.0, 3.0)),
    };
    (name, Pose::from_translation(translation) * Pose::rotation(way) * Pose::rotation(turn))
}

#[test]
fn depths_are_the_least_but_for_what_the_table_says() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(401);
    let mut seen = BTreeMap::<(&str, &str), usize>::new();
    let mut bad = Vec::new();
    for (name, allowed) in EXCESS {
        let (mut worst, mut over, mut total) = ((0.0, String::new()), 0, 0);
        for _ in 0..rounds(100) {
            let caps =
                if ["round link", "capsule"].contains(&name) { CAPS[1] } else { random.caps() };
            let (half, radius) = (size(&mut random), size(&mut random));
            let link =
                ModifiedCylinder::new(-half * Vector::Y, half * Vector::Y, radius, caps).unwrap();
            let wall = other(&mut random, name);
            let (how, pose) = place(&mut random);
            for (pos12, g1, g2) in
                [(pose, &link as &dyn Shape, &*wall), (pose.inverse(), &*wall, &link as &dyn Shape)]
            {
                let contact = dispatcher.contact(&pos12, g1, g2, 0.0).unwrap();
                let Some(contact) = contact.filter(|contact| contact.dist < 0.0) else { continue };
                let context =
                    || format!("{name} {how} {caps:?} {half} {radius} {pos12:?} {contact:?}");
                *seen.entry((name, how)).or_default() += 1;
                let own = gap(&pos12, g1, g2, contact.normal1);
                assert!((own - contact.dist).abs() < 1e-13, "{own} {}", context());
                consistent(&pos12, &contact, 1e-9, context);
                manifold_agrees(&pos12, g1, g2, &contact, context);
                let found = searched(&mut random, |way| gap(&pos12, g1, g2, way));
                let excess = found.0 - contact.dist;
                total += 1;
                over += usize::from(excess > 1e-7);
                if excess > worst.0 {
                    worst = (excess, format!("{} {}", found.1, context()));
                }
            }
        }
        println!("{name}: worst excess {:e}, {over} of {total} over 1e-7", worst.0);
        if worst.0 > allowed {
            bad.push(format!("{name} {} {}", worst.0, worst.1));
        }
    }
    println!("{seen:?}");
    assert!(bad.is_empty(), "{}", bad.join("\n"));
    assert!(
        EXCESS.iter().all(|(name, _)| seen.get(&(name, "coaxial")).is_some_and(|&n| n > rounds(5))),
        "{seen:?}"
    );
}

/// The points are where the distance along the normal says.
fn consistent(pos12: &Pose, contact: &Contact, tolerance: Real, context: impl Fn() -> String) {
    let between = pos12 * contact.point2 - contact.point1;
    assert!((between - contact.normal1 * contact.dist).length() < tolerance, "{}", context());
    assert!((contact.normal1.length() - 1.0).abs() < 1e-14, "{}", context());
    let turned = pos12.rotation * contact.normal2;
    assert!((turned + contact.normal1).length() < 1e-14, "{}", context());
}

/// The least `dist` of the manifold is the contact's, along the contact's normal.
fn manifold_agrees(
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    contact: &Contact,
    context: impl Fn() -> String,
) {
    let mut manifold = ContactManifold::<(), ()>::new();
    let dispatcher = ContinuumDispatcher::default();
    dispatcher
        .contact_manifold_convex_convex(pos12, g1, g2, None, None, 0.1, &mut manifold)
        .unwrap();
    let least = manifold.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
    assert!((least - contact.dist).abs() < 1e-12, "{least} {}", context());
    assert!((manifold.local_n1 - contact.normal1).length() < 1e-9, "{manifold:?} {}", context());
}

fn contact(pose: &Pose, first: &ModifiedCylinder, second: &ModifiedCylinder) -> Contact {
    ContinuumDispatcher::default().contact(pose, first, second, 0.0).unwrap().unwrap()
}

/// Two round links overlap by their radii less the distance of their axes, wherever these lie: on
/// one axis, crossing or parallel, in any unit of length.
#[test]
fn round_links_overlap_by_their_radii_less_the_distance_of_their_axes() {
    let mut random = Random::new(402);
    let capsule = |start, end, radius| ModifiedCylinder::capsule(start, end, radius).unwrap();
    let first = capsule(Vector::ZERO, 10.0 * Vector::X, 1.0);
    for (shift, depth) in
        [(4.0, 2.0), (0.0, 2.0), (9.0, 2.0), (10.0, 2.0), (11.0, 1.0), (-11.5, 0.5)]
    {
        let place = Pose::from_translation(Vector::X * shift);
        for turn in [0.0, std::f64::consts::PI] {
            let turned = place
                * Pose::from_translation(5.0 * Vector::X)
                * Pose::rotation(Vector::Y * turn)
                * Pose::from_translation(-5.0 * Vector::X);
            let found = contact(&turned, &first, &first);
            assert!((found.dist + depth).abs() < 1e-14, "{shift} {turn} {found:?}");
            assert!(
                (gap(&turned, &first, &first, found.normal1) + depth).abs() < 1e-14,
                "{found:?}"
            );
        }
    }
    let (mut crossing, mut deep) = (0, 0);
    for _ in 0..5000 {
        let [r1, r2] = [size(&mut random), size(&mut random)];
        let angle = if random.chance(0.3) {
            random.log_between(1e-17, 1e-3)
        } else {
            random.between(0.0, 1.6)
        };
        let height =
            if random.chance(0.3) { 0.0 } else { random.log_between(1e-16, 1.0) } * (r1 + r2);
        let (one, other) =
            (capsule(-Vector::X, Vector::X, r1), capsule(-2.0 * Vector::X, 2.0 * Vector::X, r2));
        // They cross in the middle, one above the other.
        let pose = Pose::from_translation(Vector::Y * height) * Pose::rotation(Vector::Y * angle);
        let found = contact(&pose, &one, &other);
        let depth = r1 + r2 - height;
        assert!((found.dist + depth).abs() < 1e-14, "{angle} {height} {found:?}");
        let own = gap(&pose, &one, &other, found.normal1);
        assert!((own - found.dist).abs() < 1e-13, "{own} {angle} {height} {found:?}");
        crossing += usize::from(height == 0.0);
        deep += usize::from(height < 1e-9);
        for exponent in [-100, -3, 40] {
            let unit = Real::powi(2.0, exponent);
            let [one, other] = [&one, &other]
                .map(|link| capsule(link.start() * unit, link.end() * unit, link.radius() * unit));
            let pose = Pose { translation: pose.translation * unit, ..pose };
            let scaled = contact(&pose, &one, &other);
            assert_eq!(
                (scaled.dist, scaled.normal1),
                (found.dist * unit, found.normal1),
                "{angle} {height}"
            );
        }
    }
    assert!(crossing > 1000 && deep > 1500, "{crossing} {deep}");
}

/// Two cylinders on one axis: out along it, or across it, whichever is shorter.
#[test]
fn cylinders_on_one_axis_part_along_it_or_across() {
    for (radius, length, shift) in
        [(1.0, 10.0, 4.0), (1.0, 10.0, 9.0), (0.9, 1.8, 0.0), (0.25, 8.0, 1.0), (2.0, 1.0, 0.5)]
    {
        for tilt in [0.0, 1e-15, 1e-9, 1e-6] {
            let link =
                ModifiedCylinder::cylinder(Vector::ZERO, Vector::Z * length, radius).unwrap();
            let pose = Pose::new(Vector::Z * shift, Vector::X * tilt);
            let found = contact(&pose, &link, &link);
            let least = (2.0 * radius).min(length - shift);
            assert!(
                (found.dist + least).abs() < 1e-12 + 20.0 * tilt,
                "{radius} {length} {shift} {tilt} {found:?}"
            );
            let own = gap(&pose, &link, &link, found.normal1);
            assert!((own - found.dist).abs() < 1e-13, "{own} {found:?}");
            // Moved apart by it they meet no more.
            let moved = Pose::from_translation(found.normal1 * (1e-4 - found.dist)) * pose;
            let apart =
                ContinuumDispatcher::default().distance(&moved, &link, &link).unwrap().distance;
            assert!(apart > 0.0, "{apart} {found:?}");
        }
    }
}
