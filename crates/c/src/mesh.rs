//! A mesh, and the questions about one robot near it.

use crate::answers::{
    Answer, pc_clearance, pc_contact, pc_decision, pc_derivative, pc_inside_answer, pc_minimum,
    pc_motion_answer, pc_side, pc_surface,
};
use crate::border::{BatchPoses, Place};
use crate::error::{Fault, pc_status};
use crate::motion::pc_motion;
use crate::robot::{pc_chain, pc_tube};
use mesh_files::{Frame, Options, load_with, to_obj};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{
    BvhSearch, Contact, LinkProximity, Proof, Proximity, ProximityError, Side,
};
use std::ffi::c_char;
use std::fs;
use std::path::Path;

/// The frame of a mesh is not known, or stays as it is.
pub const PC_FRAME_UNKNOWN: u32 = 0;
/// Right, anterior, superior: the axes of NIfTI and 3D Slicer.
pub const PC_FRAME_RAS: u32 = 1;
/// Left, posterior, superior: the axes of DICOM and ITK.
pub const PC_FRAME_LPS: u32 = 2;

/// A triangle mesh that is asked how near robots are to it. It remembers its last answers, which
/// makes the next question about a similar robot faster and never changes an answer.
pub struct pc_mesh {
    pub(crate) search: BvhSearch,
    skipped_faces: usize,
    frame: Option<Frame>,
    links: Vec<LinkProximity>,
    minima: Vec<pc_minimum>,
    batch: Vec<Result<Vec<LinkProximity>, ProximityError>>,
    firsts: Vec<usize>,
    found: Vec<Contact>,
    contacts: Vec<pc_contact>,
    link_sides: Vec<Side>,
    sides: Vec<pc_side>,
}

impl pc_mesh {
    fn new(search: BvhSearch, skipped_faces: usize, frame: Option<Frame>) -> Self {
        Self {
            search,
            skipped_faces,
            frame,
            links: Vec::new(),
            minima: Vec::new(),
            batch: Vec::new(),
            firsts: Vec::new(),
            found: Vec::new(),
            contacts: Vec::new(),
            link_sides: Vec::new(),
            sides: Vec::new(),
        }
    }
}

/// Replaces the items of `list`.
pub(crate) fn fill<T, U>(list: &mut Vec<U>, of: &[T], convert: impl Fn(&T) -> U) {
    list.clear();
    list.extend(of.iter().map(convert));
}

/// Puts the robots of a batch at their poses.
pub(crate) fn placed<'a, R>(
    robots: impl IntoIterator<Item = &'a R>,
    poses: &BatchPoses,
) -> Vec<(&'a R, Pose)> {
    robots.into_iter().zip(poses.poses.iter().copied()).collect()
}

/// Writes the answers of a batch. The first refused robot is the error; it and each other one have
/// their own `statuses`, if those are wanted. `bad`: robots that are refused in any case, in order.
pub(crate) fn write_batch<T, A: Answer, E: Into<Fault>>(
    found: Vec<Result<T, E>>,
    bad: Vec<(usize, Fault)>,
    answers: &mut Place<A>,
    statuses: &mut Option<Place<pc_status>>,
    convert: impl Fn(&T) -> A,
) -> Result<(), Fault> {
    let found = found.into_iter().map(|found| found.map(|found| convert(&found)));
    write_each("robot", found, bad, statuses, |robot, found| {
        answers.set_at(robot, found.unwrap_or(A::NONE));
    })
}

/// The same, with answers of any kind, about robots or other items.
pub(crate) fn write_each<T, E: Into<Fault>>(
    item: &str,
    found: impl Iterator<Item = Result<T, E>>,
    bad: Vec<(usize, Fault)>,
    statuses: &mut Option<Place<pc_status>>,
    mut write: impl FnMut(usize, Option<T>),
) -> Result<(), Fault> {
    let (mut first, mut bad) = (None, bad.into_iter().peekable());
    for (index, found) in found.enumerate() {
        let found = match bad.next_if(|(bad, _)| *bad == index) {
            Some((_, fault)) => Err(fault),
            None => found.map_err(Into::into),
        };
        if let Some(statuses) = statuses {
            let status = found.as_ref().map_or_else(|fault| fault.status, |_| pc_status::PC_OK);
            statuses.set_at(index, status);
        }
        match found {
            Ok(found) => write(index, Some(found)),
            Err(fault) => {
                write(index, None);
                first.get_or_insert_with(|| fault.of(item, index));
            }
        }
    }
    first.map_or(Ok(()), Err)
}

