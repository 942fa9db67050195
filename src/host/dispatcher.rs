//! The query dispatcher for parry and rapier.
//!
//! # Algorithm
//! 1. **Thin shapes.** Replace the other shape of a robot by a triangle if it degenerates to one
//!    ([`ThinShape`]).
//! 2. **Classify** the pair ([`ShapePair::of`]): the first row that fits says which file answers.
//!
//! | | pair | answered by |
//! |---|---|---|
//! | a | a robot and a triangle or a mesh | [`RobotSurface`] |
//! | b | a robot and a half-space | [`RobotHalfSpace`] |
//! | c | a shape with parts, and any other | each part, by this dispatcher ([`Decomposition`]) |
//! | d | two links; or a link and one of parry's shapes that is a link | [`LinkPair`] |
//! | e | any other pair | the inner dispatcher, in the unit of [`IteratedPair`] |
//!
//! In e [`ConvexPair`] checks the answers about a link, and has fallbacks.
//!
//! The two casts classify for themselves: for links against triangles, links and convex shapes they
//! use [`straight_cast`] and [`link_cast`] instead of distances. Contact manifolds have a file of
//! their own (`manifold.rs`).

use super::composite::CompositePair;
use super::convex::{ConvexPair, is_sound};
use super::decomposition::{Decomposition, has_parts};
use super::height_field::HeightFieldPair;
use super::iterated::IteratedPair;
use super::link_cast::StartContact;
use super::link_pair::LinkPair;
use super::link_triangle::LinkTrianglePair;
use super::nonlinear_cast::{self, MovingShape};
use super::range::{self, check_margin, check_pose, in_range};
use super::robot_halfspace::RobotHalfSpace;
use super::robot_surface::{RobotSurface, links_of};
use super::straight_cast;
use super::strict_dispatcher::StrictDispatcher;
use super::thin_shape::ThinShape;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher,
    ShapeCastHit, ShapeCastOptions, ShapeDistance, ShapeIntersection, Unsupported, details,
};
use parry3d_f64::shape::Shape;

