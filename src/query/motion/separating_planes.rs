//! Whether a piece keeps a margin from every triangle by itself, each in a direction of its own.
//!
//! The speed of a piece says how far it may move, and not where to. Where its course is known
//! (`half_displacement`), every triangle that is near enough to matter is parted from the body of
//! the moment by a plane, and the gap must be enough for what the piece goes towards that plane.
//! The nearest wall's direction alone would not do: what moves away from it moves into another one.
//!
//! A plane's normal leads from the triangle's nearest point to the body's. The normals found before
//! are tried first, the last one before the others: they part most of the triangles of the same
//! wall.

use super::half_displacement::{HalfDisplacement, gap};
use super::unresolved_piece::UnresolvedPiece;
use crate::pair::PlacedLink;
use crate::search::hierarchy::MeshSearch;
use parry3d_f64::math::{Real, Vector};

/// More triangles than this are not looked at: that would take longer than another shape.
const MAX_TRIANGLES: usize = 32;

/// So many normals are tried again.
const NORMALS: usize = 4;

/// What is asked of a body.
pub(super) struct PlaneTest<'a> {
    pub body: &'a PlacedLink,
    pub side: &'a HalfDisplacement,
    pub margin: Real,
    /// What rounding can do to any length.
    pub slack: Real,
}

impl PlaneTest<'_> {
    /// Whether a plane with this normal parts the body from a triangle by enough.
    fn separates(&self, corners: [Vector; 3], normal: Vector) -> bool {
        // Written so that NaN is not enough.
        gap(self.body, corners, normal) - self.margin - 2.0 * self.slack
            > self.side.gap_loss(normal)
    }

    /// The direction from a triangle to the body; nearer than rounding there may be none.
    fn normal(&self, triangle: u32, corners: [Vector; 3]) -> Vector {
        let nearest = self.body.measure(triangle, corners);
        (nearest.on_robot - nearest.on_mesh).normalize_or_zero()
    }
}

/// Memory that is used again.
#[derive(Clone, Default)]
pub(crate) struct SeparatingPlanes {
    triangles: Vec<u32>,
}

impl SeparatingPlanes {
    /// Whether the body keeps the margin all the time on that side of the middle shape; false if
    /// too many triangles are near it.
    pub(super) fn clears(
        &mut self,
        search: &mut MeshSearch,
        asked: &PlaneTest,
        failure: &UnresolvedPiece,
    ) -> bool {
        let mut normals = [Vector::ZERO; NORMALS];
        normals[0] = failure.normal;
        // Along the normal of the nearest triangle the gap is the distance.
        if failure.away - asked.margin - 2.0 * asked.slack <= asked.side.gap_loss(failure.normal) {
            return false;
        }
        let bound = asked.margin + asked.side.off + 2.0 * asked.slack;
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
