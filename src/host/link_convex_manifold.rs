//! The contact manifold of a link and a convex shape without a closed form.
//!
//! The points come from parry's clipping of the polygons that approximate the two surfaces, along
//! the normal of the dispatcher's contact for the pair. A point is as deep as the contact, and no
//! point is deeper: the polygons only approximate round surfaces. (parry's routine runs GJK and
//! EPA again from the state of the last step, and may find a different contact.)
//!
//! The clipping divides by lengths of edges. A shape without height has edges without length, whose
//! points are NaN. They are dropped; the contact's own point remains.

use super::iterated::IteratedPair;
use parry3d_f64::math::Real;
use parry3d_f64::query::{Contact, ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, PolygonalFeature};

/// A polygon point that is at most this much less deep than the contact stands for it. This is
/// 2^-40 of the scaled pair's size: parry's iterations resolve depths no better. Where two faces
/// rest on one another, the contact's own points lie anywhere on both and change with each step.
/// The corners of the polygons stay.
const TIE: Real = 8192.0 / (1_u64 << 40) as Real;

/// Updates the manifold, if both shapes have polygonal features. Returns whether they have.
///
/// `contact` computes their contact, in the pair's unit.
///
/// # Errors
/// [`Unsupported`] if `contact` refuses.
pub(super) fn update<M, C: Default + Copy>(
    pair: &IteratedPair,
    contact: impl FnOnce() -> Result<Option<Contact>, Unsupported>,
    manifold: &mut ContactManifold<M, C>,
) -> Result<bool, Unsupported> {
    let (pos12, unit) = (&pair.pos12, pair.unit);
    let [g1, g2] = pair.shapes();
    let polygons = (g1.as_polygonal_feature_map(), g2.as_polygonal_feature_map());
    let (Some((polygons1, border1)), Some((polygons2, border2))) = polygons else {
        return Ok(false);
    };
    let before = std::mem::take(&mut manifold.points);
    let Some(contact) = contact()? else { return Ok(true) };
    let (normal1, normal2) = (contact.normal1, contact.normal2);
    let (mut feature1, mut feature2) = (PolygonalFeature::default(), PolygonalFeature::default());
    polygons1.local_support_feature_toward(
        normal1,
        contact.point1 - normal1 * border1,
        &mut feature1,
    );
    polygons2.local_support_feature_toward(
        normal2,
        contact.point2 - normal2 * border2,
        &mut feature2,
    );
    let features = (&feature1, &feature2);
    PolygonalFeature::contacts(
        pos12,
        &pos12.inverse(),
        normal1,
        normal2,
        features.0,
        features.1,
        manifold,
        false,
    );
    manifold.points.retain(is_finite);
    for point in &mut manifold.points {
        point.local_p1 += normal1 * border1;
        point.local_p2 += normal2 * border2;
        point.dist = (point.dist - border1 - border2).max(contact.dist);
    }
    let is_tie = |point: &&mut TrackedContact<C>| point.dist <= contact.dist + TIE;
    if let Some(point) = manifold.points.iter_mut().find(is_tie) {
        point.dist = contact.dist;
    } else {
        let [name1, name2] = [PackedFeatureId::UNKNOWN; 2];
        let Contact { point1, point2, dist, .. } = contact;
        manifold.points.push(TrackedContact::new(point1, point2, name1, name2, dist));
    }
    for point in &mut manifold.points {
        point.local_p1 *= unit;
        point.local_p2 *= unit;
        point.dist *= unit;
    }
    (manifold.local_n1, manifold.local_n2) = (normal1, normal2);
    manifold.match_contacts(&before);
    Ok(true)
}

/// Returns whether all numbers of a point are finite.
pub(super) fn is_finite<C>(point: &TrackedContact<C>) -> bool {
    point.local_p1.is_finite() && point.local_p2.is_finite() && point.dist.is_finite()
}
