//! The mesh and the links near one, in the precision of the search.
//!
//! The mesh is moved to its centre and multiplied by a power of two, then rounded to `E` (`f32` or `f64`). A
//! distance computed there errs by less than `error` = 64 u reach, where u is the unit roundoff of `E` and reach
//! bounds the coordinates of mesh and link in that frame: 16 u for each unit of extent (at most 2 reach) from
//! the kernel, and 2 u reach for each of the roundings of vertices, axis and the bound it is compared with. What is
//! computed in double precision, the way into that frame and the measured distances, adds its own rounding. A
//! triangle whose computed distance exceeds a bound by more than `error` is therefore farther than the bound;
//! any other is measured again in double precision. So every search returns the double-precision answer.

use super::probe::{Probe, SLACK};
use crate::distance::lanes::Lane;
use crate::distance::{Scalar, Vec3, gives_direction};
use parry3d_f64::math::{Real, Vector};

/// A link farther out than this many times the mesh's size could overflow single precision.
const FARTHEST: Real = 1.0e6;

/// The way from the mesh's frame to coordinates near one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoarseFrame {
    centre: Vector,
    scale: Real,
    /// How far the mesh's own coordinates reach, which bounds the rounding of the move.
    reach: Real,
}

impl CoarseFrame {
    /// The frame of a mesh with these (finite) vertices.
    pub(crate) fn new(vertices: &[Vector]) -> Self {
        let low = vertices.iter().copied().reduce(Vector::min).unwrap_or_default();
        let high = vertices.iter().copied().reduce(Vector::max).unwrap_or_default();
        let scale = (high - low).max_element().power_of_two_to_unity();
        Self {
            centre: low + (high - low) * 0.5,
            scale,
            reach: low.abs().max(high.abs()).max_element() * scale,
        }
    }

    pub(crate) fn point<E: Lane>(&self, point: Vector) -> Vec3<E> {
        round((point - self.centre) * self.scale)
    }
}

/// A link in the precision of the search.
#[derive(Clone, Copy)]
pub(crate) struct CoarseLink<E> {
    pub start: Vec3<E>,
    /// From start to end.
    pub along: Vec3<E>,
    pub axis: Vec3<E>,
    pub length: E,
    pub radius: E,
    pub flat: [bool; 2],
    /// What rounding can do to a distance.
    pub error: E,
    /// Multiplies a length in the probe's units.
    factor: Real,
}

impl<E: Lane> CoarseLink<E> {
    /// The link of a probe. None where it lies too far out for the precision, or is too large beside the mesh.
    pub(crate) fn new(probe: &Probe, frame: &CoarseFrame) -> Option<Self> {
        let [start, end] = probe.ends();
        let unit = probe.scaled(1.0);
        Self::between(start, end, probe.link().radius / unit, probe.link().flat, unit, frame)
    }

    /// A link between two points of the mesh's frame, whose bounds are given in units of 1 / `unit`.
    pub(crate) fn between(
        start: Vector,
        end: Vector,
        radius: Real,
        flat: [bool; 2],
        unit: Real,
        frame: &CoarseFrame,
    ) -> Option<Self> {
        // Before the ends are rounded: the direction of a short, thick link must not turn.
        let along = (end - start) * frame.scale;
        let [start, end] = [start, end].map(|point| (point - frame.centre) * frame.scale);
        let radius = radius * frame.scale;
        let reach = start.abs().max(end.abs()).max_element().max(radius).max(1.0);
        if reach.is_nan() || reach > FARTHEST {
            return None;
        }
        let length = along.length();
        // A link too short for its flat caps in this precision is one for double precision alone.
        if flat.contains(&true) && !gives_direction(E::round(length) * E::round(length)) {
            return None;
        }
        let factor = frame.scale / unit;
        // The mesh's own rounding, where it lies far from the origin, is that of double precision; and so is that of the
        // measured distances, which counts where the mesh is tiny beside the robot. The largest would rule nothing out.
        let error = 64.0 * (E::UNIT_ROUNDOFF * reach + f64::UNIT_ROUNDOFF * frame.reach) + SLACK * factor;
        if error > FARTHEST {
            return None;
        }
        Some(Self {
            start: round(start),
            along: round(along),
            // Without a direction the flat caps count as round, which is a bound for them too.
            axis: round(if length > 0.0 { along / length } else { Vector::ZERO }),
            length: E::round(length),
            radius: E::round(radius),
            flat,
            error: E::round(error),
            factor,
        })
    }

    /// What every triangle at most `limit` from the axis is nearer than, in the probe's units: the converse of
    /// [`CoarseLink::axis_limit`].
    pub(crate) fn bound_within(&self, limit: E) -> Real {
        let (limit, radius, error): (Real, Real, Real) =
            (limit.into(), self.radius.into(), self.error.into());
        ((limit - radius).max(0.0) + 2.0 * error) / self.factor
    }

    /// What a triangle is at least from the link, in the probe's units, if its axis distance (beyond a flat cap: its
    /// distance and the radius) was computed as `axis_distance`.
    #[cfg(feature = "gpu")]
    pub(crate) fn at_least(&self, axis_distance: Real) -> Real {
        let (radius, error): (Real, Real) = (self.radius.into(), self.error.into());
        (axis_distance - radius - error).max(0.0) / self.factor
    }

    /// What a triangle's axis distance must stay below for the link to be possibly nearer to it than `bound`,
    /// which is in the probe's units.
    pub(crate) fn axis_limit(&self, bound: Real) -> E {
        E::round(bound * self.factor) + self.radius + self.error
    }
}

fn round<E: Lane>(point: Vector) -> Vec3<E> {
    Vec3::from(point.to_array().map(E::round))
}
