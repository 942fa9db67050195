//! Tubes against the truth: a chain so fine that its own error does not matter.

use continuum_demo::ctr::{self, Robot};
use continuum_demo::ventricle;
use continuum_testing::{Arcs, Random, Stretch, rounds};
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Certificate, Clearance, Decision, Exhaustive, PlacementFault, Proximity,
    ProximityError, Witness,
};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, RigidMotion, RobotError, Tube, TubeSection,
};
use std::sync::Arc;

fn anatomy() -> TriMesh {
    let (vertices, indices) = ventricle::mesh(6_000);
    TriMesh::new(vertices, indices).unwrap()
}

/// A concentric tube robot, whose sections out share one curvature each where the tubes inside do
/// not end.
fn concentric(robot: &Robot, random: &mut Random) -> Arcs {
    let reach = [0.15, 0.3, 0.6][random.below(3) as usize];
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    for section in &robot.sections {
        let length = section.length * reach * random.between(0.02, 1.0);
        let bend =
            |share: f64, angle: f64| Vector::new(angle.cos(), angle.sin(), 0.0) * (0.0522 * share);
        let parts = 1 + random.below(2);
        let part = length / f64::from(parts);
        let all: Vec<_> =
            (0..parts).map(|_| (part, bend(random.unit(), random.between(0.0, 6.3)))).collect();
        arcs.push(section.radius, &all);
    }
    arcs
}

/// The model of a chain: Algorithm 1, or cylinders.
pub(super) type Model = fn(&[Vector], &[f64]) -> Result<Chain, RobotError>;

/// Within 1e-5 of the tube, at the size of these scenes. Towards flat ends its links become
/// shorter, since the rim of a tilted one would stick out. A link of length l at s behind a face
/// sticks out if l k r / 2 > s (1 - k r), with the curvature k and the radius r. So l = 0.08 s is
/// enough up to k r = 0.96, and halves, l = s, only up to 2 / 3.
pub(super) fn fine(arcs: &Arcs, model: Model) -> Chain {
    let sharpest = arcs.stretches.iter().fold(1e-3, |most: f64, part| most.max(part.curvature));
    let spacing = (40e-6 / sharpest).sqrt();
    // From 12.5 spacings on, the spacing itself is 0.08 s or less.
    let off = |k: i32| 12.5 * spacing * 0.925_f64.powi(k);
    let at_ends: Vec<_> = (1..250).map(off).filter(|off| *off > 1e-6).collect();
    let (points, radii) = arcs.samples(spacing, &at_ends);
    model(&points, &radii).unwrap()
}

fn sections(arcs: &Arcs) -> Vec<TubeSection> {
    let section = |&Stretch { length, radius, curvature }: &Stretch| TubeSection {
        length,
        radius,
        curvature,
    };
    arcs.stretches.iter().map(section).collect()
}

pub(super) fn from_function(arcs: &Arc<Arcs>) -> Tube {
    let curve = Arc::clone(arcs);
    let tube = Tube::from_function(&sections(arcs), move |s| curve.at(s)).unwrap();
    tube.verify(50).unwrap();
    tube
}

/// The tube as a function, and from samples with and without the tangents at its ends, and as they
/// come from where sections have end points and radii of their own: at least four in each arc, and
/// no farther apart than a third of the smallest radius of curvature.
pub(super) fn all_ways(arcs: &Arc<Arcs>) -> [Tube; 4] {
    let sharpest = arcs.stretches.iter().fold(1e-3, |most: f64, part| most.max(part.curvature));
    let (points, radii) = arcs.samples((arcs.shortest() / 4.0).min(0.2).min(0.3 / sharpest), &[]);
    [
        from_function(arcs),
        Tube::from_samples(&points, &radii, Some(arcs.end_tangents())).unwrap(),
        Tube::from_samples(&points, &radii, None).unwrap(),
        as_computed(&points, &radii),
    ]
}

