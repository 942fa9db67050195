//! A scene of structures and robots, and the queries about all of them.
//!
//! # Definitions
//! - d(k, i): the distance of robot i from structure k; m(k, i): the margin between them.
//! - slack(k, i) = d(k, i) - m(k, i).
//! - `lower`: the lower bound on d(k, i) that [`DistanceCache`] keeps while robots move.
//! - `box`: the lower bound on d(k, i) by the bounding boxes
//!   ([`BoundingBox`](super::bounding_box::BoundingBox)).
//! - `bound`: the distance beyond which d(k, i) cannot matter: m(k, i) for [`Scene::clears`], the
//!   best slack plus m(k, i) for [`Scene::tightest`], `reach` for [`Scene::contacts_within`].
//!
//! # Algorithm
//! 1. **Begin** ([`Scene::begin`]). Place all robots, which finds their errors. Stop if every robot
//!    is beyond `bound` of the bounds of all structures. Advance the odometer of each robot.
//! 2. **Seed.** Query the pair (k, i) that decided the last query: it violated a margin, or was
//!    tightest. Leave this out if a robot could be out of range in the frame of a structure.
//! 3. **Gather** ([`Scene::gather`]). Skip the pairs with `lower > bound` or `box > bound`. Sort
//!    the others: least `box - m(k, i)` first, or by number for contacts.
//! 4. **Query** the pairs in order. [`Scene::place_unless_clear`] skips a pair that is beyond
//!    `bound`; where it pays, it queries `bound + look_ahead`, so that `lower` serves the next
//!    queries. `clears` stops at the first violated margin, `tightest` once `box - m(k, i)`
//!    exceeds the best slack.
//! 5. **Solids.** Steps 1 to 4 measure surfaces. A robot inside of a solid has the distance 0
//!    ([`solid`](super::solid)).
//! 6. **Robots.** If a margin between robots is set, query the pairs of robots that are not nested.
//!    `clears` also queries each robot and itself, if that margin is set.
//!
//! # Correctness
//! **Claim.** Warm starts never change an answer. `tightest` returns the least (slack, structure,
//! robot), pairs of robots last.
//! **Proof.** Steps 1, 3 and 4 skip a pair only if d(k, i) > `bound`. So `tightest` searches every
//! pair at the final slack, ties included, and `offer` orders ties by number. If a robot could be
//! out of range, there is no seed and `lower` is -infinity: step 3 places all pairs and finds the
//! first error.
//! **Rounding.** Slacks are compared exactly ([`DoubleDouble`]). [`beyond`] and the key of step 3
//! are rounded outward, and the best slack is rounded up before it stops step 4. So rounding can
//! only search a pair too many.

use super::distance_cache::DistanceCache;
use super::moving_robot::MovingRobotMemory;
use super::scene_bounds::SceneBounds;
use super::solid::common_point;
use super::structure::Structure;
use crate::answer::{
    Between, Contact, LinkProximity, ProximityError, SceneContact, SceneError, StructureProximity,
    Tightest,
};
use crate::distance::{DoubleDouble, Scalar};
use crate::engine::{BvhSearch, Engine, Proximity, RobotPair, SelfQuery};
use crate::pair::PlacedRobot;
use crate::query::contacts::ContactQuery;
use crate::query::{check_margin, check_not_negative};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use std::cmp::Ordering;

