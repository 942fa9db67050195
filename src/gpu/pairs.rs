//! Single pairs of the narrow phase on the GPU.

use super::batch::{Batch, BatchKernel};
use super::opened::Gpu;
use super::roots::{Finder, approximate};
use super::shaders::{CONVEX, NARROW_PHASE, shared};
use super::{GpuError, Precision};
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

    /// The pair's function, of a problem `p` as shared/pairs.wgsl loads it.
    fn call(self) -> &'static str {
        match self {
            Self::SegmentSegment => "segment_segment(p.start, p.end, p.a, p.b)",
            Self::PointTriangle => "point_triangle(p.end, p.a, p.b, p.c)",
            Self::SegmentTriangle => "segment_triangle(p.start, p.end, p.a, p.b, p.c)",
            Self::PointDisc => "point_disc(p.a, p.end, p.disc_normal, p.radius)",
            Self::SegmentDisc => "segment_disc(p.a, p.b, p.end, p.disc_normal, p.radius)",
            Self::PlaneDisc => "plane_disc(p.a, p.plane_normal, p.end, p.disc_normal, p.radius)",
            Self::TriangleDisc => "triangle_disc(p.a, p.b, p.c, p.end, p.disc_normal, p.radius)",
            Self::PointModifiedCylinder => {
                "point_modified_cylinder(p.a, p.start, p.end, p.radius, p.flat_start, p.flat_end)"
            }
            Self::TriangleCapsule => "triangle_capsule(p.a, p.b, p.c, p.start, p.end, p.radius)",
            Self::TriangleModifiedCylinder => {
                "triangle_modified_cylinder(p.a, p.b, p.c, p.start, p.end, p.radius, p.flat_start, p.flat_end)"
            }
        }
    }
}

/// A route to the disc of a flat cap: the paper's are there for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Discs {
    /// This crate's, without roots of a polynomial.
    #[default]
    Convex,
    /// The paper's quartic in closed form.
    ClosedForm,
    /// The paper's quartic by the companion matrix.
    Companion,
}

impl Discs {
    /// The route in WGSL, as [`GpuExhaustive::compute_every_pair`](super::GpuExhaustive::compute_every_pair) takes it.
    pub fn route(self, precision: Precision) -> String {
        let finder = match self {
            Self::Convex => return CONVEX.into(),
            Self::ClosedForm => Finder::ClosedForm,
            Self::Companion => Finder::Companion,
        };
        approximate(finder, precision, 4) + shared!("segment_disc_quartic")
    }
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

    /// What shared/pairs.wgsl loads, in the frame.
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
#[derive(Debug)]
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
        let text = text(pair, discs, gpu.precision());
        Ok(Self { pair, batch: Batch::new(gpu, &kernel(&text))? })
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
        self.batch.run(numbers, |answer| {
            if let &[distance, x1, y1, z1, x2, y2, z2] = answer {
                let (point1, point2) = (Vec3::new(x1, y1, z1), Vec3::new(x2, y2, z2));
                let frame = problems[out.len()].frame(pair);
                out.push(frame.answer(Closest { distance, point1, point2 }));
            }
        })
    }

    /// How long the GPU computed for the last problems, without transfers; `None` if it keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time()
    }
}

/// The kernel of a pair with this text.
pub(super) fn kernel(text: &str) -> BatchKernel<'_> {
    BatchKernel::new("pairs", text, 24, 7)
}

/// The text of a pair's kernel.
pub(super) fn text(pair: Pair, discs: Discs, precision: Precision) -> String {
    let solve = format!(
        "fn solve(problem: u32, answer: u32) {{
    let p = load_problem(problem);
    store_closest(answer, {});
}}
",
        pair.call()
    );
    [NARROW_PHASE, &discs.route(precision), shared!("pairs"), &solve].concat()
}
