//! Proximity by a bounding volume hierarchy.

use super::descent::{Descent, Visits};
use super::placed::Placed;
use super::probe::{Probe, check_vertices};
use super::search::Found;
use super::{LinkProximity, MeshError, Proximity, ProximityError};
use crate::Chain;
use crate::distance::lanes::{Lane, Pack};
use crate::robot::{Run, distance_to_segment};
use fearless_simd::{Level, dispatch};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::shape::TriMesh;

/// Proximity queries by a bounding volume hierarchy: the work per link grows with the logarithm of the number of
/// triangles.
///
/// The engine keeps the mesh and a hierarchy of its own, 16 patches and 16 triangles wide, in single precision;
/// what rounding leaves in question is measured in double precision, so the answers are those of
/// [`Exhaustive`](super::Exhaustive). It remembers the last answers, which bound the next query: any robot and
/// pose may follow, and small motions are answered fastest. [`BvhSearch::forget`] makes it cold again.
pub struct BvhSearch {
    level: Level,
    /// The largest coordinate of the mesh.
    reach: Real,
    descent: Descent,
    /// The closest triangle of each link at the last query, where there was one.
    last: Vec<u32>,
    /// The closest link and its triangle at the last query for the minimum.
    last_minimum: Option<(usize, u32)>,
}

impl BvhSearch {
    /// An engine for `mesh`, whose vertices and triangles are copied.
    ///
    /// # Errors
    /// The mesh has no triangles, or a vertex is not finite or out of range.
    pub fn new(mesh: &TriMesh) -> Result<Self, MeshError> {
        if mesh.indices().is_empty() {
            return Err(MeshError::Empty);
        }
        let reach = check_vertices(mesh.vertices())?;
        let descent = Descent::new(mesh.vertices(), mesh.indices());
        Ok(Self { level: Level::new(), reach, descent, last: Vec::new(), last_minimum: None })
    }

    /// Forgets the last answers, so that the next query starts without bounds.
    pub fn forget(&mut self) {
        self.last.clear();
        self.last_minimum = None;
    }

    /// How much was computed since the engine was built.
    pub fn visits(&self) -> Visits {
        self.descent.visits
    }

