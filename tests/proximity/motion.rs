//! Motions against the truth: their shapes in steps so fine that nothing fits between.

use continuum_scene::ctr::{self, Joints, Robot};
use continuum_scene::ventricle;
use continuum_testing::{Arcs, Random};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Decision, FirstContact, MotionAnswer, Proximity, ProximityError,
};
use parry_continuum::{
    BendingMotion, BendingRates, BendingSection, Chain, LinearMotion, Motion, RigidMotion, RobotError, Speed,
    Tube, TubeSection, bending_speed, verify_motion,
};
use std::cell::Cell;

fn anatomy() -> BvhSearch {
    let (vertices, indices) = ventricle::mesh(6_000);
    BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap()
}

/// A concentric tube robot whose joints move evenly.
struct JointMotion {
    robot: Robot,
    from: Joints,
    to: Joints,
    rates: Vec<BendingRates>,
    shapes: Cell<u64>,
}

impl JointMotion {
    /// The tubes that are out must be curved all along: the first two sections are no longer than the second tube's bend.
    fn new(robot: &Robot, from: Joints, to: Joints) -> Self {
        let mut motion = Self { robot: robot.clone(), from, to, rates: Vec::new(), shapes: Cell::new(0) };
        let bending: Vec<_> = (0..3)
            .map(|k| {
                (k..3)
                    .map(|j| motion.pull(k, j) * (motion.to.angles[j] - motion.from.angles[j]).abs())
                    .sum::<Real>()
            })
            .collect();
        let middle = motion.bends(0.5);
        motion.rates = (0..3)
            .map(|k| BendingRates {
                length: motion.from.extensions[k].max(motion.to.extensions[k]),
                growth: motion.to.extensions[k] - motion.from.extensions[k],
                curvature: middle[k].length() + 0.5 * bending[k],
                bending: bending[k],
                step: if k < 2 {
                    (middle[k + 1] - middle[k]).length() + 0.5 * (bending[k] + bending[k + 1])
                } else {
                    0.0
                },
            })
            .collect();
        motion
    }

    /// How much of the curvature of section `k` is due to tube `j`.
    fn pull(&self, k: usize, j: usize) -> Real {
        let stiffness = |j: usize| self.robot.sections[j].tubes[0].stiffness;
        stiffness(j) / (k..3).map(stiffness).sum::<Real>() * self.robot.sections[j].tubes[0].curvature
    }

    fn joints(&self, t: Real) -> Joints {
        let mix = |a: &[Real], b: &[Real]| a.iter().zip(b).map(|(a, b)| a + (b - a) * t).collect();
        Joints {
            extensions: mix(&self.from.extensions, &self.to.extensions),
            angles: mix(&self.from.angles, &self.to.angles),
        }
    }

    fn bends(&self, t: Real) -> Vec<Vector> {
        let angles = self.joints(t).angles;
        let pull = |k, j: usize| Vector::new(-angles[j].sin(), angles[j].cos(), 0.0) * self.pull(k, j);
        (0..3).map(|k| (k..3).map(|j| pull(k, j)).sum()).collect()
    }

    fn arcs(&self, t: Real) -> Arcs {
        let mut arcs = Arcs::from_frame(Pose::IDENTITY);
        let extensions = self.joints(t).extensions;
        for (k, bend) in self.bends(t).into_iter().enumerate() {
            arcs.push(self.robot.sections[k].radius, &[(extensions[k], bend)]);
        }
        arcs
    }

    fn tube(&self, t: Real) -> Tube {
        let arcs = self.arcs(t);
        let sections: Vec<_> = arcs
            .stretches
            .iter()
            .map(|part| TubeSection { length: part.length, radius: part.radius, curvature: part.curvature })
            .collect();
        Tube::from_function(&sections, move |s| arcs.at(s)).unwrap()
    }
}

impl Motion for JointMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.shapes.set(self.shapes.get() + 1);
        *tube = self.tube(t);
        Ok(ventricle::entry())
    }

    fn speed(&self, section: usize, shares: [Real; 2], _times: [Real; 2]) -> Speed {
        bending_speed(&self.rates, section, shares)
    }
}

fn tip(robot: &Robot, joints: &Joints) -> Vector {
    robot.frames(joints, &[robot.length(joints)])[0].translation
}

