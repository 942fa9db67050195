//! Exhaustive engines against parry, pair by pair and on one thread; and how they use two threads
//! and memory.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_demo::levels::levels;
use continuum_demo::subdivide::{in_four, shuffled};
use continuum_demo::timing::{self, medians};
use continuum_demo::ventricle;
use continuum_studies::machine;
use continuum_studies::models::models;
use fearless_simd::Level;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, SearchPrecision};
use std::fmt::Write;
use std::hint::black_box;
use std::sync::LazyLock;
use std::time::Duration;

/// The ventricle divided in four this many times, in the order of subdivision.
pub fn divided(times: u32) -> (Vec<Vector>, Vec<[u32; 3]>) {
    // Growing it takes longer than some of the chapters.
    static WHOLE: LazyLock<(Vec<Vector>, Vec<[u32; 3]>)> =
        LazyLock::new(|| ventricle::mesh(ventricle::DEFAULT_TRIANGLES));
    (0..times).fold(WHOLE.clone(), |mesh, _| in_four(mesh))
}

pub fn on_one_thread<T: Send>(job: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| error.to_string())?;
    Ok(pool.install(job))
}

/// The chapter of the page.
pub fn chapter(effort: Effort, goals: &mut Goals) -> Result<String, String> {
    let (times, often) = if effort.largest < 2 { (1, "once") } else { (2, "twice") };
    let mut page = format!(
        "## Exhaustive\n\n\
         The ventricle of 6,000 triangles divided in four {often}, 30 links, one thread. The peer is a loop of parry's \
         `distance(Cylinder, Triangle)` over the same pairs. Culling: every triangle is visited, and a sphere around \
         it may prune it. Nanoseconds per pair, and times faster than the peer. Triangles are shuffled, or in the \
         order of subdivision, where neighbours are adjacent.\n\n\
         | order | precision | culling | capsules | fitted caps | cylinders | fitted caps / capsules | cylinders / capsules |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    let mut work = String::from(
        "\nShare of the pairs whose axis distance was computed (a pack at a time), and that were measured in double \
         precision:\n\n| order | precision | capsules | fitted caps | cylinders |\n|---|---|---|---|---|\n",
    );
    let models = models().map_err(|error| error.to_string())?;
    let sorted = divided(times);
    for (order, (vertices, indices)) in
        [("shuffled", shuffled(sorted.clone(), 1)), ("sorted", sorted)]
    {
        let mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
        let (mesh, models, goals) = (&mesh, &models, &mut *goals);
        let (rows, shares) = on_one_thread(move || -> Result<_, String> {
            let single = rows::<f32>(order, "f32", mesh, models, effort, goals)?;
            let double = rows::<f64>(order, "f64", mesh, models, effort, goals)?;
            Ok((single.0 + &double.0, single.1 + &double.1))
        })??;
        page.push_str(&rows);
        work.push_str(&shares);
    }
    Ok(page + &work + &instruction_sets(divided(times), &models[0].1, effort)?)
}

/// What each instruction set of the machine makes of the same kernels: none may fall back to
/// narrower ones.
fn instruction_sets(
    (vertices, indices): (Vec<Vector>, Vec<[u32; 3]>),
    robot: &Chain,
    effort: Effort,
) -> Result<String, String> {
    let mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
    let mut page = String::from(
        "\nNanoseconds a pair by instruction set, capsules without culling, one thread:\n\n\
         | instruction set | f32 | f64 |\n|---|---|---|\n",
    );
    for (name, level) in levels() {
        let (mesh, robot) = (&mesh, robot);
        let [single, double] = on_one_thread(move || -> Result<_, String> {
            let enough = effort.enough / 8;
            Ok([
                without_culling::<f32>(mesh, robot, level, enough)?,
                without_culling::<f64>(mesh, robot, level, enough)?,
            ])
        })??;
        let _ = writeln!(page, "| {name} | {:.1} | {:.1} |", single * 1e9, double * 1e9);
    }
    Ok(page)
}

/// Seconds a pair.
fn without_culling<T: SearchPrecision>(
    mesh: &TriMesh,
    robot: &Chain,
    level: Level,
    enough: Duration,
) -> Result<f64, String> {
    let mut engine = Exhaustive::<T>::new(mesh).map_err(|error| error.to_string())?;
    engine.set_culling(false);
    engine.set_level(level);
    let mut out = Vec::new();
    let mut query =
        || engine.per_link(robot, &ventricle::entry(), &mut out).map_err(|error| error.to_string());
    let time = medians::<String>(&mut [&mut query], enough)?[0].as_secs_f64();
    Ok(time / (mesh.num_triangles() * robot.links().len()) as f64)
}

