//! How near motions come, against their shapes in fine steps.

use super::{Steps, anatomy, polyline, random_edge};
use continuum_demo::ctr;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, MotionClearance, ProximityError};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, DisplacementBound, LinearMotion, Motion, MotionPath,
    MovingBase, RigidMotion, RobotError, Speed, Tube,
};
use std::cell::Cell;

/// A motion that counts its shapes.
pub(super) struct Counted<'a, M: ?Sized>(&'a M, Cell<u64>);

impl<'a, M: ?Sized> Counted<'a, M> {
    pub(super) fn new(motion: &'a M) -> Self {
        Self(motion, Cell::new(0))
    }

    pub(super) fn count(&self) -> u64 {
        self.1.get()
    }
}

impl<M: Motion + ?Sized> Motion for Counted<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.1.set(self.1.get() + 1);
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        self.0.displacement(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        self.0.time_parts()
    }
}

#[derive(Debug, Default)]
struct Judged {
    resolved: usize,
    touching: usize,
    within: usize,
    of: usize,
    shapes: u64,
}

/// Compares the bounds of a motion with its shapes in this many steps.
fn judge(
    search: &mut BvhSearch,
    motion: &impl Motion,
    steps: usize,
    tolerance: Real,
    judged: &mut Judged,
) {
    let counted = Counted::new(motion);
    let least: MotionClearance = search.clearance_of_motion(&counted, tolerance).unwrap();
    let shape = |t: Real| {
        let mut tube = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap());
        let pose = motion.shape(t, &mut tube).unwrap();
        (tube, pose)
    };
    // The shape that is named realises the upper bound.
    let (tube, pose) = shape(least.t);
    let at = search.clearance(&tube, &pose, 1e-7).unwrap();
    assert!(at.lower <= least.upper + 1e-9, "{at:?}, {least:?}");
    assert!(
        (least.witness.on_robot - least.witness.on_mesh).length() <= least.upper + 1e-9,
        "{least:?}"
    );
    // No shape is nearer than the lower one.
    let truth = Steps::new(search, steps, 1e-3 * tolerance.max(1e-4), shape);
    let [lower, upper] = truth.least();
    assert!(least.lower <= upper, "{least:?} but {lower} to {upper}");
    assert!(0.0 <= least.lower && least.lower <= least.upper);
    if least.resolved {
        judged.resolved += 1;
        assert!(least.upper - least.lower <= tolerance + least.uncertainty);
        assert!(least.upper <= upper + tolerance, "{least:?} but {lower} to {upper}");
    }
    judged.touching += usize::from(least.upper <= 0.0);
    judged.within += usize::from(least.upper < 1.0);
    judged.of += 1;
    judged.shapes += counted.count();
}

#[test]
fn bounds_hold_for_edges_of_a_planner() {
    edges(rounds(90), 21);
}

fn edges(count: usize, seed: u64) {
    let (mut search, robot, mut random) = (anatomy(), ctr::three_tubes(), Random::new(seed));
    let mut judged = Judged::default();
    for round in 0..count {
        let distance = [0.5, 1.0, 2.0, 5.0, 10.0][round % 5];
        let motion = random_edge(&robot, &mut random, distance);
        judge(&mut search, &motion, 200, [1e-3, 0.01, 0.1][round % 3], &mut judged);
    }
    println!("{judged:?}");
    assert!(
        judged.resolved == judged.of
            && 10 * judged.touching > count
            && 10 * judged.touching < 9 * count,
        "{judged:?}"
    );
}

#[test]
fn bounds_hold_for_bases_that_move_and_for_chains() {
    bases_and_chains(rounds(60), 22);
}