/// Some points twice, as far apart as rounding puts what is computed in two ways, and radii that
/// differ in their last digits.
fn as_computed(points: &[Vector], radii: &[f64]) -> Tube {
    let reach = points.iter().fold(0.0, |most: f64, point| most.max(point.abs().max_element()));
    let mut random = Random::new(points.len() as u64);
    let (mut all, mut all_radii) = (vec![], vec![]);
    for (k, &point) in points.iter().enumerate() {
        all.push(point);
        let rounded =
            |random: &mut Random, k: usize| radii[k] * (1.0 + 1e-13 * random.between(-1.0, 1.0));
        if random.below(5) == 0 || k + 1 == points.len() {
            all.push(point + random.point() * (4.0 * f64::EPSILON * reach));
            all_radii.push(random.unit());
        }
        if k < radii.len() {
            all_radii.push(rounded(&mut random, k));
        }
    }
    Tube::from_samples(&all, &all_radii, None).unwrap()
}

#[derive(Debug, Default)]
struct Seen {
    free: usize,
    touching: usize,
    decisions: usize,
    undecided: usize,
    too_fine: usize,
}

/// Asks all that there is to ask of one shape.
fn judge(search: &mut BvhSearch, arcs: &Arc<Arcs>, model: Model, base: &Pose, seen: &mut Seen) {
    let truth = search.minimum(&fine(arcs, model), base).unwrap().distance;
    for (way, tube) in all_ways(arcs).iter().enumerate() {
        for tolerance in [1.0, 0.1, 0.01, 0.003] {
            let found = search.clearance(tube, base, tolerance).unwrap();
            // Samples leave the direction of a face open where the curvature changes next to it.
            assert!(found.resolved || way > 0, "way {way}, {tolerance} of {:?}", arcs.stretches);
            seen.too_fine += usize::from(!found.resolved);
            let Clearance { lower, upper, witness, .. } = found;
            let Witness { on_robot, on_mesh, arc_length, .. } = witness;
            assert!(
                lower <= truth + 1e-5 && truth <= upper + 1e-5,
                "way {way}: {truth} in {found:?}"
            );
            assert_eq!(found.resolved, upper - lower <= tolerance);
            assert!((on_robot - on_mesh).length() <= upper + 1e-9, "{found:?}");
            assert!(upper > 0.0 || on_robot == on_mesh);
            assert!((0.0..=tube.length() + 1e-9).contains(&arc_length));
        }
        for off in [-0.1, -0.003, -3e-4, 3e-4, 0.003, 0.1] {
            let margin = truth + off;
            if margin < 0.0 {
                continue;
            }
            seen.decisions += 1;
            match search.clears_tube(tube, base, margin, 0.002) {
                Ok(Decision::Undecided) => {
                    assert!(off.abs() <= 0.002 + 1e-5, "way {way}: undecided at {off} of {truth}");
                    seen.undecided += 1;
                }
                Ok(decision) => {
                    let right = if off < 0.0 { Decision::Clear } else { Decision::Contact };
                    assert_eq!(
                        decision, right,
                        "way {way}: {margin} of {truth}, {:?}",
                        arcs.stretches
                    );
                }
                Err(ProximityError::ToleranceTooFine { .. }) if way > 0 => seen.too_fine += 1,
                Err(error) => panic!("{error}: way {way}"),
            }
        }
    }
    if truth > 0.0 { seen.free += 1 } else { seen.touching += 1 }
}

fn judge_concentric_tube_robots(rounds: usize) {
    let (mut search, base, robot) =
        (BvhSearch::new(&anatomy()).unwrap(), ventricle::entry(), ctr::three_tubes());
    let (mut random, mut seen) = (Random::new(1), Seen::default());
    for _ in 0..rounds {
        judge(
            &mut search,
            &Arc::new(concentric(&robot, &mut random)),
            Chain::from_centreline,
            &base,
            &mut seen,
        );
    }
    assert!(
        seen.free > rounds / 8 && seen.touching > rounds / 8 && seen.decisions > 10 * rounds,
        "{seen:?}"
    );
    assert!(seen.too_fine < rounds / 4 && seen.undecided < seen.decisions / 4, "{seen:?}");
}

