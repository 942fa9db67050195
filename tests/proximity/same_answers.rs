//! Answers about tubes and motions are the same to the last bit after any earlier queries and on
//! any number of threads. Finer tolerances never give looser bounds.

use super::tube::from_function;
use continuum_demo::ventricle;
use continuum_testing::{Arcs, Random, WarmAndFresh, answered, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Clearance, Decision, Proximity, RobotPair};
use parry_continuum::{Chain, LinearMotion, RigidMotion, Tube, TubeSection};
use std::sync::Arc;

/// How many random robots: more for a search for faults.
const ROUNDS: usize = 6;

/// How much larger a scene is than one in millimetres.
const UNITS: [f64; 3] = [1.0, 1e-3, 1e-6];

/// The wall of a ventricle, or a plane that a straight tube may lie on.
fn walls(unit: f64) -> [TriMesh; 2] {
    let (vertices, indices) = ventricle::mesh(6_000);
    let scaled = vertices.iter().map(|vertex| vertex * unit).collect();
    let corners = [[-30.0, -30.0], [30.0, -30.0], [30.0, 30.0], [-30.0, 30.0]];
    let square = corners.map(|[x, z]| Vector::new(x, 0.0, z) * unit).to_vec();
    [
        TriMesh::new(scaled, indices).unwrap(),
        TriMesh::new(square, vec![[0, 1, 2], [0, 2, 3]]).unwrap(),
    ]
}

/// Sections that bend, or are straight along z.
fn arcs(random: &mut Random, unit: f64, is_straight: bool) -> Arc<Arcs> {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    for radius in [1.0, 0.7] {
        let bend = if is_straight {
            Vector::ZERO
        } else {
            random.direction() * random.between(0.0, 0.1 / unit)
        };
        let bend = bend - Vector::Z * bend.z;
        arcs.push(radius * unit, &[(random.between(1.0, 12.0) * unit, bend)]);
    }
    Arc::new(arcs)
}

/// The same curve as a function, as samples, as samples with a deviation, and as a chain.
fn tubes(random: &mut Random, arcs: &Arc<Arcs>, unit: f64) -> Vec<Tube> {
    let (points, radii) = arcs.samples(random.between(0.3, 1.0) * unit, &[]);
    let chain = Chain::cylinders(&points, &radii).unwrap();
    let fit = Tube::fit(&points, &radii, 0.01 * unit);
    let samples = Tube::from_samples(&points, &radii, None);
    [samples, fit].into_iter().flatten().chain([from_function(arcs), Tube::from(&chain)]).collect()
}

/// A pose at which the tube may touch, run along the wall, or stand on it.
fn place(random: &mut Random, mesh: &TriMesh, unit: f64, is_plane: bool) -> Pose {
    if !is_plane {
        let vertices = mesh.vertices();
        let from = vertices[random.below(vertices.len() as u32) as usize];
        return Pose::new(
            from + random.point() * (4.0 * unit),
            random.direction() * random.between(0.0, 3.0),
        );
    }
    // Beside it, touching, in it by rounding, above it.
    let height = [1.0, 1.0 + 1e-12, 1.0 - 1e-12, 1.5, 0.3][random.below(5) as usize] * unit;
    let turn =
        if random.below(2) == 0 { Vector::ZERO } else { Vector::X * -std::f64::consts::FRAC_PI_2 };
    Pose::new(Vector::new(random.unit() * unit, height, random.unit() * unit), turn)
}

#[derive(Debug, Default)]
struct Seen {
    free: usize,
    touching: usize,
    clear: usize,
    contact: usize,
}

impl Seen {
    fn take(&mut self, found: &Clearance) {
        if found.lower > 0.0 { self.free += 1 } else { self.touching += 1 }
    }
}

/// An engine that has answered small steps, other tubes and other tolerances, against one that
/// begins.
#[test]
fn earlier_queries_never_change_an_answer() {
    let (mut random, mut seen) = (Random::new(1), Seen::default());
    for round in 0..ROUNDS {
        let unit = UNITS[round % 3];
        for (is_plane, mesh) in [false, true].into_iter().zip(walls(unit)) {
            let mut both = WarmAndFresh::new(BvhSearch::new(&mesh).unwrap());
            let arcs = arcs(&mut random, unit, round % 2 == 0);
            let tubes = tubes(&mut random, &arcs, unit);
            let start = place(&mut random, &mesh, unit, is_plane);
            let step = random.direction() * ([0.02, 1e-9][round % 2] * unit);
            for k in 0..6 {
                let pose = Pose::from_translation(step * f64::from(k)) * start;
                for tube in &tubes {
                    let tolerance = [0.5, 0.03, 1e-3, 0.0][random.below(4) as usize] * unit;
                    let found = both
                        .ask("clearance", |search| search.clearance(tube, &pose, tolerance))
                        .unwrap();
                    seen.take(&found);
                    let margin = [0.0, found.lower, found.upper * 1.1][random.below(3) as usize];
                    let decided = both
                        .ask(margin, |search| search.clears_tube(tube, &pose, margin, tolerance));
                    seen.clear += usize::from(decided == Ok(Decision::Clear));
                    seen.contact += usize::from(decided == Ok(Decision::Contact));
                }
            }
        }
    }
    let all = ROUNDS * 12;
    assert!(seen.free > all && seen.touching > all / 2, "{seen:?}");
    assert!(seen.clear > all / 4 && seen.contact > all / 2, "{seen:?}");
}

