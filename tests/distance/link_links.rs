//! Link against link and disc against disc: references of 30 digits, what must not change when a
//! problem is rewritten, and other ways to the same distance.

use continuum_testing::Random;
use continuum_testing::narrow_phase::{
    disc_disc, modified_cylinder_modified_cylinder, segment_disc, triangle_modified_cylinder,
};
use continuum_testing::precision::{Precision, extent, vector};
use continuum_testing::{LinkCase, link_cases};
use parry_continuum::distance::*;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::{ClosestPoints, QueryDispatcher};
use parry_continuum::parry::shape::{Capsule, Shape};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

const UNIT: f64 = f64::EPSILON / 2.0;

/// Two links: the ends of both axes, both radii, and which caps are flat.
#[derive(Clone, Copy, Debug)]
struct Links {
    axes: [[Vector; 2]; 2],
    radii: [f64; 2],
    flat: [[bool; 2]; 2],
}

impl From<&LinkCase> for Links {
    fn from(case: &LinkCase) -> Self {
        Self {
            axes: case.links.map(|ends| ends.map(Vector::from)),
            radii: case.radii,
            flat: case.flat,
        }
    }
}

impl Links {
    fn answer<T: Precision>(&self) -> Closest<T> {
        let [axis1, axis2] = self.axes.map(|ends| ends.map(T::vec3));
        let [radius1, radius2] = self.radii.map(T::from_f64);
        modified_cylinder_modified_cylinder(
            axis1,
            radius1,
            self.flat[0],
            axis2,
            radius2,
            self.flat[1],
        )
    }

    fn distance(&self) -> f64 {
        self.answer::<f64>().distance
    }

    fn swapped(&self) -> Self {
        let ([a, b], [r, s], [f, g]) = (self.axes, self.radii, self.flat);
        Self { axes: [b, a], radii: [s, r], flat: [g, f] }
    }

    /// With the ends of both axes the other way round.
    fn turned(&self) -> Self {
        let turn = |[from, to]: [Vector; 2]| [to, from];
        Self { axes: self.axes.map(turn), flat: self.flat.map(|[from, to]| [to, from]), ..*self }
    }

    fn moved(&self, pose: &Pose) -> Self {
        Self { axes: self.axes.map(|ends| ends.map(|end| pose * end)), ..*self }
    }

    fn scaled(&self, factor: f64) -> Self {
        Self {
            axes: self.axes.map(|ends| ends.map(|end| end * factor)),
            radii: self.radii.map(|radius| radius * factor),
            ..*self
        }
    }

    fn extent(&self) -> f64 {
        extent(&self.axes.concat(), self.radii[0].max(self.radii[1]))
    }

    /// How far a point is from one of the links.
    fn beyond(&self, link: usize, point: Vector) -> f64 {
        let [start, end] = self.axes[link].map(<f64 as Precision>::vec3);
        point_modified_cylinder(
            Precision::vec3(point),
            start,
            end,
            self.radii[link],
            self.flat[link],
        )
        .distance
    }
}

fn worst<T: Precision>(cases: &[LinkCase]) -> f64 {
    let mut worst = 0.0_f64;
    for case in cases {
        let links = Links::from(case);
        let closest = links.answer::<T>();
        let unit = T::UNIT * case.scale;
        let error = (closest.distance.into() - case.distance()).abs() / unit;
        assert!(
            error <= 16.0,
            "{} {}: {error} units, {closest:?} for {}",
            case.id,
            case.cat,
            case.d
        );
        let (point1, point2) = (vector(closest.point1), vector(closest.point2));
        let slack = 8.0 * T::UNIT * (case.mag + case.scale);
        let off = ((point1 - point2).length() - closest.distance.into()).abs();
        assert!(off <= slack, "{} {}: witnesses off by {off}", case.id, case.cat);
        for (link, point) in [(0, point1), (1, point2)] {
            let beyond = links.beyond(link, point);
            assert!(
                beyond <= slack,
                "{} {}: witness {link} is {beyond} outside",
                case.id,
                case.cat
            );
        }
        worst = worst.max(error);
    }
    worst
}

