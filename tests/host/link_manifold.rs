//! The contact points of a link and a triangle: on both surfaces, as far apart as they say, as near
//! as the exact distance, under the same names from step to step, and with the normals that a mesh
//! or a chain allows.

use crate::draw::{CAPS, Draw, U, scaled};
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::query::{
    ContactManifold, PersistentQueryDispatcher, PointQuery, QueryDispatcher,
};
use parry_continuum::parry::shape::{
    Ball, FeatureId, Segment, Shape, TriMesh, TriMeshFlags, Triangle,
};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use std::collections::BTreeSet;

type Manifold = ContactManifold<(), ()>;

fn manifolds(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real) -> Vec<Manifold> {
    let (mut manifolds, mut workspace) = (vec![], None);
    let dispatcher = ContinuumDispatcher::default();
    dispatcher
        .contact_manifolds(pos12, g1, g2, prediction, &mut manifolds, &mut workspace)
        .unwrap();
    manifolds
}

#[test]
fn every_point_is_on_both_surfaces_and_the_nearest_is_the_distance() {
    let (mut random, dispatcher) = (Random::new(81), ContinuumDispatcher::default());
    let mut counts = [[0; 2]; 4];
    for round in 0..20_000 {
        let (link, triangle, pose) = random.meeting();
        // A segment is a triangle whose corners are on a line.
        let segment = Segment::new(triangle.a, triangle.b);
        let wall: &dyn Shape = if round % 4 == 0 { &segment } else { &triangle };
        let contact = dispatcher.contact(&pose, &link, wall, 0.3).unwrap();
        let found = manifolds(&pose, &link, wall, 0.3);
        let points = &found[0].points;
        let Some(contact) = contact else {
            assert!(points.is_empty(), "{link:?} {:?} {pose:?}", wall.as_typed_shape());
            continue;
        };
        let context =
            || format!("{link:?} {:?} {pose:?} {contact:?} {:?}", wall.as_typed_shape(), found[0]);
        let tolerance = 256.0 * U * 6.0;
        let least = points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        // What coincides with a point that is there already is left out.
        let same = 2e-6 * (link.length() + link.radius());
        assert!(
            least >= contact.dist - tolerance && least <= contact.dist + same,
            "{least} {}",
            context()
        );
        assert!((found[0].local_n1 - contact.normal1).length() < 1e-9);
        let caps = CAPS.iter().position(|caps| *caps == link.caps()).unwrap();
        counts[caps][usize::from(contact.dist < 0.0)] += points.len();
        for point in points {
            let apart = pose * point.local_p2 - point.local_p1;
            assert!((apart - found[0].local_n1 * point.dist).length() < tolerance, "{}", context());
            let off_wall = wall.distance_to_local_point(point.local_p2, true);
            // One all but as close stands for the nearest, with its distance.
            assert!(off_wall < same.max(1e-7), "{off_wall} {}", context());
            // A point deep inside is that of an overlap, which may lie beyond either.
            if contact.dist >= 0.0 {
                let off_link = link.distance_to_local_point(point.local_p1, false);
                assert!(off_link.abs() < same.max(tolerance), "{off_link} {}", context());
            }
        }
        let swapped = &manifolds(&pose.inverse(), wall, &link, 0.3)[0].points;
        let least_swapped = swapped.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min);
        assert!((least_swapped - least).abs() < same + 1e-12, "{}", context());
    }
    assert!(counts.iter().flatten().all(|&n| n > 300), "{counts:?}");
}

/// Of a link that lies along a rail, and of a cap that stands on one, both ends of what they share
/// are contacts.
#[test]
fn links_lie_and_stand_on_rails() {
    let mut random = Random::new(88);
    let rail = Segment::new(-3.0 * Vector::X, 3.0 * Vector::X);
    for caps in CAPS {
        let length = random.between(1.0, 2.0);
        for axis in [Vector::X, Vector::Y] {
            let link = ModifiedCylinder::new(Vector::ZERO, axis * length, 0.5, caps).unwrap();
            let (below, shared) = match (axis == Vector::X, caps[0]) {
                (true, _) => (0.5, length),
                (false, Cap::Flat) => (0.0, 1.0),
                // A ball stands on one point.
                (false, Cap::Round) => (0.5, 0.0),
            };
            let pose =
                Pose::from_translation(Vector::new(random.between(-0.3, 0.3), below - 0.01, 0.0))
                    .inverse();
            let found = manifolds(&pose, &link, &rail, 0.1);
            let along: Vec<_> = found[0].points.iter().map(|point| point.local_p2.x).collect();
            let least = along.iter().copied().fold(Real::INFINITY, Real::min);
            let most = along.iter().copied().fold(Real::NEG_INFINITY, Real::max);
            assert!((most - least - shared).abs() < 1e-6, "{caps:?} {axis} {found:?}");
            assert!(
                found[0].points.iter().all(|point| (point.dist + 0.01).abs() < 1e-9),
                "{caps:?} {axis} {found:?}"
            );
        }
    }
}