/// Makes a mesh of `vertex_count` vertices and `triangle_count` triangles, which are three indices
/// of vertices each. Both are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_new(
    vertices: *const f64,
    vertex_count: usize,
    triangles: *const u32,
    triangle_count: usize,
    mesh: *mut *mut pc_mesh,
) -> pc_status {
    border!(mesh: new_handle, vertices: points(vertex_count),
        triangles: triangles(triangle_count) =>
    {
        mesh.set(pc_mesh::new(BvhSearch::from_triangles(vertices, triangles)?, 0, None));
        Ok(())
    })
}

/// Reads a mesh from a file: STL, OBJ, PLY, VTK, or the surface of a label map in NIfTI, NRRD or
/// MetaImage. `label` is the label of a label map, or -1. `scale` multiplies every coordinate.
/// `frame` is the frame that the mesh gets: `PC_FRAME_RAS` or `PC_FRAME_LPS`, a file that states
/// the other one is turned; `PC_FRAME_UNKNOWN` leaves it as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_load(
    path: *const c_char,
    label: i64,
    scale: f64,
    frame: u32,
    mesh: *mut *mut pc_mesh,
) -> pc_status {
    border!(mesh: new_handle, path: text => {
        let label = match label {
            -1 => None,
            _ => Some(u32::try_from(label).map_err(|_| {
                let text = format!("`label` is {label}; give a label of the file, or -1");
                Fault::argument("bad_label", text)
            })?),
        };
        let asked = match frame {
            PC_FRAME_UNKNOWN => None,
            PC_FRAME_RAS => Some(Frame::Ras),
            PC_FRAME_LPS => Some(Frame::Lps),
            _ => {
                let text = format!(
                    "`frame` is {frame}; give PC_FRAME_UNKNOWN, PC_FRAME_RAS or PC_FRAME_LPS"
                );
                return Err(Fault::argument("bad_frame", text));
            }
        };
        let mut read = load_with(path, &Options::scaled(scale).with_label(label))?;
        let stated = read.frame;
        if let Some(asked) = asked {
            // A file that states no frame is taken to be in this one.
            read.frame = Some(stated.unwrap_or(asked));
            read = read.in_frame(asked).unwrap_or_default();
        }
        let (skipped, frame) = (read.skipped_faces, read.frame);
        let (vertices, triangles) = read.into_parts::<Vector>();
        mesh.set(pc_mesh::new(BvhSearch::from_triangles(&vertices, &triangles)?, skipped, frame));
        Ok(())
    })
}

/// Makes a second handle of a mesh, for another thread. Both share the triangles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clone(
    mesh: *const pc_mesh,
    clone: *mut *mut pc_mesh,
) -> pc_status {
    border!(clone: new_handle, mesh: shared => {
        clone.set(pc_mesh::new(mesh.search.clone(), mesh.skipped_faces, mesh.frame));
        Ok(())
    })
}

/// Frees a mesh. Its clones stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_free(mesh: *mut pc_mesh) {
    free!(mesh);
}

/// Moves the vertices, as many as the mesh has. Clones keep theirs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_set_vertices(
    mesh: *mut pc_mesh,
    vertices: *const f64,
    vertex_count: usize,
) -> pc_status {
    border!(mesh: exclusive, vertices: points(vertex_count) => {
        Ok(mesh.search.set_vertices(vertices)?)
    })
}

/// Builds all that later questions need, so that none of them builds anything.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_prepare(mesh: *const pc_mesh) -> pc_status {
    border!(mesh: shared => {
        mesh.search.prepare();
        Ok(())
    })
}

