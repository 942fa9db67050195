//! A matrix becomes its pose, or an error that says why it is not rigid.

use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{MatrixError, pose_from_matrix};

type Matrix = [[Real; 4]; 4];

/// The matrix of a rotation about an axis by Rodrigues' formula, with a shift.
fn matrix(axis: Vector, angle: Real, shift: Vector) -> Matrix {
    let (axis, (sin, cos)) = (axis.normalize(), angle.sin_cos());
    let column = |e: Vector| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
    let [x, y, z] = [Vector::X, Vector::Y, Vector::Z].map(column);
    [
        [x.x, y.x, z.x, shift.x],
        [x.y, y.y, z.y, shift.y],
        [x.z, y.z, z.z, shift.z],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

/// The matrix times a point.
fn apply(m: &Matrix, p: Vector) -> Vector {
    Vector::from(
        [0, 1, 2].map(|row| m[row][0] * p.x + m[row][1] * p.y + m[row][2] * p.z + m[row][3]),
    )
}

#[test]
fn a_pose_does_what_its_matrix_does() {
    let point = Vector::new(100.0, -70.0, 30.0);
    let mut rounded = 0;
    for step in 0..200 {
        let t = Real::from(step);
        let axis = Vector::new((1.7 * t).sin(), (0.9 * t).cos(), (2.3 * t).sin() - 0.2);
        let whole = matrix(axis, 0.031 * t, Vector::new(1e3, t, -5.0));
        let pose = pose_from_matrix(whole).unwrap();
        assert!((pose * point - apply(&whole, point)).length() < 1e-11, "{step}");
        // Six digits after the point, as files have them: the rotation is one nevertheless.
        let file = whole.map(|row| row.map(|x| (x * 1e6).round() / 1e6));
        let pose = pose_from_matrix(file).unwrap();
        rounded += usize::from(file != whole);
        assert!((pose * point - apply(&whole, point)).length() < 1e-3, "{step}");
        let turned = [Vector::X, Vector::Y, Vector::Z].map(|e| pose.rotation * e);
        for (i, a) in turned.iter().enumerate() {
            for (j, b) in turned.iter().enumerate() {
                assert!((a.dot(*b) - if i == j { 1.0 } else { 0.0 }).abs() < 1e-14, "{step}");
            }
        }
    }
    assert!(rounded > 190, "{rounded}");
}

#[test]
fn what_is_all_but_a_rotation_becomes_one_as_near() {
    for step in 0..200 {
        let t = Real::from(step);
        let axis = Vector::new((1.1 * t).sin(), (2.9 * t).cos(), (0.7 * t).sin() + 0.3);
        // Sheared and stretched by almost as much as is allowed.
        let mut bad = matrix(axis, 0.047 * t, Vector::ZERO);
        for row in &mut bad[..3] {
            row[1] += 8e-6 * row[0];
            row[2] *= 1.0 + 4e-6;
        }
        let pose = pose_from_matrix(bad).unwrap();
        for e in [Vector::X, Vector::Y, Vector::Z] {
            let off = (pose.rotation * e - apply(&bad, e)).length();
            assert!(off < 1e-5, "{step}: {off}");
        }
    }
}

#[test]
fn what_is_no_pose_is_named() {
    let good = matrix(Vector::new(1.0, 2.0, 3.0), 0.7, Vector::new(1.0, 2.0, 3.0));
    let change = |row: usize, column: usize, value: Real| {
        let mut bad = good;
        bad[row][column] = value;
        pose_from_matrix(bad).unwrap_err()
    };
    assert!(matches!(change(1, 2, Real::NAN), MatrixError::NotFinite { row: 2, column: 3, .. }));
    assert!(matches!(
        change(0, 3, Real::INFINITY),
        MatrixError::NotFinite { row: 1, column: 4, .. }
    ));
    assert!(matches!(change(3, 0, 1.0), MatrixError::LastRow { .. }));
    assert!(matches!(change(0, 0, good[0][0] + 1e-4), MatrixError::NoRotation { .. }));
    assert!(matches!(change(0, 0, 1e200), MatrixError::NoRotation { .. }));
    let scaled = |by: Real| {
        let mut bad = good;
        bad[..3].iter_mut().flat_map(|row| &mut row[..3]).for_each(|x| *x *= by);
        pose_from_matrix(bad).unwrap_err()
    };
    let MatrixError::Scales { factor } = scaled(1000.0) else { panic!("{}", scaled(1000.0)) };
    assert!((factor - 1000.0).abs() < 1e-9, "{factor}");
    assert!(matches!(scaled(0.0), MatrixError::NoRotation { .. }));
    assert!(matches!(scaled(-1.0), MatrixError::Mirrors));
}