/// An edge whose tip ends `distance` from where it begins.
fn random_edge(robot: &Robot, random: &mut Random, distance: Real) -> JointMotion {
    loop {
        let reach = random.between(0.02, 0.7);
        let from = Joints {
            extensions: robot
                .sections
                .iter()
                .map(|section| (section.length * reach * random.between(0.02, 0.7)).min(33.0))
                .collect(),
            angles: (0..3).map(|_| random.between(0.0, 6.3)).collect(),
        };
        let way: Vec<_> = (0..6).map(|_| random.between(-0.5, 0.5)).collect();
        let go = |share: Real| Joints {
            extensions: (0..3)
                .map(|k| (from.extensions[k] + share * way[k] * 20.0).clamp(0.02, 33.3))
                .collect(),
            angles: (0..3).map(|k| from.angles[k] + share * way[k + 3] * 6.0).collect(),
        };
        let moved = |share: Real| (tip(robot, &go(share)) - tip(robot, &from)).length();
        if moved(1.0) < distance {
            continue;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if moved(middle) < distance { low = middle } else { high = middle }
        }
        let motion = JointMotion::new(robot, from.clone(), go(high));
        let arcs = motion.arcs(1.0);
        assert!(
            (arcs.at(arcs.length()).0 - tip(robot, &motion.to)).length() < 1e-6,
            "the robot of the scene"
        );
        return motion;
    }
}

/// How a motion fares in steps.
struct Steps {
    /// Between these is the clearance of each shape.
    bounds: Vec<[Real; 2]>,
}

impl Steps {
    fn new(
        search: &mut BvhSearch,
        count: usize,
        tolerance: Real,
        mut shape: impl FnMut(Real) -> (Tube, Pose),
    ) -> Self {
        let bounds = (0..=count).map(|step| {
            let (tube, pose) = shape(step as Real / count as Real);
            let found = search.clearance(&tube, &pose, tolerance).unwrap();
            [found.lower, found.upper]
        });
        Self { bounds: bounds.collect() }
    }

    fn least(&self) -> [Real; 2] {
        self.bounds.iter().fold([Real::INFINITY; 2], |least, bounds| [0, 1].map(|k| least[k].min(bounds[k])))
    }

    /// The first step that is at most `margin` away.
    fn first_touch(&self, margin: Real) -> Option<usize> {
        self.bounds.iter().position(|bounds| bounds[1] <= margin)
    }
}

#[derive(Debug, Default)]
struct Seen {
    clear: usize,
    contact: usize,
    undecided: usize,
    both_ends_clear_but_contact: usize,
    shapes: u64,
}

const RESOLUTION: Real = 1e-3;

/// Compares an answer with the steps, which are `fine` apart at most.
fn judge(
    search: &mut BvhSearch,
    motion: &JointMotion,
    steps: &Steps,
    fine: Real,
    margin: Real,
    seen: &mut Seen,
) {
    let before = motion.shapes.get();
    let answer = search.clears_motion(motion, margin, RESOLUTION).unwrap();
    seen.shapes += motion.shapes.get() - before;
    let [lower, upper] = steps.least();
    match answer {
        MotionAnswer::Clear => {
            seen.clear += 1;
            assert!(upper > margin, "certified, but a step comes as near as {upper}, margin {margin}");
        }
        MotionAnswer::Contact { t, upper, arc_length, on_robot, on_mesh, .. } => {
            seen.contact += 1;
            assert!(upper <= margin && (on_robot - on_mesh).length() <= upper + 1e-9);
            let tube = motion.tube(t);
            assert!((0.0..=tube.length() + 1e-9).contains(&arc_length));
            let found = search.clearance(&tube, &ventricle::entry(), 1e-6).unwrap();
            assert!(found.lower <= margin, "false contact: {found:?} at {t}, margin {margin}");
            // By the links that follow from the same curve, too.
            let (points, radii) = motion.arcs(t).samples(0.05, &[1e-5, 1e-4, 1e-3]);
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            let links = search.minimum(&chain, &ventricle::entry()).unwrap().distance;
            assert!(links <= margin + 1e-4, "false contact: {links} at {t}, margin {margin}");
            assert!(lower <= margin + fine, "no step is near: {lower}, margin {margin}");
            let ends = [steps.bounds[0][0], steps.bounds[steps.bounds.len() - 1][0]];
            seen.both_ends_clear_but_contact += usize::from(ends.iter().all(|end| *end > margin));
        }
        MotionAnswer::Undecided { interval, .. } => {
            seen.undecided += 1;
            assert!(0.0 <= interval[0] && interval[0] < interval[1] && interval[1] <= 1.0);
            assert!(
                lower <= margin + RESOLUTION + fine && upper >= margin - fine,
                "{lower} {upper} {margin}"
            );
        }
        other => panic!("{other:?}"),
    }
}