/// Four times as many motions.
fn bases_and_chains(count: usize, seed: u64) {
    let (mut search, mut random) = (anatomy(), Random::new(seed));
    let [mut bases, mut chains, mut rigid, mut paths] = [0; 4].map(|_: i32| Judged::default());
    for round in 0..count {
        let near = search_vertex(&mut random, &search) + random.point() * 6.0;
        let tolerance = [1e-3, 0.01, 0.1][round % 3];
        let mut bent = || {
            let mut bend = || random.between(-0.2, 0.2);
            let bends = [bend(), bend()];
            BendingSection { length: random.between(1.0, 6.0), radius: 0.4, bend: bends }
        };
        let [from, to] = [0; 2].map(|_| [bent(), bent()]);
        let inner = BendingMotion::new(&from, &to, Pose::IDENTITY).unwrap();
        let turn = random.direction() * random.between(0.0, 2.0);
        let start = Pose::new(near, turn);
        let end = Pose::new(
            near + random.point() * 2.0,
            turn + random.direction() * random.between(0.0, 0.5),
        );
        let base = MovingBase::new(inner.clone(), [start, end]).unwrap();
        judge(&mut search, &base, 200, tolerance, &mut bases);
        let mut tube = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap());
        inner.shape(0.3, &mut tube).unwrap();
        judge(
            &mut search,
            &RigidMotion::new(tube, [start, end]).unwrap(),
            200,
            tolerance,
            &mut rigid,
        );
        let (from, radii) = polyline(&mut random, near);
        let shift = random.direction() * random.between(0.0, 3.0);
        let to: Vec<_> = from.iter().map(|&point| point + shift + random.point() * 0.5).collect();
        let on: Vec<_> = to.iter().map(|&point| point + random.point()).collect();
        let motion = if round % 2 == 0 { LinearMotion::capsules } else { LinearMotion::chain };
        judge(&mut search, &motion(&from, &to, &radii).unwrap(), 200, tolerance, &mut chains);
        let legs = vec![motion(&from, &to, &radii).unwrap(), motion(&to, &on, &radii).unwrap()];
        judge(&mut search, &MotionPath::new(legs).unwrap(), 200, tolerance, &mut paths);
    }
    println!("{bases:?}\n{chains:?}\n{rigid:?}\n{paths:?}");
    for judged in [&bases, &rigid, &chains, &paths] {
        assert!(
            judged.touching > rounds(5)
                && judged.touching + rounds(10) < judged.of
                && judged.within > rounds(20),
            "{judged:?}"
        );
    }
    assert!(bases.resolved == bases.of && rigid.resolved == rigid.of, "{bases:?} {rigid:?}");
    // An end that turns round may be what comes nearest.
    assert!(chains.resolved * 10 >= chains.of * 9, "{chains:?}");
}

fn search_vertex(random: &mut Random, search: &BvhSearch) -> Vector {
    use parry_continuum::proximity::Proximity;
    search.vertices()[random.below(search.vertices().len() as u32) as usize]
}

/// Counts the tolerances with narrower bounds than a coarser one, and those with a free motion.
fn refine(
    search: &mut BvhSearch,
    motion: &impl Motion,
    random: &mut Random,
    seen: &mut [usize; 2],
) {
    let mut tolerance = random.between(0.5, 8.0);
    let mut coarser: Option<MotionClearance> = None;
    while tolerance > 1e-3 {
        let finer = search.clearance_of_motion(motion, tolerance).unwrap();
        if let Some(coarser) = coarser {
            assert!(
                coarser.lower <= finer.lower && finer.upper <= coarser.upper,
                "{tolerance}: {coarser:?} {finer:?}"
            );
            let gap = |found: &MotionClearance| found.upper - found.lower;
            seen[0] += usize::from(gap(&finer) < gap(&coarser));
        }
        seen[1] += usize::from(finer.lower > 0.0);
        coarser = Some(finer);
        tolerance *= [0.1, 0.5, 0.9][random.below(3) as usize];
    }
}

/// The bounds of each tolerance lie within the bounds of every coarser tolerance.
#[test]
fn a_finer_tolerance_never_gives_looser_bounds() {
    let (mut search, robot, mut random) = (anatomy(), ctr::three_tubes(), Random::new(25));
    let mut seen = [0; 2];
    for round in 0..rounds(60) {
        let edge = random_edge(&robot, &mut random, [0.5, 2.0, 8.0][round % 3]);
        refine(&mut search, &edge, &mut random, &mut seen);
        let near = search_vertex(&mut random, &search) + random.point() * 8.0;
        let (from, radii) = polyline(&mut random, near);
        let shift = random.direction() * random.between(0.0, 3.0);
        let to: Vec<_> = from.iter().map(|&point| point + shift + random.point() * 0.5).collect();
        let capsules = LinearMotion::capsules(&from, &to, &radii).unwrap();
        refine(&mut search, &capsules, &mut random, &mut seen);
        if let Ok(chain) = LinearMotion::chain(&from, &to, &radii) {
            refine(&mut search, &chain, &mut random, &mut seen);
        }
    }
    assert!(seen.iter().all(|&count| count > rounds(200)), "{seen:?}");
}

