//! What was found of many robots: a line of CSV for each, or an object of JSON.

use crate::Options;
use crate::robot::Robot;
use crate::wall::Wall;
use indicatif::ProgressBar;
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{LinkProximity, Proximity};
use serde_json::json;
use std::error::Error;
use std::io::{BufWriter, Write, stdout};

/// Shapes per batch.
const AT_ONCE: usize = 4096;

pub fn print(
    my: &Options,
    robots: &[Robot],
    wall: &mut Wall,
    pose: &Pose,
) -> Result<(), Box<dyn Error>> {
    let progress = ProgressBar::new(robots.len() as u64);
    let mut out = BufWriter::new(stdout().lock());
    let mut objects = Vec::new();
    if !my.json {
        writeln!(
            out,
            "shape,distance,arc_length,segment,triangle,robot_x,robot_y,robot_z,mesh_x,mesh_y,mesh_z,error"
        )?;
    }
    for some in robots.chunks(AT_ONCE) {
        let chains: Vec<_> =
            some.iter().map(|robot| Chain::from_centreline(&robot.points, &robot.radii)).collect();
        let asked: Vec<_> = chains
            .iter()
            .filter_map(|chain| chain.as_ref().ok())
            .map(|chain| (chain, *pose))
            .collect();
        let mut found = Vec::new();
        wall.search.minimum_batch(&asked, &mut found)?;
        let mut found = found.into_iter();
        for (robot, chain) in some.iter().zip(&chains) {
            let answer = match chain {
                Err(error) => Err(error.to_string()),
                Ok(_) => found.next().ok_or("no answer")?.map_err(|error| error.to_string()),
            };
            if my.json {
                objects.push(match &answer {
                    Ok(answer) => json!({ "shape": robot.number, "minimum": answer }),
                    Err(error) => json!({ "shape": robot.number, "error": error }),
                });
            } else {
                writeln!(out, "{}", line(robot.number, &answer))?;
            }
        }
        progress.inc(some.len() as u64);
    }
    progress.finish_and_clear();
    if my.json {
        writeln!(out, "{:#}", json!(objects))?;
    }
    Ok(out.flush()?)
}

fn line(number: f64, answer: &Result<LinkProximity, String>) -> String {
    match answer {
        Ok(found) => {
            let [robot, mesh] = [found.witness.on_robot, found.witness.on_mesh]
                .map(|p| format!("{},{},{}", p.x, p.y, p.z));
            let LinkProximity { distance, .. } = found;
            format!(
                "{number},{distance},{},{},{},{robot},{mesh},",
                found.witness.arc_length, found.witness.segment, found.witness.triangle
            )
        }
        Err(error) => format!("{number},,,,,,,,,,,\"{}\"", error.replace('"', "'")),
    }
}