/// Several structures, each with or without a margin, and the robots among them.
///
/// A structure is a mesh with a name. Its margin is the least distance that a robot must exceed;
/// the *slack* is the distance minus the margin. A robot may touch a structure without a margin,
/// such as a target. [`per_structure`](Self::per_structure) and
/// [`contacts_within`](Self::contacts_within) measure such a structure; the other queries ignore
/// it. A single robot may have [another margin](Self::set_margin_between).
///
/// A mesh is a surface: a robot wholly inside of a box keeps a margin to it. If the structure is
/// [solid](Self::set_solid), such a robot is in contact.
///
/// Each query takes the robots with their poses in the scene's frame. If a [margin between
/// robots](Self::set_robot_margin) is set, the queries also test each robot against the others.
///
/// The scene warm-starts its queries. It keeps the warm starts of its engines and the pair that
/// decided the last answer. It also keeps a lower bound on the distance of each robot from each
/// structure. All queries but `per_structure` skip a structure that a robot cannot have reached
/// since. Robots are identified by their index in a query; any robots may follow. A clone shares
/// the meshes and has its own memory: use one clone per thread.
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
    pub(super) structures: Vec<Structure>,
    /// The bounds of all structures; `None` after a structure has changed.
    all: Option<SceneBounds>,
    pub(super) robot_margin: Option<Real>,
    pub(super) self_margin: Option<Real>,
    /// Which places the margin of a robot to itself is about; `None`: the local minima.
    pub(super) self_arc: Option<Real>,
    /// Pairs of nested robots, the lower number first.
    pub(super) nested: Vec<[usize; 2]>,
    pub(super) pair: RobotPair,
    pub(super) itself: SelfQuery,
    /// The memory of moving robots, which is reused.
    pub(super) moving: Vec<MovingRobotMemory>,
    /// The last pair (structure, robot) that was tightest, and the last that violated a margin.
    tightest: Option<[usize; 2]>,
    met: Option<[usize; 2]>,
    /// The distance cache of each robot, by its number.
    watches: Vec<DistanceCache>,
    /// Lower bounds on the slack of the gathered pairs (structure, robot).
    order: Vec<(Real, [usize; 2])>,
    contacts: Vec<Contact>,
}

/// The tightest pair so far, and its exact slack.
type Best = Option<(DoubleDouble, Tightest)>;

impl Scene {
    /// Makes a scene without structures.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a structure and returns its number.
    ///
    /// Structures count from 0 in the order in which they are added.
    ///
    /// # Errors
    /// Another structure has this name, or the margin is negative or NaN. The message names the
    /// structure.
    pub fn add(
        &mut self,
        name: impl Into<String>,
        search: BvhSearch,
        margin: Option<Real>,
    ) -> Result<usize, SceneError> {
        let name = name.into();
        if let Some(structure) = self.structures.iter().position(|it| it.name == name) {
            return Err(SceneError::NameTaken { name, structure });
        }
        let structure = Structure::new(name, search, margin);
        check(margin).map_err(|error| of_structure(&structure, error))?;
        self.structures.push(structure);
        self.all = None;
        Ok(self.structures.len() - 1)
    }

    /// The number of structures.
    pub fn len(&self) -> usize {
        self.structures.len()
    }

    /// Returns whether there is no structure.
    pub fn is_empty(&self) -> bool {
        self.structures.is_empty()
    }

    /// The name of a structure, or `None` if there is no such structure.
    pub fn name(&self, structure: usize) -> Option<&str> {
        self.structures.get(structure).map(|structure| structure.name.as_str())
    }

    /// The margin of a structure, or `None` if it has none.
    pub fn margin(&self, structure: usize) -> Option<Real> {
        self.structures.get(structure)?.margin
    }

    /// Returns whether a structure is solid; false if there is no such structure.
    pub fn is_solid(&self, structure: usize) -> bool {
        self.structures.get(structure).is_some_and(|structure| structure.is_solid)
    }

    /// Makes a structure solid, or a surface again, as it is by default.
    ///
    /// A robot inside of a solid structure is in contact with it: the distance is 0, and the
    /// robot's point nearest to the surface is the common point. All queries but
    /// [`contacts_within`](Self::contacts_within) count that. The triangles may face inwards or
    /// outwards. A closed surface within another one bounds a cavity if it faces the other way. A
    /// robot in a cavity is outside.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Cuboid};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Cuboid::new(Vector::splat(10.0)).to_trimesh();
    /// let mut scene = Scene::new();
    /// let search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let table = scene.add("table", search, Some(1.0))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 6.0], &[0.5])?;
    /// assert!(scene.clears(&[(&robot, Pose::IDENTITY)])?);
    /// scene.set_solid(table, true)?;
    /// assert!(!scene.clears(&[(&robot, Pose::IDENTITY)])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - There is no such structure.
    /// - The mesh bounds no volume
    ///   ([`SurfaceReport::bounds_volume`](crate::proximity::SurfaceReport::bounds_volume)). Then
    ///   the structure stays a surface. If [`set_vertices`](Self::set_vertices) opens the mesh of a
    ///   solid structure, the next query is this error.
    pub fn set_solid(&mut self, structure: usize, is_solid: bool) -> Result<(), SceneError> {
        let structure = self.structure(structure)?;
        structure.is_solid = is_solid;
        let checked = structure.check_solid();
        structure.is_solid &= checked.is_ok();
        self.all = None;
        checked
    }

