//! Branches against clamps on the GPU, for comparison with the paper's Tables II and III.

use gpu_batch::{Batch, DeviceError, DeviceFailure, Kernel, Precision, Shader};
use parry_continuum::distance::Vec3;
use parry_continuum::gpu::{Gpu, laboratory};
use std::time::Duration;

/// A distance in one of two forms. Both use the same products; neither is as exact as
/// [`distance`](parry_continuum::distance).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// Two segments, (7) and (8) by clamping.
    ClampedSegments,
    /// Two segments by a decision tree.
    TreeSegments,
    /// Point and triangle, the face and three edges by clamping.
    ClampedTriangle,
    /// Point and triangle by a decision tree over the seven regions of its plane.
    TreeTriangle,
}

impl Form {
    /// Every form.
    pub const ALL: [Self; 4] =
        [Self::ClampedSegments, Self::TreeSegments, Self::ClampedTriangle, Self::TreeTriangle];

    /// The form's function, of the points a, b, c and d.
    fn call(self) -> &'static str {
        match self {
            Self::ClampedSegments => "clamped_segments(two_segments(a, b, c, d))",
            Self::TreeSegments => "tree_segments(two_segments(a, b, c, d))",
            Self::ClampedTriangle => "clamped_triangle(a, b, c, d)",
            Self::TreeTriangle => "tree_triangle(a, b, c, d)",
        }
    }
}

/// One form for many problems at once, a GPU thread each.
#[derive(Debug)]
pub struct GpuForms(Batch);

impl GpuForms {
    /// Makes ready for this form.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn new(gpu: &Gpu, form: Form) -> Result<Self, DeviceError> {
        Ok(Self(Batch::new(gpu.device(), &kernel(&text(form)))?))
    }

    /// The squared distances between the segments of the first and the last two points, or between
    /// the first point and the triangle of the others. Coordinates are near one. `out` is
    /// cleared first.
    ///
    /// # Errors
    /// The GPU has failed.
    pub fn solve(
        &mut self,
        points: &[[Vec3<f64>; 4]],
        out: &mut Vec<f64>,
    ) -> Result<(), DeviceFailure> {
        out.clear();
        let numbers = points.iter().flatten().flat_map(|&point| <[f64; 3]>::from(point));
        self.0.run(numbers, |answer| out.extend(answer))
    }

    /// How long the GPU computed for the last problems, without transfers; `None` if it keeps no
    /// time.
    pub fn device_time(&self) -> Option<Duration> {
        self.0.device_time()
    }
}

/// The kernel of a form with this text.
fn kernel(text: &str) -> Kernel<'_> {
    Kernel::new("forms", text, 12, 1)
}

/// The text of a form's kernel.
fn text(form: Form) -> String {
    let solve = format!(
        "fn solve(problem: u32, answer: u32) {{
    let a = form_point(problem);
    let b = form_point(problem + 3u);
    let c = form_point(problem + 6u);
    let d = form_point(problem + 9u);
    answers[answer] = {};
}}
",
        form.call()
    );
    [laboratory::VECTORS, include_str!("shaders/forms.wgsl"), &solve].concat()
}

/// The whole text of a form's kernel, to check it without a GPU.
pub fn shader(form: Form, precision: Precision) -> Shader {
    kernel(&text(form)).shader(precision)
}
