//! The planner's question: random shapes in a ventricle, most of them colliding, at margins around
//! their distance.

use continuum_demo::steer::Random;
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random as Seeded, rounds};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};

/// Random shapes of the three tubes with about 30 links, by Algorithm 1, as capsules and as
/// cylinders.
pub fn shapes(count: usize) -> Vec<Chain> {
    let (robot, mut random) = (ctr::three_tubes(), Random(5));
    (0..count)
        .map(|shape| {
            let line = robot.centreline(&robot.any_joints(&mut random), 30);
            let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][shape % 3];
            build(&line.points, &line.radii).unwrap()
        })
        .collect()
}

pub fn scene() -> (TriMesh, Pose) {
    let (vertices, indices) = ventricle::mesh(6_000);
    (TriMesh::new(vertices, indices).unwrap(), ventricle::entry())
}

/// Cold, after other shapes, and in a batch: what `clears` says is what the distance says, to the
/// last bit.
#[test]
fn a_shape_clears_exactly_what_its_distance_exceeds() {
    let (mesh, pose) = scene();
    let mut reference = Exhaustive::<f64>::new(&mesh).unwrap();
    let (mut warm, mut cold) = (BvhSearch::new(&mesh).unwrap(), BvhSearch::new(&mesh).unwrap());
    let (mut free, mut colliding) = (0, 0);
    for shape in shapes(rounds(300)) {
        let least = reference.minimum(&shape, &pose).unwrap().distance;
        if least > 0.0 {
            free += 1
        } else {
            colliding += 1
        }
        // Just beside the distance, within what single precision can tell, and beyond.
        let around = [1.0 - 1e-3, 1.0 - 1e-6, 1.0 - 1e-12, 1.0 + 1e-12, 1.0 + 1e-6, 1.0 + 1e-3];
        let mut margins = around.map(|share| least * share).to_vec();
        margins.extend([
            0.0,
            least.next_down().max(0.0),
            least,
            least.next_up(),
            1e-6,
            0.1,
            3.0,
            f64::INFINITY,
        ]);
        for margin in margins {
            cold.forget();
            for engine in [&mut warm, &mut cold] {
                assert_eq!(
                    engine.clears(&shape, &pose, margin).unwrap(),
                    least > margin,
                    "{least}, {margin}"
                );
            }
        }
    }
    assert!(free > rounds(30) && colliding > rounds(50), "{free} free, {colliding} colliding");
}

#[test]
fn a_batch_of_shapes_is_its_shapes_one_by_one() {
    let (mesh, pose) = scene();
    let shapes = shapes(rounds(200));
    let robots: Vec<_> = shapes.iter().map(|shape| (shape, pose)).collect();
    let (mut search, mut reference) =
        (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f64>::new(&mesh).unwrap());
    let (mut clear, mut expected) = (Vec::new(), Vec::new());
    for margin in [0.0, 0.3] {
        search.clears_batch(&robots, margin, &mut clear).unwrap();
        reference.clears_batch(&robots, margin, &mut expected).unwrap();
        assert_eq!(clear, expected);
        assert!(clear.contains(&Ok(true)) && clear.contains(&Ok(false)));
    }
}

/// A small triangle whose centre is over a flat cap, from well inside the link to far ahead of it:
/// however little the gap, the link keeps it, and where another triangle overlaps the link, no gap
/// hides that.
#[test]
fn a_triangle_just_before_a_flat_cap_neither_touches_nor_hides_what_does() {
    let mut random = Seeded::new(11);
    let (mut gaps, mut touching, mut hidden) = (0, 0, 0);
    for round in 0..3_000 {
        let (start, direction) = (random.point() * 3.0, random.direction());
        let (side, length) = (direction.any_orthonormal_vector(), random.between(0.05, 2.0));
        let (end, radius) = (start + direction * length, random.between(0.02, 0.5));
        let gap =
            10.0_f64.powf(random.between(-12.0, -1.0)) * if round % 4 == 0 { -1.0 } else { 1.0 };
        let other = direction.cross(side);
        let corners = [0.0, 2.0, 4.0].map(|turn: f64| (turn.cos(), turn.sin()));
        // In a plane across the axis, so that the gap is that to the cap.
        let across = |ahead: f64| {
            let centre = end + direction * ahead + side * (0.3 * radius);
            corners.map(|(x, y)| centre + (side * x + other * y) * (0.2 * radius))
        };
        let far =
            [Vector::splat(20.0), Vector::new(20.0, 20.0, 19.0), Vector::new(20.0, 19.0, 20.0)];
        let robot = Chain::cylinders(&[start, end], &[radius]).unwrap();
        for inside in [None, Some(-0.4 * length)] {
            let second = inside.map_or(far, across);
            let mesh = TriMesh::new(
                [across(gap), second, far].concat(),
                vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]],
            );
            let mesh = mesh.unwrap();
            let mut reference = Exhaustive::<f64>::new(&mesh).unwrap();
            let keeps = reference.minimum(&robot, &Pose::IDENTITY).unwrap();
            let mut search = BvhSearch::new(&mesh).unwrap();
            let found = search.minimum(&robot, &Pose::IDENTITY).unwrap();
            assert_eq!(
                (found.distance, found.witness.triangle),
                (keeps.distance, keeps.witness.triangle),
                "{round}: {gap}"
            );
            let clears = search.clears(&robot, &Pose::IDENTITY, 0.0).unwrap();
            assert_eq!(clears, keeps.distance > 0.0, "{round}: a gap of {gap}, {keeps:?}");
            gaps += u32::from(keeps.distance > 0.0 && gap < 1e-6);
            touching += u32::from(keeps.distance == 0.0);
            hidden += u32::from(inside.is_some() && 0.0 < gap && gap < 1e-6);
        }
    }
    assert!(
        gaps > 500 && touching > 500 && hidden > 500,
        "{gaps} small gaps, {touching} touching, {hidden}"
    );
}

