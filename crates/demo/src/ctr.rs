//! Forward kinematics of a concentric tube robot, torsionally rigid.
//!
//! The robot is a telescope of sections, the outermost first; each is one or more precurved tubes
//! that move together. Section i reaches phi_i beyond section i - 1, so that it ends at the arc
//! length e_i = phi_1 + .. + phi_i; its tubes are stiff on all of [0, e_i] and curved on its last
//! L_i. Where several tubes lie inside each other they take the mean of their curvature vectors,
//! weighted by bending stiffness (Dupont et al., T-RO 2010; Rucker, Jones and Webster, T-RO 2010).
//! Without torsion that mean is constant between the arc lengths where a tube ends or
//! becomes straight, and the centreline is a chain of circular arcs.
//!
//! Base frame: the centreline leaves the origin along +z. A tube at angle 0 bends towards +x;
//! angles are about +z, in the frame that is carried along the curve without twist. Lengths in one
//! unit throughout (here mm), angles in rad.

use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::{RobotError, TubeSection};

/// A precurved tube.
#[derive(Clone, Copy, Debug)]
pub struct Tube {
    /// Bending stiffness; only ratios matter.
    pub stiffness: Real,
    /// Curvature of the free tube.
    pub curvature: Real,
}

/// Tubes that extend together.
#[derive(Clone, Debug)]
pub struct Section {
    /// Greatest extension, and the length that is precurved.
    pub length: Real,
    /// Outer radius of its outermost tube.
    pub radius: Real,
    pub tubes: Vec<Tube>,
}

/// The sections, from the outermost to the innermost.
#[derive(Clone, Debug)]
pub struct Robot {
    pub sections: Vec<Section>,
}

/// Where the tubes are.
#[derive(Clone, Debug, PartialEq)]
pub struct Joints {
    /// Each section's extension beyond the previous one, from 0 to its length.
    pub extensions: Vec<Real>,
    /// Each tube's angle.
    pub angles: Vec<Real>,
}

/// A centreline as `Chain` takes it: points, and the radius of each segment between them.
#[derive(Clone, Debug)]
pub struct Centreline {
    pub points: Vec<Vector>,
    pub radii: Vec<Real>,
}

/// The three tubes of the examples: a stiff one, a soft one, and a straight wire-thin one
/// (millimetres).
pub fn three_tubes() -> Robot {
    let section = |length, radius, stiffness, curvature| Section {
        length,
        radius,
        tubes: vec![Tube { stiffness, curvature }],
    };
    Robot {
        sections: vec![
            section(66.47, 1.25, 5.0, 0.0522),
            section(66.7, 1.0, 1.0, 0.05263),
            section(12.65, 0.5, 0.05, 1e-9),
        ],
    }
}

impl Robot {
    /// The extended length.
    pub fn length(&self, joints: &Joints) -> Real {
        joints.extensions.iter().sum()
    }

    /// The arc length at which each section ends.
    fn ends(&self, joints: &Joints) -> Vec<Real> {
        let mut end = 0.0;
        joints
            .extensions
            .iter()
            .map(|extension| {
                end += extension;
                end
            })
            .collect()
    }

    /// Position and frame at each of the given arc lengths (ascending, from 0 to the length that is
    /// out).
    pub fn frames(&self, joints: &Joints, arc_lengths: &[Real]) -> Vec<Pose> {
        let ends = self.ends(joints);
        let starts = ends.iter().zip(&self.sections).map(|(end, section)| end - section.length);
        let mut breaks: Vec<Real> =
            starts.chain(ends.iter().copied()).filter(|&s| s > 0.0).collect();
        breaks.sort_by(Real::total_cmp);
        let mut breaks = breaks.into_iter();

        let (mut from, mut frame) = (0.0, Pose::IDENTITY);
        let mut to = breaks.next().unwrap_or(0.0);
        let mut frames = Vec::with_capacity(arc_lengths.len());
        for &s in arc_lengths {
            while s > to
                && let Some(next) = breaks.next()
            {
                frame *= arc(self.curvature(joints, &ends, 0.5 * (from + to)), to - from);
                (from, to) = (to, next);
            }
            frames.push(frame * arc(self.curvature(joints, &ends, 0.5 * (from + to)), s - from));
        }
        frames
    }

    /// The centreline as a function that is fast to evaluate repeatedly.
    pub fn curve(&self, joints: &Joints) -> Curve {
        let ends = self.ends(joints);
        let starts = ends.iter().zip(&self.sections).map(|(end, section)| end - section.length);
        let mut breaks: Vec<Real> =
            starts.chain(ends.iter().copied()).filter(|&s| s > 0.0).collect();
        breaks.sort_by(Real::total_cmp);
        let mut from = 0.0;
        Curve::joined(breaks.into_iter().map(|to| {
            let bend = self.curvature(joints, &ends, 0.5 * (from + to));
            (to - std::mem::replace(&mut from, to), bend)
        }))
    }

    /// The robot as the curve that it is, in its own frame; sections that are not out are left out.
    ///
    /// # Errors
    /// Nothing is out, or the robot bends within its own radius.
    pub fn shape(&self, joints: &Joints) -> Result<parry_continuum::Tube, RobotError> {
        let curve = self.curve(joints);
        parry_continuum::Tube::from_function(&self.sections_out(joints), move |s| curve.at(s))
    }

