//! A scene: several meshes with margins, and several robots.

use crate::answers::{
    Answer, pc_decision, pc_scene_clearance_answer, pc_scene_contact, pc_scene_motion_answer,
    pc_structure_proximity, pc_tightest,
};
use crate::border::{BatchPoses, Place};
use crate::error::{Fault, pc_status};
use crate::mesh::{fill, pc_mesh, placed, write_each};
use crate::motion::pc_motion;
use crate::robot::{pc_chain, pc_tube};
use crate::structure_end::pc_structure_end;
use parry_continuum::proximity::{Scene, SceneContact, SceneError, StructureProximity};
use std::ffi::c_char;

/// Several meshes, each with its own margin or none. It remembers its last answers, as a mesh does.
#[derive(Default)]
pub struct pc_scene {
    scene: Scene,
    found: Vec<StructureProximity>,
    structures: Vec<pc_structure_proximity>,
    found_contacts: Vec<SceneContact>,
    contacts: Vec<pc_scene_contact>,
}

impl pc_scene {
    /// Refuses the number of a structure that the scene does not have.
    fn check(&self, structure: usize) -> Result<(), SceneError> {
        let structures = self.scene.len();
        if structure < structures {
            return Ok(());
        }
        Err(SceneError::NoSuchStructure { structure, structures })
    }
}

/// `count` sets of `each` items, one after another.
fn sets<T>(items: &[T], each: usize, count: usize) -> Vec<&[T]> {
    (0..count).map(|set| &items[set * each..][..each]).collect()
}

/// The sets with a bad pose, in order, and what is wrong with the first of each.
fn bad_sets(poses: BatchPoses, each: usize) -> Vec<(usize, Fault)> {
    let bad = poses.bad.into_iter();
    let mut sets: Vec<_> =
        bad.map(|(robot, fault)| (robot / each, fault.of_robot(robot % each))).collect();
    sets.dedup_by_key(|(set, _)| *set);
    sets
}

/// Writes the answers about sets, as `write_batch`.
fn write_sets<T, A: Answer>(
    found: Vec<Result<T, SceneError>>,
    bad: Vec<(usize, Fault)>,
    answers: &mut Place<A>,
    statuses: &mut Option<Place<pc_status>>,
    convert: impl Fn(T) -> A,
) -> Result<(), Fault> {
    write_each("set", found.into_iter(), bad, statuses, |set, found| {
        answers.set_at(set, found.map_or(A::NONE, &convert));
    })
}

/// A margin, or none, which is NaN in C.
fn margin_of(margin: f64) -> Option<f64> {
    (!margin.is_nan()).then_some(margin)
}

/// Makes an empty scene. `robot_margin` is that between two robots, and `self_margin` that of a
/// moving robot and itself; NaN is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_new(
    robot_margin: f64,
    self_margin: f64,
    scene: *mut *mut pc_scene,
) -> pc_status {
    border!(scene: new_handle => {
        let mut made = Scene::new();
        made.set_robot_margin(margin_of(robot_margin))?;
        made.set_self_margin(margin_of(self_margin))?;
        scene.set(pc_scene { scene: made, ..pc_scene::default() });
        Ok(())
    })
}

/// Frees a scene. The meshes that were added stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_free(scene: *mut pc_scene) {
    free!(scene);
}

/// Adds a clone of a mesh as a structure. Each structure has its own `name`, which messages use.
/// `margin` NaN is none: the structure is then reported and never tested. `pose` leads from the
/// mesh's frame to the scene's. Structures count from 0. After an error the scene is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_add(
    scene: *mut pc_scene,
    name: *const c_char,
    mesh: *const pc_mesh,
    margin: f64,
    pose: *const f64,
    structure: *mut usize,
) -> pc_status {
    border!(scene: exclusive, name: text, mesh: shared, pose: pose, structure: place => {
        let added = scene.scene.add(name, mesh.search.clone(), margin_of(margin))?;
        scene.scene.set_pose(added, &pose)?;
        structure.set(added);
        Ok(())
    })
}

