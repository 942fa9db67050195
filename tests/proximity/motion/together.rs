//! What robots do together brings them no nearer: pairs, a robot and its mesh, and a base under a
//! path cost little more than at rest.

use super::polyline;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, RobotPair, Scene, StructureEnd};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, CommonFrame, DisplacementBound, LinearMotion, Motion,
    MotionPath, MovingBase, RigidMotion, RobotError, Speed, Tube, verify_motion,
};
use std::cell::Cell;

/// Counts the shapes and the speeds that a query asks for.
struct Counted<'a, M> {
    motion: &'a M,
    shapes: Cell<usize>,
}

fn counted<M>(motion: &M) -> Counted<'_, M> {
    Counted { motion, shapes: Cell::new(0) }
}

impl<M: Motion> Motion for Counted<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.shapes.set(self.shapes.get() + 1);
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        self.motion.displacement(section, shares, times)
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        self.motion.common_frame(times)
    }

    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed_in_frame(section, shares, times)
    }

    fn time_parts(&self) -> usize {
        self.motion.time_parts()
    }
}

/// A motion that bounds no displacement.
struct BySpeed<'a, M>(&'a M);

impl<M: Motion> Motion for BySpeed<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        self.0.common_frame(times)
    }

    fn speed_in_frame(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed_in_frame(section, shares, times)
    }
}

fn straight(x: Real) -> [Vector; 2] {
    [Vector::X * x, Vector::X * x + Vector::Z * 20.0]
}

/// A shift of two parallel links, 1.001 apart by their radii, does not change their distance.
#[test]
fn two_that_are_shifted_together_are_as_far_apart_as_at_rest() {
    let shift = Vector::Y * 200.0;
    let mut pair = RobotPair::new();
    for unit in [1.0, 1e-3, 1024.0] {
        let at = |x: Real| straight(x).map(|point| point * unit);
        let moved = |x: Real| {
            LinearMotion::chain(&at(x), &at(x).map(|p| p + shift * unit), &[unit]).unwrap()
        };
        let (first, second) = (moved(0.0), moved(3.001));
        let asked = [counted(&first), counted(&second)];
        let (margin, resolution) = (unit, 1e-4 * unit);
        let found = pair.clears_motions(&asked[0], &asked[1], margin, resolution).unwrap();
        assert!(found.is_clear(), "{found:?}");
        assert!(asked[0].shapes.get() <= 2, "{}", asked[0].shapes.get());
        let least = pair.clearance_of_motion(&first, &second, resolution).unwrap();
        assert!(
            least.resolved && least.lower <= 1.001 * unit && 1.001 * unit <= least.upper + 1e-12
        );
        assert!(
            !pair.clears_motions(&first, &second, 1.002 * unit, resolution).unwrap().is_clear()
        );
    }
}