#[test]
fn every_reference_in_double_precision() {
    let cases = link_cases();
    assert_eq!(cases.len(), 2000);
    let touching = cases.iter().filter(|case| case.distance() == 0.0).count();
    assert!(touching > 300, "{touching}");
    println!("f64: {:.2} units of the extent", worst::<f64>(&cases));
}

#[test]
fn every_single_precision_reference_in_single_precision() {
    let cases: Vec<_> = link_cases().into_iter().filter(|case| case.f32).collect();
    assert!(cases.len() > 600, "{}", cases.len());
    println!("f32: {:.2} units of the extent", worst::<f32>(&cases));
}

#[test]
fn every_reference_through_parrys_dispatcher() {
    let dispatcher = ContinuumDispatcher::default();
    let (mut touching, mut parrys) = (0, 0);
    for case in link_cases() {
        let links = Links::from(&case);
        let made = |k: usize| {
            let caps = links.flat[k].map(|flat| if flat { Cap::Flat } else { Cap::Round });
            ModifiedCylinder::new(links.axes[k][0], links.axes[k][1], links.radii[k], caps).unwrap()
        };
        let (first, second) = (made(0), made(1));
        let mut check = |g1: &dyn Shape, g2: &dyn Shape| {
            let found = dispatcher.distance(&Pose::IDENTITY, g1, g2).unwrap().distance;
            let off = (found - case.distance()).abs() / (UNIT * case.scale);
            assert!(off <= 16.0, "{} {}: {off} units", case.id, case.cat);
            let slack = 8.0 * UNIT * (case.mag + case.scale);
            match dispatcher.closest_points(&Pose::IDENTITY, g1, g2, f64::MAX).unwrap() {
                ClosestPoints::WithinMargin(p1, p2) => {
                    assert!(((p1 - p2).length() - found).abs() <= slack, "{}", case.id);
                }
                ClosestPoints::Intersecting => touching += 1,
                ClosestPoints::Disjoint => panic!("{} is nowhere", case.id),
            }
        };
        check(&first, &second);
        check(&second, &first);
        // A capsule of parry's is a link; one of no thickness is a line to the dispatcher.
        if links.flat[1] == [false; 2] && links.radii[1] > 1e-9 * case.scale {
            let capsule = Capsule::new(second.start(), second.end(), second.radius());
            check(&first, &capsule);
            check(&capsule, &first);
            parrys += 1;
        }
    }
    assert!(touching > 600 && parrys > 200, "{touching} {parrys}");
}

/// Moved together by a little more than they are apart, links overlap: then the distance is 0, but
/// for what rounding says of faces that lie in one plane.
#[test]
fn links_that_overlap_meet() {
    let (mut overlapping, mut missed) = (0, 0);
    for case in link_cases().iter().filter(|case| case.cat != "wires") {
        let mut links = Links::from(case);
        let closest = links.answer::<f64>();
        if closest.distance < 1e-4 * case.scale {
            continue;
        }
        let way = (vector(closest.point1) - vector(closest.point2)) / closest.distance;
        for share in [1e-4, 1e-7, 1e-10] {
            let deep = share * (links.radii[0] + links.radii[1]);
            let moved = Links::from(case).axes[1].map(|end| end + way * (closest.distance + deep));
            links.axes[1] = moved;
            let distance = links.distance();
            assert!(distance <= 4.0 * UNIT * case.scale, "{} {}: {distance}", case.id, case.cat);
            overlapping += 1;
            missed += usize::from(distance > 0.0);
        }
    }
    assert!(overlapping > 2000 && missed < 20, "{overlapping} {missed}");
}

