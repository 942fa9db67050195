//! A robot as a chain of links.
//!
//! # Algorithm
//! 1. Check the points and radii.
//! 2. Decide the caps of every segment: Algorithm 1 of the paper (`algorithm_1`), or one cap for
//!    all.
//! 3. Make a link of each segment that has a length (`Chain::assemble`).
//! 4. Derive the link tree and the arc lengths from the links (`Chain::follow_links`).

use super::link_tree::{self, LinkNode};
use super::modified_cylinder::{check_points, check_radii, has_direction};
use super::{Cap, ModifiedCylinder, RobotError, algorithm_1};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};
use std::ops::Range;
use std::sync::OnceLock;

/// A continuum robot: links joined end to end along a centreline (paper, section III.F).
///
/// A chain is the union of its links. Neighbouring links overlap where a round cap reaches into the
/// next link. The outer surface of the union is exact. Quantities of the interior, such as volume
/// or depth, are known per link only.
///
/// The constructors differ in the caps alone:
///
/// | constructor | caps | shape |
/// |---|---|---|
/// | [`from_centreline`](Self::from_centreline) | fitted (Algorithm 1 of the paper), one radius per segment | flat ends, filled bends |
/// | [`from_vertex_radii`](Self::from_vertex_radii) | fitted, exactly as printed in the paper, one radius per point | flat ends, filled bends |
/// | [`capsules`](Self::capsules) | all round | covers the tube; reaches one radius too far at its ends |
/// | [`cylinders`](Self::cylinders) | all flat | exact at its ends; open wedges at the bends |
///
/// Points and radii are in one unit of length and in the robot's frame. All constructors accept
/// magnitudes up to 1e150.
///
/// # Repeated points
/// Planners repeat centreline points. A segment without length has no direction and makes no link.
/// No radius of such a segment makes a step: repeating a point changes no link. The exception is
/// [`from_vertex_radii`](Self::from_vertex_radii), whose printed rule has a radius per point.
///
/// [`segments_of`](Self::segments_of) counts such a segment to the link before it, or to the first
/// link.
///
/// ```
/// use parry_continuum::{Cap, Chain, parry::math::Vector};
///
/// let points = [Vector::ZERO, Vector::new(3.0, 0.0, 0.0), Vector::new(5.0, 2.0, 0.0)];
/// let robot = Chain::from_centreline(&points, &[1.0, 1.0])?;
/// assert_eq!(robot.links()[0].caps(), [Cap::Flat, Cap::Round]);
/// assert_eq!(robot.links()[1].caps(), [Cap::Round, Cap::Flat]);
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::serialised::Links", into = "super::serialised::Links")
)]
pub struct Chain {
    links: Vec<ModifiedCylinder>,
    segments: Vec<Range<usize>>,
    /// The segment of the first link. Segments before it have no length.
    first_segment: usize,
    /// Bounding capsules of halves, quarters, ... of the links, in preorder.
    link_tree: Vec<LinkNode>,
    /// Arc length from the base to the start of each link.
    lengths_before: Vec<Real>,
    /// The links' boxes for parry's composite queries; leaf i is link i. Built on first use.
    bvh: OnceLock<Bvh>,
    /// The caps of the input's segments. Kept to reuse the memory.
    caps: Vec<[Cap; 2]>,
    /// Whether all links have one cap by definition. Otherwise Algorithm 1 may have decided the
    /// caps, and decides anew in another shape of the robot.
    is_uniform: bool,
}

impl Chain {
    /// Builds the robot with fitted caps (Algorithm 1 of the paper) from one radius per segment.
    ///
    /// - Both ends of the robot and the wider side of each step in radius are flat.
    /// - A joint between them is round if its round cap does not stick out of such a face. A joint
    ///   exactly one radius from a face is round.
    /// - Radii that differ by less than 2^-32 of the first of them are equal, so that a constant
    ///   radius may carry rounding errors.
    ///
    /// `points` and `segment_radii` are in one unit of length and in the robot's frame, from base
    /// to tip; `segment_radii.len() == points.len() - 1`.
    ///
    /// # Errors
    /// - fewer than two points, or a wrong number of radii;
    /// - a coordinate or radius that is not finite or beyond 1e150, or a negative radius;
    /// - all points equal, or every segment too short beside its radius.
    pub fn from_centreline(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        let mut chain = Self::empty();
        chain.set_centreline(points, segment_radii)?;
        Ok(chain)
    }