/// Says what the mesh is as a surface, and what its file stated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_surface(
    mesh: *const pc_mesh,
    surface: *mut pc_surface,
) -> pc_status {
    border!(mesh: shared, surface: place => {
        let report = mesh.search.surface();
        surface.set(pc_surface {
            vertices: mesh.search.vertices().len(),
            triangles: mesh.search.triangles().len(),
            skipped_faces: mesh.skipped_faces,
            openings: report.openings.len(),
            nonmanifold_edges: report.nonmanifold_edges,
            misoriented_edges: report.misoriented_edges,
            frame: match mesh.frame {
                Some(Frame::Ras) => PC_FRAME_RAS,
                Some(Frame::Lps) => PC_FRAME_LPS,
                _ => PC_FRAME_UNKNOWN,
            },
            is_sound: report.is_sound(),
        });
        Ok(())
    })
}

/// Finds where a robot is closest to the mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_minimum(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    minimum: *mut pc_minimum,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, minimum: place => {
        minimum.set((&mesh.search.minimum(&robot.chain, &pose)?).into());
        Ok(())
    })
}

/// Finds where each of `count` robots is closest, on all cores. `poses` are one for each, or NULL.
/// The answer of a refused robot is NaN, and its status is not `PC_OK`; `statuses` may be NULL. The
/// first such robot is the error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_minimum_batch(
    mesh: *mut pc_mesh,
    robots: *const *const pc_chain,
    poses: *const f64,
    count: usize,
    minima: *mut pc_minimum,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, robots: handles(count), poses: batch_poses(count),
        minima: places(count), statuses: places_or_none(count) =>
    {
        let robots = placed(robots.iter().map(|robot| &robot.chain), &poses);
        let mut found = Vec::new();
        mesh.search.minimum_batch(&robots, &mut found)?;
        write_batch(found, poses.bad, &mut minima, &mut statuses, |found| found.into())
    })
}

/// Finds where each link of a robot is closest. A link is a segment that has a length.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_per_link(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    links: *mut *const pc_minimum,
    count: *mut usize,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, links: list, count: place => {
        mesh.search.per_link(&robot.chain, &pose, &mut mesh.links)?;
        fill(&mut mesh.minima, &mesh.links, |found| found.into());
        links.set_counted(&mesh.minima, &mut count);
        Ok(())
    })
}

/// Finds where each link of each of `count` robots is closest, on all cores. The links of robot `k`
/// are `links[firsts[k]]` to `links[firsts[k + 1] - 1]`; a refused robot has none. `firsts` has
/// `count + 1` items. Both lists belong to the mesh.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_per_link_batch(
    mesh: *mut pc_mesh,
    robots: *const *const pc_chain,
    poses: *const f64,
    count: usize,
    links: *mut *const pc_minimum,
    firsts: *mut *const usize,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, robots: handles(count), poses: batch_poses(count), links: list,
        firsts: list, statuses: places_or_none(count) =>
    {
        let robots = placed(robots.iter().map(|robot| &robot.chain), &poses);
        mesh.search.per_link_batch(&robots, &mut mesh.batch)?;
        mesh.minima.clear();
        mesh.firsts.clear();
        mesh.firsts.push(0);
        let found = mesh.batch.iter().map(|found| found.as_ref().map_err(|error| *error));
        let written = write_each("robot", found, poses.bad, &mut statuses, |_, found| {
            mesh.minima.extend(found.into_iter().flatten().map(pc_minimum::from));
            mesh.firsts.push(mesh.minima.len());
        });
        links.set(&mesh.minima);
        firsts.set(&mesh.firsts);
        written
    })
}

/// Says whether a robot keeps more than the margin away.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    margin: f64,
    clears: *mut bool,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, clears: place => {
        clears.set(mesh.search.clears(&robot.chain, &pose, margin)?);
        Ok(())
    })
}

/// The same for `count` robots, on all cores, as `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_batch(
    mesh: *mut pc_mesh,
    robots: *const *const pc_chain,
    poses: *const f64,
    count: usize,
    margin: f64,
    clears: *mut bool,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, robots: handles(count), poses: batch_poses(count),
        clears: places(count), statuses: places_or_none(count) =>
    {
        let robots = placed(robots.iter().map(|robot| &robot.chain), &poses);
        let mut found = Vec::new();
        mesh.search.clears_batch(&robots, margin, &mut found)?;
        write_batch(found, poses.bad, &mut clears, &mut statuses, |clears| *clears)
    })
}