/// Hairpins whose radius of curvature is little more than their own, loops, sections shorter than
/// they are thick.
fn judge_curves_of_any_kind(rounds: usize) {
    let mesh = anatomy();
    let mut search = BvhSearch::new(&mesh).unwrap();
    let (mut random, mut seen, mut sharp, mut short) = (Random::new(2), Seen::default(), 0, 0);
    for _ in 0..rounds {
        let from = mesh.vertices()[random.below(mesh.vertices().len() as u32) as usize];
        let frame =
            Pose::new(from + random.point() * 3.0, random.direction() * random.between(0.0, 3.0));
        let arcs = Arc::new(Arcs::random(&mut random, frame, 0.6));
        sharp += usize::from(arcs.stretches.iter().any(|part| part.curvature * part.radius > 0.5));
        short += usize::from(arcs.stretches.iter().any(|part| part.length < part.radius));
        // Round joints of a finely divided chain stick out of a flat end by up to curvature^2
        // radius^3 / 8.
        judge(&mut search, &arcs, Chain::cylinders, &Pose::IDENTITY, &mut seen);
    }
    assert!(
        seen.free > rounds / 8 && seen.touching > rounds / 8 && seen.decisions > 10 * rounds,
        "{seen:?}"
    );
    assert!(
        sharp > rounds / 8 && short > rounds / 8 && seen.undecided < seen.decisions / 4,
        "{sharp} {short} {seen:?}"
    );
}

#[test]
fn concentric_tube_robots_are_never_misjudged() {
    judge_concentric_tube_robots(rounds(900));
}

#[test]
fn curves_of_any_kind_are_never_misjudged() {
    judge_curves_of_any_kind(rounds(900));
}

/// A chain is a tube whose pieces are straight: the bounds differ by rounding, for all tolerances.
#[test]
fn chains_are_tubes_of_straight_pieces() {
    let (mut search, base, robot) =
        (BvhSearch::new(&anatomy()).unwrap(), ventricle::entry(), ctr::three_tubes());
    let (mut random, mut free) = (Random::new(3), 0);
    for _ in 0..rounds(300) {
        let (points, radii) = concentric(&robot, &mut random).samples(2.0, &[]);
        let chain = match random.below(3) {
            0 => Chain::capsules(&points, &radii),
            1 => Chain::cylinders(&points, &radii),
            _ => Chain::from_centreline(&points, &radii),
        }
        .unwrap();
        let tube = Tube::from(&chain);
        let truth = search.minimum(&chain, &base).unwrap().distance;
        let found = search.clearance(&tube, &base, 0.0).unwrap();
        assert!(found.lower <= truth && truth <= found.upper, "{truth} in {found:?}");
        assert!(found.upper - found.lower <= 1e-10, "{found:?}");
        for margin in [0.0, truth - 1e-9, truth + 1e-9].into_iter().filter(|margin| *margin >= 0.0)
        {
            let right = if truth > margin { Decision::Clear } else { Decision::Contact };
            assert_eq!(
                search.clears_tube(&tube, &base, margin, 1e-10).unwrap(),
                right,
                "{truth} {margin}"
            );
        }
        free += usize::from(truth > 0.0);
    }
    assert!(free > rounds(30) && free < rounds(270));
}

/// Rounding turns the body around a piece at a face, and turns shorter pieces more.
#[test]
fn links_as_short_as_rounding_keep_their_faces() {
    let mut random = Random::new(11);
    let (mut shortest, mut apart) = (0, 0);
    for round in 0..4000 {
        let length = 10.0_f64.powf(random.between(-16.0, -1.0));
        let start = random.point();
        let (end, radius) = (start + random.direction() * length, random.between(0.01, 1.0));
        let Ok(chain) = Chain::cylinders(&[start, end], &[radius]) else { continue };
        // A point, which the rim of a disc is mostly nearest to, or a triangle.
        let point = random.point() * 3.0;
        let corners = if round % 2 == 0 {
            [point; 3]
        } else {
            [point, random.point() * 3.0, random.point() * 3.0]
        };
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
        let mut search = BvhSearch::new(&mesh).unwrap();
        let truth = Certificate::between(&chain.links()[0], &Pose::IDENTITY, corners).unwrap();
        let found = search.clearance(&Tube::from(&chain), &Pose::IDENTITY, 1e-6).unwrap();
        shortest += u32::from(length < 1e-13);
        apart += u32::from(found.lower > 0.1);
        assert!(found.lower <= truth.upper, "{found:?} {truth:?} {chain:?} {corners:?}");
        assert!(truth.lower <= found.upper, "{found:?} {truth:?} {chain:?} {corners:?}");
    }
    assert!(shortest > 500 && apart > 2000, "{shortest} {apart}");
}