    /// Builds the robot with the same radius everywhere.
    ///
    /// As [`from_centreline`](Self::from_centreline) with `radius` for all segments.
    ///
    /// # Errors
    /// - fewer than two points;
    /// - a coordinate that is not finite or beyond 1e150;
    /// - a radius that is negative, not finite or beyond 1e150;
    /// - all points equal, or every segment too short beside the radius.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// let rod =
    ///     Chain::with_constant_radius(&[Vector::ZERO, Vector::Z, Vector::Z + Vector::X], 0.1)?;
    /// assert_eq!(rod.links().len(), 2);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn with_constant_radius(points: &[Vector], radius: Real) -> Result<Self, RobotError> {
        Self::from_centreline(points, &radius_for_all(points, radius)?)
    }

    /// Replaces the centreline, as [`from_centreline`](Self::from_centreline), in the same memory.
    ///
    /// A control loop whose robot keeps its number of points allocates nothing.
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline). The chain is then unchanged.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// let mut robot =
    ///     Chain::from_centreline(&[Vector::ZERO, Vector::Z, 2.0 * Vector::Z], &[0.5, 0.5])?;
    /// robot.set_centreline(&[Vector::ZERO, Vector::Z, Vector::Z + Vector::X], &[0.5, 0.5])?;
    /// assert_eq!(robot.links()[1].end(), Vector::new(1.0, 0.0, 1.0));
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn set_centreline(
        &mut self,
        points: &[Vector],
        segment_radii: &[Real],
    ) -> Result<(), RobotError> {
        check_segments(points, segment_radii)?;
        algorithm_1::from_segment_radii(points, segment_radii, &mut self.caps);
        self.assemble(points, segment_radii, "segment_radii")?;
        self.is_uniform = false;
        Ok(())
    }

    /// Builds the robot from one radius per point, with caps by Algorithm 1 as the paper prints it.
    ///
    /// A segment takes the smaller radius of its two points. Its start is round if the paper's lB
    /// is true for its first point, its end if lF is true for its second point. Prefer
    /// [`from_centreline`](Self::from_centreline), where a radius belongs to a tube. The printed
    /// rule leaves two kinds of joint open: the first joint after a thick tube shorter than its
    /// radius, and both sides of a single thick point.
    ///
    /// ```
    /// use parry_continuum::{Cap, Chain, parry::math::Vector};
    ///
    /// // A thick tube that ends at the second point, and a thin one.
    /// let points = [0.0, 5.0, 9.0, 13.0].map(|x| Vector::X * x);
    /// let robot = Chain::from_vertex_radii(&points, &[1.0, 1.0, 0.4, 0.4])?;
    /// assert_eq!(robot, Chain::from_centreline(&points, &[1.0, 0.4, 0.4])?);
    /// assert_eq!(robot.links()[0].caps(), [Cap::Flat; 2]);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline), with as many radii as points.
    pub fn from_vertex_radii(points: &[Vector], vertex_radii: &[Real]) -> Result<Self, RobotError> {
        check_chain(["points", "vertex_radii"], points, vertex_radii, points.len())?;
        let segment_radii: Vec<_> =
            vertex_radii.windows(2).map(|radii| radii[0].min(radii[1])).collect();
        let mut chain = Self::empty();
        algorithm_1::from_vertex_radii(points, vertex_radii, &mut chain.caps);
        chain.assemble(points, &segment_radii, "vertex_radii").map_err(|error| match error {
            // The radius of a segment is the smaller of two.
            RobotError::HidesLength { parameter, index, value, length } => {
                let index =
                    if vertex_radii[index] <= vertex_radii[index + 1] { index } else { index + 1 };
                RobotError::HidesLength { parameter, index, value, length }
            }
            other => other,
        })?;
        Ok(chain)
    }

    /// Builds the robot with a round cap at both ends of each segment.
    ///
    /// Arguments as for [`from_centreline`](Self::from_centreline).
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline).
    pub fn capsules(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        Self::uniform(points, segment_radii, Cap::Round)
    }

    /// Builds the robot with a flat cap at both ends of each segment.
    ///
    /// Arguments as for [`from_centreline`](Self::from_centreline).
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline).
    pub fn cylinders(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        Self::uniform(points, segment_radii, Cap::Flat)
    }

    /// Returns the links from base to tip. There is at least one.
    pub fn links(&self) -> &[ModifiedCylinder] {
        &self.links
    }

    /// Returns the range of input segments that a link stands for; empty if there is no such link.
    ///
    /// Segment k joins points k and k + 1. The ranges of all links, in order, cover every segment
    /// once. Exactly one segment of each range has a length.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// // The second segment has no length.
    /// let robot =
    ///     Chain::from_centreline(&[0.0, 1.0, 1.0, 2.0].map(|z| Vector::Z * z), &[0.5; 3])?;
    /// assert_eq!((robot.segments_of(0), robot.segments_of(1)), (0..2, 2..3));
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn segments_of(&self, link: usize) -> Range<usize> {
        self.segments.get(link).cloned().unwrap_or_default()
    }

    /// Returns the one segment of [`segments_of`](Self::segments_of) that has a length.
    pub(crate) fn segment_of(&self, link: usize) -> usize {
        if link == 0 { self.first_segment } else { self.segments_of(link).start }
    }

    /// Returns the smallest axis-aligned box, in the robot's frame, that contains all links.
    pub fn local_aabb(&self) -> Aabb {
        let boxes = self.links.iter().map(ModifiedCylinder::local_aabb);
        boxes.reduce(|a, b| a.merged(&b)).unwrap_or_else(Aabb::new_invalid)
    }

    /// Returns parry's bounding volume hierarchy of the links; leaf i is link i.
    pub(crate) fn bvh(&self) -> &Bvh {
        self.bvh.get_or_init(|| {
            let boxes: Vec<_> = self.links.iter().map(ModifiedCylinder::local_aabb).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        })
    }

    /// Whether the robot has the same caps in every shape: all links have one cap by definition.
    #[cfg(feature = "tubes")]
    pub(crate) fn is_uniform(&self) -> bool {
        self.is_uniform
    }

    /// Returns the tree of bounding capsules over the links, in preorder.
    pub(crate) fn link_tree(&self) -> &[LinkNode] {
        &self.link_tree
    }

    /// Returns an upper bound on the absolute coordinates of all links.
    pub(crate) fn reach(&self) -> Real {
        let within =
            |ends: [Vector; 2], radius| ends[0].abs().max(ends[1].abs()).max_element() + radius;
        match (self.link_tree.first(), self.links.first()) {
            (Some(LinkNode::Inner { bound, .. }), _) => {
                within([bound.start, bound.end], bound.radius)
            }
            (_, Some(link)) => within([link.start(), link.end()], link.radius()),
            _ => 0.0,
        }
    }

    /// Returns the arc length from the base to the start of a link.
    pub(crate) fn length_before(&self, link: usize) -> Real {
        self.lengths_before.get(link).copied().unwrap_or_default()
    }

    /// Returns the chain of the links' images, or `None` if a link has no image.
    pub(crate) fn try_map(
        &self,
        image: impl Fn(&ModifiedCylinder) -> Option<ModifiedCylinder>,
    ) -> Option<Self> {
        let links = self.links.iter().map(image).collect::<Option<Vec<_>>>()?;
        Some(Self::of(links, self.segments.clone(), self.first_segment))
    }

    pub(super) fn of(
        links: Vec<ModifiedCylinder>,
        segments: Vec<Range<usize>>,
        first_segment: usize,
    ) -> Self {
        let mut chain = Self { links, segments, first_segment, ..Self::empty() };
        chain.follow_links();
        chain
    }

    /// A chain without links, to be filled by a constructor.
    fn empty() -> Self {
        Self {
            links: Vec::new(),
            segments: Vec::new(),
            first_segment: 0,
            link_tree: Vec::new(),
            lengths_before: Vec::new(),
            bvh: OnceLock::new(),
            caps: Vec::new(),
            is_uniform: false,
        }
    }

    fn uniform(points: &[Vector], segment_radii: &[Real], cap: Cap) -> Result<Self, RobotError> {
        check_segments(points, segment_radii)?;
        let caps = vec![[cap; 2]; segment_radii.len()];
        let mut chain = Self { caps, is_uniform: true, ..Self::empty() };
        chain.assemble(points, segment_radii, "segment_radii")?;
        Ok(chain)
    }

    /// Makes a link of each segment that has a length.
    ///
    /// `radii` and `self.caps` are per segment; `parameter` names the radii in errors.
    fn assemble(
        &mut self,
        points: &[Vector],
        radii: &[Real],
        parameter: &'static str,
    ) -> Result<(), RobotError> {
        let has_length = |&k: &usize| has_direction(points[k], points[k + 1], radii[k]);
        let Some(last) = (0..radii.len()).rfind(has_length) else {
            return Err(without_length(points, radii, parameter));
        };
        self.links.clear();
        self.segments.clear();
        for k in (0..radii.len()).filter(has_length) {
            // The robot's two ends take the caps of the first and the last segment, which may have
            // no length: at radius 0, Algorithm 1 may make a repeated end point round.
            let caps = [
                self.caps[if self.links.is_empty() { 0 } else { k }][0],
                self.caps[if k == last { radii.len() - 1 } else { k }][1],
            ];
            if let Some(segments) = self.segments.last_mut() {
                segments.end = k;
            } else {
                self.first_segment = k;
            }
            self.segments.push(if self.links.is_empty() { 0 } else { k }..radii.len());
            self.links.push(ModifiedCylinder::unchecked(points[k], points[k + 1], radii[k], caps));
        }
        self.follow_links();
        Ok(())
    }

    /// Recomputes everything derived from the links.
    fn follow_links(&mut self) {
        link_tree::build(&self.links, &mut self.link_tree);
        self.lengths_before.clear();
        let mut length = 0.0;
        self.lengths_before.extend(self.links.iter().map(|link| {
            let before = length;
            length += link.length();
            before
        }));
        self.bvh = OnceLock::new();
    }
}

