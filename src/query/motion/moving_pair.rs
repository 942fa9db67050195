//! Two moving robots in an interval of time, in their middle shapes.

use super::approach_bound::Approach;
use super::approach_bound::ApproachSpeed;
use super::refinement::{BoundedPiece, WorkItem};
use super::relative_motion::RelativeMotion;
use crate::answer::ProximityError;
use crate::motion::{CarriedMotion, CarriedPiece, CommonFrame, Speed};
use crate::refine::{Body, BoundingBody, PiecePair, SectionRange, TubePair};
use crate::robot::RobotError;
use parry3d_f64::math::Real;

impl WorkItem<TubePair<'_>> for PiecePair {
    fn piece(&self, _: &TubePair) -> PiecePair {
        *self
    }

    fn halves(self, _: &TubePair, halves: [PiecePair; 2]) -> [Self; 2] {
        halves
    }
}

/// Pairs of pieces of two moving robots in an interval of time.
pub(super) struct MovingPair<'a> {
    pub motions: [CarriedMotion<'a>; 2],
    /// The frame in which speeds are added.
    pub seen_from: SeenFrom,
    /// The names of the motions in error messages.
    pub names: [&'static str; 2],
    /// How many pairs of pieces may still be tested in this query.
    pub left: &'a mut u32,
}

/// The frame in which the speeds of two robots are bounded. Each is valid; which one is best
/// depends on what both do together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SeenFrom {
    /// The mesh's frame, or that of the scene.
    Rest,
    /// The frame that carries one of the robots.
    Robot(usize),
}

impl SeenFrom {
    /// The speed of a piece of the robot `number`, whose stated speed is `stated`: seen from the
    /// frame at rest, if the robot has a frame; seen from the other robot's frame; or seen from its
    /// own frame, or from the frame at rest without a frame of its own. The last two are the stated
    /// speed, more precisely the speed relative to the field F.
    pub(super) fn speed(
        self,
        motions: &[CarriedMotion; 2],
        number: usize,
        stated: Speed,
        piece: impl FnOnce() -> CarriedPiece,
    ) -> Speed {
        let motion = &motions[number];
        let frame = match self {
            Self::Rest if motion.has_frame() => CommonFrame::REST,
            Self::Robot(other) if other != number => motions[other].frame(),
            _ if motion.is_exact() => return stated,
            _ => return motion.speeds(stated, piece, &CommonFrame::REST).own,
        };
        motion.speeds(stated, piece, &frame).seen
    }
}

impl<'t> RelativeMotion<TubePair<'t>, PiecePair> for MovingPair<'_> {
    /// The speeds of both pieces in one frame, in which they may move straight towards each other.
    fn speeds(
        &mut self,
        pair: &PiecePair,
        _: &PiecePair,
        _: &[BoundingBody; 2],
        tubes: &TubePair<'t>,
    ) -> Result<[Real; 2], ProximityError> {
        *self.left = self.left.saturating_sub(1);
        let mut speeds = [0.0; 2];
        for (number, (speed, range)) in
            speeds.iter_mut().zip(tubes.section_ranges(pair)).enumerate()
        {
            let SectionRange { section, shares, .. } = range;
            let stated = self.motions[number].stated(section as usize, shares);
            let seen = self.seen_from.speed(&self.motions, number, stated, || {
                let placed = tubes.tube(number);
                let (section, has_rim) = (placed.section(section), range.outer.is_flat());
                CarriedPiece::new(placed.tube, &placed.pose, section, shares, has_rim)
            });
            let named =
                |error: RobotError| ProximityError::Motion(error).of_robot(self.names[number]);
            let ApproachSpeed { centreline, rim } =
                ApproachSpeed::of(seen, &range).map_err(named)?;
            *speed = centreline + rim;
        }
        Ok(speeds)
    }

    fn is_exhausted(&self) -> bool {
        *self.left == 0
    }

    fn fastest_section(
        &self,
        bounded: &BoundedPiece<TubePair<'t>, PiecePair>,
        approach: &Approach,
    ) -> (usize, Real) {
        bounded.found.faster(approach.speeds)
    }
}