#[test]
fn batches_answer_as_single_queries_do() {
    let (mut search, base, robot) =
        (BvhSearch::new(&anatomy()).unwrap(), ventricle::entry(), ctr::three_tubes());
    let mut random = Random::new(4);
    let tubes: Vec<_> =
        (0..40).map(|_| from_function(&Arc::new(concentric(&robot, &mut random)))).collect();
    let robots: Vec<_> = tubes.iter().map(|tube| (tube, base)).collect();
    let (mut clearances, mut decisions) = (Vec::new(), Vec::new());
    search.clearance_batch(&robots, 0.01, &mut clearances).unwrap();
    search.clears_tube_batch(&robots, 0.3, 0.01, &mut decisions).unwrap();
    for ((tube, found), decision) in tubes.iter().zip(&clearances).zip(&decisions) {
        let found = found.as_ref().unwrap();
        let alone = search.clearance(tube, &base, 0.01).unwrap();
        assert!(found.lower <= alone.upper && alone.lower <= found.upper, "{found:?} {alone:?}");
        assert!(found.upper - found.lower <= 0.01);
        assert_eq!(*decision, search.clears_tube(tube, &base, 0.3, 0.01));
    }
    assert!(decisions.contains(&Ok(Decision::Clear)) && decisions.contains(&Ok(Decision::Contact)));
    assert_eq!(
        search.clearance_batch(&robots, -1.0, &mut clearances),
        Err(ProximityError::Negative { parameter: "tolerance", value: -1.0 })
    );
    assert!(clearances.is_empty());
}

/// A tube that is refused costs the others of its batch nothing.
#[test]
fn each_tube_of_a_batch_has_a_result_of_its_own() {
    let mut search = BvhSearch::new(&anatomy()).unwrap();
    let good =
        Tube::from_samples(&[Vector::ZERO, Vector::Z, Vector::Z * 2.0], &[0.1; 2], None).unwrap();
    let base = ventricle::entry();
    let far = Pose::from_translation(Vector::X * 1e151);
    let (mut clearances, mut decisions) = (Vec::new(), Vec::new());
    let (alone, decision) =
        (search.clearance(&good, &base, 0.01), search.clears_tube(&good, &base, 0.1, 0.01));
    for round in 0..40 {
        let mut robots: Vec<_> = (0..64).map(|_| (&good, base)).collect();
        robots[20 + round] = (&good, far);
        search.clearance_batch(&robots, 0.01, &mut clearances).unwrap();
        search.clears_tube_batch(&robots, 0.1, 0.01, &mut decisions).unwrap();
        for place in 0..64 {
            let (found, decided) = (&clearances[place], &decisions[place]);
            if place == 20 + round {
                assert!(
                    matches!(
                        found,
                        Err(ProximityError::Pose(PlacementFault::TubeOutOfRange { .. }))
                    ),
                    "{found:?}"
                );
                assert!(
                    matches!(
                        decided,
                        Err(ProximityError::Pose(PlacementFault::TubeOutOfRange { .. }))
                    ),
                    "{decided:?}"
                );
            } else {
                let (found, alone) = (found.as_ref().unwrap(), alone.as_ref().unwrap());
                assert!(
                    found.lower <= alone.upper && alone.lower <= found.upper,
                    "{found:?} {alone:?}"
                );
                assert_eq!(*decided, decision);
            }
        }
    }
}

