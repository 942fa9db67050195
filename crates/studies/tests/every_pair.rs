//! The loop over every pair takes any route to the discs, and uses it only where a cap decides.

use continuum_studies::Number;
use continuum_studies::every_pair::EveryPair;
use continuum_studies::quartic::RecentredQuartic;
use continuum_testing::Random;
use parry_continuum::Chain;
use parry_continuum::distance::laboratory::{Convex, DiscSolver};
use parry_continuum::distance::{Closest, Scalar, Vec3};
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{Exhaustive, Proximity};
use real_polynomial_roots::Companion;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A route that finds discs by a quartic, or none while it is blind.
struct Quartic;

static IS_BLIND: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicUsize = AtomicUsize::new(0);

impl<T: Number> DiscSolver<T> for Quartic {
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
        ASKED.fetch_add(1, Ordering::Relaxed);
        if IS_BLIND.load(Ordering::Relaxed) {
            Closest { distance: T::ONE / T::ZERO, point1: ends[0], point2: ends[0] }
        } else {
            RecentredQuartic::<Companion>::segment_disc(ends, normal, radius)
        }
    }
}

fn answers<T: Number, S: DiscSolver<T> + DiscSolver<f64>>(
    mesh: &TriMesh,
    robot: &Chain,
) -> Vec<f64> {
    let found = EveryPair::<T, S>::new(mesh).per_link(robot, &Pose::IDENTITY);
    found.iter().map(|nearest| nearest.distance).collect()
}

fn by_quartic<T: Number>(is_blind: bool, mesh: &TriMesh, robot: &Chain) -> (Vec<f64>, usize) {
    IS_BLIND.store(is_blind, Ordering::Relaxed);
    ASKED.store(0, Ordering::Relaxed);
    let found = answers::<T, Quartic>(mesh, robot);
    (found, ASKED.load(Ordering::Relaxed))
}

fn library(mesh: &TriMesh, robot: &Chain) -> Vec<f64> {
    let mut out = Vec::new();
    Exhaustive::<f64>::new(mesh).unwrap().per_link(robot, &Pose::IDENTITY, &mut out).unwrap();
    out.iter().map(|answer| answer.distance).collect()
}

fn assert_near(found: &[f64], expected: &[f64], slack: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= slack, "{found} for {expected}");
    }
}

#[test]
fn every_pair_is_taken_by_any_route_to_the_discs() {
    // Cylinders above a few hundred triangles, so that caps come nearest to edges.
    let mut random = Random::new(5);
    let mut point = |size: f64| random.point() * size;
    let vertices: Vec<_> = (0..900).map(|_| point(10.0)).collect();
    let indices = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let line: Vec<_> = (0..40).map(|_| point(30.0)).collect();
    let robot = Chain::cylinders(&line, &[0.4; 39]).unwrap();
    let capsules = Chain::capsules(&line, &[0.4; 39]).unwrap();
    // The robot reaches from -30 to 30.
    let [double, single] = [16.0 * 60.0 * f64::UNIT_ROUNDOFF, 16.0 * 60.0 * f32::UNIT_ROUNDOFF];

    let expected = library(&mesh, &robot);
    assert_near(&answers::<f64, Convex>(&mesh, &robot), &expected, double);
    assert_near(&answers::<f32, Convex>(&mesh, &robot), &expected, single);
    let (found, asked) = by_quartic::<f64>(false, &mesh, &robot);
    assert_near(&found, &expected, double);
    // Three edges for each pair whose axis ends where it is nearest, which is not every pair.
    assert!(asked > 0 && asked < 3 * 300 * 39, "{asked}");
    assert_near(&by_quartic::<f32>(false, &mesh, &robot).0, &expected, single);

    // The route is what the answers come from, where a cap decides and nowhere else.
    let (blind, _) = by_quartic::<f64>(true, &mesh, &robot);
    assert!(blind.iter().zip(&expected).any(|(blind, right)| *blind > *right + 1e-6));
    assert!(blind.iter().zip(&expected).all(|(blind, right)| *blind >= *right - double));
    let (blind, asked) = by_quartic::<f64>(true, &mesh, &capsules);
    assert_near(&blind, &library(&mesh, &capsules), double);
    assert_eq!(asked, 0);
}
