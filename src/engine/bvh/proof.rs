//! Proofs that others can check, as [`BvhSearch`] writes them.
//!
//! # Algorithm
//! 1. Decide by the query itself. Without `Clear` there is no proof.
//! 2. Divide the robot into convex bodies, and search separating planes between the bodies and the
//!    triangles ([`PlaneSearch`]).
//! 3. For a tube, divide it more finely while planes are missing. The excess of the bodies goes
//!    from 1/16 of the tube's length down to 1/4 of the resolution, by a factor of 4.

use super::search::BvhSearch;
use crate::answer::{Decision, Proof, ProximityError};
use crate::curve::Tube;
use crate::engine::Proximity;
use crate::motion::Motion;
use crate::pair::PlacedRobot;
use crate::query::proof::{
    Kind, MAX_BYTES, MIN_PIECE_BYTES, PlaneSearch, Shape, motion_proof, size_of, tube_shape,
    write_proof,
};
use crate::refine::PlacedTube;
use crate::robot::Chain;
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real};

impl BvhSearch {
    /// Proves that the robot is farther than `margin` from the mesh, for readers who do not trust
    /// this library.
    ///
    /// The proof is a text that a short program in plain Python checks. The [page on
    /// proofs](crate::book::proofs) has both. `None` if the robot does not keep the margin, or
    /// exceeds it by at most rounding. Also `None` if a link does not begin where the one before it
    /// ends, because a segment between the two was too short to be a link.
    ///
    /// The proof does not cover the side of the wall: [`side`](Self::side) answers that. The
    /// program prints this, and the premises.
    ///
    /// The work is that of many queries: a proof is for a plan that is signed off, not for a loop.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// let proof = search.prove(&robot, &Pose::IDENTITY, 1.0)?.ok_or("not clear")?;
    /// assert!(proof.planes() < 100 && proof.to_string().starts_with("proof of clearance 2\n"));
    /// // std::fs::write("proof.txt", proof.to_string())?;
    /// assert_eq!(search.prove(&robot, &Pose::IDENTITY, 6.0)?, None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    pub fn prove(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
    ) -> Result<Option<Proof>, ProximityError> {
        if !self.clears(robot, pose, margin)? {
            return Ok(None);
        }
        let shape = Shape::of_chain(PlacedRobot::new(robot, pose)?);
        let mut plane_search = self.plane_search();
        Ok(shape.and_then(|shape| {
            let steps = plane_search.steps(&shape.bodies(margin))?;
            Some(write_proof(plane_search.mesh(), margin, Kind::Chain, &[(shape, steps)]))
        }))
    }

    /// [`prove`](Self::prove) for a tube.
    ///
    /// The checking program prints the premises about the curve: points, and upper bounds on its
    /// length and bend between them. `None` if the tube does not keep the margin, or keeps it by at
    /// most `resolution`. Also `None` if the proof would be longer than 16 MiB.
    ///
    /// # Errors
    /// As [`clears_tube`](Self::clears_tube).
    pub fn prove_tube(
        &mut self,
        tube: &Tube,
        pose: &Pose,
        margin: Real,
        resolution: Real,
    ) -> Result<Option<Proof>, ProximityError> {
        if self.clears_tube(tube, pose, margin, resolution)? != Decision::Clear {
            return Ok(None);
        }
        let placed = PlacedTube::new(tube, pose, self.prepared().hierarchy.mesh_reach)?;
        let mut plane_search = self.plane_search();
        // Step 3: coarse pieces first, finer ones as long as planes are missing.
        let finest = (0.25 * resolution).max(placed.slack());
        let mut over = tube.length() / 16.0;
        // As in the decision, the ends may be rounded instead of turned.
        let ways = [Some(placed), placed.without_turn()];
        loop {
            for placed in ways.iter().flatten() {
                let (shape, _) = tube_shape(placed, over, false);
                // Finer pieces only make the proof longer.
                if shape.pieces.len() > MAX_BYTES / MIN_PIECE_BYTES {
                    return Ok(None);
                }
                if let Some(steps) = plane_search.steps(&shape.bodies(margin)) {
                    let parted = (shape, steps);
                    let is_short = size_of(Kind::Tube, &parted) <= MAX_BYTES;
                    let write = || write_proof(plane_search.mesh(), margin, Kind::Tube, &[parted]);
                    return Ok(is_short.then(write));
                }
            }
            if over <= finest {
                return Ok(None);
            }
            over = (0.25 * over).max(finest);
        }
    }

    /// [`prove`](Self::prove) for a motion: the robot is farther than `margin` at every time from 0
    /// to 1.
    ///
    /// The speeds that the motion states are premises of the proof, and printed. `None` if some
    /// shape does not keep the margin, or keeps it by at most about `resolution`. Also `None` if
    /// 65,536 tested shapes do not prove it, or if the proof would be longer than 16 MiB. A shape
    /// takes 0.2 to 2 kB, so a motion that needs many shapes has a long proof.
    ///
    /// ```
    /// use parry_continuum::{LinearMotion, parry::{math::Vector, shape::Ball}};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let (from, to) = ([Vector::ZERO, Vector::Z * 4.0], [Vector::ZERO, Vector::X * 4.0]);
    /// let motion = LinearMotion::chain(&from, &to, &[1.0])?;
    /// let proof = search.prove_motion(&motion, 1.0, 0.01)?.ok_or("not clear")?;
    /// assert!(proof.shapes() >= 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`clears_motion`](Self::clears_motion).
    pub fn prove_motion(
        &mut self,
        motion: &impl Motion,
        margin: Real,
        resolution: Real,
    ) -> Result<Option<Proof>, ProximityError> {
        if !self.clears_motion(motion, margin, resolution)?.is_clear() {
            return Ok(None);
        }
        let reach = self.prepared().hierarchy.mesh_reach;
        let mut plane_search = self.plane_search();
        let shapes = motion_proof(&mut plane_search, reach, motion, margin, resolution, MAX_BYTES)?;
        Ok(shapes.map(|shapes| write_proof(plane_search.mesh(), margin, Kind::Motion, &shapes)))
    }

    fn plane_search(&self) -> PlaneSearch<'_> {
        PlaneSearch::new(Level::new(), &self.prepared().hierarchy.mesh)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::LinearMotion;
    use parry3d_f64::math::Vector;
    use parry3d_f64::shape::Ball;

    /// A proof of a motion ends where its shapes and steps need more than the permitted bytes.
    #[test]
    fn a_proof_of_a_motion_has_a_largest_size() {
        let (vertices, triangles) = Ball::new(10.0).to_trimesh(16, 8);
        let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
        let (from, to) = ([Vector::ZERO, Vector::Z * 4.0], [Vector::ZERO, Vector::X * 4.0]);
        let motion = LinearMotion::chain(&from, &to, &[1.0]).unwrap();
        assert!(search.prove_motion(&motion, 1.0, 0.01).unwrap().is_some());
        let reach = search.prepared().hierarchy.mesh_reach;
        let mut plane_search = search.plane_search();
        let mut proof =
            |most| motion_proof(&mut plane_search, reach, &motion, 1.0, 0.01, most).unwrap();
        let shapes = proof(MAX_BYTES).unwrap();
        let bytes = shapes.iter().map(|shape| size_of(Kind::Motion, shape)).sum();
        assert_eq!(proof(bytes).map(|shapes| shapes.len()), Some(shapes.len()));
        assert!(proof(bytes - 1).is_none(), "{bytes}");
    }
}
