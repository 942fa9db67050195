//! The closest triangle of a mesh, by the mesh's own bounding volume hierarchy.

use crate::distance::Closest;
use crate::proximity::{Found, Probe};
use parry3d_f64::math::Real;
use parry3d_f64::partitioning::BvhLeafCost;
use parry3d_f64::shape::TriMesh;
use std::cell::Cell;

/// A triangle that the search visited has a vertex that is NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TriangleNotFinite;

/// How far a search goes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Until {
    /// The nearest triangle is known.
    Nearest,
    /// Some triangle is nearer than the bound.
    FirstWithinBound,
}

/// The triangle nearest to the probe among those strictly nearer than `bound`, which is in the probe's units.
///
/// Nearer boxes go first, and boxes no nearer than the best triangle so far are left out.
pub(super) fn search(
    mesh: &TriMesh,
    probe: &Probe,
    bound: Real,
    until: Until,
) -> Result<Option<Found>, TriangleNotFinite> {
    let all_finite = Cell::new(true);
    let found = mesh.bvh().find_best(
        bound,
        |node, _| probe.distance_to_box(node.mins(), node.maxs()),
        |triangle, best| {
            let vertices = mesh.triangle(triangle).vertices().to_owned();
            if !vertices.iter().all(|vertex| vertex.is_finite()) {
                all_finite.set(false);
                return None;
            }
            let closest = probe.nearer_than(best, vertices)?;
            // A cost of 0 makes the hierarchy leave out everything else.
            let cost = if until == Until::FirstWithinBound { 0.0 } else { closest.distance };
            Some(Candidate { cost, closest })
        },
    );
    if all_finite.get() {
        Ok(found.map(|(triangle, candidate)| Found { triangle, closest: candidate.closest }))
    } else {
        Err(TriangleNotFinite)
    }
}

struct Candidate {
    cost: Real,
    closest: Closest<f64>,
}

impl BvhLeafCost for Candidate {
    fn cost(&self) -> Real {
        self.cost
    }
}
