//! Triangles measured on the CPU in double precision: the device's candidates, or all.

use super::candidates::Candidate;
use crate::proximity::{Found, Probe, each};
use parry3d_f64::math::{Real, Vector};

/// The least distance that the device computed.
pub(super) fn least_distance(candidates: &[Candidate]) -> Real {
    candidates.iter().map(|candidate| candidate.distance).fold(Real::INFINITY, Real::min)
}

/// The nearest of some triangles, of those strictly nearer than `bound`; the first if several are. A distance of 0
/// ends the search.
pub(super) fn nearest_of(
    probe: &Probe,
    triangles: impl Iterator<Item = u32>,
    bound: Real,
    vertices: &[Vector],
    indices: &[[u32; 3]],
) -> Option<Found> {
    let (mut bound, mut nearest) = (bound, None);
    for triangle in triangles {
        let corners = indices[triangle as usize].map(|index| vertices[index as usize]);
        if let Some(closest) = probe.nearer_than(bound, corners) {
            bound = closest.distance;
            nearest = Some(Found { triangle, closest });
            if bound <= 0.0 {
                break;
            }
        }
    }
    nearest
}

/// Triangles that a core of the CPU takes at a time.
const SHARE: usize = 4096;

/// The nearest of all triangles.
pub(super) fn nearest_of_all(
    probe: &Probe,
    bound: Real,
    vertices: &[Vector],
    indices: &[[u32; 3]],
) -> Option<Found> {
    let mut shares: Vec<Option<Found>> = vec![None; indices.len().div_ceil(SHARE)];
    each(&mut shares, |share, nearest| {
        let triangles = share * SHARE..indices.len().min((share + 1) * SHARE);
        *nearest = nearest_of(probe, triangles.map(|triangle| triangle as u32), bound, vertices, indices);
    });
    shares.into_iter().flatten().min_by(|a, b| a.closest.distance.total_cmp(&b.closest.distance))
}
