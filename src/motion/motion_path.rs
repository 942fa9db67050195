//! Motions in sequence, as one motion.

use super::rigid_path::rigid_pose;
use super::sampled_shape::{PlaceMotion, SampledPlace, SampledShape, places};
use super::{CommonFrame, DisplacementBound, Motion, SectionSignature, Speed};
use crate::curve::{CapPersistence, Section, Tube};
use crate::distance::Scalar;
use crate::robot::RobotError;
use parry3d_f64::math::{Pose, Real, Vector};

/// A path: motions in sequence, each over an equal part of the time.
///
/// Of n motions the first runs from t = 0 to 1 / n, the second to 2 / n, and so on.
/// [`part_at`](Self::part_at) returns the motion at a given time. All have the same sections, and
/// each begins where the previous one ends.
///
/// ```
/// use parry_continuum::parry::{math::Vector, shape::Ball};
/// use parry_continuum::{LinearMotion, MotionPath, proximity::BvhSearch};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
/// let shapes =
///     [Vector::Z, Vector::Z + Vector::X * 2.0, Vector::X * 5.0].map(|tip| [Vector::ZERO, tip]);
/// let edges = shapes.windows(2).map(|ends| LinearMotion::chain(&ends[0], &ends[1], &[1.0]));
/// let path = MotionPath::new(edges.collect::<Result<_, _>>()?)?;
/// let least = search.clearance_of_motion(&path, 0.01)?;
/// assert!(least.resolved && path.part_at(least.t).0 == 1); // the second edge comes nearest
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MotionPath<M> {
    motions: Vec<M>,
}

impl<M: Motion> MotionPath<M> {
    /// Joins motions in order of time.
    ///
    /// Where two of them meet, both shapes are made and compared at nine places of each section and
    /// at its samples.
    ///
    /// # Errors
    /// - There are no motions.
    /// - A motion begins farther from the end of the previous one than rounding and the errors that
    ///   the shapes state for themselves explain, or in another direction. A robot would jump
    ///   there, and no speed bounds a jump.
    /// - Two motions have different sections.
    /// - A motion has no shape at its start or its end.
    pub fn new(motions: Vec<M>) -> Result<Self, RobotError> {
        if motions.is_empty() {
            return Err(RobotError::NoMotions { parameter: "motions" });
        }
        let mut joint = Joint::default();
        for (index, pair) in (1..).zip(motions.windows(2)) {
            let t = index as Real / motions.len() as Real;
            joint.check(index, t, [&pair[0], &pair[1]])?;
        }
        Ok(Self { motions })
    }

    /// Returns the index of the motion at a time from 0 to 1, and that motion's own time.
    pub fn part_at(&self, t: Real) -> (usize, Real) {
        let along = t * self.motions.len() as Real;
        // The conversion saturates.
        let leg = (along as usize).min(self.motions.len() - 1);
        (leg, self.time_in(leg, t))
    }

    /// Converts `t` to the time of one motion, clamped to 0..=1.
    fn time_in(&self, leg: usize, t: Real) -> Real {
        let within = (t * self.motions.len() as Real - leg as Real).max(0.0);
        within.min(1.0)
    }

    /// Returns an upper bound on the rounding error of a motion's own time.
    fn unsure(&self) -> Real {
        8.0 * TIME_ROUNDING * self.motions.len() as Real
    }

    /// Returns the motion whose part contains the times within rounding, and its own times; `None`
    /// across a joint.
    fn leg_of(&self, times: [Real; 2]) -> Option<(usize, [Real; 2])> {
        let [first, last] =
            [times[0] + TIME_ROUNDING, times[1] - TIME_ROUNDING].map(|t| self.part_at(t).0);
        (first == last).then(|| (last, times.map(|t| self.time_in(last, t))))
    }
}

/// Rounding may assign a time to a neighbouring motion up to this far beyond a joint.
const TIME_ROUNDING: Real = 4.0 * Real::UNIT_ROUNDOFF;

