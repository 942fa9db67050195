//! The answers about many robots: a line of CSV for each, or an object of JSON.

use crate::number::all_digits;
use crate::options::Options;
use crate::robot::Robot;
use crate::single::NOT_INSIDE;
use crate::wall::Wall;
use crate::{csv, messages, number, outputs, report};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{LinkProximity, Proximity, ProximityError, Side};
use serde_json::json;
use std::path::Path;

/// The number of shapes per batch.
const AT_ONCE: usize = 4096;

/// The answer about a shape: its closest link, and whether every link is inside; or a message.
type Answer = Result<(LinkProximity, bool), String>;

/// Answers about many robots, and returns whether all of them keep the margin.
pub fn answer(
    my: &Options,
    robots: &[Robot],
    wall: &mut Wall,
    pose: &Pose,
    mut doubts: Vec<String>,
) -> Result<bool, String> {
    let file = my.shapes.as_deref().unwrap_or(&my.mesh);
    let answers = ask(robots, wall, pose, file)?;
    let inside = answers.iter().filter(|answer| matches!(answer, Ok((_, true)))).count();
    let is_inside = inside == answers.len();
    let table = || -> String {
        let lines = robots.iter().zip(&answers).map(|(robot, answer)| line(robot.number, answer));
        format!("shape,{},error,inside\n", csv::COLUMNS) + &lines.collect::<String>()
    };
    if let Some(path) = &my.csv {
        outputs::write("--csv", path, table())?;
    }
    wall.notes.iter().for_each(|note| outputs::tell("note", note));
    let verdict = my.margin.map(|margin| verdict(margin, &answers, wall));
    if verdict.as_ref().is_some_and(|(_, is_kept)| *is_kept) && !is_inside && !my.inside {
        doubts.push(NOT_INSIDE.to_owned());
    }
    doubts.iter().for_each(|doubt| outputs::tell("warning", doubt));
    let of_inside = my.inside.then(|| format!("inside: {inside} of {} shapes", answers.len()));
    let of_margin = verdict.as_ref().map(|(line, _)| line.clone());
    let mut text = String::new();
    if my.json {
        text = format!("{:#}\n", json!(objects(robots, &answers)));
    } else if my.csv.is_none() {
        text = table();
    }
    // Standard output holds a table or JSON, or else the summary.
    let holds_table = !text.is_empty();
    for line in of_inside.iter().chain(&of_margin) {
        if holds_table {
            eprintln!("{line}");
        } else {
            text += &format!("{line}\n");
        }
    }
    if my.csv.is_some() && !my.json {
        text += &summary(robots, &answers, wall);
    }
    outputs::print(&text)?;
    Ok(verdict.is_none_or(|(_, is_kept)| is_kept) && (is_inside || !my.inside))
}

/// Asks about the robots in batches.
fn ask(robots: &[Robot], wall: &mut Wall, pose: &Pose, file: &Path) -> Result<Vec<Answer>, String> {
    let mut answers = Vec::with_capacity(robots.len());
    for some in robots.chunks(AT_ONCE) {
        let chains: Vec<_> =
            some.iter().map(|robot| Chain::from_centreline(&robot.points, &robot.radii)).collect();
        let asked: Vec<_> = chains
            .iter()
            .filter_map(|chain| chain.as_ref().ok())
            .map(|chain| (chain, *pose))
            .collect();
        let mut found = Vec::new();
        wall.search
            .minimum_batch(&asked, &mut found)
            .map_err(|error| messages::of_query(&error, file))?;
        let mut found = found.into_iter();
        for chain in &chains {
            let answer = match chain {
                Err(error) => Err(messages::of_robot(error, file)),
                Ok(chain) => {
                    let found = found.next().ok_or("no answer")?;
                    let answer = found.and_then(|found| Ok((found, is_inside(chain, wall, pose)?)));
                    answer.map_err(|error| messages::of_query(&error, file))
                }
            };
            answers.push(answer);
        }
    }
    Ok(answers)
}

/// Returns whether every link is inside, as for one shape.
fn is_inside(chain: &Chain, wall: &mut Wall, pose: &Pose) -> Result<bool, ProximityError> {
    let mut sides = Vec::new();
    wall.search.link_sides(chain, pose, &mut sides)?;
    Ok(sides.iter().all(|side| *side == Side::Inside))
}

/// Returns the line with the verdict, and whether all shapes keep the margin.
fn verdict(margin: f64, answers: &[Answer], wall: &Wall) -> (String, bool) {
    let keeps = |answer: &&Answer| answer.as_ref().is_ok_and(|(found, _)| found.distance > margin);
    let kept = answers.iter().filter(keeps).count();
    let (margin, count) = (number::as_written(margin, wall.unit()), answers.len());
    let decision = if kept == count { "kept" } else { "not kept" };
    (format!("margin {margin}: {decision}, by {kept} of {count} shapes"), kept == count)
}

/// Returns the last line: the closest shape, the first of equals.
fn summary(robots: &[Robot], answers: &[Answer], wall: &Wall) -> String {
    let answered = robots.iter().zip(answers);
    let answered = answered.filter_map(|(robot, answer)| Some((robot, &answer.as_ref().ok()?.0)));
    let closest = answered.min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance));
    closest.map_or_else(
        || "minimum: none, since every shape has an error\n".to_owned(),
        |(robot, found)| {
            let subject = format!("shape {}, link {}", all_digits(robot.number), found.link);
            report::minimum(&subject, found, wall) + "\n"
        },
    )
}

fn objects(robots: &[Robot], answers: &[Answer]) -> Vec<serde_json::Value> {
    let object = |(robot, answer): (&Robot, &Answer)| match answer {
        Ok((answer, is_inside)) => {
            json!({ "shape": robot.number, "minimum": answer, "inside": is_inside })
        }
        Err(error) => json!({ "shape": robot.number, "error": error }),
    };
    robots.iter().zip(answers).map(object).collect()
}

fn line(number: f64, answer: &Answer) -> String {
    match answer {
        Ok((found, is_inside)) => {
            format!("{},{},,{is_inside}\n", all_digits(number), csv::answer(found))
        }
        Err(error) => {
            let error = messages::in_one_line(error).replace('"', "'");
            format!("{},,,,,,,,,,,\"{error}\",\n", all_digits(number))
        }
    }
}
