//! The work of an engine.

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
/// assert!(search.work().axis_distances < triangles.len() as u64 && triangles.len() as u64 <= all.work().visited);
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
