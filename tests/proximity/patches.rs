//! Patches of wall nearly straight below a link.

use crate::agreement::engines;
use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;

/// A disc of 16 triangles around its centre, and the radius to its first corner.
fn disc(centre: Vector, first: Vector, second: Vector) -> impl Iterator<Item = [Vector; 3]> {
    let corner = move |k: u32| {
        let angle = f64::from(k % 16) * std::f64::consts::TAU / 16.0;
        centre + first * angle.cos() + second * angle.sin()
    };
    (0..16).map(move |k| [centre, corner(k), corner(k + 1)])
}

/// Two discs on either side of a wire. One is level. The other is a little farther away, but
/// tilted, so that its rim comes nearer: by an angle whose cosine rounds to one in single
/// precision.
#[test]
fn a_slight_tilt_brings_a_rim_nearer() {
    let mut random = Random::new(23);
    let mut slight = 0;
    for _ in 0..2000 {
        let along = random.direction();
        let up = along.cross(random.direction()).normalize();
        let aside = along.cross(up);
        let tilt = 10.0_f64.powf(random.between(-4.7, -2.7));
        let radius = random.between(0.2, 0.8);
        let tilted = along * tilt.cos() - up * tilt.sin();
        let nearest = 1.0 - radius * tilt.sin();
        let level = 1.0 - 0.5 * radius * tilt.sin();
        // The search begins at triangle 0, which is of the level one.
        let level = disc(-up * level, along * radius, aside * radius);
        let triangles = level.chain(disc(up, tilted * radius, aside * radius));
        let vertices: Vec<_> = triangles.flatten().collect();
        let indices = (0..32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = TriMesh::new(vertices, indices).unwrap();
        let robot = Chain::capsules(&[-along, along], &[0.0]).unwrap();
        for (name, mut engine) in engines(&mesh) {
            let found = engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance;
            assert!(
                (found - nearest).abs() < 1e-14,
                "{name}: {found} for {nearest}, tilted by {tilt:e}"
            );
        }
        slight += usize::from(tilt.cos() as f32 == 1.0);
    }
    assert!(slight > 500 && slight < 1500, "{slight}");
}
