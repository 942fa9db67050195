//! The exhaustive engine with another route to the discs.

use crate::UNIT;
use crate::common::Random;
use crate::scenes::extent;
use parry_continuum::Chain;
use parry_continuum::distance::{Closest, Convex, DiscSolver, Vec3};
use parry_continuum::parry::math::Pose;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::*;
use parry_continuum::roots::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A route that finds discs by a quartic, or none while it is blind. (Two routes would be two engines to compile, each
/// for every instruction set.)
struct Quartic;

static IS_BLIND: AtomicBool = AtomicBool::new(false);
/// How often it was asked in single precision.
static ASKED: AtomicUsize = AtomicUsize::new(0);

impl<T: Real> DiscSolver<T> for Quartic {
    fn segment_disc(ends: [Vec3<T>; 2], normal: Vec3<T>, radius: T) -> Closest<T> {
        ASKED.fetch_add(usize::from(T::UNIT_ROUNDOFF > 1e-9), Ordering::Relaxed);
        if IS_BLIND.load(Ordering::Relaxed) {
            Closest { distance: radius.one() / radius.zero(), point1: ends[0], point2: ends[0] }
        } else {
            RecentredQuartic::<Companion>::segment_disc(ends, normal, radius)
        }
    }
}

#[test]
fn the_exhaustive_engine_takes_any_route_to_the_discs() {
    fn answers<T: Precision, S: DiscSolver<T> + DiscSolver<f64>>(
        mesh: &TriMesh,
        robot: &Chain,
        culling: bool,
    ) -> Vec<f64> {
        let mut engine = Exhaustive::<T, S>::with_solver(mesh).unwrap();
        engine.set_culling(culling);
        let mut out = Vec::new();
        engine.per_link(robot, &Pose::IDENTITY, &mut out).unwrap();
        assert_eq!(engine.minimum(robot, &Pose::IDENTITY).unwrap().distance, minimum(&out));
        out.iter().map(|answer| answer.distance).collect()
    }
    fn minimum(answers: &[LinkProximity]) -> f64 {
        answers.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min)
    }
    // Cylinders above a few hundred triangles, so that caps come nearest to edges.
    let mut random = Random::new(5);
    let mut point = |size: f64| random.point() * size;
    let vertices: Vec<_> = (0..900).map(|_| point(10.0)).collect();
    let indices = (0..300).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let line: Vec<_> = (0..40).map(|_| point(30.0)).collect();
    let robot = Chain::cylinders(&line, &[0.4; 39]).unwrap();
    let capsules = Chain::capsules(&line, &[0.4; 39]).unwrap();

    let expected = answers::<f64, Convex>(&mesh, &robot, true);
    let unit = UNIT * extent(&mesh, &robot);
    for culling in [false, true] {
        let by_quartic = |is_blind: bool, robot: &Chain| {
            IS_BLIND.store(is_blind, Ordering::Relaxed);
            [answers::<f64, Quartic>(&mesh, robot, culling), answers::<f32, Quartic>(&mesh, robot, culling)]
        };
        let single = answers::<f32, Convex>(&mesh, &robot, culling);
        ASKED.store(0, Ordering::Relaxed);
        for found in by_quartic(false, &robot).into_iter().chain([single]) {
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() <= 16.0 * unit, "{found} for {expected}");
            }
        }
        // A bound spares the discs in single precision, all but without culling.
        assert_eq!(ASKED.load(Ordering::Relaxed) > 0, !culling);
        // The route is what the answers come from, where a cap decides and nowhere else.
        for blind in by_quartic(true, &robot) {
            let farther =
                blind.iter().zip(&expected).filter(|(blind, right)| **blind > **right + 1e-6).count();
            assert!(farther > 0 && blind.iter().zip(&expected).all(|(b, e)| *b >= e - 16.0 * unit));
        }
        let right = answers::<f64, Convex>(&mesh, &capsules, culling);
        assert_eq!(by_quartic(true, &capsules), [right.clone(), right]);
    }
}
