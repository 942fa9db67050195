//! Exact mass properties of a link and of several links.
//!
//! # One link
//! A link of radius `r` and length `l` is a cylinder and, at each round end, half a ball. The unit
//! of mass is chosen so that a volume of `pi r^2` per length weighs 1 per length. Relative to the
//! middle of the axis:
//!
//! | piece | mass | centre on the axis | axial `k^2` | transverse `k^2` about its own centre |
//! |---|---|---|---|---|
//! | cylinder | `l` | 0 | `r^2 / 2` | `r^2 / 4 + l^2 / 12` |
//! | half ball | `2 r / 3` | `+-(l / 2 + 3 r / 8)` | `2 r^2 / 5` | `2 r^2 / 5 - (3 r / 8)^2 = 83 r^2 / 320` |
//!
//! `k` is the radius of gyration. For the half ball: its second moment about any line through the
//! ball's centre is half of the ball's. The parallel axis theorem moves it to its own centre of
//! mass, `3 r / 8` outwards. The whole link is the sum of masses, moments and, again by the
//! parallel axis theorem, second moments. Every term is positive, so nothing cancels. The centre of
//! mass leaves the middle only if one end is round and the other flat.
//!
//! The link is a body of revolution, so every frame with one axis along it is principal. As for
//! parry's cylinder and capsule, this is the frame's y axis. Reversing the axis leaves the inertia
//! unchanged, so the smaller of the two rotations is used.
//!
//! # Several links
//! Masses and inertia tensors add up. The tensor of a link about the common centre of mass is
//!
//! ```text
//! t (1 - a a^T) + s a a^T + m (d^2 1 - d d^T)
//! ```
//!
//! with its axial and transverse moments `s` and `t`, axis `a`, mass `m`, and `d` from the common
//! centre to its own. Jacobi's rotations give the principal axes. They use ratios of entries only,
//! so masses and lengths scaled by powers of two give the same frame bit for bit. (parry's
//! `MassProperties::with_inertia_matrix` stops at absolute tolerances. It exchanges the axes of
//! small bodies, and of bodies whose two least moments are equal.)

use super::axial::axis_or_x;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Matrix, Real, Rotation, Vector};
use std::f64::consts::PI;

/// A row of the table: mass, centre along the axis from its middle, squared radii of gyration.
struct MassOfPiece {
    mass: Real,
    centre: Real,
    axial: Real,
    transverse: Real,
}

/// Returns the mass properties at uniform `density`. A wire (radius 0) has no mass.
pub(super) fn mass_properties(link: &ModifiedCylinder, density: Real) -> MassProperties {
    let LinkMass { mass, centre, axis, axial, transverse } = LinkMass::of(link, density);
    MassProperties::with_principal_inertia_frame(
        centre,
        mass,
        Vector::new(transverse, axial, transverse),
        rotation_from_y(axis),
    )
}

/// Mass, centre of mass and inertia of a link at uniform density.
struct LinkMass {
    mass: Real,
    centre: Vector,
    /// Unit vector along the link.
    axis: Vector,
    /// Moment of inertia about the axis.
    axial: Real,
    /// Moment of inertia about a line through the centre, perpendicular to the axis.
    transverse: Real,
}

impl LinkMass {
    fn of(link: &ModifiedCylinder, density: Real) -> Self {
        let (axis, l, r) = (axis_or_x(link), link.length(), link.radius());
        let half_ball = |cap, outward: Real| MassOfPiece {
            mass: if cap == Cap::Round { 2.0 / 3.0 * r } else { 0.0 },
            centre: outward * (0.5 * l + 0.375 * r),
            axial: 0.4 * r * r,
            transverse: 83.0 / 320.0 * r * r,
        };
        let cylinder = MassOfPiece {
            mass: l,
            centre: 0.0,
            axial: 0.5 * r * r,
            transverse: 0.25 * r * r + l * l / 12.0,
        };
        let [start, end] = link.caps();
        let pieces = [cylinder, half_ball(start, -1.0), half_ball(end, 1.0)];

        // Weights are shares of the mass, which keeps the products small.
        let column: Real = pieces.iter().map(|piece| piece.mass).sum();
        let mean = |of: &dyn Fn(&MassOfPiece) -> Real| -> Real {
            pieces.iter().map(|piece| product(piece.mass / column, of(piece))).sum()
        };
        let centre = mean(&|piece| piece.centre);
        let axial = mean(&|piece| piece.axial);
        let transverse = mean(&|piece| piece.transverse + (piece.centre - centre).powi(2));

        let mass = product(density, PI * r * r * column);
        let centre = link.start().midpoint(link.end()) + axis * centre;
        Self {
            mass,
            centre,
            axis,
            axial: product(mass, axial),
            transverse: product(mass, transverse),
        }
    }
}

