//! A planner's edges in a scene: compares `Scene::clears_motion` with the single queries that it
//! replaces, and with one engine for all triangles.

use super::organs::{MARGIN, Surface, merged};
use crate::Effort;
use crate::robots::{Job, text};
use continuum_demo::steer::Random;
use continuum_demo::timing::medians;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, Scene, SelfQuery};
use parry_continuum::{BendingMotion, BendingSection, ConstantCurvature};
use std::f64::consts::TAU;
use std::fmt::Write;

/// The number of edges that are tested one after the other.
const EDGES: usize = 200;
/// The number of edges in a batch.
const BATCH: usize = 1000;

/// How far the tip moves along an edge, mm.
const LENGTH: f64 = 5.0;

const RESOLUTION: f64 = 1e-3;

/// Writes the table.
pub(super) fn table(effort: Effort, organs: &[Surface], page: &mut String) -> Result<(), String> {
    let edges = edges(BATCH)?;
    let _ = write!(
        page,
        "\n**Edges of a planner.** A robot of three sections of constant curvature and 60 mm among the same organs. Along an edge \
         its sections bend, and the tip moves by {LENGTH} mm. `Scene::clears_motion` beside the single questions that it replaces \
         (`BvhSearch::clears_motion` for each organ, up to the first contact), and beside the merged mesh; in the last row each robot \
         keeps {MARGIN} mm from itself too. Margin {MARGIN} mm, resolution {RESOLUTION} mm, microseconds an edge. Batches: \
         thousands of edges a second by `clears_motion_batch` of {BATCH}.\n\n\
         | organs | clear of {EDGES} | scene | single | ratio | merged | ratio | batch: one thread | two threads |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for (count, own) in [(1, false), (organs.len(), false), (organs.len(), true)] {
        row(effort, &organs[..count], own, &edges, page)?;
    }
    Ok(())
}

fn row(
    effort: Effort,
    organs: &[Surface],
    own: bool,
    edges: &[BendingMotion],
    page: &mut String,
) -> Result<(), String> {
    let mut scene = Scene::new();
    let mut searches = Vec::new();
    for (number, (vertices, triangles)) in organs.iter().enumerate() {
        let search = BvhSearch::from_triangles(vertices, triangles).map_err(text)?;
        scene.add(format!("organ {number}"), search.clone(), Some(MARGIN)).map_err(text)?;
        searches.push(search);
    }
    scene.set_self_margin(own.then_some(MARGIN)).map_err(text)?;
    scene.prepare();
    let (vertices, triangles) = merged(organs);
    let mut whole = BvhSearch::from_triangles(&vertices, &triangles).map_err(text)?;
    whole.prepare();
    let mut itself = SelfQuery::new();
    let few = &edges[..EDGES];

    let mut single = |edge: &BendingMotion| -> Result<Decision, String> {
        let mut all = Decision::Clear;
        for search in &mut searches {
            match search.clears_motion(edge, MARGIN, RESOLUTION).map_err(text)?.decision {
                Decision::Contact => return Ok(Decision::Contact),
                Decision::Undecided => all = Decision::Undecided,
                Decision::Clear => {}
            }
        }
        if own {
            let answer = itself.clears_motion(edge, MARGIN, RESOLUTION).map_err(text)?;
            if answer.decision != Decision::Clear {
                return Ok(answer.decision);
            }
        }
        Ok(all)
    };
    let mut of_scene = scene.clone();
    let mut clear = 0;
    for edge in few {
        let found = of_scene.clears_motion(&[edge], RESOLUTION).map_err(text)?.decision;
        let singly = single(edge)?;
        if found != singly {
            return Err(format!("the scene says {found:?}, the single questions {singly:?}"));
        }
        clear += usize::from(found == Decision::Clear);
    }
    let mut jobs: [Job; 3] = [
        Box::new(|| {
            few.iter().try_for_each(|edge| {
                of_scene.clears_motion(&[edge], RESOLUTION).map(drop).map_err(text)
            })
        }),
        Box::new(|| few.iter().try_for_each(|edge| single(edge).map(drop))),
        Box::new(|| {
            few.iter().try_for_each(|edge| {
                whole.clears_motion(edge, MARGIN, RESOLUTION).map(drop).map_err(text)
            })
        }),
    ];
    let mut called: Vec<&mut dyn FnMut() -> Result<(), String>> =
        jobs.iter_mut().map(|job| &mut **job as _).collect();
    let times = medians(&mut called, effort.enough)?;
    let [scene_time, single_time, merged_time] =
        [0, 1, 2].map(|k: usize| times[k].as_secs_f64() * 1e6 / EDGES as f64);
    let sets: Vec<_> = edges.iter().map(|edge| [edge]).collect();
    let sets: Vec<_> = sets.iter().map(|set| set.as_slice()).collect();
    let pools = [1, 2].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
    let [one, two] = pools;
    let (one, two) = (one.map_err(text)?, two.map_err(text)?);
    let ask = |pool: &rayon::ThreadPool| -> Result<(), String> {
        let mut out = Vec::new();
        pool.install(|| scene.clears_motion_batch(&sets, RESOLUTION, &mut out));
        Ok(())
    };
    let times = medians(&mut [&mut || ask(&one), &mut || ask(&two)], effort.enough)?;
    let [one, two] = [0, 1].map(|k: usize| BATCH as f64 / times[k].as_secs_f64() / 1e3);
    let organs = organs.len();
    let who = if own { format!("{organs}, and itself") } else { organs.to_string() };
    let _ = writeln!(
        page,
        "| {who} | {clear} | {scene_time:.1} | {single_time:.1} | {:.2} | {merged_time:.1} | {:.2} | {one:.1} | {two:.1} ({:.1} x) |",
        scene_time / single_time,
        scene_time / merged_time,
        two / one
    );
    Ok(())
}

/// Random edges between the organs.
fn edges(count: usize) -> Result<Vec<BendingMotion>, String> {
    let mut random = Random(1);
    let mut edges = Vec::with_capacity(count);
    while edges.len() < count {
        let mut bend = |most: f64| {
            let (size, angle) = (most * random.share(), TAU * random.share());
            [size * angle.cos(), size * angle.sin()]
        };
        let (from, way) = ([(); 3].map(|()| bend(0.012)), [(); 3].map(|()| bend(1.0)));
        // Scales the bending until the tip moves by LENGTH.
        let from = from.map(section);
        let tip = tip(&from)?;
        let (mut to, mut share) = (from, 1e-3);
        for _ in 0..5 {
            to = std::array::from_fn(|k| {
                let bend = [0, 1].map(|c: usize| from[k].bend[c] + share * way[k][c]);
                section(bend)
            });
            share *= LENGTH / (self::tip(&to)? - tip).length();
        }
        edges.push(BendingMotion::new(&from, &to, Pose::IDENTITY).map_err(text)?);
    }
    Ok(edges)
}

fn section(bend: [f64; 2]) -> BendingSection {
    BendingSection { length: 20.0, radius: 1.0, bend }
}

fn tip(sections: &[BendingSection]) -> Result<Vector, String> {
    let curve = ConstantCurvature::new(sections).map_err(text)?;
    Ok(curve.frame(curve.length()).translation)
}
