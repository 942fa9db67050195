//! The box of a link holds it and touches it on all six sides.
//!
//! The judge is the support function of the link's parts, each written down from its definition and
//! searched by sampling: discs by angle, half balls by the directions that they contain.

use continuum_testing::Random;
use parry_continuum::parry::bounding_volume::Aabb;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::{Cap, Chain, ModifiedCylinder};

const CAPS: [[Cap; 2]; 4] = [
    [Cap::Flat, Cap::Flat],
    [Cap::Flat, Cap::Round],
    [Cap::Round, Cap::Flat],
    [Cap::Round, Cap::Round],
];

/// A direction that may be along a coordinate axis, in a coordinate plane, or neither.
fn direction(random: &mut Random) -> Vector {
    let mut v = random.point();
    for i in 0..3 {
        if random.unit() < 0.3 {
            v[i] = 0.0;
        }
    }
    if v == Vector::ZERO { Vector::Y } else { v.normalize() }
}

/// Points of the link's surface, dense on the rims and caps; the link must have a length.
fn surface(link: &ModifiedCylinder, around: u32) -> Vec<Vector> {
    let axis = (link.end() - link.start()).normalize();
    let side = axis.any_orthonormal_vector();
    let up = axis.cross(side);
    let mut points = vec![];
    for (centre, outward, cap) in
        [(link.start(), -axis, link.caps()[0]), (link.end(), axis, link.caps()[1])]
    {
        for i in 0..around {
            let (sin, cos) = (std::f64::consts::TAU * Real::from(i) / Real::from(around)).sin_cos();
            let radial = side * cos + up * sin;
            points.push(centre + radial * link.radius());
            if cap == Cap::Round {
                for j in 1..=around / 4 {
                    let (sin, cos) =
                        (std::f64::consts::TAU * Real::from(j) / Real::from(around)).sin_cos();
                    points.push(centre + (radial * cos + outward * sin) * link.radius());
                }
            }
        }
    }
    points
}

fn assert_holds(aabb: &Aabb, points: &[Vector], slack: Real) {
    for &p in points {
        let outside = (aabb.mins - p).max(p - aabb.maxs).max_element();
        assert!(outside <= slack, "{p} is {outside} outside of {aabb:?}");
    }
}

/// Each side of the box is within `gap` of one of the points.
fn assert_touches(aabb: &Aabb, points: &[Vector], gap: Real) {
    let low = points.iter().fold(Vector::INFINITY, |low, &p| low.min(p));
    let high = points.iter().fold(Vector::NEG_INFINITY, |high, &p| high.max(p));
    let between = (low - aabb.mins).max(aabb.maxs - high).max_element();
    assert!(between <= gap, "a side of {aabb:?} is {between} from the shape");
}

fn random_link(random: &mut Random, caps: [Cap; 2]) -> ModifiedCylinder {
    let start = random.point();
    // From a coin to a needle; axes along the coordinates included.
    let length = Real::powf(10.0, random.between(-3.0, 1.0));
    ModifiedCylinder::new(start, start + direction(random) * length, random.between(0.1, 2.0), caps)
        .unwrap()
}

#[test]
fn holds_the_surface_and_touches_it() {
    let mut random = Random::new(1);
    let around = 400;
    // Half a step on the rim or on the ball in each of two directions, and the sphere's curvature.
    let gap = 2.0 * 2.0 * (std::f64::consts::PI / Real::from(around)).powi(2);
    let mut along_a_coordinate = 0;
    for i in 0..120 {
        let link = random_link(&mut random, CAPS[i % 4]);
        along_a_coordinate += usize::from(link.axis().abs().max_element() == 1.0);
        let points = surface(&link, around);
        assert_holds(&link.local_aabb(), &points, 1e-14);
        assert_touches(&link.local_aabb(), &points, gap);
    }
    assert!((5..60).contains(&along_a_coordinate), "{along_a_coordinate}");
}

/// Along the coordinate axes the box is known to the last bit.
#[test]
fn along_the_coordinates() {
    let boxes = CAPS.map(|caps| {
        ModifiedCylinder::new(Vector::new(1.0, 2.0, 3.0), Vector::new(1.0, 2.0, 5.0), 0.5, caps)
            .unwrap()
            .local_aabb()
    });
    for (aabb, (low, high)) in boxes.iter().zip([(3.0, 5.0), (3.0, 5.5), (2.5, 5.0), (2.5, 5.5)]) {
        assert_eq!(*aabb, Aabb::new(Vector::new(0.5, 1.5, low), Vector::new(1.5, 2.5, high)));
    }
}

/// Axes with whole components and whole length, and that length as radius: a disc reaches sqrt(y^2
/// + z^2) along x.
#[test]
fn right_to_the_last_bits() {
    for (x, y, z, length) in
        [(2.0, 3.0, 6.0, 7.0), (1.0, 4.0, 8.0, 9.0), (-2.0, 6.0, -9.0, 11.0), (3.0, -4.0, 0.0, 5.0)]
    {
        let end = Vector::new(x, y, z);
        let disc = Vector::new(y * y + z * z, z * z + x * x, x * x + y * y).map(Real::sqrt);
        let link =
            ModifiedCylinder::new(Vector::ZERO, end, length, [Cap::Flat, Cap::Round]).unwrap();
        let low =
            (-disc).min(end - Vector::select(end.cmple(Vector::ZERO), Vector::splat(length), disc));
        let high =
            disc.max(end + Vector::select(end.cmpge(Vector::ZERO), Vector::splat(length), disc));
        let aabb = link.local_aabb();
        let difference = (aabb.mins - low).abs().max((aabb.maxs - high).abs()).max_element();
        assert!(difference <= 4.0 * Real::EPSILON * length, "{difference}");
    }
}

