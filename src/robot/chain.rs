//! A robot as a chain of links.

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
/// A chain is the union of its links, and neighbouring links overlap where a round cap reaches into
/// the next link. Seen from outside the union is exact. What depends on the inside, such as the
/// volume or the way out of it, is known only link by link.
///
/// The constructors differ in the caps alone:
///
/// | constructor | caps | the tube is |
/// |---|---|---|
/// | [`from_centreline`](Self::from_centreline) | those that fit (Algorithm 1 of the paper), from one radius per segment | followed: flat ends, filled bends |
/// | [`from_vertex_radii`](Self::from_vertex_radii) | the same by the letter of the paper, from one radius per point | followed |
/// | [`capsules`](Self::capsules) | all round | covered, but reaches one radius too far at its ends |
/// | [`cylinders`](Self::cylinders) | all flat | never exceeded at its ends, but open at the bends |
///
/// Points and radii are in one unit of length and in the robot's frame; all constructors accept
/// magnitudes up to 1e150.
///
/// # Repeated points
/// Planners repeat centreline points. A segment without length has no direction and adds nothing to
/// the robot, so it becomes no link. It is left out only after Algorithm 1 has walked over it:
/// repeating a point changes no link, and a segment without length but with a radius of its own
/// counts as a step there and back. The robot's own two ends stay flat whatever is repeated there.
/// [`segments_of`](Self::segments_of) gives such a segment to the link before it, or to the first
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
    /// The segment that is the first link: those before it have no length.
    first_segment: usize,
    /// Capsules around halves, quarters ... of the links.
    link_tree: Vec<LinkNode>,
    /// How long the links before each one are, together.
    lengths_before: Vec<Real>,
    /// Over the links' boxes, for parry's composite queries; leaf i is link i. Built when first
    /// asked for.
    bvh: OnceLock<Bvh>,
    /// The caps of the input's segments: memory for the next centreline.
    caps: Vec<[Cap; 2]>,
}

impl Chain {
    /// The robot with this centreline, its tubes' radii given segment by segment, with the caps
    /// that fit (Algorithm 1 of the paper).
    ///
    /// The two ends of the robot and the wider side of each step in radius are flat, the joints in
    /// between round where a round cap does not stick out of such a face. Radii that differ by
    /// less than 2^-32 of the first of them are no step, so that a constant may be rounded. A
    /// joint exactly one radius from a face is round.
    ///
    /// # Errors
    /// Fewer than two points, not one radius fewer than points, a coordinate or radius that is not
    /// finite or beyond 1e150, a negative radius, or points that are all equal.
    pub fn from_centreline(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        let mut chain = Self::empty();
        chain.set_centreline(points, segment_radii)?;
        Ok(chain)
    }