    /// The sections that are out, with the largest curvature of each.
    pub fn sections_out(&self, joints: &Joints) -> Vec<TubeSection> {
        let (curve, mut end) = (self.curve(joints), 0.0);
        let out = self.sections.iter().zip(&joints.extensions).filter(|(_, length)| **length > 0.0);
        out.map(|(section, &length)| {
            let curvature = curve.curvature(end, end + length);
            end += length;
            TubeSection { length, radius: section.radius, curvature }
        })
        .collect()
    }

    /// The mean curvature vector at an arc length, in the frame carried along.
    fn curvature(&self, joints: &Joints, ends: &[Real], s: Real) -> Vector {
        let (mut sum, mut stiffness, mut angles) = (Vector::ZERO, 0.0, joints.angles.iter());
        for (section, &end) in self.sections.iter().zip(ends) {
            for (tube, angle) in section.tubes.iter().zip(&mut angles) {
                if s < end {
                    stiffness += tube.stiffness;
                }
                if s < end && s > end - section.length {
                    sum += Vector::new(-angle.sin(), angle.cos(), 0.0)
                        * (tube.stiffness * tube.curvature);
                }
            }
        }
        if stiffness > 0.0 { sum / stiffness } else { Vector::ZERO }
    }

    /// The joints on the way to a goal, at a share of its length from 0 to 1: the outermost section
    /// comes out first, then the next. The tubes that are still inside have their final angles,
    /// so the robot that is out has its final shape, and the rest of it follows where the tip
    /// went.
    pub fn on_the_way(&self, goal: &Joints, share: Real) -> Joints {
        let mut out = share * self.length(goal);
        let mut part = |extension: &Real| {
            let part = out.min(*extension);
            out -= part;
            part
        };
        Joints {
            extensions: goal.extensions.iter().map(&mut part).collect(),
            angles: goal.angles.clone(),
        }
    }

    /// The centreline as about `links` segments, shared out among the sections by their lengths: at
    /// least one for each section that is out, so that the radius changes exactly where a
    /// section ends.
    pub fn centreline(&self, joints: &Joints, links: usize) -> Centreline {
        let whole = self.length(joints);
        let (mut arc_lengths, mut radii, mut from) = (vec![0.0], Vec::new(), 0.0);
        for (section, &extension) in self.sections.iter().zip(&joints.extensions) {
            if extension > 0.0 {
                let done = from / whole * links as Real;
                let share = (done + extension / whole * links as Real).round() - done.round();
                let count = (share as usize).max(1);
                arc_lengths
                    .extend((1..=count).map(|k| from + extension * k as Real / count as Real));
                radii.extend(std::iter::repeat_n(section.radius, count));
                from += extension;
            }
        }
        let points =
            self.frames(joints, &arc_lengths).into_iter().map(|frame| frame.translation).collect();
        Centreline { points, radii }
    }
}

/// A centreline as a chain of circular arcs.
#[derive(Clone, Debug)]
pub struct Curve {
    arcs: Vec<CurveArc>,
}

#[derive(Clone, Copy, Debug)]
struct CurveArc {
    from: Real,
    to: Real,
    place: Vector,
    /// The direction at its start.
    along: Vector,
    /// Towards its centre, as long as its curvature.
    inward: Vector,
    bend: Real,
}

impl Curve {
    /// Arcs that leave the origin along z one after the other, each of a length and a curvature
    /// vector in the frame that is carried along the curve without twist.
    pub(crate) fn joined(parts: impl Iterator<Item = (Real, Vector)>) -> Self {
        let (mut from, mut frame) = (0.0, Pose::IDENTITY);
        let arcs = parts.map(|(length, bend)| {
            let inward = frame.rotation * bend.cross(Vector::Z);
            let along = frame.rotation * Vector::Z;
            let part = CurveArc {
                from,
                to: from + length,
                place: frame.translation,
                along,
                inward,
                bend: bend.length(),
            };
            frame *= arc(bend, length);
            from += length;
            part
        });
        Self { arcs: arcs.collect() }
    }

    /// The point and the unit direction at an arc length.
    pub fn at(&self, arc_length: Real) -> (Vector, Vector) {
        let arc = self
            .arcs
            .iter()
            .find(|arc| arc_length <= arc.to)
            .unwrap_or(&self.arcs[self.arcs.len() - 1]);
        let length = arc_length - arc.from;
        let half = 0.5 * arc.bend * length;
        let (sin, cos) = half.sin_cos();
        let share = if half == 0.0 { 1.0 } else { sin / half };
        let place = arc.place
            + arc.along * (length * share * cos)
            + arc.inward * (0.5 * (length * share).powi(2));
        (place, arc.along * (1.0 - 2.0 * sin * sin) + arc.inward * (length * share * cos))
    }

    /// The largest curvature of what lies between two arc lengths.
    pub fn curvature(&self, from: Real, to: Real) -> Real {
        let there = self.arcs.iter().filter(|arc| arc.from < to && from < arc.to);
        there.fold(0.0, |most, arc| arc.bend.max(most))
    }
}

/// The motion along an arc of constant curvature vector (perpendicular to z) that leaves the origin
/// along z.
fn arc(curvature: Vector, length: Real) -> Pose {
    let bend = curvature.length();
    let angle = bend * length;
    // Towards the centre, sin and 1 - cos over the curvature; both are taken so that a straight
    // line needs no case.
    let inward = curvature.cross(Vector::Z);
    let half = 0.5 * angle;
    let along = length * sinc(angle);
    let across = 0.5 * length * length * sinc(half) * sinc(half);
    Pose::from_parts(
        Vector::Z * along + inward * across,
        Rot3::from_scaled_axis(curvature * length),
    )
}

/// sin x / x.
fn sinc(x: Real) -> Real {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}
