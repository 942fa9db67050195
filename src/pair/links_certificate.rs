//! Certificates of two links: proven bounds on their distance, in double-double arithmetic.
//!
//! `certificate.rs` has the two bounds, and why they hold.
//!
//! # Definitions
//! - `n`: a unit direction; the lower bound is the separation of the links by planes across it.
//! - `w = p2 - p1`: the shortest vector between the links. `d = |w|`.
//!
//! # Choice of direction
//! If `d > 0`, `n = w / d` makes both bounds equal. If the shortest vector ends on a smooth part of
//! a link, `n` is the normal there. The boundary of a link has five kinds of places, and each
//! constrains `n`:
//!
//! | place | constraint on `n` |
//! |---|---|
//! | a flat face, without its rim | along the axis `a` |
//! | the barrel | perpendicular to `a` |
//! | a flat cap's rim | perpendicular to the tangent `a x (p - c)`, with the cap's centre `c` |
//! | a round cap | along `p - c`, with the axis' end `c` |
//! | a wire or its end, of radius 0 | as barrel or cap, with `p` on the axis |
//!
//! A face alone determines `n`, and so do two round caps. Otherwise two constraints do:
//!
//! - a barrel or a rim and a barrel or a rim: `n` is along the cross product of the two directions
//!   that it is perpendicular to;
//! - a round cap and a barrel: from the end `c`, across the other link's axis;
//! - a round cap and a rim: from `c` to the rim's point, which is at least the cap's radius away;
//! - parallel barrels, a rim and the barrel of its own tangent, and other pairs whose cross product
//!   vanishes: from a point of one across the axis of the other.
//!
//! **Rounding.** None of these directions is a difference of points that nearly touch, unless the
//! radius is small too. Each errs by about 2^-100, as its features do, for every `d`. The
//! difference `w` of numbers that err by `e = 2^-100` errs by `e / d` in direction, which costs `e
//! / d` of the extent. So `w` is tried first, and the features only if `w` leaves the bounds more
//! than 4 u of the extent apart. The best lower bound is returned. A direction that does not apply
//! costs only time.
//!
//! # Links in contact
//! If the links meet, the lower bound is 0. The upper bound is how far the common point lies
//! outside of both links, by rounding.

use super::certificate::{CertifiedLink, ExactFrame, ExactLink, ExactPoint, Number, tightened};
use super::placed_link::PlacedLink;
use crate::answer::{Certificate, ProximityError, RobotProximity};
use crate::distance::{Link, Scalar, TwoLinks, Vec3, single};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::Pose;

/// The names of the poses in errors.
const POSES: [&str; 2] = ["pose_a", "pose_b"];

impl Certificate {
    /// Returns proven bounds on the distance between two links at their poses.
    ///
    /// - `a`, `b`: the links, each in its robot's frame.
    /// - `pose_a`, `pose_b`: the poses of the robots in one common frame.
    ///
    /// ```
    /// use parry_continuum::{ModifiedCylinder, proximity::Certificate};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, 0.5)?;
    /// let proof = Certificate::between_links(
    ///     &link,
    ///     &Pose::IDENTITY,
    ///     &link,
    ///     &Pose::translation(3.0, 0.0, 0.0),
    /// )?;
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
    /// Returns proven bounds on the distance between this answer's links, rounding included.
    ///
    /// `upper` also holds for the two robots. `lower` holds for these two links alone: for the
    /// robots take the least over all pairs of links ([`Certificate::between_links`]). The bounds
    /// lie within a few units in the last place of the problem's extent. Links that overlap have
    /// `lower` 0. The bounds do not depend on any engine or earlier query.
    ///
    /// - `a`, `b`, `pose_a`, `pose_b`: the robots and poses of the query.
    /// - For an answer about one robot and itself, pass the robot twice, at the identity.
    ///
    /// An answer about a flat or round end of a link is refused if the whole link is nearer than
    /// this end: its distance is not the distance of the links.
    ///
    /// # Errors
    /// - A robot does not have the answer's link.
    /// - A pose is not finite or not rigid, or moves the link out of range.
    /// - The answer does not fit the two links: it is about other robots or other poses.
    ///
    /// ```
    /// use parry_continuum::{Chain, proximity::RobotPair};
    /// use parry_continuum::parry::math::{Pose, Vector};
    ///
    /// let robot = Chain::from_centreline(&[Vector::ZERO, Vector::Z * 40.0], &[0.7])?;
    /// let (here, crossing) =
    ///     (Pose::IDENTITY, Pose::new(Vector::new(3.0, 9.0, 7.0), Vector::X * 0.9));
    /// let closest = RobotPair::new().minimum(&robot, &here, &robot, &crossing)?;
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
        let closest = single::two_links(&pair, &pair.axes());
        let points = [closest.point1, closest.point2];
        let upper = (points[1] - points[0]).norm()
            + first.distance_to(points[0])
            + second.distance_to(points[1]);
        let lower = self.apart((points[1] - points[0]).normalised()).max(Number::ZERO);
        tightened(lower, upper, || self.apart_by_features(points))
    }

    /// Returns the separations by planes whose normals come from features near these points, one
    /// point of each link.
    fn apart_by_features(&self, points: [ExactPoint; 2]) -> impl Iterator<Item = Number> {
        let [first, second] = self.links;
        // The directions that a normal may be perpendicular to: the axis, and the tangents of both
        // rims.
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

/// Returns the separation of two links by a plane with the normal `direction`, from the first to
/// the second.
fn apart([first, second]: [&ExactLink; 2], direction: ExactPoint) -> Number {
    second.lowest(direction) - first.highest(direction)
}

impl ExactLink {
    /// Returns the link relative to its own start, as the narrow phase represents it.
    fn seen_from_start(&self) -> Link<Number> {
        Link { end: self.along, axis: self.axis, radius: self.radius, flat: self.flat }
    }

    /// Returns an upper bound on `<direction, x>` over the link.
    pub(super) fn highest(&self, direction: ExactPoint) -> Number {
        -self.lowest(-direction)
    }
}
