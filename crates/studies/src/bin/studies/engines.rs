//! Figure 9 and Table IV on the CPU: every triangle against every link, with the paper's solvers
//! and with ours.

use super::peak;
use continuum_demo::subdivide::{in_four, shuffled};
use continuum_demo::ventricle;
use continuum_studies::Number;
use continuum_studies::every_pair::EveryPair;
use continuum_studies::long_table;
use continuum_studies::models::models;
use continuum_studies::quartic::QuarticAsPrinted;
use parry_continuum::Chain;
use parry_continuum::distance::laboratory::{Convex, DiscSolver};
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{Exhaustive, Proximity, SearchPrecision};
use real_polynomial_roots::{ClosedForm, Companion};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// The most runs of an engine, and the seconds after which it is not run again.
const ROUNDS: usize = 5;
const ENOUGH: f64 = 1.0;

/// Model, how pairs are taken and the route to a disc, and the engine that takes them alike for
/// capsules.
const ENGINES: [(&str, &str, usize); 8] = [
    ("capsules", "packed, no discs", 0),
    ("fitted caps", "packed, convex", 0),
    ("cylinders", "packed, convex", 0),
    ("capsules", "one by one, no discs", 3),
    ("fitted caps", "one by one, convex", 3),
    ("fitted caps", "one by one, (18) as printed, companion", 3),
    ("cylinders", "one by one, convex", 3),
    ("cylinders", "one by one, (18) as printed, closed form", 3),
];
const COUNT: usize = ENGINES.len();
const PRECISIONS: [&str; 2] = ["f32", "f64"];
/// The paper's model of each of them.
const PAPERS: [usize; COUNT] = [0, 1, 2, 0, 1, 1, 2, 2];

/// The paper's Table IV: seconds for 1e6 triangles and the index per TFLOPS, for capsules, fitted
/// caps and cylinders in float, then in double.
const PAPER: [[(f64, f64); 3]; 2] = [
    [(0.016, 11.93), (0.016, 11.93), (0.276, 0.69)],
    [(0.037, 10.32), (0.037, 10.32), (0.330, 1.16)],
];
/// Seconds and index of the peer that the paper compares itself with.
const PEER: (f64, f64) = (0.946, 0.33);

/// Seconds of each engine for a query of all links, and the largest error of a link's distance in
/// mm.
type Measured = [(f64, f64); COUNT];

/// The distances of a robot's links.
type Engine<'a> = Box<dyn FnMut(&Chain, &Pose) -> Result<Vec<f64>, String> + 'a>;

fn measure<T: SearchPrecision + Number>(mesh: &TriMesh) -> Result<Measured, String> {
    let [(_, capsules), (_, fitted), (_, flat)] = models().map_err(|error| error.to_string())?;
    let mut engines = [
        (&capsules, packed::<T>(mesh)?),
        (&fitted, packed::<T>(mesh)?),
        (&flat, packed::<T>(mesh)?),
        (&capsules, one_by_one::<T, Convex>(mesh)),
        (&fitted, one_by_one::<T, Convex>(mesh)),
        (&fitted, one_by_one::<T, QuarticAsPrinted<Companion>>(mesh)),
        (&flat, one_by_one::<T, Convex>(mesh)),
        (&flat, one_by_one::<T, QuarticAsPrinted<ClosedForm>>(mesh)),
    ];
    let base = ventricle::entry();
    let mut exact = Exhaustive::<f64>::new(mesh).map_err(|error| error.to_string())?;
    let mut right = Vec::new();
    let mut measured = [(f64::INFINITY, 0.0_f64); COUNT];
    let mut taken = [0.0; COUNT];
    for round in 0..ROUNDS {
        for (((robot, engine), (least, error)), taken) in
            engines.iter_mut().zip(&mut measured).zip(&mut taken)
        {
            if round > 0 && *taken > ENOUGH {
                continue;
            }
            let begin = Instant::now();
            let answer = engine(robot, &base)?;
            let time = begin.elapsed().as_secs_f64();
            *least = least.min(time);
            *taken += time;
            if round == 0 {
                exact.per_link(robot, &base, &mut right).map_err(|error| error.to_string())?;
                for (right, answer) in right.iter().zip(&answer) {
                    *error = error.max((right.distance - answer).abs());
                }
            }
        }
    }
    Ok(measured)
}