/// Multiplied by 2^k, everything is 2^k times as large, bit for bit.
#[test]
fn the_unit_of_length_does_not_matter() {
    let mut random = Random::new(82);
    let mut counted = 0;
    for _ in 0..2000 {
        let (link, triangle, pose) = random.meeting();
        let factor = Real::powi(2.0, random.index(81) as i32 - 40);
        let big = Triangle::from(triangle.vertices().map(|vertex| vertex * factor));
        let big_pose = Pose::from_parts(pose.translation * factor, pose.rotation);
        let found = manifolds(&pose, &link, &triangle, 0.3);
        let big = manifolds(&big_pose, &scaled(&link, factor), &big, 0.3 * factor);
        assert_eq!(found[0].local_n1, big[0].local_n1);
        assert_eq!(found[0].points.len(), big[0].points.len());
        for (one, other) in found[0].points.iter().zip(&big[0].points) {
            counted += 1;
            assert_eq!((one.local_p1 * factor, one.dist * factor), (other.local_p1, other.dist));
            assert_eq!((one.fid1, one.fid2), (other.fid1, other.fid2));
        }
    }
    assert!(counted > 500, "{counted}");
}

fn floor() -> Triangle {
    Triangle::new(
        Vector::new(-50.0, 0.0, -40.0),
        Vector::new(50.0, 0.0, -40.0),
        Vector::new(0.0, 0.0, 60.0),
    )
}

/// A link that lies touches with the ends of its lowest line; one that stands on a disc touches
/// around it.
#[test]
fn links_lie_on_their_ends_and_stand_on_their_rim() {
    let mut random = Random::new(83);
    for caps in CAPS {
        for _ in 0..50 {
            let turn = Rot3::from_rotation_y(random.between(0.0, 6.0));
            let lying = ModifiedCylinder::new(-Vector::X, 1.5 * Vector::X, 0.5, caps).unwrap();
            let pose = Pose::from_parts(Vector::new(random.unit(), 0.499, random.unit()), turn);
            let found = &manifolds(&pose.inverse(), &lying, &floor(), 0.02)[0];
            let along: Vec<_> = found.points.iter().map(|point| point.local_p1.x).collect();
            assert_eq!(along.len(), 2, "{caps:?} {along:?}");
            assert!(
                (along[0].min(along[1]) + 1.0).abs() < 1e-6
                    && (along[0].max(along[1]) - 1.5).abs() < 1e-6
            );
            assert!(found.points.iter().all(|point| (point.dist + 0.001).abs() < 1e-12));

            let standing = ModifiedCylinder::new(Vector::ZERO, 2.0 * Vector::Y, 0.5, caps).unwrap();
            let height = if caps[0] == Cap::Flat { -0.001 } else { 0.499 };
            let pose = Pose::from_parts(Vector::new(random.unit(), height, random.unit()), turn);
            let found = &manifolds(&pose.inverse(), &standing, &floor(), 0.02)[0];
            assert_eq!(found.points.len(), if caps[0] == Cap::Flat { 4 } else { 1 });
            let middle: Vector = found.points.iter().map(|point| point.local_p1).sum();
            assert!((middle * Vector::new(1.0, 0.0, 1.0)).length() < 1e-9);
            assert!(found.points.iter().all(|point| (point.dist + 0.001).abs() < 1e-12));
        }
    }
}

