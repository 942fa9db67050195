//! The planner's question: random shapes in a ventricle, most of them colliding, at margins around their distance.

use continuum_scene::steer::Random;
use continuum_scene::{ctr, ventricle};
use parry_continuum::Chain;
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};

/// Random shapes of the three tubes with about 30 links, by Algorithm 1, as capsules and as cylinders.
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

/// Cold, after other shapes, and in a batch: what `clears` says is what the distance says, to the last bit.
#[test]
fn a_shape_clears_exactly_what_its_distance_exceeds() {
    let (mesh, pose) = scene();
    let mut reference = Exhaustive::<f64>::new(&mesh).unwrap();
    let (mut warm, mut cold) = (BvhSearch::new(&mesh).unwrap(), BvhSearch::new(&mesh).unwrap());
    let (mut free, mut colliding) = (0, 0);
    for shape in shapes(300) {
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
    assert!(free > 50 && colliding > 50, "{free} free, {colliding} colliding");
}

#[test]
fn a_batch_of_shapes_is_its_shapes_one_by_one() {
    let (mesh, pose) = scene();
    let shapes = shapes(200);
    let robots: Vec<_> = shapes.iter().map(|shape| (shape, pose)).collect();
    let (mut search, mut reference) =
        (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f64>::new(&mesh).unwrap());
    let (mut clear, mut expected) = (Vec::new(), Vec::new());
    for margin in [0.0, 0.3] {
        search.clears_batch(&robots, margin, &mut clear).unwrap();
        reference.clears_batch(&robots, margin, &mut expected).unwrap();
        assert_eq!(clear, expected);
        assert!(clear.contains(&true) && clear.contains(&false));
    }
}