/// Answers parry's queries for links and chains, and passes all other pairs to `L`.
///
/// It is a *root* dispatcher: give it to parry or rapier as it is, and put a dispatcher of your own
/// inside, as `L`. It must not stand at the end of a chain of dispatchers, because parry's own
/// dispatcher never passes the parts of a composite shape on to the others.
///
/// Answers for a link or a chain against another shape, in either order:
///
/// | | `Triangle`, `Segment`, `TriMesh`, `Polyline`, `HeightField` | `HalfSpace` | link, chain, `Ball`, `Capsule`, `Cylinder` | other convex shape |
/// |---|---|---|---|---|
/// | `distance`, `closest_points` | exact | exact | exact | parry's GJK: within 1e-5 |
/// | `intersection_test` | exact | exact | exact | parry's GJK |
/// | `contact`, apart | exact | exact | exact | parry's GJK: within 1e-5 |
/// | `contact`, overlapping | exact: the shortest translation that separates link and triangle | exact | separates, up to rounding; exact for round links and balls; otherwise nearly the shortest translation, see below | separates, up to rounding; nearly the shortest translation, see below |
/// | `cast_shapes` | never late; early by at most 1e-9 of the link's size | exact | never late; early by at most 1e-9 of the smaller link's size | never late, except for errors of GJK; early by 1e-5 |
/// | `cast_shapes_nonlinear` | never late | never late | never late | never late, except for errors of GJK |
/// | contact manifolds | exact points along the contact's normal, which obeys a mesh's normal constraints | exact points | exact points along the contact's normal | the contact's own points, and points of polygons that approximate the surfaces along its normal |
///
/// Errors are for shapes of size one, and relative to the size for others: a pair of the last
/// column is scaled by a power of two before `L` answers, because parry's tolerances are absolute.
/// `tests/host/pairs.rs` and `tests/host/depths.rs` enforce these numbers. In the last column, a
/// shape smaller than 2^-40 of the other shape, or of the distance between them, is refused.
///
/// **Shortest translation.** The translation that separates a link from another convex shape may
/// exceed the shortest one that a search of all directions finds, by at most
///
/// - 1e-12 for a round link against a round link or a `Capsule`;
/// - 1e-6 for other links, and for a `Cylinder`, a `Cuboid`, a `ConvexPolyhedron` and a
///   `RoundCuboid`;
/// - 0.01 for a `Cone` and a `RoundCylinder`.
///
/// **Links among parry's shapes.** A `Ball` is a link of length 0, a `Capsule` a link with two
/// round caps, a `Cylinder` a link with two flat caps. A `Cylinder` without height is not a link
/// and stays in the last column. Another shape that is only a line, such as a cone of radius 0,
/// counts as a segment.
///
/// **Distances** are to the triangles themselves and unsigned: 0 for a link that touches or crosses
/// a triangle. Touching is `Intersecting`. A distance equal to a margin is within the margin.
///
/// **Predictions.** Nothing farther away than the prediction is returned. A negative prediction
/// asks for an overlap at least that deep. For a manifold, its nearest point counts.
///
/// **Manifolds.** The least `dist` of a pair's manifolds is the `dist` of `contact`. The flags of a
/// mesh or a height field that fix internal edges may turn a normal, but remove no overlap. An edge
/// without a neighbour constrains nothing, except for a link that lies on the plane of the face:
/// it slides over the edge as over a seam of two meshes. A one-sided surface holds from behind as
/// well, unless its front is touched at least as deep.
///
/// **Nonlinear casts** that do not stop at the start ignore contacts at the start until the link's
/// core would meet the other shape. At that time half of the depth that keeps the link from passing
/// through is left.
///
/// **Composite shapes** (`Compound`, `TriMesh`, `Polyline`, `HeightField`,
/// [`Chain`](crate::Chain)) are split by this dispatcher at each level. `L` sees only pairs that
/// cannot be split. The sub-shape ids of an answer name the link, the triangle or the part of each
/// side.
///
/// # Errors
/// [`Unsupported`] if any pair within the query is unsupported, so that such a pair never looks
/// free. Also if
///
/// - a pose, a velocity or a visited triangle is not finite or beyond 1e150;
/// - a rotation is not of unit length, or a margin is NaN;
/// - a height field has a negative scale;
/// - a link meets `Voxels`: parry's routines for them depend on the unit of length.
///
/// ```
/// use parry_continuum::{ContinuumDispatcher, ModifiedCylinder};
/// use parry_continuum::parry::{math::{Pose, Vector}, query::QueryDispatcher, shape::Triangle};
///
/// let link = ModifiedCylinder::cylinder(Vector::ZERO, Vector::Z, 0.5)?;
/// let wall = Triangle::new(
///     Vector::new(2.0, -9.0, -9.0),
///     Vector::new(2.0, 9.0, -9.0),
///     Vector::new(2.0, 0.0, 9.0),
/// );
/// let apart = ContinuumDispatcher::default().distance(&Pose::IDENTITY, &link, &wall)?;
/// assert_eq!(apart.distance, 1.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContinuumDispatcher<L = DefaultQueryDispatcher>(pub L);

/// Has parry's own dispatcher inside.
impl Default for ContinuumDispatcher {
    fn default() -> Self {
        Self(DefaultQueryDispatcher)
    }
}