/// Leaning by any angle about any side, the lowest point of the rim is exact: no corner of a
/// polygon is.
#[test]
fn the_lowest_point_of_a_rim_is_a_contact() {
    let mut random = Random::new(84);
    for _ in 0..500 {
        let rod = ModifiedCylinder::cylinder(Vector::ZERO, Vector::Y, 0.5).unwrap();
        let (side, lean) = (random.between(0.0, 6.2), random.between(1e-4, 1.4));
        let lowered = Rot3::from_axis_angle(Vector::new(side.cos(), 0.0, side.sin()), lean);
        let rim_depth = 0.5 * lean.sin();
        let pose = Pose::from_parts(Vector::new(0.3, rim_depth - 0.001, 0.1), lowered);
        let found = &manifolds(&pose.inverse(), &rod, &floor(), 0.02)[0];
        let deepest = found.find_deepest_contact().unwrap();
        assert!((deepest.dist + 0.001).abs() < 1e-12, "{lean}: {:?}", found.points);
        assert!(((deepest.local_p1 * Vector::new(1.0, 0.0, 1.0)).length() - 0.5).abs() < 1e-9);
    }
}

fn names(found: &[Manifold]) -> BTreeSet<(u32, u32)> {
    found.iter().flat_map(|m| m.points.iter().map(|point| (point.fid1.0, point.fid2.0))).collect()
}

/// What shakes a resting link does not rename its contacts.
#[test]
fn contacts_keep_their_names() {
    let mut random = Random::new(85);
    for caps in CAPS {
        for (start, end) in [(-Vector::X, Vector::X), (Vector::ZERO, 2.0 * Vector::Y)] {
            let link = ModifiedCylinder::new(start, end, 0.5, caps).unwrap();
            let rest = if start == Vector::ZERO && caps[0] == Cap::Flat { 0.0 } else { 0.5 };
            let at = |place: Vector, turn: Vector| {
                let pose = Pose::from_parts(
                    Vector::new(1.0, rest, 2.0) + place,
                    Rot3::from_scaled_axis(turn),
                );
                names(&manifolds(&pose.inverse(), &link, &floor(), 0.02))
            };
            let before = at(Vector::ZERO, Vector::ZERO);
            assert!(!before.is_empty());
            for _ in 0..50 {
                let after = at(
                    random.vector(1e-4),
                    Vector::Y * random.between(-0.5, 0.5) + random.vector(1e-7),
                );
                assert_eq!(before, after, "{caps:?}");
            }
        }
    }
}

/// A flat floor of many triangles. The flags decide what its inner edges do.
fn tiles(flags: TriMeshFlags) -> TriMesh {
    let vertices =
        (0..81).map(|k| Vector::new((k / 9) as Real - 4.0, 0.0, (k % 9) as Real - 4.0)).collect();
    let cell = |k: u32| {
        let a = 9 * (k / 8) + k % 8;
        [[a, a + 1, a + 9], [a + 1, a + 10, a + 9]]
    };
    TriMesh::with_flags(vertices, (0..64).flat_map(cell).collect(), flags).unwrap()
}

#[test]
fn inner_edges_of_a_floor_are_not_felt() {
    let mut random = Random::new(86);
    let (plain, fixed) = (tiles(TriMeshFlags::empty()), tiles(TriMeshFlags::FIX_INTERNAL_EDGES));
    let (mut ghosts, mut honest) = (0, 0);
    for _ in 0..300 {
        let (caps, turn) = (random.caps(), Rot3::from_rotation_y(random.between(0.0, 6.0)));
        let link = ModifiedCylinder::new(-0.7 * Vector::X, 0.7 * Vector::X, 0.3, caps).unwrap();
        let place = Vector::new(random.between(-2.0, 2.0), 0.295, random.between(-2.0, 2.0));
        let pose = Pose::from_parts(place, turn);
        let points = |mesh: &TriMesh| {
            let found = manifolds(&pose, mesh, &link, 0.01);
            found.into_iter().filter(|m| !m.points.is_empty()).collect::<Vec<_>>()
        };
        ghosts += points(&plain).iter().filter(|m| m.local_n1.y < 0.999).count();
        for manifold in points(&fixed) {
            honest += manifold.points.len();
            assert!((manifold.local_n1 - Vector::Y).length() < 1e-12, "{manifold:?}");
            // An edge along the lowest line may be a little beside it.
            assert!(
                manifold.points.iter().all(|point| (-1e-9..2e-5).contains(&(point.dist + 0.005)))
            );
        }
    }
    assert!(ghosts > 20 && honest > 600, "{ghosts} {honest}");
}