/// The same distance at all times, for robots of many links that are carried in any way: shifted,
/// turned about any axis, on bases upon bases.
#[test]
fn two_that_are_carried_together_cost_as_at_rest() {
    let (mut random, mut pair) = (Random::new(7), RobotPair::new());
    let (mut seen, mut turned) = (0, 0);
    for _ in 0..rounds(24) {
        let unit = [1.0, 1e-3, 1e3][random.below(3) as usize];
        let tool = |random: &mut Random, base: Vector| {
            let (points, radii) = polyline(random, base);
            let points: Vec<_> = points.into_iter().map(|point| point * unit).collect();
            let radii: Vec<_> = radii.into_iter().map(|radius| radius * unit).collect();
            Tube::from(&Chain::from_centreline(&points, &radii).unwrap())
        };
        let tubes = [tool(&mut random, Vector::ZERO), tool(&mut random, Vector::X * 12.0)];
        let pose = |random: &mut Random| {
            let Pose { rotation, translation } = random.pose(9.0);
            Pose::from_parts(translation * unit, rotation)
        };
        let place = pose(&mut random);
        let still = tubes.clone().map(|tube| RigidMotion::new(tube, [place; 2]).unwrap());
        let ends = match random.below(4) {
            0 => [
                place,
                Pose::from_parts(place.translation + Vector::Y * (200.0 * unit), place.rotation),
            ],
            1 => [place, Pose::from_parts(place.translation, pose(&mut random).rotation)],
            _ => [place, pose(&mut random)],
        };
        let carried = tubes.clone().map(|tube| RigidMotion::new(tube, ends).unwrap());
        // The same from the frame of a base that is itself turned.
        let bases = [pose(&mut random), pose(&mut random)];
        let on_base = carried.clone().map(|motion| MovingBase::new(motion, bases).unwrap());
        let resolution = 1e-4 * unit;
        let least = pair.clearance_of_motion(&still[0], &still[1], resolution).unwrap();
        let margin = least.lower - 10.0 * resolution;
        if margin <= 0.0 {
            continue;
        }
        seen += 1;
        turned += usize::from(ends[0].rotation != ends[1].rotation);
        let there = pair.clearance_of_motion(&carried[0], &carried[1], resolution).unwrap();
        assert!(there.resolved, "{there:?}");
        assert!(there.lower <= least.upper && least.lower <= there.upper, "{there:?} {least:?}");
        let at_rest = [counted(&still[0]), counted(&still[1])];
        assert!(
            pair.clears_motions(&at_rest[0], &at_rest[1], margin, resolution).unwrap().is_clear()
        );
        let moved = [counted(&carried[0]), counted(&carried[1])];
        let found = pair.clears_motions(&moved[0], &moved[1], margin, resolution).unwrap();
        assert!(found.is_clear(), "{found:?}");
        let counts = [&at_rest[0], &moved[0]].map(|motion| motion.shapes.get());
        assert!(counts[1] <= 2 * counts[0], "{counts:?}");
        // Both frames turn: their common motion is known to the length of the interval only.
        let found = pair.clears_motions(&on_base[0], &on_base[1], margin, resolution).unwrap();
        assert!(found.is_clear(), "{found:?}");
    }
    assert!(seen * 2 > rounds(24) && turned * 4 >= seen, "{seen} {turned}");
}

/// A robot and a mesh that are shifted together, and a structure that moves as the robot does.
#[test]
fn a_robot_that_moves_with_its_mesh_costs_as_at_rest() {
    // A floor of 2 x 50 triangles, and a rod 1.001 above it.
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for k in 0..=50_u32 {
        let x = Real::from(k) - 25.0;
        vertices.extend([Vector::new(x, -5.0, 0.0), Vector::new(x, 5.0, 0.0)]);
        if k > 0 {
            let a = 2 * k;
            triangles.extend([[a - 2, a - 1, a], [a, a - 1, a + 1]]);
        }
    }
    let rod = [Vector::new(-10.0, 0.0, 2.001), Vector::new(10.0, 0.0, 2.001)];
    let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    for shift in [Vector::Y * 200.0, Vector::new(30.0, -70.0, 110.0)] {
        let to: Vec<_> = vertices.iter().map(|vertex| vertex + shift).collect();
        let motion = LinearMotion::chain(&rod, &rod.map(|point| point + shift), &[1.0]).unwrap();
        let moving = counted(&motion);
        let found = search.clears_motion_while(&to, &moving, 1.0, 1e-4).unwrap();
        assert!(found.is_clear() && moving.shapes.get() <= 2, "{found:?} {}", moving.shapes.get());
        // The speed relative to the shift of the mesh is enough.
        let by_speed = BySpeed(&motion);
        let moving = counted(&by_speed);
        let found = search.clears_motion_while(&to, &moving, 1.0, 1e-4).unwrap();
        assert!(found.is_clear() && moving.shapes.get() <= 2, "{found:?} {}", moving.shapes.get());
        assert!(!search.clears_motion_while(&to, &motion, 1.002, 1e-4).unwrap().is_clear());
        // A robot at rest comes nearer to the mesh as the mesh moves.
        let still = LinearMotion::chain(&rod, &rod, &[1.0]).unwrap();
        let up: Vec<_> = vertices.iter().map(|vertex| vertex + Vector::Z * 0.1).collect();
        assert!(search.clears_motion_while(&up, &still, 0.9, 1e-4).unwrap().is_clear());
        assert!(!search.clears_motion_while(&up, &still, 0.902, 1e-4).unwrap().is_clear());
        assert!(search.clears_motion_while(&up, &still, 0.9005, 1e-4).unwrap().is_clear());
    }
    let tube = Tube::from(&Chain::from_centreline(&rod, &[1.0]).unwrap());
    for to in [
        Pose::from_translation(Vector::new(30.0, -70.0, 110.0)),
        Pose::rotation(Vector::new(0.7, -0.4, 1.1)),
        Pose::new(Vector::new(3.0, -7.0, 11.0), Vector::new(0.7, -0.4, 1.1)),
    ] {
        let mut scene = Scene::new();
        let floor = scene.add("floor", search.clone(), Some(1.0)).unwrap();
        let motion = RigidMotion::new(tube.clone(), [Pose::IDENTITY, to]).unwrap();
        let moving = counted(&motion);
        let ends = [(floor, StructureEnd::Pose(to))];
        let found = scene.clears_motion_while(&ends, &[&moving], 1e-4).unwrap();
        assert!(found.is_clear(), "{found:?} {to:?}");
        let shapes = moving.shapes.get();
        assert!(shapes <= 8, "{shapes}");
    }
}