/// Edges in steps of which no point moves by more than about `fine`.
fn judge_edges(search: &mut BvhSearch, random: &mut Random, edges: usize, fine: Real) -> Seen {
    let robot = ctr::three_tubes();
    let mut seen = Seen::default();
    for edge in 0..edges {
        let distance = [0.5, 1.0, 2.0, 5.0, 10.0, 20.0][edge % 6] * random.between(0.8, 1.0);
        // Most as planners ask about them, with both ends clear.
        let motion = loop {
            let motion = random_edge(&robot, random, distance);
            let mut is_clear = |t: &Real| {
                search.tube_clears(&motion.tube(*t), &ventricle::entry(), 0.0, 1e-3).unwrap()
                    == Decision::Clear
            };
            if edge % 8 == 7 || [0.0, 1.0].iter().all(&mut is_clear) {
                break motion;
            }
        };
        let fastest =
            motion.speed(2, [0.0, 1.0], [0.0, 1.0]).point.max(motion.speed(0, [0.0, 1.0], [0.0, 1.0]).point);
        // The bound is about twice the speed.
        let count = (0.5 * fastest.max(distance) / fine).ceil() as usize;
        let steps = Steps::new(search, count, 0.1 * fine, |t| (motion.tube(t), ventricle::entry()));
        let [lower, upper] = steps.least();
        let margins = [
            [0.0, 0.25, 0.5, 1.0][random.below(4) as usize],
            random.unit(),
            // Grazing, on either side.
            (lower - random.between(1.0, 3.0) * fine).max(0.0),
            upper + random.between(0.1, 3.0) * fine,
        ];
        for margin in margins {
            judge(search, &motion, &steps, 2.0 * fine, margin, &mut seen);
        }
    }
    seen
}

#[test]
fn no_edge_is_misjudged() {
    let seen = judge_edges(&mut anatomy(), &mut Random::new(1), 200, 0.05);
    println!("{seen:?}");
    assert!(seen.clear > 200 && seen.contact > 200 && seen.both_ends_clear_but_contact > 40, "{seen:?}");
    assert!(seen.undecided < 10, "{seen:?}");
}

#[test]
#[ignore = "10,000 edges in steps of 0.01 mm take an hour"]
fn no_edge_of_ten_thousand_is_misjudged() {
    let seen = judge_edges(&mut anatomy(), &mut Random::new(2), 10_000, 0.01);
    println!("{seen:?}");
}

/// Between their ends, motions jump through a wall that no coarse step sees.
#[test]
fn a_jump_through_a_wall_is_seen() {
    let wall = [[-60.0, -60.0], [60.0, -60.0], [60.0, 60.0], [-60.0, 60.0]];
    let vertices = wall.iter().map(|&[x, y]| Vector::new(x, y, 0.1 * x)).collect();
    let mut search = BvhSearch::new(&TriMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()).unwrap();
    let (mut random, mut jumps) = (Random::new(3), 0);
    for round in 0..400 {
        let radius = random.between(0.01, 0.5);
        let mut points = vec![random.point() * 5.0 + Vector::Z * 10.0];
        for k in 0..4 {
            points.push(points[k] + (random.direction() + Vector::Z) * radius * random.between(0.5, 3.0));
        }
        let shift =
            Vector::new(random.between(-5.0, 5.0), random.between(-5.0, 5.0), random.between(-50.0, -35.0));
        let to: Vec<_> = points.iter().map(|&point| point + shift + random.point() * radius).collect();
        let (from, radii) = (&points, [radius; 4]);
        let linear = [LinearMotion::capsules, LinearMotion::chain][round % 2](from, &to, &radii).unwrap();
        let tube = Tube::from(&Chain::capsules(from, &radii).unwrap());
        let turn = random.direction() * random.between(0.0, 0.1);
        let rigid = RigidMotion::new(tube.clone(), [Pose::IDENTITY, Pose::new(shift, turn)]).unwrap();
        let coarse = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];
        let is_seen = |search: &mut BvhSearch, motion: &dyn Fn(&mut Tube, Real) -> Pose| {
            coarse.iter().any(|&t| {
                let mut tube = tube.clone();
                let pose = motion(&mut tube, t);
                search.tube_clears(&tube, &pose, 0.0, 1e-6).unwrap() != Decision::Clear
            })
        };
        let linear_seen = is_seen(&mut search, &|tube, t| linear.shape(t, tube).unwrap());
        let rigid_seen = is_seen(&mut search, &|tube, t| rigid.shape(t, tube).unwrap());
        jumps += usize::from(!linear_seen) + usize::from(!rigid_seen);
        for answer in [
            search.clears_motion(&linear, 0.0, 1e-4).unwrap(),
            search.clears_motion(&rigid, 0.0, 1e-4).unwrap(),
        ] {
            assert!(matches!(answer, MotionAnswer::Contact { .. }), "{answer:?}");
        }
    }
    assert!(jumps > 400, "{jumps} of 800");
}

