//! Links at the free edges of walls. Of a thin wall that stands edge-on below a link the near edge
//! counts, not the far one, which lies over the same point of the link. The flags of a mesh or a
//! height field turn normals and remove no contact.

use crate::draw::{CAPS, Draw, scaled};
use continuum_testing::placements::Wall;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{ContactManifold, PersistentQueryDispatcher, QueryDispatcher};
use parry_continuum::parry::shape::{
    HeightField, HeightFieldCellStatus, HeightFieldFlags, Shape, SharedShape, TriMesh,
    TriMeshFlags, Triangle,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, ContinuumDispatcher, ModifiedCylinder};

/// What `contact` says, and the least `dist` of the manifolds.
fn contact_and_manifold(
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    prediction: Real,
) -> [Real; 2] {
    let dispatcher = ContinuumDispatcher::default();
    let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) = (vec![], None);
    dispatcher
        .contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut workspace)
        .unwrap();
    let points = manifolds.iter().flat_map(|manifold| &manifold.points);
    let least = points.map(|point| point.dist).fold(Real::INFINITY, Real::min);
    let contact = dispatcher.contact(pos12, g1, g2, prediction).unwrap();
    [contact.map_or(Real::INFINITY, |contact| contact.dist), least]
}

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// The link's lowest line is at y = 0, the wall's edge along x at y = 0, before the wall moves by
/// `gap` down.
#[test]
fn the_near_edge_of_a_wall_seen_edge_on_is_in_the_manifold() {
    let corners =
        [Vector::new(-4.0, 0.0, 0.0), Vector::new(0.0, -5.0, 0.0), Vector::new(4.0, 0.0, 0.0)];
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
                    for (pos12, g1, g2) in [
                        (place, &link as &dyn Shape, wall),
                        (place.inverse(), wall, &link as &dyn Shape),
                    ] {
                        let [contact, least] = contact_and_manifold(&pos12, g1, g2, 0.05);
                        let context = format!("{caps:?} {order:?} {gap:e}");
                        assert!(
                            (contact - gap).abs() < 1e-15 * 8.0,
                            "{context}: contact {contact}"
                        );
                        assert!((least - gap).abs() < 1e-15 * 8.0, "{context}: manifold {least}");
                    }
                }
            }
        }
    }
}

