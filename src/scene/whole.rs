//! A scene, and what is asked of all of it at once.

use super::structure::Structure;
use crate::answer::{
    Between, Contact, ProximityError, SceneContact, SceneError, StructureProximity, Tightest,
};
use crate::distance::{DoubleDouble, Scalar};
use crate::engine::{BvhSearch, Proximity, RobotPair};
use crate::pair::PlacedRobot;
use crate::query::{check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use std::cmp::Ordering;

/// Several structures, each with a margin of its own or none, and the robots among them.
///
/// A structure is a mesh with a name. The margin is what a robot must keep from it; the *slack* is the distance less the
/// margin. A structure without a margin may be touched, as a target is: it is measured by
/// [`per_structure`](Self::per_structure) and [`contacts`](Self::contacts), and is no part of the other questions.
///
/// Robots are given to each question, with their poses in the scene's frame. If a
/// [margin between robots](Self::set_robot_margin) is set, they are held against one another too.
///
/// The scene remembers what its engines do, and whom the last answer was about, who is asked first. A clone shares the
/// meshes and has a memory of its own: one for each thread.
///
/// ```
/// use parry_continuum::Chain;
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
/// use parry_continuum::proximity::{Between, BvhSearch, Scene};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let ball = |centre: Vector, radius: f64| -> Result<BvhSearch, Box<dyn std::error::Error>> {
///     let (vertices, triangles) = Ball::new(radius).to_trimesh(32, 16);
///     let vertices: Vec<_> = vertices.iter().map(|vertex| *vertex + centre).collect();
///     Ok(BvhSearch::from_triangles(&vertices, &triangles)?)
/// };
/// let mut scene = Scene::new();
/// scene.add("wall", ball(Vector::ZERO, 10.0)?, Some(0.5))?;
/// let vessel = scene.add("vessel", ball(Vector::X * 6.0, 1.0)?, Some(2.0))?;
/// scene.add("target", ball(Vector::Z * 8.0, 1.0)?, None)?;
///
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?;
/// let robots = [(&robot, Pose::IDENTITY)];
/// assert!(scene.clears(&robots)?);
/// let tightest = scene.tightest(&robots)?.ok_or("nothing has a margin")?;
/// if let Between::Structure(near) = tightest.between {
///     let name = scene.name(near.structure as usize).unwrap_or_default();
///     println!("{name} leaves {:.2} mm at link {}", tightest.slack, near.nearest.link);
///     assert_eq!(name, "vessel");
/// }
///
/// scene.set_margin(vessel, Some(6.0))?;
/// assert!(!scene.clears(&robots)?);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Scene {
    structures: Vec<Structure>,
    robot_margin: Option<Real>,
    /// The lower number first.
    nested: Vec<[usize; 2]>,
    pair: RobotPair,
    /// Structure and robot that were tightest, and that did not keep a margin.
    tightest: Option<[usize; 2]>,
    met: Option<[usize; 2]>,
    /// How much room structures leave robots at least.
    order: Vec<(Real, [usize; 2])>,
    contacts: Vec<Contact>,
}

/// The tightest so far, and its slack without rounding.
type Best = Option<(DoubleDouble, Tightest)>;

impl Scene {
    /// Without structures.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a structure, and returns its number: structures count from 0 in the order in which they are added.
    ///
    /// # Errors
    /// The margin is negative or NaN. The message has the structure's name.
    pub fn add(
        &mut self,
        name: impl Into<String>,
        search: BvhSearch,
        margin: Option<Real>,
    ) -> Result<usize, SceneError> {
        let structure = Structure::new(name.into(), search, margin);
        check(margin).map_err(|error| of_structure(&structure, error))?;
        self.structures.push(structure);
        Ok(self.structures.len() - 1)
    }

    /// How many structures there are.
    pub fn len(&self) -> usize {
        self.structures.len()
    }

    /// Whether there is no structure.
    pub fn is_empty(&self) -> bool {
        self.structures.is_empty()
    }

    /// A structure's name.
    pub fn name(&self, structure: usize) -> Option<&str> {
        self.structures.get(structure).map(|structure| structure.name.as_str())
    }

    /// A structure's margin; nothing if it has none.
    pub fn margin(&self, structure: usize) -> Option<Real> {
        self.structures.get(structure)?.margin
    }

    /// Gives a structure another margin, or none.
    ///
    /// # Errors
    /// There is no such structure, or the margin is negative or NaN.
    pub fn set_margin(&mut self, structure: usize, margin: Option<Real>) -> Result<(), SceneError> {
        let structure = self.structure(structure)?;
        check(margin).map_err(|error| of_structure(structure, error))?;
        structure.margin = margin;
        Ok(())
    }

