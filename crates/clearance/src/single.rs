//! The answer about one robot.

use crate::options::Options;
use crate::report::{Proven, Report};
use crate::robot::Robot;
use crate::sides::Sides;
use crate::verdict::Verdict;
use crate::wall::Wall;
use crate::{csv, messages, outputs, plot, proof};
use mesh_files::Frame;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{Clearance, Proximity};
use parry_continuum::{Chain, Tube};

/// The warning beside a margin that is kept on an unknown side.
pub const NOT_INSIDE: &str = "the margin is kept, but not every link is inside the mesh; \
                              --inside decides by the side too";

/// Answers about one robot, and returns whether the margin is kept and proven.
pub fn answer(
    my: &Options,
    robot: &Robot,
    wall: &mut Wall,
    pose: &Pose,
    turned: Option<[Frame; 2]>,
    mut doubts: Vec<String>,
) -> Result<bool, String> {
    let Robot { points, radii, .. } = robot;
    let file = my.centreline.as_deref().unwrap_or(&my.mesh);
    let chain =
        Chain::from_centreline(points, radii).map_err(|error| messages::of_robot(&error, file))?;
    let asked = |error| messages::of_query(&error, file);
    let mut links = Vec::new();
    wall.search.per_link(&chain, pose, &mut links).map_err(asked)?;
    let minimum = wall.search.minimum(&chain, pose).map_err(asked)?;
    let mut sides = Vec::new();
    wall.search.link_sides(&chain, pose, &mut sides).map_err(asked)?;
    let [base, tip] =
        [points[0], points[points.len() - 1]].map(|end| wall.search.side(*pose * end));
    let sides = Sides { base, tip, links: sides };
    let curve = my.tolerance.map(|tolerance| bound_curve(robot, wall, pose, tolerance));
    // Print the links even if the curve fails.
    let (curve, failure) = match curve.transpose() {
        Ok(curve) => (curve, None),
        Err(error) => (None, Some(messages::of_curve(error, file))),
    };
    let verdict = my.margin.filter(|_| failure.is_none());
    let verdict =
        verdict.map(|margin| Verdict::new(margin, minimum.distance, curve.as_ref().map(|c| &c.1)));

    if let Some(path) = &my.csv {
        outputs::write("--csv", path, csv::links(&links))?;
    }
    if let Some(path) = &my.plot {
        let bounds = curve.as_ref().map(|curve| [curve.1.lower, curve.1.upper]);
        let plot =
            plot::Plot { robot, pose, minimum: &minimum, margin: my.margin, verdict, bounds };
        let unit = wall.unit();
        plot.draw(&mut wall.search, path, unit)?;
    }
    let proven = match (&my.prove, &verdict) {
        (Some(path), Some(verdict)) if verdict.is_kept == Some(true) => {
            let margin = verdict.margin;
            let search = &mut wall.search;
            let proof = match (&curve, my.tolerance) {
                (Some((tube, _)), Some(tolerance)) => {
                    search.prove_tube(tube, pose, margin, tolerance)
                }
                _ => search.prove(&chain, pose, margin),
            };
            Some(match proof.map_err(asked)? {
                Some(proof) => Proven::By(proof::write(path, &proof, &wall.search)?),
                None => Proven::TooClose,
            })
        }
        (Some(_), Some(_)) => Some(Proven::NotKept),
        _ => None,
    };

    let skipped = (robot.skipped_points > 0).then(|| {
        format!(
            "left out of {}: {} points without a position",
            file.display(),
            robot.skipped_points
        )
    });
    wall.notes.iter().chain(&skipped).for_each(|note| outputs::tell("note", note));
    let is_kept = verdict.is_none_or(|verdict| verdict.is_kept == Some(true));
    let is_proven = !matches!(proven, Some(Proven::TooClose));
    let is_inside = sides.is_inside();
    if verdict.is_some() && is_kept && !is_inside && !my.inside {
        doubts.push(NOT_INSIDE.to_owned());
    }
    doubts.iter().for_each(|doubt| outputs::tell("warning", doubt));
    let curve = curve.map(|(_, bounds)| bounds);
    let asks_inside = my.inside;
    let report = Report {
        wall,
        turned,
        sides,
        asks_inside,
        links,
        curve,
        minimum,
        verdict,
        proven,
        doubts: &doubts,
    };
    outputs::print(&if my.json { report.json() } else { report.lines() })?;
    match failure {
        Some(failure) => Err(failure),
        None => Ok(is_kept && is_proven && (is_inside || !my.inside)),
    }
}

/// Returns the curve through the robot's points, and the bounds of its clearance.
fn bound_curve(
    robot: &Robot,
    wall: &mut Wall,
    pose: &Pose,
    tolerance: f64,
) -> Result<(Tube, Clearance), messages::CurveError> {
    let tube = Tube::from_samples(&robot.points, &robot.radii, None)?;
    let bounds = wall.search.clearance(&tube, pose, tolerance)?;
    Ok((tube, bounds))
}