/// Changes the margin of a structure; NaN is none. Margins from single robots stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_margin(
    scene: *mut pc_scene,
    structure: usize,
    margin: f64,
) -> pc_status {
    border!(scene: exclusive => Ok(scene.scene.set_margin(structure, margin_of(margin))?))
}

/// Says how far a robot must be from a structure; NaN is none. `robot` is its place in the lists of
/// robots of the questions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_margin_between(
    scene: *const pc_scene,
    structure: usize,
    robot: usize,
    margin: *mut f64,
) -> pc_status {
    border!(scene: shared, margin: place => {
        scene.check(structure)?;
        margin.set(scene.scene.margin_between(structure, robot).unwrap_or(f64::NAN));
        Ok(())
    })
}

/// Sets the margin between a structure and one robot, in place of the structure's margin. NaN is
/// none: the two may touch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_margin_between(
    scene: *mut pc_scene,
    structure: usize,
    robot: usize,
    margin: f64,
) -> pc_status {
    border!(scene: exclusive => {
        Ok(scene.scene.set_margin_between(structure, robot, margin_of(margin))?)
    })
}

/// Changes the margin between two robots; NaN is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_robot_margin(scene: *mut pc_scene, margin: f64) -> pc_status {
    border!(scene: exclusive => Ok(scene.scene.set_robot_margin(margin_of(margin))?))
}

/// Changes the margin of a robot and itself; NaN is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_self_margin(scene: *mut pc_scene, margin: f64) -> pc_status {
    border!(scene: exclusive => Ok(scene.scene.set_self_margin(margin_of(margin))?))
}

/// Sets the pairs of robots that are nested, as a tube in the tube that guides it, in place of
/// earlier ones. Nested robots touch, so they are not tested against each other. `pairs` is two
/// places in the lists of robots for each pair.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_nested(
    scene: *mut pc_scene,
    pairs: *const usize,
    pair_count: usize,
) -> pc_status {
    border!(scene: exclusive, pairs: pairs(pair_count) => {
        scene.scene.set_nested(pairs);
        Ok(())
    })
}

/// Says whether a structure is solid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_is_solid(
    scene: *const pc_scene,
    structure: usize,
    is_solid: *mut bool,
) -> pc_status {
    border!(scene: shared, is_solid: place => {
        scene.check(structure)?;
        is_solid.set(scene.scene.is_solid(structure));
        Ok(())
    })
}

/// Makes a structure solid, or with 0 a surface, as it is at first. A robot inside of a solid
/// structure is in contact with it. Its mesh must be closed, and all triangles face the same way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_solid(
    scene: *mut pc_scene,
    structure: usize,
    is_solid: u32,
) -> pc_status {
    border!(scene: exclusive => Ok(scene.scene.set_solid(structure, is_solid != 0)?))
}

/// Builds all that later questions need, so that none of them builds anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_prepare(scene: *const pc_scene) -> pc_status {
    border!(scene: shared => {
        scene.scene.prepare();
        Ok(())
    })
}

/// Moves a structure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_pose(
    scene: *mut pc_scene,
    structure: usize,
    pose: *const f64,
) -> pc_status {
    border!(scene: exclusive, pose: pose => Ok(scene.scene.set_pose(structure, &pose)?))
}

/// Moves the vertices of a structure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_vertices(
    scene: *mut pc_scene,
    structure: usize,
    vertices: *const f64,
    vertex_count: usize,
) -> pc_status {
    border!(scene: exclusive, vertices: points(vertex_count) => {
        Ok(scene.scene.set_vertices(structure, vertices)?)
    })
}

/// Says whether `count` robots keep all margins. `poses` are one for each, or NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears(
    scene: *mut pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    count: usize,
    clears: *mut bool,
) -> pc_status {
    border!(scene: exclusive, robots: handles(count), poses: poses(count), clears: place => {
        let robots: Vec<_> = robots.iter().map(|robot| &robot.chain).zip(poses).collect();
        clears.set(scene.scene.clears(&robots)?);
        Ok(())
    })
}