/// The same for `count` robots of `section_count` sections of constant curvature each, on all
/// cores. A section is three numbers: its length, and its curvature towards x and towards y. All
/// robots have the same radii: one for each section, or a single one. A section becomes `segments`
/// straight links. All bases have the same `pose`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_sections_batch(
    mesh: *mut pc_mesh,
    sections: *const f64,
    section_count: usize,
    radii: *const f64,
    radius_count: usize,
    count: usize,
    segments: usize,
    pose: *const f64,
    margin: f64,
    clears: *mut bool,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, sections: points(section_count.saturating_mul(count)),
        radii: items(radius_count), pose: pose, clears: places(count),
        statuses: places_or_none(count) =>
    {
        let mut memory = Vec::new();
        let each = crate::robot::radii(radii, section_count, &mut memory);
        let sections = crate::motion::sections(sections, each, section_count)?;
        let robot = |k: usize| &sections[k * section_count..][..section_count];
        let robots: Vec<_> = (0..count).map(robot).collect();
        let mut found = Vec::new();
        mesh.search.clears_sections_batch(&robots, segments, &pose, margin, &mut found)?;
        write_batch(found, Vec::new(), &mut clears, &mut statuses, |clears| *clears)
    })
}

/// Finds every contact within the margin: all local minima of the distance. Contacts
/// that rise by less than `prominence` before a nearer one are left out; 0 keeps all.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_contacts_within(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    margin: f64,
    prominence: f64,
    contacts: *mut *const pc_contact,
    count: *mut usize,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, contacts: list, count: place => {
        let found = &mut mesh.found;
        mesh.search.contacts_within(&robot.chain, &pose, margin, prominence, found)?;
        fill(&mut mesh.contacts, &mesh.found, |found| found.into());
        contacts.set_counted(&mesh.contacts, &mut count);
        Ok(())
    })
}

/// Finds the derivative of the least distance with respect to the ends and the radius of the
/// closest link.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_derivative(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    derivative: *mut pc_derivative,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, derivative: place => {
        let (search, chain) = (&mut mesh.search, &robot.chain);
        let closest = search.minimum(chain, &pose)?;
        let value = search.contact_of(chain, &pose, &closest)?.depth;
        let found = search.derivative(chain, &pose, &closest)?;
        let end = |of: fn(&parry_continuum::proximity::Derivative) -> Vector| {
            found.as_ref().map_or([f64::NAN; 3], |found| of(found).to_array())
        };
        derivative.set(pc_derivative {
            value,
            start: end(|found| found.start),
            end: end(|found| found.end),
            radius: found.as_ref().map_or(f64::NAN, |found| found.radius),
            segment: closest.witness.segment,
            kink: found.as_ref().is_some_and(|found| found.kink),
        });
        Ok(())
    })
}

/// Says on which side of the mesh each of `count` points is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_side(
    mesh: *const pc_mesh,
    points: *const f64,
    count: usize,
    sides: *mut pc_side,
) -> pc_status {
    border!(mesh: shared, points: points(count), sides: places(count) => {
        for (k, point) in points.iter().enumerate() {
            sides.set_at(k, mesh.search.side(*point).into());
        }
        Ok(())
    })
}

/// Says on which side each link of a robot is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_link_sides(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    sides: *mut *const pc_side,
    count: *mut usize,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, sides: list, count: place => {
        mesh.search.link_sides(&robot.chain, &pose, &mut mesh.link_sides)?;
        fill(&mut mesh.sides, &mesh.link_sides, |side| (*side).into());
        sides.set_counted(&mesh.sides, &mut count);
        Ok(())
    })
}

/// Says whether a robot keeps the margin, and whether it is inside.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_inside(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    margin: f64,
    answer: *mut pc_inside_answer,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, answer: place => {
        answer.set(mesh.search.clears_inside(&robot.chain, &pose, margin)?.into());
        Ok(())
    })
}

/// Bounds the clearance of a tube. The bounds are at most `tolerance` apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clearance(
    mesh: *mut pc_mesh,
    tube: *const pc_tube,
    pose: *const f64,
    tolerance: f64,
    clearance: *mut pc_clearance,
) -> pc_status {
    border!(mesh: exclusive, tube: shared, pose: pose, clearance: place => {
        clearance.set((&mesh.search.clearance(&tube.tube, &pose, tolerance)?).into());
        Ok(())
    })
}

