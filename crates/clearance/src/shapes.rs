//! The answers about many robots: a line of CSV for each, or an object of JSON.

use crate::options::Options;
use crate::robot::Robot;
use crate::wall::Wall;
use crate::{csv, messages, number, outputs, report};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{LinkProximity, Proximity};
use serde_json::json;
use std::path::Path;

/// The number of shapes per batch.
const AT_ONCE: usize = 4096;

/// The answer about a shape, or a message.
type Answer = Result<LinkProximity, String>;

/// Answers about many robots, and returns whether all of them keep the margin.
pub fn answer(
    my: &Options,
    robots: &[Robot],
    wall: &mut Wall,
    pose: &Pose,
    doubts: &[String],
) -> Result<bool, String> {
    let file = my.shapes.as_deref().unwrap_or(&my.mesh);
    let answers = ask(robots, wall, pose, file)?;
    let table = || -> String {
        let lines = robots.iter().zip(&answers).map(|(robot, answer)| line(robot.number, answer));
        format!("shape,{},error\n", csv::COLUMNS) + &lines.collect::<String>()
    };
    if let Some(path) = &my.csv {
        outputs::write("--csv", path, &table())?;
    }
    wall.notes.iter().for_each(|note| eprintln!("note: {note}"));
    doubts.iter().for_each(|doubt| eprintln!("warning: {doubt}"));
    let verdict = my.margin.map(|margin| verdict(margin, &answers, wall));
    let mut text = String::new();
    if my.json {
        text = format!("{:#}\n", json!(objects(robots, &answers)));
    } else if my.csv.is_none() {
        text = table();
    }
    // Standard output holds a table or JSON, or else the summary.
    if let Some((line, _)) = &verdict {
        if text.is_empty() {
            text = format!("{line}\n");
        } else {
            eprintln!("{line}");
        }
    }
    if my.csv.is_some() && !my.json {
        text += &summary(robots, &answers, wall);
    }
    outputs::print(&text)?;
    Ok(verdict.is_none_or(|(_, is_kept)| is_kept))
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
            answers.push(match chain {
                Err(error) => Err(messages::of_robot(error, file)),
                Ok(_) => found
                    .next()
                    .ok_or("no answer")?
                    .map_err(|error| messages::of_query(&error, file)),
            });
        }
    }
    Ok(answers)
}

/// Returns the line with the verdict, and whether all shapes keep the margin.
fn verdict(margin: f64, answers: &[Answer], wall: &Wall) -> (String, bool) {
    let keeps = |answer: &&Answer| answer.as_ref().is_ok_and(|found| found.distance > margin);
    let kept = answers.iter().filter(keeps).count();
    let (margin, count) = (number::as_written(margin, wall.unit()), answers.len());
    let decision = if kept == count { "kept" } else { "not kept" };
    (format!("margin {margin}: {decision}, by {kept} of {count} shapes"), kept == count)
}

/// Returns the last line: the closest shape, the first of equals.
fn summary(robots: &[Robot], answers: &[Answer], wall: &Wall) -> String {
    let answered = robots.iter().zip(answers);
    let answered = answered.filter_map(|(robot, answer)| Some((robot, answer.as_ref().ok()?)));
    let closest = answered.min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance));
    closest.map_or_else(
        || "minimum: none, since every shape has an error\n".to_owned(),
        |(robot, found)| {
            let subject = format!("shape {}, link {}", robot.number, found.link);
            report::minimum(&subject, found, wall) + "\n"
        },
    )
}

fn objects(robots: &[Robot], answers: &[Answer]) -> Vec<serde_json::Value> {
    let object = |(robot, answer): (&Robot, &Answer)| match answer {
        Ok(answer) => json!({ "shape": robot.number, "minimum": answer }),
        Err(error) => json!({ "shape": robot.number, "error": error }),
    };
    robots.iter().zip(answers).map(object).collect()
}

fn line(number: f64, answer: &Answer) -> String {
    match answer {
        Ok(found) => format!("{number},{},\n", csv::answer(found)),
        Err(error) => format!("{number},,,,,,,,,,,\"{}\"\n", error.replace('"', "'")),
    }
}
