//! How long a control loop may have to wait: not the median of a query alone, but its rare worst.

use crate::Effort;
use continuum_demo::cavity;
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{BvhSearch, Contact, LinkProximity, Proximity, ProximityError};
use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// How many bytes other work walks through, so that nothing of a query is left in the caches.
pub const OTHER_WORK: usize = 64 << 20;

/// How far contacts may be away, mm: the robot keeps about 2 mm.
const MARGIN: f64 = 3.0;

/// Fewer ticks than this tell no p99.9.
const TICKS: usize = 1000;

/// A loop that queries one engine at every tick.
struct Loop {
    search: BvhSearch,
    robot: Chain,
    links: Vec<LinkProximity>,
    contacts: Vec<Contact>,
}

/// A query and its name.
type Query = (&'static str, fn(&mut Loop, &Pose) -> Result<(), ProximityError>);

const QUERIES: [Query; 4] = [
    ("minimum", |turn, pose| {
        black_box(turn.search.minimum(&turn.robot, pose)?);
        Ok(())
    }),
    ("clears", |turn, pose| {
        black_box(turn.search.clears(&turn.robot, pose, 1.0)?);
        Ok(())
    }),
    ("per_link", |turn, pose| turn.search.per_link(&turn.robot, pose, &mut turn.links)),
    ("contacts_within", |turn, pose| {
        turn.search.contacts_within(&turn.robot, pose, MARGIN, 0.0, &mut turn.contacts)
    }),
];

/// Returns the chapter of the page.
pub fn chapter(effort: Effort) -> Result<String, String> {
    let mut page = format!(
        "## Latency\n\n\
         The robot of 30 links at the wall of the cavity, one query a tick, with the answers of the tick before. *Alone*: \
         nothing else runs between two ticks. *After other work*: between two ticks {} MB of other data pass through the caches. `clears` with 1 mm, \
         `contacts_within` with {MARGIN} mm. Microseconds: the median, what one tick in a thousand exceeds, and the largest.\n\n\
         | query | triangles | ticks | alone: p50 | p99.9 | largest | ticks | after other work: p50 | p99.9 | largest |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
        OTHER_WORK >> 20
    );
    let mut other_work = vec![0_u8; OTHER_WORK];
    for level in [4, 6].into_iter().filter(|level| *level <= 4 + effort.largest) {
        let mesh = cavity::mesh(level);
        let search = BvhSearch::new(&mesh).map_err(|error| error.to_string())?;
        for (name, query) in QUERIES {
            let _ = write!(page, "| `{name}` | {} |", mesh.num_triangles());
            for is_after_work in [false, true] {
                let (search, robot) = (search.clone(), cavity::chain(2.0));
                let mut turn = Loop { search, robot, links: Vec::new(), contacts: Vec::new() };
                let between = |tick: usize| {
                    if is_after_work {
                        walk(&mut other_work, tick);
                    }
                };
                let times = latencies(effort.enough / 4, between, |pose| query(&mut turn, pose))
                    .map_err(|error| error.to_string())?;
                let micros = |time: Duration| time.as_secs_f64() * 1e6;
                // The time that one in a thousand exceeds.
                let rare = times[times.len() - 1 - times.len() / 1000];
                let _ = write!(
                    page,
                    " {} | {:.1} | {:.1} | {:.1} |",
                    times.len(),
                    micros(times[times.len() / 2]),
                    micros(rare),
                    micros(times[times.len() - 1])
                );
            }
            page.push('\n');
        }
    }
    Ok(page)
}

/// The sorted times of one query a tick along a slow motion, until `enough` has passed.
fn latencies(
    enough: Duration,
    mut between: impl FnMut(usize),
    mut query: impl FnMut(&Pose) -> Result<(), ProximityError>,
) -> Result<Vec<Duration>, ProximityError> {
    let poses = cavity::frames(997);
    let least = if enough.is_zero() { TICKS / 50 } else { TICKS };
    let (start, mut times) = (Instant::now(), Vec::new());
    while times.len() < least || start.elapsed() < enough {
        between(times.len());
        let begin = Instant::now();
        query(&poses[times.len() % poses.len()])?;
        times.push(begin.elapsed());
    }
    times.sort();
    Ok(times)
}

/// Writes to every line of the caches.
pub fn walk(bytes: &mut [u8], tick: usize) {
    const LINE: usize = 64;
    bytes.iter_mut().step_by(LINE).for_each(|byte| *byte = byte.wrapping_add(tick as u8));
    black_box(bytes);
}
