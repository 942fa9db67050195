//! The root finders on the GPU.

use super::batch::Batch;
use super::opened::Gpu;
use super::{GpuError, shaders};
use crate::proximity::DeviceFailure;
use parry3d_f64::math::Real;
use polynomial_roots::Complex;
use std::time::Duration;

/// A method of `polynomial-roots`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Finder {
    /// [`ClosedForm`](polynomial_roots::ClosedForm), up to degree 4.
    ClosedForm,
    /// [`Bairstow`](polynomial_roots::Bairstow).
    Bairstow,
    /// [`Companion`](polynomial_roots::Companion).
    Companion,
    /// [`JenkinsTraub`](polynomial_roots::JenkinsTraub).
    JenkinsTraub,
}

impl Finder {
    /// Every method.
    pub const ALL: [Self; 4] = [Self::ClosedForm, Self::Bairstow, Self::Companion, Self::JenkinsTraub];
}

/// The roots of many polynomials at once, a GPU thread each, for coefficients of comparable size.
///
/// The approximations come as they are: unlike `polynomial-roots` on the CPU, nothing is cut into pieces,
/// tested or polished afterwards. In double precision, where shading languages have no cosine or cube root, the
/// closed form starts these in single precision and refines them.
pub struct GpuRoots {
    degree: usize,
    batch: Batch,
}

impl GpuRoots {
    /// Makes ready for polynomials of this degree, at least 1.
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn new(gpu: &Gpu, finder: Finder, degree: usize) -> Result<Self, GpuError> {
        let degree = degree.max(1);
        let (problem, answer) = (degree as u64 + 1, 2 * degree as u64 + 1);
        let kernel = shaders::FIND_ROOTS[finder as usize];
        let batch = Batch::new(gpu, kernel, degree as u32 + 1, &[], problem, answer)?;
        Ok(Self { degree, batch })
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
        let whole = coefficients.len() / (degree + 1) * (degree + 1);
        self.batch.run(coefficients[..whole].iter().copied(), &mut |answers| {
            while let Some(count) = answers.next() {
                for number in 0..degree {
                    let mut part = || answers.next().unwrap_or_default();
                    let root = Complex { re: part(), im: part() };
                    let missing = Complex { re: Real::NAN, im: Real::NAN };
                    out.push(if (number as Real) < count { root } else { missing });
                }
            }
        })
    }

    /// How long the GPU computed for the last polynomials, without transfers; `None` if it keeps no time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time
    }
}