    /// Sets or removes the margin of a structure. [Margins from single
    /// robots](Self::set_margin_between) stay.
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

    /// The margin between a structure and a robot. `None` if the two may touch, or if there is no
    /// such structure.
    pub fn margin_between(&self, structure: usize, robot: usize) -> Option<Real> {
        self.structures.get(structure)?.margin_from(robot)
    }

    /// Sets the margin between a structure and one robot, in place of the structure's margin. With
    /// `None` the two may touch.
    ///
    /// `robot` is the index of a robot in a query; without such a robot the margin has no effect.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(32, 16);
    /// let mut scene = Scene::new();
    /// let target =
    ///     scene.add("target", BvhSearch::from_triangles(&vertices, &triangles)?, Some(5.0))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 9.0], &[0.5])?;
    /// let [needle, probe] = [0.0, 8.0].map(|x| (&robot, Pose::translation(x, 0.0, 0.0)));
    /// assert!(!scene.clears(&[needle, probe])?);
    /// scene.set_margin_between(target, 0, None)?; // the needle may touch the target
    /// assert!(scene.clears(&[needle, probe])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// There is no such structure, or the margin is negative or NaN.
    pub fn set_margin_between(
        &mut self,
        structure: usize,
        robot: usize,
        margin: Option<Real>,
    ) -> Result<(), SceneError> {
        let structure = self.structure(structure)?;
        check(margin).map_err(|error| of_structure(structure, error))?;
        structure.set_margin_from(robot, margin);
        self.all = None;
        Ok(())
    }

    /// Moves a structure as a whole. `pose` maps its mesh's frame to the scene's frame.
    ///
    /// Nothing is built anew.
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

    /// Moves the vertices of a structure's mesh, in the mesh's frame: [`Proximity::set_vertices`].
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

    /// Sets the margin between robots. With `None`, the default, robots are not tested against one
    /// another: several robots may pass through each other.
    ///
    /// # Errors
    /// The margin is negative or NaN.
    pub fn set_robot_margin(&mut self, margin: Option<Real>) -> Result<(), SceneError> {
        check(margin).map_err(SceneError::BetweenRobots)?;
        self.robot_margin = margin;
        Ok(())
    }

    /// Sets the margin of each robot to itself. With `None`, the default, robots are not tested
    /// against themselves.
    ///
    /// [`clears`](Self::clears), [`clears_tube`](Self::clears_tube) and
    /// [`clears_motion`](Self::clears_motion) test it. Which parts of a robot count is as for
    /// [`SelfQuery`]: the local minima, or all places by [arc length](Self::set_self_arc). The
    /// least slack of [`tightest`](Self::tightest) does not include it.
    ///
    /// # Errors
    /// The margin is negative or NaN.
    pub fn set_self_margin(&mut self, margin: Option<Real>) -> Result<(), SceneError> {
        check(margin).map_err(SceneError::Query)?;
        self.self_margin = margin;
        Ok(())
    }

    /// Sets between which places of a robot the [margin to itself](Self::set_self_margin) applies:
    /// places at least `arc` apart along the centreline, as for [`SelfQuery::clears_beyond`]. With
    /// `None`, the default, between local minima, as for [`SelfQuery::clears`].
    ///
    /// `arc` is a length, larger than the margin: a distance by arc length is at most `arc`. A
    /// robot shorter than `arc` keeps every margin. [`clears_motion`](Self::clears_motion) and
    /// [`time_of_contact`](Self::time_of_contact) have the local minima only.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::{Pose, Vector}, proximity::Scene};
    ///
    /// // A bend with a radius of 10. It has no local minimum.
    /// let angles = (0..=120).map(|k| f64::from(k).to_radians());
    /// let points: Vec<_> = angles.map(|a| Vector::new(a.cos(), 0.0, a.sin()) * 10.0).collect();
    /// let robot = Chain::from_centreline(&points, &[2.0; 120])?;
    /// let mut scene = Scene::new();
    /// scene.set_self_margin(Some(9.0))?;
    /// assert!(scene.clears(&[(&robot, Pose::IDENTITY)])?);
    /// scene.set_self_arc(Some(12.0))?; // the inner edges are 16 sin(0.6) = 9.03 apart
    /// assert!(scene.clears(&[(&robot, Pose::IDENTITY)])?);
    /// scene.set_self_arc(Some(11.0))?; // 16 sin(0.55) = 8.36
    /// assert!(!scene.clears(&[(&robot, Pose::IDENTITY)])?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `arc` is negative or NaN.
    pub fn set_self_arc(&mut self, arc: Option<Real>) -> Result<(), SceneError> {
        check_not_negative("arc", arc.unwrap_or(0.0)).map_err(SceneError::Query)?;
        self.self_arc = arc;
        Ok(())
    }

