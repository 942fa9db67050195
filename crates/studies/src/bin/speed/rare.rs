//! How much longer than its median a question about a new shape may take, once the engine is
//! prepared.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_demo::steer::Random;
use continuum_demo::{cavity, ctr};
use cpu_time::ThreadTime;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::proximity::{BvhSearch, Proximity, ProximityError};
use std::fmt::Write;
use std::hint::black_box;

/// Number of shapes.
const SHAPES: usize = 100_000;

/// Repetitions per shape. The least processor time of the thread counts, which excludes other
/// processes.
const ROUNDS: usize = 3;

/// Contacts up to so far away, mm.
const MARGIN: f64 = 3.0;

/// How many times its median the worst may take.
const MOST: f64 = 20.0;

/// Between these marks the page has the chapter.
pub const MARK: &str = "rare";

/// The query.
const QUERIES: [&str; 3] = ["clears", "minimum", "contacts_within"];

/// The chapter of the page, without its marks.
pub fn chapter(effort: Effort, written: &str, goals: &mut Goals) -> Result<String, String> {
    // A rehearsal takes fewer.
    let shapes = if effort.enough.is_zero() { SHAPES / 100 } else { SHAPES };
    let mut page = format!(
        "## The worst of many\n\n\
         {written}. {shapes} random shapes of three tubes, 30 links each, in the cavity: each new, without a warm start, and \
         queried {ROUNDS} times. The least processor time of the thread counts, the clock included. `prepare` was called \
         before, so that no query builds anything. Touching and free shapes are separate; `clears` with margin 0, `contacts_within` with \
         {MARGIN} mm. Microseconds: the median, what one shape in a thousand exceeds, and the worst; and the worst over the \
         median. Most free shapes are decided by one test of a body around the whole robot, so the median of `clears` \
         and `contacts_within` is that test. The worst free shapes are as near to the wall as touching ones, and cost as much.\n\n\
         | query | triangles | touching | p50 | p99.9 | worst | worst / p50 | free | p50 | p99.9 | worst | worst / p50 |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    let inwards = Vector::new(-0.3, 0.2, 1.0).normalize();
    let base = Pose::from_parts(
        Vector::new(20.0, 0.0, -30.0),
        Rot3::from_rotation_arc(Vector::Z, inwards),
    );
    for level in [4, 6, 8].into_iter().filter(|level| *level <= 4 + effort.largest) {
        let mesh = cavity::mesh(level);
        let mut search = BvhSearch::new(&mesh).map_err(|error| error.to_string())?;
        search.prepare();
        let least = least_times(&mut search, &base, shapes)?;
        for (number, name) in QUERIES.iter().enumerate() {
            let _ = write!(page, "| `{name}` | {} |", mesh.num_triangles());
            for (kind, is_free) in [("touching", false), ("free", true)] {
                let of_kind = least.iter().filter(|shape| shape.is_free == is_free);
                let mut times: Vec<_> = of_kind.map(|shape| shape.micros[number]).collect();
                times.sort_unstable_by(f64::total_cmp);
                let Some(&worst) = times.last() else { return Err(format!("no shape is {kind}")) };
                let (median, rare) =
                    (times[times.len() / 2], times[times.len() - 1 - times.len() / 1000]);
                let _ = write!(
                    page,
                    " {} | {median:.1} | {rare:.1} | {worst:.1} | {:.1} |",
                    times.len(),
                    worst / median
                );
                goals.note(
                    &format!("{name}, the worst of {shapes}, {kind}"),
                    Goal::AtMost(MOST),
                    worst / median,
                );
            }
            page.push('\n');
        }
    }
    Ok(page)
}

/// The times of a shape, and whether it touches.
#[derive(Clone)]
struct Shape {
    is_free: bool,
    /// The least time of each query.
    micros: [f64; QUERIES.len()],
}

/// The least times of each shape.
fn least_times(search: &mut BvhSearch, base: &Pose, shapes: usize) -> Result<Vec<Shape>, String> {
    let robot = ctr::three_tubes();
    let mut contacts = Vec::new();
    let mut least = vec![Shape { is_free: false, micros: [f64::INFINITY; QUERIES.len()] }; shapes];
    for _ in 0..ROUNDS {
        let mut random = Random(7);
        for shape in &mut least {
            let line = robot.centreline(&robot.any_joints(&mut random), 30);
            let chain = Chain::from_centreline(&line.points, &line.radii)
                .map_err(|error| error.to_string())?;
            let mut timed = |number: usize, query: &mut dyn FnMut(&mut BvhSearch) -> Asked| {
                search.forget();
                let begin = ThreadTime::now();
                let answer = query(search);
                let micros = begin.elapsed().as_secs_f64() * 1e6;
                shape.micros[number] = shape.micros[number].min(micros);
                answer.map_err(|error| error.to_string())
            };
            shape.is_free = timed(0, &mut |search| search.clears(&chain, base, 0.0))?;
            timed(1, &mut |search| {
                search.minimum(&chain, base).map(|found| black_box(found).distance > 0.0)
            })?;
            timed(2, &mut |search| {
                search.contacts_within(&chain, base, MARGIN, 0.0, &mut contacts).map(|()| true)
            })?;
        }
    }
    Ok(least)
}

type Asked = Result<bool, ProximityError>;