/// Says whether each of `count` sets of `robot_count` robots keeps all margins, on all cores.
/// `robots` has the sets one after another; so has `poses`, or it is NULL. The answer of a refused
/// set is false, and its status is not `PC_OK`; `statuses` may be NULL. The first such set is the
/// error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears_batch(
    scene: *const pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    robot_count: usize,
    count: usize,
    clears: *mut bool,
    statuses: *mut pc_status,
) -> pc_status {
    border!(scene: shared, robots: handles(robot_count.saturating_mul(count)),
        poses: batch_poses(robot_count.saturating_mul(count)), clears: places(count),
        statuses: places_or_none(count) =>
    {
        let robots = placed(robots.iter().map(|robot| &robot.chain), &poses);
        let (sets, mut found) = (sets(&robots, robot_count, count), Vec::new());
        scene.scene.clears_batch(&sets, &mut found);
        write_sets(found, bad_sets(poses, robot_count), &mut clears, &mut statuses, |clears| clears)
    })
}

/// Finds the least slack: the least distance less the margin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_tightest(
    scene: *mut pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    count: usize,
    tightest: *mut pc_tightest,
) -> pc_status {
    border!(scene: exclusive, robots: handles(count), poses: poses(count), tightest: place => {
        let robots: Vec<_> = robots.iter().map(|robot| &robot.chain).zip(poses).collect();
        tightest.set(scene.scene.tightest(&robots)?.into());
        Ok(())
    })
}

/// The same for `count` sets of robots, on all cores, as `pc_scene_clears_batch`. The answer of a
/// refused set is NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_tightest_batch(
    scene: *const pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    robot_count: usize,
    count: usize,
    tightest: *mut pc_tightest,
    statuses: *mut pc_status,
) -> pc_status {
    border!(scene: shared, robots: handles(robot_count.saturating_mul(count)),
        poses: batch_poses(robot_count.saturating_mul(count)), tightest: places(count),
        statuses: places_or_none(count) =>
    {
        let robots = placed(robots.iter().map(|robot| &robot.chain), &poses);
        let (sets, mut found) = (sets(&robots, robot_count, count), Vec::new());
        scene.scene.tightest_batch(&sets, &mut found);
        let bad = bad_sets(poses, robot_count);
        write_sets(found, bad, &mut tightest, &mut statuses, pc_tightest::from)
    })
}

/// Finds where the robots are closest to each structure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_per_structure(
    scene: *mut pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    robot_count: usize,
    structures: *mut *const pc_structure_proximity,
    count: *mut usize,
) -> pc_status {
    border!(scene: exclusive, robots: handles(robot_count), poses: poses(robot_count),
        structures: list, count: place =>
    {
        let robots: Vec<_> = robots.iter().map(|robot| &robot.chain).zip(poses).collect();
        scene.scene.per_structure(&robots, &mut scene.found)?;
        fill(&mut scene.structures, &scene.found, |found| found.into());
        structures.set_counted(&scene.structures, &mut count);
        Ok(())
    })
}

/// Finds every contact within `reach` of a structure, as `pc_mesh_contacts_within`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_contacts_within(
    scene: *mut pc_scene,
    robots: *const *const pc_chain,
    poses: *const f64,
    robot_count: usize,
    reach: f64,
    prominence: f64,
    contacts: *mut *const pc_scene_contact,
    count: *mut usize,
) -> pc_status {
    border!(scene: exclusive, robots: handles(robot_count), poses: poses(robot_count),
        contacts: list, count: place =>
    {
        let robots: Vec<_> = robots.iter().map(|robot| &robot.chain).zip(poses).collect();
        let found = &mut scene.found_contacts;
        scene.scene.contacts_within(&robots, reach, prominence, found)?;
        fill(&mut scene.contacts, &scene.found_contacts, |found| found.into());
        contacts.set_counted(&scene.contacts, &mut count);
        Ok(())
    })
}

