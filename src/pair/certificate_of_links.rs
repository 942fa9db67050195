//! Proofs of an answer about two links.
//!
//! As for a link and a [triangle](super::certificate), a point of each bounds the distance from
//! above, and a plane between the two from below: for a direction n of unit length, the least <n,
//! x> over the second link minus the largest over the first. Both are true whatever the points and
//! the plane are, so what has to be derived is only that the bounds are close.
//!
//! **Which direction.** Let w = p2 - p1 be the shortest way and d > 0 its length: n = w / d leaves
//! nothing between the bounds. Where the shortest way ends on a smooth part of a link, n is the
//! normal there. The boundary of a link has five kinds of places, and each says something of n:
//!
//! | place | what n is |
//! |---|---|
//! | a flat face, without its rim | along the axis a |
//! | the barrel | perpendicular to a |
//! | a flat cap's rim | perpendicular to the rim's tangent a x (p - c), with c the cap's centre |
//! | a round cap | along p - c, with c the axis' end |
//! | a wire or its end, of radius 0 | as barrel or cap, with p on the axis |
//!
//! Two statements fix n, unless one is of a face or of two round caps, which fixes it alone:
//!
//! - a barrel or a rim and a barrel or a rim: n is along the cross product of the two directions to
//!   which it is perpendicular;
//! - a round cap and a barrel: from the end c, across the other link's axis;
//! - a round cap and a rim: from c to the rim's point, which is at least the cap's radius away;
//! - parallel barrels, a rim and its own tangent's barrel, and other pairs whose cross product
//!   vanishes: from a point of one across the axis of the other.
//!
//! None of these is a difference of points that nearly touch, unless the radius is small too, and
//! none is worse than the features that it is made of: 2^-100 or so, whatever d is. The plain
//! difference w, of numbers that err by e = 2^-100, is off by e / d in direction, which costs e / d
//! of the extent. So it is tried first, because it serves wherever the two are apart, and the
//! features where it leaves the bounds more than 4 u of the extent apart. The best of all is taken:
//! one that does not apply costs time and no more.
//!
//! **Where they meet** the lower bound is 0, and the upper how far the common point is outside of
//! both, as rounded.

use super::exact_link::{CertifiedLink, ExactFrame, ExactLink, ExactPoint, Number, SLACK};
use super::placed_link::PlacedLink;
use crate::answer::{Certificate, ProximityError, RobotProximity};
use crate::distance::{Scalar, TwoLinks, Vec3};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::Pose;

/// What the poses are called.
const POSES: [&str; 2] = ["pose_a", "pose_b"];

impl Certificate {
    /// Bounds on the distance between two links at their poses.
    ///
    /// ```
    /// use parry_continuum::{ModifiedCylinder, proximity::Certificate};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, 0.5)?;
    /// let proof = Certificate::between_links(&link, &Pose::IDENTITY, &link, &Pose::translation(3.0, 0.0, 0.0))?;
    /// assert!(proof.lower <= 2.0 && 2.0 <= proof.upper && proof.upper - proof.lower < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A pose is not finite or not rigid, or moves its link out of range.
    pub fn between_links(
        a: &ModifiedCylinder,
        pose_a: &Pose,
        b: &ModifiedCylinder,
        pose_b: &Pose,
    ) -> Result<Self, ProximityError> {
        let placed = |k: usize| {
            CertifiedLink::new([a, b][k], [pose_a, pose_b][k], 0)
                .map_err(|error| error.of_robot(POSES[k]))
        };
        Ok(bounds(&[placed(0)?, placed(1)?]))
    }
}

