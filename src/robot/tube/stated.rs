//! What is stated of how far a robot may be from its tube: in place, and in direction at flat faces.

use super::{Face, Section, Tube};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

impl Tube {
    /// The same tube, each point of which may be off by up to `error`, because the sensor or the kinematics are. For a
    /// centreline that is off by c and whose direction is off by an angle a, that is c + radius a: the rim of a flat face
    /// moves as the face turns. All bounds of answers count it, beside the deviation of a [`fit`](Self::fit).
    ///
    /// # Errors
    /// The error is not finite or negative.
    pub fn with_error(mut self, error: Real) -> Result<Self, RobotError> {
        if !(0.0..Real::INFINITY).contains(&error) {
            return Err(RobotError::Negative { parameter: "error", value: error });
        }
        self.error = error;
        Ok(self)
    }

    /// The same tube, whose direction near a flat face may be off by up to `turn` (rad) from that of the centreline: within
    /// two radii of the face, by arc length. Nothing is known of the directions of a tube by [`fit`](Self::fit) before; those
    /// of any other are known that much less.
    ///
    /// # Errors
    /// The turn is not finite or negative.
    pub fn with_turn(mut self, turn: Real) -> Result<Self, RobotError> {
        if !(0.0..Real::INFINITY).contains(&turn) {
            return Err(RobotError::Negative { parameter: "turn", value: turn });
        }
        self.turn = Some(turn);
        Ok(self)
    }

    /// How far the centreline of a tube by [`fit`](Self::fit) is from the points at most; 0 for any other.
    pub fn residual(&self) -> Real {
        self.residual
    }

    /// Takes back the errors that were stated.
    pub(crate) fn forget_error(&mut self) {
        (self.error, self.turn) = (0.0, None);
    }

    /// How far a point of the tube may be from where it is said to be: what was stated, and what was taken for one.
    pub(crate) fn error(&self) -> Real {
        self.error + self.deviation + self.merged
    }

    /// How far the centreline's directions near flat ends may be off, as far as somebody said so.
    pub(crate) fn turn(&self) -> Real {
        self.turn.unwrap_or(0.0)
    }

    /// The flat ends of a section, with what was stated of their directions.
    pub(crate) fn faces(&self, section: &Section) -> [Option<Face>; 2] {
        let tilt = |face: Face| match self.turn {
            Some(turn) if face.tilt < Real::INFINITY => face.tilt + turn,
            Some(turn) => turn,
            None => face.tilt,
        };
        section.faces.map(|face| face.map(|face| Face { tilt: tilt(face), ..face }))
    }

    /// How far apart two bounds near a flat end of a section have to be because of what was stated of its direction, or
    /// was not.
    pub(crate) fn doubt(&self, section: &Section, end: usize) -> Real {
        match (section.faces[end], self.turn) {
            (Some(_), Some(turn)) => section.radius * (2.0 * turn).min(1.0),
            (Some(Face { tilt: Real::INFINITY, .. }), None) => section.radius,
            _ => 0.0,
        }
    }
}
