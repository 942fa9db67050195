//! A robot at a pose, whose links are placed in the mesh's frame when they are needed.

use super::ProximityError;
use super::coarse::{CoarseFrame, CoarseLink};
use super::probe::{Probe, scale_for};
use crate::robot::{Cap, Chain, Envelope, ModifiedCylinder, Run};
use parry3d_f64::math::{Pose, Real, Vector};

/// A robot at a pose in the frame of a mesh.
pub(super) struct Placed<'a> {
    robot: &'a Chain,
    pose: &'a Pose,
    /// The power of two that brings mesh and robot near one: the unit of probes and bounds.
    scale: Real,
}

impl<'a> Placed<'a> {
    /// `mesh_reach` is the largest coordinate of the mesh.
    ///
    /// # Errors
    /// The pose is not finite or moves a link out of range.
    pub(super) fn new(robot: &'a Chain, pose: &'a Pose, mesh_reach: Real) -> Result<Self, ProximityError> {
        Ok(Self { robot, pose, scale: scale_for(robot, pose, mesh_reach)? })
    }

    pub(super) fn scale(&self) -> Real {
        self.scale
    }

    pub(super) fn links(&self) -> usize {
        self.robot.links().len()
    }

    pub(super) fn link(&self, link: usize) -> &ModifiedCylinder {
        &self.robot.links()[link]
    }

    pub(super) fn runs(&self) -> &'a [Run] {
        self.robot.runs()
    }

    pub(super) fn in_robot_frame(&self, point: Vector) -> Vector {
        self.pose.inverse_transform_point(point)
    }

    pub(super) fn probe(&self, link: usize) -> Probe {
        Probe::new(self.link(link), self.pose, self.scale)
    }

    pub(super) fn coarse(&self, link: usize, frame: &CoarseFrame) -> Option<CoarseLink<f32>> {
        let link = self.link(link);
        let flat = link.caps().map(|cap| cap == Cap::Flat);
        self.coarse_between(link.start(), link.end(), link.radius(), flat, frame)
    }

    pub(super) fn coarse_envelope(
        &self,
        envelope: &Envelope,
        frame: &CoarseFrame,
    ) -> Option<CoarseLink<f32>> {
        self.coarse_between(envelope.start, envelope.end, envelope.radius, [false; 2], frame)
    }

    fn coarse_between(
        &self,
        start: Vector,
        end: Vector,
        radius: Real,
        flat: [bool; 2],
        frame: &CoarseFrame,
    ) -> Option<CoarseLink<f32>> {
        CoarseLink::between(self.pose * start, self.pose * end, radius, flat, self.scale, frame)
    }

    /// The capsule around the whole robot, if it has more than one link.
    pub(super) fn envelope_of_all(&self) -> Option<(Probe, Envelope)> {
        let Some(Run::Links { envelope, .. }) = self.runs().first() else { return None };
        let capsule = ModifiedCylinder::capsule(envelope.start, envelope.end, envelope.radius).ok()?;
        Some((Probe::new(&capsule, self.pose, self.scale), *envelope))
    }
}
