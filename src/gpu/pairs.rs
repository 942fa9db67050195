//! Single pairs of the narrow phase on the GPU.

use super::batch::Batch;
use super::opened::{Discs, Gpu};
use super::{GpuError, shaders};
use crate::distance::{Closest, Frame, Vec3};
use crate::proximity::DeviceFailure;
use parry3d_f64::math::Real;
use std::time::Duration;

/// A pair of shapes of [`distance`](crate::distance), and which parts of a [`PairProblem`] they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pair {
    /// The link's axis against the triangle's first edge.
    SegmentSegment,
    /// The link's end point against the triangle.
    PointTriangle,
    /// The link's axis against the triangle.
    SegmentTriangle,
    /// The triangle's first vertex against the disc around the link's end.
    PointDisc,
    /// The triangle's first edge against the disc around the link's end.
    SegmentDisc,
    /// The plane through the triangle's first vertex against the disc around the link's end.
    PlaneDisc,
    /// The triangle against the disc around the link's end.
    TriangleDisc,
    /// The triangle's first vertex against the link.
    PointModifiedCylinder,
    /// The triangle against the link with two round caps.
    TriangleCapsule,
    /// The triangle against the link.
    TriangleModifiedCylinder,
}

impl Pair {
    /// Every pair.
    pub const ALL: [Self; 10] = [
        Self::SegmentSegment,
        Self::PointTriangle,
        Self::SegmentTriangle,
        Self::PointDisc,
        Self::SegmentDisc,
        Self::PlaneDisc,
        Self::TriangleDisc,
        Self::PointModifiedCylinder,
        Self::TriangleCapsule,
        Self::TriangleModifiedCylinder,
    ];
}

/// A triangle, a plane through its first vertex, a link, and a disc around the link's end. A pair takes its part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairProblem {
    /// The triangle's vertices.
    pub triangle: [Vec3<Real>; 3],
    /// The plane's normal, of any length.
    pub plane_normal: Vec3<Real>,
    /// The start of the link's axis.
    pub start: Vec3<Real>,
    /// The end of the link's axis.
    pub end: Vec3<Real>,
    /// The disc's normal, of any length.
    pub disc_normal: Vec3<Real>,
    /// The radius of link and disc.
    pub radius: Real,
    /// Which caps of the link are flat.
    pub flat: [bool; 2],
}

impl PairProblem {
    /// The frame that brings what the pair takes near one.
    fn frame(&self, pair: Pair) -> Frame<Real> {
        let Self { triangle: [a, b, c], start, end, radius, .. } = *self;
        match pair {
            Pair::SegmentSegment => Frame::around(start, [end, a, b], 0.0),
            Pair::PointTriangle => Frame::around(end, [a, b, c], 0.0),
            Pair::SegmentTriangle => Frame::around(start, [end, a, b, c], 0.0),
            Pair::PointDisc | Pair::PlaneDisc => Frame::around(end, [a], radius),
            Pair::SegmentDisc => Frame::around(end, [a, b], radius),
            Pair::TriangleDisc => Frame::around(end, [a, b, c], radius),
            Pair::PointModifiedCylinder => Frame::around(start, [end, a], radius),
            Pair::TriangleCapsule | Pair::TriangleModifiedCylinder => {
                Frame::around(start, [end, a, b, c], radius)
            }
        }
    }

    /// What pairs.wgsl reads, in the frame.
    fn numbers(&self, frame: &Frame<Real>) -> [Real; 24] {
        let point = |point: Vec3<Real>| -> [Real; 3] { frame.point(point).into() };
        let [a, b, c] = self.triangle.map(point);
        let [start, end] = [self.start, self.end].map(point);
        let [plane, disc] =
            [self.plane_normal, self.disc_normal].map(|normal| -> [Real; 3] { normal.normalised().into() });
        let [flat_start, flat_end] = self.flat.map(|flat| if flat { 1.0 } else { 0.0 });
        let mut numbers = [0.0; 24];
        let vectors = [a, b, c, plane, start, end, disc, [frame.length(self.radius), flat_start, flat_end]];
        for (place, number) in numbers.iter_mut().zip(vectors.as_flattened()) {
            *place = *number;
        }
        numbers
    }
}

/// The closest points of many pairs at once, a GPU thread each.
pub struct GpuPairs {
    pair: Pair,
    batch: Batch,
}

impl GpuPairs {
    /// Makes ready for problems of this pair.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn new(gpu: &Gpu, pair: Pair) -> Result<Self, GpuError> {
        Self::with_discs(gpu, pair, Discs::Convex)
    }

    /// As [`GpuPairs::new`], with segment-disc by one of the paper's routes or by ours.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn with_discs(gpu: &Gpu, pair: Pair, discs: Discs) -> Result<Self, GpuError> {
        let kernel = if discs == Discs::Convex { shaders::PAIRS } else { shaders::PAIRS_BY_QUARTIC };
        let mut constants = vec![("PAIR", f64::from(pair as u32))];
        constants.extend(discs.constant());
        Ok(Self { pair, batch: Batch::new(gpu, kernel, shaders::QUARTIC, &constants, 24, 7)? })
    }

    /// The closest points of every problem, in their order, computed in the GPU's precision. `out` is cleared first.
    ///
    /// # Errors
    /// The GPU has failed.
    pub fn solve(
        &mut self,
        problems: &[PairProblem],
        out: &mut Vec<Closest<Real>>,
    ) -> Result<(), DeviceFailure> {
        out.clear();
        let pair = self.pair;
        let numbers = problems.iter().flat_map(|problem| problem.numbers(&problem.frame(pair)));
        self.batch.run(numbers, &mut |answers| {
            while let Some(distance) = answers.next() {
                let mut next = || answers.next().unwrap_or_default();
                let point1 = Vec3::new(next(), next(), next());
                let point2 = Vec3::new(next(), next(), next());
                let Some(problem) = problems.get(out.len()) else { return };
                out.push(problem.frame(pair).answer(Closest { distance, point1, point2 }));
            }
        })
    }

    /// How long the GPU computed for the last problems, without transfers; `None` if it keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time
    }
}
