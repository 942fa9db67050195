//! The contact manifold of a link and a triangle: points that share the contact's normal.
//!
//! The normal is the contact's own (see [`link_triangle`](super::link_triangle)), passed through
//! the constraints of a mesh. Every point is a pair, one on the link's surface and one on the
//! triangle, exactly `dist` apart along the normal:
//!
//! 1. **The link's [`support_points`](super::support_points)** with the triangle below them.
//! 2. **The triangle's outline** below a flat cap ([`rim`](super::rim)), or across or along the
//!    barrel's crest ([`crest`](super::crest)).
//! 3. **The closest points**, if no other point is as close: a corner against the barrel, an edge
//!    across a cap.
//!
//! Coincident points count as one, the nearest of them, so the least `dist` is the contact's. If it
//! is within the prediction, all points count, so that the host sees what a fast link is about to
//! reach. Tolerances are relative to the link, so the unit of length does not matter. Between calls
//! nothing is stored except the host's data of the points, which are matched by feature.
//!
//! # Constraints
//! Constraints may turn the normal. They never remove the contact:
//!
//! 1. At a *free edge*, which no other triangle shares, nothing is known about the other side. A
//!    link that lies on the face's plane ([`side_of_plane`]) may come from another mesh or height
//!    field that continues the face, and the edge must not stop it: the points are those of the
//!    contact's own normal, each as deep as along it, but the manifold has the face's normal.
//!    While the link is beside the edge, it has no contact until it touches: the face does not
//!    extend below the link, and a contact along the plane would stop the link. Any other link
//!    meets the edge of a thin wall, and the contact keeps its normal.
//! 2. If the constraints reject a normal, it comes *from behind* a one-sided surface. It is passed
//!    through the mirrored constraints, as parry does for a two-sided surface.
//! 3. If a constraint has turned the normal, all points along it may lie beyond the contact, or
//!    there may be none. Then the link's closest point is appended with the contact's distance,
//!    and the point that far along the turned normal. The caller knows the contacts with other
//!    triangles and decides whether they count ([`Met`]).

use super::axial::unit;
use super::link_triangle::{LinkTrianglePair, Local, face_normal};
use super::link_triangle_points::{Meeting, POINT_ROUNDING};
use super::{crest, feature, rim, support_points};
use crate::distance::{Vec3, segment_segment};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, SupportMap};

/// How many times deeper than the overlap a point may be if a constraint has turned the normal; as
/// in parry. A deeper one lies where link and triangle do not meet. The depths of the others are
/// limited when the contacts of the link are known ([`Met::limit_depths`]).
const DEEPER: Real = 5.0;
/// A normal turned by more than this was turned by a constraint, not by rounding.
const TURNED: Real = 1e-9;

/// How far a link may reach beyond a face's plane to lie on it, as a share of half of its
/// thickness: five times the overlap that rapier's solver allows. With more, a rod in a slot would
/// lose the hold of the two edges beside it.
const SUNK: Real = 0.05;
/// The cosine to the face's normal below which a link is beside a face rather than above it.
const BESIDE: Real = std::f64::consts::FRAC_1_SQRT_2;

/// Largest rounding error by which a contact may exceed the prediction within which `contact` finds
/// it, relative to the largest coordinate.
const BEYOND: Real = 16.0 * Real::EPSILON;

/// The constraints of a surface on one of its triangles.
pub(super) struct TriangleRules<'a> {
    pub constraints: (Option<&'a dyn NormalConstraints>, Option<&'a dyn NormalConstraints>),
    /// Returns whether no other triangle shares the edge from this corner to the next.
    pub is_free: &'a dyn Fn(usize) -> bool,
}

/// A contact within the prediction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// The `dist` that `contact` reports for the pair.
    pub dist: Real,
    /// Whether the constraints reject the contact's own normal.
    pub is_from_behind: bool,
    /// Whether the constraints have turned it, with the points; then the last point of the manifold
    /// is the closest.
    pub is_turned: bool,
    /// Whether the link is the first shape.
    pub link_is_first: bool,
}

impl Met {
    /// Limits all depths along a turned normal to `limit`: the way out of a deep overlap may be
    /// much longer along it than the shortest.
    pub fn limit_depths<M, C>(&self, limit: Real, manifold: &mut ContactManifold<M, C>) {
        let (normal1, normal2) = (manifold.local_n1, manifold.local_n2);
        for point in manifold.points.iter_mut().filter(|_| self.is_turned) {
            let less_deep = limit - point.dist;
            if less_deep > 0.0 {
                // The triangle's point follows along the normal, so that the pair stays together.
                if self.link_is_first {
                    point.local_p2 -= normal2 * less_deep;
                } else {
                    point.local_p1 -= normal1 * less_deep;
                }
                point.dist = limit;
            }
        }
    }

    /// Removes the closest points of a contact with a turned normal, and limits all depths to
    /// `limit`.
    pub fn drop_closest<M, C>(&self, limit: Real, manifold: &mut ContactManifold<M, C>) {
        if self.is_turned {
            manifold.points.pop();
        }
        self.limit_depths(limit, manifold);
    }
}

