//! Links that lose their length on the way, and links that nearly do.

use super::least::Counted;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, SelfQuery};
use parry_continuum::{Chain, LinearMotion, Motion, MotionPath, Tube, verify_motion};

/// More shapes than this are not needed for any room here.
const FEW: u64 = 400;

/// A mesh of one point.
fn point(place: Vector) -> BvhSearch {
    BvhSearch::from_triangles(&[place; 3], &[[0, 1, 2]]).unwrap()
}

/// A flat needle that grows out of nothing keeps free what is ahead of its tip, at every
/// resolution.
#[test]
fn a_needle_that_grows_out_of_nothing_keeps_its_margin() {
    for unit in [1.0, 1e-3, 1e-6, 1e3] {
        let base = [Vector::ZERO; 2];
        let grown = [Vector::ZERO, Vector::Z * (10.0 * unit)];
        let mut search = point(Vector::Z * (10.5 * unit));
        for begin in [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3] {
            let from = [base[0], Vector::Z * (10.0 * unit * begin)];
            let grows = LinearMotion::chain(&from, &grown, &[unit]).unwrap();
            let shrinks = LinearMotion::chain(&grown, &from, &[unit]).unwrap();
            let both = MotionPath::new(vec![grows.clone(), shrinks.clone()]).unwrap();
            for resolution in [1e-1, 1e-3, 1e-5] {
                let motions: [&dyn Motion; 3] = [&grows, &shrinks, &both];
                for motion in motions {
                    let counted = Counted::new(motion);
                    let mut decide = |margin| {
                        search.clears_motion(&counted, margin * unit, resolution * unit).unwrap()
                    };
                    let clear = decide(0.2);
                    assert!(clear.is_clear(), "{unit} {begin} {resolution}: {clear:?}");
                    let contact = decide(0.7).decision;
                    assert_eq!(contact, Decision::Contact, "{unit} {begin} {resolution}");
                    let shapes = counted.count();
                    assert!(shapes < FEW, "{unit} {begin} {resolution}: {shapes} shapes");
                }
            }
        }
    }
}

/// What is behind the base of a needle is free of a needle that has a length, however short; and
/// touched by one that has none, which is a ball.
#[test]
fn a_link_without_a_length_is_a_ball_for_a_moment() {
    let mut behind = point(Vector::Z * -0.5);
    let grown = [Vector::ZERO, Vector::Z * 10.0];
    let from = |length: Real| {
        LinearMotion::chain(&[Vector::ZERO, Vector::Z * length], &grown, &[1.0]).unwrap()
    };
    for length in [1e-9, 1e-6, 1e-3] {
        let answer = behind.clears_motion(&from(length), 0.2, 1e-3).unwrap();
        assert!(answer.is_clear(), "{length}: {answer:?}");
    }
    // At its beginning it is a ball, and at no other time.
    let ball = behind.clears_motion(&from(0.0), 0.2, 1e-3).unwrap();
    assert!(ball.decision == Decision::Undecided && ball.interval[1] < 1e-5, "{ball:?}");
    // On the way through nothing it is one in the middle.
    let through = LinearMotion::chain(&[Vector::ZERO, Vector::Z * -10.0], &grown, &[1.0]).unwrap();
    let mut beside = point(Vector::new(0.0, 1.3, 0.0));
    let answer = beside.clears_motion(&through, 0.2, 1e-3).unwrap();
    assert!(answer.is_clear(), "{answer:?}");
}

/// A link that nearly loses its length turns arbitrarily fast, and is still answered.
#[test]
fn a_link_that_nearly_loses_its_length_is_answered() {
    let mut ahead = point(Vector::Z * 10.5);
    for aside in [1e-15, 1e-12, 1e-9, 1e-6, 1e-3] {
        let from = [Vector::ZERO, Vector::new(aside, 0.0, -10.0)];
        let to = [Vector::ZERO, Vector::new(aside, 0.0, 10.0)];
        let motion = LinearMotion::chain(&from, &to, &[1.0]).unwrap();
        let counted = Counted::new(&motion);
        let answer = ahead.clears_motion(&counted, 0.2, 1e-3).unwrap();
        assert!(answer.is_clear(), "{aside}: {answer:?}");
        assert!(counted.count() < FEW, "{aside}: {} shapes", counted.count());
        let answer = ahead.clears_motion(&motion, 0.7, 1e-3).unwrap();
        assert_eq!(answer.decision, Decision::Contact, "{aside}: {answer:?}");
    }
}

/// Robots whose links grow out of nothing, go through nothing or nearly so, against their shapes in
/// steps.
#[test]
fn links_that_lose_their_length_are_never_misjudged() {
    losing(120, 41);
}

