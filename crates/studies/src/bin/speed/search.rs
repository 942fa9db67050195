//! Search against parry: all links, the minimum, and clearance.

use crate::Effort;
use crate::goals::{Goal, Goals};
use continuum_scene::cavity;
use continuum_scene::timing::{self, medians};
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::query::{self, ClosestPoints};
use parry_continuum::parry::shape::{Cylinder, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity, Work};
use std::cell::RefCell;
use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

/// parry's fair peer of `clears`: it may stop looking beyond the margin, and stops at the first link within it.
fn parry_clears(
    mesh: &TriMesh,
    links: &[(Pose, Cylinder)],
    pose: &Pose,
    margin: f64,
) -> Result<bool, String> {
    for (place, cylinder) in links {
        let found = query::closest_points(&(*pose * *place), cylinder, &Pose::IDENTITY, mesh, margin);
        if found.map_err(|error| error.to_string())? != ClosestPoints::Disjoint {
            return Ok(false);
        }
    }
    Ok(true)
}

/// How many queries a job makes in its turn, all but parry's distances, so that each finds its own data in the caches.
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

/// The chapter of the page, and its table for the README.
pub fn chapter(effort: Effort, goals: &mut Goals) -> Result<(String, String), String> {
    let mut page = String::from(
        "## Search\n\n\
         A bumpy cavity of about 100 mm with a robot of 30 links (1.2, 0.9 and 0.5 mm) inside, 60 moving frames: at \
         the wall about 2 mm away from it, and in the middle about 19 mm. The peer is parry's `distance(Cylinder, \
         TriMesh)` for each of the 30 links; for `clears` it is `closest_points(max_dist = margin)` for each link, \
         with half the clearance as margin. Cold: without the last answers. Queries in bursts of 60. Times faster than \
         the peer:\n\n",
    );
    let mut table = String::from(
        "| scene | triangles | parry, 30 links | per link, cold | per link, warm | minimum, cold | minimum, warm | clears |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    let mut visits = String::from(
        "\nWork for each link of a per-link query (a pack of up to 16 counts once; measured: in double precision):\n\n\
         | scene | triangles | nodes, cold | leaves, cold | measured, cold | nodes, warm | leaves, warm | measured, warm |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    // The cavity of level 4 is about as large as a ventricle that has not been divided.
    for level in [4, 6, 7, 8].into_iter().filter(|level| *level <= 4 + effort.largest) {
        let mesh = cavity::mesh(level);
        for (scene, clearance) in [("wall", 2.0), ("middle", 20.0)] {
            let (row, work) = row(scene, clearance, &mesh, effort, goals)?;
            table.push_str(&row);
            visits.push_str(&work);
        }
    }
    page.push_str(&table);
    Ok((page + &visits, table))
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
    let (mut cold, mut warm, mut cold_least, mut warm_least, mut clears) =
        (engine()?, engine()?, engine()?, engine()?, engine()?);
    let (mut out, mut warm_out) = (Vec::new(), Vec::new());
    let pose = || motion.borrow_mut().pose();
    let text = |error: parry_continuum::proximity::ProximityError| error.to_string();
    let times = medians::<String>(
        &mut [
            &mut || timing::parry(mesh, &cylinders, &pose()).map(keep).map_err(|e| e.to_string()),
            &mut || burst(|| parry_clears(mesh, &cylinders, &pose(), margin).map(keep)),
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
            &mut || burst(|| clears.clears(&robot, &pose(), margin).map(keep).map_err(text)),
        ],
        effort.enough,
    )?;
    let mut times: Vec<_> = times.iter().map(Duration::as_secs_f64).collect();
    times[1..].iter_mut().for_each(|time| *time /= BURST as f64);
    let triangles = mesh.num_triangles();
    let mut row = format!("| {scene} | {triangles} | {:.2} ms |", times[0] * 1e3);
    for (job, peer) in [(2, 0), (3, 0), (4, 0), (5, 0), (6, 1)] {
        let _ = write!(row, " {:.0} x ({:.1} us) |", times[peer] / times[job], times[job] * 1e6);
    }
    row.push('\n');
    match triangles {
        0..=100_000 => {
            goals.note("per link, cold, to 100,000 triangles", Goal::AtLeast(50.0), times[0] / times[2])
        }
        1_000_000.. => {
            goals.note("per link, cold, at 1.3 million", Goal::AtLeast(150.0), times[0] / times[2])
        }
        _ => {}
    }
    goals.note("per link, warm against cold", Goal::AtLeast(2.0), times[2] / times[3]);
    if (50_000..=100_000).contains(&triangles) {
        goals.note("minimum, cold, at 82,000 triangles", Goal::AtLeast(500.0), times[0] / times[4]);
    }
    goals.note("clears, all sizes", Goal::AtLeast(20.0), times[1] / times[6]);

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