/// The library's engine, without culling.
fn packed<T: SearchPrecision>(mesh: &TriMesh) -> Result<Engine<'static>, String> {
    let mut engine = Exhaustive::<T>::new(mesh).map_err(|error| error.to_string())?;
    engine.set_culling(false);
    let mut answer = Vec::new();
    Ok(Box::new(move |robot, pose| {
        engine.per_link(robot, pose, &mut answer).map_err(|error| error.to_string())?;
        Ok(answer.iter().map(|link| link.distance).collect())
    }))
}

fn one_by_one<'a, T: Number + 'a, S: DiscSolver<T> + DiscSolver<f64> + 'a>(
    mesh: &TriMesh,
) -> Engine<'a> {
    let engine = EveryPair::<T, S>::new(mesh);
    Box::new(move |robot, pose| {
        Ok(engine.per_link(robot, pose).iter().map(|nearest| nearest.distance).collect())
    })
}

/// The chapter of the page. `largest` is the number of triangles for Table IV; long tables go to
/// `out`.
pub fn chapter(largest: usize, out: &Path) -> Result<String, String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| error.to_string())?;
    let mut sizes = Vec::new();
    let mut mesh = ventricle::mesh(ventricle::DEFAULT_TRIANGLES);
    loop {
        // The largest is a part of a finer, shuffled mesh.
        let last = mesh.1.len() >= largest;
        if last || mesh.1.len() < 200_000 {
            let (vertices, mut indices) = shuffled(mesh.clone(), 1);
            indices.truncate(largest);
            let mesh = TriMesh::new(vertices, indices).map_err(|error| error.to_string())?;
            let times = pool.install(|| -> Result<_, String> {
                Ok([measure::<f32>(&mesh)?, measure::<f64>(&mesh)?])
            })?;
            sizes.push((mesh.num_triangles(), times));
        }
        if last {
            break;
        }
        mesh = in_four(mesh);
    }
    let peak = [peak::single(), peak::double()];
    let text = |error: std::fmt::Error| error.to_string();
    // Double precision goes to the files, and into the findings.
    let shorten = |table: String, file: &str| {
        long_table::write(&table, &out.join(file), |cells| cells[0] == PRECISIONS[0])
    };
    let times = shorten(times(&sizes).map_err(text)?, "studies_engines.csv")?;
    let indices = shorten(indices(&sizes, peak).map_err(text)?, "studies_index.csv")?;
    write_page(&sizes, peak, [&times, &indices]).map_err(text)
}

fn finding(holds: bool) -> &'static str {
    if holds { "confirmed" } else { "refuted" }
}

/// Triangles, and what each engine took in both precisions.
type Size = (usize, [Measured; 2]);

/// Figure 9 as a table.
fn times(sizes: &[Size]) -> Result<String, std::fmt::Error> {
    let mut table = String::from("| precision | model | pairs and discs |");
    for (triangles, _) in sizes {
        write!(table, " {triangles} |")?;
    }
    write!(
        table,
        " time / capsules | error, mm |\n|---|---|---|{}---|---|\n",
        "---|".repeat(sizes.len())
    )?;
    let Some((_, last)) = sizes.last() else { return Ok(table) };
    for (precision, name) in PRECISIONS.into_iter().enumerate() {
        for (engine, (model, route, capsules)) in ENGINES.into_iter().enumerate() {
            write!(table, "| {name} | {model} | {route} |")?;
            for (_, times) in sizes {
                write!(table, " {:.1} |", times[precision][engine].0 * 1e3)?;
            }
            let ratio = last[precision][engine].0 / last[precision][capsules].0;
            let error = sizes.iter().map(|size| size.1[precision][engine].1).fold(0.0, f64::max);
            let error = if error == 0.0 { "0".into() } else { format!("{error:.0e}") };
            writeln!(table, " {ratio:.2} | {error} |")?;
        }
    }
    Ok(table)
}

/// 1 / (seconds x TFLOPS).
fn index(seconds: f64, peak: f64) -> f64 {
    1e12 / (seconds * peak)
}