/// Fifty times as many.
#[test]
#[ignore = "ten seconds: run it by name"]
fn many_links_that_lose_their_length_are_never_misjudged() {
    losing(6_000, 42);
}

fn losing(count: usize, seed: u64) {
    const STEPS: u32 = 60;
    let mut random = Random::new(seed);
    let (mut clear, mut contact, mut undecided, mut shapes) = (0, 0, 0, 0);
    for round in 0..count {
        let unit = [1.0, 1e-3, 1e-6][round % 3];
        let links = 1 + random.below(3) as usize;
        let fading = random.below(links as u32) as usize;
        let axis = random.direction();
        let mut lengths =
            [[0.0; 2]; 3].map(|_: [Real; 2]| [0, 1].map(|_| random.between(0.2, 3.0)));
        // Out of nothing, to nothing, through nothing, or nearly.
        let little = [0.0, 1e-14, 1e-10, 1e-5][random.below(4) as usize];
        match random.below(3) {
            0 => lengths[fading][0] = little,
            1 => lengths[fading][1] = little,
            _ => lengths[fading][0] *= -1.0,
        }
        let aligned = random.below(2) == 0;
        let aside = random.direction() * (little * Real::from(random.below(2)));
        let mut ends = [[Vector::ZERO; 4]; 2];
        for (k, lengths) in lengths.iter().take(links).enumerate() {
            let way = if aligned || k == fading {
                axis
            } else {
                (axis + random.direction() * 0.5).normalize()
            };
            let turned = if k == fading || aligned {
                way
            } else {
                (way + random.direction() * 0.2).normalize()
            };
            ends[0][k + 1] =
                ends[0][k] + way * lengths[0] + aside * Real::from(u8::from(k == fading));
            ends[1][k + 1] =
                ends[1][k] + turned * lengths[1] + aside * Real::from(u8::from(k == fading));
        }
        let shift = random.direction() * [0.0, random.unit()][random.below(2) as usize];
        let at = random.direction() * [0.0, 5.0][random.below(2) as usize];
        let place = |point: Vector, shift: Vector| (point + shift + at) * unit;
        let from: Vec<_> =
            ends[0].iter().take(links + 1).map(|p| place(*p, Vector::ZERO)).collect();
        let to: Vec<_> = ends[1].iter().take(links + 1).map(|p| place(*p, shift)).collect();
        let radii: Vec<_> =
            (0..links).map(|_| [0.5, 0.5, 0.3][random.below(3) as usize] * unit).collect();
        let Ok(motion) = LinearMotion::chain(&from, &to, &radii) else { continue };
        let mut search = point(place(random.point() * 3.0, Vector::ZERO));
        let distances: Vec<_> = (0..=STEPS)
            .map(|step| {
                let t = Real::from(step) / Real::from(STEPS);
                let mut tube =
                    Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::X], &[1.0]).unwrap());
                let pose = motion.shape(t, &mut tube).unwrap();
                search.clearance(&tube, &pose, 1e-9 * unit).unwrap().upper
            })
            .collect();
        let least = distances.iter().copied().fold(Real::INFINITY, Real::min);
        for margin in [0.0, 0.5 * least, least - 0.05 * unit, least + 1e-2 * unit] {
            if margin < 0.0 {
                continue;
            }
            let counted = Counted::new(&motion);
            let answer = search.clears_motion(&counted, margin, 1e-3 * unit).unwrap();
            shapes = shapes.max(counted.count());
            match answer.decision {
                Decision::Clear => {
                    clear += 1;
                    assert!(least > margin, "{round}: clear, but {least} away, margin {margin}");
                }
                Decision::Contact => contact += 1,
                Decision::Undecided => undecided += 1,
            }
        }
    }
    println!("{clear} {contact} {undecided}, {shapes} shapes");
    let all = clear + contact + undecided;
    assert!(
        3 * clear > all && 10 * contact > all && 20 * undecided < all,
        "{clear} {contact} {undecided}"
    );
    assert!(shapes < 2_000, "{shapes}");
}

/// Self contact while a link grows from length 0.
#[test]
fn a_growing_robot_is_asked_about_itself() {
    let from = [Vector::ZERO, Vector::Z * 20.0, Vector::Z * 20.0];
    let to = [Vector::ZERO, Vector::Z * 20.0, Vector::Z * 30.0];
    let motion = LinearMotion::chain(&from, &to, &[1.0, 0.5]).unwrap();
    verify_motion(&motion, 50).unwrap();
    assert!(SelfQuery::new().clears_motion(&motion, 0.5, 1e-3).unwrap().is_clear());
    let pose =
        motion.shape(0.5, &mut Tube::from(&Chain::capsules(&from[..2], &[1.0]).unwrap())).unwrap();
    assert_eq!(pose, Pose::IDENTITY);
}