impl<L: QueryDispatcher> QueryDispatcher for ContinuumDispatcher<L> {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        check_pose(pos12)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        let pair = ShapePair::of(pos12, g1, g2)?;
        // A ball uses the point query, as in parry: an oriented mesh is solid to it.
        if let (Some(ball), true) = (g1.as_ball(), has_parts(g2)) {
            return Ok(details::intersection_test_ball_point_query(pos12, ball, g2));
        }
        if let (true, Some(ball)) = (has_parts(g1), g2.as_ball()) {
            return Ok(details::intersection_test_point_query_ball(pos12, g1, ball));
        }
        match pair {
            ShapePair::Surface(pair) => pair.intersection_test(),
            ShapePair::HalfSpace(pair) => pair.intersection_test(),
            ShapePair::Parts(Decomposition::Composite(parts)) => {
                CompositePair { dispatcher: self, parts, pos12, other: g2 }.intersection_test()
            }
            ShapePair::Parts(Decomposition::Field(field)) => {
                HeightFieldPair { dispatcher: self, field, pos12, other: g2 }.intersection_test()
            }
            ShapePair::Parts(Decomposition::OfSecond) => {
                self.intersection_test(&pos12.inverse(), g2, g1).map(ShapeIntersection::swapped)
            }
            ShapePair::Links(links) => Ok(ShapeIntersection::new(links.distance() <= 0.0)),
            ShapePair::Iterated(pair) => {
                let [g1, g2] = pair.shapes();
                self.0.intersection_test(&pair.pos12, g1, g2)
            }
        }
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        check_pose(pos12)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        match ShapePair::of(pos12, g1, g2)? {
            ShapePair::Surface(pair) => pair.distance(),
            ShapePair::HalfSpace(pair) => pair.distance(),
            ShapePair::Parts(Decomposition::Composite(parts)) => {
                let answer = StrictDispatcher::ask(self, |watched| {
                    details::distance_composite_shape_shape(watched, pos12, parts, g2)
                })?;
                // parry returns `Real::MAX` if no part was near enough.
                if answer.distance < Real::MAX { Ok(answer) } else { Err(Unsupported) }
            }
            ShapePair::Parts(Decomposition::Field(field)) => {
                HeightFieldPair { dispatcher: self, field, pos12, other: g2 }.distance()
            }
            ShapePair::Parts(Decomposition::OfSecond) => {
                self.distance(&pos12.inverse(), g2, g1).map(ShapeDistance::swapped)
            }
            ShapePair::Links(links) => Ok(ShapeDistance::new(links.distance())),
            ShapePair::Iterated(pair) => {
                let [g1, g2] = pair.shapes();
                let answer = match ConvexPair::of(&self.0, &pair.pos12, g1, g2) {
                    Some(convex) => ShapeDistance::new(convex.distance()?),
                    None => self.0.distance(&pair.pos12, g1, g2)?,
                };
                check_margin(answer.distance)?;
                Ok(ShapeDistance { distance: answer.distance * pair.unit, ..answer })
            }
        }
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        check_pose(pos12)?;
        check_margin(prediction)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        match ShapePair::of(pos12, g1, g2)? {
            ShapePair::Surface(pair) => pair.contact(prediction),
            ShapePair::HalfSpace(pair) => pair.contact(prediction),
            ShapePair::Parts(Decomposition::Composite(parts)) => {
                CompositePair { dispatcher: self, parts, pos12, other: g2 }.contact(prediction)
            }
            ShapePair::Parts(Decomposition::Field(field)) => {
                HeightFieldPair { dispatcher: self, field, pos12, other: g2 }.contact(prediction)
            }
            ShapePair::Parts(Decomposition::OfSecond) => {
                let contact = self.contact(&pos12.inverse(), g2, g1, prediction)?;
                Ok(contact.map(Contact::flipped))
            }
            ShapePair::Links(links) => within(prediction, links.contact(pos12, prediction)),
            ShapePair::Iterated(pair) => {
                let contact = self.contact_of_iterated(&pair, pair.length(prediction))?;
                within(prediction, contact.map(|contact| pair.restore(contact)))
            }
        }
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        check_pose(pos12)?;
        check_margin(max_dist)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        match ShapePair::of(pos12, g1, g2)? {
            ShapePair::Surface(pair) => pair.closest_points(max_dist),
            ShapePair::HalfSpace(pair) => pair.closest_points(max_dist),
            ShapePair::Parts(Decomposition::Composite(parts)) => {
                CompositePair { dispatcher: self, parts, pos12, other: g2 }.closest_points(max_dist)
            }
            ShapePair::Parts(Decomposition::Field(field)) => {
                HeightFieldPair { dispatcher: self, field, pos12, other: g2 }
                    .closest_points(max_dist)
            }
            ShapePair::Parts(Decomposition::OfSecond) => self
                .closest_points(&pos12.inverse(), g2, g1, max_dist)
                .map(|points| points.flipped()),
            ShapePair::Links(links) => Ok(links.closest_points(pos12, max_dist)),
            ShapePair::Iterated(pair) => {
                let ([g1, g2], max_dist) = (pair.shapes(), pair.length(max_dist));
                let points = match ConvexPair::of(&self.0, &pair.pos12, g1, g2) {
                    Some(convex) => convex.closest_points(max_dist)?,
                    None => self.0.closest_points(&pair.pos12, g1, g2, max_dist.max(0.0))?,
                };
                Ok(pair.restore_points(points))
            }
        }
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        check_pose(pos12)?;
        check_margin(options.max_time_of_impact)?;
        check_margin(options.target_distance)?;
        in_range(local_vel12)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        if let Some(pair) = RobotHalfSpace::of(pos12, g1, g2)? {
            return pair.cast_shapes(local_vel12, options);
        }
        match Decomposition::of(g1, g2)? {
            Some(Decomposition::Composite(parts)) => {
                CompositePair { dispatcher: self, parts, pos12, other: g2 }
                    .cast_shapes(local_vel12, options)
            }
            Some(Decomposition::Field(field)) => {
                HeightFieldPair { dispatcher: self, field, pos12, other: g2 }
                    .cast_shapes(local_vel12, options)
            }
            Some(Decomposition::OfSecond) => {
                let local_vel21 = -(pos12.rotation.inverse() * local_vel12);
                let hit = self.cast_shapes(&pos12.inverse(), local_vel21, g2, g1, options)?;
                Ok(hit.map(ShapeCastHit::swapped))
            }
            None => {
                if let Some(pair) = LinkTrianglePair::of(g1, g2)? {
                    return straight_cast::cast_triangle(&pair, pos12, local_vel12, options);
                }
                if let Some(hit) = straight_cast::cast_link(pos12, local_vel12, (g1, g2), options)?
                {
                    return Ok(hit);
                }
                if let Some(hit) =
                    straight_cast::cast_convex(self, pos12, local_vel12, (g1, g2), options)?
                {
                    return Ok(hit);
                }
                let hit =
                    self.inner(pos12, g1, g2)?.cast_shapes(pos12, local_vel12, g1, g2, options)?;
                check_margin(hit.map_or(0.0, |hit| hit.time_of_impact)).map(|()| hit)
            }
        }
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let sides = [
            MovingShape { motion: motion1, shape: g1 },
            MovingShape { motion: motion2, shape: g2 },
        ];
        let times = (start_time, end_time);
        let start = if stop_at_penetration { StartContact::Stops } else { StartContact::Core };
        nonlinear_cast::cast((self, &self.0), sides, times, start)
    }
}

