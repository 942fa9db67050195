//! When a motion first comes as near as a margin.

use super::{Steps, anatomy, random_edge};
use continuum_demo::{ctr, ventricle};
use continuum_testing::Random;
use parry_continuum::parry::math::Real;
use parry_continuum::proximity::Decision;

/// The bracket of the first contact is as narrow as the resolution, where the motion goes straight into the wall.
#[test]
fn the_first_contact_is_found() {
    let mut search = anatomy();
    let (robot, mut random, mut found, mut later) = (ctr::three_tubes(), Random::new(5), 0, 0);
    while found < 60 {
        let motion = random_edge(&robot, &mut random, 8.0);
        let steps = Steps::new(&mut search, 300, 1e-3, |t| (motion.tube(t).unwrap(), ventricle::entry()));
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
                let at = search.clearance(&motion.tube(t).unwrap(), &ventricle::entry(), 1e-6).unwrap();
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
