//! The tube in the mesh's frame.

use super::Piece;
use crate::distance::Scalar;
use crate::proximity::ProximityError;
use crate::proximity::placed::PlacedLink;
use crate::robot::{COORDINATE_LIMIT, Face, Section, Tube};
use parry3d_f64::math::{Pose, Real, Vector};

/// A tube at a pose in the frame of a mesh.
#[derive(Clone, Copy)]
pub(crate) struct PlacedTube<'a> {
    pub(super) tube: &'a Tube,
    pub(super) pose: &'a Pose,
    /// What rounding can do to any length that is computed here or measured.
    ///
    /// Every coordinate of the problem is at most `reach` = the tube's reach after the pose and the mesh's. A measured
    /// distance errs by 16 u for each unit of extent, which is at most 2 reach; a placed point by less than 16 u reach;
    /// and no bound here adds up more than a few such terms. 128 u reach is more than all of them.
    pub(super) slack: Real,
}

impl<'a> PlacedTube<'a> {
    /// # Errors
    /// The tube has no section, or the pose is not finite or moves it out of range.
    pub(crate) fn new(tube: &'a Tube, pose: &'a Pose, mesh_reach: Real) -> Result<Self, ProximityError> {
        if !pose.is_finite() {
            return Err(ProximityError::PoseNotFinite);
        }
        let radius = tube.sections().iter().fold(0.0, |radius: Real, section| radius.max(section.radius));
        // A rotation keeps lengths, and a length is at most twice the largest coordinate.
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach() + tube.error() + radius;
        if reach > COORDINATE_LIMIT {
            return Err(ProximityError::OutOfRange { link: 0, limit: COORDINATE_LIMIT });
        }
        if tube.sections().is_empty() {
            return Err(ProximityError::EmptyTube);
        }
        let slack = 128.0 * Real::UNIT_ROUNDOFF * (reach + mesh_reach);
        Ok(Self { tube, pose, slack })
    }

    pub(crate) fn sections(&self) -> &'a [Section] {
        self.tube.sections()
    }

    pub(super) fn section(&self, number: u32) -> &'a Section {
        &self.tube.sections()[number as usize]
    }

    /// A point of the centreline in the mesh's frame.
    pub(super) fn point(&self, section: &Section, tick: u32) -> Vector {
        self.pose * self.tube.point(section, tick)
    }

    pub(crate) fn slack(&self) -> Real {
        self.slack
    }

    /// The radius of a piece.
    pub(crate) fn radius(&self, piece: &Piece) -> Real {
        self.section(piece.section).radius
    }

    /// A point of the centreline, or one between two samples nearby.
    pub(crate) fn place_at(&self, section: u32, arc: Real) -> Vector {
        let section = self.section(section);
        self.point(section, self.tube.tick(section, arc))
    }

    /// The line between the ends of a section, and their arc lengths.
    pub(crate) fn chord(&self, section: u32) -> (PlacedLink, [Real; 2]) {
        let section = self.section(section);
        let ends = [section.first, section.last].map(|tick| self.point(section, tick));
        (PlacedLink::between(ends[0], ends[1], 0.0, [false; 2]), [section.start, section.end])
    }

    /// A flat end in the mesh's frame.
    pub(super) fn face(&self, face: &Face) -> Face {
        Face { centre: self.pose * face.centre, outward: self.pose.rotation * face.outward, ..*face }
    }
}