/// Capsules over a floor, whose least height is a vertex's where it begins or where it ends:
/// scraping, and at the margin.
#[test]
fn motions_that_scrape_are_never_misjudged() {
    scraping(150, 23);
}

fn scraping(count: usize, seed: u64) {
    let (mut search, mut random) = (floor(), Random::new(seed));
    let (mut clear, mut contact) = (0, 0);
    for round in 0..count {
        let (from, radii) = polyline(&mut random, Vector::ZERO);
        let shift = random.direction() * random.between(0.0, 3.0);
        let to: Vec<_> = from.iter().map(|&point| point + shift + random.point() * 0.5).collect();
        let low = |points: &[Vector]| {
            let links = points.windows(2).zip(&radii);
            links.fold(Real::INFINITY, |low, (ends, radius)| {
                low.min(ends[0].z.min(ends[1].z) - radius)
            })
        };
        let gap = [0.0, 1e-9, 1e-6, 1e-3, random.between(0.0, 5.0)][round % 5];
        let lift = Vector::Z * (gap - low(&from).min(low(&to)));
        let lifted =
            [from, to].map(|points| points.iter().map(|&point| point + lift).collect::<Vec<_>>());
        let motion = LinearMotion::capsules(&lifted[0], &lifted[1], &radii).unwrap();
        for tolerance in [1e-3, 0.1] {
            let least = search.clearance_of_motion(&motion, tolerance).unwrap();
            assert!(least.lower <= gap + 1e-13 && gap <= least.upper + 1e-13, "{gap}: {least:?}");
            assert!(least.resolved, "{gap}: {least:?}");
        }
        let mut decide = |margin| search.clears_motion(&motion, margin, 1e-4).unwrap().decision;
        assert_ne!(decide(gap + 1e-9), Decision::Clear);
        clear += usize::from(decide((gap - 2e-4).max(0.0)) == Decision::Clear);
        contact += usize::from(decide(gap + 2e-4) == Decision::Contact);
        if gap >= 1e-9 {
            assert_ne!(decide(gap - 1e-9), Decision::Contact);
        }
    }
    assert!(5 * clear >= 2 * count && 10 * contact > 9 * count, "{clear} {contact} of {count}");
}

/// The same for many motions.
#[test]
#[ignore = "ten seconds: run it by name"]
fn bounds_hold_for_1_500_motions() {
    edges(400, 31);
    bases_and_chains(150, 32);
    scraping(500, 33);
}