#[test]
fn earlier_queries_never_change_an_answer_about_two_tubes() {
    let (mut random, mut free, mut touching) = (Random::new(2), 0, 0);
    for round in 0..2 * ROUNDS {
        let unit = UNITS[round % 3];
        let all = [0, 1].map(|k| {
            // Two straight tubes may lie side by side.
            let arcs = arcs(&mut random, unit, (round + k) % 3 == 0 || round % 4 == 0);
            tubes(&mut random, &arcs, unit)
        });
        let mut both = WarmAndFresh::new(RobotPair::new());
        let aside = [2.0, 2.0 + 1e-12, 1.9, 2.5, 6.0][round % 5] * unit;
        let turn = if round % 2 == 0 { Vector::ZERO } else { random.direction() };
        let step = random.direction() * ([0.02, 1e-9][round % 2] * unit);
        for k in 0..5 {
            let pose = Pose::new(
                Vector::new(aside, 0.0, random.unit() * unit) + step * f64::from(k),
                turn,
            );
            for (a, b) in all[0].iter().zip(&all[1]) {
                let tolerance = [0.5, 0.03, 1e-3][random.below(3) as usize] * unit;
                let here = Pose::IDENTITY;
                let found = both
                    .ask("clearance", |pair| pair.clearance(a, &here, b, &pose, tolerance))
                    .unwrap();
                if found.lower > 0.0 {
                    free += 1
                } else {
                    touching += 1
                }
                let margin = [0.0, found.lower, found.upper * 1.1][random.below(3) as usize];
                let _ = both
                    .ask(margin, |pair| pair.clears_tubes(a, &here, b, &pose, margin, tolerance));
            }
        }
    }
    assert!(free > ROUNDS * 5 && touching > ROUNDS * 5, "{free} {touching}");
}

#[test]
fn batches_answer_the_same_on_any_number_of_threads() {
    let mut random = Random::new(3);
    let [mesh, _] = walls(1.0);
    let tubes: Vec<_> = (0..ROUNDS)
        .flat_map(|round| {
            let arcs = arcs(&mut random, 1.0, round % 4 == 0);
            tubes(&mut random, &arcs, 1.0)
        })
        .collect();
    let robots: Vec<_> =
        tubes.iter().map(|tube| (tube, place(&mut random, &mesh, 1.0, false))).collect();
    let alone: Vec<_> = robots
        .iter()
        .map(|(tube, pose)| BvhSearch::new(&mesh).unwrap().clearance(tube, pose, 0.01).unwrap())
        .collect();
    for threads in [1, 2, 16] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (mut search, mut out) = (BvhSearch::new(&mesh).unwrap(), Vec::new());
        for _ in 0..2 {
            pool.install(|| search.clearance_batch(&robots, 0.01, &mut out).unwrap());
            assert_eq!(answered(&out), alone, "{threads} threads");
        }
    }
    assert!(
        alone.iter().any(|found| found.lower > 0.0) && alone.iter().any(|found| found.upper <= 0.0)
    );
}

/// The bounds of each tolerance lie within the bounds of the previous one.
#[test]
fn finer_tolerances_never_give_looser_bounds() {
    let (mut random, mut narrower) = (Random::new(4), 0);
    for round in 0..ROUNDS {
        let unit = UNITS[round % 3];
        for (is_plane, mesh) in [false, true].into_iter().zip(walls(unit)) {
            let mut search = BvhSearch::new(&mesh).unwrap();
            let arcs = arcs(&mut random, unit, round % 3 == 0);
            let pose = place(&mut random, &mesh, unit, is_plane);
            for tube in tubes(&mut random, &arcs, unit) {
                let mut tolerance = random.between(0.5, 4.0) * unit;
                let mut coarser = search.clearance(&tube, &pose, tolerance).unwrap();
                for _ in 0..14 {
                    tolerance *= [0.2, 0.5, 0.9][random.below(3) as usize];
                    let finer = search.clearance(&tube, &pose, tolerance).unwrap();
                    assert!(
                        coarser.lower <= finer.lower && finer.upper <= coarser.upper,
                        "{tolerance}: {coarser:?} {finer:?}"
                    );
                    narrower +=
                        usize::from(finer.upper - finer.lower < coarser.upper - coarser.lower);
                    coarser = finer;
                }
            }
        }
    }
    assert!(narrower > 2 * ROUNDS, "{narrower}");
}

