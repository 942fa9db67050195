//! Search against parry: all links, the minimum, and clearance.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_demo::cavity;
use continuum_demo::timing::{self, medians};
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::query::{self, ClosestPoints};
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity, Work};
use std::cell::RefCell;
use std::fmt::Write;
use std::hint::black_box;

/// parry's fair peer of `clears`: it may stop looking beyond the margin, and stops at the first
/// link within it.
fn parry_clears(
    mesh: &TriMesh,
    links: &[(Pose, Cylinder)],
    pose: &Pose,
    margin: f64,
) -> Result<bool, String> {
    for (place, cylinder) in links {
        let found =
            query::closest_points(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh, margin);
        if found.map_err(|error| error.to_string())? != ClosestPoints::Disjoint {
            return Ok(false);
        }
    }
    Ok(true)
}

/// parry's fair peer of `minimum`: no link looks farther than the nearest so far.
fn parry_minimum(mesh: &TriMesh, links: &[(Pose, Cylinder)], pose: &Pose) -> Result<f64, String> {
    let mut least = f64::MAX;
    for (place, cylinder) in links {
        let found =
            query::closest_points(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh, least);
        match found.map_err(|error| error.to_string())? {
            ClosestPoints::Intersecting => return Ok(0.0),
            ClosestPoints::WithinMargin(one, other) => least = least.min(one.distance(other)),
            ClosestPoints::Disjoint => {}
        }
    }
    Ok(least)
}

/// How many queries a job makes in its turn, all but parry's distances, so that each finds its own
/// data in the caches.
const BURST: usize = 60;

fn burst(mut query: impl FnMut() -> Result<(), String>) -> Result<(), String> {
    (0..BURST).try_for_each(|_| query())
}

/// Uses an answer, so that the query is not optimised away.
fn keep<T>(answer: T) {
    black_box(answer);
}

/// The poses of a slow motion, one at a time, for ever.
struct Motion {
    frames: Vec<Pose>,
    next: usize,
}

impl Motion {
    fn pose(&mut self) -> Pose {
        self.next = (self.next + 1) % self.frames.len();
        self.frames[self.next]
    }
}

/// The head of the table; the README has some of its rows.
pub const HEAD: &str = "\
| wall | triangles | all links: parry | first time | again | closest link: parry | first time | again | enough room: parry | again |
|---|---|---|---|---|---|---|---|---|---|
";

