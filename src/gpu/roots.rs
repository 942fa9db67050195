//! The root finders on the GPU.

use super::batch::{Batch, BatchKernel};
use super::opened::Gpu;
use super::shaders::shared;
use super::{GpuError, Precision};
use crate::proximity::DeviceFailure;
use crate::roots::Complex;
use parry3d_f64::math::Real;
use std::time::Duration;

/// A method of [`roots`](crate::roots).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Finder {
    /// [`ClosedForm`](crate::roots::ClosedForm), up to degree 4.
    ClosedForm,
    /// [`Bairstow`](crate::roots::Bairstow).
    Bairstow,
    /// [`Companion`](crate::roots::Companion).
    Companion,
    /// [`JenkinsTraub`](crate::roots::JenkinsTraub).
    JenkinsTraub,
}

impl Finder {
    /// Every method.
    pub const ALL: [Self; 4] = [Self::ClosedForm, Self::Bairstow, Self::Companion, Self::JenkinsTraub];
}

/// The method in WGSL, as the function `approximate` of a monic polynomial up to this degree.
pub(super) fn approximate(finder: Finder, precision: Precision, degree: u16) -> String {
    // Powers of what is larger may be infinite; and the steps of the iterations that start in single precision.
    let (largest, steps) = match precision {
        Precision::F32 => (2.0_f64.powi(126), 2),
        Precision::F64 => (2.0_f64.powi(1022), 3),
    };
    let (name, text) = match finder {
        Finder::ClosedForm => ("closed_form", shared!("closed_form")),
        Finder::Bairstow => ("bairstow", shared!("division", "direction", "bairstow")),
        Finder::Companion => ("companion", shared!("companion")),
        Finder::JenkinsTraub => ("jenkins_traub", shared!("division", "direction", "jenkins_traub")),
    };
    format!(
        "const COEFFICIENTS = {}u;
const LARGEST = real({largest:e});
const ROOT_STEPS = {steps}u;
{}{text}
fn approximate(monic: ptr<function, Coefficients>, degree: u32) {{
    {name}(monic, degree);
}}
",
        u32::from(degree) + 1,
        shared!("roots"),
    )
}

/// The roots of many polynomials at once, a GPU thread each, for coefficients of comparable size.
///
/// The approximations come as they are: unlike [`roots`](crate::roots) on the CPU, nothing is cut into pieces,
/// tested or polished afterwards. In double precision, where shading languages have no cosine or cube root, the
/// closed form starts these in single precision and refines them.
#[derive(Debug)]
pub struct GpuRoots {
    degree: usize,
    batch: Batch,
}

impl GpuRoots {
    /// Makes ready for polynomials of this degree, from 1 to 32767 (and as far as the driver goes).
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn new(gpu: &Gpu, finder: Finder, degree: usize) -> Result<Self, GpuError> {
        let degree = degree.clamp(1, usize::from(u16::MAX / 2)) as u16;
        let text = text(finder, gpu.precision(), degree);
        Ok(Self { degree: degree.into(), batch: Batch::new(gpu, &kernel(&text, degree))? })
    }

    /// The roots of polynomials that stand one after another, each lowest power first: as many as the degree for each,
    /// conjugates side by side, NaN for those that did not converge. `out` is cleared first.
    ///
    /// # Errors
    /// The GPU has failed.
    pub fn solve(
        &mut self,
        coefficients: &[Real],
        out: &mut Vec<Complex<Real>>,
    ) -> Result<(), DeviceFailure> {
        out.clear();
        let degree = self.degree;
        self.batch.run(coefficients.iter().copied(), |answer| {
            let Some((&count, parts)) = answer.split_first() else { return };
            let (roots, _) = parts.as_chunks::<2>();
            out.extend(roots.iter().take(degree).enumerate().map(|(number, &[re, im])| {
                let missing = Complex { re: Real::NAN, im: Real::NAN };
                if (number as Real) < count { Complex { re, im } } else { missing }
            }));
        })
    }

    /// How long the GPU computed for the last polynomials, without transfers; `None` if it keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time()
    }
}

/// The kernel for polynomials of a degree with this text.
pub(super) fn kernel(text: &str, degree: u16) -> BatchKernel<'_> {
    BatchKernel::new("find_roots", text, degree + 1, 2 * degree + 1)
}

/// The text of that kernel.
pub(super) fn text(finder: Finder, precision: Precision, degree: u16) -> String {
    [shared!("vec3"), &approximate(finder, precision, degree), shared!("find_roots")].concat()
}