/// The same with walls that lean a little, turned about the edge and about the link's axis, at
/// every height.
#[test]
fn the_least_distance_at_a_free_edge_does_not_depend_on_a_slight_tilt() {
    let corners =
        [Vector::new(-3.0, 0.0, 0.0), Vector::new(0.0, -5.0, 0.0), Vector::new(3.0, 0.0, 0.0)];
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
                            let [contact, least] =
                                contact_and_manifold(&place, &link, &triangle, 0.05);
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

/// Every flag that constrains normals, and none.
const FLAGS: [TriMeshFlags; 4] = [
    TriMeshFlags::empty(),
    TriMeshFlags::ORIENTED,
    TriMeshFlags::FIX_INTERNAL_EDGES,
    TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
];

/// The contact, and the least of the manifolds, in both orders; asserts that they are the same.
fn agreed(
    pose: &Pose,
    robot: &dyn Shape,
    wall: &dyn Shape,
    prediction: Real,
    slack: Real,
    context: &str,
) -> Real {
    let mut contacts = [0.0; 2];
    let orders = [(*pose, robot, wall), (pose.inverse(), wall, robot)];
    for ((pos12, g1, g2), found) in orders.into_iter().zip(&mut contacts) {
        let [contact, least] = contact_and_manifold(&pos12, g1, g2, prediction);
        if contact < prediction - slack {
            assert!(
                (contact - least).abs() <= slack,
                "{context}: contact {contact:e}, manifold {least:e}"
            );
        }
        *found = contact;
    }
    contacts[0]
}

/// Two plates with a slot between them, of either sense, whose triangles have any first corner.
fn slot(width: Real, sense: bool, first: usize, flags: TriMeshFlags) -> TriMesh {
    let corners = |x: Real, y: Real| [(x, -4.0), (y, -4.0), (y, 4.0), (x, 4.0)];
    let vertices = [corners(-4.0, -0.5 * width), corners(0.5 * width, 4.0)].concat();
    let vertices = vertices.into_iter().map(|(x, z)| Vector::new(x, 0.0, z)).collect();
    let triangles = [[0, 2, 1], [0, 3, 2], [4, 6, 5], [4, 7, 6]].map(|triangle: [u32; 3]| {
        let mut triangle = triangle;
        triangle.rotate_left(first);
        if sense { triangle } else { [triangle[1], triangle[0], triangle[2]] }
    });
    TriMesh::with_flags(vertices, triangles.to_vec(), flags).unwrap()
}

/// A rod that lies in a slot is held by the two free edges, under every flag.
#[test]
fn a_slot_holds_a_rod_under_every_flag() {
    let width = 0.2;
    for caps in CAPS {
        for unit in [1.0, 1e-3, 1e-6] {
            let rod = ModifiedCylinder::new(-Vector::Z, Vector::Z, 0.5, caps).unwrap();
            let rod = scaled(&rod, unit);
            for flags in FLAGS {
                for (sense, first) in [(true, 0), (true, 1), (false, 0), (false, 2)] {
                    let wall = slot_in(unit, width, sense, first, flags);
                    for y in [0.2, 0.45, 0.485, 0.4898979485566356] {
                        for x in [0.0, 0.01, -0.03] {
                            let pose = Pose::from_translation(Vector::new(-x, -y, 0.3) * unit);
                            let context =
                                format!("{caps:?} {flags:?} {sense} {first} at {x} {y} in {unit}");
                            let dist =
                                agreed(&pose, &rod, &wall, 0.05 * unit, 1e-14 * unit, &context);
                            let expected = [-0.1, 0.1].map(|edge: Real| (edge - x).hypot(y) - 0.5);
                            let expected = expected[0].min(expected[1]) * unit;
                            assert!((dist - expected).abs() < 1e-14 * unit, "{context}: {dist}");
                        }
                    }
                }
            }
        }
    }
}

fn slot_in(unit: Real, width: Real, sense: bool, first: usize, flags: TriMeshFlags) -> TriMesh {
    let wall = slot(width, sense, first, TriMeshFlags::empty());
    let vertices = wall.vertices().iter().map(|&vertex| vertex * unit).collect();
    TriMesh::with_flags(vertices, wall.indices().to_vec(), flags).unwrap()
}

/// The same of a height field whose middle row of cells is missing, and of its outer edges.
#[test]
fn a_slot_of_a_height_field_holds_a_rod_under_every_flag() {
    let mut counted = 0;
    for flags in [HeightFieldFlags::empty(), HeightFieldFlags::FIX_INTERNAL_EDGES] {
        for zigzag in [false, true] {
            let heights = Array2::new(6, 6, vec![0.0; 36]);
            // Cells of 0.2.
            let mut field = HeightField::with_flags(heights, Vector::new(1.0, 1.0, 1.0), flags);
            for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
                let mut status = HeightFieldCellStatus::empty();
                status.set(HeightFieldCellStatus::CELL_REMOVED, j == 2);
                status.set(HeightFieldCellStatus::ZIGZAG_SUBDIVISION, zigzag);
                field.set_cell_status(i, j, status);
            }
            for caps in CAPS {
                let rod =
                    ModifiedCylinder::new(-0.3 * Vector::Z, 0.3 * Vector::Z, 0.5, caps).unwrap();
                // Over the slot from -0.1 to 0.1, and beside the field, which ends at 0.5.
                for (x, edge) in [(0.01, 0.1), (-0.02, -0.1), (0.6, 0.5), (-0.58, -0.5)] {
                    for (y, side) in [(0.45, 1.0), (0.48, 1.0), (0.45, -1.0)] {
                        let pose = Pose::from_translation(Vector::new(-x, -y * side, 0.0));
                        let context = format!("{caps:?} {flags:?} {zigzag} at {x} {y} {side}");
                        let dist = agreed(&pose, &rod, &field, 0.05, 1e-14, &context);
                        let expected = Real::hypot(x - edge, y) - 0.5;
                        assert!(
                            (dist - expected).abs() < 1e-14,
                            "{context}: {dist} for {expected}"
                        );
                        counted += 1;
                    }
                }
            }
        }
    }
    assert!(counted == 192, "{counted}");
}

/// Robots in aligned and in random placements at meshes, each under every flag and of either sense.
#[test]
fn a_flag_turns_normals_and_removes_no_contact() {
    let mut random = Random::new(97);
    let (mut near, mut turned) = ([0; 4], 0);
    for round in 0..rounds(1500) {
        let placement = random.placement(if round % 2 == 0 { Wall::BoxMesh } else { Wall::Plate });
        let mesh = placement.wall.as_trimesh().unwrap();
        let turn = if round % 3 == 0 { random.direction() * 0.3 } else { Vector::ZERO };
        let pose = Pose::new(Vector::ZERO, turn) * placement.pose;
        for (k, flags) in FLAGS.into_iter().enumerate() {
            for sense in [false, true] {
                let triangles = mesh
                    .indices()
                    .iter()
                    .map(|&[a, b, c]| if sense { [a, b, c] } else { [a, c, b] });
                let wall =
                    TriMesh::with_flags(mesh.vertices().to_vec(), triangles.collect(), flags)
                        .unwrap();
                let context = format!(
                    "{flags:?} {sense} {:?} {mesh:?} {pose:?}",
                    placement.robot.0.shape_type()
                );
                let dist = agreed(&pose, &*placement.robot, &wall, 0.05, 1e-11, &context);
                near[k] += usize::from(dist < 0.05);
                turned += usize::from(wall.triangle_normal_constraints(0).is_some());
            }
        }
    }
    assert!(near.iter().all(|&n| n > rounds(1000)) && turned > rounds(3000), "{near:?} {turned}");
}