    /// Moves a structure as a whole: `pose` brings its mesh's frame into the scene's. Nothing is built anew.
    ///
    /// # Errors
    /// There is no such structure, or the pose is not finite or not rigid.
    pub fn set_pose(&mut self, structure: usize, pose: &Pose) -> Result<(), SceneError> {
        let structure = self.structure(structure)?;
        structure.set_pose(pose).map_err(|error| of_structure(structure, error))
    }

    /// Moves the vertices of a structure's mesh, in the mesh's own frame: [`Proximity::set_vertices`].
    ///
    /// # Errors
    /// There is no such structure, the number of vertices differs, or one is not finite or out of range.
    pub fn set_vertices(&mut self, structure: usize, vertices: &[Vector]) -> Result<(), SceneError> {
        let structure = self.structure(structure)?;
        structure.set_vertices(vertices).map_err(|error| of_structure(structure, error.into()))
    }

    /// The margin that robots keep from one another; nothing if they are not held against one another, which is so at first.
    ///
    /// # Errors
    /// The margin is negative or NaN.
    pub fn set_robot_margin(&mut self, margin: Option<Real>) -> Result<(), SceneError> {
        check(margin).map_err(SceneError::BetweenRobots)?;
        self.robot_margin = margin;
        Ok(())
    }

