//! Which flat ends stay flat while the robot moves.
//!
//! An end is flat for one of three reasons (`algorithm_1`, `section`):
//!
//! 1. The radii: it is a limit of the walks of Algorithm 1, which is an end of the robot or a step
//!    in radius. Radii are constant during a motion.
//! 2. Its distance to the last limit is less than a radius.
//! 3. The robot has flat caps at all links ([`Chain::cylinders`](crate::Chain::cylinders)).
//!
//! Only the second one changes with the shape. In a motion of one shape all flat ends stay flat.
//!
//! # Reason 2 over time
//! A distance changes by at most the movement of its two points. Let D be the distance at one time
//! and v and w the speeds of the points. The distance stays below the radius for a time tau before
//! and after if `D + tau (v + w)` does.
//!
//! At the joints of a curve this does not matter: round or flat, the tube is its discs (`faces`).
//!
//! # Chains by vertex radii
//! The radius r_k of a link is then the smaller of its two vertices' R_k and R_k+1. If
//! `r_k > r_k-1`, also `R_k > R_k-1`: every limit by links' radii is a limit by vertices' radii.
//! The converse fails: a single thick vertex is a limit that the links' radii do not show. So the
//! true limit is the shown one or a vertex between it and the end. An end that is less than
//! `r_k <= R_k` away from all these candidates is flat by either rule.
//!
//! # Directions
//! In two cases the flat ends of a section count as round in an interval of time. A ball around the
//! end contains the disc for every direction, so only the centreline's speed matters.
//!
//! 1. The section is marked (`fades`), and the vector from its one end to the other changes by its
//!    own length or more. The section may lose its length in the interval, and so its direction.
//! 2. The section turns by more than [`MAX_TURN`] = 1 rad.
//!
//! **Claim.** In case 2 the ball is the closer bound. **Proof.** Let r be the radius and a > 1 the
//! turn. A flat end costs `r a` in all directions. Every point of the ball is within r of the
//! disc's centre, and `r < r a`.

use super::Tube;
use super::section::CapPersistence;
use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// Beyond this turn, in rad, a ball is a closer bound than the discs (case 2).
const MAX_TURN: Real = 1.0;

/// A marked section keeps its direction if it is longer than this many times the rounding error of
/// a point.
const MIN_LENGTH: Real = 8.0;

/// Bounds on how far sections move and turn from a shape to either end of an interval of time.
pub(crate) trait Drift {
    /// Upper bound on the movement of an end of a section.
    fn moves(&self, section: usize, end: usize) -> Real;

    /// Upper bound on the change of the vector from one end of a section to the other, in any frame
    /// that moves rigidly: its length changes by no more.
    fn stretches(&self, section: usize) -> Real;

    /// Upper bound on the turn of a section, rad.
    fn turns(&self, section: usize) -> Real;

    /// Returns whether shorter intervals can reduce this turn below 1 rad.
    fn can_follow(&self, turn: Real) -> bool;
}

impl Tube {
    /// Marks the ends that are flat by the radii alone (reason 1).
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

    /// Marks all flat ends of a tube that keeps its shape.
    pub(crate) fn mark_constant_faces(&mut self) {
        for section in &mut self.sections {
            for face in section.faces.iter_mut().flatten() {
                if matches!(
                    face.persistence,
                    CapPersistence::WhileNear | CapPersistence::WhileAllNear
                ) {
                    face.persistence = CapPersistence::Always;
                }
            }
        }
    }

    /// Marks a link whose length vanishes in some shape of the motion.
    pub(crate) fn mark_fading(&mut self, number: usize) {
        self.sections[number].fades = true;
    }

    /// Returns the length of a section.
    pub(crate) fn length_of(&self, number: usize) -> Real {
        self.sections[number].end - self.sections[number].start
    }

    /// States the uncertainty of a link's direction, due to rounding of its ends.
    pub(crate) fn tilt_faces(&mut self, number: usize, tilt: Real) {
        for face in self.sections[number].faces.iter_mut().flatten() {
            face.tilt = tilt;
        }
    }

    /// Marks the ends that stay flat in an interval, and the sections that may lose their
    /// direction.
    ///
    /// Returns the larger of two upper bounds: on the movement, relative to their limits, of the
    /// ends that may not stay flat; and on the movement of the rims of sections that may turn too
    /// far.
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

    /// Marks the sections whose flat ends count as round in the interval (cases 1 and 2).
    ///
    /// Returns the movement of the rims in case 2, if a shorter interval helps.
    fn mark_lost_directions(&mut self, drift: &impl Drift, rounding: Real) -> Real {
        let mut opening: Real = 0.0;
        for (number, section) in self.sections.iter_mut().enumerate() {
            if section.radius <= 0.0 || section.faces.iter().all(Option::is_none) {
                continue;
            }
            // Both are written so that NaN loses the direction.
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
