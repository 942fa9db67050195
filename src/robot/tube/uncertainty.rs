//! What is stated of how far a robot may be from its tube: in place, and in direction at flat
//! faces.

use super::{EndFace, Section, Tube};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

impl Tube {
    /// The same tube, each point of which may be off by up to `error`, because the sensor or the
    /// kinematics are. For a centreline that is off by c and whose direction is off by an angle
    /// a, that is c + radius a: the rim of a flat face moves as the face turns. All bounds of
    /// answers count it, beside the deviation of a [`fit`](Self::fit).
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

    /// The same tube, whose direction near a flat face may be off by up to `turn` (rad) from that
    /// of the centreline: within two radii of the face, by arc length. Nothing is known of the
    /// directions of a tube by [`fit`](Self::fit) before, so that its bounds become closer and
    /// never looser; the directions of any other are known that much less.
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

    /// How far the centreline of a tube by [`fit`](Self::fit) is from the points at most; 0 for any
    /// other.
    pub fn residual(&self) -> Real {
        self.residual
    }

    /// Takes back the errors that were stated.
    pub(crate) fn forget_error(&mut self) {
        (self.error, self.turn) = (0.0, None);
    }

    /// How far a point of the tube may be from where it is said to be: what was stated, and what
    /// was taken for one.
    pub(crate) fn error(&self) -> Real {
        self.error + self.deviation + self.merged
    }

    /// By how much what was taken for one is apart.
    pub(crate) fn merged(&self) -> Real {
        self.merged
    }

    /// How far the centreline's directions near flat ends may be off, if that was stated.
    pub(crate) fn turn(&self) -> Option<Real> {
        self.turn
    }

    /// Whether nothing is known of the directions of flat ends but the turn that was stated.
    pub(crate) fn is_turn_all_that_is_known(&self) -> bool {
        let mut faces = self.sections.iter().flat_map(|section| section.faces).flatten().peekable();
        self.turn.is_some()
            && !self.is_loose()
            && faces.peek().is_some()
            && faces.all(|face| face.tilt == Real::INFINITY)
    }

    /// The flat ends of a section, whose directions may be off by a turn, if one is known.
    pub(crate) fn faces(&self, section: &Section, turn: Option<Real>) -> [Option<EndFace>; 2] {
        let tilt = |face: EndFace| match turn {
            Some(turn) if face.tilt < Real::INFINITY => face.tilt + turn,
            Some(turn) => turn,
            None => face.tilt,
        };
        section.faces.map(|face| face.map(|face| EndFace { tilt: tilt(face), ..face }))
    }

    /// How far apart two bounds near a flat end of a section have to be because its direction may
    /// be off by a turn, or is not known.
    pub(crate) fn direction_uncertainty(
        &self,
        section: &Section,
        end: usize,
        turn: Option<Real>,
    ) -> Real {
        match (section.faces[end], turn) {
            (Some(_), Some(turn)) => section.radius * (2.0 * turn).min(1.0),
            (Some(EndFace { tilt: Real::INFINITY, .. }), None) => section.radius,
            _ => 0.0,
        }
    }
}