/// Inside a closed mesh and outside, links are held under every flag; also a chain, and in small
/// units.
#[test]
fn a_vessel_holds_a_robot_from_within_and_from_without() {
    let mut random = Random::new(98);
    let (vertices, triangles) = parry_continuum::parry::shape::Ball::new(5.0).to_trimesh(24, 12);
    let mut held = 0;
    for unit in [1.0, 1e-6] {
        for flags in FLAGS {
            let vertices: Vec<_> = vertices.iter().map(|&vertex| vertex * unit).collect();
            let vessel = TriMesh::with_flags(vertices, triangles.clone(), flags).unwrap();
            for _ in 0..20 {
                let link = random.link();
                let link = link.transformed(&Pose::from_translation(-link.local_aabb().center()));
                let reach = link.local_aabb().half_extents().max_element();
                let robot = SharedShape::new(scaled(&link, 0.5 / reach * unit));
                let (turn, way) = (random.direction(), random.direction());
                let at = |t: Real| Pose::new(way * t * unit, turn).inverse();
                // Somewhat deeper than where it first touches, from within and from without.
                for (mut free, mut met) in [(2.5, 5.5), (8.0, 4.5)] {
                    for _ in 0..12 {
                        let middle = 0.5 * (free + met);
                        let dispatcher = ContinuumDispatcher::default();
                        let apart =
                            dispatcher.distance(&at(middle), &*robot, &vessel).unwrap().distance;
                        *(if apart > 0.0 { &mut free } else { &mut met }) = middle;
                    }
                    let pose = at(met + 0.01 * (met - free).signum());
                    let context = format!(
                        "{flags:?} {unit} {:?} {pose:?}",
                        robot.as_shape::<ModifiedCylinder>()
                    );
                    let dist = agreed(&pose, &*robot, &vessel, 0.05 * unit, 1e-11 * unit, &context);
                    held += usize::from(dist <= 0.0);
                }
            }
        }
    }
    assert!(held > 300, "{held}");
}

/// A link on the plane of a face slides over its free edge: the contact has the face's normal, and
/// there is none before the two touch. A link that reaches farther beyond the plane is stopped.
#[test]
fn a_link_on_the_plane_of_a_face_is_not_stopped_by_its_free_edge() {
    let dispatcher = ContinuumDispatcher::default();
    for unit in [1.0, 1e-3, 1e-6] {
        for flags in &FLAGS[2..] {
            for (sense, first) in [(true, 0), (true, 1), (false, 0), (false, 2)] {
                let wall = slot_in(unit, 0.2, sense, first, *flags);
                for side in [1.0, -1.0] {
                    for caps in [[Cap::Flat; 2], [Cap::Round; 2]] {
                        // The wall begins at x = 0.1, and the link ends at x = 0.1 - gap.
                        // A round link stands on its end there.
                        // Its lowest line is `sunk` beyond the wall.
                        let normals = |gap: Real, sunk: Real| {
                            let low = Vector::new(0.1 - gap, side * (0.5 - sunk), 0.0);
                            let (from, to) = if caps[1] == Cap::Round {
                                (low, low + side * Vector::Y)
                            } else {
                                (low - 0.15 * Vector::X, low)
                            };
                            let link = ModifiedCylinder::new(from, to, 0.5, caps).unwrap();
                            let link = scaled(&link, unit);
                            let (mut manifolds, mut workspace): (Vec<ContactManifold<(), ()>>, _) =
                                (vec![], None);
                            dispatcher
                                .contact_manifolds(
                                    &Pose::IDENTITY,
                                    &link,
                                    &wall,
                                    0.02 * unit,
                                    &mut manifolds,
                                    &mut workspace,
                                )
                                .unwrap();
                            let held = manifolds.iter().filter(|manifold| {
                                // The other plate of the slot is below the link.
                                let mut points = manifold.points.iter();
                                points.any(|point| point.local_p2.x > 0.0)
                            });
                            held.map(|manifold| manifold.local_n1).collect::<Vec<_>>()
                        };
                        let context = format!("{caps:?} {flags:?} {sense} {first} {side} {unit}");
                        let is_level = |normal: &Vector| (normal.y + side).abs() < 1e-9;
                        if caps[1] == Cap::Flat {
                            for sunk in [-1e-3, -1e-9, 0.0, 1e-9, 1e-3, 0.02] {
                                assert_eq!(normals(0.01, sunk), [], "{context} {sunk}");
                            }
                            for sunk in [1e-3, 0.02] {
                                let found = normals(-0.01, sunk);
                                let is_level = !found.is_empty() && found.iter().all(is_level);
                                assert!(is_level, "{context} {sunk}: {found:?}");
                            }
                            for gap in [0.01, -0.01] {
                                let found = normals(gap, 0.1);
                                let stops = |normal: &Vector| normal.x > 1.0 - 1e-9;
                                let is_stopped = !found.is_empty() && found.iter().all(stops);
                                assert!(is_stopped, "{context} {gap}: {found:?}");
                            }
                        } else {
                            // The round end is beside the edge, and above it.
                            let found = normals(0.05, 0.02);
                            let is_level = !found.is_empty() && found.iter().all(is_level);
                            assert!(is_level, "{context}: {found:?}");
                        }
                    }
                }
            }
        }
    }
}
