//! Which flat ends stay flat while the robot moves.
//!
//! An end is flat by the radii alone, at the limits of the walks of Algorithm 1, or because it is
//! less than a radius away from the last limit (`algorithm_1`, `faces`). Radii do not change during
//! a motion. A distance between two points changes by no more than the points move: if it is D at
//! one time and the points are v and w fast, then it is below the radius for a time tau before and
//! after as long as D + tau (v + w) is.
//!
//! At the joints of a curve none of that matters: round or flat, the tube is its discs (`faces`).
//!
//! A chain may be capped by vertex radii instead. A link's radius r_k is then the smaller of its
//! two vertices' R_k and R_k+1, and where r_k > r_k-1, R_k > R_k-1 too: every limit by the links'
//! radii is one by the vertices'. Not the other way round: a single thick vertex is a limit that
//! the links' radii don't show. So the true limit is the one that they show or a vertex between
//! that and the end, and an end that is less than r_k <= R_k away from all of these is flat by
//! either rule.
//!
//! # Directions
//! The flat ends of a section count as round in an interval of time in two cases. A ball around the
//! end holds the disc then, whichever way the disc stands, so only the centreline's speed counts.
//! 1. The section is marked (`fades`), and the way from its one end to the other changes by as much
//!    as it is long. It may lose its length in the interval, and with it its direction.
//! 2. The section turns by more than [`MAX_TURN`] = 1 rad.
//!
//! **Claim.** In case 2 the ball is the closer bound. **Proof.** Let r be the radius and a > 1 the
//! turn. A flat end counts r a in all directions. Every point of the ball is within r of the disc's
//! centre, and r < r a.

use super::Tube;
use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// Whether a flat end is flat in other shapes of the robot, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CapPersistence {
    /// The robot's own two ends, and the wider side of a step in radius.
    Always,
    /// At a joint of a curve, whose tube is the same where it is round.
    Either,
    /// For want of room behind such a face.
    WhileNear,
    /// The same in a chain that may be capped by vertex radii: behind such a face, or any vertex
    /// from there on.
    WhileAllNear,
    /// Its direction is not known.
    Never,
}

/// What turns farther than this, in rad, is held by a ball more closely than by discs.
const MAX_TURN: Real = 1.0;

/// A marked section has a direction if it is longer than this many times the rounding of a point.
const MIN_LENGTH: Real = 8.0;

/// How far sections move and turn from a shape until an interval of time ends, before it and after
/// it.
pub(crate) trait Drift {
    /// By how much an end of a section moves at most.
    fn moves(&self, section: usize, end: usize) -> Real;

    /// By how much the way from one end of a section to its other end changes at most.
    fn stretches(&self, section: usize) -> Real;

    /// By how much a section turns at most, in rad.
    fn turns(&self, section: usize) -> Real;

    /// Whether intervals can be so short that what turns so far in this one turns by less than 1
    /// rad.
    fn can_follow(&self, turn: Real) -> bool;
}

impl CapPersistence {
    /// Whether a body with this flat end holds the tube at other times, too.
    pub(crate) fn is_safe(self) -> bool {
        matches!(self, Self::Always | Self::Either)
    }
}

impl Tube {
    /// Marks the flat ends that are so by the radii alone.
    pub(crate) fn mark_persistent_faces(&mut self) {
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                if number == limit
                    && let Some(face) = &mut tube.sections[number].faces[end]
                {
                    face.persistence = CapPersistence::Always;
                }
            });
        }
    }

    /// Marks a link whose length vanishes in some shape of the motion.
    pub(crate) fn mark_fading(&mut self, number: usize) {
        self.sections[number].fades = true;
    }

    /// How long a section is.
    pub(crate) fn length_of(&self, number: usize) -> Real {
        self.sections[number].end - self.sections[number].start
    }

    /// States how far the direction of a link may be off whose ends are rounded.
    pub(crate) fn tilt_faces(&mut self, number: usize, tilt: Real) {
        for face in self.sections[number].faces.iter_mut().flatten() {
            face.tilt = tilt;
        }
    }

    /// Marks the flat ends that stay so for a time, and the sections whose direction may get lost
    /// in it. By how much those that may not stay so move, with their limits, is returned.
    pub(crate) fn mark_lasting_faces_between(&mut self, drift: &impl Drift) -> Real {
        let rounding = 16.0 * Real::UNIT_ROUNDOFF * self.reach;
        let mut opening = self.mark_lost_directions(drift, rounding);
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                let section = &tube.sections[number];
                let Some(face) = section.faces[end] else { return };
                let limits = match face.persistence {
                    CapPersistence::WhileNear => limit..=limit,
                    CapPersistence::WhileAllNear => limit.min(number)..=limit.max(number),
                    CapPersistence::Always | CapPersistence::Either | CapPersistence::Never => {
                        return;
                    }
                };
                let mut stays = true;
                for limit in limits.filter(|limit| *limit != number) {
                    let at = &tube.sections[limit];
                    let from = tube.point(at, if end == 0 { at.first } else { at.last });
                    let change = drift.moves(number, end) + drift.moves(limit, end);
                    let apart = (face.centre - from).length() + change + rounding;
                    let is_near = apart < section.radius;
                    if !is_near {
                        opening = opening.max(change);
                    }
                    stays &= is_near;
                }
                if stays && let Some(face) = &mut tube.sections[number].faces[end] {
                    face.persistence = CapPersistence::Always;
                }
            });
        }
        opening
    }

    /// Marks the sections whose flat ends count as round in the interval (cases 1 and 2). By how
    /// much the rims of the latter move is returned, if a shorter interval helps.
    fn mark_lost_directions(&mut self, drift: &impl Drift, rounding: Real) -> Real {
        let mut opening: Real = 0.0;
        for (number, section) in self.sections.iter_mut().enumerate() {
            if section.radius <= 0.0 || section.faces.iter().all(Option::is_none) {
                continue;
            }
            // Both written so that NaN loses the direction.
            let length = section.end - section.start;
            let keeps_length =
                !section.fades || length > drift.stretches(number) + MIN_LENGTH * rounding;
            let turns = drift.turns(number);
            let turns_little = turns <= MAX_TURN;
            section.fades = !(keeps_length && turns_little);
            if keeps_length && !turns_little && drift.can_follow(turns) {
                opening = opening.max(section.radius * turns);
            }
        }
        opening
    }
}
