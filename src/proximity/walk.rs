//! A robot's way through the search: all its links, the closest of them, or only whether they keep away.

use super::LinkProximity;
use super::descent::Descent;
use super::placed::Placed;
use super::probe::Found;
use super::probe::{Probe, beyond};
use crate::robot::{Run, distance_to_segment};
use fearless_simd::Simd;
use parry3d_f64::math::Real;

/// A robot on its way through a mesh.
pub(super) struct Walk<'a> {
    pub descent: Descent<'a>,
    pub placed: &'a Placed<'a>,
}

impl Walk<'_> {
    /// The closest triangle of every link. `last` are the triangles to start with, link by link.
    pub(super) fn per_link<S: Simd>(&mut self, simd: S, last: &[u32], out: &mut Vec<LinkProximity>) {
        for link in 0..self.placed.links() {
            let before = out.last().map(|answer: &LinkProximity| answer.triangle);
            let start = [last.get(link).copied(), before];
            // Without a bound some triangle is always the nearest.
            if let Some((probe, found)) = self.nearest(simd, link, Real::INFINITY, start) {
                out.push(probe.report(link, &found));
            }
        }
    }

    fn nearest<S: Simd>(
        &mut self,
        simd: S,
        link: usize,
        bound: Real,
        start: [Option<u32>; 2],
    ) -> Option<(Probe, Found)> {
        let probe = self.placed.probe(link);
        let coarse = self.placed.coarse(link, &self.descent.mesh.tree.frame);
        let found = self.descent.nearest(simd, &probe, coarse.as_ref(), bound, start)?;
        Some((probe, found))
    }

    /// Whether any triangle may be nearer than `bound` to any link of a run; false only if none is.
    fn may_meet<S: Simd>(&mut self, simd: S, run: &Run, bound: Real) -> bool {
        let coarse = match run {
            Run::Links { envelope, .. } => {
                self.placed.coarse_envelope(envelope, &self.descent.mesh.tree.frame)
            }
            Run::Link(link) => self.placed.coarse(*link, &self.descent.mesh.tree.frame),
        };
        coarse.is_none_or(|coarse| self.descent.may_meet(simd, &coarse, bound))
    }

    /// The closest link and triangle. `last` are those to start with.
    pub(super) fn minimum<S: Simd>(
        &mut self,
        simd: S,
        last: Option<(usize, u32)>,
    ) -> Option<(usize, Probe, Found)> {
        let (first, triangle) = match last {
            Some((link, triangle)) if link < self.placed.links() => (link, triangle),
            _ => self.likely_minimum(simd),
        };
        let (probe, found) = self.nearest(simd, first, Real::INFINITY, [Some(triangle), None])?;
        let mut best = (first, probe, found);
        let runs = self.placed.runs();
        let mut place = 0;
        while let Some(run) = runs.get(place) {
            let bound = best.2.closest.distance;
            match run {
                Run::Links { inner, .. } if !self.may_meet(simd, run, bound) => place += inner,
                Run::Link(link) if *link != first => {
                    if let Some((probe, found)) = self.nearest(simd, *link, bound, [None, None]) {
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
    fn likely_minimum<S: Simd>(&mut self, simd: S) -> (usize, u32) {
        let Some((probe, envelope)) = self.placed.envelope_of_all() else { return (0, 0) };
        let coarse = self.placed.coarse_envelope(&envelope, &self.descent.mesh.tree.frame);
        let found = self.descent.nearest(simd, &probe, coarse.as_ref(), Real::INFINITY, [None, None]);
        let triangle = found.map_or(0, |found| found.triangle);
        let [a, b, c] = self.descent.mesh.corners(triangle);
        let centre = self.placed.in_robot_frame(a / 3.0 + b / 3.0 + c / 3.0);
        let distance = |link: usize| {
            let link = self.placed.link(link);
            distance_to_segment(centre, link.start(), link.end()) - link.radius()
        };
        let mut nearest = (0, distance(0));
        for link in 1..self.placed.links() {
            let other = distance(link);
            if other < nearest.1 {
                nearest = (link, other);
            }
        }
        (nearest.0, triangle)
    }

    /// Whether every link keeps more than `margin` away from the mesh.
    pub(super) fn clears<S: Simd>(&mut self, simd: S, margin: Real) -> bool {
        let bound = beyond(margin, self.placed.scale());
        let runs = self.placed.runs();
        let mut place = 0;
        while let Some(run) = runs.get(place) {
            if !self.may_meet(simd, run, bound) {
                if let Run::Links { inner, .. } = run {
                    place += inner;
                }
            } else if let Run::Link(link) = run
                && self.nearest(simd, *link, bound, [None, None]).is_some()
            {
                return false;
            }
            place += 1;
        }
        true
    }
}