/// Table IV.
fn indices(sizes: &[Size], peak: [f64; 2]) -> Result<String, std::fmt::Error> {
    let mut table = String::from(
        "| precision | model | pairs and discs | s | index | against P_comp | paper's GPU: s | index | against P_comp |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let Some((_, last)) = sizes.last() else { return Ok(table) };
    for (precision, name) in PRECISIONS.into_iter().enumerate() {
        for (engine, (model, route, _)) in ENGINES.into_iter().enumerate() {
            let seconds = last[precision][engine].0;
            let index = index(seconds, peak[precision]);
            let (paper_seconds, paper_index) = PAPER[precision][PAPERS[engine]];
            writeln!(
                table,
                "| {name} | {model} | {route} | {seconds:.3} | {index:.2} | {:.1} | {paper_seconds:.3} | {paper_index:.2} | \
                 {:.1} |",
                index / PEER.1,
                paper_index / PEER.1,
            )?;
        }
    }
    Ok(table)
}

fn write_page(
    sizes: &[Size],
    peak: [f64; 2],
    [times, indices]: [&str; 2],
) -> Result<String, std::fmt::Error> {
    let mut page = String::from(
        "## Figure 9 and Table IV: every triangle against 30 links\n\n\
         The ventricle of 6,000 triangles divided in four again and again, shuffled; one thread, no culling, so that each \
         pair costs its full distance. The models are capsules, links whose caps fit (Algorithm 1) and cylinders: K, Z* and Z \
         in the paper. Packed is this crate's exhaustive engine, in the widest instructions of the machine. One by one is a plain loop, the only way \
         for root finders, because they branch; it solves a disc only where the axis' nearest point is at a flat end. The \
         paper's choices are the closed form for cylinders and the companion matrix for fitted caps. Milliseconds of a query, \
         the least of up to five. The times are divided by those of capsules taken alike; the last column is the largest error of a link's \
         distance, once its nearest triangle is measured in double precision. The table is of single precision; \
         [studies_engines.csv](studies_engines.csv) has double precision too.\n\n",
    );
    page.push_str(times);
    let Some((triangles, last)) = sizes.last() else { return Ok(page) };
    let ratio = |engine: usize| last.map(|times| times[engine].0 / times[ENGINES[engine].2].0);
    let ([z32, z64], [s32, s64]) = (ratio(2), ratio(1));
    let ([a32, a64], [b32, b64]) = (ratio(6), ratio(4));
    let ([p32, p64], [c32, c64]) = (ratio(7), ratio(5));
    writeln!(
        page,
        "\nFinding: the paper's CPU takes 2.29 times as long for cylinders as for capsules, and no longer for fitted caps. With \
         its solvers that is {p32:.2} (f32) and {p64:.2} (f64) for cylinders here, and {c32:.2} and {c64:.2} for fitted caps; \
         with the convex route {a32:.2} and {a64:.2} for cylinders, and {b32:.2} and {b64:.2} for fitted caps; packed {z32:.2} \
         and {z64:.2} for cylinders, and {s32:.2} and {s64:.2} for fitted caps. So fitted caps cost less than cylinders: {}; \
         and no more than capsules: {} without culling. (Culling, the engine's default, brings cylinders near capsules: \
         [SPEED.md](../SPEED.md).)",
        finding(s32 < z32 && s64 < z64 && c32 < p32 && c64 < p64),
        finding([s32, s64, c32, c64].iter().all(|ratio| *ratio < 1.05)),
    )?;
    write!(
        page,
        "\n### Table IV, {triangles} triangles\n\n\
         The index is 1 / (seconds x TFLOPS), higher is better. The paper divides by its GPU's nominal peak (5.24 TFLOPS in \
         float, 2.62 in double). A CPU's nominal peak depends on a clock that varies, so the peak here is measured: \
         {:.4} TFLOPS (f32) and {:.4} (f64) for this one thread, from independent fused multiply-adds in the widest \
         vectors, two operations each. The table is of single precision; [studies_index.csv](studies_index.csv) has double precision \
         too.\n\n",
        peak[0] / 1e12,
        peak[1] / 1e12
    )?;
    page.push_str(indices);
    let index = |precision: usize, engine: usize| index(last[precision][engine].0, peak[precision]);
    let ahead = (0..2).all(|p| (0..COUNT).all(|engine| index(p, engine) > PEER.1));
    writeln!(
        page,
        "\nP_comp is the peer of the paper's Table IV, {} s on a GPU of 3.21 TFLOPS, index {}. Finding: that every model, even \
         cylinders with their root finding, beats it per TFLOPS is {} on this CPU. Per TFLOPS the convex route reaches {:.1} (f32) \
         and {:.1} (f64) times the paper's index for cylinders.",
        PEER.0,
        PEER.1,
        finding(ahead),
        index(0, 2) / PAPER[0][2].1,
        index(1, 2) / PAPER[1][2].1,
    )?;
    Ok(page)
}