/// A rod with flat ends rolls about its own axis, 3 from a wall, in any direction: it stays as far.
#[test]
fn a_roll_about_its_own_axis_moves_nothing() {
    let mut random = Random::new(3);
    for roll in [0.1, 1.0, 3.0] {
        for _ in 0..4 {
            let place = random.pose(5.0);
            let wall = [[-40.0, -40.0], [40.0, -40.0], [0.0, 60.0]]
                .map(|[x, y]| place * Vector::new(x, y, -4.0));
            let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]]).unwrap();
            let rod = [Vector::X * -10.0, Vector::X * 10.0];
            let tube = Tube::from(&Chain::cylinders(&rod, &[1.0]).unwrap());
            let about = Pose::rotation(Vector::X * roll);
            let motion = RigidMotion::new(tube, [place, place * about]).unwrap();
            let asked = counted(&motion);
            let found = search.clears_motion(&asked, 3.0 - 2e-4, 1e-4).unwrap();
            assert!(found.is_clear(), "{roll} {found:?}");
            assert!(asked.shapes.get() <= 4, "{roll} {}", asked.shapes.get());
            let least = search.clearance_of_motion(&motion, 1e-4).unwrap();
            assert!(least.resolved && least.lower <= 3.0 + 1e-12 && 3.0 - 1e-12 <= least.upper);
        }
    }
}

/// A base that moves under a path of many parts costs at most three times as many shapes as the
/// path at rest, and asks no part about another.
#[test]
fn a_base_under_a_path_is_linear_in_its_parts() {
    let (vertices, triangles) = parry_continuum::parry::shape::Ball::new(30.0).to_trimesh(32, 16);
    let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let parts = 200;
    let shape = |k: u32| {
        let turn = 0.05 * Real::from(k);
        [Vector::ZERO, Vector::Z * 5.0, Vector::new(3.0 * turn.cos(), 3.0 * turn.sin(), 9.0)]
    };
    let part = |k: u32| LinearMotion::chain(&shape(k), &shape(k + 1), &[1.0, 1.0]).unwrap();
    let path = MotionPath::new((0..parts).map(part).collect()).unwrap();
    let ends =
        [Pose::IDENTITY, Pose::new(Vector::new(1.0, 2.0, -3.0), Vector::new(0.2, -0.1, 0.3))];
    let moving = MovingBase::new(path.clone(), ends).unwrap();
    let at_rest = counted(&path);
    let mut least = |motion: &dyn Motion| search.clearance_of_motion(&motion, 1e-3).unwrap().lower;
    let near = least(&moving).min(least(&path)) - 0.1;
    for margin in [5.0, near] {
        assert!(search.clears_motion(&at_rest, margin, 1e-3).unwrap().is_clear());
        let asked = counted(&moving);
        assert!(search.clears_motion(&asked, margin, 1e-3).unwrap().is_clear());
        let counts = [at_rest.shapes.get(), asked.shapes.get()];
        assert!(counts[1] <= 3 * counts[0], "{counts:?} {margin}");
        at_rest.shapes.set(0);
    }
}

