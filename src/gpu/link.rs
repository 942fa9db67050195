//! A link in the device's frame and precision, and the conversion of its results.
use super::Precision;
use super::layout::{LinkRecord, UNBOUNDED};
use crate::distance::Vec3;
use crate::distance::lanes::Lane;
use crate::mesh::SearchFrame;
use crate::pair::{PlacedLink, SearchLink};
use parry3d_f64::math::Real;

/// The largest magnitude of a coordinate. Shaders pass bounds on in single precision, so the limit
/// of single precision holds for double precision too.
const FARTHEST: Real = <f32 as Lane>::FARTHEST;

/// A link as the GPU reads it, and the conversion of the GPU's distances to the mesh's unit.
#[derive(Debug)]
pub(super) struct DeviceLink {
    pub record: LinkRecord,
    /// The upper bound on the distance from the axis for a triangle to be a candidate.
    pub limit: f32,
    searched: DeviceSearch,
}

/// A link in the precision of the search.
#[derive(Debug)]
enum DeviceSearch {
    Single(SearchLink<f32>),
    Double(SearchLink<f64>),
}

impl DeviceLink {
    /// Converts a link. With a `bound`, only triangles within it are candidates. Returns `None` if
    /// the link lies too far out for the search.
    pub(super) fn new(
        link: &PlacedLink,
        frame: &SearchFrame,
        bound: Option<Real>,
        precision: Precision,
    ) -> Option<Self> {
        Some(match precision {
            Precision::F32 => Self::of(SearchLink::new(link, frame)?, bound, DeviceSearch::Single)?,
            Precision::F64 => Self::of(SearchLink::new(link, frame)?, bound, DeviceSearch::Double)?,
        })
    }

    fn of<E: Lane>(
        link: SearchLink<E>,
        bound: Option<Real>,
        searched: impl FnOnce(SearchLink<E>) -> DeviceSearch,
    ) -> Option<Self> {
        let number = |value: E| -> Real { value.into() };
        let point = |Vec3 { x, y, z }: Vec3<E>| [x, y, z].map(number);
        let [flat_start, flat_end] = link.flat.map(|flat| if flat { 1.0 } else { 0.0 });
        // A bound is rounded up. A bound above UNBOUNDED excludes nothing.
        let limit = bound.map_or(UNBOUNDED, |bound| {
            (number(link.axis_limit(bound)) as f32).next_up().min(UNBOUNDED)
        });
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
        let reach = record
            .start
            .iter()
            .chain(&record.end)
            .fold(record.radius, |reach, x| reach.max(x.abs()));
        (reach <= FARTHEST).then(|| Self { record, limit, searched: searched(link) })
    }

    /// Returns whether only triangles within a margin are candidates.
    pub(super) fn has_margin(&self) -> bool {
        self.limit < UNBOUNDED
    }

    /// A lower bound on a triangle's distance from the link, in the mesh's unit, from the distance
    /// that the GPU computed.
    pub(super) fn at_least(&self, distance: Real) -> Real {
        match &self.searched {
            DeviceSearch::Single(link) => link.at_least(distance),
            DeviceSearch::Double(link) => link.at_least(distance),
        }
    }

    /// The bound on the rounding error of a distance that the GPU computed, in the device's unit.
    pub(super) fn error(&self) -> Real {
        self.record.error
    }
}