/// A square of 40 across z at the origin.
fn floor() -> BvhSearch {
    let corners = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
    let corners = corners.map(|[x, y]| Vector::new(x, y, 0.0));
    BvhSearch::from_triangles(&corners, &[[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// What touches at one moment, what slides along a wall at one distance, what stands still, and
/// what passes through.
#[test]
fn touching_and_sliding_motions_are_bounded() {
    let mut search = floor();
    let link = |x: Real, z: Real| [Vector::new(x, 0.0, z), Vector::new(x + 2.0, 0.0, z)];
    let radius = 0.5;
    for gap in [0.0, 1e-12, 1e-9, 1e-3, 1.0] {
        let height = radius + gap;
        // Down and up again, exactly to the gap at half time.
        let down =
            LinearMotion::chain(&link(-2.0, height + 3.0), &link(0.0, height), &[radius]).unwrap();
        let up =
            LinearMotion::chain(&link(0.0, height), &link(2.0, height + 3.0), &[radius]).unwrap();
        let bounce = MotionPath::new(vec![down, up]).unwrap();
        let slide =
            LinearMotion::chain(&link(-2.0, height), &link(2.0, height), &[radius]).unwrap();
        let still = LinearMotion::chain(&link(0.0, height), &link(0.0, height), &[radius]).unwrap();
        for tolerance in [1e-3, 0.1] {
            for least in [
                search.clearance_of_motion(&bounce, tolerance).unwrap(),
                search.clearance_of_motion(&slide, tolerance).unwrap(),
                search.clearance_of_motion(&still, tolerance).unwrap(),
            ] {
                assert!(
                    least.lower <= gap + 1e-14 && gap <= least.upper + 1e-14,
                    "{gap}: {least:?}"
                );
                assert!(least.resolved, "{gap}: {least:?}");
            }
        }
        let least = search.clearance_of_motion(&bounce, 1e-3).unwrap();
        assert!((least.t - 0.5).abs() < 1e-3, "{least:?}");
    }
    let through = LinearMotion::capsules(&link(0.0, 8.0), &link(0.0, -9.0), &[radius]).unwrap();
    let least = search.clearance_of_motion(&through, 1e-3).unwrap();
    assert!(least.upper <= 1e-3 && least.lower == 0.0 && least.resolved, "{least:?}");
}

/// Walls of one point each.
fn points(places: &[Vector]) -> BvhSearch {
    let vertices: Vec<_> = places.iter().flat_map(|place| [*place; 3]).collect();
    let triangles: Vec<_> =
        (0..places.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    BvhSearch::from_triangles(&vertices, &triangles).unwrap()
}

/// A piece that has failed beside what was wanted then is settled at what is wanted later, when a
/// nearer one is found.
#[test]
fn what_displacements_settle_bounds_the_answer() {
    // As it was found.
    let from = [0.0, 100.0, 200.0, 300.0].map(|z| Vector::Z * z);
    let mut to = from;
    to[0].x = 5.0;
    to[1].x = 5.0;
    let motion = LinearMotion::capsules(&from, &to, &[0.0; 3]).unwrap();
    let mut search = points(&[Vector::new(12.5, 0.0, 50.0), Vector::new(8.0, 0.0, 250.0)]);
    for tolerance in [0.9, 1.0, 2.0] {
        let least = search.clearance_of_motion(&motion, tolerance).unwrap();
        assert!(
            least.lower <= 7.5 && 7.5 <= least.upper && least.resolved,
            "{tolerance}: {least:?}"
        );
    }
    // Chains with one part that moves towards its wall, and one that rests beside a wall slightly
    // farther away.
    let (mut random, mut nearer) = (Random::new(51), 0);
    for round in 0..400 {
        let unit = [1.0, 1e-3, 1e-6][round % 3];
        let links = 3 + random.below(4) as usize;
        let moving = random.below(links as u32 - 2) as usize;
        let radius = [0.0, 0.5][random.below(2) as usize];
        let (way, gap) = (random.between(1.0, 6.0), random.between(0.5, 10.0));
        let tolerance = random.between(0.1, 2.0);
        let pose = if round % 2 == 0 { Pose::IDENTITY } else { random.pose(5.0) };
        let place = |x: Real, z: Real| pose * Vector::new(x, 0.0, z) * unit;
        let from: Vec<_> = (0..=links).map(|k| place(0.0, 100.0 * k as Real)).collect();
        let mut to = from.clone();
        for (k, to) in to.iter_mut().enumerate().skip(moving).take(2) {
            *to = place(way, 100.0 * k as Real);
        }
        let rests = moving + 2;
        let beside = gap + tolerance * random.unit();
        let walls = [
            place(way + radius + gap, 100.0 * moving as Real + 50.0),
            place(radius + beside, 100.0 * rests as Real + 50.0),
        ];
        let motion = LinearMotion::capsules(&from, &to, &vec![radius * unit; links]).unwrap();
        let least = points(&walls).clearance_of_motion(&motion, tolerance * unit).unwrap();
        let (truth, rounding) = (gap * unit, 1e-11 * unit);
        assert!(least.lower <= truth + rounding, "{round}: {truth}, {least:?}");
        assert!(truth <= least.upper + rounding && least.resolved, "{round}: {truth}, {least:?}");
        nearer += usize::from(least.lower > truth - 0.5 * tolerance * unit);
    }
    assert!(nearer > 20, "{nearer}");
}

/// Of a path only what may come nearest is looked at closely.
#[test]
fn a_path_looks_closely_where_it_comes_nearest() {
    let mut search = floor();
    let link = |x: Real, z: Real| [Vector::new(x, 0.0, z), Vector::new(x + 2.0, 0.0, z)];
    let heights: Vec<_> = (0..=200).map(|k| 5.0 + 3.0 * (Real::from(k) * 0.1).cos()).collect();
    // To and fro, so that each motion begins where the previous one ends.
    let shape = |k: usize| link([0.0, 0.1][k % 2], heights[k]);
    let motions =
        (1..heights.len()).map(|k| LinearMotion::chain(&shape(k - 1), &shape(k), &[0.5]).unwrap());
    let path = MotionPath::new(motions.collect()).unwrap();
    let counted = Counted::new(&path);
    let least = search.clearance_of_motion(&counted, 1e-3).unwrap();
    let lowest = heights.iter().copied().fold(Real::INFINITY, Real::min) - 0.5;
    assert!(
        least.lower <= lowest && lowest <= least.upper && least.resolved,
        "{lowest}: {least:?}"
    );
    // One for each, and a few more where it is low.
    assert!(counted.count() < 200 + 400, "{}", counted.count());
    let (leg, t) = path.part_at(least.t);
    let height = heights[leg] + (heights[leg + 1] - heights[leg]) * t;
    assert!((height - 0.5 - least.upper).abs() < 1e-9);
}

#[test]
fn what_cannot_be_bounded_is_refused() {
    let mut search = floor();
    let link = [Vector::Z, 2.0 * Vector::Z];
    let motion = LinearMotion::chain(&link, &link, &[0.1]).unwrap();
    for tolerance in [-1.0, Real::NAN] {
        let refused = search.clearance_of_motion(&motion, tolerance).unwrap_err();
        assert!(
            matches!(refused, ProximityError::Negative { parameter: "tolerance", .. }),
            "{refused}"
        );
    }
    // Without a tolerance the bounds are as close as rounding allows.
    let least = search.clearance_of_motion(&motion, 0.0).unwrap();
    assert!(
        least.lower <= 1.0 && 1.0 <= least.upper && least.upper - least.lower < 1e-11,
        "{least:?}"
    );
}

/// What an insertion costs beside the distances of some of its shapes, which prove nothing of those
/// between. Run by name.
#[test]
#[ignore = "prints a ratio of times"]
fn an_insertion_costs_little_more_than_its_shapes() {
    use continuum_demo::ctr::Joints;
    use continuum_demo::joint_motion::JointMotion;
    use continuum_demo::ventricle;
    use parry_continuum::proximity::Proximity;
    use std::time::Instant;
    let (mut search, robot, goal) = (anatomy(), ctr::three_tubes(), ventricle::goal());
    let out = |sections: usize| Joints {
        extensions: (0..3).map(|k| if k < sections { goal.extensions[k] } else { 0.01 }).collect(),
        angles: goal.angles.clone(),
    };
    let leg =
        |k: usize| JointMotion::new(&robot, [&out(k), &out(k + 1)], ventricle::entry()).unwrap();
    let path = MotionPath::new((0..3).map(leg).collect()).unwrap();
    let chains: Vec<_> = (0..500)
        .map(|k| {
            let (leg, t) = path.part_at((Real::from(k) + 0.5) / 500.0);
            let joints = JointMotion::new(&robot, [&out(leg), &out(leg + 1)], ventricle::entry())
                .unwrap()
                .joints(t);
            let line = robot.centreline(&joints, 100);
            let (points, radii) =
                parry_continuum::simplify(&line.points, &line.radii, 0.01).unwrap();
            Chain::from_centreline(&points, &radii).unwrap()
        })
        .collect();
    let base = ventricle::entry();
    for _ in 0..3 {
        let begin = Instant::now();
        let least = chains.iter().map(|chain| search.minimum(chain, &base).unwrap().distance);
        let least = least.fold(Real::INFINITY, Real::min);
        let steps = begin.elapsed();
        let counted = Counted::new(&path);
        let begin = Instant::now();
        let found = search.clearance_of_motion(&counted, 0.01).unwrap();
        let proof = begin.elapsed();
        println!(
            "{least:.4}; {found:?}; {} shapes; {:.2} times",
            counted.count(),
            proof.as_secs_f64() / steps.as_secs_f64()
        );
        assert!(found.resolved && found.lower <= least + 0.02);
    }
}