/// A motion that states a frame that is not its own.
struct Claims<M> {
    motion: M,
    frame: fn(&M, [Real; 2]) -> CommonFrame,
    speed: Speed,
}

impl<M: Motion> Motion for Claims<M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }

    fn common_frame(&self, times: [Real; 2]) -> Option<CommonFrame> {
        Some((self.frame)(&self.motion, times))
    }

    fn speed_in_frame(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
        self.speed
    }
}

#[test]
fn a_false_frame_is_refused() {
    let tube = Tube::from(
        &Chain::from_centreline(&[Vector::X, Vector::X + Vector::Z * 20.0], &[1.0]).unwrap(),
    );
    let ends = [Pose::IDENTITY, Pose::new(Vector::Y * 4.0, Vector::X * 0.5)];
    let motion = RigidMotion::new(tube, ends).unwrap();
    let none = Speed { point: 0.0, turn: 0.0 };
    for steps in [1, 10, 100] {
        assert_eq!(verify_motion(&motion, steps), Ok(()));
        let own =
            |frame, speed| verify_motion(&Claims { motion: motion.clone(), frame, speed }, steps);
        let right = |_: &RigidMotion, times: [Real; 2]| {
            let pose = |t: Real| Pose::new(Vector::Y * (4.0 * t), Vector::X * (0.5 * t));
            CommonFrame::between(times.map(pose), times).unwrap()
        };
        assert_eq!(own(right, none), Ok(()));
        // The shift alone; the turn alone; a frame at rest; one that runs ahead.
        let shift = |_: &RigidMotion, _: [Real; 2]| CommonFrame::shifting(Vector::Y * 4.0);
        let turn = |_: &RigidMotion, times: [Real; 2]| {
            CommonFrame::between(times.map(|t| Pose::rotation(Vector::X * (0.5 * t))), times)
                .unwrap()
        };
        let rest = |_: &RigidMotion, _: [Real; 2]| CommonFrame::shifting(Vector::ZERO);
        let fast = |_: &RigidMotion, times: [Real; 2]| {
            let pose = |t: Real| Pose::new(Vector::Y * (4.04 * t), Vector::X * (0.5 * t));
            CommonFrame::between(times.map(pose), times).unwrap()
        };
        for frame in [shift, turn, rest, fast] {
            let refused = own(frame, none);
            assert!(matches!(refused, Err(RobotError::LeavesFrame { .. })), "{refused:?}");
        }
        // 4 / 100 along, and what the axis is ahead by the turn: 0.04 x 0.5.
        assert_eq!(own(fast, Speed { point: 0.0605, turn: 0.0 }), Ok(()));
        assert!(own(fast, Speed { point: 0.0396, turn: 0.0 }).is_err());
        // In a shifted frame the tip, 20.02 from the axis, turns by 0.5.
        assert_eq!(own(shift, Speed { point: 0.5 * 20.1, turn: 0.5 }), Ok(()));
        assert!(own(shift, Speed { point: 0.5 * 19.0, turn: 0.5 }).is_err());
        let slow_turn = own(shift, Speed { point: 0.5 * 20.1, turn: 0.45 });
        assert!(matches!(slow_turn, Err(RobotError::LeavesFrame { is_turn: true, .. })));
        let infinite = own(right, Speed { point: Real::INFINITY, turn: 0.0 });
        assert!(infinite.is_err());
    }
    // All ready motions state frames of their own that hold.
    let (mut random, mut framed) = (Random::new(11), 0);
    for _ in 0..rounds(20) {
        let start = random.point() * 5.0;
        let (points, radii) = polyline(&mut random, start);
        let shift = random.point() * 30.0;
        let to: Vec<_> = points.iter().map(|&point| point + shift).collect();
        let linear = LinearMotion::chain(&points, &to, &radii).unwrap();
        let other = LinearMotion::chain(&to, &points, &radii).unwrap();
        let path = MotionPath::new(vec![linear.clone(), other]).unwrap();
        let once = MovingBase::new(path.clone(), [random.pose(9.0), random.pose(9.0)]).unwrap();
        let twice = MovingBase::new(once.clone(), [random.pose(9.0), random.pose(9.0)]).unwrap();
        for steps in [1, 3, 64] {
            assert_eq!(verify_motion(&linear, steps), Ok(()));
            assert_eq!(verify_motion(&path, steps), Ok(()));
            assert_eq!(verify_motion(&once, steps), Ok(()));
            assert_eq!(verify_motion(&twice, steps), Ok(()));
        }
        let all: [&dyn Motion; 4] = [&linear, &path, &once, &twice];
        framed += all.iter().filter(|motion| motion.common_frame([0.1, 0.2]).is_some()).count();
    }
    assert_eq!(framed, 4 * rounds(20));
}