/// The same for `count` tubes, on all cores, as `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clearance_batch(
    mesh: *mut pc_mesh,
    tubes: *const *const pc_tube,
    poses: *const f64,
    count: usize,
    tolerance: f64,
    clearances: *mut pc_clearance,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, tubes: handles(count), poses: batch_poses(count),
        clearances: places(count), statuses: places_or_none(count) =>
    {
        let tubes = placed(tubes.iter().map(|tube| &tube.tube), &poses);
        let mut found = Vec::new();
        mesh.search.clearance_batch(&tubes, tolerance, &mut found)?;
        write_batch(found, poses.bad, &mut clearances, &mut statuses, |found| found.into())
    })
}

/// Says whether a tube keeps more than the margin away. It is undecided only within `resolution` of
/// the margin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_tube(
    mesh: *mut pc_mesh,
    tube: *const pc_tube,
    pose: *const f64,
    margin: f64,
    resolution: f64,
    decision: *mut pc_decision,
) -> pc_status {
    border!(mesh: exclusive, tube: shared, pose: pose, decision: place => {
        decision.set(mesh.search.clears_tube(&tube.tube, &pose, margin, resolution)?.into());
        Ok(())
    })
}

/// The same for `count` tubes, on all cores, as `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_tube_batch(
    mesh: *mut pc_mesh,
    tubes: *const *const pc_tube,
    poses: *const f64,
    count: usize,
    margin: f64,
    resolution: f64,
    decisions: *mut pc_decision,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, tubes: handles(count), poses: batch_poses(count),
        decisions: places(count), statuses: places_or_none(count) =>
    {
        let tubes = placed(tubes.iter().map(|tube| &tube.tube), &poses);
        let mut found = Vec::new();
        mesh.search.clears_tube_batch(&tubes, margin, resolution, &mut found)?;
        write_batch(found, poses.bad, &mut decisions, &mut statuses, |decision| (*decision).into())
    })
}

/// Says whether a motion keeps more than the margin away at every time from 0 to 1. It is undecided
/// only within `resolution` of the margin, or after too much work.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_motion(
    mesh: *mut pc_mesh,
    motion: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_motion_answer,
) -> pc_status {
    border!(mesh: exclusive, motion: shared, answer: place => {
        answer.set((&mesh.search.clears_motion(&motion.motion(), margin, resolution)?).into());
        Ok(())
    })
}

/// The same for `count` motions, on all cores, as `pc_mesh_minimum_batch`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_motion_batch(
    mesh: *mut pc_mesh,
    motions: *const *const pc_motion,
    count: usize,
    margin: f64,
    resolution: f64,
    answers: *mut pc_motion_answer,
    statuses: *mut pc_status,
) -> pc_status {
    border!(mesh: exclusive, motions: handles(count), answers: places(count),
        statuses: places_or_none(count) =>
    {
        let motions: Vec<_> = motions.iter().map(|motion| motion.motion()).collect();
        let mut found = Vec::new();
        mesh.search.clears_motion_batch(&motions, margin, resolution, &mut found)?;
        write_batch(found, Vec::new(), &mut answers, &mut statuses, |found| found.into())
    })
}

/// Finds the first time at which a motion does not keep the margin, within `resolution`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_time_of_contact(
    mesh: *mut pc_mesh,
    motion: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_motion_answer,
) -> pc_status {
    border!(mesh: exclusive, motion: shared, answer: place => {
        answer.set((&mesh.search.time_of_contact(&motion.motion(), margin, resolution)?).into());
        Ok(())
    })
}

/// Bounds the least clearance of a motion. The bounds are at most `tolerance` apart.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clearance_of_motion(
    mesh: *mut pc_mesh,
    motion: *const pc_motion,
    tolerance: f64,
    clearance: *mut pc_clearance,
) -> pc_status {
    border!(mesh: exclusive, motion: shared, clearance: place => {
        clearance.set((&mesh.search.clearance_of_motion(&motion.motion(), tolerance)?).into());
        Ok(())
    })
}

