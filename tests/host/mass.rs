//! A link's mass properties are the sum over its slices, and equal parry's where parry has the
//! shape.

use crate::draw::{CAPS, Draw};
use continuum_testing::Random;
use parry_continuum::parry::mass_properties::MassProperties;
use parry_continuum::parry::math::{Matrix, Pose, Real, Rotation, Vector};
use parry_continuum::parry::shape::{Ball, Capsule, Cylinder, Shape};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
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

/// Mass, centre along the axis from the start, axial and transverse inertia about the centre, by
/// slices.
fn by_slices(
    length: Real,
    radius: Real,
    caps: [Cap; 2],
    density: Real,
) -> (Real, Real, Real, Real) {
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
fn assert_close(
    actual: &MassProperties,
    mass: Real,
    centre: Vector,
    inertia: Matrix,
    tolerance: Real,
) {
    let size = inertia.to_cols_array().into_iter().fold(0.0, |a: Real, b| a.max(b.abs()));
    let gap = (actual.reconstruct_inertia_matrix() - inertia).to_cols_array();
    assert!((actual.mass() - mass).abs() <= tolerance * mass, "mass {} for {mass}", actual.mass());
    assert!(
        (actual.local_com - centre).length() <= tolerance,
        "centre {} for {centre}",
        actual.local_com
    );
    assert!(
        gap.into_iter().all(|g| g.abs() <= tolerance * size),
        "inertia off by {gap:?} of {size}"
    );
}

#[test]
fn every_cap_combination_weighs_as_its_slices() {
    let mut random = Random::new(1);
    for _ in 0..50 {
        for caps in CAPS {
            let (length, radius) = (random.log_between(1e-2, 1e1), random.log_between(1e-2, 1e1));
            let (start, axis, density) =
                (random.vector(3.0), random.direction(), random.between(0.1, 9.0));
            let link = ModifiedCylinder::new(start, start + axis * length, radius, caps).unwrap();
            let (mass, centre, axial, transverse) = by_slices(length, radius, caps, density);
            let actual = link.mass_properties(density);
            assert_close(
                &actual,
                mass,
                start + axis * centre,
                tensor(axis, axial, transverse),
                1e-11,
            );
        }
    }
}

#[test]
fn capsules_cylinders_and_balls_weigh_as_parrys() {
    let mut random = Random::new(2);
    for _ in 0..200 {
        let (half, radius, pose) =
            (random.log_between(1e-2, 1e1), random.log_between(1e-2, 1e1), random.pose(5.0));
        let (start, end) =
            (pose * Vector::new(0.0, -half, 0.0), pose * Vector::new(0.0, half, 0.0));
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
            assert_close(
                &link.mass_properties(3.0),
                expected.mass(),
                expected.local_com,
                inertia,
                1e-12,
            );
        }
    }
}

/// The frame's y axis is the link's axis, also where a turn from y is nearly a half turn or nearly
/// none.
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
    let link =
        ModifiedCylinder::new(Vector::X, 3.0 * Vector::X, 0.0, [Cap::Flat, Cap::Round]).unwrap();
    let properties = link.mass_properties(7.0);
    assert_eq!(properties.mass(), 0.0);
    assert_eq!(properties.principal_inertia(), Vector::ZERO);
    assert_eq!(properties.local_com, 2.0 * Vector::X);
}

#[test]
fn no_size_gives_a_nan() {
    let sizes = [
        (1e150, 1e-300),
        (1e30, 1e150),
        (1e-300, 1e-180),
        (1e150, 1e150),
        (1e-300, 1e-300),
        (1e150, 0.0),
    ];
    for (length, radius) in sizes {
        for caps in CAPS {
            let link =
                ModifiedCylinder::new(Vector::ZERO, Vector::X * length, radius, caps).unwrap();
            for density in [0.0, 1.0] {
                let p = link.mass_properties(density);
                let numbers = [p.inv_mass, p.local_com.length(), p.inv_principal_inertia.length()];
                assert!(numbers.iter().all(|x| !x.is_nan()), "{caps:?} {length} {radius}: {p:?}");
            }
        }
    }
}

