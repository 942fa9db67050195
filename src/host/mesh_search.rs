//! The closest triangle of a mesh, by the mesh's own bounding volume hierarchy.

use crate::pair::{Best, Nearest, PlacedLink};
use parry3d_f64::math::Real;
use parry3d_f64::partitioning::BvhLeafCost;
use parry3d_f64::shape::TriMesh;
use std::cell::Cell;

/// The error for a visited triangle with a vertex that is NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TriangleNotFinite;

/// When a search ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SearchGoal {
    /// When the nearest triangle is known.
    Nearest,
    /// When some triangle is nearer than the bound.
    FirstWithinBound,
}

/// Returns the triangle nearest to the link among those strictly nearer than `bound`.
///
/// Visits nearer boxes first and prunes boxes at least as far as the best triangle so far.
///
/// # Errors
/// A visited triangle is not finite.
pub(super) fn search(
    mesh: &TriMesh,
    link: &PlacedLink,
    bound: Real,
    until: SearchGoal,
) -> Result<Option<Nearest>, TriangleNotFinite> {
    let all_finite = Cell::new(true);
    let found = mesh.bvh().find_best(
        bound,
        |node, _| link.distance_to_box(node.mins(), node.maxs()),
        |triangle, bound| {
            let vertices = mesh.triangle(triangle).vertices().to_owned();
            if !vertices.iter().all(|vertex| vertex.is_finite()) {
                all_finite.set(false);
                return None;
            }
            let mut best = Best::within(bound);
            best.measure(link, triangle, vertices);
            let nearest = best.nearest()?;
            // A cost of 0 prunes everything else.
            let cost = if until == SearchGoal::FirstWithinBound { 0.0 } else { nearest.distance };
            Some(LeafCost { cost, nearest })
        },
    );
    if all_finite.get() {
        Ok(found.map(|(_, candidate)| candidate.nearest))
    } else {
        Err(TriangleNotFinite)
    }
}

struct LeafCost {
    cost: Real,
    nearest: Nearest,
}

impl BvhLeafCost for LeafCost {
    fn cost(&self) -> Real {
        self.cost
    }
}
