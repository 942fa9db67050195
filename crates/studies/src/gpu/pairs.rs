//! Single pairs of the narrow phase on the GPU.

use super::Discs;
use continuum_testing::kernels::Input;
use gpu_batch::{Batch, DeviceError, DeviceFailure, Kernel, Precision, Shader};
use parry_continuum::distance::{Closest, Scalar, Vec3};
use parry_continuum::gpu::{Gpu, laboratory};
use std::time::Duration;

/// A pair of shapes of [`distance`](parry_continuum::distance), and which parts of a
/// [`PairProblem`] they are.
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

    /// The pair's function, of a problem `p` as shaders/pairs.wgsl loads it.
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

/// A triangle, a plane through its first vertex, a link, and a disc around the link's end. A pair
/// takes its part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairProblem {
    /// The triangle's vertices.
    pub triangle: [Vec3<f64>; 3],
    /// The plane's normal, of any length.
    pub plane_normal: Vec3<f64>,
    /// The start of the link's axis.
    pub start: Vec3<f64>,
    /// The end of the link's axis.
    pub end: Vec3<f64>,
    /// The disc's normal, of any length.
    pub disc_normal: Vec3<f64>,
    /// The radius of link and disc.
    pub radius: f64,
    /// Which caps of the link are flat.
    pub flat: [bool; 2],
}

impl PairProblem {
    /// The input of a kernel as the GPU takes it.
    pub fn of(input: &Input<f64>, flat: [bool; 2]) -> Self {
        let Input { triangle, plane_normal, start, end, disc_normal, radius } = *input;
        Self { triangle, plane_normal, start, end, disc_normal, radius, flat }
    }

    /// The frame that brings what the pair takes near one.
    fn frame(&self, pair: Pair) -> Frame {
        let Self { triangle: [a, b, c], start, end, radius, .. } = *self;
        match pair {
            Pair::SegmentSegment => Frame::around(start, &[end, a, b], 0.0),
            Pair::PointTriangle => Frame::around(end, &[a, b, c], 0.0),
            Pair::SegmentTriangle => Frame::around(start, &[end, a, b, c], 0.0),
            Pair::PointDisc | Pair::PlaneDisc => Frame::around(end, &[a], radius),
            Pair::SegmentDisc => Frame::around(end, &[a, b], radius),
            Pair::TriangleDisc => Frame::around(end, &[a, b, c], radius),
            Pair::PointModifiedCylinder => Frame::around(start, &[end, a], radius),
            Pair::TriangleCapsule | Pair::TriangleModifiedCylinder => {
                Frame::around(start, &[end, a, b, c], radius)
            }
        }
    }

    /// What shaders/pairs.wgsl loads, in the frame.
    fn numbers(&self, frame: &Frame) -> [f64; 24] {
        let [a, b, c] = self.triangle.map(|vertex| frame.point(vertex));
        let [start, end] = [self.start, self.end].map(|point| frame.point(point));
        let [plane, disc] = [self.plane_normal, self.disc_normal].map(Vec3::normalised);
        let [flat_start, flat_end] = self.flat.map(|flat| if flat { 1.0 } else { 0.0 });
        let round = Vec3::new(self.radius * frame.scale, flat_start, flat_end);
        let mut numbers = [0.0; 24];
        let vectors = [a, b, c, plane, start, end, disc, round].map(<[f64; 3]>::from);
        numbers.copy_from_slice(vectors.as_flattened());
        numbers
    }
}

/// Coordinates near one: from a point of the problem, and times a power of two.
struct Frame {
    origin: Vec3<f64>,
    scale: f64,
}

impl Frame {
    fn around(origin: Vec3<f64>, points: &[Vec3<f64>], length: f64) -> Self {
        let extent =
            points.iter().fold(length, |extent, &point| extent.max(largest(point - origin)));
        Self { origin, scale: extent.power_of_two_to_unity() }
    }

    fn point(&self, point: Vec3<f64>) -> Vec3<f64> {
        (point - self.origin) * self.scale
    }

    /// An answer of this frame in the problem's coordinates, with one common point where the
    /// distance is 0.
    fn answer(&self, distance: f64, on_first: Vec3<f64>, on_second: Vec3<f64>) -> Closest<f64> {
        let place = |point: Vec3<f64>| self.origin + point * (1.0 / self.scale);
        let point1 = place(on_first);
        let point2 = if distance > 0.0 { place(on_second) } else { point1 };
        Closest { distance: distance / self.scale, point1, point2 }
    }
}

fn largest(vector: Vec3<f64>) -> f64 {
    let [x, y, z] = <[f64; 3]>::from(vector).map(f64::abs);
    x.max(y).max(z)
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
    pub fn new(gpu: &Gpu, pair: Pair) -> Result<Self, DeviceError> {
        Self::with_discs(gpu, pair, Discs::Convex)
    }

    /// As [`GpuPairs::new`], with segment-disc by one of the paper's routes or by ours.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn with_discs(gpu: &Gpu, pair: Pair, discs: Discs) -> Result<Self, DeviceError> {
        let text = text(pair, discs, gpu.precision());
        Ok(Self { pair, batch: Batch::new(gpu.device(), &kernel(&text))? })
    }

    /// The closest points of every problem, in their order, computed in the GPU's precision. `out`
    /// is cleared first.
    ///
    /// # Errors
    /// The GPU has failed.
    pub fn solve(
        &mut self,
        problems: &[PairProblem],
        out: &mut Vec<Closest<f64>>,
    ) -> Result<(), DeviceFailure> {
        out.clear();
        let pair = self.pair;
        let numbers = problems.iter().flat_map(|problem| problem.numbers(&problem.frame(pair)));
        self.batch.run(numbers, |answer| {
            if let &[distance, x1, y1, z1, x2, y2, z2] = answer {
                let (point1, point2) = (Vec3::new(x1, y1, z1), Vec3::new(x2, y2, z2));
                out.push(problems[out.len()].frame(pair).answer(distance, point1, point2));
            }
        })
    }

    /// How long the GPU computed for the last problems, without transfers; `None` if it keeps no
    /// time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time()
    }
}

/// The kernel of a pair with this text.
fn kernel(text: &str) -> Kernel<'_> {
    Kernel::new("pairs", text, 24, 7)
}

/// The text of a pair's kernel.
fn text(pair: Pair, discs: Discs, precision: Precision) -> String {
    let solve = format!(
        "fn solve(problem: u32, answer: u32) {{
    let p = load_problem(problem);
    store_closest(answer, {});
}}
",
        pair.call()
    );
    [
        &laboratory::narrow_phase(precision),
        &discs.route(precision),
        include_str!("shaders/pairs.wgsl"),
        &solve,
    ]
    .concat()
}

/// The whole text of a pair's kernel, to check it without a GPU.
pub fn shader(pair: Pair, discs: Discs, precision: Precision) -> Shader {
    kernel(&text(pair, discs, precision)).shader(precision)
}
