//! When a motion first comes as near as a margin.

use super::{Steps, anatomy, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::{Random, rounds};
use parry_continuum::LinearMotion;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision};

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