#[test]
fn a_robot_in_a_lumen_is_held_by_walls_of_one_side_and_of_two() {
    let (vertices, triangles) = Ball::new(5.0).to_trimesh(40, 20);
    let wall = |flags| TriMesh::with_flags(vertices.clone(), triangles.clone(), flags).unwrap();
    let one_sided = wall(TriMeshFlags::FIX_INTERNAL_EDGES);
    let two_sided = wall(TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED);
    let robot =
        Chain::from_centreline(&[Vector::ZERO, 2.0 * Vector::X, 4.97 * Vector::X], &[0.5, 0.5])
            .unwrap();
    for robot in [&robot as &dyn Shape, &robot.links()[1]] {
        let touched = |mesh: &TriMesh| {
            let found = manifolds(&Pose::IDENTITY, robot, mesh, 0.01);
            found.into_iter().filter(|m| m.points.iter().any(|p| p.dist < 0.01)).collect::<Vec<_>>()
        };
        for wall in [&one_sided, &two_sided] {
            let held = touched(wall);
            assert!(!held.is_empty());
            assert!(held.iter().all(|m| m.local_n1.x > 0.9), "{held:?}");
        }
    }
}

/// Slid along a vertex of the wall, a chain's joints are as smooth as its links: the cap of one
/// link inside the next makes no contact that would catch.
#[test]
fn joints_do_not_catch() {
    let mut random = Random::new(87);
    let points: Vec<_> = (0..6).map(|k| Vector::X * k as Real).collect();
    let (radii, spike) = ([0.4; 5], 0.401);
    let robots = [Chain::from_centreline(&points, &radii), Chain::capsules(&points, &radii)];
    let mut touched = 0;
    for robot in robots.map(Result::unwrap) {
        for _ in 0..300 {
            let x = random.between(0.6, 4.4);
            let tip = Vector::new(x, spike, 0.0);
            let base = |way: Real| tip + Vector::new(way, 2.0, random_side(way));
            let wall = Triangle::new(tip, base(0.5), base(-0.5));
            let found = manifolds(&Pose::IDENTITY, &robot, &wall, 0.05);
            for manifold in found.iter().filter(|manifold| !manifold.points.is_empty()) {
                assert!(manifold.local_n1.x.abs() < 1e-9, "{manifold:?}");
                assert!(
                    manifold.points.iter().all(|point| point.dist > 0.001 - 1e-9),
                    "{manifold:?}"
                );
            }
            let points = found.iter().flat_map(|manifold| &manifold.points);
            touched +=
                points.filter(|p| p.dist < 0.001 + 1e-9 && (p.local_p1.x - x).abs() < 1e-6).count();
        }
    }
    assert!(touched >= 600, "{touched}");
}

fn random_side(way: Real) -> Real {
    if way > 0.0 { 0.3 } else { -0.2 }
}

/// At a step the wider cap is bare and touches; the narrower one is inside the wider link and does
/// not.
#[test]
fn a_step_touches_with_its_wider_side_alone() {
    let points = [Vector::ZERO, 2.0 * Vector::X, 4.0 * Vector::X];
    let robot = Chain::from_centreline(&points, &[0.6, 0.3]).unwrap();
    assert_eq!(robot.links()[0].caps()[1], Cap::Flat);
    let hook = |x: Real, y: Real| {
        Triangle::new(
            Vector::new(x, y, 0.0),
            Vector::new(x + 1.0, y + 1.5, 0.1),
            Vector::new(x + 1.0, y + 1.5, -0.1),
        )
    };
    let touched = |wall: &Triangle| {
        let found = manifolds(&Pose::IDENTITY, &robot, wall, 0.02).into_iter();
        found.filter(|m| !m.points.is_empty()).collect::<Vec<_>>()
    };
    let bare = touched(&hook(1.99, 0.45));
    assert_eq!(bare.len(), 1, "{bare:?}");
    assert!(bare[0].subshape1 == 0 && bare[0].local_n1.x > 0.99);
    // 0.005 inside the narrow link's start, 0.595 from the wide one's barrel: sideways at best.
    for manifold in touched(&hook(2.005, 0.0)) {
        assert!(manifold.subshape1 == 0 || manifold.local_n1.x > -1e-9, "{manifold:?}");
    }
}

