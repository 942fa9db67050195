//! Measures triangles on the CPU in double precision: the device's candidates, or all.

use super::candidates::CandidateTriangle;
use crate::mesh::Mesh;
use crate::pair::{Best, Nearest, PlacedLink};
use crate::threads::each;
use parry3d_f64::math::Real;

/// The least distance that the device computed.
pub(super) fn least_distance(candidates: &[CandidateTriangle]) -> Real {
    candidates.iter().map(|candidate| candidate.distance).fold(Real::INFINITY, Real::min)
}

/// The nearest of some triangles, if it is at most `bound` away. Once a triangle touches, only
/// lower triangles are measured.
pub(super) fn nearest_of(
    link: &PlacedLink,
    triangles: impl Iterator<Item = u32>,
    bound: Real,
    mesh: &Mesh,
) -> Option<Nearest> {
    let mut best = Best::within(bound);
    for triangle in triangles {
        if triangle < best.triangle_limit() {
            best.measure(link, triangle, mesh.corners(triangle));
        }
    }
    best.nearest()
}

/// Triangles per task of the CPU.
const TASK_SIZE: usize = 4096;

/// The nearest of all triangles, if it is at most `bound` away.
pub(super) fn nearest_of_all(link: &PlacedLink, bound: Real, mesh: &Mesh) -> Option<Nearest> {
    let mut shares = vec![None; mesh.len().div_ceil(TASK_SIZE)];
    each(&mut shares, |share, nearest| {
        let triangles = share * TASK_SIZE..mesh.len().min((share + 1) * TASK_SIZE);
        *nearest = nearest_of(link, triangles.map(|triangle| triangle as u32), bound, mesh);
    });
    let mut best = Best::within(bound);
    shares.into_iter().flatten().for_each(|nearest| {
        best.take(nearest);
    });
    best.nearest()
}
