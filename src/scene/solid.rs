//! Solid structures: a robot inside of one is in contact with it.
//!
//! # Definitions
//! - *solid*: a structure whose mesh bounds a volume, which belongs to the structure. The mesh is
//!   closed: each edge has as many triangles that pass it one way as the other.
//! - The distance of a robot from a solid is 0 if they share a point. Otherwise it is the distance
//!   from the surface.
//! - w: the winding number of the mesh. Inside it is not 0.
//!
//! # Claim
//! Let a robot keep a positive distance from the surface, at every time of a motion. Then all of
//! its points are on one side of the surface at all times. So one point at one time decides.
//!
//! **Proof.**
//! 1. Off a closed surface w is an integer. It depends continuously on the point, and on the
//!    vertices if the structure moves. So it is constant along every curve that avoids the surface.
//! 2. A robot is connected: a curve within it joins any two of its points. Its centreline moves
//!    continuously. So w is the same for all points and times.
//!
//! A kept margin implies a positive distance, even if the margin is 0: it is proven to be exceeded.
//! For a tube with a stated error, the proof holds for all tubes within the error. They include the
//! stated centreline, which decides.
//!
//! # Where the surface decides nothing
//! A point of the robot that is proven to be inside is a contact even if the query about the
//! surface decides nothing. The points of a tube are known only if it states no error.
//!
//! **Rounding.** A point that rounding cannot tell from the surface has no side; the next point is
//! tried. A robot without any sided point counts as inside where the answer is a yes or no or a
//! distance, and as `Undecided` elsewhere. All of its points are then within rounding of the
//! surface.

use super::structure::Structure;
use crate::answer::{Clearance, Decision, ProximityError, SceneError, Side, Witness};
use crate::curve::Tube;
use crate::pair::PlacedRobot;
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};

impl Structure {
    /// # Errors
    /// The structure is solid, and its mesh bounds no volume.
    pub fn check_solid(&self) -> Result<(), SceneError> {
        if !self.is_solid {
            return Ok(());
        }
        let surface = self.search.surface();
        if surface.bounds_volume() {
            return Ok(());
        }
        Err(SceneError::NotSolid {
            name: self.name.clone(),
            open_edges: surface.openings.iter().map(|opening| opening.edges).sum(),
            unbalanced_edges: surface.unbalanced_edges,
        })
    }

    /// Checks that a solid is still closed if its vertices move to these places.
    ///
    /// # Errors
    /// As [`check_solid`](Self::check_solid), or the vertices do not fit the mesh.
    pub fn check_solid_at(&self, vertices: &[Vector]) -> Result<(), SceneError> {
        if !self.is_solid {
            return Ok(());
        }
        let mut moved = self.clone();
        moved.set_vertices(vertices).map_err(|error| SceneError::Structure {
            name: self.name.clone(),
            error: error.into(),
        })?;
        moved.check_solid()
    }

    /// Returns whether a robot that does not touch the structure's surface is inside, if the
    /// structure is solid. `pose` maps the robot's frame to the mesh's frame.
    ///
    /// # Errors
    /// The pose is not rigid, or moves a link out of range.
    pub fn contains(&self, chain: &Chain, pose: &Pose) -> Result<bool, ProximityError> {
        if !self.is_solid {
            return Ok(false);
        }
        let robot = PlacedRobot::new(chain, pose)?;
        let mut ends = robot.ends().into_iter().chain(robot.placed_links().map(|link| link.end()));
        Ok(self.around.at_least(&robot) <= 0.0 && self.side(&mut ends) != Side::Outside)
    }

    /// Returns the side of the first point that has one.
    fn side(&self, points: &mut dyn Iterator<Item = Vector>) -> Side {
        let sides = points.map(|point| self.search.side(point));
        sides.into_iter().find(|side| *side != Side::Undecided).unwrap_or(Side::Undecided)
    }

    /// Returns the side of a tube if it decides about a solid; otherwise `Outside`, and the surface
    /// decides. `is_apart`: the tube provably does not touch the surface. `pose` maps the tube's
    /// frame to the mesh's frame.
    pub fn side_of_tube(&self, tube: &Tube, pose: &Pose, is_apart: bool) -> Side {
        if !self.is_solid {
            return Side::Outside;
        }
        let mut points = tube.sections().iter().flat_map(|section| {
            [section.first, section.last].map(|tick| pose * tube.point(section, tick))
        });
        match self.side(&mut points) {
            Side::Inside if is_apart || tube.error() == 0.0 => Side::Inside,
            Side::Undecided if is_apart => Side::Undecided,
            _ => Side::Outside,
        }
    }

    /// Returns the decision about a solid and a tube, given the decision about its surface.
    pub fn decide_tube(
        &self,
        of_surface: Result<Decision, ProximityError>,
        tube: &Tube,
        pose: &Pose,
    ) -> Result<Decision, ProximityError> {
        if of_surface == Ok(Decision::Contact) {
            return of_surface;
        }
        match self.side_of_tube(tube, pose, of_surface == Ok(Decision::Clear)) {
            Side::Outside => of_surface,
            Side::Inside => Ok(Decision::Contact),
            Side::Undecided => Ok(Decision::Undecided),
        }
    }

    /// Returns the clearance of a solid and a tube, given the clearance of its surface.
    ///
    /// # Errors
    /// As [`BvhSearch::clearance`](crate::proximity::BvhSearch::clearance).
    pub fn clearance_of_tube(
        &mut self,
        of_surface: Clearance,
        tube: &Tube,
        pose: &Pose,
    ) -> Result<Clearance, ProximityError> {
        match self.side_of_tube(tube, pose, of_surface.lower > 0.0) {
            Side::Outside => Ok(of_surface),
            Side::Inside => self.clearance_inside(tube, pose),
            Side::Undecided => Ok(Clearance { lower: 0.0, ..of_surface }),
        }
    }

    /// Returns the clearance of a tube inside of a solid.
    ///
    /// # Errors
    /// As [`BvhSearch::clearance`](crate::proximity::BvhSearch::clearance).
    pub fn clearance_inside(
        &mut self,
        tube: &Tube,
        pose: &Pose,
    ) -> Result<Clearance, ProximityError> {
        let frame = self.frame();
        let mut found = self.search.ask_clearance(tube, pose, Real::INFINITY, frame)?;
        found.witness = common_point(found.witness);
        Ok(Clearance { lower: 0.0, upper: 0.0, resolved: true, uncertainty: 0.0, ..found })
    }
}

/// The witness of a robot inside a solid: its nearest point to the surface belongs to both.
pub(super) fn common_point(witness: Witness) -> Witness {
    Witness { on_mesh: witness.on_robot, ..witness }
}
