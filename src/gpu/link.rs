use super::Precision;
use super::record::record;
use crate::distance::Vec3;
use crate::distance::lanes::Lane;
use crate::proximity::{CoarseFrame, CoarseLink, Probe};
use parry3d_f64::math::Real;

/// More than any distance near one.
pub(super) const FAR: f32 = f32::from_bits((127 + 100) << 23);

record! {
    /// What shaders/shared/query.wgsl reads of a link.
    LinkRecord {
        start: [Real; 3],
        length: Real,
        /// From the start, as the axis.
        end: [Real; 3],
        radius: Real,
        axis: [Real; 3],
        error: Real,
        flat_start: Real,
        flat_end: Real,
    }
}

/// A link as the GPU sees it, and the way from what the GPU finds to the probe's units.
pub(super) struct DeviceLink {
    pub record: LinkRecord,
    /// What a triangle's distance from the axis must not exceed to be of interest.
    pub limit: f32,
    coarse: Coarse,
}

/// A link in the precision of the search.
enum Coarse {
    Single(CoarseLink<f32>),
    Double(CoarseLink<f64>),
}

impl DeviceLink {
    /// The link of a probe; only triangles nearer than `bound`, in the probe's units, are of interest. None where it
    /// lies too far out for the search.
    pub(super) fn new(
        probe: &Probe,
        frame: &CoarseFrame,
        bound: Option<Real>,
        precision: Precision,
    ) -> Option<Self> {
        Some(match precision {
            Precision::F32 => Self::of(CoarseLink::new(probe, frame)?, bound, Coarse::Single),
            Precision::F64 => Self::of(CoarseLink::new(probe, frame)?, bound, Coarse::Double),
        })
    }

    fn of<E: Lane>(
        link: CoarseLink<E>,
        bound: Option<Real>,
        coarse: impl FnOnce(CoarseLink<E>) -> Coarse,
    ) -> Self {
        let number = |value: E| -> Real { value.into() };
        let point = |Vec3 { x, y, z }: Vec3<E>| [x, y, z].map(number);
        let [flat_start, flat_end] = link.flat.map(|flat| if flat { 1.0 } else { 0.0 });
        // A bound is rounded up; beyond FAR it bounds nothing.
        let limit = bound.map_or(FAR, |bound| (number(link.axis_limit(bound)) as f32).next_up().min(FAR));
        let record = LinkRecord {
            start: point(link.start),
            length: number(link.length),
            end: point(link.along),
            radius: number(link.radius),
            axis: point(link.axis),
            error: number(link.error),
            flat_start,
            flat_end,
        };
        Self { record, limit, coarse: coarse(link) }
    }

    /// Whether only triangles within a margin are of interest.
    pub(super) fn has_margin(&self) -> bool {
        self.limit < FAR
    }

    /// What a triangle is at least from the link, in the probe's units, by the distance that the GPU computed.
    pub(super) fn at_least(&self, distance: Real) -> Real {
        match &self.coarse {
            Coarse::Single(link) => link.at_least(distance),
            Coarse::Double(link) => link.at_least(distance),
        }
    }

    /// What rounding can do to a distance that the GPU computed, in its units.
    pub(super) fn error(&self) -> Real {
        self.record.error
    }
}