/// The directions that a function gives may have any length: the answer is the same to the last
/// bit.
#[test]
fn directions_of_any_length_will_do() {
    let (mut search, base, robot) =
        (BvhSearch::new(&anatomy()).unwrap(), ventricle::entry(), ctr::three_tubes());
    let mut random = Random::new(6);
    for _ in 0..rounds(50) {
        let arcs = Arc::new(concentric(&robot, &mut random));
        let mut ask = |length: f64| {
            let curve = Arc::clone(&arcs);
            let scaled = move |s| {
                let (point, direction) = curve.at(s);
                (point, direction * length)
            };
            let tube = Tube::from_function(&sections(&arcs), scaled).unwrap();
            search.forget();
            search.clearance(&tube, &base, 1e-4).unwrap()
        };
        let unit = ask(1.0);
        for length in [1.0 / 1024.0, 32.0] {
            assert_eq!(ask(length), unit);
        }
    }
}

/// A stated error of the centreline widens the bounds by at least that error, which is not part of
/// the tolerance.
#[test]
fn stated_errors_count() {
    let (mut search, base, robot) =
        (BvhSearch::new(&anatomy()).unwrap(), ventricle::entry(), ctr::three_tubes());
    let (mut random, mut free) = (Random::new(5), 0);
    for _ in 0..rounds(240) {
        let arcs = Arc::new(concentric(&robot, &mut random));
        let exact = search.clearance(&from_function(&arcs), &base, 1e-4).unwrap();
        let rough = from_function(&arcs).with_error(0.05).unwrap();
        let found = search.clearance(&rough, &base, 0.3).unwrap();
        assert!(found.lower <= (exact.lower - 0.05).max(0.0) + 1e-4);
        assert!(
            exact.upper <= 0.0 || found.upper >= exact.lower + 0.05 - 1e-4,
            "{exact:?} {found:?}"
        );
        if exact.lower > 0.1 {
            free += 1;
            let fine = search.clearance(&rough, &base, 0.05).unwrap();
            assert!(fine.resolved && fine.upper - fine.lower >= 0.1 - 1e-9, "{fine:?}");
            assert!(fine.upper - fine.lower <= 0.05 + fine.uncertainty, "{fine:?}");
            assert!((fine.uncertainty - 0.1).abs() < 1e-12, "{fine:?}");
        }
    }
    assert!(free >= rounds(5));
}

/// New samples do not make the sensor better.
#[test]
fn a_stated_error_outlives_new_samples() {
    let mut search = BvhSearch::new(&anatomy()).unwrap();
    let points: Vec<_> = (0..50).map(|k| Vector::new(0.0, 0.0, f64::from(k) * 0.1)).collect();
    let mut tube = Tube::from_samples(&points, &[0.1; 49], None).unwrap().with_error(0.5).unwrap();
    let far = Pose::from_translation(Vector::X * 1000.0);
    // Without the error the bounds would be as close as rounding allows.
    let width = |found: Clearance| found.upper - found.lower;
    assert!(width(search.clearance(&tube, &far, 0.4).unwrap()) >= 1.0 - 1e-9);
    tube.set_samples(&points, &[0.1; 49], None).unwrap();
    assert!(width(search.clearance(&tube, &far, 0.4).unwrap()) >= 1.0 - 1e-9);
}

#[test]
fn a_tube_that_cannot_be_asked_about_is_refused() {
    let mut search = BvhSearch::new(&anatomy()).unwrap();
    let section = TubeSection { length: 10.0, radius: 1.0, curvature: 0.01 };
    let broken = Tube::from_function(&[section], |s| {
        let x = if (0.5..9.5).contains(&s) { f64::NAN } else { 0.0 };
        (Vector::new(x, 0.0, s), Vector::Z)
    })
    .unwrap();
    let base = ventricle::entry();
    let refused = search.clearance(&broken, &base, 0.01);
    assert!(matches!(refused, Err(ProximityError::CurveNotFinite { .. })), "{refused:?}");
    let refused = search.clears_tube(&broken, &base, 0.01, 0.1);
    assert!(matches!(refused, Err(ProximityError::CurveNotFinite { .. })), "{refused:?}");
    assert!(matches!(broken.verify(10), Err(RobotError::CurveNotFinite { .. })));

    let mut tube = Tube::from_samples(&[Vector::ZERO, Vector::Z], &[0.1], None).unwrap();
    for (pose, margin, resolution) in [
        (Pose::from_translation(Vector::splat(f64::NAN)), 1.0, 0.1),
        (Pose::from_translation(Vector::splat(1e151)), 1.0, 0.1),
        (Pose::IDENTITY, -1.0, 0.1),
        (Pose::IDENTITY, f64::NAN, 0.1),
        (Pose::IDENTITY, 1.0, -0.1),
        (Pose::IDENTITY, 1.0, f64::NAN),
    ] {
        assert!(search.clears_tube(&tube, &pose, margin, resolution).is_err());
    }
    // Samples that are refused leave the tube as it was.
    search.forget();
    let before = search.clearance(&tube, &Pose::IDENTITY, 0.1).unwrap();
    assert!(tube.set_samples(&[Vector::ZERO, Vector::X * f64::NAN], &[0.1], None).is_err());
    assert!(tube.set_samples(&[Vector::ZERO; 3], &[0.1; 2], None).is_err());
    search.forget();
    assert_eq!(search.clearance(&tube, &Pose::IDENTITY, 0.1), Ok(before));
}

