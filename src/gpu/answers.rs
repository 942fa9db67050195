//! From robots to answers: the device finds candidates, the CPU measures them.
//!
//! # Definitions
//! - c(t): the distance of triangle t, as the device computed it; d(t): the exact value.
//! - e: the bound on the error, |c(t) - d(t)| <= e ([`DeviceLink::error`]).
//!
//! # Claim
//! The nearest triangle is among the candidates with c(t) <= min c + 2 e, if no candidates were
//! lost.
//! **Proof.** Let c be least at s, and let t be the nearest. Then c(t) <= d(t) + e <= d(s) + e <=
//! c(s) + 2 e.
//!
//! A link whose candidates did not all come back, or that the device cannot represent, is measured
//! against all triangles on the CPU.

use super::GpuExhaustive;
use super::candidates::CandidateTriangle;
use super::link::DeviceLink;
use super::measure::{least_distance, nearest_of, nearest_of_all};
use super::mesh::DeviceMesh;
use crate::answer::{LinkProximity, ProximityError};
use crate::pair::{Nearest, PlacedRobot};
use parry3d_f64::math::Real;

impl GpuExhaustive {
    /// Places the robots' links and runs the device's search for their candidates. With a `margin`,
    /// only triangles within it are candidates.
    pub(super) fn search<'a>(
        &mut self,
        robots: impl Iterator<Item = Result<PlacedRobot<'a>, ProximityError>>,
        margin: Option<Real>,
    ) -> Result<(), ProximityError> {
        let Self { links, device_links, robots: ranges, .. } = self;
        links.clear();
        device_links.clear();
        ranges.clear();
        for robot in robots {
            let first = links.len();
            let robot = match robot {
                Ok(robot) => robot,
                Err(error) => {
                    ranges.push(Err(error));
                    continue;
                }
            };
            for link in robot.placed_links() {
                let on_device = DeviceLink::new(&link, &self.frame, margin, self.gpu.precision());
                links.push((link, on_device.is_some().then_some(device_links.len())));
                device_links.extend(on_device);
            }
            ranges.push(Ok(first..links.len()));
        }
        if device_links.is_empty() {
            return Ok(());
        }
        let gpu = &*self.gpu.0;
        let mut mesh = self
            .on_device
            .take()
            .unwrap_or_else(|| DeviceMesh::new(gpu, &self.mesh, self.tuning.part));
        mesh.update(gpu, &self.frame, &self.mesh);
        let nearest = self.every_pair.as_ref().unwrap_or(&gpu.nearest);
        self.query.run(gpu, &mesh, device_links, nearest)?;
        self.on_device = Some(mesh);
        Ok(())
    }

    /// The candidates of a link, if all candidates came back from the device.
    fn candidates(&self, place: usize) -> Option<(&DeviceLink, &[CandidateTriangle])> {
        let number = self.links[place].1?;
        let link = &self.device_links[number];
        let (candidates, too_many) = self.query.candidates(number);
        // Without a margin there is at least one candidate.
        let complete = !too_many && (link.has_margin() || !candidates.is_empty());
        complete.then_some((link, candidates))
    }

    /// The nearest triangle of a link, if it is at most `bound` away.
    fn nearest(&mut self, place: usize, bound: Real) -> Option<Nearest> {
        let link = &self.links[place].0;
        let Some((device_link, candidates)) = self.candidates(place) else {
            let nearest = nearest_of_all(link, bound, &self.mesh);
            self.answered_on_cpu += 1;
            return nearest;
        };
        // The limit of the claim: min c + 2 e.
        let limit = least_distance(candidates) + 2.0 * device_link.error();
        let near = candidates.iter().filter(|candidate| candidate.distance <= limit);
        nearest_of(link, near.map(|candidate| candidate.triangle), bound, &self.mesh)
    }

    /// A lower bound on a link's distance, from the device's distances.
    fn at_least(&self, place: usize) -> Real {
        self.candidates(place)
            .map_or(0.0, |(link, candidates)| link.at_least(least_distance(candidates)))
    }

    /// Appends the nearest triangle of each link of a robot to `out`.
    ///
    /// # Errors
    /// The error of a bad robot.
    pub(super) fn answers(
        &mut self,
        robot: usize,
        out: &mut Vec<LinkProximity>,
    ) -> Result<(), ProximityError> {
        for (link, place) in self.robots[robot].clone()?.enumerate() {
            // Some triangle is always the nearest. If rounding hides it, triangle 0 is the answer.
            let nearest =
                self.nearest(place, Real::INFINITY).unwrap_or_else(|| self.first_triangle(place));
            out.push(self.links[place].0.answer(link, &nearest));
        }
        Ok(())
    }

    fn first_triangle(&self, place: usize) -> Nearest {
        self.links[place].0.measure(0, self.mesh.corners(0))
    }

    /// The closest of a robot's links. Ties go to the lowest triangle, then to the lowest link.
    ///
    /// # Errors
    /// The error of a bad robot.
    pub(super) fn least(&mut self, robot: usize) -> Result<LinkProximity, ProximityError> {
        let places = self.robots[robot].clone()?;
        let first = places.start;
        let mut best: Option<LinkProximity> = None;
        // The link with the least lower bound is first, because its distance prunes most others.
        let likeliest = places
            .clone()
            .min_by(|&a, &b| self.at_least(a).total_cmp(&self.at_least(b)))
            .unwrap_or(first);
        for place in std::iter::once(likeliest).chain(places.filter(|&place| place != likeliest)) {
            let bound = best.map_or(Real::INFINITY, |best| best.distance);
            if self.at_least(place) <= bound
                && let Some(nearest) = self.nearest(place, bound)
            {
                let other = self.links[place].0.answer(place - first, &nearest);
                let key = |answer: &LinkProximity| (answer.witness.triangle, answer.link);
                let is_nearer = |best: LinkProximity| {
                    other.distance < best.distance
                        || (other.distance <= best.distance && key(&other) < key(&best))
                };
                if best.is_none_or(is_nearer) {
                    best = Some(other);
                }
            }
        }
        Ok(best.unwrap_or_else(|| self.links[first].0.answer(0, &self.first_triangle(first))))
    }

    /// Returns whether every link of a robot is farther than `margin`.
    ///
    /// # Errors
    /// The error of a bad robot.
    pub(super) fn is_clear(&mut self, robot: usize, margin: Real) -> Result<bool, ProximityError> {
        Ok(self.robots[robot].clone()?.all(|place| self.nearest(place, margin).is_none()))
    }
}
