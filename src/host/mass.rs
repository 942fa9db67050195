//! Mass properties of a link, exactly.
//!
//! # Derivation
//! A link of radius `r` and length `l` is a cylinder and, at each round end, half a ball. With the unit of
//! mass chosen so that a volume of `pi r^2` per length weighs 1 per length, about the middle of the axis:
//!
//! | piece | mass | centre on the axis | axial `k^2` | transverse `k^2` about its own centre |
//! |---|---|---|---|---|
//! | cylinder | `l` | 0 | `r^2 / 2` | `r^2 / 4 + l^2 / 12` |
//! | half ball | `2 r / 3` | `+-(l / 2 + 3 r / 8)` | `2 r^2 / 5` | `2 r^2 / 5 - (3 r / 8)^2 = 83 r^2 / 320` |
//!
//! `k` is the radius of gyration. The half ball's row: the second moment of half a ball about any line
//! through the ball's centre is half the ball's, and the parallel axis theorem takes it to its own centre of
//! mass, `3 r / 8` outwards. The whole link follows by adding masses, moments and, again by the parallel axis
//! theorem, second moments. Every term is positive, so nothing cancels; the centre of mass leaves the middle
//! only when one end is round and the other flat.
//!
//! The link is a body of revolution, so any frame with one axis along it is principal; here, as for parry's
//! cylinder and capsule, that is the frame's y axis. Turning the axis round changes no inertia, so the
//! shorter of the two turns is taken.

use super::axial::axis_or_x;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Real, Rotation, Vector};
use std::f64::consts::PI;

/// One row of the table: mass, centre along the axis from its middle, squared radii of gyration.
struct MassOfPiece {
    mass: Real,
    centre: Real,
    axial: Real,
    transverse: Real,
}

/// Mass properties at uniform `density`. A wire (radius 0) has no mass.
pub(super) fn mass_properties(link: &ModifiedCylinder, density: Real) -> MassProperties {
    let (axis, l, r) = (axis_or_x(link), link.length(), link.radius());
    let half_ball = |cap, outward: Real| MassOfPiece {
        mass: if cap == Cap::Round { 2.0 / 3.0 * r } else { 0.0 },
        centre: outward * (0.5 * l + 0.375 * r),
        axial: 0.4 * r * r,
        transverse: 83.0 / 320.0 * r * r,
    };
    let cylinder =
        MassOfPiece { mass: l, centre: 0.0, axial: 0.5 * r * r, transverse: 0.25 * r * r + l * l / 12.0 };
    let [start, end] = link.caps();
    let pieces = [cylinder, half_ball(start, -1.0), half_ball(end, 1.0)];

    // Weighted by shares of the mass rather than masses, which keeps the products shorter.
    let column: Real = pieces.iter().map(|piece| piece.mass).sum();
    let mean = |of: &dyn Fn(&MassOfPiece) -> Real| -> Real {
        pieces.iter().map(|piece| product(piece.mass / column, of(piece))).sum()
    };
    let centre = mean(&|piece| piece.centre);
    let axial = mean(&|piece| piece.axial);
    let transverse = mean(&|piece| piece.transverse + (piece.centre - centre).powi(2));

    let mass = product(density, PI * r * r * column);
    let (axial, transverse) = (product(mass, axial), product(mass, transverse));
    MassProperties::with_principal_inertia_frame(
        link.start().midpoint(link.end()) + axis * centre,
        mass,
        Vector::new(transverse, axial, transverse),
        rotation_from_y(axis),
    )
}

/// The product, where nothing times a number that left the range of f64 is still nothing.
fn product(a: Real, b: Real) -> Real {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// A rotation that takes the y axis to `axis` or to its opposite, whichever is nearer.
///
/// The quaternion `(y x axis, 1 + y . axis)`, normalised, loses digits only when the two are nearly opposite,
/// which the choice of the nearer one excludes.
fn rotation_from_y(axis: Vector) -> Rotation {
    let axis = if axis.y < 0.0 { -axis } else { axis };
    let turn = Vector::Y.cross(axis);
    Rotation::from_xyzw(turn.x, turn.y, turn.z, 1.0 + axis.y).normalize()
}
