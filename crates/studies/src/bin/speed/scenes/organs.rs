//! The structures of a scene.

use parry_continuum::parry::math::Vector;
use parry_continuum::parry::shape::Ball;
use std::f64::consts::TAU;

/// The distance that a robot keeps from each, mm.
pub(super) const MARGIN: f64 = 1.0;

pub(super) type Surface = (Vec<Vector>, Vec<[u32; 3]>);

/// One of five organs around the robot at four heights: an uneven egg.
pub(super) fn organ(number: u32) -> Surface {
    let (vertices, triangles) = Ball::new(1.0).to_trimesh(33, 32);
    let (around, height) =
        (f64::from(number % 5) + 0.3 * f64::from(number / 5), f64::from(number / 5));
    let (sin, cos) = (TAU * around / 5.0).sin_cos();
    let centre = Vector::new(15.0 * cos, 15.0 * sin, 8.0 + 15.0 * height);
    let uneven =
        |v: Vector| v * (1.0 + 0.1 * (5.0 * v.x + f64::from(number)).sin() * (4.0 * v.z).cos());
    let place = |v: &Vector| centre + uneven(*v) * Vector::new(8.0, 7.0, 9.0);
    (vertices.iter().map(place).collect(), triangles)
}

/// All organs as one surface.
pub(super) fn merged(organs: &[Surface]) -> Surface {
    let (mut all, mut corners) = (Vec::new(), Vec::new());
    for (vertices, triangles) in organs {
        let before = all.len() as u32;
        all.extend(vertices);
        corners.extend(triangles.iter().map(|triangle| triangle.map(|corner| corner + before)));
    }
    (all, corners)
}