    /// The robot with this centreline whose tube has the same radius everywhere:
    /// [`from_centreline`](Self::from_centreline) with one radius for all segments.
    ///
    /// # Errors
    /// Fewer than two points, a coordinate that is not finite or beyond 1e150, a radius that is
    /// negative or not finite, or points that are all equal.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// let rod = Chain::with_constant_radius(&[Vector::ZERO, Vector::Z, Vector::Z + Vector::X], 0.1)?;
    /// assert_eq!(rod.links().len(), 2);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn with_constant_radius(points: &[Vector], radius: Real) -> Result<Self, RobotError> {
        Self::from_centreline(points, &radius_for_all(points, radius)?)
    }

    /// Makes this chain what [`from_centreline`](Self::from_centreline) makes of the arguments, in
    /// the memory that it has: a control loop whose robot keeps its number of points allocates
    /// nothing.
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline). The chain is then what it was before.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// let mut robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z, 2.0 * Vector::Z], &[0.5, 0.5])?;
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
        self.assemble(points, segment_radii, "segment_radii")
    }

    /// The robot with this centreline and one radius per point, capped by Algorithm 1 as the paper
    /// prints it.
    ///
    /// A segment takes the smaller radius of its two points; a start is round where the paper's lB
    /// says so for that point, an end where lF does. Prefer
    /// [`from_centreline`](Self::from_centreline), where a radius belongs to a tube: here the
    /// first joint after a thick tube shorter than its radius is left open, and so are both
    /// sides of a single thick point.
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
        check(["points", "vertex_radii"], points, vertex_radii, points.len())?;
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

    /// The same centreline and radii with a round cap at both ends of each segment.
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline).
    pub fn capsules(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        Self::uniform(points, segment_radii, Cap::Round)
    }

    /// The same centreline and radii with a flat cap at both ends of each segment.
    ///
    /// # Errors
    /// As [`from_centreline`](Self::from_centreline).
    pub fn cylinders(points: &[Vector], segment_radii: &[Real]) -> Result<Self, RobotError> {
        Self::uniform(points, segment_radii, Cap::Flat)
    }

    /// The links, from the base to the tip. There is at least one.
    pub fn links(&self) -> &[ModifiedCylinder] {
        &self.links
    }

    /// The input segments that link number `link` stands for, or an empty range if there is no such
    /// link.
    ///
    /// Segment k joins points k and k + 1. The ranges of all links, in order, cover every segment
    /// once; exactly one segment in each has a length.
    ///
    /// ```
    /// use parry_continuum::{Chain, parry::math::Vector};
    ///
    /// // The second segment has no length.
    /// let robot = Chain::from_centreline(&[0.0, 1.0, 1.0, 2.0].map(|z| Vector::Z * z), &[0.5; 3])?;
    /// assert_eq!((robot.segments_of(0), robot.segments_of(1)), (0..2, 2..3));
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn segments_of(&self, link: usize) -> Range<usize> {
        self.segments.get(link).cloned().unwrap_or_default()
    }

    /// The input segment that link number `link` is: the one of [`segments_of`](Self::segments_of)
    /// that has a length.
    pub(crate) fn segment_of(&self, link: usize) -> usize {
        if link == 0 { self.first_segment } else { self.segments_of(link).start }
    }

    /// The smallest box, with sides along the axes of the robot's frame, that holds all links.
    pub fn local_aabb(&self) -> Aabb {
        let boxes = self.links.iter().map(ModifiedCylinder::local_aabb);
        boxes.reduce(|a, b| a.merged(&b)).unwrap_or_else(Aabb::new_invalid)
    }

    /// The links' bounding volume hierarchy; leaf i is link i.
    pub(crate) fn bvh(&self) -> &Bvh {
        self.bvh.get_or_init(|| {
            let boxes: Vec<_> = self.links.iter().map(ModifiedCylinder::local_aabb).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        })
    }

    /// The links' tree of capsules, in depth-first order.
    pub(crate) fn link_tree(&self) -> &[LinkNode] {
        &self.link_tree
    }

    /// No coordinate of its links is larger.
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

    /// How long the links before a link are, together.
    pub(crate) fn length_before(&self, link: usize) -> Real {
        self.lengths_before.get(link).copied().unwrap_or_default()
    }

    /// The chain whose links are the images of this one's, or nothing if a link has none.
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

    /// What the constructors fill.
    fn empty() -> Self {
        Self {
            links: Vec::new(),
            segments: Vec::new(),
            first_segment: 0,
            link_tree: Vec::new(),
            lengths_before: Vec::new(),
            bvh: OnceLock::new(),
            caps: Vec::new(),
        }
    }

    fn uniform(points: &[Vector], segment_radii: &[Real], cap: Cap) -> Result<Self, RobotError> {
        check_segments(points, segment_radii)?;
        let mut chain = Self { caps: vec![[cap; 2]; segment_radii.len()], ..Self::empty() };
        chain.assemble(points, segment_radii, "segment_radii")?;
        Ok(chain)
    }

    /// Makes links of the segments that have a length; radii and `self.caps` are per segment, and
    /// `parameter` is what the radii came from.
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
            // The walk leaves every end at the same place as a limit flat on its own, except at
            // radius 0.
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

    /// Computes anew what follows from the links.
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

/// Equal links for equal segments. The hierarchy follows from them.
impl PartialEq for Chain {
    fn eq(&self, other: &Self) -> bool {
        self.links == other.links
            && self.segments == other.segments
            && self.first_segment == other.first_segment
    }
}

/// Why none of the segments has a length.
pub(super) fn without_length(
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

/// One radius for each segment.
pub(super) fn radius_for_all(points: &[Vector], radius: Real) -> Result<Vec<Real>, RobotError> {
    check_radii("radius", &[radius])?;
    Ok(vec![radius; points.len().saturating_sub(1)])
}

/// [`check`] of the parameters `points` and `segment_radii`.
pub(super) fn check_segments(points: &[Vector], segment_radii: &[Real]) -> Result<(), RobotError> {
    check(["points", "segment_radii"], points, segment_radii, points.len().saturating_sub(1))
}

/// Enough points, as many radii as they need, and nothing out of range. `names` are those of the
/// two parameters.
pub(super) fn check(
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
