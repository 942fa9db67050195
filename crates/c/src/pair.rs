//! Questions about two robots, and about one robot and itself.

use crate::answers::{
    Answer, pc_decision, pc_robot_clearance, pc_robot_motion_answer, pc_robot_proximity,
};
use crate::border::BatchPoses;
use crate::error::{Fault, pc_status};
use crate::mesh::{fill, placed, write_batch};
use crate::motion::pc_motion;
use crate::robot::{pc_chain, pc_tube};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::proximity::{RobotPair, RobotProximity, SelfQuery};

/// Questions about two robots. It remembers its last answers, as a mesh does.
#[derive(Default)]
pub struct pc_pair {
    pair: RobotPair,
    found: Vec<RobotProximity>,
    places: Vec<pc_robot_proximity>,
}

impl pc_pair {
    fn list(&mut self) -> &[pc_robot_proximity] {
        fill(&mut self.places, &self.found, |found| found.into());
        &self.places
    }
}

/// Makes a handle for questions about two robots.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_new(pair: *mut *mut pc_pair) -> pc_status {
    border!(pair: new_handle => {
        pair.set(pc_pair::default());
        Ok(())
    })
}

/// Frees it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_free(pair: *mut pc_pair) {
    free!(pair);
}

/// Finds where two robots are closest to each other. Both poses lead into the same frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_minimum(
    pair: *mut pc_pair,
    robot_a: *const pc_chain,
    pose_a: *const f64,
    robot_b: *const pc_chain,
    pose_b: *const f64,
    minimum: *mut pc_robot_proximity,
) -> pc_status {
    border!(pair: exclusive, robot_a: shared, pose_a: pose, robot_b: shared, pose_b: pose,
        minimum: place =>
    {
        let found = pair.pair.minimum(&robot_a.chain, &pose_a, &robot_b.chain, &pose_b)?;
        minimum.set((&found).into());
        Ok(())
    })
}

/// Robots, and where they are.
type Placed<'a> = (&'a Chain, Pose);

/// The pairs of a batch, and the refused ones, in order.
fn pairs<'a>(
    a: (Vec<&'a pc_chain>, BatchPoses),
    b: (Vec<&'a pc_chain>, BatchPoses),
) -> (Vec<[Placed<'a>; 2]>, Vec<(usize, Fault)>) {
    let [a_placed, b_placed] =
        [&a, &b].map(|(robots, poses)| placed(robots.iter().map(|robot| &robot.chain), poses));
    let mut bad: Vec<_> = a.1.bad.into_iter().chain(b.1.bad).collect();
    bad.sort_by_key(|(pair, _)| *pair);
    bad.dedup_by_key(|(pair, _)| *pair);
    (a_placed.into_iter().zip(b_placed).map(|(a, b)| [a, b]).collect(), bad)
}

/// Finds where each of `count` pairs of robots are closest, on all cores, as
/// `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_minimum_batch(
    pair: *const pc_pair,
    robots_a: *const *const pc_chain,
    poses_a: *const f64,
    robots_b: *const *const pc_chain,
    poses_b: *const f64,
    count: usize,
    minima: *mut pc_robot_proximity,
    statuses: *mut pc_status,
) -> pc_status {
    border!(pair: shared, robots_a: handles(count), poses_a: batch_poses(count),
        robots_b: handles(count), poses_b: batch_poses(count), minima: places(count),
        statuses: places_or_none(count) =>
    {
        let (pairs, bad) = pairs((robots_a, poses_a), (robots_b, poses_b));
        let mut found = Vec::new();
        pair.pair.minimum_batch(&pairs, &mut found);
        write_batch(found, bad, &mut minima, &mut statuses, |found| found.into())
    })
}

/// Says whether each of `count` pairs of robots keep more than the margin apart, on all cores, as
/// `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clears_batch(
    pair: *const pc_pair,
    robots_a: *const *const pc_chain,
    poses_a: *const f64,
    robots_b: *const *const pc_chain,
    poses_b: *const f64,
    count: usize,
    margin: f64,
    clears: *mut bool,
    statuses: *mut pc_status,
) -> pc_status {
    border!(pair: shared, robots_a: handles(count), poses_a: batch_poses(count),
        robots_b: handles(count), poses_b: batch_poses(count), clears: places(count),
        statuses: places_or_none(count) =>
    {
        let (pairs, bad) = pairs((robots_a, poses_a), (robots_b, poses_b));
        let mut found = Vec::new();
        pair.pair.clears_batch(&pairs, margin, &mut found)?;
        write_batch(found, bad, &mut clears, &mut statuses, |clears| *clears)
    })
}

