//! Seeded walls, robots and poses, made without the sines of the system.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Rotation, Vector};

/// A closed wall of 2 n^2 triangles around the offset, uneven.
pub fn wall(random: &mut Random, n: u32, offset: f64) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let vertices = (0..(n + 1) * (n + 1))
        .map(|k| {
            let [i, j] =
                [k / (n + 1), k % (n + 1)].map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0);
            let height = 2.0 + i * i - j * j + 0.05 * random.unit();
            Vector::new(5.0 * i + offset, 5.0 * j, height)
        })
        .collect();
    let cell = |k: u32| {
        let a = (n + 1) * (k / n) + k % n;
        [[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]]
    };
    (vertices, (0..n * n).flat_map(cell).collect())
}

pub fn pose(random: &mut Random, offset: f64) -> Pose {
    let [a, b] = [random.point(), random.point()];
    let rotation = Rotation::from_xyzw(a.x, a.y, a.z, b.x).normalize();
    Pose::from_parts(random.point() + Vector::X * offset, rotation)
}

/// The pose moved and turned a little, as in a control loop.
pub fn nudged(random: &mut Random, pose: &Pose) -> Pose {
    let [step, turn] = [random.point(), random.point()];
    let turn = Rotation::from_xyzw(0.01 * turn.x, 0.01 * turn.y, 0.01 * turn.z, 1.0);
    Pose::from_parts(pose.translation + 0.02 * step, (pose.rotation * turn).normalize())
}

/// Thirteen points 0.3 apart along a gentle bend.
pub fn centreline(random: &mut Random) -> Vec<Vector> {
    let mut points = vec![random.point()];
    let mut direction = random.direction();
    for _ in 0..12 {
        direction = (direction + 0.2 * random.point()).normalize();
        points.push(points[points.len() - 1] + direction * 0.3);
    }
    points
}

/// Thirteen points along two arms and the half circle that joins them: a robot that comes near
/// itself.
pub fn hairpin(random: &mut Random) -> Vec<Vector> {
    /// Cosines and sines in steps of pi / 8.
    #[expect(
        clippy::approx_constant,
        reason = "points near a circle, with the same bits everywhere"
    )]
    const QUARTER: [[f64; 2]; 4] =
        [[1.0, 0.0], [0.92388, 0.38268], [0.70711, 0.70711], [0.38268, 0.92388]];
    let [radius, rise] = [0.3 + 0.1 * random.unit(), 0.05 * random.unit()];
    let left = QUARTER.map(|[x, y]| [-x, y]);
    let right = QUARTER.map(|[x, y]| [y, x]);
    let arms = [[-0.9, -0.76], [-0.98, -0.39]].into_iter().chain(left).chain(right);
    arms.chain([[1.0, 0.0], [0.98, -0.39], [0.9, -0.76]])
        .enumerate()
        .map(|(k, [x, y])| Vector::new(radius * x, radius * y, rise * k as f64))
        .collect()
}

/// Twelve radii that fall in steps, some of them equal.
pub fn radii(random: &mut Random) -> [f64; 12] {
    let mut radius = 0.05 + 0.1 * random.unit();
    [(); 12].map(|()| {
        if random.unit() < 0.3 {
            radius *= 0.9;
        }
        radius
    })
}