/// Two robots that are carried in different ways: the bounds contain the distances of fine steps.
#[test]
fn bounds_hold_for_robots_that_are_carried_apart() {
    let (mut random, mut pair) = (Random::new(29), RobotPair::new());
    let mut seen = [0; 2];
    for _ in 0..rounds(24) {
        let mut robot = |base: Vector| {
            let (points, radii) = polyline(&mut random, base);
            let to: Vec<_> = points.iter().map(|&point| point + random.point()).collect();
            let inner = LinearMotion::chain(&points, &to, &radii).unwrap();
            let from = random.pose(4.0);
            let step = [0.0, 1e-9, 1.0, 1.0][random.below(4) as usize];
            let by = Pose::new(random.point() * (4.0 * step), random.direction() * (2.0 * step));
            let first = MovingBase::new(inner, [from, from * by]).unwrap();
            MovingBase::new(first, [Pose::IDENTITY, random.pose(3.0)]).unwrap()
        };
        let (first, second) = (robot(Vector::ZERO), robot(Vector::X * 9.0));
        let (mut one, mut other) = (
            Tube::from(&Chain::capsules(&straight(0.0), &[1.0]).unwrap()),
            Tube::from(&Chain::capsules(&straight(0.0), &[1.0]).unwrap()),
        );
        let mut truth = Real::INFINITY;
        for step in 0..=200 {
            let t = Real::from(step) / 200.0;
            let poses = [first.shape(t, &mut one).unwrap(), second.shape(t, &mut other).unwrap()];
            let found = pair.clearance(&one, &poses[0], &other, &poses[1], 1e-4).unwrap();
            truth = truth.min(found.upper);
        }
        let bounds = pair.clearance_of_motion(&first, &second, 1e-2).unwrap();
        assert!(bounds.lower <= truth + 1e-9, "{bounds:?} {truth}");
        seen[usize::from(bounds.upper > 0.0)] += 1;
        for margin in [0.0, truth, 0.9 * truth] {
            let found = pair.clears_motions(&first, &second, margin, 1e-3).unwrap();
            assert!(!found.is_clear() || margin < truth + 1e-9, "{found:?} {margin} {truth}");
        }
    }
    assert!(seen[1] > 0, "{seen:?}");
}

/// Two of three robots overlap: the nearest pair is bounded first, in every order of the robots.
#[test]
fn the_nearest_pair_of_a_scene_is_bounded_first() {
    let bending = |y: Real| {
        let from = BendingSection { length: 30.0, radius: 0.5, bend: [0.0, 0.0] };
        let to = BendingSection { bend: [0.04, 0.0], ..from };
        BendingMotion::new(&[from], &[to], Pose::from_translation(Vector::Y * y)).unwrap()
    };
    let places = [0.0, 20.0, 0.2];
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let motions = order.map(|k: usize| bending(places[k]));
        let asked = motions.each_ref().map(counted);
        let mut scene = Scene::new();
        scene.set_robot_margin(Some(0.0)).unwrap();
        let asked_for = [&asked[0], &asked[1], &asked[2]];
        let found = scene.clearance_of_motion(&asked_for, 1e-3).unwrap().unwrap();
        assert!(found.lower == 0.0 && found.upper < 1e-9, "{found:?}");
        let shapes: usize = asked.iter().map(|motion| motion.shapes.get()).sum();
        assert!(shapes <= 32, "{shapes} {order:?}");
    }
}