/// Says whether a motion keeps the margin while the vertices of the mesh move, straight and evenly,
/// to `vertices`. The mesh itself stays where it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_motion_while(
    mesh: *mut pc_mesh,
    vertices: *const f64,
    vertex_count: usize,
    motion: *const pc_motion,
    margin: f64,
    resolution: f64,
    answer: *mut pc_motion_answer,
) -> pc_status {
    border!(mesh: exclusive, vertices: points(vertex_count), motion: shared, answer: place => {
        let motion = motion.motion();
        let found = mesh.search.clears_motion_while(vertices, &motion, margin, resolution)?;
        answer.set((&found).into());
        Ok(())
    })
}

/// Says whether a path of `count` shapes keeps the margin. `deviation` is how far the robot may be
/// from the straight lines between the shapes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_clears_path(
    mesh: *mut pc_mesh,
    shapes: *const *const pc_chain,
    count: usize,
    deviation: f64,
    margin: f64,
    resolution: f64,
    answer: *mut pc_motion_answer,
) -> pc_status {
    border!(mesh: exclusive, shapes: handles(count), answer: place => {
        let shapes: Vec<_> = shapes.iter().map(|shape| shape.chain.clone()).collect();
        let found = mesh.search.clears_path(&shapes, deviation, margin, resolution)?;
        answer.set((&found).into());
        Ok(())
    })
}

/// Writes a proof, and the mesh beside it as `.obj`. Says whether there is a proof.
fn write_proof(
    mesh: &mut pc_mesh,
    path: &str,
    prove: impl FnOnce(&mut BvhSearch) -> Result<Option<Proof>, ProximityError>,
) -> Result<bool, Fault> {
    let path = Path::new(path);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
        let text =
            format!("`path` is {}, the file of the mesh; give another extension", path.display());
        return Err(Fault::argument("bad_path", text));
    }
    let Some(proof) = prove(&mut mesh.search)? else { return Ok(false) };
    let obj = to_obj(mesh.search.vertices(), mesh.search.triangles());
    for (path, text) in [(path, proof.to_string()), (&path.with_extension("obj"), obj)] {
        fs::write(path, text).map_err(|error| {
            let text = format!("{} cannot be written: {error}", path.display());
            Fault::new(pc_status::PC_FILE, "file", text)
        })?;
    }
    Ok(true)
}

/// Proves that a robot keeps more than the margin away. Writes the proof to `path`, and the mesh
/// beside it with the extension `.obj`, for `docs/book/check_proof.py`. Writes nothing, and sets
/// `proven` to false, if the margin is not kept, or exceeded by at most rounding.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_prove(
    mesh: *mut pc_mesh,
    robot: *const pc_chain,
    pose: *const f64,
    margin: f64,
    path: *const c_char,
    proven: *mut bool,
) -> pc_status {
    border!(mesh: exclusive, robot: shared, pose: pose, path: text, proven: place => {
        proven.set(write_proof(mesh, path, |search| search.prove(&robot.chain, &pose, margin))?);
        Ok(())
    })
}

/// The same for a tube. The proof may be missed within `resolution` of the margin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_prove_tube(
    mesh: *mut pc_mesh,
    tube: *const pc_tube,
    pose: *const f64,
    margin: f64,
    resolution: f64,
    path: *const c_char,
    proven: *mut bool,
) -> pc_status {
    border!(mesh: exclusive, tube: shared, pose: pose, path: text, proven: place => {
        let prove = |search: &mut BvhSearch| {
            search.prove_tube(&tube.tube, &pose, margin, resolution)
        };
        proven.set(write_proof(mesh, path, prove)?);
        Ok(())
    })
}

/// The same for a motion, at every time from 0 to 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_mesh_prove_motion(
    mesh: *mut pc_mesh,
    motion: *const pc_motion,
    margin: f64,
    resolution: f64,
    path: *const c_char,
    proven: *mut bool,
) -> pc_status {
    border!(mesh: exclusive, motion: shared, path: text, proven: place => {
        let prove = |search: &mut BvhSearch| {
            search.prove_motion(&motion.motion(), margin, resolution)
        };
        proven.set(write_proof(mesh, path, prove)?);
        Ok(())
    })
}
