//! Forward kinematics of a concentric tube robot whose tubes twist.
//!
//! A tube's bending stiffness over its torsional stiffness is 1 + nu (E I over G J for a round
//! section, nu being Poisson's ratio), so that its angle psi_i obeys
//!
//! ```text
//! psi_i'' = (1 + nu) kappa_i sum_j k_j kappa_j sin(psi_i - psi_j) / sum_j k_j,
//! ```
//!
//! j running over the tubes that are present, with stiffness k and curvature kappa (0 where a tube
//! is straight); no tube is twisted at its own end (Dupont et al., T-RO 2010; Rucker, Jones and
//! Webster, T-RO 2010). With the angles given at the tubes' ends that is an initial value problem
//! from the tip to the base, and its solution is unique. It is integrated by Runge and Kutta's
//! method of order four, together with the frame.

use crate::ctr::{Joints, Robot};
use parry_continuum::parry::math::{Matrix, Pose, Real, Rot3, Vector};

/// The longest step of the integration, in the robot's unit: bends of radius 20 mm its error is
/// about 1e-9.
const STEP: Real = 0.25;

/// Poisson's ratio of the tubes.
pub const POISSON: Real = 0.3;

/// A robot whose tubes have twisted.
pub struct Twisted {
    /// The centreline at each requested arc length, in the frame of the robot's base.
    pub points: Vec<Vector>,
    /// The frame at the last of them, carried along without twist.
    pub tip: Pose,
    /// Each tube's angle at the base: what a motor there has set.
    pub base_angles: Vec<Real>,
}

/// What changes along the robot: every tube's angle and twist, the position and the frame's
/// columns.
#[derive(Clone)]
struct State {
    angles: Vec<Real>,
    twists: Vec<Real>,
    place: Vector,
    columns: [Vector; 3],
}

impl State {
    /// This state and a step along a derivative.
    fn along(&self, derivative: &State, step: Real) -> State {
        let sum = |a: &[Real], b: &[Real]| a.iter().zip(b).map(|(a, b)| a + step * b).collect();
        let [x, y, z] = self.columns;
        let [dx, dy, dz] = derivative.columns;
        State {
            angles: sum(&self.angles, &derivative.angles),
            twists: sum(&self.twists, &derivative.twists),
            place: self.place + derivative.place * step,
            columns: [x + dx * step, y + dy * step, z + dz * step],
        }
    }

    fn pose(&self) -> Pose {
        // The columns are orthonormal up to rounding and the error of the integration.
        let [_, y, z] = self.columns;
        let z = z.normalize();
        let x = y.cross(z).normalize();
        let turn = Rot3::from_mat3(&Matrix::from_cols(x, z.cross(x), z));
        Pose::from_parts(self.place, turn)
    }
}

/// A tube on the robot's arc length.
struct Reach {
    start: Real,
    end: Real,
    stiffness: Real,
    curvature: Real,
}

/// How the state changes between two breaks; `s` is any arc length between them.
fn derivative(tubes: &[Reach], s: Real, state: &State) -> State {
    let curved = |tube: &Reach| if tube.start < s && s < tube.end { tube.curvature } else { 0.0 };
    let stiffness: Real = tubes.iter().filter(|tube| s < tube.end).map(|tube| tube.stiffness).sum();
    let each = || tubes.iter().zip(&state.angles).map(|(tube, &angle)| (tube, angle, curved(tube)));
    let twist = |tube: &Reach, angle: Real, curvature: Real| {
        if s > tube.end {
            return 0.0;
        }
        let pull: Real =
            each().map(|(other, at, bend)| other.stiffness * bend * (angle - at).sin()).sum();
        (1.0 + POISSON) * curvature * pull / stiffness
    };
    let bend: Vector = each()
        .map(|(tube, angle, bend)| {
            Vector::new(-angle.sin(), angle.cos(), 0.0) * (tube.stiffness * bend)
        })
        .sum();
    let [x, y, z] = state.columns;
    let turn = (x * bend.x + y * bend.y) / stiffness;
    State {
        angles: state.twists.clone(),
        twists: each().map(|(tube, angle, curvature)| twist(tube, angle, curvature)).collect(),
        place: z,
        columns: [turn.cross(x), turn.cross(y), turn.cross(z)],
    }
}

/// One step of Runge and Kutta's method.
fn advance(tubes: &[Reach], s: Real, state: &State, step: Real) -> State {
    let first = derivative(tubes, s, state);
    let second = derivative(tubes, s, &state.along(&first, 0.5 * step));
    let third = derivative(tubes, s, &state.along(&second, 0.5 * step));
    let fourth = derivative(tubes, s, &state.along(&third, step));
    let sixth = step / 6.0;
    state
        .along(&first, sixth)
        .along(&second, 2.0 * sixth)
        .along(&third, 2.0 * sixth)
        .along(&fourth, sixth)
}

impl Robot {
    /// The robot at joints whose angles are given at the tubes' own ends, at each of the given arc
    /// lengths (ascending, from 0 to the extended length, both included).
    pub fn twisted(&self, joints: &Joints, arc_lengths: &[Real]) -> Twisted {
        let (mut tubes, mut breaks, mut end) = (Vec::new(), Vec::new(), 0.0);
        for (section, extension) in self.sections.iter().zip(&joints.extensions) {
            end += extension;
            let start = end - section.length;
            breaks.extend([start, end]);
            tubes.extend(section.tubes.iter().map(|tube| Reach {
                start,
                end,
                stiffness: tube.stiffness,
                curvature: tube.curvature,
            }));
        }
        breaks.retain(|&at| at > 0.0);
        breaks.sort_by(Real::total_cmp);

        let mut state = State {
            angles: joints.angles.clone(),
            twists: vec![0.0; tubes.len()],
            place: Vector::ZERO,
            columns: [Vector::X, Vector::Y, Vector::Z],
        };
        let mut at = end;
        let mut poses = Vec::with_capacity(arc_lengths.len());
        for &to in arc_lengths.iter().rev() {
            while at > to {
                while breaks.last().is_some_and(|&last| last >= at) {
                    breaks.pop();
                }
                let next = breaks.last().map_or(to, |&last| last.max(to));
                let steps = ((at - next) / STEP).ceil();
                for _ in 0..steps as usize {
                    state = advance(&tubes, 0.5 * (at + next), &state, (next - at) / steps);
                }
                at = next;
            }
            poses.push(state.pose());
        }
        // The integration began at the tip; the robot begins at its base.
        let base = state.pose().inverse();
        let points = poses.iter().rev().map(|pose| (base * *pose).translation).collect();
        Twisted {
            points,
            tip: poses.first().map_or(Pose::IDENTITY, |tip| base * *tip),
            base_angles: state.angles,
        }
    }
}