impl<M: Motion> Motion for MotionPath<M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let (leg, t) = self.part_at(t);
        self.motions[leg].shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        // Rounding may assign the time of one motion to its neighbour.
        let [first, last] =
            [times[0] + TIME_ROUNDING, times[1] - TIME_ROUNDING].map(|t| self.part_at(t).0);
        let up = self.motions.len() as Real * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        let all = (first.min(last)..=last).map(|leg| {
            let own = [-TIME_ROUNDING, TIME_ROUNDING];
            let times = [0, 1].map(|end| self.time_in(leg, times[end] + own[end]));
            self.motions[leg].speed(section, shares, times)
        });
        all.fold(Speed { point: 0.0, turn: 0.0 }, |most, speed| Speed {
            point: larger(most.point, speed.point * up),
            turn: larger(most.turn, speed.turn * up),
        })
    }

    /// `None` across a joint of two motions, where the velocity may jump.
    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        let (last, inner) = self.leg_of(times)?;
        let DisplacementBound { ways, off } =
            self.motions[last].displacement(section, shares, inner)?;
        // A motion's time errs by less than `rounding` times the number of motions, and so do the
        // two ends of the interval. A time of a neighbouring motion counts as this motion's end.
        let unsure = self.unsure();
        let around = [(inner[0] - unsure).max(0.0), (inner[1] + unsure).min(1.0)];
        let speed = self.motions[last].speed(section, shares, around);
        Some(DisplacementBound { ways, off: off + unsure * speed.point })
    }

    /// The frame of the current motion; `None` across a joint.
    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        let (leg, inner) = self.leg_of(times)?;
        let frame = self.motions[leg].common_frame(inner)?.at_unsure_time(self.unsure());
        Some(frame.sped_up(self.motions.len() as Real))
    }

    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let none = Speed { point: Real::INFINITY, turn: Real::INFINITY };
        let Some((leg, inner)) = self.leg_of(times) else { return none };
        let Speed { point, turn } = self.motions[leg].speed_in_frame(section, shares, inner);
        let up = self.motions.len() as Real * (1.0 + 4.0 * Real::UNIT_ROUNDOFF);
        Speed { point: point * up, turn: turn * up }
    }

    fn time_parts(&self) -> usize {
        self.motions.len()
    }
}

/// The end of a motion and the start of the next one.
#[derive(Default)]
struct Joint {
    ends: [SampledShape; 2],
    signature: SectionSignature,
    places: Vec<SampledPlace>,
    /// The flat faces at both ends of each section, of either shape.
    faces: [Vec<[Option<PlacedFace>; 2]>; 2],
}

/// The direction of a flat face, and an upper bound on its error.
#[derive(Clone, Copy)]
struct PlacedFace {
    outward: Vector,
    tilt: Real,
}

impl Joint {
    /// # Errors
    /// Motion `index` does not begin where the one before it ends, at the time `t` of the path.
    fn check(
        &mut self,
        index: usize,
        t: Real,
        motions: [&impl Motion; 2],
    ) -> Result<(), RobotError> {
        self.signature.clear();
        for (number, motion) in motions.into_iter().enumerate() {
            let mut tube = Tube::empty();
            let pose = motion.shape([1.0, 0.0][number], &mut tube)?;
            let pose = rigid_pose("motions", &pose)?;
            self.signature.check(t, &tube)?;
            if number == 0 {
                self.places = places(&tube);
            }
            self.ends[number].take(t, &tube, &pose, &self.places);
            let rounding = self.ends[number].rounding();
            let placed = |section: &Section| {
                [0, 1].map(|end: usize| {
                    // A section that fades has no direction, and a face that may be round does not
                    // matter.
                    let face = section.faces[end].filter(|face| {
                        face.persistence != CapPersistence::Never && !section.fades
                    })?;
                    // The direction of a link is computed from its two ends, which are rounded.
                    let inside = [Real::EPSILON, 1.0 - Real::EPSILON][end];
                    let around = tube.samples_around(section, inside);
                    let [from, to] = around.filter(|[from, to]| from < to).unwrap_or([0.0, 1.0]);
                    let length = (section.end - section.start) * (to - from);
                    let unsure = 64.0 * Real::UNIT_ROUNDOFF + 2.0 * rounding / length;
                    let outward = pose.rotation * face.outward;
                    (length > 0.0).then_some(PlacedFace { outward, tilt: face.tilt + unsure })
                })
            };
            self.faces[number].clear();
            self.faces[number].extend(tube.sections().iter().map(placed));
        }
        let [before, behind] = &self.ends;
        for (number, place) in self.places.iter().enumerate() {
            let Some(PlaceMotion { way, angle }) = before.moved(behind, number) else { continue };
            // A way that is NaN is apart. An angle is NaN where there is no direction.
            let is_joined = way <= 0.0 && (angle <= 0.0 || angle.is_nan());
            if !is_joined {
                let (section, share) = (place.section, place.shares[0]);
                let [off, turn] = [way, angle].map(|part| part.max(0.0));
                return Err(RobotError::MotionsApart { index, section, share, off, turn });
            }
        }
        // A face may turn about its centre, which no sample shows.
        let [before, behind] = &self.faces;
        for (section, pair) in before.iter().zip(behind).enumerate() {
            for end in 0..2 {
                let (Some(one), Some(other)) = (pair.0[end], pair.1[end]) else { continue };
                let turn = (one.outward - other.outward).length() - one.tilt - other.tilt;
                if turn > 0.0 {
                    let share = end as Real;
                    let off = 0.0;
                    return Err(RobotError::MotionsApart { index, section, share, off, turn });
                }
            }
        }
        Ok(())
    }
}

/// Returns the larger number; NaN if either is NaN.
fn larger(a: Real, b: Real) -> Real {
    if a >= b || a.is_nan() { a } else { b }
}
