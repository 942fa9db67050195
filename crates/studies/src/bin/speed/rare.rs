//! How much longer than its median a question about a new shape may take, once the engine is prepared.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_demo::steer::Random;
use continuum_demo::{cavity, ctr};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::proximity::{BvhSearch, Contact, Proximity, ProximityError};
use std::fmt::Write;
use std::hint::black_box;
use std::time::Instant;

/// How many shapes are asked about.
const SHAPES: usize = 100_000;

/// How often each: what counts is the least time, so that whatever else the machine does is left out.
const ROUNDS: usize = 3;

/// Contacts up to so far away, mm.
const MARGIN: f64 = 3.0;

/// How many times its median the worst may take.
const MOST: f64 = 20.0;

type Query =
    (&'static str, fn(&mut BvhSearch, &Chain, &Pose, &mut Vec<Contact>) -> Result<(), ProximityError>);

const QUERIES: [Query; 3] = [
    ("clears", |search, robot, pose, _| {
        black_box(search.clears(robot, pose, 0.0)?);
        Ok(())
    }),
    ("minimum", |search, robot, pose, _| {
        black_box(search.minimum(robot, pose)?);
        Ok(())
    }),
    ("within", |search, robot, pose, contacts| search.within(robot, pose, MARGIN, 0.0, contacts)),
];

/// The chapter of the page.
pub fn chapter(effort: Effort, goals: &mut Goals) -> Result<String, String> {
    let mut page = format!(
        "## The worst of many\n\n\
         {SHAPES} random shapes of three tubes, 30 links each, in the cavity: each new, without any memory of the last one, and \
         asked about {ROUNDS} times, of which the least time counts. `prepare` was called before, so that no question builds \
         anything. Shapes that touch the wall and those that are free apart; `clears` with margin 0, `within` with {MARGIN} mm. \
         Microseconds: the median, what one shape in a thousand exceeds, and the worst; and the worst over the median.\n\n\
         | query | triangles | touching | p50 | p99.9 | worst | worst / p50 | free | p50 | p99.9 | worst | worst / p50 |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    let inwards = Vector::new(-0.3, 0.2, 1.0).normalize();
    let base = Pose::from_parts(Vector::new(20.0, 0.0, -30.0), Rot3::from_rotation_arc(Vector::Z, inwards));
    for level in [4, 6, 8].into_iter().filter(|level| *level <= 4 + effort.largest) {
        let mesh = cavity::mesh(level);
        let search = BvhSearch::new(&mesh).map_err(|error| error.to_string())?;
        search.prepare();
        for (name, query) in QUERIES {
            let _ = write!(page, "| `{name}` | {} |", mesh.num_triangles());
            for (kind, mut times) in ["touching", "free"].into_iter().zip(least_times(&search, &base, query)?)
            {
                times.sort_unstable_by(f64::total_cmp);
                let Some(&worst) = times.last() else { return Err(format!("no shape is {kind}")) };
                let (median, rare) = (times[times.len() / 2], times[times.len() - 1 - times.len() / 1000]);
                let _ = write!(
                    page,
                    " {} | {median:.1} | {rare:.1} | {worst:.1} | {:.1} |",
                    times.len(),
                    worst / median
                );
                goals.note(
                    &format!("{name}, the worst of {SHAPES}, {kind}"),
                    Goal::AtMost(MOST),
                    worst / median,
                );
            }
            page.push('\n');
        }
    }
    Ok(page)
}

/// The least time of each shape in microseconds: of those that touch, and of those that are free.
fn least_times(
    search: &BvhSearch,
    base: &Pose,
    query: fn(&mut BvhSearch, &Chain, &Pose, &mut Vec<Contact>) -> Result<(), ProximityError>,
) -> Result<[Vec<f64>; 2], String> {
    let robot = ctr::three_tubes();
    let (mut search, mut contacts) = (search.clone(), Vec::new());
    let mut least = vec![f64::INFINITY; SHAPES];
    let mut is_free = vec![false; SHAPES];
    for _ in 0..ROUNDS {
        let mut random = Random(7);
        for shape in 0..SHAPES {
            let line = robot.centreline(&robot.any_joints(&mut random), 30);
            let chain =
                Chain::from_centreline(&line.points, &line.radii).map_err(|error| error.to_string())?;
            search.forget();
            let begin = Instant::now();
            query(&mut search, &chain, base, &mut contacts).map_err(|error| error.to_string())?;
            least[shape] = least[shape].min(begin.elapsed().as_secs_f64() * 1e6);
            is_free[shape] = search.clears(&chain, base, 0.0).map_err(|error| error.to_string())?;
        }
    }
    let of = |free: bool| {
        least.iter().zip(&is_free).filter(|(_, is_free)| **is_free == free).map(|(time, _)| *time).collect()
    };
    Ok([of(false), of(true)])
}
