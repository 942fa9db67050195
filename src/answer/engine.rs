//! Answers about the mesh itself, and the work of an engine.

/// The side of a mesh on which a point lies.
///
/// The mesh's winding number w decides: the sum of the solid angles of its triangles, divided by 4
/// pi. For a closed mesh w is an integer, and not 0 inside. Triangles may face outward or inward,
/// if all do the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// Proven: |w| > 3/4.
    Inside,
    /// Proven: |w| < 1/4.
    Outside,
    /// Neither: the point lies on the surface, within rounding; or holes of the mesh, or triangles
    /// that are there twice or face the wrong way, cover at least a quarter of the view from it.
    Undecided,
}

/// Whether a robot is inside a wall and keeps a margin to it: both, if [`holds`](Self::holds).
///
/// The side at the tip differs from the side at the base if the robot passes through the wall or
/// leaves through an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct InsideAnswer {
    /// The side of the robot's base, the first point of its centreline.
    pub base: Side,
    /// The side of the robot's tip, the last point of its centreline.
    pub tip: Side,
    /// Whether a link touches the lid of an [opening](super::Opening): the triangles between its
    /// edges and its centre.
    pub crosses_opening: bool,
    /// Whether every link is farther than the margin.
    pub clears: bool,
}

impl InsideAnswer {
    /// Returns whether the whole robot is inside and every link keeps the margin: no link touches
    /// the mesh or crosses an opening, base or tip is inside, and neither is outside. Near an
    /// opening an end may be undecided: it is on the side of the other end.
    pub fn holds(&self) -> bool {
        let ends = [self.base, self.tip];
        let is_inside = ends.contains(&Side::Inside) && !ends.contains(&Side::Outside);
        is_inside && !self.crosses_opening && self.clears
    }
}

/// The work of an engine since it was built, batches excluded.
///
/// ```
/// use parry_continuum::Chain;
/// use parry_continuum::parry::{math::{Pose, Vector}, shape::Ball};
/// use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, Work};
///
/// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
/// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
/// let mut all = Exhaustive::<f32>::from_triangles(&vertices, &triangles)?;
/// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::new(0.0, 0.0, 5.0)], &[0.5])?;
/// assert_eq!(search.work(), Work::default());
/// search.minimum(&robot, &Pose::IDENTITY)?;
/// all.minimum(&robot, &Pose::IDENTITY)?;
/// assert!(
///     search.work().axis_distances < triangles.len() as u64
///         && triangles.len() as u64 <= all.work().visited
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Work {
    /// Nodes of the hierarchy whose children (up to 16) were bounded; 0 in an exhaustive engine.
    pub nodes: u64,
    /// Pairs of link and triangle that were visited, 16 triangles at a time.
    pub visited: u64,
    /// Pairs whose distance between axis and triangle was computed, a pack at a time.
    pub axis_distances: u64,
    /// Pairs that were measured in double precision, with the disc of a flat cap if the disc
    /// decides.
    pub measured: u64,
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.visited += other.visited;
        self.axis_distances += other.axis_distances;
        self.measured += other.measured;
    }
}