/// The same for pairs of motions, at every time from 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clears_motions_batch(
    pair: *const pc_pair,
    motions_a: *const *const pc_motion,
    motions_b: *const *const pc_motion,
    count: usize,
    margin: f64,
    resolution: f64,
    answers: *mut pc_robot_motion_answer,
    statuses: *mut pc_status,
) -> pc_status {
    border!(pair: shared, motions_a: handles(count), motions_b: handles(count),
        answers: places(count), statuses: places_or_none(count) =>
    {
        let pairs = motions_a.iter().zip(&motions_b).map(|(a, b)| (a.motion(), b.motion()));
        let (pairs, mut found): (Vec<_>, _) = (pairs.collect(), Vec::new());
        pair.pair.clears_motions_batch(&pairs, margin, resolution, &mut found)?;
        write_batch(found, Vec::new(), &mut answers, &mut statuses, |found| found.into())
    })
}

/// Finds for each link of the first robot the closest link of the second.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_per_link(
    pair: *mut pc_pair,
    robot_a: *const pc_chain,
    pose_a: *const f64,
    robot_b: *const pc_chain,
    pose_b: *const f64,
    links: *mut *const pc_robot_proximity,
    count: *mut usize,
) -> pc_status {
    border!(pair: exclusive, robot_a: shared, pose_a: pose, robot_b: shared, pose_b: pose,
        links: list, count: place =>
    {
        let (a, b) = (&robot_a.chain, &robot_b.chain);
        pair.pair.per_link(a, &pose_a, b, &pose_b, &mut pair.found)?;
        links.set_counted(pair.list(), &mut count);
        Ok(())
    })
}

/// Finds every place where two robots are within the margin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_contacts_within(
    pair: *mut pc_pair,
    robot_a: *const pc_chain,
    pose_a: *const f64,
    robot_b: *const pc_chain,
    pose_b: *const f64,
    margin: f64,
    contacts: *mut *const pc_robot_proximity,
    count: *mut usize,
) -> pc_status {
    border!(pair: exclusive, robot_a: shared, pose_a: pose, robot_b: shared, pose_b: pose,
        contacts: list, count: place =>
    {
        let (a, b) = (&robot_a.chain, &robot_b.chain);
        pair.pair.contacts_within(a, &pose_a, b, &pose_b, margin, &mut pair.found)?;
        contacts.set_counted(pair.list(), &mut count);
        Ok(())
    })
}

/// Says whether two robots keep more than the margin apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clears(
    pair: *mut pc_pair,
    robot_a: *const pc_chain,
    pose_a: *const f64,
    robot_b: *const pc_chain,
    pose_b: *const f64,
    margin: f64,
    clears: *mut bool,
) -> pc_status {
    border!(pair: exclusive, robot_a: shared, pose_a: pose, robot_b: shared, pose_b: pose,
        clears: place =>
    {
        let (a, b) = (&robot_a.chain, &robot_b.chain);
        clears.set(pair.pair.clears(a, &pose_a, b, &pose_b, margin)?);
        Ok(())
    })
}

/// Bounds how near two tubes are. The bounds are at most `tolerance` apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clearance(
    pair: *mut pc_pair,
    tube_a: *const pc_tube,
    pose_a: *const f64,
    tube_b: *const pc_tube,
    pose_b: *const f64,
    tolerance: f64,
    clearance: *mut pc_robot_clearance,
) -> pc_status {
    border!(pair: exclusive, tube_a: shared, pose_a: pose, tube_b: shared, pose_b: pose,
        clearance: place =>
    {
        let (a, b) = (&tube_a.tube, &tube_b.tube);
        clearance.set((&pair.pair.clearance(a, &pose_a, b, &pose_b, tolerance)?).into());
        Ok(())
    })
}