    /// Names the pairs of robots one of which is inside the other, as a tube in the tube that guides it: they touch, and are not
    /// held against one another. The numbers are those of the robots that are given to a question, in any order; a pair that
    /// is not there changes nothing. What was named before is forgotten.
    pub fn set_nested(&mut self, pairs: &[[usize; 2]]) {
        self.nested.clear();
        self.nested.extend(pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]));
    }

    /// Whether all robots keep all margins: true exactly when the slack of [`tightest`](Self::tightest) is more than 0, or
    /// there is none. The first margin that is not kept ends the query.
    ///
    /// # Errors
    /// A pose is not finite or not rigid, or moves a link out of range. The message has the robot's number.
    pub fn clears(&mut self, robots: &[(&Chain, Pose)]) -> Result<bool, SceneError> {
        check_poses(robots)?;
        if let Some([structure, robot]) = self.met.filter(|met| self.have(*met, robots))
            && !self.clears_one(structure, robot, robots)?
        {
            return Ok(false);
        }
        self.met = None;
        let mut order = std::mem::take(&mut self.order);
        let near = |structure: &Structure| structure.margin.map(|margin| (margin, margin));
        let asked = self.gather(robots, near, &mut order).and_then(|()| {
            order.sort_unstable_by(nearest_first);
            for &(_, [structure, robot]) in &order {
                if !self.clears_one(structure, robot, robots)? {
                    self.met = Some([structure, robot]);
                    break;
                }
            }
            Ok(())
        });
        self.order = order;
        asked?;
        if self.met.is_some() {
            return Ok(false);
        }
        let Some(margin) = self.robot_margin else { return Ok(true) };
        for [first, second] in pairs_apart(robots.len(), &self.nested) {
            let [(a, pose_a), (b, pose_b)] = [&robots[first], &robots[second]];
            if !self.pair.clears(a, pose_a, b, pose_b, margin).map_err(of_robot(second))? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The least slack, and whom it is between; nothing if no robot is given or nothing has a margin.
    ///
    /// Slacks are compared without rounding. Of equal ones that of the lowest structure counts, then that of the lowest robot;
    /// pairs of robots come last.
    ///
    /// # Errors
    /// As [`clears`](Self::clears).
    pub fn tightest(&mut self, robots: &[(&Chain, Pose)]) -> Result<Option<Tightest>, SceneError> {
        check_poses(robots)?;
        let mut best: Best = None;
        if let Some([structure, robot]) = self.tightest.filter(|last| self.have(*last, robots)) {
            self.tighter(structure, robot, robots, &mut best)?;
        }
        // Those that may be tightest are asked first: they rule out the others.
        let mut order = std::mem::take(&mut self.order);
        let all = |structure: &Structure| structure.margin.map(|margin| (margin, Real::INFINITY));
        let asked = self.gather(robots, all, &mut order).and_then(|()| {
            order.sort_unstable_by(nearest_first);
            for &(room, [structure, robot]) in &order {
                if best.as_ref().is_some_and(|(_, best)| room > best.slack.next_up()) {
                    break;
                }
                self.tighter(structure, robot, robots, &mut best)?;
            }
            Ok(())
        });
        self.order = order;
        asked?;
        self.tightest = match best.as_ref().map(|(_, best)| best.between) {
            Some(Between::Structure(near)) => Some([near.structure as usize, near.robot as usize]),
            _ => None,
        };
        let Some(margin) = self.robot_margin else { return Ok(best.map(|(_, best)| best)) };
        for [first, second] in pairs_apart(robots.len(), &self.nested) {
            let [(a, pose_a), (b, pose_b)] = [&robots[first], &robots[second]];
            let nearest = self.pair.minimum(a, pose_a, b, pose_b).map_err(of_robot(second))?;
            let slack = slack(nearest.distance, margin);
            if best.as_ref().is_none_or(|(least, _)| slack.lt(*least)) {
                let between = Between::Robots { robots: [first as u32, second as u32], nearest };
                best = Some((slack, Tightest { slack: slack.rounded(), between }));
            }
        }
        Ok(best.map(|(_, best)| best))
    }

    /// For each structure, in order, where the robots are closest to it, whether it has a margin or not. `out` is cleared
    /// first, and stays empty where no robot is given.
    ///
    /// # Errors
    /// As [`clears`](Self::clears).
    pub fn per_structure(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<StructureProximity>,
    ) -> Result<(), SceneError> {
        out.clear();
        for (number, structure) in self.structures.iter_mut().enumerate() {
            let mut best: Option<StructureProximity> = None;
            for (robot, (chain, pose)) in robots.iter().enumerate() {
                let pose = structure.in_mesh(pose);
                let bound = best.map_or(Real::INFINITY, |best| best.nearest.distance);
                let found = structure.search.minimum_within(chain, &pose, bound).map_err(of_robot(robot))?;
                if let Some(found) = found
                    && best.is_none_or(|best| found.distance < best.nearest.distance)
                {
                    best = Some(StructureProximity {
                        structure: number as u32,
                        robot: robot as u32,
                        nearest: structure.placed(found),
                        slack: structure.margin.map(|margin| found.distance - margin),
                    });
                }
            }
            out.extend(best);
        }
        Ok(())
    }

    /// Every contact of every robot with every structure that is at most `reach` away: [`Proximity::within`], structure by
    /// structure and robot by robot. `out` is cleared first.
    ///
    /// # Errors
    /// As [`clears`](Self::clears), or `reach` is negative or NaN.
    pub fn contacts(
        &mut self,
        robots: &[(&Chain, Pose)],
        reach: Real,
        out: &mut Vec<SceneContact>,
    ) -> Result<(), SceneError> {
        out.clear();
        let Some(first) = self.structures.first() else { return check_poses(robots) };
        check_not_negative("reach", reach).map_err(|error| of_structure(first, error))?;
        let mut order = std::mem::take(&mut self.order);
        let asked = self.gather(robots, |_| Some((0.0, reach)), &mut order).and_then(|()| {
            order.sort_unstable_by_key(|(_, who)| *who);
            for &(_, [number, robot]) in &order {
                let structure = &mut self.structures[number];
                let (chain, pose) = &robots[robot];
                let pose = structure.in_mesh(pose);
                let found = structure.search.within(chain, &pose, reach, 0.0, &mut self.contacts);
                found.map_err(of_robot(robot))?;
                out.extend(self.contacts.drain(..).map(|contact| SceneContact {
                    structure: number as u32,
                    robot: robot as u32,
                    contact: structure.placed_contact(contact),
                }));
            }
            Ok(())
        });
        self.order = order;
        asked
    }

    /// Builds all that a later query would build.
    pub fn prepare(&self) {
        self.structures.iter().for_each(|structure| structure.search.prepare());
    }

    fn structure(&mut self, structure: usize) -> Result<&mut Structure, SceneError> {
        let structures = self.structures.len();
        self.structures.get_mut(structure).ok_or(SceneError::NoSuchStructure { structure, structures })
    }

    fn have(&self, [structure, robot]: [usize; 2], robots: &[(&Chain, Pose)]) -> bool {
        structure < self.structures.len() && robot < robots.len()
    }

    fn clears_one(
        &mut self,
        structure: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
    ) -> Result<bool, SceneError> {
        let structure = &mut self.structures[structure];
        let Some(margin) = structure.margin else { return Ok(true) };
        let (chain, pose) = &robots[robot];
        let pose = structure.in_mesh(pose);
        structure.search.clears(chain, &pose, margin).map_err(of_robot(robot))
    }

    /// Writes to `order` which robots may be as near to which structures as is asked, and how much room these leave them at least.
    /// `asked` tells a structure's margin, and how far away is near enough; nothing if it takes no part. Each robot is placed
    /// once for all structures that have not moved.
    fn gather(
        &self,
        robots: &[(&Chain, Pose)],
        asked: impl Fn(&Structure) -> Option<(Real, Real)>,
        order: &mut Vec<(Real, [usize; 2])>,
    ) -> Result<(), SceneError> {
        order.clear();
        for (robot, (chain, pose)) in robots.iter().enumerate() {
            let in_scene = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            for (number, structure) in self.structures.iter().enumerate() {
                let Some((margin, bound)) = asked(structure) else { continue };
                let placed = structure.place(chain, pose, &in_scene).map_err(of_robot(robot))?;
                let at_least = structure.at_least(&placed);
                let is_near =
                    at_least <= bound && (bound == Real::INFINITY || structure.may_be_within(&placed, bound));
                if is_near {
                    order.push(((at_least - margin).next_down(), [number, robot]));
                }
            }
        }
        Ok(())
    }

    /// Takes a structure and a robot for the tightest if they are.
    fn tighter(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
        best: &mut Best,
    ) -> Result<(), SceneError> {
        let structure = &mut self.structures[number];
        let Some(margin) = structure.margin else { return Ok(()) };
        let (chain, pose) = &robots[robot];
        let pose = structure.in_mesh(pose);
        // No distance with a slack as small is beyond this, whatever is rounded here.
        let bound =
            best.as_ref().map_or(Real::INFINITY, |(_, best)| (best.slack.next_up() + margin).next_up());
        if bound < Real::INFINITY {
            let placed = PlacedRobot::new(chain, &pose).map_err(of_robot(robot))?;
            if !structure.may_be_within(&placed, bound) {
                return Ok(());
            }
        }
        let found = structure.search.minimum_within(chain, &pose, bound).map_err(of_robot(robot))?;
        let Some(found) = found else { return Ok(()) };
        let slack = slack(found.distance, margin);
        let is_tighter = best.as_ref().is_none_or(|(least, best)| {
            let comes_first = match best.between {
                Between::Structure(near) => [number, robot] < [near.structure as usize, near.robot as usize],
                Between::Robots { .. } => true,
            };
            slack.lt(*least) || (slack.le(*least) && comes_first)
        });
        if is_tighter {
            let rounded = slack.rounded();
            let near = StructureProximity {
                structure: number as u32,
                robot: robot as u32,
                nearest: structure.placed(found),
                slack: Some(rounded),
            };
            *best = Some((slack, Tightest { slack: rounded, between: Between::Structure(near) }));
        }
        Ok(())
    }
}

/// Those with the least room come first, then those with the lowest numbers.
fn nearest_first(one: &(Real, [usize; 2]), other: &(Real, [usize; 2])) -> Ordering {
    one.0.total_cmp(&other.0).then(one.1.cmp(&other.1))
}

/// The distance less the margin, which may be infinite.
fn slack(distance: Real, margin: Real) -> DoubleDouble {
    if margin == Real::INFINITY {
        return Real::NEG_INFINITY.into();
    }
    DoubleDouble::from(distance) - margin.into()
}

/// A margin that can be kept, if there is one.
fn check(margin: Option<Real>) -> Result<(), ProximityError> {
    margin.map_or(Ok(()), check_margin)
}

fn of_structure(structure: &Structure, error: ProximityError) -> SceneError {
    SceneError::Structure { name: structure.name.clone(), error }
}

fn of_robot(robot: usize) -> impl Fn(ProximityError) -> SceneError {
    move |error| SceneError::Robot { robot, error }
}

/// The poses of all robots, also of those that are held against nothing: what is asked afterwards finds no fault with one.
fn check_poses(robots: &[(&Chain, Pose)]) -> Result<(), SceneError> {
    for (robot, (chain, pose)) in robots.iter().enumerate() {
        PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
    }
    Ok(())
}

/// The pairs of so many robots that are held against one another, in order: all but those that are nested.
fn pairs_apart(robots: usize, nested: &[[usize; 2]]) -> impl Iterator<Item = [usize; 2]> {
    let pairs = (0..robots).flat_map(move |first| (first + 1..robots).map(move |second| [first, second]));
    pairs.filter(|pair| !nested.contains(pair))
}
