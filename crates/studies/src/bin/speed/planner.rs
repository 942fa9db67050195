//! A planner's question: is this new shape free? Random shapes, free and colliding apart, and many
//! of them at once.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_demo::steer::Random;
use continuum_demo::timing::{self, medians};
use continuum_demo::{cavity, ctr, lumen, ventricle};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity, ProximityError};
use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Random shapes per scene. This many do not fit into the caches; a repeated batch of 1,500
/// sometimes does.
const SHAPES: usize = 10_000;

struct Shape {
    chain: Chain,
    cylinders: Vec<(Pose, Cylinder)>,
}

/// Answers about one shape.
type Job<'a> = &'a mut dyn FnMut(&Shape) -> Result<(), String>;

/// Shapes of the three tubes with 30 links, by Algorithm 1.
fn shapes() -> Result<Vec<Shape>, String> {
    let (robot, mut random) = (ctr::three_tubes(), Random(7));
    let shape = |_| {
        let line = robot.centreline(&robot.any_joints(&mut random), 30);
        let chain =
            Chain::from_centreline(&line.points, &line.radii).map_err(|error| error.to_string())?;
        Ok(Shape { cylinders: timing::cylinders(&chain), chain })
    };
    (0..SHAPES).map(shape).collect()
}

/// parry's answer: link by link, to the first that meets the mesh.
fn parry_clears(mesh: &TriMesh, shape: &Shape, base: &Pose) -> Result<bool, String> {
    for (place, cylinder) in &shape.cylinders {
        let met = query::intersection_test(&(*base * *place), cylinder, &Pose::IDENTITY, mesh);
        if met.map_err(|error| error.to_string())?.intersecting {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Meshes by name, with the pose at which the robot enters, the smallest first.
fn scenes(effort: Effort) -> Result<Vec<(&'static str, TriMesh, Pose)>, String> {
    let inwards = Vector::new(-0.3, 0.2, 1.0).normalize();
    let aside = Pose::from_parts(
        Vector::new(20.0, 0.0, -30.0),
        Rot3::from_rotation_arc(Vector::Z, inwards),
    );
    let mut scenes = Vec::new();
    for times in [0, 2].into_iter().filter(|times| *times <= effort.largest) {
        let (vertices, indices) = ventricle::mesh(ventricle::DEFAULT_TRIANGLES << (2 * times));
        let mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
        scenes.push(("ventricle", mesh, ventricle::entry()));
        scenes.push(("cavity", cavity::mesh(4 + times), aside));
        scenes.push(("vessel", lumen::mesh(32 << times), lumen::entry()));
    }
    Ok(scenes)
}

/// Returns the chapter of the page, and its summary for the README.
pub fn chapter(effort: Effort, goals: &mut Goals) -> Result<(String, String), String> {
    let mut page = String::from(
        "## Planner\n\n\
         Random shapes of three tubes, 30 links each, from a fixed entry: does the shape touch the wall? `clears` with \
         margin 0, and `minimum`, each without a warm start. The peer is parry's \
         `intersection_test(Cylinder, TriMesh)` link by link, to the first that touches. Shapes are in the order of \
         drawing. Each query is timed alone, and the robot (for parry its cylinders) is written to memory just before, \
         as by a planner. Microseconds per touching shape and per free shape, and the number of each.\n\n\
         | scene | triangles | touching | parry | clears | minimum | free | parry | clears | minimum |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    // The least and the largest time of `clears`, and by how much it is faster than parry.
    let mut ranges = [[f64::INFINITY, 0.0_f64]; 2];
    let mut batches = format!(
        "\nThousands of shapes a second by `clears_batch` of all {SHAPES}, margin 0. The shapes of a batch come from memory; those \
         above are in the caches.\n\n\
         | scene | triangles | one thread | two threads |\n|---|---|---|---|\n"
    );
    let shapes = shapes()?;
    for (scene, mesh, base) in scenes(effort)? {
        let mut search = BvhSearch::new(&mesh).map_err(|error| error.to_string())?;
        let clear = |shape: &Shape| search.clears(&shape.chain, &base, 0.0).map_err(text);
        let clear: Vec<_> = shapes.iter().map(clear).collect::<Result<_, _>>()?;
        let _ = write!(page, "| {scene} | {} |", mesh.num_triangles());
        let [parry, clears, minimum] =
            times(&mesh, &search, &shapes, &clear, &base, effort.enough / 4)?;
        for (kind, is_clear) in [("colliding", false), ("free", true)] {
            let count = clear.iter().filter(|clear| **clear == is_clear).count();
            let [parry, clears, minimum] =
                [parry, clears, minimum].map(|of| of[usize::from(is_clear)]);
            let _ = write!(
                page,
                " {count} | {parry:.2} | {clears:.2} ({:.1} x) | {minimum:.2} |",
                parry / clears,
            );
            for (range, value) in ranges.iter_mut().zip([clears, parry / clears]) {
                *range = [range[0].min(value), range[1].max(value)];
            }
            let goal = if is_clear { 20.0 } else { 10.0 };
            goals.note(
                &format!("clears, random shapes, {kind}"),
                Goal::AtLeast(goal),
                parry / clears,
            );
        }
        page.push('\n');
        let _ = write!(batches, "| {scene} | {} |", mesh.num_triangles());
        let robots: Vec<_> = shapes.iter().map(|shape| (&shape.chain, base)).collect();
        let [one, two] = batch(&search, &robots, effort.enough / 4)?;
        let _ = writeln!(batches, " {:.0} | {:.0} ({:.1} x) |", one * 1e-3, two * 1e-3, two / one);
    }
    let [[least, most], [slower, faster]] = ranges;
    let quote = format!(
        "A planner asks whether a random shape touches, without a warm start: `clears` takes {least:.1} to {most:.1} us, \
         {slower:.0} to {faster:.0} times less than parry's `intersection_test`."
    );
    Ok((page + &batches, quote))
}

fn text(error: ProximityError) -> String {
    error.to_string()
}

/// Microseconds per touching shape and per free shape: parry, `clears` and the minimum.
///
/// Each query is timed alone, and the shapes take turns as they were drawn. The robot is written to
/// its place just before.
fn times(
    mesh: &TriMesh,
    search: &BvhSearch,
    shapes: &[Shape],
    clear: &[bool],
    base: &Pose,
    enough: Duration,
) -> Result<[[f64; 2]; 3], String> {
    let mut robot = Shape { chain: shapes[0].chain.clone(), cylinders: Vec::new() };
    let (mut clears, mut minimum) = (search.clone(), search.clone());
    let mut jobs: [Job; 3] = [
        &mut |shape| parry_clears(mesh, shape, base).map(keep),
        &mut |shape| {
            clears.forget();
            clears.clears(&shape.chain, base, 0.0).map(keep).map_err(text)
        },
        &mut |shape| {
            minimum.forget();
            minimum.minimum(&shape.chain, base).map(keep).map_err(text)
        },
    ];
    let mut passes = [const { [const { Vec::new() }; 2] }; 3];
    let begin = Instant::now();
    while passes[0][0].is_empty() || begin.elapsed() < enough {
        for (job, passes) in jobs.iter_mut().zip(&mut passes) {
            let mut sums = [Duration::ZERO; 2];
            for (shape, &clear) in shapes.iter().zip(clear) {
                robot.chain.clone_from(&shape.chain);
                robot.cylinders.clone_from(&shape.cylinders);
                let start = Instant::now();
                job(&robot)?;
                sums[usize::from(clear)] += start.elapsed();
            }
            passes.iter_mut().zip(sums).for_each(|(passes, sum)| passes.push(sum));
        }
    }
    let count =
        |kind: usize| clear.iter().filter(|&&clear| usize::from(clear) == kind).count().max(1);
    Ok(passes.map(|passes| {
        let [touching, free] = passes.map(|mut sums| {
            sums.sort_unstable();
            sums[sums.len() / 2].as_secs_f64() * 1e6
        });
        [touching / count(0) as f64, free / count(1) as f64]
    }))
}

/// Uses an answer, so that the query is not optimised away.
fn keep<T>(answer: T) {
    black_box(answer);
}

/// How many shapes a second a batch answers on one thread and on two, which take turns.
fn batch(
    search: &BvhSearch,
    robots: &[(&Chain, Pose)],
    enough: Duration,
) -> Result<[f64; 2], String> {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let (mut search, mut out) = (search.clone(), Vec::new());
        let answer = move |pool: &rayon::ThreadPool| {
            pool.install(|| search.clears_batch(robots, 0.0, &mut out)).map_err(text)
        };
        pool.map(|pool| (pool, answer)).map_err(|error| error.to_string())
    };
    let ((one, mut on_one), (two, mut on_two)) = (on(1)?, on(2)?);
    let times = medians(&mut [&mut || on_one(&one), &mut || on_two(&two)], enough)?;
    Ok([times[0], times[1]].map(|time| robots.len() as f64 / time.as_secs_f64()))
}
