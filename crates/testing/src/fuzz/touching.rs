//! The dispatcher with robots and walls that are aligned and touch, as in scenes, which random
//! poses never reach. Every query gives the same answer in either order and when repeated.

use super::source::Source;
use crate::Random;
use crate::placements::{Placement, Wall};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::{
    ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastOptions,
};
use parry_continuum::parry::shape::Shape;
use parry_continuum::{Chain, ContinuumDispatcher, ModifiedCylinder};

/// A wall and a robot, and the accuracy that their answers must have. All lengths are about 1.
struct Pair<'a> {
    g1: &'a dyn Shape,
    g2: &'a dyn Shape,
    /// The largest error if they are apart.
    apart: f64,
    /// The largest error if they overlap.
    overlapping: f64,
    /// The largest error of the place at which a cast ends.
    early: f64,
}

/// Runs touching and aligned placements, in both orders.
pub fn touching(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let kind = Wall::ALL[source.below(Wall::ALL.len() as u8)];
    let Placement { robot, wall, pose, .. } = Random::new(source.bits()).placement(kind);
    let pose = source.nudged(pose);
    let is_exact =
        !matches!(kind, Wall::Cuboid | Wall::Cone | Wall::ConvexPolyhedron | Wall::Compound);
    // The errors of parry's iterations are in the dispatcher's table, for shapes of size one.
    let (apart, overlapping) = if is_exact { (1e-11, 1e-9) } else { (1e-4, 0.1) };
    let early = if is_exact { 1e-8 } else { 1e-4 };
    let pair = |g1, g2| Pair { g1, g2, apart, overlapping, early };
    let there = pair(&*robot, &*wall).ask(&mut source, &pose);
    let back = pair(&*wall, &*robot).ask(&mut source, &pose.inverse());
    // A pose and its inverse differ in the last digit.
    let slack = if there.min(back) < 0.0 { overlapping } else { apart } + 1e-12;
    assert!((there - back).abs() <= slack, "{there} in one order, {back} in the other, {kind:?}");
}