impl RobotProximity {
    /// Bounds on the distance between this answer's links, which hold rigorously, rounding
    /// included. `upper` holds for the two robots too, `lower` for these two links alone: for
    /// the robots take the least of all pairs of links ([`Certificate::between_links`]).
    ///
    /// They lie within a few units in the last place of the problem's extent of each other; links
    /// that overlap have `lower` 0. No engine is trusted, and nothing is remembered. Give the
    /// same robots and poses as to the query. An answer about one robot and itself takes the
    /// robot twice, at the identity; where it is about an end of a link, flat or round, to which
    /// the whole link is nearer than its end, it is not that of the links and is refused.
    ///
    /// # Errors
    /// A robot does not have the answer's link, a pose is not finite or not rigid or moves the link
    /// out of range, or the answer does not fit the two links: it is about other robots or
    /// other poses.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::between};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[0.7])?;
    /// let (here, crossing) = (Pose::IDENTITY, Pose::new(Vector::new(3.0, 9.0, 7.0), Vector::X * 0.9));
    /// let closest = between(&robot, &here, &robot, &crossing)?;
    /// let proof = closest.certify(&robot, &here, &robot, &crossing)?;
    /// assert!(proof.upper - proof.lower < 1e-13);
    /// assert!((closest.distance - proof.lower).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn certify(
        &self,
        a: &Chain,
        pose_a: &Pose,
        b: &Chain,
        pose_b: &Pose,
    ) -> Result<Certificate, ProximityError> {
        let placed = |k: usize| {
            let (link, links) = (self.links[k] as usize, [a, b][k].links());
            let place =
                links.get(link).ok_or(ProximityError::NoSuchLink { link, links: links.len() })?;
            CertifiedLink::new(place, [pose_a, pose_b][k], link)
                .map_err(|error| error.of_robot(POSES[k]))
        };
        let links = [placed(0)?, placed(1)?];
        self.check_answer([&links[0], &links[1]].map(CertifiedLink::placed))?;
        Ok(bounds(&links))
    }
}

impl CertifiedLink {
    fn placed(&self) -> PlacedLink {
        PlacedLink::between(self.start, self.end, self.radius, self.flat)
    }
}

fn bounds(links: &[CertifiedLink; 2]) -> Certificate {
    let [first, second] = links;
    let radius = first.radius.max(second.radius);
    let Some(frame) =
        ExactFrame::around(first.start, [first.end, second.start, second.end], radius)
    else {
        return Certificate { lower: 0.0, upper: 0.0 }; // one point
    };
    let pair = ExactLinkPair { links: links.each_ref().map(|link| link.exact(&frame)) };
    let (lower, upper) = pair.bounds();
    frame.certificate(lower, upper)
}

struct ExactLinkPair {
    links: [ExactLink; 2],
}

impl ExactLinkPair {
    fn bounds(&self) -> (Number, Number) {
        let [first, second] = &self.links;
        let pair = TwoLinks {
            first: first.seen_from_start(),
            second: second.seen_from_start(),
            second_start: second.start,
        };
        let closest = pair.closest(&pair.axes(), |mask| mask);
        let points = [closest.point1, closest.point2];
        let upper = (points[1] - points[0]).norm()
            + first.distance_to(points[0])
            + second.distance_to(points[1]);
        let lower = self.apart((points[1] - points[0]).normalised()).max(Number::ZERO);
        let is_tight = (upper - lower).le((2.0 * f64::EPSILON).into());
        let lower =
            if is_tight { lower } else { self.apart_by_features(points).fold(lower, Scalar::max) };
        (lower - SLACK.into(), upper + SLACK.into())
    }

    /// How far the planes keep the links apart whose normals are those of features near these
    /// points, each of its link.
    fn apart_by_features(&self, points: [ExactPoint; 2]) -> impl Iterator<Item = Number> {
        let [first, second] = self.links;
        // What a normal may be perpendicular to: the axis, and the tangents of both rims.
        let tangents = [(first, points[0]), (second, points[1])].map(|(link, point)| {
            let around = |centre: ExactPoint| link.axis.cross(point - centre).normalised();
            [link.axis, around(link.start), around(link.end())]
        });
        let places = [(first, points[0]), (second, points[1])]
            .map(|(link, point)| [link.start, link.end(), point]);
        let across = move |way: ExactPoint, from: ExactPoint| way - from * from.dot(way);
        let crossed =
            tangents[0].into_iter().flat_map(move |one| tangents[1].map(|other| one.cross(other)));
        let ways = places[0].into_iter().flat_map(move |from| places[1].map(|to| to - from));
        let of_places = ways.flat_map(move |way| {
            let [[axis1, start1, end1], [axis2, start2, end2]] = tangents;
            [way, across(way, axis1), across(way, axis2)]
                .into_iter()
                .chain([start1, end1, start2, end2].map(|tangent| across(way, tangent)))
        });
        let all = [first.axis, second.axis]
            .into_iter()
            .chain(crossed)
            .chain(of_places)
            .map(Vec3::normalised);
        all.flat_map(move |direction| {
            [direction, -direction].map(|it| apart([&first, &second], it))
        })
    }

    fn apart(&self, direction: ExactPoint) -> Number {
        let [first, second] = &self.links;
        apart([first, second], direction)
    }
}

/// How far the plane with the normal `direction`, from the first to the second, keeps two links
/// apart.
fn apart([first, second]: [&ExactLink; 2], direction: ExactPoint) -> Number {
    second.lowest(direction) - first.highest(direction)
}
