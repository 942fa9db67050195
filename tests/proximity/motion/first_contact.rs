//! When a motion first comes as near as a margin.

use super::{Steps, anatomy, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::LinearMotion;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{BvhSearch, Decision, RobotPair};

/// The bracket of the first contact is as narrow as the resolution, where the motion goes straight
/// into the wall.
#[test]
fn the_first_contact_is_found() {
    let mut search = anatomy();
    let (robot, mut random, mut found, mut later) = (ctr::three_tubes(), Random::new(5), 0, 0);
    while found < rounds(60) {
        let motion = random_edge(&robot, &mut random, 8.0);
        let steps =
            Steps::new(&mut search, 300, 1e-3, |t| (motion.tube(t).unwrap(), ventricle::entry()));
        let margin = random.between(0.0, 0.5);
        if steps.bounds[0][0] <= margin {
            continue;
        }
        let answer = search.time_of_contact(&motion, margin, 1e-3).unwrap();
        let step = |t: Real| (t * 300.0).ceil() as usize;
        match (answer.decision, steps.first_touch(margin)) {
            (Decision::Contact, first) => {
                let [clear_until, t] = answer.interval;
                assert!(steps.bounds[..step(clear_until)].iter().all(|bounds| bounds[1] > margin));
                assert!(first.is_none_or(|first| clear_until <= first as Real / 300.0));
                let at =
                    search.clearance(&motion.tube(t).unwrap(), &ventricle::entry(), 1e-6).unwrap();
                assert!(at.lower <= margin);
                found += 1;
                // Not just any contact: the speed is at most some 40 mm in all.
                later += usize::from(t - clear_until > 1e-3);
            }
            (Decision::Clear, first) => assert_eq!(first, None),
            (Decision::Undecided, _) => {}
        }
    }
    assert!(later <= 3, "{later} of {found}");
}

/// A resolution of a billionth of the way: what keeps the margin is clear, as for a coarser one,
/// and the first contact is bracketed as finely.
#[test]
fn a_resolution_far_finer_than_the_motion_is_kept() {
    let (vertices, triangles) = Ball::new(1.0).to_trimesh(4, 2);
    let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let needle = |x: Real, y: Real| [Vector::new(x, y, 0.0), Vector::new(x + 1.0, y, 0.0)];
    let moves = |from: [Vector; 2], to: [Vector; 2]| LinearMotion::capsules(&from, &to, &[0.5]);
    let passes = moves(needle(-50.0, 3.0), needle(50.0, 3.0)).unwrap();
    let meets = moves(needle(-52.5, 0.0), needle(47.5, 0.0)).unwrap();
    let rests = moves(needle(0.5, 0.0), needle(0.5, 0.0)).unwrap();
    let mut pair = RobotPair::new();
    for resolution in [1e-3, 1e-7, 1e-9] {
        assert!(search.clears_motion(&passes, 0.5, resolution).unwrap().is_clear());
        assert!(pair.clears_motions(&passes, &rests, 0.5, resolution).unwrap().is_clear());
        // The tip comes from -51.5 and is at -1.5, or beside the other robot at -0.5, after 50 of
        // 100 or 51.
        let beside_mesh = search.time_of_contact(&meets, 0.0, resolution).unwrap();
        let beside_robot = pair.time_of_contact(&meets, &rests, 0.0, resolution).unwrap();
        for ([clear_until, t], first) in
            [(beside_mesh.interval, 0.5), (beside_robot.interval, 0.51)]
        {
            assert!(clear_until <= first && first <= t + 1e-14, "{clear_until} {t}");
            assert!(100.0 * (t - clear_until) <= 1.5 * resolution + 1e-12, "{clear_until} {t}");
        }
    }
}

/// A wire that slides in a wall's plane, apart from it by rounding at most: no shape decides,
/// however fine, and a million intervals have room in the way. The first of them is all that can be
/// said.
#[test]
fn what_slides_in_the_plane_of_a_wall_is_soon_given_up() {
    let tip = Vector::new(0.0, 1.5e-5, 5.5e-310);
    let wall =
        [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]].map(Vector::from);
    let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let motion = |from: Real, to: Real| {
        let shift = |way: Real| [Vector::X * way + tip, Vector::X * way + Vector::Z * 5.5e-310];
        LinearMotion::chain(&shift(from), &shift(to), &[0.0]).unwrap()
    };
    let found = search.time_of_contact(&motion(-1.0, 1.0), 0.0, 1.5e-6).unwrap();
    assert!(found.decision != Decision::Clear && found.interval[0] <= 1e-6, "{found:?}");
    let shapes = search.work().measured;
    assert!(shapes < 100_000, "{shapes}");
}