impl Pair<'_> {
    fn problem(&self, pose: &Pose) -> String {
        let shown = |shape: &dyn Shape| match (
            shape.as_shape::<ModifiedCylinder>(),
            shape.as_shape::<Chain>(),
        ) {
            (Some(link), _) => format!("{link:?}"),
            (_, Some(chain)) => format!("{chain:?}"),
            _ => match shape.as_trimesh() {
                Some(mesh) => format!("{:?} {:?}", mesh.vertices(), mesh.indices()),
                None => format!("{:?}", shape.as_typed_shape()),
            },
        };
        format!("\n{}\n{}\n{pose:?}", shown(self.g1), shown(self.g2))
    }

    /// Returns the largest difference of two answers for the same pair.
    fn slack(&self, dist: f64) -> f64 {
        if dist < self.apart { self.overlapping } else { self.apart }
    }

    fn distance(&self, pose: &Pose) -> f64 {
        let answer = ContinuumDispatcher::default().distance(pose, self.g1, self.g2);
        answer
            .unwrap_or_else(|_| panic!("a pair in range is refused{}", self.problem(pose)))
            .distance
    }

    /// Runs every query at this pose. Returns the distance, negative in overlap.
    fn ask(&self, source: &mut Source, pose: &Pose) -> f64 {
        let dispatcher = ContinuumDispatcher::default();
        let problem = || self.problem(pose);
        let apart = self.distance(pose);
        assert!(apart >= 0.0 && apart.is_finite(), "distance {apart}{}", problem());
        let touches = dispatcher
            .intersection_test(pose, self.g1, self.g2)
            .expect("a pair in range")
            .intersecting;
        let contact = |prediction| {
            let contact =
                dispatcher.contact(pose, self.g1, self.g2, prediction).expect("a pair in range");
            contact.map(|contact| contact.dist)
        };
        let whole =
            contact(f64::MAX).unwrap_or_else(|| panic!("no contact however far{}", problem()));
        assert!(whole.is_finite(), "a contact of {whole}{}", problem());
        assert!(
            (whole.max(0.0) - apart).abs() <= self.apart,
            "a contact of {whole} at {apart}{}",
            problem()
        );
        // At contact rounding decides.
        let agree = if touches { whole <= self.apart } else { whole >= -self.apart };
        assert!(agree, "touches: {touches}, {whole}{}", problem());
        for prediction in [f64::INFINITY, 0.0, 0.05, -0.05, -f64::INFINITY, whole, source.number()]
        {
            if prediction.is_nan() {
                continue;
            }
            match contact(prediction) {
                Some(dist) => {
                    assert!(
                        dist <= prediction,
                        "{dist} beyond the prediction {prediction}{}",
                        problem()
                    );
                    assert!(
                        (dist - whole).abs() <= self.slack(whole),
                        "{dist} and {whole}{}",
                        problem()
                    );
                }
                None => {
                    let least = prediction - self.slack(whole);
                    assert!(whole > least, "nothing within {prediction}, but {whole}{}", problem());
                }
            }
        }
        self.manifolds(source, pose, whole);
        self.casts(source, pose);
        whole
    }

    /// Asserts that the least distance of a manifold is that of the contact, at first and after a
    /// small motion.
    fn manifolds(&self, source: &mut Source, pose: &Pose, whole: f64) {
        let prediction = [0.0, 0.02, 0.3][source.below(3)];
        let dispatcher = ContinuumDispatcher::default();
        let ask = |pose: &Pose, (manifolds, workspace): &mut (Vec<ContactManifold<(), ()>>, _)| {
            let asked = dispatcher
                .contact_manifolds(pose, self.g1, self.g2, prediction, manifolds, workspace);
            asked.expect("a pair in range");
            let points = manifolds.iter().flat_map(|manifold| &manifold.points);
            points
                .map(|point| point.dist)
                .reduce(|least, dist| if dist < least { dist } else { least })
        };
        let mut kept = (Vec::new(), None);
        let check = |pose: &Pose, least: Option<f64>, whole: f64| {
            let problem = || self.problem(pose);
            assert!(
                least.is_none_or(|least| least.is_finite()),
                "a contact of {least:?}{}",
                problem()
            );
            if whole < prediction - self.slack(whole) {
                assert!(
                    least.is_some(),
                    "no contact within {prediction}, but {whole}{}",
                    problem()
                );
            }
            if let Some(least) = least {
                let off = (least - whole).abs();
                assert!(off <= self.slack(whole), "{least} in the manifold, {whole}{}", problem());
                assert!(
                    least <= prediction + self.slack(whole),
                    "{least} beyond {prediction}{}",
                    problem()
                );
            }
        };
        let first = ask(pose, &mut kept);
        check(pose, first, whole);
        let again = ask(pose, &mut kept);
        check(pose, again, whole);
        let moved = source.nudged(*pose);
        let goes_on = ask(&moved, &mut kept);
        let contact =
            dispatcher.contact(&moved, self.g1, self.g2, f64::MAX).expect("a pair in range");
        if let Some(contact) = contact {
            check(&moved, goes_on, contact.dist);
        }
    }

    /// Asserts that casts are never late, from a touching start too.
    fn casts(&self, source: &mut Source, pose: &Pose) {
        let dispatcher = ContinuumDispatcher::default();
        let way = source.way();
        let target = [0.0, 0.0, 0.01][source.below(3)];
        let longest = 2.0;
        let options = ShapeCastOptions {
            target_distance: target,
            ..ShapeCastOptions::with_max_time_of_impact(longest)
        };
        let hit = dispatcher.cast_shapes(pose, way, self.g1, self.g2, options);
        if let Ok(hit) = hit {
            let at = |time: f64| Pose::from_translation(way * time) * *pose;
            self.never_late(
                "cast",
                pose,
                hit.map_or(longest, |hit| hit.time_of_impact),
                target,
                at,
            );
            if let Some(hit) = hit.filter(|hit| hit.time_of_impact > 0.0) {
                let there = self.distance(&at(hit.time_of_impact));
                assert!(
                    there <= target + self.early,
                    "a cast ends at {there}: {way:?}{}",
                    self.problem(pose)
                );
            }
        }
        let turning = source.way() * 0.5;
        let still = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
        let moving = NonlinearRigidMotion::new(*pose, Vector::ZERO, way, turning);
        let hit =
            dispatcher.cast_shapes_nonlinear(&still, self.g1, &moving, self.g2, 0.0, longest, true);
        if let Ok(hit) = hit {
            let at = |time| moving.position_at_time(time);
            self.never_late(
                "nonlinear",
                pose,
                hit.map_or(longest, |hit| hit.time_of_impact),
                0.0,
                at,
            );
        }
    }

    /// Returns whether the two overlap by more than rounding.
    fn is_deep(&self, pose: &Pose) -> bool {
        let contact = ContinuumDispatcher::default().contact(pose, self.g1, self.g2, 0.0);
        contact.is_ok_and(|contact| contact.is_some_and(|contact| contact.dist < -self.apart))
    }

    /// Asserts that before the time of a hit the two are farther apart than the target.
    fn never_late(
        &self,
        cast: &str,
        pose: &Pose,
        time: f64,
        target: f64,
        at: impl Fn(f64) -> Pose,
    ) {
        let samples = if time > 0.0 { 16 } else { 0 };
        for k in 0..samples {
            let before = time * f64::from(k) / f64::from(samples);
            let there = self.distance(&at(before));
            // The poses of the samples are rounded, and so are the distances there.
            let is_late = if target > 0.0 {
                there < target - self.apart
            } else {
                there == 0.0 && self.is_deep(&at(before))
            };
            assert!(
                !is_late,
                "{cast} says {time}, but at {before} they are {there} apart{}",
                self.problem(pose)
            );
        }
    }
}
