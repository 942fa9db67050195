//! A scene: several meshes with margins, and several robots.

use crate::answers::{
    pc_decision, pc_scene_clearance_answer, pc_scene_contact, pc_scene_motion_answer,
    pc_structure_proximity, pc_tightest,
};
use crate::error::pc_status;
use crate::mesh::{fill, pc_mesh};
use crate::motion::pc_motion;
use crate::robot::{pc_chain, pc_tube};
use parry_continuum::proximity::{Scene, SceneContact, StructureProximity};
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

/// Adds a clone of a mesh as a structure. `name` is for messages, `margin` NaN is none: the
/// structure is then reported and never tested. `pose` leads from the mesh's frame to the scene's.
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

/// Changes the margin of a structure; NaN is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_scene_set_margin(
    scene: *mut pc_scene,
    structure: usize,
    margin: f64,
) -> pc_status {
    border!(scene: exclusive => Ok(scene.scene.set_margin(structure, margin_of(margin))?))
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
        structures.set(&scene.structures, &mut count);
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
        contacts.set(&scene.contacts, &mut count);
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