/// A polyline near a vertex of the anatomy, with links shorter and longer than their radii, and steps in radius.
fn polyline(random: &mut Random, from: Vector) -> (Vec<Vector>, Vec<Real>) {
    let mut points = vec![from];
    let (mut heading, mut radii, mut radius) = (random.direction(), Vec::new(), random.between(0.2, 1.0));
    for k in 0..2 + random.below(6) as usize {
        heading = (heading + random.direction() * 0.6).normalize();
        points.push(points[k] + heading * random.between(0.1, 2.0));
        radii.push(radius);
        radius *= [1.0, 1.0, 1.0, 0.7, 1.3][random.below(5) as usize];
    }
    (points, radii)
}

/// The model of a chain: Algorithm 1, or capsules.
type Model = fn(&[Vector], &[Real]) -> Result<Chain, RobotError>;

/// Chains whose vertices move straight, against the links of each step.
#[test]
fn no_chain_is_misjudged() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let mut search = BvhSearch::new(&mesh).unwrap();
    let mut random = Random::new(4);
    let (mut clear, mut contact, mut undecided, mut changing, mut wide) = (0, 0, 0, 0, 0);
    for round in 0..400 {
        let near = mesh.vertices()[random.below(mesh.vertices().len() as u32) as usize];
        let base = near + random.point() * 4.0;
        let (from, radii) = polyline(&mut random, base);
        let shift = random.direction() * random.between(0.0, 3.0);
        let to: Vec<_> = from.iter().map(|&point| point + shift + random.point() * 0.5).collect();
        let (motion, model): (_, Model) = if round % 3 == 0 {
            (LinearMotion::capsules(&from, &to, &radii).unwrap(), Chain::capsules)
        } else {
            (LinearMotion::chain(&from, &to, &radii).unwrap(), Chain::from_centreline)
        };
        verify_motion(&motion, 20).unwrap();
        let count = 400;
        let chain = |t: Real| {
            let points: Vec<_> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * t).collect();
            model(&points, &radii).unwrap()
        };
        let chains: Vec<_> = (0..=count).map(|step| chain(Real::from(step) / Real::from(count))).collect();
        let distance =
            |search: &mut BvhSearch, chain: &Chain| search.minimum(chain, &Pose::IDENTITY).unwrap().distance;
        let distances: Vec<_> = chains.iter().map(|chain| distance(&mut search, chain)).collect();
        changing += usize::from(chains.iter().any(|chain| {
            chain.links().iter().zip(chains[0].links()).any(|(link, first)| link.caps() != first.caps())
        }));
        let least = distances.iter().copied().fold(Real::INFINITY, Real::min);
        // Between two steps nothing moves farther than this, unless a cap changes.
        let fine = 4.0 / Real::from(count);
        for margin in [0.0, random.unit(), (least - fine).max(0.0), least + 2e-3] {
            match search.clears_motion(&motion, margin, 1e-3).unwrap() {
                MotionAnswer::Clear => {
                    clear += 1;
                    wide += usize::from(least > margin + 0.5);
                    assert!(least > margin, "certified, but a step is {least} away, margin {margin}");
                }
                MotionAnswer::Contact { t, upper, .. } => {
                    contact += 1;
                    let truth = distance(&mut search, &chain(t));
                    assert!(
                        truth <= margin + 1e-9 && truth <= upper + 1e-9,
                        "{truth} at {t}, margin {margin}"
                    );
                }
                MotionAnswer::Undecided { .. } => undecided += 1,
                other => panic!("{other:?}"),
            }
            // When it happens.
            match search.time_of_contact(&motion, margin, 1e-3).unwrap() {
                FirstContact::Never => assert!(least > margin, "never, but {least} away, margin {margin}"),
                FirstContact::Within { clear_until, t, upper, .. } => {
                    assert!(clear_until <= t);
                    let truth = distance(&mut search, &chain(t));
                    assert!(truth <= margin + 1e-9 && upper <= margin, "{truth} at {t}, margin {margin}");
                    let clear = distances.iter().take((clear_until * Real::from(count)).ceil() as usize);
                    assert!(clear.clone().all(|distance| *distance > margin), "{clear_until} to {t}");
                }
                FirstContact::Undecided { interval, .. } => {
                    let clear = distances.iter().take((interval[0] * Real::from(count)).ceil() as usize);
                    assert!(clear.clone().all(|distance| *distance > margin), "{interval:?}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
    println!("{clear} {contact} {undecided} {changing} {wide}");
    assert!(
        clear > 200 && contact > 400 && changing > 20 && wide > 50,
        "{clear} {contact} {changing} {wide}"
    );
    assert!(undecided < 40, "{undecided}");
}

/// The bracket of the first contact is as narrow as the resolution, where the motion goes straight into the wall.
#[test]
fn the_first_contact_is_found() {
    let mut search = anatomy();
    let (robot, mut random, mut found, mut later) = (ctr::three_tubes(), Random::new(5), 0, 0);
    while found < 60 {
        let motion = random_edge(&robot, &mut random, 8.0);
        let steps = Steps::new(&mut search, 300, 1e-3, |t| (motion.tube(t), ventricle::entry()));
        let margin = random.between(0.0, 0.5);
        if steps.bounds[0][0] <= margin {
            continue;
        }
        let answer = search.time_of_contact(&motion, margin, 1e-3).unwrap();
        let step = |t: Real| (t * 300.0).ceil() as usize;
        match (answer, steps.first_touch(margin)) {
            (FirstContact::Within { clear_until, t, .. }, first) => {
                assert!(steps.bounds[..step(clear_until)].iter().all(|bounds| bounds[1] > margin));
                assert!(first.is_none_or(|first| clear_until <= first as Real / 300.0));
                let at = search.clearance(&motion.tube(t), &ventricle::entry(), 1e-6).unwrap();
                assert!(at.lower <= margin);
                found += 1;
                // Not just any contact: the speed is at most some 40 mm in all.
                later += usize::from(t - clear_until > 1e-3);
            }
            (FirstContact::Never, first) => assert_eq!(first, None),
            (FirstContact::Undecided { .. }, _) => {}
            (other, _) => panic!("{other:?}"),
        }
    }
    assert!(later <= 3, "{later} of {found}");
}

/// A motion that states a share of the speeds that it should.
struct Understated<'a, M>(&'a M, Real);

impl<M: Motion> Motion for Understated<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        let Speed { point, turn } = self.0.speed(section, shares, times);
        Speed { point: point * self.1, turn: turn * self.1 }
    }
}