/// The chapter of the page, and the rows of its table.
pub fn chapter(effort: Effort, goals: &mut Goals) -> Result<(String, Vec<String>), String> {
    let mut page = String::from(
        "## Search\n\n\
         A bumpy cavity of about 100 mm with a robot of 30 links (1.2, 0.9 and 0.5 mm) inside, 60 moving frames: near the \
         wall, about 2 mm away from it, and far, about 19 mm. Microseconds per query, and how many times faster than \
         parry. First time: without a warm start. Again: with the answers of the previous frame. Queries in bursts of \
         60.\n\n\
         - All links (`per_link`): parry's `distance(Cylinder, TriMesh)` for each of them.\n\
         - The closest link (`minimum`): parry's `closest_points` for each of them, never farther than the nearest so far.\n\
         - Enough room (`clears`), with half the clearance as margin: parry's `closest_points` within the margin for each \
         of them, until one is.\n\n",
    );
    let mut rows = Vec::new();
    let mut visits = String::from(
        "\nWork for each link of a per-link query (a pack of up to 16 counts once; measured: in double precision):\n\n\
         | wall | triangles | nodes, first time | leaves, first time | measured, first time | nodes, again | leaves, again | measured, again |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    // The cavity of level 4 is about as large as a ventricle that has not been divided.
    for level in [4, 6, 7, 8].into_iter().filter(|level| *level <= 4 + effort.largest) {
        let mesh = cavity::mesh(level);
        for (scene, clearance) in [("near", 2.0), ("far", 20.0)] {
            let (row, work) = row(scene, clearance, &mesh, effort, goals)?;
            rows.push(row);
            visits.push_str(&work);
        }
    }
    page.push_str(HEAD);
    page.extend(rows.iter().map(String::as_str));
    Ok((page + &visits, rows))
}

fn row(
    scene: &str,
    clearance: f64,
    mesh: &TriMesh,
    effort: Effort,
    goals: &mut Goals,
) -> Result<(String, String), String> {
    let robot = cavity::chain(clearance);
    let cylinders = timing::cylinders(&robot);
    let margin = 0.5 * clearance;
    let motion = RefCell::new(Motion { frames: cavity::frames(60), next: 0 });
    let engine = || BvhSearch::new(mesh).map_err(|error| error.to_string());
    let (mut cold, mut warm, mut cold_least, mut warm_least, mut room) =
        (engine()?, engine()?, engine()?, engine()?, engine()?);
    let (mut out, mut warm_out) = (Vec::new(), Vec::new());
    let pose = || motion.borrow_mut().pose();
    let text = |error: parry_continuum::proximity::ProximityError| error.to_string();
    let times = medians::<String>(
        &mut [
            &mut || timing::parry(mesh, &cylinders, &pose()).map(keep).map_err(|e| e.to_string()),
            &mut || burst(|| parry_clears(mesh, &cylinders, &pose(), margin).map(keep)),
            &mut || parry_minimum(mesh, &cylinders, &pose()).map(keep),
            &mut || {
                burst(|| {
                    cold.forget();
                    cold.per_link(&robot, &pose(), &mut out).map_err(text)
                })
            },
            &mut || burst(|| warm.per_link(&robot, &pose(), &mut warm_out).map_err(text)),
            &mut || {
                burst(|| {
                    cold_least.forget();
                    cold_least.minimum(&robot, &pose()).map(keep).map_err(text)
                })
            },
            &mut || burst(|| warm_least.minimum(&robot, &pose()).map(keep).map_err(text)),
            &mut || burst(|| room.clears(&robot, &pose(), margin).map(keep).map_err(text)),
        ],
        effort.enough,
    )?;
    let mut times: Vec<_> = times.iter().map(|time| time.as_secs_f64() * 1e6).collect();
    [1, 3, 4, 5, 6, 7].into_iter().for_each(|job| times[job] /= BURST as f64);
    let [all, room, closest, per_link, per_link_again, minimum, minimum_again, clears] = times[..]
    else {
        return Err("a job was not timed".into());
    };
    let triangles = mesh.num_triangles();
    let cell = |time: f64, peer: f64| format!("{time:.1} ({:.0} x)", peer / time);
    let row = format!(
        "| {scene} | {triangles} | {all:.0} | {} | {} | {closest:.0} | {} | {} | {room:.0} | {} |\n",
        cell(per_link, all),
        cell(per_link_again, all),
        cell(minimum, closest),
        cell(minimum_again, closest),
        cell(clears, room),
    );
    match triangles {
        0..=100_000 => goals.note(
            "per link, first time, to 100,000 triangles",
            Goal::AtLeast(50.0),
            all / per_link,
        ),
        1_000_000.. => {
            goals.note("per link, first time, at 1.3 million", Goal::AtLeast(150.0), all / per_link)
        }
        _ => {}
    }
    goals.note("per link, again against first time", Goal::AtLeast(2.0), per_link / per_link_again);
    if (50_000..=100_000).contains(&triangles) {
        goals.note(
            "minimum, first time, at 82,000 triangles, peer not bounded",
            Goal::AtLeast(500.0),
            all / minimum,
        );
    }
    goals.note("clears, all sizes", Goal::AtLeast(20.0), room / clears);

    let frames = cavity::frames(60);
    let mut work = format!("| {scene} | {triangles} |");
    for forget in [true, false] {
        let before = warm.work();
        for pose in &frames {
            if forget {
                warm.forget();
            }
            warm.per_link(&robot, pose, &mut warm_out).map_err(text)?;
        }
        let each = |count: fn(&Work) -> u64| {
            let links = frames.len() * robot.links().len();
            (count(&warm.work()) - count(&before)) as f64 / links as f64
        };
        let (nodes, leaves) = (each(|work| work.nodes), each(|work| work.visited) / 16.0);
        let _ = write!(work, " {nodes:.1} | {leaves:.1} | {:.1} |", each(|work| work.measured));
    }
    work.push('\n');
    Ok((row, work))
}
