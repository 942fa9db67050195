//! Which flat ends stay flat while the robot moves.
//!
//! An end is flat by the radii alone, at the limits of the walks of Algorithm 1, or because it is less than a radius away
//! from the last limit (`algorithm_1`, `faces`). Radii do not change during a motion. A distance between two points changes
//! by no more than the points move: if it is D at one time and the points are v and w fast, then it is below the radius
//! for a time tau before and after as long as D + tau (v + w) is.
//!
//! At the joints of a curve none of that matters: round or flat, the tube is its discs (`faces`).
//!
//! A chain may be capped by vertex radii instead. A link's radius r_k is then the smaller of its two vertices' R_k and
//! R_k+1, and where r_k > r_k-1, R_k > R_k-1 too: every limit by the links' radii is one by the vertices'. Not the other way
//! round: a single thick vertex is a limit that the links' radii don't show. So the true limit is the one that they show or
//! a vertex between that and the end, and an end that is less than r_k <= R_k away from all of these is flat by either rule.

use super::Tube;
use crate::distance::Scalar;
use parry3d_f64::math::Real;

/// Whether a flat end is flat in other shapes of the robot, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lasting {
    /// The robot's own two ends, and the wider side of a step in radius.
    Always,
    /// At a joint of a curve, whose tube is the same where it is round.
    Either,
    /// For want of room behind such a face.
    WhileNear,
    /// The same in a chain that may be capped by vertex radii: behind such a face, or any vertex from there on.
    WhileAllNear,
    /// Its direction gets lost.
    Never,
}

impl Lasting {
    /// Whether a body with this flat end holds the tube at other times, too.
    pub(crate) fn is_safe(self) -> bool {
        matches!(self, Self::Always | Self::Either)
    }
}

impl Tube {
    /// Marks the flat ends that are so by the radii alone.
    pub(crate) fn mark_lasting_faces(&mut self) {
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                if number == limit
                    && let Some(face) = &mut tube.sections[number].faces[end]
                {
                    face.lasting = Lasting::Always;
                }
            });
        }
    }

    /// Marks the flat ends of a section as such that may get lost.
    pub(crate) fn mark_fading(&mut self, number: usize) {
        for face in self.sections[number].faces.iter_mut().flatten() {
            face.lasting = Lasting::Never;
        }
    }

    /// Marks the flat ends that stay so for a time: `moves(section, end)` is by how much that end of a section moves
    /// in it at most. By how much those that may not stay so move, with their limits, is returned.
    pub(crate) fn hold_faces(&mut self, moves: impl Fn(usize, usize) -> Real) -> Real {
        let rounding = 16.0 * Real::UNIT_ROUNDOFF * self.reach;
        let mut opening: Real = 0.0;
        for end in [0, 1] {
            self.walk(end, |tube, number, limit| {
                let section = &tube.sections[number];
                let Some(face) = section.faces[end] else { return };
                let limits = match face.lasting {
                    Lasting::WhileNear => limit..=limit,
                    Lasting::WhileAllNear => limit.min(number)..=limit.max(number),
                    Lasting::Always | Lasting::Either | Lasting::Never => return,
                };
                let mut stays = true;
                for limit in limits.filter(|limit| *limit != number) {
                    let at = &tube.sections[limit];
                    let from = tube.point(at, if end == 0 { at.first } else { at.last });
                    let change = moves(number, end) + moves(limit, end);
                    let apart = (face.centre - from).length() + change + rounding;
                    let is_near = apart < section.radius;
                    if !is_near {
                        opening = opening.max(change);
                    }
                    stays &= is_near;
                }
                if stays && let Some(face) = &mut tube.sections[number].faces[end] {
                    face.lasting = Lasting::Always;
                }
            });
        }
        opening
    }
}
