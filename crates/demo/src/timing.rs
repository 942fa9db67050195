//! Median times of the engines and of parry, taken in turns in one run.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::query::{self, Unsupported};
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use std::time::{Duration, Instant};

/// The links as parry's own cylinders (which lie along y around the origin), each with its place in
/// the robot. A link of length 0 is left out.
pub fn cylinders(robot: &Chain) -> Vec<(Pose, Cylinder)> {
    let cylinder = |link: &parry_continuum::ModifiedCylinder| {
        let turn = Rot3::from_rotation_arc(Vector::Y, link.axis());
        let middle = Pose::from_parts(link.start().midpoint(link.end()), turn);
        (middle, Cylinder::new(0.5 * link.length(), link.radius()))
    };
    robot.links().iter().filter(|link| link.length() > 0.0).map(cylinder).collect()
}

/// One distance per link by parry's `distance(Cylinder, TriMesh)`.
pub fn parry(mesh: &TriMesh, links: &[(Pose, Cylinder)], pose: &Pose) -> Result<f64, Unsupported> {
    let distance = |(place, cylinder): &(Pose, Cylinder)| {
        Ok(query::distance(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh)?.distance)
    };
    links.iter().map(distance).sum()
}

/// The median time of each of the jobs, called in turns until `enough` has passed (at least 3
/// rounds each).
pub fn medians<E>(
    jobs: &mut [&mut dyn FnMut() -> Result<(), E>],
    enough: Duration,
) -> Result<Vec<Duration>, E> {
    let mut times = vec![Vec::new(); jobs.len()];
    let start = Instant::now();
    while times.iter().any(|times: &Vec<_>| times.len() < 3) || start.elapsed() < enough {
        for (job, times) in jobs.iter_mut().zip(&mut times) {
            let begin = Instant::now();
            job()?;
            times.push(begin.elapsed());
        }
    }
    Ok(times
        .into_iter()
        .map(|mut times| {
            times.sort();
            times[times.len() / 2]
        })
        .collect())
}
