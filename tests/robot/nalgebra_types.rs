//! Poses and points come from nalgebra and go back, by the conversions of glamx and nalgebra.

use continuum_testing::Random;
use nalgebra::{Isometry3, Point3, Vector3};
use parry_continuum::parry::math::{Pose, Vector};

#[test]
fn a_pose_moves_points_as_an_isometry_does() {
    let mut random = Random::new(73);
    for _ in 0..1000 {
        let [shift, turn, point] = [5.0, 2.0, 10.0].map(|size| random.point() * size);
        let isometry = Isometry3::new(Vector3::from(shift), Vector3::from(turn));
        let pose = Pose::from(isometry);
        let moved = isometry * Point3::from(point);
        assert!(Vector::from(moved).distance(pose * point) < 1e-13, "{isometry} {point}");
        assert!(
            (Isometry3::from(pose) * Point3::from(point) - moved).norm() < 1e-13,
            "{isometry} {point}"
        );
        // nalgebra turns by scaled axes as parry does, and both count translations after rotations.
        assert!(
            (pose * point).distance(Pose::new(shift, turn) * point) < 1e-13,
            "{isometry} {point}"
        );
    }
}