#[test]
fn speeds_that_are_too_low_are_found() {
    let (robot, mut random) = (ctr::three_tubes(), Random::new(6));
    let mut found = [0; 4];
    for _ in 0..60 {
        let joints = random_edge(&robot, &mut random, 5.0);
        verify_motion(&joints, 60).unwrap();
        let sections = |t: Real| -> Vec<_> {
            let parts = joints.arcs(t).stretches.into_iter().zip(joints.bends(t));
            parts
                .map(|(part, bend)| BendingSection {
                    length: part.length,
                    radius: part.radius,
                    bend: [bend.y, -bend.x],
                })
                .collect()
        };
        let bending = BendingMotion::new(&sections(0.0), &sections(1.0), ventricle::entry()).unwrap();
        verify_motion(&bending, 60).unwrap();
        let poses = [random.pose(5.0), random.pose(5.0)];
        let rigid = RigidMotion::new(joints.tube(0.0), poses).unwrap();
        verify_motion(&rigid, 60).unwrap();
        let (from, radii) = polyline(&mut random, Vector::ZERO);
        let to: Vec<_> = from.iter().map(|&point| point + random.point()).collect();
        let linear = LinearMotion::chain(&from, &to, &radii).unwrap();
        verify_motion(&linear, 60).unwrap();
        let too_low = |result: Result<(), RobotError>, stated_share: Real| match result {
            Ok(()) => 0,
            Err(
                RobotError::FasterThanStated { t, share, found, stated, .. }
                | RobotError::TurnsFasterThanStated { t, share, found, stated, .. },
            ) => {
                assert!((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&share));
                // The true bound holds, so the speed is between the two.
                assert!(stated < found && found <= stated / stated_share * (1.0 + 1e-9) + 1e-9);
                1
            }
            Err(other) => panic!("{other:?}"),
        };
        found[0] += too_low(verify_motion(&Understated(&joints, 0.5), 60), 0.5);
        found[1] += too_low(verify_motion(&Understated(&bending, 0.5), 60), 0.5);
        found[2] += too_low(verify_motion(&Understated(&rigid, 0.3), 60), 0.3);
        found[3] += too_low(verify_motion(&Understated(&linear, 0.99), 60), 0.99);
    }
    assert!(found.iter().all(|found| *found > 50), "{found:?}");
    // In debug builds queries find it too.
    if cfg!(debug_assertions) {
        let motion = random_edge(&robot, &mut random, 20.0);
        let mut search = anatomy();
        let refused = search.clears_motion(&Understated(&motion, 0.05), 2.5, 1e-3);
        let is_refused = matches!(
            refused,
            Err(ProximityError::Motion(
                RobotError::FasterThanStated { .. } | RobotError::TurnsFasterThanStated { .. }
            ))
        );
        assert!(
            is_refused || matches!(refused, Ok(MotionAnswer::Contact { t, .. }) if t == 0.5),
            "{refused:?}"
        );
    }
}