/// Chains whose tensors are of every kind: of a rod along an axis and anywhere, flat (two least
/// moments equal, or all but), with three different moments, and about as thick as long.
fn chains(random: &mut Random) -> Vec<(&'static str, Vec<Vector>, Real)> {
    let (turn, along) = (random.pose(1.0).rotation, random.direction());
    let plane = |angle: Real| turn * Vector::new(angle.cos(), angle.sin(), 0.0);
    let ring =
        |count: usize| (0..=count).map(|k| plane(2.0 * PI * k as Real / count as Real)).collect();
    let cross = |width: Real| {
        let ends = [Vector::X, -Vector::X, Vector::ZERO, Vector::Y, -Vector::Y];
        ends.map(|end| turn * (end * Vector::new(1.0, width, 1.0))).to_vec()
    };
    vec![
        ("along y", vec![-Vector::Y, Vector::Y, 1.5 * Vector::Y], 0.02),
        ("along x", vec![-Vector::X, Vector::ZERO, Vector::X], 0.02),
        ("anywhere", vec![-along, along * 0.2, along], 0.05),
        ("ring", ring(12), 0.1),
        ("square", ring(4), 0.01),
        ("cross", cross(1.0), 0.03),
        ("nearly square", cross(1.0 + 1e-7), 0.03),
        ("bent", (0..5).map(|_| random.vector(1.0)).collect(), 0.1),
        ("thick", (0..3).map(|k| along * (0.1 * k as Real)).collect(), 0.5),
    ]
}

/// In metres, micrometres and kilometres, near the origin and far from it, and as heavy as one
/// likes.
#[test]
fn a_chain_weighs_as_the_slices_of_its_links_in_every_unit() {
    let mut random = Random::new(4);
    for unit in [1.0, 0.1, 1e-3, 1e-6, 1e3] {
        for (_, points, radius) in chains(&mut random) {
            for far in [0.0, 10.0] {
                let shift = random.direction() * far;
                let points: Vec<_> = points.iter().map(|&point| (point + shift) * unit).collect();
                let radii = vec![radius * unit; points.len() - 1];
                let density = random.log_between(1e-3, 1e3) / unit.powi(3);
                let chain = if random.chance(0.5) {
                    Chain::capsules(&points, &radii)
                } else {
                    Chain::cylinders(&points, &radii)
                }
                .unwrap();
                let of_links: Vec<_> = chain
                    .links()
                    .iter()
                    .map(|link| {
                        let axis = (link.end() - link.start()) / link.length();
                        let (mass, centre, axial, transverse) = by_slices(
                            link.length() / unit,
                            radius,
                            link.caps(),
                            density * unit.powi(3),
                        );
                        let centre = link.start() / unit + axis * centre;
                        (mass, centre, tensor(axis, axial, transverse))
                    })
                    .collect();
                let mass: Real = of_links.iter().map(|link| link.0).sum();
                let centre = of_links.iter().map(|link| link.1 * (link.0 / mass)).sum::<Vector>();
                let mut inertia = Matrix::ZERO;
                for (mass, at, own) in of_links {
                    let d = at - centre;
                    let outer = Matrix::from_cols(d * d.x, d * d.y, d * d.z);
                    inertia += own
                        + (Matrix::from_diagonal(Vector::splat(d.length_squared())) - outer) * mass;
                }
                let found = chain.mass_properties(density);
                let found = MassProperties {
                    local_com: found.local_com / unit,
                    inv_principal_inertia: found.inv_principal_inertia * unit * unit,
                    ..found
                };
                assert_close(&found, mass, centre, inertia, 1e-11);
            }
        }
    }
}

/// Multiplied by 2^k, with the mass kept, moments are 4^k times as large and the frame is the same,
/// bit for bit.
#[test]
fn the_unit_of_length_turns_no_axes() {
    let mut random = Random::new(5);
    for (name, points, radius) in chains(&mut random) {
        let at = |k: i32| {
            let unit = 2.0_f64.powi(k);
            let points: Vec<_> = points.iter().map(|&point| point * unit).collect();
            let radii = vec![radius * unit; points.len() - 1];
            Chain::from_centreline(&points, &radii).unwrap().mass_properties(7.0 * 8.0_f64.powi(-k))
        };
        let one = at(0);
        for k in [-160, -20, -10, -1, 10, 160] {
            let (other, unit) = (at(k), 2.0_f64.powi(k));
            assert_eq!(other.inv_mass, one.inv_mass, "{name} {k}");
            assert_eq!(other.local_com, one.local_com * unit, "{name} {k}");
            let moments = other.inv_principal_inertia * unit * unit;
            assert_eq!(moments, one.inv_principal_inertia, "{name} {k}");
            assert_eq!(
                other.principal_inertia_local_frame, one.principal_inertia_local_frame,
                "{name} {k}"
            );
        }
    }
}

#[test]
fn a_chain_of_one_link_weighs_as_the_link() {
    let mut random = Random::new(6);
    for _ in 0..50 {
        let points = [random.vector(1.0), random.vector(1.0)];
        let chain = Chain::from_centreline(&points, &[random.between(0.1, 1.0)]).unwrap();
        assert_eq!(chain.mass_properties(3.0), chain.links()[0].mass_properties(3.0));
    }
}