fn rows<T: SearchPrecision + Send>(
    order: &str,
    precision: &str,
    mesh: &TriMesh,
    models: &[(&str, Chain); 3],
    effort: Effort,
    goals: &mut Goals,
) -> Result<(String, String), String> {
    let base = ventricle::entry();
    let cylinders = timing::cylinders(&models[2].1);
    // parry's time does not depend on the mesh's size; a share of its pairs is enough.
    let sample: Vec<_> = mesh.triangles().step_by(97).collect();
    let text = |error: parry_continuum::proximity::ProximityError| error.to_string();
    let (mut page, mut shares) = (String::new(), format!("| {order} | {precision} |"));
    for culling in [false, true] {
        let mut engines = Vec::new();
        for _ in models {
            let mut engine = Exhaustive::<T>::new(mesh).map_err(|error| error.to_string())?;
            engine.set_culling(culling);
            engines.push(engine);
        }
        let [mut capsules, mut fitted, mut flat] =
            <[Exhaustive<T>; 3]>::try_from(engines).map_err(|_| "three models")?;
        let (mut out1, mut out2, mut out3) = (Vec::new(), Vec::new(), Vec::new());
        let times = medians::<String>(
            &mut [
                &mut || {
                    for (place, cylinder) in &cylinders {
                        for triangle in &sample {
                            let pose = base * *place;
                            black_box(
                                query::distance(&pose, cylinder, &Pose::IDENTITY, triangle)
                                    .map_err(|e| e.to_string())?,
                            );
                        }
                    }
                    Ok(())
                },
                &mut || capsules.per_link(&models[0].1, &base, &mut out1).map_err(text),
                &mut || fitted.per_link(&models[1].1, &base, &mut out2).map_err(text),
                &mut || flat.per_link(&models[2].1, &base, &mut out3).map_err(text),
            ],
            effort.enough / 2,
        )?;
        let peer = times[0].as_secs_f64() / (cylinders.len() * sample.len()) as f64;
        let pairs = (cylinders.len() * mesh.num_triangles()) as f64;
        let ours: Vec<_> = times[1..].iter().map(|time| time.as_secs_f64() / pairs).collect();
        let _ = write!(page, "| {order} | {precision} | {} |", if culling { "yes" } else { "no" });
        for time in &ours {
            let _ = write!(page, " {:.2} ns, {:.0} x |", time * 1e9, peer / time);
        }
        let _ = writeln!(page, " {:.2} | {:.2} |", ours[1] / ours[0], ours[2] / ours[0]);
        let least = match (precision, culling) {
            ("f32", false) => 50.0,
            ("f32", true) => 200.0,
            (_, false) => 25.0,
            (_, true) => 80.0,
        };
        let job = format!(
            "exhaustive, capsules, {precision}, {} culling",
            if culling { "with" } else { "without" }
        );
        goals.note(&job, Goal::AtLeast(least), peer / ours[0]);
        if culling {
            goals.note(
                "exhaustive, fitted caps against capsules, with culling",
                Goal::AtMost(1.05),
                ours[1] / ours[0],
            );
            goals.note(
                "exhaustive, cylinders against capsules, with culling",
                Goal::AtMost(1.2),
                ours[2] / ours[0],
            );
            for work in [capsules.work(), fitted.work(), flat.work()] {
                let share = |count: u64| 100.0 * count as f64 / work.visited as f64;
                let _ = write!(
                    shares,
                    " {:.2} %, {:.4} % |",
                    share(work.axis_distances),
                    share(work.measured)
                );
            }
        }
    }
    Ok((page, shares + "\n"))
}

/// Bytes per triangle, from the growth of the process: measured first, while no freed memory can be
/// reused.
pub fn memory(effort: Effort) -> Result<String, String> {
    let (vertices, indices) = divided(effort.largest.min(4));
    let mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
    let triangles = mesh.num_triangles() as f64;
    let mut page = format!(
        "## Memory\n\nHeld for each triangle of {triangles} (the engine's copy of the mesh included):\n\n| engine | bytes |\n|---|---|\n"
    );
    let mut engines = Vec::new();
    let mut measure = |name: &str,
                       build: &dyn Fn() -> Result<Box<dyn Proximity>, String>|
     -> Result<(), String> {
        let before = machine::memory();
        let engine = build()?;
        let after = machine::memory();
        let bytes = before
            .zip(after)
            .map_or("unknown".into(), |(a, b)| format!("{:.0}", (b - a) / triangles));
        engines.push(engine);
        writeln!(page, "| {name} | {bytes} |").map_err(|error| error.to_string())
    };
    let text = |error: parry_continuum::proximity::MeshError| error.to_string();
    measure("`BvhSearch`", &|| Ok(Box::new(BvhSearch::new(&mesh).map_err(text)?)))?;
    measure("`Exhaustive<f32>`", &|| Ok(Box::new(Exhaustive::<f32>::new(&mesh).map_err(text)?)))?;
    measure("`Exhaustive<f64>`", &|| Ok(Box::new(Exhaustive::<f64>::new(&mesh).map_err(text)?)))?;
    Ok(page)
}
