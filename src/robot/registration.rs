//! Converts the 4x4 matrix of a registration or of a kinematic model to a pose, with checks.
//!
//! # Rigid poses
//! Poses that keep lengths, and rotations that are equal on every machine. A rotation by the
//! quaternion q multiplies lengths by `|q|^2`, so it is rigid only if `|q| = 1`.
//!
//! **Rounding.** A unit quaternion rounded to single precision is off unit length by at most 2^-24.
//! A product of a few such quaternions is off by a small multiple. So a deviation up to 2^-20
//! counts as rounding and q is normalised. A larger deviation has no clear meaning and is refused.
//! Chains, tubes and motions all use this rule.

use super::error::number;
use super::scale::length;
use crate::distance::Scalar;
use parry3d_f64::math::{Mat3, Pose, Real, Rot3, Rotation, Vector};
use strum::IntoStaticStr;
use thiserror::Error;

/// Largest accepted deviation of an entry of R^T R from the identity. It accepts matrices written
/// with six decimals. A rotation that is off by 1e-5 moves a point at 100 mm by 0.001 mm.
const ROUNDED: Real = 1e-5;

/// Why a 4x4 matrix is not a pose. Each message says what to change.
#[derive(Clone, Copy, Debug, Error, IntoStaticStr, PartialEq)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum MatrixError {
    /// An entry is NaN or infinite.
    #[error(
        "row {row}, column {column} of the matrix is {value}; give finite numbers (rows and columns count from 1)",
        value = number(.value)
    )]
    NotFinite {
        /// Row, counted from 1.
        row: usize,
        /// Column, counted from 1.
        column: usize,
        /// The entry.
        value: Real,
    },
    /// The last row is not 0 0 0 1.
    #[error("the last row of the matrix is {} {} {} {}, not 0 0 0 1; transpose it if the shift is there",
            number(&row[0]), number(&row[1]), number(&row[2]), number(&row[3]))]
    LastRow {
        /// The last row.
        row: [Real; 4],
    },
    /// All axes are scaled alike.
    #[error(
        "the matrix scales by {factor}; scale the mesh or the robot instead, and give a rotation and a shift alone",
        factor = number(.factor)
    )]
    Scales {
        /// The factor.
        factor: Real,
    },
    /// The axes are not perpendicular unit vectors.
    #[error(
        "the matrix does not rotate: its axes are off unit length and right angles by {deviation:?}; \
         give a rigid registration, with six digits after the point"
    )]
    NoRotation {
        /// The largest deviation of R^T R from the identity.
        deviation: Real,
    },
    /// The axes are left-handed.
    #[error(
        "the matrix mirrors; bring both frames to the same handedness, for example both to RAS or both to LPS"
    )]
    Mirrors,
}

impl MatrixError {
    /// Returns the variant's name in snake case, the same in Rust and Python.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

/// Returns the pose of a 4x4 matrix: a rotation and a translation (last column).
///
/// `rows` is in row-major order; the translation is in the caller's unit. Entries rounded to six
/// decimals are accepted: the result is the nearby rotation.
///
/// # Errors
/// An entry is not finite, the last row is not 0 0 0 1, or the 3x3 part scales, shears or mirrors.
///
/// ```
/// use parry_continuum::{parry::math::Vector, pose_from_matrix};
/// let pose = pose_from_matrix([
///     [0.0, -1.0, 0.0, 10.0], // a quarter turn about z, and a shift
///     [1.0, 0.0, 0.0, 20.0],
///     [0.0, 0.0, 1.0, 30.0],
///     [0.0, 0.0, 0.0, 1.0],
/// ])?;
/// assert!((pose * Vector::X - Vector::new(10.0, 21.0, 30.0)).length() < 1e-14);
/// # Ok::<(), parry_continuum::MatrixError>(())
/// ```
pub fn pose_from_matrix(rows: [[Real; 4]; 4]) -> Result<Pose, MatrixError> {
    for (row, entries) in rows.iter().enumerate() {
        for (column, &value) in entries.iter().enumerate() {
            if !value.is_finite() {
                return Err(MatrixError::NotFinite { row: row + 1, column: column + 1, value });
            }
        }
    }
    if rows[3] != [0.0, 0.0, 0.0, 1.0] {
        return Err(MatrixError::LastRow { row: rows[3] });
    }
    let axis = |column: usize| Vector::new(rows[0][column], rows[1][column], rows[2][column]);
    let [x, y, z] = [axis(0), axis(1), axis(2)];
    let squares = Vector::new(x.length_squared(), y.length_squared(), z.length_squared());
    let skew = Vector::new(x.dot(y), y.dot(z), z.dot(x)).abs().max_element();
    let off = (squares - Vector::ONE).abs().max_element();
    if off.max(skew) > ROUNDED {
        let mean = squares.element_sum() / 3.0;
        let is_even = mean > 0.0
            && (squares - Vector::splat(mean)).abs().max_element().max(skew) <= ROUNDED * mean;
        return Err(if is_even && mean.is_finite() {
            MatrixError::Scales { factor: mean.sqrt() }
        } else {
            MatrixError::NoRotation { deviation: off.max(skew) }
        });
    }
    if x.cross(y).dot(z) < 0.0 {
        return Err(MatrixError::Mirrors);
    }
    Ok(Pose::from_parts(axis(3), Rot3::from_mat3(&Mat3::from_cols(x, y, z)).normalize()))
}

/// Largest deviation of `|q|` from 1 that counts as rounding of single precision: 2^-20.
const MAX_OFF: Real = Real::from_bits((1023 - 20) << 52);

/// The error for a quaternion whose length is not 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NotRigid {
    pub length: Real,
}

/// Returns the pose with a unit quaternion. A pose that is rigid up to the rounding of a few
/// operations is returned unchanged.
///
/// # Errors
/// The quaternion's length differs from 1 by more than 2^-20, or is NaN.
#[inline]
pub(crate) fn rigid(pose: &Pose) -> Result<Pose, NotRigid> {
    // If the square overflows or underflows, the length is not near 1 either.
    let off = (pose.rotation.length_squared() - 1.0).abs();
    if off <= 8.0 * Real::UNIT_ROUNDOFF {
        return Ok(*pose);
    }
    // (1 + x)^2 = 1 + 2 x + x^2. Written so that NaN is refused.
    if off <= 2.0 * MAX_OFF {
        return Ok(Pose::from_parts(pose.translation, pose.rotation.normalize()));
    }
    Err(NotRigid { length: quaternion_length(pose.rotation) })
}

/// The length of a quaternion, without overflow or underflow.
fn quaternion_length(q: Rotation) -> Real {
    let across = length(Vector::new(q.x, q.y, q.z));
    length(Vector::new(across, q.w, 0.0))
}

/// Returns the rotation by a rotation vector: about its direction, by its length in rad.
///
/// `libm` makes the result bit-identical on every machine; the standard library's sine does not.
pub(crate) fn rotation_by(turn: Vector) -> Rotation {
    let half = 0.5 * length(turn);
    // `sin(half) / |turn|`; its limit is 1/2 at 0.
    let share = if half > 0.0 { 0.5 * (libm::sin(half) / half) } else { 0.5 };
    let axis = turn * share;
    Rotation::from_xyzw(axis.x, axis.y, axis.z, libm::cos(half))
}
