//! The joint speeds nearest to those wanted that obey every limit: a quadratic program of six
//! unknowns.

use crate::kinematics::JOINTS;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus,
};
use parry_continuum::parry::math::{Real, Vector};

/// What the joint speeds must keep to: `rates . speeds >= least`.
pub struct Limit {
    pub rates: [Real; JOINTS],
    pub least: Real,
}

/// What a joint's speed costs beside the tip's: extensions in mm/s, angles in rad/s.
const COST: [Real; JOINTS] = [0.02, 0.02, 0.02, 2.0, 2.0, 2.0];

/// Minimises |J speeds - wanted|^2 + sum of cost speed^2 under the limits. The robot stops where no
/// speeds obey them.
pub fn speeds(
    jacobian: &[Vector; JOINTS],
    wanted: Vector,
    limits: &[Limit],
) -> Result<[Real; JOINTS], String> {
    let entry = |row: usize, column: usize| {
        jacobian[row].dot(jacobian[column]) + if row == column { COST[row] } else { 0.0 }
    };
    let hessian: Vec<Vec<Real>> =
        (0..JOINTS).map(|row| (0..JOINTS).map(|column| entry(row, column)).collect()).collect();
    let hessian = CscMatrix::from(&hessian).to_triu();
    let linear: Vec<_> = jacobian.iter().map(|column| -column.dot(wanted)).collect();
    // A x + s = b with s >= 0.
    let rates: Vec<Vec<Real>> =
        limits.iter().map(|limit| limit.rates.iter().map(|rate| -rate).collect()).collect();
    let rates =
        if rates.is_empty() { CscMatrix::zeros((0, JOINTS)) } else { CscMatrix::from(&rates) };
    let least: Vec<_> = limits.iter().map(|limit| -limit.least).collect();
    let settings =
        DefaultSettingsBuilder::default().verbose(false).build().map_err(|e| e.to_string())?;
    let cones = [NonnegativeConeT(limits.len())];
    let mut solver = DefaultSolver::new(&hessian, &linear, &rates, &least, &cones, settings)
        .map_err(|error| error.to_string())?;
    solver.solve();
    let solved =
        matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
    Ok(if solved { std::array::from_fn(|joint| solver.solution.x[joint]) } else { [0.0; JOINTS] })
}
