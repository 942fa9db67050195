//! Queries about many sets of robots in one scene, on all cores: a planner's shapes and edges.

use super::Scene;
use crate::answer::{SceneError, SceneMotionAnswer, Tightest};
use crate::motion::Motion;
use crate::robot::Chain;
use crate::threads::with_clones;
use parry3d_f64::math::{Pose, Real};

impl Scene {
    /// [`clears`](Self::clears) for many sets of robots, on all cores.
    ///
    /// Writes one result per set to `out`, in order.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Real, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// let shapes = [0.0, 3.0, 8.0, Real::NAN].map(|x| [(&robot, Pose::translation(x, 0.0, 0.0))]);
    /// let sets = shapes.each_ref().map(|set| set.as_slice());
    /// let mut answers = Vec::new();
    /// scene.clears_batch(&sets, &mut answers);
    /// assert_eq!(answers[..3], [Ok(true), Ok(true), Ok(false)]);
    /// assert_eq!(answers[3].as_ref().map_err(|error| error.kind()), Err("pose_not_finite"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears_batch(
        &self,
        sets: &[&[(&Chain, Pose)]],
        out: &mut Vec<Result<bool, SceneError>>,
    ) {
        with_clones(self, sets, out, || Ok(false), |scene, robots| scene.clears(robots));
    }

    /// [`tightest`](Self::tightest) for many sets of robots, on all cores.
    ///
    /// Writes one result per set to `out`, in order.
    ///
    /// ```
    /// use parry_continuum::Chain;
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// let shapes = [0.0, 3.0].map(|x| [(&robot, Pose::translation(x, 0.0, 0.0))]);
    /// let mut answers = Vec::new();
    /// scene.tightest_batch(&shapes.each_ref().map(|set| set.as_slice()), &mut answers);
    /// for (shape, answer) in shapes.iter().zip(answers) {
    ///     assert_eq!(answer, scene.tightest(shape)); // the same, one by one
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn tightest_batch(
        &self,
        sets: &[&[(&Chain, Pose)]],
        out: &mut Vec<Result<Option<Tightest>, SceneError>>,
    ) {
        with_clones(self, sets, out, || Ok(None), |scene, robots| scene.tightest(robots));
    }

    /// [`clears_motion`](Self::clears_motion) for many edges of a planner, on all cores.
    ///
    /// An edge has one motion per robot. Writes one result per edge to `out`, in order.
    ///
    /// ```
    /// use parry_continuum::LinearMotion;
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    /// use parry_continuum::proximity::{BvhSearch, Decision, Scene};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut scene = Scene::new();
    /// scene.add("wall", BvhSearch::from_triangles(&vertices, &triangles)?, Some(1.0))?;
    /// let shapes = [0.0, 3.0, 6.0, 9.0].map(|x| [Vector::ZERO, Vector::new(x, 0.0, 5.0)]);
    /// let edges = shapes.windows(2).map(|ends| LinearMotion::chain(&ends[0], &ends[1], &[0.5]));
    /// let edges = edges.collect::<Result<Vec<_>, _>>()?;
    /// let sets: Vec<_> = edges.iter().map(|edge| [edge]).collect();
    /// let sets: Vec<_> = sets.iter().map(|set| set.as_slice()).collect();
    /// let mut answers = Vec::new();
    /// scene.clears_motion_batch(&sets, 1e-3, &mut answers);
    /// let decisions = answers.into_iter().map(|answer| answer.map(|answer| answer.decision));
    /// let decisions = decisions.collect::<Result<Vec<_>, _>>()?;
    /// assert_eq!(decisions, [Decision::Clear, Decision::Clear, Decision::Contact]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn clears_motion_batch<M: Motion + Sync + ?Sized>(
        &self,
        edges: &[&[&M]],
        resolution: Real,
        out: &mut Vec<Result<SceneMotionAnswer, SceneError>>,
    ) {
        let ask = |scene: &mut Self, edge: &&[&M]| scene.clears_motion(edge, resolution);
        with_clones(self, edges, out, || Ok(SceneMotionAnswer::clear()), ask);
    }
}