/// A half ball shorter than its own radius does not reach back past the other end's disc.
#[test]
fn a_coin_with_one_round_side() {
    let link = ModifiedCylinder::new(Vector::ZERO, Vector::X * 0.25, 1.0, [Cap::Flat, Cap::Round])
        .unwrap();
    let aabb = link.local_aabb();
    assert_eq!((aabb.mins.x, aabb.maxs.x), (0.0, 1.25));
}

#[test]
fn capsules_as_parry_has_them() {
    let mut random = Random::new(2);
    for _ in 0..100 {
        let link = random_link(&mut random, [Cap::Round; 2]);
        let peer =
            parry_continuum::parry::shape::Capsule::new(link.start(), link.end(), link.radius())
                .local_aabb();
        let difference = (peer.mins - link.local_aabb().mins)
            .abs()
            .max((peer.maxs - link.local_aabb().maxs).abs());
        assert!(difference.max_element() <= 1e-14);
    }
}

#[test]
fn balls_and_wires() {
    let ball = ModifiedCylinder::capsule(Vector::Y, Vector::Y, 2.0).unwrap();
    assert_eq!(ball.local_aabb(), Aabb::new(Vector::Y - 2.0, Vector::Y + 2.0));
    for caps in CAPS {
        let wire = ModifiedCylinder::new(Vector::ONE, Vector::NEG_ONE, 0.0, caps).unwrap();
        assert_eq!(wire.local_aabb(), Aabb::new(Vector::NEG_ONE, Vector::ONE));
    }
}

#[test]
fn moved_by_a_pose() {
    let mut random = Random::new(3);
    for i in 0..100 {
        let link = random_link(&mut random, CAPS[i % 4]);
        let pose = Pose::new(random.point() * 5.0, random.point() * 3.0);
        let moved: Vec<_> = surface(&link, 400).iter().map(|&p| pose * p).collect();
        assert_holds(&link.aabb(&pose), &moved, 1e-13);
        assert_touches(
            &link.aabb(&pose),
            &moved,
            2.0 * 2.0 * (std::f64::consts::PI / 400.0).powi(2),
        );
    }
}

/// Rounding at the far place makes one point of the two ends.
#[test]
fn a_link_that_loses_its_length_is_still_held() {
    let link = ModifiedCylinder::cylinder(Vector::ZERO, Vector::X * 1e-9, 1.0).unwrap();
    let centre = Vector::splat(1e9);
    let far = Pose::from_translation(centre);
    assert_eq!(link.transformed(&far).start(), link.transformed(&far).end());
    assert_eq!(link.aabb(&far), Aabb::new(centre - 1.0, centre + 1.0));
}

#[test]
fn the_unit_does_not_matter() {
    let mut random = Random::new(4);
    for i in 0..100 {
        let link = random_link(&mut random, CAPS[i % 4]);
        for exponent in [-700, -300, 300, 480] {
            let scale = Real::powi(2.0, exponent);
            let scaled = ModifiedCylinder::new(
                link.start() * scale,
                link.end() * scale,
                link.radius() * scale,
                link.caps(),
            )
            .unwrap();
            let (plain, aabb) = (link.local_aabb(), scaled.local_aabb());
            assert_eq!(aabb, Aabb::new(plain.mins * scale, plain.maxs * scale));
            assert_eq!(scaled.length(), link.length() * scale);
            assert_eq!(scaled.axis(), link.axis());
        }
    }
}

#[test]
fn length_and_axis() {
    for scale in [1.0, 1e-300, 5e-320, 1e149] {
        let end = Vector::new(3.0, 0.0, 4.0) * scale;
        let link = ModifiedCylinder::capsule(Vector::ZERO, end, 0.0).unwrap();
        assert!(
            (link.length() / scale - 5.0).abs() < 1e-3_f64.min(1e-13 + 1e-320 / scale),
            "{scale}"
        );
        assert!(
            (link.axis() - Vector::new(0.6, 0.0, 0.8)).length()
                < 1e-3_f64.min(1e-15 + 1e-320 / scale)
        );
        assert!((link.axis().length() - 1.0).abs() < 1e-15);
    }
    let ball = ModifiedCylinder::capsule(Vector::ONE, Vector::ONE, 1.0).unwrap();
    assert_eq!((ball.length(), ball.axis()), (0.0, Vector::ZERO));
}

#[test]
fn a_chain_is_held_with_all_its_links() {
    let mut random = Random::new(5);
    for n in [2, 3, 4, 30] {
        let points: Vec<_> = (0..n).map(|_| random.point() * 10.0).collect();
        let radii: Vec<_> = (1..n).map(|_| random.between(0.1, 1.0)).collect();
        let chain = Chain::from_centreline(&points, &radii).unwrap();
        let union = chain
            .links()
            .iter()
            .map(ModifiedCylinder::local_aabb)
            .reduce(|a, b| Aabb::new(a.mins.min(b.mins), a.maxs.max(b.maxs)));
        assert_eq!(Some(chain.local_aabb()), union);
    }
}