/// Compares links and segments, which are the robot's shape. The caps may be equal by different
/// rules; all other fields follow from links and segments.
impl PartialEq for Chain {
    fn eq(&self, other: &Self) -> bool {
        self.links == other.links
            && self.segments == other.segments
            && self.first_segment == other.first_segment
    }
}

/// The error for a centreline in which no segment has a length.
pub(crate) fn without_length(
    points: &[Vector],
    radii: &[Real],
    parameter: &'static str,
) -> RobotError {
    match (0..radii.len()).find(|&k| points[k] != points[k + 1]) {
        Some(index) => {
            let length = super::scale::length(points[index + 1] - points[index]);
            RobotError::HidesLength { parameter, index, value: radii[index], length }
        }
        None => RobotError::AllPointsEqual,
    }
}

/// Returns one radius per segment.
pub(crate) fn radius_for_all(points: &[Vector], radius: Real) -> Result<Vec<Real>, RobotError> {
    check_radii("radius", &[radius])?;
    Ok(vec![radius; points.len().saturating_sub(1)])
}

/// [`check`] of the parameters `points` and `segment_radii`.
pub(crate) fn check_segments(points: &[Vector], segment_radii: &[Real]) -> Result<(), RobotError> {
    check_chain(["points", "segment_radii"], points, segment_radii, points.len().saturating_sub(1))
}

/// Checks the number of points and radii, and the range of both. `names` are the two parameters.
pub(crate) fn check_chain(
    names: [&'static str; 2],
    points: &[Vector],
    radii: &[Real],
    expected: usize,
) -> Result<(), RobotError> {
    if points.len() < 2 {
        return Err(RobotError::TooFewPoints { parameter: names[0], count: points.len() });
    }
    if radii.len() != expected {
        let (points, radii) = (points.len(), radii.len());
        return Err(RobotError::LengthsDiffer { parameter: names[1], points, expected, radii });
    }
    check_points(names[0], points)?;
    check_radii(names[1], radii)
}