/// Says whether `count` tubes keep all margins.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears_tube(
    scene: *mut pc_scene,
    tubes: *const *const pc_tube,
    poses: *const f64,
    count: usize,
    resolution: f64,
    decision: *mut pc_decision,
) -> pc_status {
    border!(scene: exclusive, tubes: handles(count), poses: poses(count), decision: place => {
        let tubes: Vec<_> = tubes.iter().map(|tube| &tube.tube).zip(poses).collect();
        decision.set(scene.scene.clears_tube(&tubes, resolution)?.into());
        Ok(())
    })
}

/// Bounds the least slack of `count` tubes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clearance(
    scene: *mut pc_scene,
    tubes: *const *const pc_tube,
    poses: *const f64,
    count: usize,
    tolerance: f64,
    clearance: *mut pc_scene_clearance_answer,
) -> pc_status {
    border!(scene: exclusive, tubes: handles(count), poses: poses(count), clearance: place => {
        let tubes: Vec<_> = tubes.iter().map(|tube| &tube.tube).zip(poses).collect();
        clearance.set(scene.scene.clearance(&tubes, tolerance)?.into());
        Ok(())
    })
}

fn refer<'a>(motions: &[&'a pc_motion]) -> Vec<&'a (dyn parry_continuum::Motion + Send + Sync)> {
    motions.iter().map(|motion| motion.motion()).collect()
}

/// Says whether `count` robots that move keep all margins at every time from 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears_motion(
    scene: *mut pc_scene,
    motions: *const *const pc_motion,
    count: usize,
    resolution: f64,
    answer: *mut pc_scene_motion_answer,
) -> pc_status {
    border!(scene: exclusive, motions: handles(count), answer: place => {
        answer.set((&scene.scene.clears_motion(&refer(&motions), resolution)?).into());
        Ok(())
    })
}

/// The same for `count` sets of `robot_count` motions, on all cores, as `pc_scene_clears_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears_motion_batch(
    scene: *const pc_scene,
    motions: *const *const pc_motion,
    robot_count: usize,
    count: usize,
    resolution: f64,
    answers: *mut pc_scene_motion_answer,
    statuses: *mut pc_status,
) -> pc_status {
    border!(scene: shared, motions: handles(robot_count.saturating_mul(count)),
        answers: places(count), statuses: places_or_none(count) =>
    {
        let motions = refer(&motions);
        let (sets, mut found) = (sets(&motions, robot_count, count), Vec::new());
        scene.scene.clears_motion_batch(&sets, resolution, &mut found);
        let convert = |found| pc_scene_motion_answer::from(&found);
        write_sets(found, Vec::new(), &mut answers, &mut statuses, convert)
    })
}

/// The same while `end_count` structures move too, to their `ends`. A structure that is not listed
/// rests. The scene itself stays as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clears_motion_while(
    scene: *mut pc_scene,
    ends: *const pc_structure_end,
    end_count: usize,
    motions: *const *const pc_motion,
    count: usize,
    resolution: f64,
    answer: *mut pc_scene_motion_answer,
) -> pc_status {
    border!(scene: exclusive, ends: structure_ends(end_count), motions: handles(count),
        answer: place =>
    {
        let found = scene.scene.clears_motion_while(&ends, &refer(&motions), resolution)?;
        answer.set((&found).into());
        Ok(())
    })
}

/// Finds the first time at which a margin is not kept, within `resolution`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_time_of_contact(
    scene: *mut pc_scene,
    motions: *const *const pc_motion,
    count: usize,
    resolution: f64,
    answer: *mut pc_scene_motion_answer,
) -> pc_status {
    border!(scene: exclusive, motions: handles(count), answer: place => {
        answer.set((&scene.scene.time_of_contact(&refer(&motions), resolution)?).into());
        Ok(())
    })
}

/// Bounds the least slack of `count` robots that move.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_clearance_of_motion(
    scene: *mut pc_scene,
    motions: *const *const pc_motion,
    count: usize,
    tolerance: f64,
    clearance: *mut pc_scene_clearance_answer,
) -> pc_status {
    border!(scene: exclusive, motions: handles(count), clearance: place => {
        let found = scene.scene.clearance_of_motion(&refer(&motions), tolerance)?;
        clearance.set(found.into());
        Ok(())
    })
}
