//! Links at the free edge of a thin wall that stands edge-on below them: the near edge counts, not the far one, which lies
//! over the same point of the link.

use crate::draw::CAPS;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{ContactManifold, PersistentQueryDispatcher, QueryDispatcher};
use parry_continuum::parry::shape::{Shape, TriMesh, Triangle};
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

/// What `contact` says, and the least `dist` of the manifolds.
fn contact_and_manifold(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real) -> [Real; 2] {
    let dispatcher = ContinuumDispatcher::default();
    let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
    dispatcher.contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut workspace).unwrap();
    let points = manifolds.iter().flat_map(|manifold| &manifold.points);
    let least = points.map(|point| point.dist).fold(Real::INFINITY, Real::min);
    let contact = dispatcher.contact(pos12, g1, g2, prediction).unwrap();
    [contact.map_or(Real::INFINITY, |contact| contact.dist), least]
}

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// The link's lowest line is at y = 0, the wall's edge along x at y = 0, before the wall moves by `gap` down.
#[test]
fn the_near_edge_of_a_wall_seen_edge_on_is_in_the_manifold() {
    let corners = [Vector::new(-4.0, 0.0, 0.0), Vector::new(0.0, -5.0, 0.0), Vector::new(4.0, 0.0, 0.0)];
    for caps in CAPS {
        let (start, end) = (Vector::new(0.0, 0.5, -1.0), Vector::new(0.0, 0.5, 1.0));
        let link = ModifiedCylinder::new(start, end, 0.5, caps).unwrap();
        for order in ORDERS {
            let triangle = Triangle::from(order.map(|k| corners[k]));
            let mesh = TriMesh::new(corners.to_vec(), vec![order.map(|k| k as u32)]).unwrap();
            for gap in [-0.2, -1e-6, 0.0, 1e-14, 0.01] {
                let place = Pose::from_translation(Vector::new(0.13, -gap, 0.0));
                let walls: [&dyn Shape; 2] = [&triangle, &mesh];
                for wall in walls {
                    for (pos12, g1, g2) in
                        [(place, &link as &dyn Shape, wall), (place.inverse(), wall, &link as &dyn Shape)]
                    {
                        let [contact, least] = contact_and_manifold(&pos12, g1, g2, 0.05);
                        let context = format!("{caps:?} {order:?} {gap:e}");
                        assert!((contact - gap).abs() < 1e-15 * 8.0, "{context}: contact {contact}");
                        assert!((least - gap).abs() < 1e-15 * 8.0, "{context}: manifold {least}");
                    }
                }
            }
        }
    }
}

/// The same with walls that lean a little, turned about the edge and about the link's axis, at every height.
#[test]
fn the_least_distance_at_a_free_edge_does_not_depend_on_a_slight_tilt() {
    let corners = [Vector::new(-3.0, 0.0, 0.0), Vector::new(0.0, -5.0, 0.0), Vector::new(3.0, 0.0, 0.0)];
    let mut asked = 0;
    for caps in CAPS {
        for upright in [false, true] {
            let axis = if upright { Vector::Y } else { Vector::Z };
            let low = if upright && caps[0] == Cap::Flat { 0.0 } else { 0.5 };
            let start = Vector::Y * low - if upright { Vector::ZERO } else { axis };
            let link = ModifiedCylinder::new(start, start + axis * 2.0, 0.5, caps).unwrap();
            for tilt in [0.0, 1e-16, 1e-13, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4] {
                for about in [Vector::X, Vector::Z, Vector::Y, Vector::new(0.6, 0.0, 0.8)] {
                    for gap in [-1e-2, -1e-9, 1e-12, 1e-3] {
                        let place = Pose::from_parts(
                            Vector::new(0.13, -gap, 0.0),
                            Rot3::from_axis_angle(about, tilt),
                        );
                        for order in ORDERS {
                            let triangle = Triangle::from(order.map(|k| corners[k]));
                            let [contact, least] = contact_and_manifold(&place, &link, &triangle, 0.05);
                            asked += 1;
                            assert!(
                                (contact - least).abs() < 1e-13,
                                "{caps:?} {upright} {tilt:e} about {about} {gap:e} {order:?}: {contact:e} {least:e}"
                            );
                        }
                    }
                }
            }
        }
    }
    assert!(asked > 6000, "{asked}");
}