/// Half of what a scene is made of: aligned axes, touching caps, small integers.
fn drawn(random: &mut Random, round: u32) -> Links {
    let mut point = |lattice: bool| {
        let point = random.point() * 2.0;
        if lattice { (point * 2.0).round() / 2.0 } else { point }
    };
    let lattice = round.is_multiple_of(2);
    let axes = [[point(lattice), point(lattice)], [point(lattice), point(lattice)]];
    let mut radius = || [0.0, 0.5, 1.0, random.magnitude(-2.0, 0.3)][random.below(4) as usize];
    let radii = [radius(), radius()];
    let bits = random.below(16);
    let flat = [[bits & 1 != 0, bits & 2 != 0], [bits & 4 != 0, bits & 8 != 0]];
    Links { axes, radii, flat }
}

#[test]
fn order_and_direction_change_nothing() {
    let mut random = Random::new(1);
    let drawn = (0..4000).map(|round| drawn(&mut random, round));
    for links in drawn.chain(link_cases().iter().map(Links::from)) {
        let expected = links.distance();
        for other in [links.swapped(), links.turned(), links.swapped().turned()] {
            let off = (other.distance() - expected).abs() / (UNIT * links.extent());
            assert!(off <= 16.0, "{off} units: {links:?}");
        }
    }
}

/// A rotation rounds the ends; so it turns the flat caps of a short link by u extent / length.
#[test]
fn a_rigid_motion_changes_no_distance() {
    let mut random = Random::new(2);
    for round in 0..4000 {
        let links = drawn(&mut random, round);
        let pose = random.pose(1.0);
        let turned = links.axes.iter().zip(links.radii).map(|([from, to], radius)| {
            let length = (to - from).length();
            if length > 0.0 { radius / length } else { 0.0 }
        });
        let unit = UNIT * (links.extent() + 4.0) * (1.0 + turned.fold(0.0, f64::max));
        let off = (links.moved(&pose).distance() - links.distance()).abs() / unit;
        assert!(off <= 16.0, "{off} units: {links:?}");
    }
}

#[test]
fn a_scaled_pair_has_the_scaled_distance_bit_for_bit() {
    let mut random = Random::new(3);
    for round in 0..2000 {
        let links = drawn(&mut random, round);
        for power in [-40, -1, 1, 40] {
            let factor = 2.0_f64.powi(power);
            let (plain, scaled) = (links.answer::<f64>(), links.scaled(factor).answer::<f64>());
            assert_eq!(scaled.distance, plain.distance * factor, "{links:?}");
            assert_eq!(scaled.point1, plain.point1 * factor, "{links:?}");
            assert_eq!(scaled.point2, plain.point2 * factor, "{links:?}");
        }
    }
}

/// A link whose radius is 0 is a segment, which a triangle without a height is too.
#[test]
fn a_wire_is_as_far_as_a_flat_triangle() {
    let mut random = Random::new(4);
    for round in 0..4000 {
        let mut links = drawn(&mut random, round);
        links.radii[1] = 0.0;
        let [[start, end], [from, to]] = links.axes.map(|ends| ends.map(<f64 as Precision>::vec3));
        let expected =
            triangle_modified_cylinder([from, to, to], start, end, links.radii[0], links.flat[0])
                .distance;
        let off = (links.distance() - expected).abs() / (UNIT * links.extent());
        assert!(off <= 16.0, "{off} units: {links:?}");
    }
}