/// Updates the manifold of the pair. Returns the contact, if it is within the prediction and the
/// constraints leave it one.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn update<M, C: Default + Copy>(
    pos12: &Pose,
    pair: &LinkTrianglePair,
    rules: &TriangleRules,
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<Option<Met>, Unsupported> {
    let link_is_first = pair.link_is_first;
    let to_link = |p| if link_is_first { pos12 * p } else { pos12.inverse_transform_point(p) };
    let to_triangle = |p| if link_is_first { pos12.inverse_transform_point(p) } else { pos12 * p };
    let local = Local::new(pair.link, pair.triangle.vertices().map(to_link)).ok_or(Unsupported)?;

    let before = std::mem::take(&mut manifold.points);
    let margin = prediction / local.unit;
    // Find an overlap first, then measure it. Coordinates of the local problem are at most 1.
    let found = local.contact_within(margin.max(0.0) + BEYOND);
    let Some(mut found) = found.filter(|found| found.distance <= margin + BEYOND) else {
        return Ok(None);
    };
    found.distance = found.distance.min(margin);
    let rotation = pos12.rotation;
    let in_order = |normal: Vector| {
        if link_is_first {
            (normal, rotation.inverse() * -normal)
        } else {
            (rotation * -normal, normal)
        }
    };
    let own = in_order(found.normal);
    let mut constrained = constrain(pos12, rules.constraints, own);
    let of_link = |(n1, n2): (Vector, Vector)| {
        let normal = if link_is_first { n1 } else { n2 };
        // A rotation not quite of unit length must not count as a turn.
        unit(normal).unwrap_or(normal)
    };
    let has_turned = |normals| (of_link(normals) - found.normal).length() > TURNED;
    let side = || side_of_plane(&local);
    let has_constraints = rules.constraints.0.is_some() || rules.constraints.1.is_some();
    let is_along = |side: Vector| (side + found.normal).length() > TURNED;
    let is_free = has_constraints
        && (constrained.is_from_behind
            || has_turned(constrained.normals)
            || side().is_some_and(is_along))
        && edges_at(local.triangle, found.on_other).any(rules.is_free);
    if is_free {
        constrained = match side() {
            Some(side) if found.distance > 0.0 && found.normal.dot(-side) < BESIDE => {
                return Ok(None);
            }
            Some(side) => constrain(pos12, rules.constraints, in_order(-side)),
            None => Constrained { normals: own, is_from_behind: false },
        };
    }
    let Constrained { normals, is_from_behind } = constrained;
    let normal = if has_turned(normals) { of_link(normals) } else { found.normal };
    let is_turned = has_turned(normals) && !is_free;

    let along = if is_turned { normal } else { found.normal };
    let mut meeting = Meeting::new(&local.link, local.triangle, along, 1.0);
    rim::collect(&mut meeting);
    support_points::points(&local.link, along, |on_link, name| {
        meeting.add_above_face(on_link, name)
    });
    crest::collect(&mut meeting);
    if !is_turned {
        meeting.add_closest(found.distance, found.on_link);
    }
    let least = DEEPER * found.distance.min(0.0) - feature::SAME_POINT * meeting.size;
    let place = |point: Vector| local.origin + point * local.unit;
    for point in meeting.points.iter().filter(|point| !is_turned || point.dist >= least) {
        manifold.points.push(TrackedContact::flipped(
            place(point.on_link),
            to_triangle(place(point.on_link + normal * point.dist)),
            point.of_link,
            point.of_triangle,
            point.dist * local.unit,
            !link_is_first,
        ));
    }
    let dist = found.distance * local.unit;
    if is_turned {
        manifold.points.push(TrackedContact::flipped(
            place(found.on_link),
            to_triangle(place(found.on_link + normal * found.distance)),
            PackedFeatureId::UNKNOWN,
            PackedFeatureId::UNKNOWN,
            dist,
            !link_is_first,
        ));
    }
    (manifold.local_n1, manifold.local_n2) = normals;
    manifold.match_contacts(&before);
    Ok(Some(Met { dist, is_from_behind, is_turned, link_is_first }))
}

/// A normal after constraints.
struct Constrained {
    /// Out of the first shape and out of the second, each in its frame.
    normals: (Vector, Vector),
    is_from_behind: bool,
}

/// Passes normals through the constraints (2. of the module).
fn constrain(
    pos12: &Pose,
    constraints: (Option<&dyn NormalConstraints>, Option<&dyn NormalConstraints>),
    normals: (Vector, Vector),
) -> Constrained {
    let project = |(mut n1, mut n2): (Vector, Vector)| {
        constraints.project_local_normals(pos12, &mut n1, &mut n2).then_some((n1, n2))
    };
    if let Some(normals) = project(normals) {
        return Constrained { normals, is_from_behind: false };
    }
    let mirrored = project((-normals.0, -normals.1)).map(|(n1, n2)| (-n1, -n2));
    Constrained { normals: mirrored.unwrap_or(normals), is_from_behind: true }
}

/// Returns the normal of the triangle's plane on the link's side, if the link lies on the plane or
/// above it: it reaches beyond the plane by at most [`SUNK`] of half of its thickness.
fn side_of_plane(local: &Local) -> Option<Vector> {
    let face = face_normal(local.triangle)?;
    let height =
        |side: Vector| (local.link.local_support_point_toward(side) - local.triangle[0]).dot(side);
    let (above, below) = (height(face), height(-face));
    let half = (0.5 * (above + below)).min(local.link.radius());
    (above.min(below) <= SUNK * half).then_some(if above >= below { face } else { -face })
}

/// Yields the edges that contain a point of a triangle, within rounding, for coordinates up to 1.
fn edges_at(triangle: [Vector; 3], point: Vector) -> impl Iterator<Item = usize> {
    let is_on = move |edge: &usize| {
        let ends = [triangle[*edge], triangle[(edge + 1) % 3]].map(Vec3::from);
        segment_segment(ends, [Vec3::from(point); 2]).distance <= POINT_ROUNDING
    };
    (0..3).filter(is_on)
}