impl<L: QueryDispatcher> ContinuumDispatcher<L> {
    /// Returns the contact of a pair for the inner dispatcher, in the pair's unit.
    pub(super) fn contact_of_iterated(
        &self,
        pair: &IteratedPair,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let [g1, g2] = pair.shapes();
        match ConvexPair::of(&self.0, &pair.pos12, g1, g2) {
            Some(convex) => {
                Ok(convex.contact(prediction)?.map(|contact| convex.shallowest(contact)))
            }
            None => self.0.contact(&pair.pos12, g1, g2, prediction),
        }
    }
}

impl<L> ContinuumDispatcher<L> {
    /// Returns the inner dispatcher for a pair that is neither split nor answered here.
    ///
    /// # Errors
    /// [`Unsupported`] for a link beyond the range of parry's iterations, where they panic or
    /// return NaN.
    pub(super) fn inner(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<&L, Unsupported> {
        let is_robot = links_of(g1).or(links_of(g2)).is_some();
        if is_robot && !range::is_iterated(pos12, g1, g2) { Err(Unsupported) } else { Ok(&self.0) }
    }
}

/// The kind of a pair of shapes, with the data of the algorithm that answers it. The rows of the
/// table in the head of this file.
enum ShapePair<'a> {
    /// a: a robot and a triangle or a mesh.
    Surface(RobotSurface<'a>),
    /// b: a robot and a half-space.
    HalfSpace(RobotHalfSpace<'a>),
    /// c: a shape with parts.
    Parts(Decomposition<'a>),
    /// d: two links.
    Links(LinkPair),
    /// e: a pair for the inner dispatcher.
    Iterated(IteratedPair<'a>),
}

impl<'a> ShapePair<'a> {
    /// Classifies a pair, after [`ThinShape`].
    ///
    /// # Errors
    /// [`Unsupported`] for a shape or a placement that the algorithm of its kind refuses.
    fn of(pos12: &'a Pose, g1: &'a dyn Shape, g2: &'a dyn Shape) -> Result<Self, Unsupported> {
        Ok(if let Some(pair) = RobotSurface::of(pos12, g1, g2) {
            Self::Surface(pair)
        } else if let Some(pair) = RobotHalfSpace::of(pos12, g1, g2)? {
            Self::HalfSpace(pair)
        } else if let Some(parts) = Decomposition::of(g1, g2)? {
            Self::Parts(parts)
        } else if let Some(pair) = LinkPair::of(pos12, g1, g2)? {
            Self::Links(pair)
        } else {
            Self::Iterated(IteratedPair::of(pos12, g1, g2)?)
        })
    }
}

/// Returns the contact if it is within the prediction.
///
/// # Errors
/// [`Unsupported`] for a contact with numbers that are not finite, or without a direction.
fn within(prediction: Real, contact: Option<Contact>) -> Result<Option<Contact>, Unsupported> {
    if contact.is_some_and(|contact| !is_sound(&contact)) {
        return Err(Unsupported);
    }
    Ok(contact.filter(|contact| contact.dist <= prediction))
}