/// Says whether two tubes keep more than the margin apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clears_tubes(
    pair: *mut pc_pair,
    tube_a: *const pc_tube,
    pose_a: *const f64,
    tube_b: *const pc_tube,
    pose_b: *const f64,
    margin: f64,
    resolution: f64,
    decision: *mut pc_decision,
) -> pc_status {
    border!(pair: exclusive, tube_a: shared, pose_a: pose, tube_b: shared, pose_b: pose,
        decision: place =>
    {
        let (a, b) = (&tube_a.tube, &tube_b.tube);
        decision.set(pair.pair.clears_tubes(a, &pose_a, b, &pose_b, margin, resolution)?.into());
        Ok(())
    })
}

/// Says whether two motions keep more than the margin apart at every time from 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clears_motions(
    pair: *mut pc_pair,
    motion_a: *const pc_motion,
    motion_b: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_robot_motion_answer,
) -> pc_status {
    border!(pair: exclusive, motion_a: shared, motion_b: shared, answer: place => {
        let (a, b) = (&motion_a.motion(), &motion_b.motion());
        answer.set((&pair.pair.clears_motions(a, b, margin, resolution)?).into());
        Ok(())
    })
}

/// Finds the first time at which two motions do not keep the margin, within `resolution`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_time_of_contact(
    pair: *mut pc_pair,
    motion_a: *const pc_motion,
    motion_b: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_robot_motion_answer,
) -> pc_status {
    border!(pair: exclusive, motion_a: shared, motion_b: shared, answer: place => {
        let (a, b) = (&motion_a.motion(), &motion_b.motion());
        answer.set((&pair.pair.time_of_contact(a, b, margin, resolution)?).into());
        Ok(())
    })
}

/// Bounds how near two motions come. The bounds are at most `tolerance` apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_pair_clearance_of_motion(
    pair: *mut pc_pair,
    motion_a: *const pc_motion,
    motion_b: *const pc_motion,
    tolerance: f64,
    clearance: *mut pc_robot_clearance,
) -> pc_status {
    border!(pair: exclusive, motion_a: shared, motion_b: shared, clearance: place => {
        let (a, b) = (&motion_a.motion(), &motion_b.motion());
        clearance.set((&pair.pair.clearance_of_motion(a, b, tolerance)?).into());
        Ok(())
    })
}

/// Questions about one robot and itself. It remembers its last answers, as a mesh does.
#[derive(Default)]
pub struct pc_self_query {
    query: SelfQuery,
}

/// Makes a handle for questions about one robot and itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_new(query: *mut *mut pc_self_query) -> pc_status {
    border!(query: new_handle => {
        query.set(pc_self_query::default());
        Ok(())
    })
}

/// Frees it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_free(query: *mut pc_self_query) {
    free!(query);
}

/// Finds where two parts of a robot that are not neighbours are closest. The distance is infinite
/// if no two parts could meet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_minimum(
    query: *mut pc_self_query,
    robot: *const pc_chain,
    minimum: *mut pc_robot_proximity,
) -> pc_status {
    border!(query: exclusive, robot: shared, minimum: place => {
        let found = query.query.minimum(&robot.chain)?;
        minimum.set(found.as_ref().map_or(Answer::NONE, pc_robot_proximity::from));
        Ok(())
    })
}

/// Says whether a robot keeps more than the margin from itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_clears(
    query: *mut pc_self_query,
    robot: *const pc_chain,
    margin: f64,
    clears: *mut bool,
) -> pc_status {
    border!(query: exclusive, robot: shared, clears: place => {
        clears.set(query.query.clears(&robot.chain, margin)?);
        Ok(())
    })
}

/// The same for a tube.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_clears_tube(
    query: *mut pc_self_query,
    tube: *const pc_tube,
    margin: f64,
    resolution: f64,
    decision: *mut pc_decision,
) -> pc_status {
    border!(query: exclusive, tube: shared, decision: place => {
        decision.set(query.query.clears_tube(&tube.tube, margin, resolution)?.into());
        Ok(())
    })
}

/// The same for a motion, at every time from 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_self_query_clears_motion(
    query: *mut pc_self_query,
    motion: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_robot_motion_answer,
) -> pc_status {
    border!(query: exclusive, motion: shared, answer: place => {
        let found = query.query.clears_motion(&motion.motion(), margin, resolution)?;
        answer.set((&found).into());
        Ok(())
    })
}
