//! Questions about chains that both devices answer: large batches of a mesh on the GPU go there.

use crate::error::Refused;
use crate::input::{Block, Caps, Given, Robots};
use crate::threads::{
    Asked, DeviceKind, DeviceSession, Engine, FirstRefused, LARGEST_CHUNK, Rows, Session, compute,
    device_failure, in_chunks, pool,
};
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{BvhSearch, LinkProximity, Proximity, ProximityError};
use parry_continuum::{Chain, RobotError};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::Arc;

/// The links of a chunk for the GPU, whose search divides them into chunks of up to 2^18 links that
/// overlap. Not measured: more would take more memory, fewer would wait more often.
const LINKS: usize = 1 << 19;
/// The links for each thread from which a batch of any question runs on the GPU.
const LINKS_PER_THREAD: usize = 15_000;

/// Makes a chain that of a robot, in the memory that it has.
pub(crate) fn set_chain<'a>(
    chain: &'a mut Option<Chain>,
    robot: &Given<'_>,
    caps: Caps,
) -> Result<&'a Chain, Refused> {
    fill(chain, robot, caps).map_err(|error| robot.names.apply(error))
}

fn fill<'a>(
    chain: &'a mut Option<Chain>,
    robot: &Given<'_>,
    caps: Caps,
) -> Result<&'a Chain, RobotError> {
    Ok(match (chain, caps) {
        (Some(chain), Caps::Fitted) => {
            chain.set_centreline(robot.points, robot.radii)?;
            chain
        }
        (chain, Caps::Fitted) => chain.insert(Chain::from_centreline(robot.points, robot.radii)?),
        (chain, Caps::Capsules) => chain.insert(Chain::capsules(robot.points, robot.radii)?),
        (chain, Caps::Cylinders) => chain.insert(Chain::cylinders(robot.points, robot.radii)?),
    })
}

/// A question about chains.
pub(super) trait ChainQuestion: Sync {
    /// What is kept of an answer; there are one or more for each robot.
    type Row: Clone + Send;
    /// An answer of the library.
    type Answer;

    /// Asks about one robot. `links` is memory that is used again.
    fn ask(
        &self,
        search: &mut BvhSearch,
        robot: (&Chain, &Pose),
        links: &mut Vec<LinkProximity>,
        rows: &mut [Self::Row],
    ) -> Result<(), ProximityError>;

    /// Asks about many.
    ///
    /// # Errors
    /// The device has failed, or all robots are refused.
    fn ask_batch(
        &self,
        search: &mut impl Proximity,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<Result<Self::Answer, ProximityError>>,
    ) -> Result<(), ProximityError>;

    /// Keeps what is needed of an answer.
    fn keep(answer: &Self::Answer, rows: &mut [Self::Row]);
}

/// As `ask_each`. The search of a mesh on the GPU gets whole chunks, and chooses the device.
pub(super) fn ask_chains<Q: ChainQuestion>(
    py: Python<'_>,
    engine: &Arc<Engine>,
    robots: &Robots<'_>,
    (question, caps): (&Q, Caps),
    (empty, width): (Q::Row, usize),
    take: impl FnMut(usize, &[Q::Row]),
) -> PyResult<()> {
    let few = <Robots<'_> as Asked>::FEW;
    let is_batch = robots.len() >= few;
    let largest = match engine.device() {
        DeviceKind::Cpu => None,
        DeviceKind::Gpu => {
            let links = LINKS.max(LINKS_PER_THREAD * pool(py)?.current_num_threads());
            Some(links.div_ceil(robots.segments_each().max(1)).max(few))
        }
    };
    let answer = |session: &mut Session, robot: &Given<'_>, row: &mut [Q::Row]| {
        let Session { search, chain, links, .. } = session;
        let chain = set_chain(chain, robot, caps)?;
        Ok(question.ask(search, (chain, &robot.pose()?), links, row)?)
    };
    let ask = |block: &Block, rows: &mut [Q::Row]| {
        // After a move the search on the CPU may take long to refit, even for one robot.
        if largest.is_some() && (is_batch || engine.is_stale(py)) {
            let pool = pool(py)?;
            if let Some(mut session) = engine.lend_device(py)? {
                let ask = || {
                    pool.install(|| ask_device(&mut session, (question, caps), block, width, rows))
                };
                let answered = compute(py, ask);
                engine.take_back_device(py, answered.is_ok().then_some(session));
                let refused = answered?.map_err(|refused| refused.raise(py, None))?;
                return Ok((rows.len() / width, refused));
            }
        }
        Rows::<Robots<'_>, _> { block, width, answer: &answer }.ask_lender(py, engine, robots, rows)
    };
    let sizes = largest.unwrap_or(few)..=largest.unwrap_or(LARGEST_CHUNK);
    in_chunks(py, robots, (empty, width), sizes, ask, take)
}

/// Answers all robots of a block, on the device or on the CPU, as the search chooses.
///
/// # Errors
/// The device has failed.
fn ask_device<Q: ChainQuestion>(
    session: &mut DeviceSession,
    (question, caps): (&Q, Caps),
    block: &Block,
    width: usize,
    rows: &mut [Q::Row],
) -> Result<FirstRefused, Refused> {
    let count = rows.len() / width;
    let DeviceSession { search, chains, .. } = session;
    if chains.len() < count {
        chains.resize_with(count, || None);
    }
    let chains = &mut chains[..count];
    let build = |(place, chain): (usize, &mut Option<Chain>)| -> Result<Pose, Refused> {
        let robot = block.robot(place);
        set_chain(chain, &robot, caps)?;
        robot.pose()
    };
    let poses: Vec<_> = chains.par_iter_mut().enumerate().map(build).collect();
    // The library may refuse a robot before the first that is none.
    let placed: Vec<_> = chains
        .iter()
        .zip(&poses)
        .map_while(|(chain, pose)| Some((chain.as_ref()?, *pose.as_ref().ok()?)))
        .collect();
    let mut out = Vec::new();
    if !placed.is_empty()
        && let Err(error) = question.ask_batch(search, &placed, &mut out)
    {
        return match device_failure(&error) {
            Some(failure) => Err(failure),
            None => Ok(Some((0, error.into()))),
        };
    }
    for ((place, answer), rows) in out.into_iter().enumerate().zip(rows.chunks_mut(width)) {
        match answer {
            Ok(answer) => Q::keep(&answer, rows),
            Err(error) => return Ok(Some((place, error.into()))),
        }
    }
    Ok(poses.into_iter().enumerate().find_map(|(place, pose)| Some((place, pose.err()?))))
}
