//! The contact manifold of two links.
//!
//! Every point is a pair, one on each link's surface, exactly `dist` apart along the contact's
//! normal:
//!
//! 1. **Barrels along each other**: the ends of either crest that lie over the other's barrel, near
//!    its crest.
//! 2. **A crest over a flat cap**: where the other link's crest comes over the cap's rim and where
//!    it leaves it, as in [`rim`](super::rim).
//! 3. **Two flat caps**: points around their common region, by [`lens`](super::lens).
//! 4. **The closest points**, if no other point is as close: barrels that cross, a round cap.
//!
//! No pair of points is closer along the normal than the contact's distance, which is the gap
//! between the two links along it.

use super::crest::Crest;
use super::feature::{self, SAME_POINT};
use super::lens;
use super::link_pair::LinkPair;
use super::link_triangle_points::{Meeting, POINT_ROUNDING};
use super::{rim, support_points};
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, Shape};

/// The cosine between axes above which barrels lie along each other: 22.5 degrees, as for the edges
/// of parry's polygons. At larger angles they roll on one point, and a second one would come and
/// go.
const ALONG: Real = 0.924;

/// Updates the manifold, if the shapes are two links. Returns whether they are.
///
/// # Errors
/// [`Unsupported`] for numbers out of range.
pub(super) fn update<M, C: Default + Copy>(
    pos12: &Pose,
    (g1, g2): (&dyn Shape, &dyn Shape),
    prediction: Real,
    manifold: &mut ContactManifold<M, C>,
) -> Result<bool, Unsupported> {
    let Some(pair) = LinkPair::of(pos12, g1, g2)? else { return Ok(false) };
    let before = std::mem::take(&mut manifold.points);
    let Some(touch) = pair.touch_within(prediction) else { return Ok(true) };
    let LinkPair { links: [first, second], extent, .. } = pair;
    let normal = touch.normal;
    let mut meeting = LinkLinkMeeting { points: Vec::new(), extent };
    if first.axis().dot(second.axis()).abs() >= ALONG {
        meeting.add_ends(&first, &second, normal, false);
        meeting.add_ends(&second, &first, -normal, true);
    }
    meeting.add_across_cap(&first, &second, normal, false);
    meeting.add_across_cap(&second, &first, -normal, true);
    lens::collect(&first, &second, normal, |on_first, dist, names| {
        meeting.add(on_first, dist, names)
    });
    meeting.add_closest(touch.on_first, touch.dist);
    for LinkLinkPoint { on_first, dist, names } in meeting.points {
        let [point1, point2] = [on_first, on_first + normal * dist].map(|point| pair.place(point));
        let point2 = pos12.inverse_transform_point(point2);
        let contact = TrackedContact::new(point1, point2, names[0], names[1], pair.length(dist));
        manifold.points.push(contact);
    }
    (manifold.local_n1, manifold.local_n2) = (normal, pos12.rotation.inverse() * -normal);
    manifold.match_contacts(&before);
    Ok(true)
}

/// Returns the link relative to `origin`.
fn from(link: &ModifiedCylinder, origin: Vector) -> ModifiedCylinder {
    link.transformed(&Pose::from_translation(-origin))
}

/// Returns the name on the other link of a point over a cap: a corner or an edge of the triangle
/// that represents the other's crest.
///
/// The triangle goes along the crest and back. Both ends may lie over one cap. If one end is on the
/// rim, within rounding, each direction may have one of the crossings, so each has its own name.
fn of_crest(of_triangle: PackedFeatureId) -> PackedFeatureId {
    let is = |corner| of_triangle == PackedFeatureId::vertex(corner);
    if is(0) {
        feature::crest_end(0)
    } else if is(1) || is(2) {
        feature::crest_end(1)
    } else if of_triangle == PackedFeatureId::edge(0) {
        feature::BARREL.into()
    } else {
        PackedFeatureId::edge(feature::BARREL_LINE)
    }
}

struct LinkLinkPoint {
    on_first: Vector,
    dist: Real,
    names: [PackedFeatureId; 2],
}

/// The contact points of two links so far.
struct LinkLinkMeeting {
    points: Vec<LinkLinkPoint>,
    /// The largest coordinate. Points closer together than [`SAME_POINT`] of it count as one: the
    /// nearest.
    extent: Real,
}

impl LinkLinkMeeting {
    /// Case 1: adds the ends of `link`'s crest over the other's barrel. `normal` points out of
    /// `link`.
    fn add_ends(
        &mut self,
        link: &ModifiedCylinder,
        other: &ModifiedCylinder,
        normal: Vector,
        is_second: bool,
    ) {
        let Some(crest) = Crest::of(&from(other, other.start()), -normal) else { return };
        support_points::points(link, normal, |on_link, name| {
            let Some(dist) = crest.near(on_link - other.start()) else { return };
            let names = [name, feature::BARREL.into()];
            if is_second {
                self.add(on_link + normal * dist, dist, [names[1], names[0]]);
            } else {
                self.add(on_link, dist, names);
            }
        });
    }

    /// Case 2: adds the crossings of the other's crest and a flat cap of `link`. `normal` points
    /// out of `link`.
    fn add_across_cap(
        &mut self,
        link: &ModifiedCylinder,
        other: &ModifiedCylinder,
        normal: Vector,
        is_second: bool,
    ) {
        let faces = (0..2).any(|end| support_points::faces_flat(link, normal, end));
        let Some(lateral) = support_points::lateral(other, -normal).filter(|_| faces) else {
            return;
        };
        let [v, w] = [other.start(), other.end()].map(|centre| centre + lateral * other.radius());
        let mut below = Meeting::new(link, [v, w, w], normal, self.extent);
        rim::collect(&mut below);
        for point in below.points {
            let of_other = of_crest(point.of_triangle);
            let names = [point.of_link, of_other];
            if is_second {
                self.add(point.on_link + normal * point.dist, point.dist, [names[1], names[0]]);
            } else {
                self.add(point.on_link, point.dist, names);
            }
        }
    }

    /// Case 4. If other points are almost as close, the nearest of them gets the contact's distance
    /// instead. The rest keep their distances.
    fn add_closest(&mut self, on_first: Vector, dist: Real) {
        let least = self.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        if least > dist + SAME_POINT * self.extent {
            return self.add(on_first, dist, [feature::BARREL.into(); 2]);
        }
        let enough = least.max(dist);
        for point in self.points.iter_mut().filter(|point| point.dist <= enough) {
            point.dist = dist;
        }
    }

    fn add(&mut self, on_first: Vector, dist: Real, names: [PackedFeatureId; 2]) {
        if !(dist.is_finite() && on_first.is_finite()) {
            return;
        }
        let (apart, point) = (SAME_POINT * self.extent, LinkLinkPoint { on_first, dist, names });
        match self.points.iter_mut().find(|point| (point.on_first - on_first).length() <= apart) {
            Some(same) if dist < same.dist - POINT_ROUNDING * self.extent => *same = point,
            Some(_) => {}
            None => self.points.push(point),
        }
    }
}