#[test]
fn points_are_named_after_features() {
    let rod = ModifiedCylinder::cylinder(Vector::ZERO, 2.0 * Vector::Y, 0.5).unwrap();
    let needle =
        Triangle::new(Vector::ZERO, Vector::new(0.2, -1.0, 0.1), Vector::new(-0.2, -1.0, 0.1));
    let found = &manifolds(&Pose::IDENTITY, &rod, &needle, 0.02)[0];
    let point = found.find_deepest_contact().unwrap();
    assert_eq!(point.fid2.unpack(), FeatureId::Vertex(0));
    assert_eq!(point.fid1.unpack(), FeatureId::Face(1));
}

/// Under the flags that fix internal edges, too, a pair of points is as far apart along the normal
/// as its `dist` says, for links deeper than their radius.
#[test]
fn points_of_deep_links_stay_together_under_every_flag() {
    let mut random = Random::new(92);
    let corner = |k: u32| {
        let (x, z) = (Real::from(k % 5) - 2.0, Real::from(k / 5) - 2.0);
        Vector::new(x, 0.0, z)
    };
    let cell = |k: u32| {
        let a = 5 * (k / 4) + k % 4;
        [[a, a + 5, a + 1], [a + 1, a + 5, a + 6]]
    };
    let triangles: Vec<_> = (0..16).flat_map(cell).collect();
    for flags in [TriMeshFlags::FIX_INTERNAL_EDGES, TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED] {
        let floor = TriMesh::with_flags((0..25).map(corner).collect(), triangles.clone(), flags);
        let floor = floor.unwrap();
        let (mut deep, mut points) = (0, 0);
        for _ in 0..1500 {
            let link = random.link();
            let place = Vector::new(random.between(-2.0, 2.0), 0.0, random.between(-2.0, 2.0));
            let pose = Pose::new(place + random.vector(0.3), random.direction() * 2.0);
            for (pos12, g1, g2) in
                [(pose, &floor as &dyn Shape, &link as &dyn Shape), (pose.inverse(), &link, &floor)]
            {
                for manifold in manifolds(&pos12, g1, g2, 0.05) {
                    for point in &manifold.points {
                        points += 1;
                        deep += usize::from(point.dist < -link.radius());
                        let apart = pos12 * point.local_p2 - point.local_p1;
                        let off = (apart - manifold.local_n1 * point.dist).length();
                        assert!(off < 1e-6, "{off} {flags:?} {link:?} {pose:?} {point:?}");
                    }
                }
            }
        }
        assert!(deep > 200 && points > 2000, "{flags:?}: {deep} deep of {points}");
    }
}

/// A triangle that fills a crack, with corners on a line up to rounding, makes contacts on
/// itself.
#[test]
fn points_of_filler_triangles_lie_on_them() {
    let mut random = Random::new(93);
    let mut points = 0;
    for _ in 0..4000 {
        let way = random.direction() * random.between(0.5, 3.0);
        let from = random.vector(1.0);
        let noise = random.vector(1e-15);
        let triangle = Triangle::new(from, from + way * random.unit() + noise, from + way);
        let mut link = random.link();
        let pose = if random.chance(0.5) {
            // Along the triangle, above it.
            let half = 0.5 * link.length() * way.normalize();
            link = ModifiedCylinder::new(-half, half, link.radius(), link.caps()).unwrap();
            let above = way.cross(random.direction()).normalize() * link.radius();
            Pose::from_translation(-above - from - random.between(-1.0, 2.0) * way)
        } else {
            Pose::new(random.vector(0.5), random.direction())
        };
        for (pos12, g1, g2, is_second) in [
            (pose, &link as &dyn Shape, &triangle as &dyn Shape, true),
            (pose.inverse(), &triangle, &link, false),
        ] {
            for point in manifolds(&pos12, g1, g2, 0.3).iter().flat_map(|found| &found.points) {
                let on_triangle = if is_second { point.local_p2 } else { point.local_p1 };
                // (parry's distance from such a triangle is off.)
                let edges =
                    triangle.edges().map(|edge| edge.distance_to_local_point(on_triangle, true));
                let off = edges.into_iter().fold(Real::INFINITY, Real::min);
                // The points of an overlap may lie beyond either, by at most its depth.
                assert!(
                    off < 1e-5 - point.dist.min(0.0),
                    "{off} {point:?} {link:?} {triangle:?} {pose:?}"
                );
                points += 1;
            }
        }
    }
    assert!(points > 1000, "{points}");
}
