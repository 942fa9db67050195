//! A search in single precision whose answer is the double-precision one.
//!
//! The mesh is moved to its centre and multiplied by a power of two once, then rounded. A distance computed
//! from it errs by less than `error` = 64 u reach, where u = 2^-24 and reach is the largest coordinate of mesh
//! and link in that frame: 16 u for each unit of extent (at most 2 reach) from the kernel, and 2 u reach for
//! each of the roundings of vertices and axis, which move the shapes by that much. So the nearest triangle is
//! among those whose computed distance is within 2 `error` of the least, and only they are measured again.

use super::exhaustive;
use super::probe::Probe;
use super::search::Found;
use crate::distance::{Axial, Face, Link, Scalar, Vec3};
use parry3d_f64::math::{Real, Vector};

/// How many triangles may be left in question before the link is searched in double precision.
const CANDIDATES: usize = 64;

/// Links farther out than this many times the mesh's size are searched in double precision.
const FARTHEST: Real = 1024.0;

/// A mesh in single precision.
#[derive(Default)]
pub(super) struct CoarseMesh {
    triangles: Vec<[Vec3<f32>; 3]>,
    centre: Vector,
    scale: Real,
    /// Triangles whose lower bound does not rule them out, with that bound.
    candidates: Vec<(f32, u32)>,
    in_double: u64,
}

impl CoarseMesh {
    /// Takes over the triangles.
    pub(super) fn update(&mut self, triangles: &[[Vector; 3]]) {
        let points = || triangles.iter().flatten();
        let low = points().copied().reduce(Vector::min).unwrap_or_default();
        let high = points().copied().reduce(Vector::max).unwrap_or_default();
        self.centre = low + (high - low) * 0.5;
        self.scale = (high - low).max_element().power_of_two_to_unity();
        self.triangles.clear();
        let (centre, scale) = (self.centre, self.scale);
        self.triangles.extend(triangles.iter().map(|t| t.map(|vertex| round((vertex - centre) * scale))));
    }

    pub(super) fn links_searched_in_double(&self) -> u64 {
        self.in_double
    }

    /// The triangle nearest to the probe among those strictly nearer than `bound`, in the probe's units.
    pub(super) fn nearest(&mut self, triangles: &[[Vector; 3]], probe: &Probe, bound: Real) -> Option<Found> {
        if !self.collect(probe, bound) {
            self.in_double += 1;
            return exhaustive::nearest(triangles, probe, bound);
        }
        let mut best: Option<Found> = None;
        for &(_, triangle) in &self.candidates {
            let bound = best.map_or(bound, |found| found.closest.distance);
            if let Some(closest) = probe.nearer_than(bound, triangles[triangle as usize]) {
                best = Some(Found { triangle, closest });
            }
        }
        best
    }

    /// Fills `candidates`. False if single precision cannot settle the question.
    fn collect(&mut self, probe: &Probe, bound: Real) -> bool {
        self.candidates.clear();
        let [start, end] = probe.ends().map(|point| (point - self.centre) * self.scale);
        let unit = probe.scaled(1.0);
        let radius = probe.link().radius / unit * self.scale;
        let reach = start.abs().max(end.abs()).max_element().max(radius).max(1.0);
        if reach.is_nan() || reach > FARTHEST {
            return false;
        }
        let error = (64.0 * f32::UNIT_ROUNDOFF * reach) as f32;
        // The axis is rounded by itself: a link may be too short for single precision.
        let axis = Vector::from_array(probe.link().axis.into());
        let link = Link {
            end: round(end - start),
            axis: round(axis),
            radius: radius as f32,
            flat: probe.link().flat,
        };
        let start = round(start);
        // Everything nearer than `best` (or as near, within the error) stays in question.
        let mut best = (bound / unit * self.scale) as f32 + error;
        for (index, vertices) in self.triangles.iter().enumerate() {
            let face = Face::new(vertices.map(|vertex| vertex - start));
            let axial = Axial::new(&link, &face);
            let mut distance = axial.upper.distance;
            if axial.at_flat[0] || axial.at_flat[1] {
                distance = axial.plane_bound(&link, &face);
                if distance - error < best {
                    distance = axial.with_caps(&link, &face).distance;
                }
            }
            if distance - error <= best {
                best = best.min(distance + error);
                self.candidates.push((distance - error, index as u32));
                if self.candidates.len() > 2 * CANDIDATES {
                    self.candidates.retain(|&(lower, _)| lower <= best);
                    if self.candidates.len() > CANDIDATES {
                        return false;
                    }
                }
            }
        }
        self.candidates.retain(|&(lower, _)| lower <= best);
        true
    }
}

fn round(point: Vector) -> Vec3<f32> {
    Vec3::from(point.to_array().map(|value| value as f32))
}
