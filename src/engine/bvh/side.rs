//! Inside or outside, as [`BvhSearch`] answers it.
//!
//! The side of a point is its winding number ([`Winding`]). Consecutive links that touch neither
//! the mesh nor the lid of an opening ([`Surface`](crate::query::side::Surface)) are on one side.

use super::search::BvhSearch;
use crate::answer::{InsideAnswer, ProximityError, Side, SurfaceReport};
#[cfg(doc)]
use crate::engine::Proximity;
use crate::pair::PlacedRobot;
use crate::query::check_margin;
use crate::query::side::Winding;
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real, Vector};
use std::ops::Range;

impl BvhSearch {
    /// Returns the side of the mesh on which a point lies. The point is in the mesh's frame.
    ///
    /// `Inside` and `Outside` are proven: the error of the winding number is bounded, rounding
    /// included. In a closed mesh the answer is [`Side::Undecided`] only if the point lies on the
    /// surface, within rounding, or is not finite. [`Side`] defines the answer for an open mesh.
    ///
    /// The first query builds the far field of each node, and so does the first one after
    /// [`set_vertices`](Proximity::set_vertices), unless [`prepare`](Self::prepare) has built it.
    /// Clones share the far fields.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::{Ball, TriMesh}};
    /// use parry_continuum::proximity::{BvhSearch, Side};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let search = BvhSearch::new(&TriMesh::new(vertices.clone(), triangles)?)?;
    /// assert_eq!(search.side(Vector::X * 9.9), Side::Inside);
    /// assert_eq!(search.side(Vector::X * 10.1), Side::Outside);
    /// assert_eq!(search.side(vertices[0]), Side::Undecided);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn side(&self, point: Vector) -> Side {
        let prepared = self.prepared();
        let hierarchy = &prepared.hierarchy;
        let (mesh, tree) = (&hierarchy.mesh, hierarchy.single());
        Winding { mesh, tree, fields: prepared.far_fields(), point }.side()
    }

    /// Returns what the mesh is as a surface: its openings, the widest first, and the edges that
    /// make its sides doubtful.
    ///
    /// The first query builds it, and so does the first one after
    /// [`set_vertices`](Proximity::set_vertices), unless [`prepare`](Self::prepare) has built it.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    /// use parry_continuum::proximity::BvhSearch;
    ///
    /// let (vertices, mut triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// assert!(BvhSearch::from_triangles(&vertices, &triangles)?.surface().is_sound());
    /// triangles.retain(|triangle| triangle.iter().all(|&corner| vertices[corner as usize].y < 8.0));
    /// let search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let [opening] = &search.surface().openings[..] else { panic!() };
    /// assert!(opening.edges == 64 && 12.0 < opening.width && opening.width < 14.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn surface(&self) -> &SurfaceReport {
        &self.surface_with_lids().report
    }

    /// Returns whether every link is farther than `margin` from the mesh, the sides of the robot's
    /// base and tip, and whether it crosses an opening.
    ///
    /// Distances are unsigned, so [`clears`](Proximity::clears) alone is true of a robot outside
    /// the anatomy. A robot whose base is inside is inside as a whole, unless it touches the mesh
    /// or the lid of an opening: the triangles between the edges of the opening and its centre. A
    /// mesh with edges of more than two triangles, or with triangles that face opposite ways, has
    /// no reliable sides: see [`surface`](Self::surface).
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Side}};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::{Ball, TriMesh}};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::new(&TriMesh::new(vertices, triangles)?)?;
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 5.0], &[0.5])?;
    /// assert!(search.clears_inside(&robot, &Pose::IDENTITY, 2.0)?.holds());
    /// let beside = search.clears_inside(&robot, &Pose::from_translation(Vector::X * 20.0), 2.0)?;
    /// assert!(beside.clears && beside.base == Side::Outside);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The margin is negative or NaN, the pose is not finite, or it moves a link out of range.
    pub fn clears_inside(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        margin: Real,
    ) -> Result<InsideAnswer, ProximityError> {
        check_margin(margin)?;
        let placed = PlacedRobot::new(robot, pose)?;
        let clears = self.context().clears(placed, margin);
        let [base, tip] = placed.ends();
        let base = self.side(base);
        // Both ends of a robot that touches no sound surface are on one side.
        let tip = if clears && self.surface().is_sound() { base } else { self.side(tip) };
        let crosses_opening = self.context().touches_lid(placed);
        Ok(InsideAnswer { base, tip, crosses_opening, clears })
    }

    /// Writes the side of each link to `out`.
    ///
    /// A link that touches the mesh or the lid of an opening is [`Side::Undecided`]. The other
    /// links lie on one side of the mesh and its lids from one such link to the next. Their side is
    /// the [`side`](Self::side) of their ends that are decided; without any, or if two ends
    /// contradict one another, it is [`Side::Undecided`]. See
    /// [`clears_inside`](Self::clears_inside) for lids.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::{BvhSearch, Side}};
    /// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let points = [0.0, 6.0, 12.0, 18.0].map(|z| Vector::Z * z);
    /// let mut sides = Vec::new();
    /// let robot = Chain::with_constant_radius(&points, 0.5)?;
    /// search.link_sides(&robot, &Pose::IDENTITY, &mut sides)?;
    /// assert_eq!(sides, [Side::Inside, Side::Undecided, Side::Outside]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The pose is not finite, or it moves a link out of range.
    pub fn link_sides(
        &mut self,
        robot: &Chain,
        pose: &Pose,
        out: &mut Vec<Side>,
    ) -> Result<(), ProximityError> {
        out.clear();
        let (mut links, mut lids) = (Vec::new(), Vec::new());
        let placed = PlacedRobot::new(robot, pose)?;
        self.context().per_link(placed, &mut links);
        self.context().per_link_of_lids(placed, &mut lids);
        let mut touches = vec![false; links.len()];
        for link in links.iter().chain(&lids) {
            touches[link.link as usize] |= link.distance == 0.0;
        }
        for run in touches.chunk_by(|one, other| one == other) {
            let links = out.len()..out.len() + run.len();
            let side = if run[0] { Side::Undecided } else { self.side_of_run(placed, links) };
            out.resize(out.len() + run.len(), side);
        }
        Ok(())
    }

    /// Returns the side of consecutive links that lie on one side.
    fn side_of_run(&self, robot: PlacedRobot, links: Range<usize>) -> Side {
        let ends = links.clone().map(|link| robot.link(link).end());
        let mut sides = [robot.link(links.start).start()]
            .into_iter()
            .chain(ends)
            .map(|end| self.side(end))
            .filter(|side| *side != Side::Undecided);
        let Some(side) = sides.next() else { return Side::Undecided };
        if sides.all(|other| other == side) { side } else { Side::Undecided }
    }
}
