//! A scene, and what is asked of all of it at once.

use super::distance_cache::DistanceCache;
use super::scene_bounds::SceneBounds;
use super::structure::Structure;
use crate::answer::{
    Between, Contact, ProximityError, SceneContact, SceneError, StructureProximity, Tightest,
};
use crate::distance::{DoubleDouble, Scalar};
use crate::engine::{BvhSearch, Engine, Proximity, RobotPair};
use crate::pair::PlacedRobot;
use crate::query::contacts::ContactQuery;
use crate::query::{check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use std::cmp::Ordering;

/// Several structures, each with a margin of its own or none, and the robots among them.
///
/// A structure is a mesh with a name. The margin is what a robot must keep from it; the *slack* is
/// the distance less the margin. A structure without a margin may be touched, as a target is: it is
/// measured by [`per_structure`](Self::per_structure) and [`contacts`](Self::contacts), and is no
/// part of the other questions.
///
/// Robots are given to each question, with their poses in the scene's frame. If a
/// [margin between robots](Self::set_robot_margin) is set, they are held against one another too.
///
/// The scene remembers what its engines do, whom the last answer was about, who is asked first, and
/// what each robot kept from each structure: one that a robot cannot have reached since is passed
/// over by all questions but `per_structure`. Robots are told apart by their place in a question;
/// any may follow. A clone shares the meshes and has a memory of its own: one for each thread.
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
    /// All of these; none where one of them has changed since the last question.
    all: Option<SceneBounds>,
    robot_margin: Option<Real>,
    /// The lower number first.
    nested: Vec<[usize; 2]>,
    pair: RobotPair,
    /// Structure and robot that were tightest, and that did not keep a margin.
    tightest: Option<[usize; 2]>,
    met: Option<[usize; 2]>,
    /// For each robot, by its number, what it keeps.
    watches: Vec<DistanceCache>,
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

    /// Adds a structure, and returns its number: structures count from 0 in the order in which they
    /// are added.
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
        self.all = None;
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
        self.all = None;
        Ok(())
    }

    /// Moves a structure as a whole: `pose` brings its mesh's frame into the scene's. Nothing is
    /// built anew.
    ///
    /// # Errors
    /// There is no such structure, or the pose is not finite or not rigid.
    pub fn set_pose(&mut self, structure: usize, pose: &Pose) -> Result<(), SceneError> {
        let number = structure;
        let structure = self.structure(number)?;
        structure.set_pose(pose).map_err(|error| of_structure(structure, error))?;
        self.has_moved(number);
        Ok(())
    }

    /// Moves the vertices of a structure's mesh, in the mesh's own frame:
    /// [`Proximity::set_vertices`].
    ///
    /// # Errors
    /// There is no such structure, the number of vertices differs, or one is not finite or out of
    /// range.
    pub fn set_vertices(
        &mut self,
        structure: usize,
        vertices: &[Vector],
    ) -> Result<(), SceneError> {
        let number = structure;
        let structure = self.structure(number)?;
        structure.set_vertices(vertices).map_err(|error| of_structure(structure, error.into()))?;
        self.has_moved(number);
        Ok(())
    }

    /// The margin that robots keep from one another; nothing if they are not held against one
    /// another, which is so at first.
    ///
    /// # Errors
    /// The margin is negative or NaN.
    pub fn set_robot_margin(&mut self, margin: Option<Real>) -> Result<(), SceneError> {
        check(margin).map_err(SceneError::BetweenRobots)?;
        self.robot_margin = margin;
        Ok(())
    }

    /// Names the pairs of robots one of which is inside the other, as a tube in the tube that
    /// guides it: they touch, and are not held against one another. The numbers are those of
    /// the robots that are given to a question, in any order; a pair that is not there changes
    /// nothing. What was named before is forgotten.
    pub fn set_nested(&mut self, pairs: &[[usize; 2]]) {
        self.nested.clear();
        self.nested.extend(pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]));
    }

    /// Whether all robots keep all margins: true exactly when the slack of
    /// [`tightest`](Self::tightest) is more than 0, or there is none. The first margin that is
    /// not kept ends the query.
    ///
    /// # Errors
    /// A pose is not finite or not rigid, or moves a link out of range. The message has the robot's
    /// number.
    pub fn clears(&mut self, robots: &[(&Chain, Pose)]) -> Result<bool, SceneError> {
        if self.begin(robots, None)? && !self.clears_structures(robots)? {
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

    fn clears_structures(&mut self, robots: &[(&Chain, Pose)]) -> Result<bool, SceneError> {
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
        asked.map(|()| self.met.is_none())
    }

    /// The least slack, and whom it is between; nothing if no robot is given or nothing has a
    /// margin.
    ///
    /// Slacks are compared without rounding. Of equal ones that of the lowest structure counts,
    /// then that of the lowest robot; pairs of robots come last.
    ///
    /// # Errors
    /// As [`clears`](Self::clears).
    pub fn tightest(&mut self, robots: &[(&Chain, Pose)]) -> Result<Option<Tightest>, SceneError> {
        self.begin(robots, Some(Real::INFINITY))?;
        let mut best: Best = None;
        if let Some([structure, robot]) = self.tightest.filter(|last| self.have(*last, robots)) {
            self.offer(structure, robot, robots, &mut best)?;
        }
        // Those that may be tightest are asked first: they rule out the others.
        let mut order = std::mem::take(&mut self.order);
        let near =
            |structure: &Structure| structure.margin.map(|margin| (margin, beyond(&best, margin)));
        let asked = self.gather(robots, near, &mut order).and_then(|()| {
            order.sort_unstable_by(nearest_first);
            for &(room, [structure, robot]) in &order {
                if best.as_ref().is_some_and(|(_, best)| room > best.slack.next_up()) {
                    break;
                }
                self.offer(structure, robot, robots, &mut best)?;
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

    /// For each structure, in order, where the robots are closest to it, whether it has a margin or
    /// not. `out` is cleared first, and stays empty where no robot is given.
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
                let found = structure
                    .search
                    .minimum_within(chain, &pose, bound)
                    .map_err(of_robot(robot))?;
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

    /// Every contact of every robot with every structure that is at most `reach` away:
    /// [`Proximity::within`], structure by structure and robot by robot. `out` is cleared
    /// first.
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
        if let Some(first) = self.structures.first() {
            check_not_negative("reach", reach).map_err(|error| of_structure(first, error))?;
        }
        if !self.begin(robots, Some(reach))? {
            return Ok(());
        }
        let mut order = std::mem::take(&mut self.order);
        let asked = self.gather(robots, |_| Some((0.0, reach)), &mut order).and_then(|()| {
            order.sort_unstable_by_key(|(_, who)| *who);
            for &(_, [number, robot]) in &order {
                let Some(placed) = self.place_unless_clear(number, robot, robots, reach)? else {
                    continue;
                };
                let structure = &mut self.structures[number];
                let asked = ContactQuery { margin: reach, prominence: 0.0 };
                structure
                    .search
                    .ask_contacts(placed, asked, &mut self.contacts)
                    .map_err(of_robot(robot))?;
                if !self.contacts.is_empty() {
                    self.watches[robot].mark_near(number);
                }
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
        self.structures
            .get_mut(structure)
            .ok_or(SceneError::NoSuchStructure { structure, structures })
    }

    fn have(&self, [structure, robot]: [usize; 2], robots: &[(&Chain, Pose)]) -> bool {
        structure < self.structures.len() && robot < robots.len()
    }

    /// What robots kept from a structure, they kept from where it was.
    fn has_moved(&mut self, structure: usize) {
        self.watches.iter_mut().for_each(|watch| watch.forget(structure));
        self.all = None;
    }

    /// A question about all of these robots begins. False if all of them are farther than `bound`
    /// from all structures, or than all margins where it is not given. Also those are placed
    /// that are held against nothing: what is asked afterwards finds no fault with one.
    fn begin(
        &mut self,
        robots: &[(&Chain, Pose)],
        bound: Option<Real>,
    ) -> Result<bool, SceneError> {
        let all = *self.all.get_or_insert_with(|| SceneBounds::of(&self.structures));
        let (mut may_be_near, bound) = (false, bound.unwrap_or(all.margin));
        for (robot, (chain, pose)) in robots.iter().enumerate() {
            let placed = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            may_be_near = may_be_near || !all.are_beyond(bound, &placed);
        }
        if !may_be_near {
            // Their ways are counted from where they were last, when they are near again.
            return Ok(false);
        }
        if self.watches.len() < robots.len() {
            self.watches.resize_with(robots.len(), DistanceCache::default);
        }
        for (robot, ((chain, pose), watch)) in robots.iter().zip(&mut self.watches).enumerate() {
            let placed = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            watch.begin(placed, self.structures.len());
        }
        Ok(true)
    }

    fn clears_one(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
    ) -> Result<bool, SceneError> {
        let Some(margin) = self.structures[number].margin else { return Ok(true) };
        let Some(placed) = self.place_unless_clear(number, robot, robots, margin)? else {
            return Ok(true);
        };
        let clears =
            self.structures[number].search.ask_clears(placed, margin).map_err(of_robot(robot))?;
        if !clears {
            self.watches[robot].mark_near(number);
        }
        Ok(clears)
    }

    /// The robot in the frame of a structure's mesh, or nothing if it keeps more than `bound` at a
    /// look: one that speaks for the next questions too where the robot moves little, or else
    /// one at the boxes alone.
    fn place_unless_clear<'a>(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&'a Chain, Pose)],
        bound: Real,
    ) -> Result<Option<PlacedRobot<'a>>, SceneError> {
        let (structure, watch) = (&mut self.structures[number], &mut self.watches[robot]);
        if watch.lower_bound(number, structure.size()) > bound {
            return Ok(None);
        }
        let (chain, pose) = robots[robot];
        let placed = PlacedRobot::new(chain, &structure.in_mesh(&pose)).map_err(of_robot(robot))?;
        if bound == Real::INFINITY {
            return Ok(Some(placed));
        }
        let Some(room) = watch.look_ahead() else {
            return Ok(structure.around.may_be_within(&placed, bound).then_some(placed));
        };
        if watch.is_worth_a_query(number) {
            let far = bound + room;
            if structure.search.clears_unless_crossing(placed, far) {
                watch.record(number, far, structure.size());
                return Ok(None);
            }
            watch.mark_near(number);
        }
        Ok(Some(placed))
    }

    /// Writes to `order` which robots may be as near to which structures as is asked, and how much
    /// room these leave them at least. `asked` tells a structure's margin, and how far away is
    /// near enough; nothing if it takes no part. Each robot is placed once for all structures
    /// that have not moved.
    fn gather(
        &mut self,
        robots: &[(&Chain, Pose)],
        asked: impl Fn(&Structure) -> Option<(Real, Real)>,
        order: &mut Vec<(Real, [usize; 2])>,
    ) -> Result<(), SceneError> {
        order.clear();
        for (robot, ((chain, pose), watch)) in robots.iter().zip(&mut self.watches).enumerate() {
            let in_scene = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            for (number, structure) in self.structures.iter().enumerate() {
                let Some((margin, bound)) = asked(structure) else { continue };
                if watch.lower_bound(number, structure.size()) > bound {
                    continue;
                }
                let placed = structure.place(chain, pose, &in_scene).map_err(of_robot(robot))?;
                let at_least = structure.around.at_least(&placed);
                if at_least > bound {
                    watch.record(number, at_least, structure.size());
                } else {
                    order.push(((at_least - margin).next_down(), [number, robot]));
                }
            }
        }
        Ok(())
    }

    /// Takes a structure and a robot for the tightest if they are.
    fn offer(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
        best: &mut Best,
    ) -> Result<(), SceneError> {
        let Some(margin) = self.structures[number].margin else { return Ok(()) };
        let bound = beyond(best, margin);
        if bound < 0.0 {
            return Ok(());
        }
        let Some(placed) = self.place_unless_clear(number, robot, robots, bound)? else {
            return Ok(());
        };
        let (structure, watch) = (&mut self.structures[number], &mut self.watches[robot]);
        let far = bound + watch.look_ahead().unwrap_or(0.0);
        let found = structure.search.ask_nearest(placed, far).map_err(of_robot(robot))?;
        watch.record(number, found.map_or(far, |found| found.distance), structure.size());
        let Some(found) = found else { return Ok(()) };
        if found.distance <= bound {
            watch.mark_near(number);
        }
        let slack = slack(found.distance, margin);
        let is_tighter = best.as_ref().is_none_or(|(least, best)| {
            let comes_first = match best.between {
                Between::Structure(near) => {
                    [number, robot] < [near.structure as usize, near.robot as usize]
                }
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

/// With this margin no distance beyond this has a slack as small as the best, whatever is rounded
/// here.
fn beyond(best: &Best, margin: Real) -> Real {
    best.as_ref().map_or(Real::INFINITY, |(_, best)| (best.slack.next_up() + margin).next_up())
}

/// The pairs of so many robots that are held against one another, in order: all but those that are
/// nested.
fn pairs_apart(robots: usize, nested: &[[usize; 2]]) -> impl Iterator<Item = [usize; 2]> {
    let pairs =
        (0..robots).flat_map(move |first| (first + 1..robots).map(move |second| [first, second]));
    pairs.filter(|pair| !nested.contains(pair))
}

#[cfg(test)]
mod tests {
    use super::*;
    use continuum_testing::Random;
    use parry3d_f64::shape::Ball;

    fn scene_of_balls() -> Scene {
        let mut scene = Scene::new();
        for number in 0..20 {
            let (vertices, triangles) = Ball::new(1.0).to_trimesh(16, 8);
            let mut random = Random::new(number);
            let away = random.direction();
            let centre = Vector::new(away.x, away.y, 0.0).normalize() * random.between(2.0, 2.6);
            let place = |vertex: &Vector| *vertex + centre + Vector::Z * (0.4 * number as Real);
            let vertices: Vec<_> = vertices.iter().map(place).collect();
            let search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
            scene.add(format!("ball {number}"), search, Some(0.1)).unwrap();
        }
        scene
    }

    /// Along a smooth walk most structures are passed over, and a scene says what one says that
    /// knows of no way of a robot.
    #[test]
    fn what_cannot_be_near_is_not_looked_at() {
        let points: Vec<_> = (0..=8).map(|k| Vector::Z * Real::from(k)).collect();
        let robot = Chain::from_centreline(&points, &[0.2; 8]).unwrap();
        let mut scenes = [0; 3].map(|_| [scene_of_balls(), scene_of_balls()]);
        let (mut silent, mut looked_at, mut contacts) = ([0; 3], [[0; 2]; 3], 0);
        for tick in 0..400 {
            let (sin, cos) = (0.02 * Real::from(tick)).sin_cos();
            let robots = [(&robot, Pose::translation(0.5 * cos, 0.5 * sin, 0.0))];
            for (question, scenes) in scenes.iter_mut().enumerate() {
                scenes[1].watches.clear();
                let [one, other] = scenes.each_mut().map(|scene| {
                    let (mut clears, mut tightest, mut found) = (false, None, Vec::new());
                    match question {
                        0 => clears = scene.clears(&robots).unwrap(),
                        1 => tightest = scene.tightest(&robots).unwrap(),
                        _ => scene.contacts(&robots, 0.4, &mut found).unwrap(),
                    }
                    (clears, tightest, found)
                });
                assert_eq!(one, other);
                contacts += one.2.len();
                // Those that were not passed over are put in order.
                let looked = scenes.each_ref().map(|scene| scene.order.len());
                silent[question] += u32::from(looked[0] == 0);
                looked_at[question][0] += looked[0];
                looked_at[question][1] += looked[1];
            }
        }
        assert!(silent[0] > 100 && contacts > 100, "{silent:?} {contacts}");
        assert!(looked_at.iter().all(|[with, without]| 2 * with < *without), "{looked_at:?}");
    }
}
