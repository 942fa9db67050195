//! The limit of work of a motion query, and its answer at the limit.

use super::least::Counted;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, RobotPair, UndecidedReason};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, MovingBase, RigidMotion,
    RobotError, Speed, Tube,
};

const MOST_SHAPES: u64 = 1 << 16;

/// A square of 40 across z at a height.
fn floor(z: Real, unit: Real) -> BvhSearch {
    let corners = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]];
    let corners = corners.map(|[x, y]| Vector::new(x, y, z) * unit);
    BvhSearch::from_triangles(&corners, &[[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// A needle along x, whose side is `room` above z = 0.
fn needle(x: Real, y: Real, room: Real) -> [Vector; 2] {
    [Vector::new(x, y, 0.5 + room), Vector::new(x + 2.0, y, 0.5 + room)]
}

/// Without its courses.
struct Speeds<'a, M>(&'a M);

impl<M: Motion> Motion for Speeds<'_, M> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.0.speed(section, shares, times)
    }
}

/// What slides along a plane needs few shapes, however little room it has.
#[test]
fn a_slide_along_a_plane_takes_few_shapes() {
    let mut random = Random::new(61);
    for unit in [1.0, 1e-3, 1e-6] {
        let mut search = floor(0.0, unit);
        for resolution in [1e-2, 1e-4, 1e-6] {
            for room in [1.5, 2.5, 10.0] {
                let height = room * resolution;
                let (from, to) =
                    (needle(-5.0, 0.0, height), needle(5.0, random.between(-3.0, 3.0), height));
                let [from, to] = [from, to].map(|points| points.map(|point| point * unit));
                for motion in [LinearMotion::chain, LinearMotion::capsules] {
                    let motion = motion(&from, &to, &[0.5 * unit]).unwrap();
                    let counted = Counted::new(&motion);
                    let answer = search.clears_motion(&counted, 0.0, resolution * unit).unwrap();
                    assert!(answer.is_clear(), "{unit} {resolution} {room}: {answer:?}");
                    assert!(
                        counted.count() <= 64,
                        "{unit} {resolution} {room}: {} shapes",
                        counted.count()
                    );
                    let counted = Counted::new(&motion);
                    let least = search.clearance_of_motion(&counted, resolution * unit).unwrap();
                    assert!(
                        least.resolved && least.lower <= height * unit * (1.0 + 1e-6),
                        "{least:?}"
                    );
                    assert!(
                        counted.count() <= 64,
                        "{unit} {resolution} {room}: {} shapes",
                        counted.count()
                    );
                }
            }
        }
    }
    // Other motions along the plane; across the margin in the beginning.
    let section = BendingSection { length: 2.0, radius: 0.5, bend: [0.0, 0.0] };
    let still = BendingMotion::new(&[section], &[section], Pose::IDENTITY).unwrap();
    let at = |x: Real| {
        Pose::new(Vector::new(x, 0.0, 0.5 + 2.5e-6), Vector::Y * std::f64::consts::FRAC_PI_2)
    };
    let base = MovingBase::new(still, [at(-5.0), at(5.0)]).unwrap();
    let tube = Tube::from(&Chain::capsules(&needle(0.0, 0.0, 2.5e-6), &[0.5]).unwrap());
    let places = [-5.0, 5.0].map(|x| Pose::from_translation(Vector::X * x));
    let rigid = RigidMotion::new(tube, places).unwrap();
    let motions: [&dyn Motion; 2] = [&base, &rigid];
    for motion in motions {
        let counted = Counted::new(motion);
        let answer = floor(0.0, 1.0).clears_motion(&counted, 0.0, 1e-6).unwrap();
        assert!(
            answer.is_clear() && counted.count() < 64,
            "{} shapes: {answer:?}",
            counted.count()
        );
    }
}

/// No query tests more shapes than the documented limit, and it reports why it ends.
#[test]
fn a_question_ends_at_its_limit_and_says_so() {
    let (from, to) = (needle(-5.0, 0.0, 2.5e-6), needle(5.0, 0.0, 2.5e-6));
    let slide = LinearMotion::chain(&from, &to, &[0.5]).unwrap();
    let slide = Speeds(&slide);
    let mut search = floor(0.0, 1.0);
    let limit = Some(UndecidedReason::Work);
    for first in [false, true] {
        let counted = Counted::new(&slide);
        let answer = if first {
            search.time_of_contact(&counted, 0.0, 1e-6).unwrap()
        } else {
            search.clears_motion(&counted, 0.0, 1e-6).unwrap()
        };
        assert_eq!(
            (answer.decision, answer.reason),
            (Decision::Undecided, limit),
            "{first}: {answer:?}"
        );
        assert!(counted.count() == MOST_SHAPES, "{}", counted.count());
        assert!(answer.interval[0] < 0.9 && answer.interval[0] < answer.interval[1], "{answer:?}");
    }
    let vertices = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]]
        .map(|[x, y]| Vector::new(x, y, 0.0));
    let counted = Counted::new(&slide);
    let answer = search.clears_motion_while(&vertices, &counted, 0.0, 1e-6).unwrap();
    assert_eq!((answer.reason, counted.count()), (limit, MOST_SHAPES));
    // Two robots side by side.
    let beside = needle(0.0, 1.0 + 2.5e-6, 2.5e-6);
    let rests = LinearMotion::chain(&beside, &beside, &[0.5]).unwrap();
    let counted = Counted::new(&slide);
    let answer = RobotPair::new().clears_motions(&counted, &rests, 0.0, 1e-6).unwrap();
    assert_eq!((answer.decision, answer.reason), (Decision::Undecided, limit), "{answer:?}");
    assert!(counted.count() <= MOST_SHAPES, "{}", counted.count());
    // What stays within the resolution is not what ends for want of shapes.
    let ends = [-5.0, 5.0].map(|x| needle(x, 0.0, 5e-5));
    let near = LinearMotion::chain(&ends[0], &ends[1], &[0.5]).unwrap();
    let answer = search.clears_motion(&Speeds(&near), 0.0, 1e-4).unwrap();
    assert_eq!(
        (answer.decision, answer.reason),
        (Decision::Undecided, Some(UndecidedReason::Near))
    );
}