    #[inline(always)]
    fn per_link_in<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        placed: &Placed,
        out: &mut Vec<LinkProximity>,
    ) {
        for link in 0..placed.links() {
            let before = out.last().map(|answer: &LinkProximity| answer.triangle);
            let start = [self.last.get(link).copied(), before];
            // Without a bound some triangle is always the nearest.
            if let Some((probe, found)) = self.nearest::<L>(token, placed, link, Real::INFINITY, start) {
                out.push(probe.report(link, &found));
            }
        }
    }

    #[inline(always)]
    fn nearest<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        placed: &Placed,
        link: usize,
        bound: Real,
        start: [Option<u32>; 2],
    ) -> Option<(Probe, Found)> {
        let probe = placed.probe(link);
        let coarse = placed.coarse(link, &self.descent.tree.frame);
        let found = self.descent.nearest::<L>(token, &probe, coarse.as_ref(), bound, start)?;
        Some((probe, found))
    }

    /// Whether any triangle may be nearer than `bound` to any link of a run; false only if none is.
    #[inline(always)]
    fn may_meet<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        placed: &Placed,
        run: &Run,
        bound: Real,
    ) -> bool {
        let coarse = match run {
            Run::Links { envelope, .. } => placed.coarse_envelope(envelope, &self.descent.tree.frame),
            Run::Link(link) => placed.coarse(*link, &self.descent.tree.frame),
        };
        coarse.is_none_or(|coarse| self.descent.may_meet::<L>(token, &coarse, bound))
    }

    /// The nearest link and triangle among those nearer than `best`, where there is a best.
    #[inline(always)]
    fn minimum_in<L: Pack<Element = f32>>(
        &mut self,
        token: L::Token,
        placed: &Placed,
    ) -> Option<(usize, Probe, Found)> {
        let (first, triangle) = match self.last_minimum {
            Some((link, triangle)) if link < placed.links() => (link, triangle),
            _ => self.likely_minimum::<L>(token, placed),
        };
        let (probe, found) =
            self.nearest::<L>(token, placed, first, Real::INFINITY, [Some(triangle), None])?;
        let mut best = (first, probe, found);
        let runs = placed.runs();
        let mut place = 0;
        while let Some(run) = runs.get(place) {
            let bound = best.2.closest.distance;
            match run {
                Run::Links { inner, .. } if !self.may_meet::<L>(token, placed, run, bound) => place += inner,
                Run::Link(link) if *link != first => {
                    let start = [Some(best.2.triangle), None];
                    if let Some((probe, found)) = self.nearest::<L>(token, placed, *link, bound, start) {
                        best = (*link, probe, found);
                    }
                }
                _ => {}
            }
            place += 1;
        }
        Some(best)
    }

    /// The triangle nearest to the capsule around the robot, and the link nearest to that triangle.
    #[inline(always)]
    fn likely_minimum<L: Pack<Element = f32>>(&mut self, token: L::Token, placed: &Placed) -> (usize, u32) {
        let Some((probe, envelope)) = placed.envelope_of_all() else { return (0, 0) };
        let coarse = placed.coarse_envelope(&envelope, &self.descent.tree.frame);
        let found = self.descent.nearest::<L>(token, &probe, coarse.as_ref(), Real::INFINITY, [None, None]);
        let triangle = found.map_or(0, |found| found.triangle);
        let [a, b, c] = self.descent.indices[triangle as usize].map(|v| self.descent.vertices[v as usize]);
        let centre = placed.in_robot_frame(a / 3.0 + b / 3.0 + c / 3.0);
        let distance = |link: usize| {
            let link = placed.link(link);
            distance_to_segment(centre, link.start(), link.end()) - link.radius()
        };
        let mut nearest = (0, distance(0));
        for link in 1..placed.links() {
            let other = distance(link);
            if other < nearest.1 {
                nearest = (link, other);
            }
        }
        (nearest.0, triangle)
    }

    #[inline(always)]
    fn clears_in<L: Pack<Element = f32>>(&mut self, token: L::Token, placed: &Placed, margin: Real) -> bool {
        // The next number, because the search wants triangles strictly nearer than its bound.
        let bound = (margin * placed.scale()).next_up();
        let runs = placed.runs();
        let mut place = 0;
        while let Some(run) = runs.get(place) {
            if !self.may_meet::<L>(token, placed, run, bound) {
                if let Run::Links { inner, .. } = run {
                    place += inner;
                }
            } else if let Run::Link(link) = run {
                if self.nearest::<L>(token, placed, *link, bound, [None, None]).is_some() {
                    return false;
                }
            }
            place += 1;
        }
        true
    }
}

impl Proximity for BvhSearch {
    fn per_link(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        out.clear();
        let placed = Placed::new(robot, pose, self.reach)?;
        dispatch!(self.level, simd => self.per_link_in::<<f32 as Lane>::Pack<_>>(simd, &placed, out));
        self.last.clear();
        self.last.extend(out.iter().map(|answer| answer.triangle));
        Ok(())
    }

    fn minimum(&mut self, robot: &Chain, pose: &Pose) -> Result<LinkProximity, ProximityError> {
        let placed = Placed::new(robot, pose, self.reach)?;
        let found = dispatch!(self.level, simd => self.minimum_in::<<f32 as Lane>::Pack<_>>(simd, &placed));
        let (link, probe, found) = found.unwrap_or_else(|| {
            // Without a bound some triangle is always the nearest; this is any other.
            let probe = placed.probe(0);
            let corners = self.descent.indices[0].map(|vertex| self.descent.vertices[vertex as usize]);
            (0, probe, Found { triangle: 0, closest: probe.closest(corners) })
        });
        self.last_minimum = Some((link, found.triangle));
        Ok(probe.report(link, &found))
    }

    fn clears(&mut self, robot: &Chain, pose: &Pose, margin: Real) -> Result<bool, ProximityError> {
        if margin.is_nan() || margin < 0.0 {
            return Err(ProximityError::BadMargin { margin });
        }
        let placed = Placed::new(robot, pose, self.reach)?;
        Ok(dispatch!(self.level, simd => self.clears_in::<<f32 as Lane>::Pack<_>>(simd, &placed, margin)))
    }

    fn set_vertices(&mut self, vertices: &[Vector]) -> Result<(), MeshError> {
        let expected = self.descent.vertices.len();
        if vertices.len() != expected {
            return Err(MeshError::VertexCount { expected, got: vertices.len() });
        }
        self.reach = check_vertices(vertices)?;
        self.descent.set_vertices(vertices);
        Ok(())
    }
}