/// Points of one disc: no point is nearer to the other disc than the discs' distance, and some
/// points are nearly that near.
#[test]
fn discs_are_as_far_as_their_nearest_chords() {
    let mut random = Random::new(5);
    let (mut crossing, mut apart) = (0, 0);
    for round in 0..600 {
        let normal = [Vector::Z, random.direction()][round % 2];
        let (tilt, way) = (random.tiny(-8.0, 0.3), random.direction());
        let other = [random.direction(), normal, (normal + way * tilt).normalize()][round % 3];
        let radii = [random.magnitude(-1.0, 0.3), random.magnitude(-1.0, 0.3)];
        let centre = random.point() * [0.3, 1.0, 2.0][round / 3 % 3];
        let [n1, n2] = [normal, other].map(<f64 as Precision>::vec3);
        let (zero, to) = (Vec3::new(0.0, 0.0, 0.0), <f64 as Precision>::vec3(centre));
        let found = disc_disc(zero, n1, radii[0], to, n2, radii[1]).distance;
        let (across, along) = normal.any_orthonormal_pair();
        let chords = 400;
        let mut least = f64::INFINITY;
        for k in 0..=chords {
            let (sin, cos) =
                (std::f64::consts::PI * (f64::from(k) / f64::from(chords) - 0.5)).sin_cos();
            let ends = [1.0, -1.0].map(|side| (across * sin + along * (cos * side)) * radii[0]);
            let ends = ends.map(<f64 as Precision>::vec3);
            least = least.min(segment_disc(ends, to, n2, radii[1]).distance);
        }
        let extent = centre.abs().max_element().max(radii[0]).max(radii[1]);
        assert!(found <= least + 16.0 * UNIT * extent, "{found} of {least} in round {round}");
        // A chord is at most half a step from the nearest point's.
        let step = std::f64::consts::PI / f64::from(chords) * radii[0];
        assert!(least <= found + 0.6 * step, "{found} of {least} in round {round}");
        if found == 0.0 { crossing += 1 } else { apart += 1 }
    }
    assert!(crossing > 30 && apart > 200, "{crossing} {apart}");
}

/// Where a disc's centre is not off to one side of the other's, a number that only weighs a sign
/// vanishes.
#[test]
fn aligned_discs_and_links_are_as_far_as_they_are() {
    let discs = |[normal1, normal2]: [Vector; 2], radii: [f64; 2], centre: Vector| {
        let [zero, to, n1, n2] =
            [Vector::ZERO, centre, normal1, normal2].map(<f64 as Precision>::vec3);
        [
            disc_disc(zero, n1, radii[0], to, n2, radii[1]),
            disc_disc(to, n2, radii[1], zero, n1, radii[0]),
        ]
        .map(|closest| closest.distance)
    };
    assert_eq!(discs([Vector::Z, Vector::X], [2.0, 2.0], Vector::new(2.0, 1.5, 0.0)), [0.0; 2]);
    assert_eq!(discs([Vector::Z, Vector::X], [2.0, 2.0], Vector::new(4.0, 1.5, 0.0)), [2.0; 2]);
    // Found by alternating projections.
    for (a, f, radius, expected) in [
        (0.75, 1.75, 1.5, 0.0),
        (1.0, 1.75, 2.0, 0.0178),
        (1.0, 1.75, 1.5, 0.1485),
        (1.5, 1.75, 2.0, 0.7199),
    ] {
        let first = [Vector::Z * -4.0, Vector::ZERO];
        let second = [Vector::new(a, f, a), Vector::new(a + 4.0, f, a + 4.0)];
        let links = Links { axes: [first, second], radii: [2.0, radius], flat: [[true; 2]; 2] };
        for links in [links, links.swapped(), links.turned()] {
            assert!((links.distance() - expected).abs() < 1e-4, "{links:?}: {}", links.distance());
        }
    }
    let mut random = Random::new(6);
    let axes =
        [Vector::X, Vector::Y, Vector::Z, Vector::new(1.0, 0.0, 1.0), Vector::new(0.0, 1.0, -1.0)];
    let mut tilted = 0;
    for _ in 0..12_000 {
        let normals = [0; 2].map(|_| axes[random.below(5) as usize]);
        let radii = [0; 2].map(|_| 0.5 * f64::from(1 + random.below(4)));
        let centre = (random.point() * 6.0).round() / 2.0;
        let [one, other] = discs(normals, radii, centre);
        let extent = centre.abs().max_element().max(radii[0]).max(radii[1]);
        assert!(
            (one - other).abs() <= 32.0 * UNIT * extent,
            "{one} {other}: {normals:?} {radii:?} {centre}"
        );
        tilted += u32::from(normals[0].cross(normals[1]) != Vector::ZERO && one > 0.0);
    }
    assert!(tilted > 4000, "{tilted}");
}