/// Two helices with one axis are as near all along: more pieces than a query divides are near.
#[test]
fn a_double_helix_is_bounded_the_closer_the_finer_the_tolerance() {
    const TURNS: f64 = 6.0;
    let helix = |phase: f64| {
        let (radius, rise) = (4.0_f64, 0.5_f64);
        let speed = radius.hypot(rise);
        let at = move |s: f64| {
            let (sin, cos) = (s / speed + phase).sin_cos();
            let point = Vector::new(radius * cos, radius * sin, rise * s / speed);
            (point, Vector::new(-radius * sin, radius * cos, rise) / speed)
        };
        let length = TURNS * std::f64::consts::TAU * speed;
        let section = TubeSection { length, radius: 0.3, curvature: radius / (speed * speed) };
        Tube::from_function(&[section], at).unwrap()
    };
    let (a, b) = (helix(0.0), helix(std::f64::consts::PI));
    let mut pair = RobotPair::new();
    let mut coarser: Option<[f64; 2]> = None;
    for tolerance in [0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6] {
        let found = pair.clearance(&a, &Pose::IDENTITY, &b, &Pose::IDENTITY, tolerance).unwrap();
        let [lower, upper] = coarser.unwrap_or([0.0, f64::INFINITY]);
        assert!(
            lower <= found.lower && found.upper <= upper,
            "{tolerance}: {found:?} in {coarser:?}"
        );
        assert!(found.upper - found.lower <= tolerance.max(0.01), "{tolerance}: {found:?}");
        coarser = Some([found.lower, found.upper]);
    }
}

/// A tube whose samples do not show how near one part is, and which touches with another.
#[test]
fn a_contact_is_found_before_a_resolution_is_refused() {
    let [mesh, _] = walls(1.0);
    let mut search = BvhSearch::new(&mesh).unwrap();
    let (mut random, mut touching, mut refused) = (Random::new(5), 0, 0);
    for _ in 0..rounds(3000) {
        let curve = arcs(&mut random, 1.0, false);
        // Few samples leave much open.
        let (points, radii) = curve.samples(curve.length() / 8.0, &[]);
        let Ok(tube) = Tube::from_samples(&points, &radii, None) else { continue };
        let pose = place(&mut random, &mesh, 1.0, false);
        let found = search.clearance(&tube, &pose, 1e-3).unwrap();
        let decided = search.clears_tube(&tube, &pose, 0.0, 1e-4);
        if found.upper <= 0.0 {
            touching += 1;
            assert_eq!(decided, Ok(Decision::Contact), "{found:?}");
        }
        refused += usize::from(decided.is_err());
    }
    assert!(touching > rounds(1000) && refused > 0, "{touching} {refused}");
}

#[test]
fn earlier_queries_never_change_an_answer_about_a_motion() {
    let (mut random, mut clear, mut contact) = (Random::new(6), 0, 0);
    let [mesh, _] = walls(1.0);
    let mut both = WarmAndFresh::new(BvhSearch::new(&mesh).unwrap());
    for round in 0..ROUNDS {
        let arcs = arcs(&mut random, 1.0, round % 2 == 0);
        let (points, radii) = arcs.samples(1.0, &[]);
        let start = place(&mut random, &mesh, 1.0, false);
        let at: Vec<_> = points.iter().map(|point| start * *point).collect();
        let to: Vec<_> = at.iter().map(|point| point + random.point()).collect();
        let linear = LinearMotion::chain(&at, &to, &radii).unwrap();
        let end = Pose::from_translation(random.point()) * start;
        let rigid = RigidMotion::new(from_function(&arcs), [start, end]).unwrap();
        let found = both.ask("motion", |search| search.clearance_of_motion(&linear, 0.05)).unwrap();
        for margin in [0.0, 0.5 * found.lower, 0.3] {
            let decided = both.ask(margin, |search| search.clears_motion(&rigid, margin, 0.01));
            clear += usize::from(decided.as_ref().is_ok_and(|answer| answer.is_clear()));
            contact +=
                usize::from(decided.is_ok_and(|answer| answer.decision == Decision::Contact));
        }
        // Another question between.
        both.warm.clearance(&from_function(&arcs), &start, 0.1).unwrap();
        both.warm.minimum(&Chain::cylinders(&at, &radii).unwrap(), &Pose::IDENTITY).unwrap();
    }
    assert!(clear > 0 && contact > ROUNDS / 2, "{clear} {contact}");
}
