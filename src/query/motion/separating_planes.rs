//! Whether a piece keeps a margin on one side of the middle shape, by one separating plane per
//! triangle.
//!
//! The speed of a piece bounds how far it moves, not in which direction. If its displacement is
//! bounded (`half_displacement`), a plane separates the body in the middle shape from each triangle
//! that is near enough. Each gap must exceed what the displacement uses up. The normal of the
//! nearest triangle alone is not enough: a piece that leaves one wall may approach another.
//!
//! **Claim.** A triangle that is more than margin + `any_direction` + 2 slack from the swept body
//! never comes within the margin. **Proof.** The swept body contains the piece at every
//! displacement in the triangle (0, a, b). Relative to the mesh, every point of the piece stays
//! within `any_direction` of the swept body. So only the triangles within that distance of it are
//! gathered, and each of them must be separated.
//!
//! A plane's normal leads from the nearest point of the triangle to that of the body. Normals found
//! before are tried first, the latest one first: one normal separates most triangles of a wall.

use super::half_displacement::{HalfDisplacement, gap};
use super::pending_piece::UnresolvedPiece;
use crate::pair::PlacedLink;
use crate::search::hierarchy::PlacedMeshSearch;
use parry3d_f64::math::{Real, Vector};

/// With more triangles the test fails: another shape is cheaper.
const MAX_TRIANGLES: usize = 32;

/// How many normals are kept and tried again.
const NORMALS: usize = 4;

/// The displacement test of a body.
pub(super) struct PlaneTest<'a> {
    pub body: &'a PlacedLink,
    pub side: &'a HalfDisplacement,
    pub margin: Real,
    /// A bound on the rounding error of any length.
    pub slack: Real,
}

impl PlaneTest<'_> {
    /// Whether the plane with this normal separates body and triangle by more than the displacement
    /// uses up.
    fn separates(&self, corners: [Vector; 3], normal: Vector) -> bool {
        // This form makes NaN false.
        gap(self.body, corners, normal) - self.margin - 2.0 * self.slack
            > self.side.gap_loss(normal)
    }

    /// Returns the direction from a triangle to the body; zero within rounding.
    fn normal(&self, triangle: u32, corners: [Vector; 3]) -> Vector {
        let nearest = self.body.measure(triangle, corners);
        (nearest.on_robot - nearest.on_mesh).normalize_or_zero()
    }
}

/// Memory that is reused.
#[derive(Clone, Default)]
pub(crate) struct SeparatingPlanes {
    triangles: Vec<u32>,
}

impl SeparatingPlanes {
    /// Whether the body keeps the margin at all times of that side; false if too many triangles are
    /// near.
    pub(super) fn clears(
        &mut self,
        search: &mut PlacedMeshSearch,
        asked: &PlaneTest,
        unresolved: &UnresolvedPiece,
    ) -> bool {
        let mut normals = [Vector::ZERO; NORMALS];
        normals[0] = unresolved.normal;
        // Cheap: the nearest triangle must pass too. Along its normal the gap is the distance.
        if unresolved.away - asked.margin - 2.0 * asked.slack
            <= asked.side.gap_loss(unresolved.normal)
        {
            return false;
        }
        let bound = asked.margin + asked.side.any_direction + 2.0 * asked.slack;
        if !search.gather(
            &asked.side.swept_body(asked.body),
            bound,
            MAX_TRIANGLES,
            &mut self.triangles,
        ) {
            return false;
        }
        self.triangles.iter().all(|&triangle| {
            let corners = search.corners(triangle);
            if let Some(place) = normals.iter().position(|normal| asked.separates(corners, *normal))
            {
                normals[..=place].rotate_right(1);
                return true;
            }
            normals.rotate_right(1);
            normals[0] = asked.normal(triangle, corners);
            asked.separates(corners, normals[0])
        })
    }
}