/// The error that is stated is that of every point, rims of flat faces among them.
#[test]
fn a_robot_that_is_off_by_the_stated_error_is_within_the_bounds() {
    let (mut random, mut near, mut apart) = (Random::new(6), 0, 0);
    for _ in 0..rounds(400) {
        let (length, radius) = (random.between(2.0, 20.0), random.between(0.5, 2.0));
        let curvature = random.between(0.0, 0.3) / radius;
        let arc = move |s: f64| {
            let (sin, cos) = (curvature * s).sin_cos();
            (Vector::new(1.0 - cos, 0.0, sin) / curvature, Vector::new(sin, 0.0, cos))
        };
        let tube = Tube::from_function(&[TubeSection { length, radius, curvature }], arc).unwrap();
        // The robot itself, turned about a place of the curve and moved.
        let (centre, turn) =
            (arc(random.unit() * length).0, random.direction() * random.between(0.0, 0.05));
        let turned = Pose::from_parts(Vector::ZERO, Pose::new(Vector::ZERO, turn).rotation);
        let shift = random.direction() * random.between(0.0, 0.2);
        let own = Pose::from_translation(centre + shift) * turned * Pose::from_translation(-centre);
        let off =
            (0..=64).map(|k| arc(length * f64::from(k) / 64.0).0).map(|p| (own * p - p).length());
        let error = 1.001 * off.fold(0.0, f64::max) + radius * turn.length();
        // A wall near the tip, across or aslant.
        let (tip, normal) = arc(length);
        let normal = (normal + random.direction() * random.between(0.0, 0.7)).normalize();
        let aside = normal.cross(random.direction()).normalize();
        let middle = tip + normal * random.between(0.0, 12.0) * error;
        let corners =
            [aside * 9.0, normal.cross(aside) * 9.0, -(aside + normal.cross(aside)) * 9.0];
        let wall =
            TriMesh::new(corners.map(|corner| middle + corner).to_vec(), vec![[0, 1, 2]]).unwrap();
        let mut search = BvhSearch::new(&wall).unwrap();
        let truth = search.clearance(&tube, &own, 1e-3).unwrap();
        let doubtful = tube.with_error(error).unwrap();
        let found = search.clearance(&doubtful, &Pose::IDENTITY, 6.0 * error + 1e-3).unwrap();
        apart += usize::from(found.lower > 0.0);
        assert!(
            found.lower <= truth.upper && truth.lower <= found.upper,
            "{found:?} {truth:?} {error}"
        );
        let cleared = search.clears_tube(&doubtful, &Pose::IDENTITY, truth.upper, 1e-3);
        assert!(!matches!(cleared, Ok(Decision::Clear)), "{truth:?} {error}");
        near += usize::from(0.0 < truth.lower && truth.lower < 2.0 * error);
    }
    assert!(near > rounds(30) && apart > rounds(100), "{near} {apart}");
}

/// A rotation that was rounded to single precision is no scale.
#[test]
fn a_pose_of_single_precision_keeps_lengths() {
    let tube = Tube::from(&Chain::cylinders(&[Vector::ZERO, 5.0 * Vector::Z], &[1.0]).unwrap());
    let corners =
        [[-99.0, -99.0], [99.0, -99.0], [0.0, 99.0]].map(|[x, y]| Vector::new(x, y, 15.0));
    let mut search =
        BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    for w in [1.0, 0.99999994, 1.0000001] {
        let pose = Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(0.0, 0.0, 0.0, w));
        let found = search.clearance(&tube, &pose, 1e-9).unwrap();
        assert!(found.lower <= 10.0 && 10.0 <= found.upper, "{w}: {found:?}");
    }
}