    /// Sets the pairs of nested robots: one is inside the other, as a tube in the tube that guides
    /// it.
    ///
    /// Nested robots touch, so they are not tested against one another. A pair has the indices of
    /// two robots of a query, in any order; a pair without such robots has no effect. The new pairs
    /// replace the old ones.
    pub fn set_nested(&mut self, pairs: &[[usize; 2]]) {
        self.nested.clear();
        self.nested.extend(pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]));
    }

    /// Returns whether all robots keep all margins.
    ///
    /// True exactly if [`tightest`](Self::tightest) finds no pair, or one with a slack of more than
    /// 0; and if all robots keep the [margin to themselves](Self::set_self_margin), if it is
    /// set. The query ends at the first violated margin.
    ///
    /// # Errors
    /// - Neither a structure nor the robots have a margin.
    /// - A pose is not finite or not rigid, or moves a link out of range. The message has the
    ///   robot's number.
    /// - [`set_vertices`](Self::set_vertices) has opened the mesh of a solid structure.
    /// - A margin of robots to themselves is set, without an arc length, and a joint is too sharp
    ///   for [`SelfQuery::clears`].
    pub fn clears(&mut self, robots: &[(&Chain, Pose)]) -> Result<bool, SceneError> {
        self.check_has_margin()?;
        if self.begin(robots, None)? && !self.clears_structures(robots)? {
            return Ok(false);
        }
        if let Some(margin) = self.robot_margin {
            for [first, second] in pairs_apart(robots.len(), &self.nested) {
                let [(a, pose_a), (b, pose_b)] = [&robots[first], &robots[second]];
                let clears = self.pair.clears(a, pose_a, b, pose_b, margin);
                if !clears.map_err(of_pair([first, second]))? {
                    return Ok(false);
                }
            }
        }
        let Some(margin) = self.self_margin else { return Ok(true) };
        for (robot, (chain, _)) in robots.iter().enumerate() {
            let clears = match self.self_arc {
                None => self.itself.clears(chain, margin),
                Some(arc) => self.itself.clears_beyond(chain, arc, margin),
            };
            if !clears.map_err(of_robot(robot))? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// # Errors
    /// Nothing has a margin.
    pub(super) fn check_has_margin(&self) -> Result<(), SceneError> {
        let is_robot_tested = self.robot_margin.is_some() || self.self_margin.is_some();
        if is_robot_tested || self.structures.iter().any(Structure::has_margin) {
            Ok(())
        } else {
            Err(SceneError::NoMargin)
        }
    }

    fn clears_structures(&mut self, robots: &[(&Chain, Pose)]) -> Result<bool, SceneError> {
        if let Some([structure, robot]) = self.seed(self.met, robots)
            && !self.clears_one(structure, robot, robots)?
        {
            return Ok(false);
        }
        self.met = None;
        let mut order = std::mem::take(&mut self.order);
        let near = |structure: &Structure, robot: usize| {
            structure.margin_from(robot).map(|margin| (margin, margin))
        };
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
        for (number, structure) in self.structures.iter().enumerate() {
            for robot in 0..if structure.is_solid { robots.len() } else { 0 } {
                if structure.margin_from(robot).is_some()
                    && self.is_inside(number, robot, robots)?
                {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    /// Returns whether a robot that does not touch a structure's surface is inside, if the
    /// structure is solid.
    fn is_inside(
        &self,
        structure: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
    ) -> Result<bool, SceneError> {
        let structure = &self.structures[structure];
        let (chain, pose) = robots[robot];
        let contained = structure.contains(chain, &structure.in_mesh(&pose));
        contained.map_err(beside(structure, robot))
    }

    /// Returns the least slack and the pair that has it, or `None` if there is no robot or no
    /// margin.
    ///
    /// Slacks are compared without rounding. Ties return the lowest structure, then the lowest
    /// robot; pairs of robots come last.
    ///
    /// # Errors
    /// - A pose is not finite or not rigid, or moves a link out of range. The message has the
    ///   robot's number.
    /// - [`set_vertices`](Self::set_vertices) has opened the mesh of a solid structure.
    pub fn tightest(&mut self, robots: &[(&Chain, Pose)]) -> Result<Option<Tightest>, SceneError> {
        self.begin(robots, Some(Real::INFINITY))?;
        let mut best: Best = None;
        if let Some([structure, robot]) = self.seed(self.tightest, robots) {
            self.offer(structure, robot, robots, &mut best)?;
        }
        // Step 3. The pair with the least lower bound is first, because its slack excludes the most
        // others.
        let mut order = std::mem::take(&mut self.order);
        let near = |structure: &Structure, robot: usize| {
            structure.margin_from(robot).map(|margin| (margin, beyond(&best, margin)))
        };
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
        for number in 0..self.structures.len() {
            if !self.structures[number].is_solid {
                continue;
            }
            for robot in 0..robots.len() {
                self.offer_inside(number, robot, robots, &mut best)?;
            }
        }
        self.tightest = match best.as_ref().map(|(_, best)| best.between) {
            Some(Between::Structure(near)) => Some([near.structure as usize, near.robot as usize]),
            _ => None,
        };
        let Some(margin) = self.robot_margin else { return Ok(best.map(|(_, best)| best)) };
        for [first, second] in pairs_apart(robots.len(), &self.nested) {
            let [(a, pose_a), (b, pose_b)] = [&robots[first], &robots[second]];
            let nearest =
                self.pair.minimum(a, pose_a, b, pose_b).map_err(of_pair([first, second]))?;
            let slack = slack(nearest.distance, margin);
            if best.as_ref().is_none_or(|(least, _)| slack.lt(*least)) {
                let between = Between::Robots { robots: [first as u32, second as u32], nearest };
                best = Some((slack, Tightest { slack: slack.rounded(), between }));
            }
        }
        Ok(best.map(|(_, best)| best))
    }

    /// Finds the closest robot of each structure, in order, with or without a margin.
    ///
    /// If the robots have different margins from the structure, the one with the least slack is
    /// found. Robots without a margin are then ignored. `out` is cleared first, and stays empty if
    /// no robot is given.
    ///
    /// # Errors
    /// As [`tightest`](Self::tightest).
    pub fn per_structure(
        &mut self,
        robots: &[(&Chain, Pose)],
        out: &mut Vec<StructureProximity>,
    ) -> Result<(), SceneError> {
        out.clear();
        // A bad robot is an error in a scene without structures too.
        for (robot, (chain, pose)) in robots.iter().enumerate() {
            PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
        }
        self.bounds()?;
        for (number, structure) in self.structures.iter_mut().enumerate() {
            let has_margin = (0..robots.len()).any(|robot| structure.margin_from(robot).is_some());
            let mut best: Option<(DoubleDouble, StructureProximity)> = None;
            for (robot, (chain, pose)) in robots.iter().enumerate() {
                let margin = structure.margin_from(robot);
                if has_margin && margin.is_none() {
                    continue;
                }
                let pose = structure.in_mesh(pose);
                let bound = best.as_ref().map_or(Real::INFINITY, |(least, best)| {
                    if structure.margin_from(best.robot as usize) == margin {
                        return best.nearest.distance;
                    }
                    // Not a number if both are infinite.
                    let bound = (least.rounded().next_up() + margin.unwrap_or(0.0)).next_up();
                    if bound.is_nan() { Real::INFINITY } else { bound }
                });
                if bound < 0.0 {
                    continue;
                }
                let found = structure.search.minimum_within(chain, &pose, bound);
                let mut found = found.map_err(beside(structure, robot))?;
                if structure.contains(chain, &pose).map_err(beside(structure, robot))? {
                    let nearest = structure.search.minimum(chain, &pose);
                    found = Some(inside(nearest.map_err(beside(structure, robot))?));
                }
                let Some(found) = found else { continue };
                let slack = slack(found.distance, margin.unwrap_or(0.0));
                let is_tighter = best.as_ref().is_none_or(|(least, best)| {
                    let is_closer = found.distance < best.nearest.distance;
                    slack.lt(*least) || (slack.le(*least) && is_closer)
                });
                if is_tighter {
                    let near = StructureProximity {
                        structure: number as u32,
                        robot: robot as u32,
                        nearest: structure.placed(found),
                        slack: margin.map(|margin| found.distance - margin),
                    };
                    best = Some((slack, near));
                }
            }
            out.extend(best.map(|(_, best)| best));
        }
        Ok(())
    }

    /// Finds every contact of every robot with every structure at most `reach` away.
    ///
    /// Each contact is one of [`Proximity::contacts_within`] at this prominence; they are sorted by
    /// structure, then by robot. `out` is cleared first.
    ///
    /// # Errors
    /// As [`tightest`](Self::tightest), or `reach` or `prominence` is negative or NaN.
    pub fn contacts_within(
        &mut self,
        robots: &[(&Chain, Pose)],
        reach: Real,
        prominence: Real,
        out: &mut Vec<SceneContact>,
    ) -> Result<(), SceneError> {
        out.clear();
        check_not_negative("reach", reach).map_err(SceneError::Query)?;
        check_not_negative("prominence", prominence).map_err(SceneError::Query)?;
        if !self.begin(robots, Some(reach))? {
            return Ok(());
        }
        let mut order = std::mem::take(&mut self.order);
        let asked = self.gather(robots, |_, _| Some((0.0, reach)), &mut order).and_then(|()| {
            order.sort_unstable_by_key(|(_, who)| *who);
            for &(_, [number, robot]) in &order {
                let Some(placed) = self.place_unless_clear(number, robot, robots, reach)? else {
                    continue;
                };
                let structure = &mut self.structures[number];
                let asked = ContactQuery { margin: reach, prominence };
                structure
                    .search
                    .ask_contacts(placed, asked, &mut self.contacts)
                    .map_err(beside(structure, robot))?;
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

    /// Builds every structure that a later query would build at first use.
    pub fn prepare(&self) {
        self.structures.iter().for_each(|structure| structure.search.prepare());
    }

    pub(super) fn structure(&mut self, structure: usize) -> Result<&mut Structure, SceneError> {
        let structures = self.structures.len();
        self.structures
            .get_mut(structure)
            .ok_or(SceneError::NoSuchStructure { structure, structures })
    }

    /// The pairs (structure, robot) that have a margin, with a lower bound on the slack: the least
    /// first. `at_least` bounds the distance of a structure, with its number, from a
    /// robot.
    pub(super) fn by_slack(
        &self,
        robots: usize,
        at_least: impl Fn(usize, &Structure, usize) -> Real,
    ) -> Vec<(Real, [usize; 2])> {
        let mut order = Vec::new();
        for (number, structure) in self.structures.iter().enumerate() {
            order.extend((0..robots).filter_map(|robot| {
                let margin = structure.margin_from(robot)?;
                let slack = (at_least(number, structure, robot) - margin).next_down();
                // An infinite margin and an infinite bound.
                Some((if slack.is_nan() { Real::NEG_INFINITY } else { slack }, [number, robot]))
            }));
        }
        order.sort_unstable_by(nearest_first);
        order
    }

    /// Step 2: the pair of the last query, if this query has it and no placement can fail.
    fn seed(&self, last: Option<[usize; 2]>, robots: &[(&Chain, Pose)]) -> Option<[usize; 2]> {
        let size = self.all?.size;
        let mut watches = self.watches.iter().take(robots.len());
        last.filter(|[structure, robot]| {
            *structure < self.structures.len() && *robot < robots.len()
        })
        .filter(|_| watches.all(|watch| watch.is_in_range(size)))
    }

    /// Drops the cached distances from a structure, which were measured at its old place.
    fn has_moved(&mut self, structure: usize) {
        self.watches.iter_mut().for_each(|watch| watch.forget(structure));
        self.all = None;
    }

    /// The bounds of all structures.
    ///
    /// # Errors
    /// The mesh of a solid structure is open, since its vertices have moved.
    pub(super) fn bounds(&mut self) -> Result<SceneBounds, SceneError> {
        if let Some(all) = self.all {
            return Ok(all);
        }
        self.structures.iter().try_for_each(Structure::check_solid)?;
        Ok(*self.all.insert(SceneBounds::of(&self.structures)))
    }

    /// Step 1. Returns false if all robots are farther than `bound` from all structures; without a
    /// bound, farther than the largest margin.
    ///
    /// It places robots without any partner too, so that the steps below meet no bad robot.
    fn begin(
        &mut self,
        robots: &[(&Chain, Pose)],
        bound: Option<Real>,
    ) -> Result<bool, SceneError> {
        let all = self.bounds()?;
        let (mut may_be_near, bound) = (false, bound.unwrap_or(all.margin));
        for (robot, (chain, pose)) in robots.iter().enumerate() {
            let placed = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            may_be_near = may_be_near || !all.are_beyond(bound, &placed);
        }
        if !may_be_near {
            // The odometers stay: a robot that comes near again is counted from its last pose.
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
        let Some(margin) = self.structures[number].margin_from(robot) else { return Ok(true) };
        let Some(placed) = self.place_unless_clear(number, robot, robots, margin)? else {
            return Ok(true);
        };
        let structure = &mut self.structures[number];
        let clears =
            structure.search.ask_clears(placed, margin).map_err(beside(structure, robot))?;
        if !clears {
            self.watches[robot].mark_near(number);
        }
        Ok(clears)
    }

    /// Places the robot in the frame of a structure's mesh, unless it is farther than `bound`.
    ///
    /// If the robot moves little, one query of `bound + look_ahead` also serves the next queries.
    /// Otherwise the bounding boxes alone are tested.
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
        let placed = PlacedRobot::new(chain, &structure.in_mesh(&pose));
        let placed = placed.map_err(beside(structure, robot))?;
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

    /// Step 3: writes to `order` the pairs that may be within their bound, with a lower bound on
    /// the slack.
    ///
    /// `asked` returns the margin and the bound of a structure and a robot, or `None` if the query
    /// ignores the two. Each robot is placed once for all structures whose frame is the scene's.
    fn gather(
        &mut self,
        robots: &[(&Chain, Pose)],
        asked: impl Fn(&Structure, usize) -> Option<(Real, Real)>,
        order: &mut Vec<(Real, [usize; 2])>,
    ) -> Result<(), SceneError> {
        order.clear();
        for (robot, ((chain, pose), watch)) in robots.iter().zip(&mut self.watches).enumerate() {
            let in_scene = PlacedRobot::new(chain, pose).map_err(of_robot(robot))?;
            for (number, structure) in self.structures.iter().enumerate() {
                let Some((margin, bound)) = asked(structure, robot) else { continue };
                if watch.lower_bound(number, structure.size()) > bound {
                    continue;
                }
                let placed = structure.place(chain, pose, &in_scene);
                let placed = placed.map_err(beside(structure, robot))?;
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

    /// Step 4 of `tightest`: keeps the pair if it is tighter than the best, and lowers the best.
    fn offer(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
        best: &mut Best,
    ) -> Result<(), SceneError> {
        let Some(margin) = self.structures[number].margin_from(robot) else { return Ok(()) };
        let bound = beyond(best, margin);
        if bound < 0.0 {
            return Ok(());
        }
        let Some(placed) = self.place_unless_clear(number, robot, robots, bound)? else {
            return Ok(());
        };
        let (structure, watch) = (&mut self.structures[number], &mut self.watches[robot]);
        let far = bound + watch.look_ahead().unwrap_or(0.0);
        let found = structure.search.ask_nearest(placed, far).map_err(beside(structure, robot))?;
        watch.record(number, found.map_or(far, |found| found.distance), structure.size());
        let Some(found) = found else { return Ok(()) };
        if found.distance <= bound {
            watch.mark_near(number);
        }
        self.keep([number, robot], found, margin, best);
        Ok(())
    }

    /// Step 5 of `tightest`: offers a robot that is inside of a solid.
    fn offer_inside(
        &mut self,
        number: usize,
        robot: usize,
        robots: &[(&Chain, Pose)],
        best: &mut Best,
    ) -> Result<(), SceneError> {
        let Some(margin) = self.structures[number].margin_from(robot) else { return Ok(()) };
        if beyond(best, margin) < 0.0 || !self.is_inside(number, robot, robots)? {
            return Ok(());
        }
        let structure = &mut self.structures[number];
        let (chain, pose) = robots[robot];
        let nearest = structure.search.minimum(chain, &structure.in_mesh(&pose));
        let nearest = nearest.map_err(beside(structure, robot))?;
        self.keep([number, robot], inside(nearest), margin, best);
        Ok(())
    }

    /// Keeps a pair if it is tighter than the best.
    fn keep(
        &self,
        [number, robot]: [usize; 2],
        found: LinkProximity,
        margin: Real,
        best: &mut Best,
    ) {
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
                nearest: self.structures[number].placed(found),
                slack: Some(rounded),
            };
            *best = Some((slack, Tightest { slack: rounded, between: Between::Structure(near) }));
        }
    }
}

/// Orders pairs by the lower bound on their slack, then by their numbers.
fn nearest_first(one: &(Real, [usize; 2]), other: &(Real, [usize; 2])) -> Ordering {
    one.0.total_cmp(&other.0).then(one.1.cmp(&other.1))
}

/// The slack, exactly. The margin may be infinite.
fn slack(distance: Real, margin: Real) -> DoubleDouble {
    if margin == Real::INFINITY {
        return Real::NEG_INFINITY.into();
    }
    DoubleDouble::from(distance) - margin.into()
}

/// Checks a margin, if there is one.
fn check(margin: Option<Real>) -> Result<(), ProximityError> {
    margin.map_or(Ok(()), check_margin)
}

pub(super) fn of_structure(structure: &Structure, error: ProximityError) -> SceneError {
    SceneError::Structure { name: structure.name.clone(), error }
}

pub(super) fn of_robot(robot: usize) -> impl Fn(ProximityError) -> SceneError {
    move |error| SceneError::Robot { robot, structure: None, error }
}

/// Attributes an error to a robot and the structure that was queried.
pub(super) fn beside(structure: &Structure, robot: usize) -> impl Fn(ProximityError) -> SceneError {
    move |error| SceneError::Robot { robot, structure: Some(structure.name.clone()), error }
}

/// The proximity of a robot inside of a solid, given that to its surface.
fn inside(nearest: LinkProximity) -> LinkProximity {
    LinkProximity { distance: 0.0, witness: common_point(nearest.witness), ..nearest }
}

/// Attributes an error of a query about two robots to the robot that causes it, or to both. The
/// query calls them `a` and `b`, or their poses `pose_a` and `pose_b`.
pub(super) fn of_pair(robots: [usize; 2]) -> impl Fn(ProximityError) -> SceneError {
    let of = move |parameter: &str| of_robot(robots[usize::from(parameter.ends_with('b'))]);
    move |error| match error {
        ProximityError::OneMotion { parameter, fault } => {
            of(parameter)(ProximityError::Motion(fault))
        }
        ProximityError::Placement { parameter, fault } => {
            of(parameter)(ProximityError::Pose(fault))
        }
        error => SceneError::Robots { robots, error },
    }
}

/// The distance beyond which a structure with this margin is not tighter than the best, rounded up.
fn beyond(best: &Best, margin: Real) -> Real {
    best.as_ref().map_or(Real::INFINITY, |(_, best)| (best.slack.next_up() + margin).next_up())
}

/// The pairs of robots that are tested against one another, in order: all but the nested pairs.
pub(super) fn pairs_apart(
    robots: usize,
    nested: &[[usize; 2]],
) -> impl Iterator<Item = [usize; 2]> {
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

    /// Along a smooth walk most structures are skipped, and the answers equal those without a
    /// cache.
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
                        _ => scene.contacts_within(&robots, 0.4, 0.0, &mut found).unwrap(),
                    }
                    (clears, tightest, found)
                });
                assert_eq!(one, other);
                contacts += one.2.len();
                // `order` has the pairs that were not skipped.
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
