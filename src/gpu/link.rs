use super::Precision;
use super::layout::{FAR, LinkRecord};
use crate::distance::Vec3;
use crate::distance::lanes::Lane;
use crate::mesh::SearchFrame;
use crate::pair::{PlacedLink, SearchLink};
use parry3d_f64::math::Real;

/// Shaders pass bounds on in single precision, so that links farther out are none for double
/// precision either.
const FARTHEST: Real = <f32 as Lane>::FARTHEST;

/// A link as the GPU sees it, and the way from what the GPU finds to the mesh's unit.
#[derive(Debug)]
pub(super) struct DeviceLink {
    pub record: LinkRecord,
    /// What a triangle's distance from the axis must not exceed to be of interest.
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
    /// A link of which only triangles at most `bound` away are of interest, if there is a bound.
    /// None where it lies too far out for the search.
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
        // A bound is rounded up; beyond FAR it bounds nothing.
        let limit =
            bound.map_or(FAR, |bound| (number(link.axis_limit(bound)) as f32).next_up().min(FAR));
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

    /// Whether only triangles within a margin are of interest.
    pub(super) fn has_margin(&self) -> bool {
        self.limit < FAR
    }

    /// What a triangle is at least from the link, in the mesh's unit, by the distance that the GPU
    /// computed.
    pub(super) fn at_least(&self, distance: Real) -> Real {
        match &self.searched {
            DeviceSearch::Single(link) => link.at_least(distance),
            DeviceSearch::Double(link) => link.at_least(distance),
        }
    }

    /// What rounding can do to a distance that the GPU computed, in its units.
    pub(super) fn error(&self) -> Real {
        self.record.error
    }
}
