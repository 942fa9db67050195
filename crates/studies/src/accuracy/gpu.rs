//! The kernels of the GPU on the extreme problems.

use super::measure::{Found, Measured, PAIRS, Problem, scaled};
use super::problems::Extreme;
use super::tables::cell;
use crate::gpu::{GpuPairs, Pair, PairProblem};
use gpu_batch::DeviceError;
use parry_continuum::gpu::Gpu;

/// The pair and the caps of each of the [`KERNELS`](continuum_testing::kernels::KERNELS).
const PAIR_OF_KERNEL: [(Pair, [bool; 2]); 15] = [
    (Pair::SegmentSegment, [false; 2]),
    (Pair::PointTriangle, [false; 2]),
    (Pair::SegmentTriangle, [false; 2]),
    (Pair::PointDisc, [false; 2]),
    (Pair::SegmentDisc, [false; 2]),
    (Pair::PlaneDisc, [false; 2]),
    (Pair::TriangleDisc, [false; 2]),
    (Pair::PointModifiedCylinder, [false; 2]),
    (Pair::PointModifiedCylinder, [true; 2]),
    (Pair::PointModifiedCylinder, [false, true]),
    (Pair::TriangleCapsule, [false; 2]),
    (Pair::TriangleModifiedCylinder, [false; 2]),
    (Pair::TriangleModifiedCylinder, [true; 2]),
    (Pair::TriangleModifiedCylinder, [true, false]),
    (Pair::TriangleModifiedCylinder, [false, true]),
];

/// The head of [`lines`].
pub const HEAD: &str = "precision,category,pair,problems,GPU median,GPU worst";

/// The errors of every kernel on the given problems, as [`Found::scalar`].
pub fn measure<T: Measured>(gpu: &Gpu, problems: &[Problem<T>]) -> Result<Vec<Found>, DeviceError> {
    let mut found = Vec::new();
    for (kernel, (pair, flat)) in PAIR_OF_KERNEL.into_iter().enumerate() {
        let exact = |problem: &Problem<T>| PairProblem::of(&problem.input.map(Into::into), flat);
        let numbers: Vec<_> = problems.iter().map(exact).collect();
        let mut answers = Vec::new();
        GpuPairs::new(gpu, pair)?.solve(&numbers, &mut answers)?;
        for (problem, answer) in problems.iter().zip(&answers) {
            if let Some(proof) = problem.proofs[kernel] {
                let (extreme, power) = (problem.extreme, problem.power);
                let scalar = proof.error(scaled(answer.distance, -problem.exponent));
                found.push(Found { extreme, power, kernel, scalar, levels: Vec::new() });
            }
        }
    }
    Ok(found)
}

/// One line for each category and pair.
pub fn lines(precision: &str, found: &[Found]) -> Vec<String> {
    let mut lines = Vec::new();
    for (extreme, category, _) in Extreme::ALL {
        for (pair, kernels) in PAIRS {
            let here = |found: &&Found| found.extreme == extreme && kernels.contains(&found.kernel);
            let errors: Vec<_> = found.iter().filter(here).map(|found| found.scalar).collect();
            lines.push(format!("{precision},{category},{pair},{},{}", errors.len(), cell(errors)));
        }
    }
    lines
}