/// A motion that is made up of two functions.
struct Made<S, V>(S, V);

impl<S, V> Motion for Made<S, V>
where
    S: Fn(Real, &mut Tube) -> Result<Pose, RobotError>,
    V: Fn() -> Real,
{
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0(t, tube)
    }

    fn speed(&self, _section: usize, _shares: [Real; 2], _times: [Real; 2]) -> Speed {
        Speed { point: self.1(), turn: 0.0 }
    }
}

#[test]
fn a_motion_that_cannot_be_asked_about_is_refused() {
    let mut search = anatomy();
    let inside = ventricle::entry().translation;
    let straight = |links: usize, radius: Real| {
        move |_: Real, tube: &mut Tube| {
            let points: Vec<_> = (0..=links).map(|k| inside + Vector::Z * (0.1 * k as Real)).collect();
            tube.set_samples(&points, &vec![radius; links], None)?;
            Ok(Pose::IDENTITY)
        }
    };
    let good = Made(straight(3, 0.1), || 0.0);
    assert_eq!(search.clears_motion(&good, 0.0, 1e-3), Ok(MotionAnswer::Clear));
    assert_eq!(search.time_of_contact(&good, 0.0, 1e-3), Ok(FirstContact::Never));
    assert!(matches!(search.clears_motion(&good, -1.0, 1e-3), Err(ProximityError::BadMargin { .. })));
    assert!(matches!(search.clears_motion(&good, 0.0, -1.0), Err(ProximityError::BadTolerance { .. })));
    assert!(matches!(search.clears_motion(&good, 0.0, Real::NAN), Err(ProximityError::BadTolerance { .. })));
    assert!(matches!(search.clears_motion(&good, 0.0, 0.0), Err(ProximityError::ToleranceTooFine { .. })));
    for speed in [Real::NAN, -1.0, Real::INFINITY] {
        let refused = search.clears_motion(&Made(straight(3, 0.1), || speed), 0.0, 1e-3);
        assert!(matches!(refused, Err(ProximityError::Motion(RobotError::BadSpeed { .. }))), "{refused:?}");
    }
    let fast = search.clears_motion(&Made(straight(3, 0.1), || 1e30), 0.0, 1e-3);
    assert!(matches!(fast, Err(ProximityError::TooFast { .. })), "{fast:?}");
    // The radius changes on the way.
    let changing =
        Made(|t: Real, tube: &mut Tube| straight(3, if t < 0.5 { 0.1 } else { 0.2 })(t, tube), || 100.0);
    let refused = search.clears_motion(&changing, 0.0, 1e-3);
    assert!(matches!(refused, Err(ProximityError::Motion(RobotError::SectionsChange { .. }))), "{refused:?}");
    assert!(matches!(verify_motion(&changing, 4), Err(RobotError::SectionsChange { .. })));
    // There is no shape, or none that can be asked about.
    let broken =
        Made(|_: Real, tube: &mut Tube| tube.set_samples(&[], &[], None).map(|()| Pose::IDENTITY), || 0.0);
    assert!(matches!(search.clears_motion(&broken, 0.0, 1e-3), Err(ProximityError::Motion(_))));
    let nothing = Made(|_: Real, _: &mut Tube| Ok(Pose::IDENTITY), || 0.0);
    search.forget();
    let lost = Made(
        |t: Real, tube: &mut Tube| {
            straight(3, 0.1)(t, tube).map(|_| Pose::from_translation(Vector::splat(Real::NAN)))
        },
        || 0.0,
    );
    assert_eq!(search.clears_motion(&lost, 0.0, 1e-3), Err(ProximityError::PoseNotFinite));
    assert!(anatomy().clears_motion(&nothing, 0.0, 1e-3).is_err());

    let (a, b) = ([Vector::ZERO, Vector::Z], [Vector::ZERO, Vector::Z, Vector::X]);
    assert_eq!(LinearMotion::chain(&a, &b, &[1.0]).unwrap_err(), RobotError::PointsDiffer { from: 2, to: 3 });
    assert!(LinearMotion::capsules(&a, &a, &[-1.0]).is_err());
    assert!(LinearMotion::capsules(&a[..1], &a[..1], &[]).is_err());
    assert!(LinearMotion::capsules(&[Vector::ZERO; 2], &[Vector::X; 2], &[1.0]).is_err());
    let section = BendingSection { length: 1.0, radius: 0.1, bend: [0.0, 0.1] };
    let thick = BendingSection { radius: 0.2, ..section };
    assert_eq!(
        BendingMotion::new(&[section], &[thick], Pose::IDENTITY).unwrap_err(),
        RobotError::SectionsDiffer { index: 0 }
    );
    assert!(BendingMotion::new(&[section], &[section, section], Pose::IDENTITY).is_err());
    assert!(BendingMotion::new(&[], &[], Pose::IDENTITY).is_err());
    let endless = BendingSection { length: Real::INFINITY, ..section };
    assert!(BendingMotion::new(&[section], &[endless], Pose::IDENTITY).is_err());
    let lost = Pose::from_translation(Vector::splat(Real::NAN));
    assert!(RigidMotion::new(Tube::from(&Chain::capsules(&a, &[1.0]).unwrap()), [lost, lost]).is_err());
}

/// A link's start becomes round when it is one radius away from the base, and fills a corner of the robot at once.
#[test]
fn an_end_that_becomes_round_counts() {
    let corner = Vector::new(-1.0, 0.0, 1.0).normalize() * 0.95;
    let speck = [corner, corner + Vector::Y * 1e-3, corner + Vector::new(-1e-3, 0.0, 1e-3)];
    let mut search = BvhSearch::new(&TriMesh::new(speck.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    let line = |base: Real| [Vector::Z * -base, Vector::ZERO, Vector::X * 0.5];
    // Flat ends leave the speck 0.67 away.
    let flat = LinearMotion::chain(&line(0.9), &line(0.99), &[1.0; 2]).unwrap();
    assert_eq!(search.clears_motion(&flat, 0.3, 1e-3), Ok(MotionAnswer::Clear));
    let opening = LinearMotion::chain(&line(0.9), &line(1.05), &[1.0; 2]).unwrap();
    let answer = search.clears_motion(&opening, 0.3, 1e-3).unwrap();
    assert!(matches!(answer, MotionAnswer::Contact { t, .. } if t > 0.666), "{answer:?}");
}
