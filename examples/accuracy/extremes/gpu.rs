//! The kernels of the GPU on the extreme problems.

use super::measure::{Found, Measured, PAIRS, Problem, scaled};
use super::problems::Extreme;
use super::tables::cell;
use crate::common::kernels::Input;
use crate::common::precision::vector;
use parry_continuum::distance::Vec3;
use parry_continuum::gpu::{Gpu, GpuError, GpuPairs, Pair, PairProblem};

/// The pair and the caps of each of the [`KERNELS`](crate::common::kernels::KERNELS).
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
pub fn measure<T: Measured>(gpu: &Gpu, problems: &[Problem<T>]) -> Result<Vec<Found>, GpuError> {
    let mut found = Vec::new();
    for (kernel, (pair, flat)) in PAIR_OF_KERNEL.into_iter().enumerate() {
        let numbers: Vec<_> = problems.iter().map(|problem| pair_problem(&problem.input, flat)).collect();
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

fn pair_problem<T: Measured>(input: &Input<T>, flat: [bool; 2]) -> PairProblem {
    let wide = |v: Vec3<T>| Vec3::from(vector(v).to_array());
    PairProblem {
        triangle: input.triangle.map(wide),
        plane_normal: wide(input.plane_normal),
        start: wide(input.start),
        end: wide(input.end),
        disc_normal: wide(input.disc_normal),
        radius: input.radius.into(),
        flat,
    }
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