/// One rule for all: rounding of single precision is made good, and any other length of a
/// quaternion is refused, however large or small; chains, tubes, certificates and motions agree.
#[test]
fn rotations_that_scale_are_refused_by_all() {
    let chain =
        Chain::cylinders(&[Vector::new(1e3, -700.0, 0.0), Vector::new(1e3, -700.0, 5.0)], &[1.0])
            .unwrap();
    let tube = Tube::from(&chain);
    let corners = [[-9e3, -9e3], [9e3, -9e3], [0.0, 9e3]].map(|[x, y]| Vector::new(x, y, 2500.0));
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let (mut search, mut all) =
        (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f64>::new(&mesh).unwrap());
    let mut random = Random::new(8);
    let posed = |q: Rotation| Pose::from_parts(Vector::new(1.0, 2.0, 3.0), q);
    let still = |pose: Pose| {
        let bent = BendingSection { length: 5.0, radius: 1.0, bend: [0.0, 0.1] };
        let bending = BendingMotion::new(&[bent], &[bent], pose).map(|_| ());
        [bending, RigidMotion::new(tube.clone(), [Pose::IDENTITY, pose]).map(|_| ())]
    };
    for round in 0..300 {
        let unit = random.pose(0.0).rotation;
        let exact = search.minimum(&chain, &posed(unit)).unwrap();
        // Rounded to single precision, or as wrong as a few products in it.
        let rounded = unit.to_array().map(|c| f64::from(c as f32));
        let rounded = if round % 2 == 0 {
            Rotation::from_array(rounded)
        } else {
            unit * (1.0 + 9e-7 * random.between(-1.0, 1.0))
        };
        let pose = posed(rounded);
        let found = search.minimum(&chain, &pose).unwrap();
        // A turn by 2e-7, but no scale, which would be 1e-3 and more.
        assert!(
            (found.distance - exact.distance).abs() < if round % 2 == 0 { 1e-3 } else { 1e-9 },
            "{found:?} {exact:?}"
        );
        assert_eq!(all.minimum(&chain, &pose).unwrap(), found);
        let certificate = found.certify(&chain, &pose, &mesh).unwrap();
        assert!(
            certificate.lower <= found.distance * (1.0 + 1e-12)
                && found.distance <= certificate.upper * (1.0 + 1e-12)
        );
        let bounds = search.clearance(&tube, &pose, 1e-9).unwrap();
        assert!(
            bounds.lower <= found.distance && found.distance <= bounds.upper,
            "{bounds:?} {found:?}"
        );
        assert!(still(pose).iter().all(Result::is_ok));
        for length in [0.0, 1e-162, 1e-155, 0.5, 1.0 - 1e-5, 1.0 + 1e-5, 3.0, 1e155, 1e300] {
            let pose = posed(unit * length);
            let is_refused = |error: ProximityError| matches!(error, ProximityError::Pose(PlacementFault::PoseNotRigid { length: told }) if (told - length).abs() <= 1e-12 * length);
            assert!(is_refused(search.minimum(&chain, &pose).unwrap_err()), "{length}");
            assert!(is_refused(search.clears_inside(&chain, &pose, 1.0).unwrap_err()), "{length}");
            assert!(is_refused(all.minimum(&chain, &pose).unwrap_err()), "{length}");
            assert!(is_refused(search.clearance(&tube, &pose, 1.0).unwrap_err()), "{length}");
            assert!(
                is_refused(search.clears_tube(&tube, &pose, 1.0, 1.0).unwrap_err()),
                "{length}"
            );
            assert!(is_refused(found.certify(&chain, &pose, &mesh).unwrap_err()), "{length}");
            assert!(
                still(pose).iter().all(|made| matches!(made, Err(RobotError::PoseNotRigid { .. }))),
                "{length}"
            );
        }
    }
}