/// Returns the mass properties of all `links` at uniform `density`. Overlaps of two links count
/// twice. Links without mass have their centre in the middle of the first link's axis.
pub(super) fn mass_properties_of_all(links: &[ModifiedCylinder], density: Real) -> MassProperties {
    if let [link] = links {
        return mass_properties(link, density);
    }
    let of_links: Vec<LinkMass> = links.iter().map(|link| LinkMass::of(link, density)).collect();
    let total: Real = of_links.iter().map(|link| link.mass).sum();
    // Relative to the first link, so that a robot far from the origin loses no digits.
    let Some(origin) = of_links.first().map(|link| link.centre) else {
        return MassProperties::default();
    };
    let share = |link: &LinkMass| if total > 0.0 { link.mass / total } else { 0.0 };
    let centre: Vector = of_links.iter().map(|link| (link.centre - origin) * share(link)).sum();
    let mut inertia = [[0.0; 3]; 3];
    for link in &of_links {
        let offset = (link.centre - origin) - centre;
        let (axis, square) = (link.axis.to_array(), offset.length_squared());
        let offset = offset.to_array();
        for (i, row) in inertia.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let one = if i == j { 1.0 } else { 0.0 };
                let of_axis = axis[i] * axis[j];
                *entry += product(link.transverse, one - of_axis)
                    + product(link.axial, of_axis)
                    + product(link.mass, square * one - offset[i] * offset[j]);
            }
        }
    }
    let (moments, frame) = principal_axes(inertia);
    MassProperties::with_principal_inertia_frame(origin + centre, total, moments, frame)
}

/// Most sweeps. Jacobi's rotations take four to six for a matrix of three rows.
const MOST_SWEEPS: usize = 16;

/// Returns the principal moments of a symmetric tensor and the rotation from their frame.
fn principal_axes(mut a: [[Real; 3]; 3]) -> (Vector, Rotation) {
    let mut axes = [Vector::X, Vector::Y, Vector::Z];
    for _ in 0..MOST_SWEEPS {
        let mut is_diagonal = true;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            // An entry that changes no moment is rounding.
            let small = 0.25 * Real::EPSILON * a[p][p].abs().min(a[q][q].abs());
            // NaN, from masses out of range, rotates nothing either.
            if a[p][q].is_nan() || a[p][q].abs() <= small {
                continue;
            }
            is_diagonal = false;
            let cot = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
            let tan = cot.signum() / (cot.abs() + (cot * cot + 1.0).sqrt());
            let cos = 1.0 / (tan * tan + 1.0).sqrt();
            let sin = tan * cos;
            let r = 3 - p - q;
            let (shift, of_p, of_q) = (tan * a[p][q], a[r][p], a[r][q]);
            a[p][p] -= shift;
            a[q][q] += shift;
            (a[p][q], a[q][p]) = (0.0, 0.0);
            (a[r][p], a[r][q]) = (cos * of_p - sin * of_q, sin * of_p + cos * of_q);
            (a[p][r], a[q][r]) = (a[r][p], a[r][q]);
            (axes[p], axes[q]) = (axes[p] * cos - axes[q] * sin, axes[p] * sin + axes[q] * cos);
        }
        if is_diagonal {
            break;
        }
    }
    // Rotations keep the frame right-handed. Only rounding can make a moment negative.
    let moments = Vector::new(a[0][0].max(0.0), a[1][1].max(0.0), a[2][2].max(0.0));
    let frame = Matrix::from_cols(axes[0], axes[1], axes[2]);
    (moments, Rotation::from_mat3(&frame).normalize())
}

/// The product, with 0 times an infinite number defined as 0.
fn product(a: Real, b: Real) -> Real {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// Returns a rotation that takes the y axis to `axis` or to its opposite, whichever is nearer.
///
/// The quaternion `(y x axis, 1 + y . axis)`, normalised, loses digits only if the two are nearly
/// opposite. The choice of the nearer one excludes this.
fn rotation_from_y(axis: Vector) -> Rotation {
    let axis = if axis.y < 0.0 { -axis } else { axis };
    let turn = Vector::Y.cross(axis);
    Rotation::from_xyzw(turn.x, turn.y, turn.z, 1.0 + axis.y).normalize()
}
