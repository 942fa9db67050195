//! A link's mass properties are those of its slices added up, and parry's where parry has the shape.

use crate::draw::{CAPS, Draw};
use continuum_testing::Random;
use parry_continuum::parry::mass_properties::MassProperties;
use parry_continuum::parry::math::{Matrix, Pose, Real, Rotation, Vector};
use parry_continuum::parry::shape::{Ball, Capsule, Cylinder, Shape};
use parry_continuum::{Cap, ModifiedCylinder};
use std::f64::consts::PI;

/// The integral of `f` by Simpson's rule.
fn integral(low: Real, high: Real, f: impl Fn(Real) -> Real) -> Real {
    let panels = 2000;
    let h = (high - low) / panels as Real;
    let weight = |i| match i {
        0 => 1.0,
        i if i == panels => 1.0,
        i if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=panels).map(|i| weight(i) * f(low + h * i as Real)).sum::<Real>() * h / 3.0
}

/// Mass, centre along the axis from the start, axial and transverse inertia about the centre, by slices.
fn by_slices(length: Real, radius: Real, caps: [Cap; 2], density: Real) -> (Real, Real, Real, Real) {
    let low = if caps[0] == Cap::Round { -radius } else { 0.0 };
    let high = length + if caps[1] == Cap::Round { radius } else { 0.0 };
    let squared = |z: Real| {
        let past = (-z).max(z - length).max(0.0);
        (radius * radius - past * past).max(0.0)
    };
    let over = |f: &dyn Fn(Real) -> Real| {
        integral(low, 0.0, f) + integral(0.0, length, f) + integral(length, high, f)
    };
    let mass = over(&|z| density * PI * squared(z));
    let centre = over(&|z| density * PI * squared(z) * z) / mass;
    let axial = over(&|z| density * PI * squared(z) * squared(z) / 2.0);
    let disc = |z: Real| squared(z) * (squared(z) / 4.0 + (z - centre) * (z - centre));
    (mass, centre, axial, over(&|z| density * PI * disc(z)))
}

/// The inertia tensor of a body of revolution around `axis`.
fn tensor(axis: Vector, axial: Real, transverse: Real) -> Matrix {
    let outer = Matrix::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    Matrix::from_diagonal(Vector::splat(transverse)) + outer * (axial - transverse)
}

#[track_caller]
fn assert_close(actual: &MassProperties, mass: Real, centre: Vector, inertia: Matrix, tolerance: Real) {
    let size = inertia.to_cols_array().into_iter().fold(0.0, |a: Real, b| a.max(b.abs()));
    let gap = (actual.reconstruct_inertia_matrix() - inertia).to_cols_array();
    assert!((actual.mass() - mass).abs() <= tolerance * mass, "mass {} for {mass}", actual.mass());
    assert!((actual.local_com - centre).length() <= tolerance, "centre {} for {centre}", actual.local_com);
    assert!(gap.into_iter().all(|g| g.abs() <= tolerance * size), "inertia off by {gap:?} of {size}");
}

#[test]
fn every_cap_combination_weighs_as_its_slices() {
    let mut random = Random::new(1);
    for _ in 0..50 {
        for caps in CAPS {
            let (length, radius) = (random.log_between(1e-2, 1e1), random.log_between(1e-2, 1e1));
            let (start, axis, density) = (random.vector(3.0), random.direction(), random.between(0.1, 9.0));
            let link = ModifiedCylinder::new(start, start + axis * length, radius, caps).unwrap();
            let (mass, centre, axial, transverse) = by_slices(length, radius, caps, density);
            let actual = link.mass_properties(density);
            assert_close(&actual, mass, start + axis * centre, tensor(axis, axial, transverse), 1e-11);
        }
    }
}

#[test]
fn capsules_cylinders_and_balls_weigh_as_parrys() {
    let mut random = Random::new(2);
    for _ in 0..200 {
        let (half, radius, pose) =
            (random.log_between(1e-2, 1e1), random.log_between(1e-2, 1e1), random.pose(5.0));
        let (start, end) = (pose * Vector::new(0.0, -half, 0.0), pose * Vector::new(0.0, half, 0.0));
        let pairs: [(ModifiedCylinder, MassProperties); 3] = [
            (
                ModifiedCylinder::cylinder(start, end, radius).unwrap(),
                Cylinder::new(half, radius).mass_properties(3.0).transform_by(&pose),
            ),
            (
                ModifiedCylinder::capsule(start, end, radius).unwrap(),
                Capsule::new(start, end, radius).mass_properties(3.0),
            ),
            (
                ModifiedCylinder::capsule(start, start, radius).unwrap(),
                Ball::new(radius)
                    .mass_properties(3.0)
                    .transform_by(&Pose::from_parts(start, Rotation::IDENTITY)),
            ),
        ];
        for (link, expected) in pairs {
            let inertia = expected.reconstruct_inertia_matrix();
            assert_close(&link.mass_properties(3.0), expected.mass(), expected.local_com, inertia, 1e-12);
        }
    }
}

/// The frame's y axis is the link's axis, also where a turn from y is nearly a half turn or nearly none.
#[test]
fn the_principal_frame_follows_the_axis() {
    let mut random = Random::new(3);
    for tilt in [0.0, 1e-12, 1e-8, 1e-4, 0.5] {
        for up in [Vector::Y, -Vector::Y, Vector::X] {
            let axis = (up + random.direction() * tilt).normalize();
            let link = ModifiedCylinder::cylinder(Vector::ZERO, axis, 0.25).unwrap();
            let y = link.mass_properties(1.0).principal_inertia_local_frame * Vector::Y;
            assert!(y.cross(axis).length() < 1e-15, "tilt {tilt} from {up}: {y} for {axis}");
        }
    }
}

#[test]
fn a_wire_has_no_mass_and_stays_where_it_is() {
    let link = ModifiedCylinder::new(Vector::X, 3.0 * Vector::X, 0.0, [Cap::Flat, Cap::Round]).unwrap();
    let properties = link.mass_properties(7.0);
    assert_eq!(properties.mass(), 0.0);
    assert_eq!(properties.principal_inertia(), Vector::ZERO);
    assert_eq!(properties.local_com, 2.0 * Vector::X);
}

#[test]
fn no_size_gives_a_nan() {
    let sizes =
        [(1e150, 1e-300), (1e30, 1e150), (1e-300, 1e-180), (1e150, 1e150), (1e-300, 1e-300), (1e150, 0.0)];
    for (length, radius) in sizes {
        for caps in CAPS {
            let link = ModifiedCylinder::new(Vector::ZERO, Vector::X * length, radius, caps).unwrap();
            for density in [0.0, 1.0] {
                let p = link.mass_properties(density);
                let numbers = [p.inv_mass, p.local_com.length(), p.inv_principal_inertia.length()];
                assert!(numbers.iter().all(|x| !x.is_nan()), "{caps:?} {length} {radius}: {p:?}");
            }
        }
    }
}
