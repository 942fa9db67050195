//! Proximity by looking at every triangle, as the paper does on parallel hardware.

use super::coarse::CoarseMesh;
use super::probe::{Probe, check_vertices, place};
use super::search::Found;
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;
use std::marker::PhantomData;

/// Proximity queries that visit every triangle: the work grows with the number of triangles, and moving the
/// mesh costs only a copy.
///
/// `T` is the precision of the search, `f64` or `f32`. In `f32` every triangle that rounding leaves in question
/// is measured again in `f64`, so both return the double-precision answer. Every triangle is visited; bounds
/// spare those that cannot be the closest the computation of a flat cap's disc.
pub struct Exhaustive<T: SearchPrecision> {
    triangles: Vec<[Vector; 3]>,
    indices: Vec<[u32; 3]>,
    vertex_count: usize,
    /// The largest coordinate of the mesh.
    reach: Real,
    /// The mesh in single precision, for a search that starts there.
    coarse: Option<CoarseMesh>,
    probes: Vec<Probe>,
    precision: PhantomData<T>,
}

/// A precision in which [`Exhaustive`] can search: `f32` or `f64`.
pub trait SearchPrecision: sealed::Sealed {}

mod sealed {
    pub trait Sealed {
        const SINGLE: bool;
    }
    impl Sealed for f32 {
        const SINGLE: bool = true;
    }
    impl Sealed for f64 {
        const SINGLE: bool = false;
    }
}

impl SearchPrecision for f32 {}
impl SearchPrecision for f64 {}

impl<T: SearchPrecision> Exhaustive<T> {
    /// An engine for `mesh`, whose triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        let mut engine = Self {
            triangles: Vec::new(),
            indices: mesh.indices().to_vec(),
            vertex_count: mesh.vertices().len(),
            reach: 0.0,
            coarse: T::SINGLE.then(CoarseMesh::default),
            probes: Vec::new(),
            precision: PhantomData,
        };
        engine.set_vertices(mesh.vertices())?;
        Ok(engine)
    }

    /// The triangle nearest to the probe among those strictly nearer than `bound`, in the probe's units.
    fn nearest(&mut self, probe: &Probe, bound: Real) -> Option<Found> {
        match &mut self.coarse {
            Some(coarse) => coarse.nearest(&self.triangles, probe, bound),
            None => nearest(&self.triangles, probe, bound),
        }
    }

    fn place(&mut self, robot: &Chain, pose: &Pose) -> Result<Vec<Probe>, ProximityError> {
        let mut probes = std::mem::take(&mut self.probes);
        place(robot.links(), pose, self.reach, &mut probes).map(|()| probes)
    }
}

impl Exhaustive<f32> {
    /// How many links so far left more triangles in question than single precision can settle, and were
    /// searched in double precision instead.
    pub fn links_searched_in_double(&self) -> u64 {
        self.coarse.as_ref().map_or(0, CoarseMesh::links_searched_in_double)
    }
}

/// The triangle nearest to the probe among those strictly nearer than `bound`, in double precision.
pub(super) fn nearest(triangles: &[[Vector; 3]], probe: &Probe, mut bound: Real) -> Option<Found> {
    let mut best = None;
    for (triangle, &vertices) in triangles.iter().enumerate() {
        if let Some(closest) = probe.nearer_than(bound, vertices) {
            bound = closest.distance;
            best = Some(Found { triangle: triangle as u32, closest });
            if bound <= 0.0 {
                break;
            }
        }
    }
    best
}

impl<T: SearchPrecision> Proximity for Exhaustive<T> {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        let probes = self.place(robot, pose)?;
        for (link, probe) in probes.iter().enumerate() {
            // Without a bound some triangle is always the nearest.
            out.extend(self.nearest(probe, Real::INFINITY).map(|found| probe.report(link, &found)));
        }
        self.probes = probes;
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        let probes = self.place(robot, pose)?;
        let mut best = (0, Found { triangle: 0, closest: probes[0].closest(self.triangles[0]) });
        for (link, probe) in probes.iter().enumerate() {
            if let Some(found) = self.nearest(probe, best.1.closest.distance) {
                best = (link, found);
            }
        }
        let answer = probes[best.0].report(best.0, &best.1);
        self.probes = probes;
        Ok(answer)
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        if margin.is_nan() || margin < 0.0 {
            return Err(ProximityError::BadMargin { margin });
        }
        let probes = self.place(robot, pose)?;
        let clears = probes.iter().all(|probe| {
            // The next number, because the search wants triangles strictly nearer than its bound.
            self.nearest(probe, probe.scaled(margin).next_up()).is_none()
        });
        self.probes = probes;
        Ok(clears)
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        if vertices.len() != self.vertex_count {
            return Err(MeshError::VertexCount { expected: self.vertex_count, got: vertices.len() });
        }
        self.reach = check_vertices(vertices)?;
        self.triangles.clear();
        self.triangles.extend(self.indices.iter().map(|t| t.map(|index| vertices[index as usize])));
        if let Some(coarse) = &mut self.coarse {
            coarse.update(&self.triangles);
        }
        Ok(())
    }
}
