//! The root finders on the GPU (feature `gpu`).
//!
//! Each function has the name of its twin in this crate and does the same in the same order, in
//! WGSL that is one text for both precisions.

use crate::{Complex, bairstow, closed_form, companion, jenkins_traub};
use gpu_batch::{Batch, Device, DeviceError, DeviceFailure, Kernel, Precision, Shader};
use std::time::Duration;

pub use gpu_batch;

macro_rules! shaders {
    ($($file:literal),* $(,)?) => { concat!($(include_str!(concat!("shaders/", $file, ".wgsl"))),*) };
}

/// A method of this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Finder {
    /// [`ClosedForm`](crate::ClosedForm), up to degree 4.
    ClosedForm,
    /// [`Bairstow`](crate::Bairstow).
    Bairstow,
    /// [`Companion`](crate::Companion).
    Companion,
    /// [`JenkinsTraub`](crate::JenkinsTraub).
    JenkinsTraub,
}

impl Finder {
    /// Every method.
    pub const ALL: [Self; 4] =
        [Self::ClosedForm, Self::Bairstow, Self::Companion, Self::JenkinsTraub];
}

/// The method in WGSL for polynomials up to this degree, for kernels that find roots on their way.
/// It declares `COEFFICIENTS`, `Coefficients` (lowest power first), the function
/// `approximate(monic: ptr<function, Coefficients>, degree: u32)`, and what that finds:
/// `root_count`, `root_re` and `root_im`. It builds on [`wgsl`](gpu_batch::wgsl).
pub fn approximate(finder: Finder, precision: Precision, degree: u16) -> String {
    let (name, text) = match finder {
        Finder::ClosedForm => ("closed_form", shaders!("closed_form")),
        Finder::Bairstow => ("bairstow", shaders!("division", "direction", "bairstow")),
        Finder::Companion => ("companion", shaders!("companion")),
        Finder::JenkinsTraub => {
            ("jenkins_traub", shaders!("division", "direction", "jenkins_traub"))
        }
    };
    let constants = constants(precision, degree);
    let roots = shaders!("roots");
    format!(
        "{constants}{roots}{text}
fn approximate(monic: ptr<function, Coefficients>, degree: u32) {{
    {name}(monic, degree);
}}
"
    )
}

/// What the shaders and their twins both know.
fn constants(precision: Precision, degree: u16) -> String {
    // Powers of what is larger may be infinite; and the steps of the iterations that start in
    // single precision.
    let (largest, root_steps) = match precision {
        Precision::F32 => (2.0_f64.powi(126), 2),
        Precision::F64 => (2.0_f64.powi(1022), 3),
    };
    let [first_x, first_y] = bairstow::FIRST_DIRECTION;
    let [turn_cosine, turn_sine] = bairstow::TURN;
    let whole = [
        ("COEFFICIENTS", usize::from(degree) + 1),
        ("ROOT_STEPS", root_steps),
        ("BAIRSTOW_STEPS", bairstow::STEPS),
        ("BAIRSTOW_GUESSES", bairstow::GUESSES),
        ("FACTOR_STEPS", closed_form::FACTOR_STEPS),
        ("COMPANION_SWEEPS", companion::SWEEPS),
        ("NO_SHIFT_STEPS", jenkins_traub::NO_SHIFT_STEPS),
        ("DIRECTIONS", jenkins_traub::DIRECTIONS),
        ("LINEAR_STEPS", jenkins_traub::LINEAR_STEPS),
        ("QUADRATIC_STEPS", jenkins_traub::QUADRATIC_STEPS),
    ];
    let real = [
        ("LARGEST", largest),
        ("DIVISION_ROUNDINGS", bairstow::ROUNDINGS),
        ("FACTOR_ROUNDINGS", closed_form::FACTOR_ROUNDINGS),
        ("FIRST_X", first_x),
        ("FIRST_Y", first_y),
        ("TURN_COSINE", turn_cosine),
        ("TURN_SINE", turn_sine),
    ];
    let whole = whole.map(|(name, value)| format!("const {name} = {value}u;\n"));
    let real = real.map(|(name, value)| format!("const {name} = real({value:e});\n"));
    whole.concat() + &real.concat()
}

/// The highest degree whose record size fits the type.
const MOST: u16 = u16::MAX / 2;

/// The roots of many polynomials at once, a GPU thread each, for coefficients of comparable size.
///
/// The approximations come as they are: unlike on the CPU, nothing is cut into pieces, tested or
/// polished afterwards. In double precision, where shading languages have no cosine or cube root,
/// the closed form starts these in single precision and refines them.
#[derive(Debug)]
pub struct GpuRoots {
    degree: usize,
    batch: Batch,
}

impl GpuRoots {
    /// Prepares for polynomials of this degree, from 1 to 32767 (or the driver's limit).
    ///
    /// # Errors
    /// The driver does not compile the kernel.
    pub fn new(device: &Device, finder: Finder, degree: usize) -> Result<Self, DeviceError> {
        let degree = degree.clamp(1, usize::from(MOST)) as u16;
        let text = text(finder, device.precision(), degree);
        Ok(Self { degree: degree.into(), batch: Batch::new(device, &kernel(&text, degree))? })
    }

    /// The roots of polynomials that follow one another, each lowest power first. Each has as many
    /// roots as its degree, conjugates side by side, NaN for a root that did not converge. `out`
    /// is cleared first.
    ///
    /// # Errors
    /// The GPU has failed.
    pub fn solve(
        &mut self,
        coefficients: &[f64],
        out: &mut Vec<Complex<f64>>,
    ) -> Result<(), DeviceFailure> {
        out.clear();
        let degree = self.degree;
        self.batch.run(coefficients.iter().copied(), |answer| {
            let Some((&count, parts)) = answer.split_first() else { return };
            let (roots, _) = parts.as_chunks::<2>();
            out.extend(roots.iter().take(degree).enumerate().map(|(number, &[re, im])| {
                let missing = Complex { re: f64::NAN, im: f64::NAN };
                if (number as f64) < count { Complex { re, im } } else { missing }
            }));
        })
    }

    /// How long the GPU computed for the last polynomials, without transfers; `None` if it keeps no
    /// time.
    pub fn device_time(&self) -> Option<Duration> {
        self.batch.device_time()
    }
}

/// The kernel for polynomials of a degree with the text of [`text`].
fn kernel(text: &str, degree: u16) -> Kernel<'_> {
    Kernel::new("find_roots", text, degree + 1, 2 * degree + 1)
}

fn text(finder: Finder, precision: Precision, degree: u16) -> String {
    approximate(finder, precision, degree) + shaders!("find_roots")
}

/// The whole text of the kernel for polynomials of a degree, to check it without a GPU.
pub fn shader(finder: Finder, precision: Precision, degree: u16) -> Shader {
    kernel(&text(finder, precision, degree), degree).shader(precision)
}
