//! Twenty organs around a robot, each an engine of its own in a scene, beside one engine of all
//! their triangles.

mod edges;
mod organs;

use crate::Effort;
use crate::latency::{OTHER_WORK, walk};
use crate::robots::{at_all, text};
use continuum_demo::timing::medians;
use organs::{MARGIN, Surface, merged, organ};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Contact, Proximity, Scene, SceneContact};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Between these marks the page has the chapter.
pub const MARK: &str = "scenes";

/// How many places the robot takes, one after the other.
const PLACES: u32 = 60;

const ORGANS: u32 = 20;
const REACH: f64 = 3.0;

/// The chapter of the page, without its marks.
pub fn chapter(effort: Effort, written: &str) -> Result<String, String> {
    let organs: Vec<_> = (0..ORGANS).map(organ).collect();
    let mut page = format!(
        "## Scenes\n\n\
         {written}. A robot of 30 links that moves past {ORGANS} organs of {} triangles each in {PLACES} places: a `Scene` of {ORGANS} \
         engines beside one engine of the merged mesh, which does not know whose a triangle is. All margins are {MARGIN} mm, and \
         contacts are those within {REACH} mm. Microseconds a query: in bursts, and where {} MB of other data pass through the \
         caches between two queries.\n\n\
         | robot | question | scene | merged | ratio | after other work: scene | merged | ratio |\n\
         |---|---|---|---|---|---|---|---|\n",
        organs[0].1.len(),
        OTHER_WORK >> 20
    );
    let mut other_work = vec![0_u8; OTHER_WORK];
    for (name, away) in [("near", 0.0), ("far", 60.0)] {
        rows(effort, name, away, &organs, &mut other_work, &mut page)?;
    }
    edges::table(effort, &organs, &mut page)?;
    Ok(page)
}

/// A robot of 30 links that bends a little.
fn robot() -> Result<Chain, String> {
    let point = |k: i32| {
        let s = f64::from(k) * 2.0;
        Vector::new(1.5 * (s / 15.0).sin(), 1.5 * (s / 11.0).cos(), s)
    };
    let points: Vec<_> = (0..=30).map(point).collect();
    Chain::from_centreline(&points, &[1.0; 30]).map_err(text)
}

/// One query of the scene and of the merged mesh.
type Ask<'a> = Box<dyn FnMut(&Pose) -> Result<f64, String> + 'a>;

fn rows(
    effort: Effort,
    name: &str,
    away: f64,
    organs: &[Surface],
    other_work: &mut [u8],
    page: &mut String,
) -> Result<(), String> {
    let robot = robot()?;
    let mut scene = Scene::new();
    for (number, (vertices, triangles)) in organs.iter().enumerate() {
        let search = BvhSearch::from_triangles(vertices, triangles).map_err(text)?;
        scene.add(format!("organ {number}"), search, Some(MARGIN)).map_err(text)?;
    }
    scene.prepare();
    let (vertices, triangles) = merged(organs);
    let whole = BvhSearch::from_triangles(&vertices, &triangles).map_err(text)?;
    whole.prepare();
    let poses: Vec<_> = (0..PLACES).map(|k| f64::from(k) / f64::from(PLACES)).collect();
    let poses: Vec<_> = poses
        .iter()
        .map(|t| Pose::translation(away + 2.0 * (TAU * t).sin(), 3.0 * t, 2.0 * t))
        .collect();

    let (mut scene1, mut whole1) = (scene.clone(), whole.clone());
    let (mut scene2, mut whole2) = (scene.clone(), whole.clone());
    let (mut scene3, mut whole3) = (scene, whole);
    let (mut of_scene, mut of_whole): (Vec<SceneContact>, Vec<Contact>) = (Vec::new(), Vec::new());
    let as_number = |clears: bool| f64::from(u8::from(clears));
    let robot = &robot;
    let questions: [(&str, [Ask; 2]); 3] = [
        (
            "`clears`",
            [
                Box::new(move |pose| scene1.clears(&[(robot, *pose)]).map(as_number).map_err(text)),
                Box::new(move |pose| {
                    whole1.clears(robot, pose, MARGIN).map(as_number).map_err(text)
                }),
            ],
        ),
        (
            "`tightest` and `minimum`",
            [
                Box::new(move |pose| {
                    let found = scene2.tightest(&[(robot, *pose)]).map_err(text)?;
                    Ok(found.map_or(f64::INFINITY, |found| found.slack))
                }),
                Box::new(move |pose| {
                    whole2.minimum(robot, pose).map(|found| found.distance - MARGIN).map_err(text)
                }),
            ],
        ),
        (
            "`contacts_within`",
            [
                Box::new(move |pose| {
                    scene3
                        .contacts_within(&[(robot, *pose)], REACH, 0.0, &mut of_scene)
                        .map_err(text)?;
                    Ok(of_scene.len() as f64)
                }),
                Box::new(move |pose| {
                    whole3.contacts_within(robot, pose, REACH, 0.0, &mut of_whole).map_err(text)?;
                    Ok(of_whole.len() as f64)
                }),
            ],
        ),
    ];
    for (question, mut asks) in questions {
        // Both say the same, or the times tell nothing.
        for pose in &poses {
            let [one, other] = asks.each_mut().map(|ask| ask(pose));
            let (one, other) = (one?, other?);
            if (one - other).abs() > 1e-9 {
                return Err(format!("{question}: the scene says {one}, the merged mesh {other}"));
            }
        }
        let bursts = in_bursts(effort, &mut asks, &poses)?;
        let flushed = after_other_work(effort, &mut asks, &poses, other_work)?;
        let _ = write!(page, "| {name} | {question} |");
        for [scene, merged] in [bursts, flushed] {
            let _ = write!(page, " {scene:.1} | {merged:.1} | {:.2} |", scene / merged);
        }
        page.push('\n');
    }
    Ok(())
}

/// The median microseconds of a query of each, all places in turn.
fn in_bursts(effort: Effort, asks: &mut [Ask; 2], poses: &[Pose]) -> Result<[f64; 2], String> {
    let [mut scene, mut merged] = asks.each_mut().map(|ask| at_all(poses, ask));
    let times = medians(&mut [&mut scene, &mut merged], effort.enough)?;
    let micros = |time: Duration| time.as_secs_f64() * 1e6 / f64::from(PLACES);
    Ok([micros(times[0]), micros(times[1])])
}

/// The same of one query at a time, both in turn.
fn after_other_work(
    effort: Effort,
    asks: &mut [Ask; 2],
    poses: &[Pose],
    other_work: &mut [u8],
) -> Result<[f64; 2], String> {
    let (start, mut times) = (Instant::now(), [Vec::new(), Vec::new()]);
    while times[0].len() < poses.len() || start.elapsed() < effort.enough {
        let tick = times[0].len();
        for (ask, times) in asks.iter_mut().zip(&mut times) {
            walk(other_work, tick);
            let begin = Instant::now();
            black_box(ask(&poses[tick % poses.len()])?);
            times.push(begin.elapsed());
        }
    }
    Ok(times.map(|mut times| {
        times.sort();
        times[times.len() / 2].as_secs_f64() * 1e6
    }))
}