/// A triangle that begins in the plane of a flat cap, up to rounding, and whose third corner lies
/// in the link: rounding never turns this overlap into a gap.
#[test]
fn a_triangle_from_the_plane_of_a_flat_cap_into_the_link_touches_it() {
    let mut random = Seeded::new(12);
    for round in 0..rounds(40_000) {
        // A link of radius 1 from z = 0 to z = 4, with two corners or one a little off the plane z
        // = 0.
        let off = [0.0, 1e-17, -1e-16, 3e-16][round % 4];
        let aside = random.between(0.05, 0.6);
        let inside = |random: &mut Seeded| {
            let (x, y) = (aside + random.between(0.0, 0.2), random.between(-0.3, 0.3));
            Vector::new(x, y, random.between(0.5, 3.0))
        };
        let corners = if round / 4 % 2 == 0 {
            let (left, right) = (random.between(0.1, 3.0), random.between(0.1, 3.0));
            [Vector::new(aside, -left, -off), Vector::new(aside, right, -off), inside(&mut random)]
        } else {
            [Vector::new(aside, 0.0, -off), inside(&mut random), inside(&mut random)]
        };
        let pose = random.pose(5.0);
        let corners = corners.map(|corner| pose * corner).to_vec();
        let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).unwrap();
        let ends = [pose.translation, pose * Vector::new(0.0, 0.0, 4.0)];
        let robot = Chain::cylinders(&ends, &[1.0]).unwrap();
        let mut reference = Exhaustive::<f64>::new(&mesh).unwrap();
        let found = reference.minimum(&robot, &Pose::IDENTITY).unwrap();
        assert_eq!(found.distance, 0.0, "{round}: {found:?}");
        assert_eq!(found.witness.on_mesh, found.witness.on_robot, "{round}");
        let mut search = BvhSearch::new(&mesh).unwrap();
        assert!(!search.clears(&robot, &Pose::IDENTITY, 0.0).unwrap(), "{round}");
    }
}

/// A wire through a corner or an edge of a wall without a hole, as near as rounding can tell, meets
/// it. Each triangle by itself might say that it passes beside.
#[test]
fn a_wire_does_not_slip_through_between_triangles() {
    let mut random = Seeded::new(13);
    for round in 0..20_000 {
        // A fan of six triangles around the origin.
        let rim = (0..6).map(|k| {
            let turn = f64::from(k) * std::f64::consts::FRAC_PI_3;
            Vector::new(turn.cos(), turn.sin(), random.between(-0.3, 0.3))
        });
        let corners: Vec<_> = std::iter::once(Vector::ZERO).chain(rim).collect();
        let at = corners[1] * if round % 2 == 0 { 0.0 } else { random.between(0.2, 0.8) };
        let half = Vector::new(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0);
        let pose = random.pose(5.0);
        let fan = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let mesh =
            TriMesh::new(corners.iter().map(|corner| pose * *corner).collect(), fan).unwrap();
        let wire = Chain::capsules(&[pose * (at - half), pose * (at + half)], &[0.0]).unwrap();
        let mut reference = Exhaustive::<f64>::new(&mesh).unwrap();
        let found = reference.minimum(&wire, &Pose::IDENTITY).unwrap();
        assert_eq!(found.distance, 0.0, "{round}: {found:?}");
        let mut search = BvhSearch::new(&mesh).unwrap();
        assert!(!search.clears(&wire, &Pose::IDENTITY, 0.0).unwrap(), "{round}");
    }
}
