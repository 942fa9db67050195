//! The stated uncertainty of a tube: in place, and in direction at flat faces.

use super::{EndFace, Section, Tube};
use crate::robot::RobotError;
use parry3d_f64::math::Real;
use std::f64::consts::PI;

impl Tube {
    /// States that each point of the tube may be off by up to `error`, in the unit of the points.
    ///
    /// Use it for errors of a sensor or of the kinematics. If the centreline is off by c and its
    /// direction by an angle a, state `c + radius a`: the rim of a flat face moves as the face
    /// turns. All bounds include it, in addition to the deviation of a [`fit`](Self::fit).
    ///
    /// # Errors
    /// The error is negative or not finite.
    pub fn with_error(mut self, error: Real) -> Result<Self, RobotError> {
        if !(0.0..Real::INFINITY).contains(&error) {
            return Err(RobotError::Negative { parameter: "error", value: error });
        }
        self.error = error;
        Ok(self)
    }

    /// States that the direction near a flat face may be off by up to `turn`, in rad.
    ///
    /// It applies to the centreline within two radii of the face, by arc length. For a tube by
    /// [`fit`](Self::fit), whose directions were unknown before, bounds become closer and never
    /// looser. For any other tube the uncertainty of directions grows by `turn`. A turn of pi
    /// leaves every direction open; more counts as pi.
    ///
    /// # Errors
    /// The turn is negative or not finite.
    pub fn with_turn(mut self, turn: Real) -> Result<Self, RobotError> {
        if !(0.0..Real::INFINITY).contains(&turn) {
            return Err(RobotError::Negative { parameter: "turn", value: turn });
        }
        self.turn = Some(turn.min(PI));
        Ok(self)
    }

    /// Returns the largest distance of a [`fit`](Self::fit)'s centreline from its points; 0 for any
    /// other tube.
    pub fn residual(&self) -> Real {
        self.residual
    }

    /// Removes the stated errors.
    pub(crate) fn forget_error(&mut self) {
        (self.error, self.turn) = (0.0, None);
    }

    /// Returns an upper bound on the error of a point: stated error, deviation, and merged points.
    pub(crate) fn error(&self) -> Real {
        self.error + self.deviation + self.merged
    }

    /// Returns the stated error of directions near flat ends, if any.
    pub(crate) fn turn(&self) -> Option<Real> {
        self.turn
    }

    /// Returns whether the stated turn alone bounds the directions of all flat ends.
    pub(crate) fn is_turn_all_that_is_known(&self) -> bool {
        let mut faces = self.sections.iter().flat_map(|section| section.faces).flatten().peekable();
        self.turn.is_some()
            && !self.is_loose()
            && faces.peek().is_some()
            && faces.all(|face| face.tilt == Real::INFINITY)
    }

    /// Returns the flat ends of a section with tilts enlarged by `turn`, if it is known.
    pub(crate) fn faces(&self, section: &Section, turn: Option<Real>) -> [Option<EndFace>; 2] {
        let tilt = |face: EndFace| match turn {
            Some(turn) if face.tilt < Real::INFINITY => face.tilt + turn,
            Some(turn) => turn,
            None => face.tilt,
        };
        section.faces.map(|face| face.map(|face| EndFace { tilt: tilt(face), ..face }))
    }

    /// Returns how far apart the two bounds near a flat end stay because its direction is uncertain
    /// by `turn`, or unknown.
    ///
    /// The rim of the face may be off by r `turn` to either side, and never by more than r: the
    /// face's centre lies in the tube for every direction. The tilt that the samples alone leave
    /// shrinks with finer samples, so it is not counted.
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
