//! A tube beside itself, against distances from derivations, and against chains.

use super::robots::robot;
use super::tube::{all_ways, fine, from_function};
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, ProximityError, SelfQuery};
use parry_continuum::{Chain, Tube, TubeSection};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A tube of one radius along a curve by arc length, and its curvature at most.
fn along(
    length: f64,
    radius: f64,
    curvature: f64,
    curve: impl Fn(f64) -> (Vector, Vector) + Send + Sync + 'static,
) -> Tube {
    let tube = Tube::from_function(&[TubeSection { length, radius, curvature }], curve).unwrap();
    tube.verify(100).unwrap();
    tube
}

/// A circle's coil by arc length: `rise` is the pitch over 2 pi.
#[derive(Clone, Copy, Debug)]
struct Coil {
    radius: f64,
    rise: f64,
}

impl Coil {
    /// The way along it for 1 rad.
    fn speed(self) -> f64 {
        self.radius.hypot(self.rise)
    }

    fn at(self, angle: f64) -> Vector {
        Vector::new(self.radius * angle.cos(), self.radius * angle.sin(), self.rise * angle)
    }

    fn curvature(self) -> f64 {
        self.radius / self.speed().powi(2) * (1.0 + 1e-12)
    }

    fn tube(self, angle: f64, thickness: f64) -> Tube {
        let speed = self.speed();
        along(angle * speed, thickness, self.curvature(), move |s| {
            let angle = s / speed;
            let way = Vector::new(-self.radius * angle.sin(), self.radius * angle.cos(), self.rise);
            (self.at(angle), way / speed)
        })
    }

    fn samples(self, angle: f64, thickness: f64, count: u32) -> Tube {
        let points: Vec<_> =
            (0..=count).map(|k| self.at(angle * f64::from(k) / f64::from(count))).collect();
        let ends = [0.0, angle]
            .map(|a| Vector::new(-self.radius * a.sin(), self.radius * a.cos(), self.rise));
        Tube::with_constant_radius(&points, thickness, Some(ends)).unwrap()
    }

    fn frames(self, angle: f64, thickness: f64, count: u32) -> Tube {
        let angles = (0..=count).map(|k| angle * f64::from(k) / f64::from(count));
        let (points, ways): (Vec<_>, Vec<_>) = angles
            .map(|a| {
                (self.at(a), Vector::new(-self.radius * a.sin(), self.radius * a.cos(), self.rise))
            })
            .unzip();
        Tube::from_frames(&points, &ways, &vec![thickness; count as usize]).unwrap()
    }

    /// How far the axes of neighbouring turns are apart: at the angle near 2 pi where R^2 sin(phi)
    /// + rise^2 phi = 0.
    fn chord(self) -> f64 {
        let slope = |phi: f64| self.radius * self.radius * phi.sin() + self.rise * self.rise * phi;
        let (mut low, mut high) = (1.5 * PI, 2.5 * PI);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if slope(middle) < 0.0 { low = middle } else { high = middle }
        }
        (2.0 * self.radius * self.radius * (1.0 - low.cos()) + (self.rise * low).powi(2)).sqrt()
    }
}

#[test]
fn neighbouring_turns_of_a_coil_are_as_far_apart_as_an_equation_says() {
    let mut query = SelfQuery::new();
    for pitch in [0.79, 0.81, 1.0, 2.0, 3.5] {
        let coil = Coil { radius: 3.0, rise: pitch / (2.0 * PI) };
        let (angle, thickness) = (4.2 * PI, 0.4);
        let apart = coil.chord() - 2.0 * thickness;
        let tube = coil.tube(angle, thickness);
        let mut decide =
            |margin: f64, resolution| query.clears_tube(&tube, margin, resolution).unwrap();
        if apart < 0.0 {
            assert_eq!(decide(0.0, 1e-9), Decision::Contact);
        } else {
            // The whole coil is equally near itself, so that more digits would take more pieces
            // than a query divides it into.
            assert_eq!(decide(apart - 1e-4, 2e-5), Decision::Clear, "{pitch}");
            assert_eq!(decide(apart + 1e-9, 1e-10), Decision::Contact, "{pitch}");
            // A distance of exactly the margin is never a proven contact.
            assert_ne!(decide(apart, 1e-4), Decision::Contact, "{pitch}");
            assert_eq!(decide(0.0, 1e-5), Decision::Clear);
        }
        // Samples leave open k l^2 / 8 of each part on either side of what they show, together
        // 1.5e-3; frames less.
        for tube in [coil.samples(angle, thickness, 420), coil.frames(angle, thickness, 126)] {
            for off in [-0.1, -4e-3, 4e-3, 0.1] {
                let right = if off < 0.0 { Decision::Clear } else { Decision::Contact };
                if apart + off >= 0.0 {
                    let decision = query.clears_tube(&tube, apart + off, 2e-3).unwrap();
                    assert_eq!(decision, right, "{pitch}, {off}");
                }
            }
        }
        // The stated error of both parts widens each bound, and slightly more at the rim of a face.
        let tube = tube.with_error(0.05).unwrap();
        for (off, right) in [
            (-0.13, Decision::Clear),
            (-0.09, Decision::Undecided),
            (0.09, Decision::Undecided),
            (0.13, Decision::Contact),
        ] {
            if apart + off >= 0.0 {
                assert_eq!(
                    query.clears_tube(&tube, apart + off, 0.02).unwrap(),
                    right,
                    "{pitch}, {off}"
                );
            }
        }
    }
}

/// A robot that bends much: up to five stretches, each an arc or two, that turn by up to a whole
/// turn.
pub(super) fn winding(random: &mut Random) -> Arcs {
    let mut all = Arcs::from_frame(random.pose(1.0));
    let mut angle = random.between(0.0, 7.0);
    for _ in 0..2 + random.below(3) {
        let radius = random.between(0.05, 0.5);
        let arcs: Vec<_> = (0..2)
            .map(|_| {
                let curvature = random.between(0.1, 0.8) / 1.5;
                angle += random.between(-0.5, 0.5);
                let length = random.between(0.3, 5.5) / curvature;
                (length, Vector::new(angle.cos(), angle.sin(), 0.0) * curvature)
            })
            .collect();
        all.push(radius, &arcs);
    }
    all
}

/// A chain is a tube whose pieces are straight.
#[test]
fn chains_are_tubes_of_straight_pieces() {
    let mut random = Random::new(2);
    let (mut query, mut apart, mut touching, mut none) = (SelfQuery::new(), 0, 0, 0);
    for round in 0..1500 {
        let chain = robot(&mut random, 12);
        let tube = Tube::from(&chain);
        let Ok(found) = SelfQuery::new().minimum(&chain) else {
            let error = query.clears_tube(&tube, 0.0, 0.0).unwrap_err();
            assert_eq!(error.kind(), "joint_too_sharp");
            continue;
        };
        let mut ask = |margin: f64| query.clears_tube(&tube, margin, 1e-9).unwrap();
        match found {
            None => {
                assert_eq!(ask(1e6), Decision::Clear, "{round}");
                none += 1;
            }
            Some(found) => {
                let slack = 1e-8 * (1.0 + found.distance);
                if found.distance > slack {
                    assert_eq!(ask(found.distance - slack), Decision::Clear, "{round}: {found:?}");
                    apart += 1;
                } else {
                    touching += 1;
                }
                assert_eq!(ask(found.distance + slack), Decision::Contact, "{round}: {found:?}");
            }
        }
    }
    assert!(apart > 100 && touching > 20 && none > 100, "{apart} {touching} {none}");
}

/// A straight leg, a bend of the radius `bend` that turns by `turn`, and a leg back.
fn hairpin(turn: f64, bend: f64, legs: [f64; 2], radius: f64) -> Arcs {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(radius, &[(legs[0], Vector::ZERO)]);
    arcs.push(radius, &[(turn * bend, Vector::X / bend)]);
    arcs.push(radius, &[(legs[1], Vector::ZERO)]);
    arcs
}

#[test]
fn a_straight_tube_never_meets_itself() {
    let mut query = SelfQuery::new();
    let points: Vec<_> = (0..20).map(|k| Vector::Z * f64::from(k)).collect();
    let steps: Vec<_> = (0..19).map(|k| 1.5 - 0.5 * f64::from(k / 7)).collect();
    let mut tubes = vec![along(50.0, 3.0, 0.0, |s| (Vector::X * s, Vector::X))];
    tubes.push(Tube::with_constant_radius(&points, 0.5, None).unwrap());
    tubes.push(Tube::from_samples(&points, &steps, None).unwrap());
    tubes.push(from_function(&Arc::new(hairpin(0.48 * PI, 2.0, [3.0, 1.0], 0.9))));
    for tube in tubes {
        for margin in [0.0, 1.0, 1e6] {
            assert_eq!(query.clears_tube(&tube, margin, 1e-6).unwrap(), Decision::Clear);
        }
    }
}

#[test]
fn legs_of_a_hairpin_meet_if_it_turns_by_more_than_half_a_turn() {
    let mut query = SelfQuery::new();
    let (bend, leg, radius) = (10.0, 60.0, 1.5);
    for beyond in [-0.2, -0.01, 0.01, 0.05, 0.2] {
        let turn = PI + beyond;
        let arcs = Arc::new(hairpin(turn, bend, [leg, leg], radius));
        let tube = from_function(&arcs);
        // In the plane of the bend, the tips are nearest at two points of their rims.
        let width = 2.0 * bend * (0.5 * turn).sin() + 2.0 * leg * (0.5 * turn).cos();
        let apart = width - 2.0 * radius * (0.5 * beyond).cos();
        for margin in [0.0, 1.0, 5.0, 10.0, 16.0, 16.9] {
            let decision = query.clears_tube(&tube, margin, 1e-6).unwrap();
            let right =
                if beyond < 0.0 || margin < apart { Decision::Clear } else { Decision::Contact };
            assert_eq!(decision, right, "{beyond}: {margin} of {apart}");
        }
        if beyond > 0.02 {
            assert!(beyond < 0.1 || apart < 16.0);
            for (off, right) in [(-1e-8, Decision::Clear), (1e-8, Decision::Contact)] {
                if apart + off > 0.0 {
                    assert_eq!(
                        query.clears_tube(&tube, apart + off, 1e-9).unwrap(),
                        right,
                        "{beyond}"
                    );
                }
            }
        }
        // A margin wider than the bend may stay undecided, but no false contact is reported.
        if beyond < 0.0 {
            assert_ne!(query.clears_tube(&tube, 1e3, 1e-6).unwrap(), Decision::Contact);
        }
    }
    // Exactly half a turn: as wide as its waist, anywhere along the legs.
    let tube = from_function(&Arc::new(hairpin(PI, bend, [leg, leg], radius)));
    // Nearer than the resolution at which pieces of a bend are known to turn enough or not.
    assert_eq!(query.clears_tube(&tube, 17.0 - 1e-5, 2e-6).unwrap(), Decision::Clear);
    assert_eq!(query.clears_tube(&tube, 17.0 + 1e-9, 1e-10).unwrap(), Decision::Contact);
}

/// A thick tube, a thin one out of its face that bends by `turn` and goes on straight.
fn bent_back(turn: f64, reach: f64) -> Arcs {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(3.0, &[(10.0, Vector::ZERO)]);
    arcs.push(0.2, &[(1.0, Vector::ZERO), (turn, Vector::X), (reach, Vector::ZERO)]);
    arcs
}

#[test]
fn a_thin_tube_that_bends_back_stands_on_the_face_of_its_step() {
    let mut query = SelfQuery::new();
    let mut above = 0;
    for (turn, reach) in
        [(PI, 0.75), (0.6 * PI, 2.5), (0.7 * PI, 2.5), (0.8 * PI, 1.4), (0.9 * PI, 0.9)]
    {
        let arcs = Arc::new(bent_back(turn, reach));
        let chain =
            SelfQuery::new().minimum(&fine(&arcs, Chain::cylinders)).unwrap().unwrap().distance;
        for (way, tube) in all_ways(&arcs).iter().enumerate() {
            for (off, right) in [
                (-0.05, Decision::Clear),
                (-2e-3, Decision::Clear),
                (2e-3, Decision::Contact),
                (0.05, Decision::Contact),
            ] {
                match query.clears_tube(tube, chain + off, 1e-3) {
                    Ok(decision) if way == 0 => {
                        assert_eq!(decision, right, "{turn}, way {way}, {off} of {chain}")
                    }
                    Ok(decision) => assert!(decision == right || decision == Decision::Undecided),
                    Err(ProximityError::ToleranceTooFine { .. }) if way > 0 => {}
                    Err(error) => panic!("{error}"),
                }
            }
        }
        // The lowest point of the tip: beside the tube's first leg, and ahead of the face.
        let (sin, cos) = turn.sin_cos();
        let [beside, ahead] =
            [1.0 - cos + reach * sin + 0.2 * cos, 1.0 + sin + reach * cos - 0.2 * sin];
        if beside <= 3.0 {
            let tube = from_function(&arcs);
            for (off, right) in [(-1e-8, Decision::Clear), (1e-8, Decision::Contact)] {
                assert_eq!(
                    query.clears_tube(&tube, ahead + off, 1e-9).unwrap(),
                    right,
                    "{turn}: {ahead}"
                );
            }
            above += 1;
        }
    }
    assert_eq!(above, 3);
}

#[test]
fn two_steps_face_one_another() {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    for (radius, length) in [(2.0, 3.0), (0.5, 2.0), (2.0, 3.0)] {
        arcs.push(radius, &[(length, Vector::ZERO)]);
    }
    let tube = from_function(&Arc::new(arcs));
    let mut query = SelfQuery::new();
    assert_eq!(query.clears_tube(&tube, 2.0 - 1e-8, 1e-9).unwrap(), Decision::Clear);
    assert_eq!(query.clears_tube(&tube, 2.0 + 1e-8, 1e-9).unwrap(), Decision::Contact);
}

/// Round three quarters of a turn, and straight on until the tip stands before the tube's own side.
#[test]
fn a_tip_stands_against_its_own_side() {
    let mut query = SelfQuery::new();
    let (bend, radius) = (4.0, 0.5);
    for apart in [1e-3, 0.3, 2.0] {
        // The bend ends `bend` beside the leg, beyond it, and heads for it.
        let arcs = Arc::new(hairpin(1.5 * PI, bend, [20.0, bend - radius - apart], radius));
        let chain =
            SelfQuery::new().minimum(&fine(&arcs, Chain::cylinders)).unwrap().unwrap().distance;
        assert!((chain - apart).abs() < 1e-4, "{chain} {apart}");
        let tube = from_function(&arcs);
        assert_eq!(
            query.clears_tube(&tube, apart - 1e-8, 1e-9).unwrap(),
            Decision::Clear,
            "{apart}"
        );
        assert_eq!(
            query.clears_tube(&tube, apart + 1e-8, 1e-9).unwrap(),
            Decision::Contact,
            "{apart}"
        );
    }
    // Into it.
    let tube =
        from_function(&Arc::new(hairpin(1.5 * PI, bend, [20.0, bend - 0.9 * radius], radius)));
    assert_eq!(query.clears_tube(&tube, 0.0, 1e-9).unwrap(), Decision::Contact);
}

/// A trefoil, whose parts pass one another three times.
#[test]
fn a_knot_is_as_thick_as_it_can_be() {
    let point = |t: f64| {
        Vector::new(
            t.sin() + 2.0 * (2.0 * t).sin(),
            t.cos() - 2.0 * (2.0 * t).cos(),
            -(3.0 * t).sin(),
        ) * 5.0
    };
    let count = 4000_u32;
    let at = |k: u32| point(0.3 + 5.9 * f64::from(k) / f64::from(count));
    let points: Vec<_> = (0..=count).map(at).collect();
    let radius = 1.0;
    // Places with a turn of pi between them, sampled.
    let (mut turned, mut least) = (vec![0.0_f64; 2], f64::INFINITY);
    for k in 1..count as usize {
        let [a, b] = [points[k] - points[k - 1], points[k + 1] - points[k]];
        turned.push(turned[k] + a.cross(b).length().atan2(a.dot(b)));
    }
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            if turned[j] - turned[i] >= PI {
                least = least.min((points[i] - points[j]).length() - 2.0 * radius);
            }
        }
    }
    let tube = Tube::with_constant_radius(&points, radius, None).unwrap();
    let mut query = SelfQuery::new();
    assert!(least > 1.0, "{least}");
    // Samples are 0.03 apart: next to the nearest two places are some that are 1.5e-4 farther
    // apart.
    assert_eq!(query.clears_tube(&tube, least - 5e-4, 2.5e-4).unwrap(), Decision::Clear, "{least}");
    assert_eq!(
        query.clears_tube(&tube, least + 5e-4, 2.5e-4).unwrap(),
        Decision::Contact,
        "{least}"
    );
}

/// A finer resolution never revokes a decision.
#[test]
fn a_finer_resolution_decides_no_less() {
    let (mut random, mut query) = (Random::new(31), SelfQuery::new());
    let (mut decided, mut gained) = (0, 0);
    for _ in 0..rounds(400) {
        let coil = Coil { radius: random.between(1.0, 4.0), rise: random.between(0.1, 0.2) };
        // Margins that are narrow beside the resolutions, at about the clearance.
        let apart = random.between(0.0, 0.3 * coil.chord());
        let (thickness, angle) = (0.5 * (coil.chord() - apart), random.between(7.0, 14.0));
        let tube = match random.below(2) {
            0 => coil.tube(angle, thickness),
            _ => coil.samples(angle, thickness, 300),
        };
        let off = random.between(-0.2, 0.2);
        let (margin, mut coarser) = ((apart + off).max(0.0), None);
        let mut resolution = 1.0;
        while resolution > 0.04 {
            let finer = query.clears_tube(&tube, margin, resolution).ok();
            let finer = finer.filter(|decision| *decision != Decision::Undecided);
            assert!(
                coarser.is_none() || finer == coarser,
                "{margin} {resolution}: {coarser:?} {finer:?} {coil:?} {thickness} {angle}"
            );
            gained += usize::from(finer.is_some() && coarser.is_none());
            coarser = finer;
            resolution *= 0.9;
        }
        decided += usize::from(coarser.is_some());
    }
    assert!(decided > rounds(100) && gained > rounds(100), "{decided} {gained}");
}

/// Evaluations of a coil's curve for margins slightly off the truth: they grow as the root of
/// 1 / resolution.
#[test]
fn the_work_grows_like_the_root_of_the_resolution() {
    let coil = Coil { radius: 3.0, rise: 0.3 };
    let (speed, thickness) = (coil.speed(), 0.4);
    let asked = Arc::new(AtomicU64::new(0));
    let counter = Arc::clone(&asked);
    let tube = along(6.0 * PI * speed, thickness, coil.curvature(), move |s| {
        counter.fetch_add(1, Ordering::Relaxed);
        let angle = s / speed;
        (coil.at(angle), Vector::new(-3.0 * angle.sin(), 3.0 * angle.cos(), 0.3) / speed)
    });
    let apart = coil.chord() - 2.0 * thickness;
    let work = |off: f64| {
        let before = asked.load(Ordering::Relaxed);
        assert_eq!(
            SelfQuery::new().clears_tube(&tube, apart - off, 0.5 * off).unwrap(),
            Decision::Clear
        );
        asked.load(Ordering::Relaxed) - before
    };
    let [coarse, fine] = [1e-2, 1e-4].map(work);
    // A hundred times finer: ten times the pieces, each along the whole of the coil.
    assert!(fine < 15 * coarse, "{coarse} {fine}");
}

#[test]
fn what_is_wrong_is_named() {
    let coil = Coil { radius: 3.0, rise: 0.3 };
    let tight = Tube::from_function(
        &[
            TubeSection { length: 5.0, radius: 0.1, curvature: 0.0 },
            TubeSection { length: 5.0, radius: 0.1, curvature: 11.0 },
        ],
        |s| (Vector::Z * s, Vector::Z),
    );
    // Its ends are flat, so the same limit applies.
    assert_eq!(tight.unwrap_err().kind(), "bends_within_radius");
    // Two straight legs, and between them a bend of the radius 1, far from the faces.
    let frame = |k: u32| {
        let turn = (0.2 * (f64::from(k) - 40.0)).clamp(0.0, 1.6);
        let leg = 0.5 * (f64::from(k) - 48.0).max(0.0);
        let way = Vector::new(turn.sin(), 0.0, turn.cos());
        let along = 0.5 * f64::from(k.min(40));
        (Vector::new(1.0 - turn.cos(), 0.0, along + turn.sin()) + way * leg, way)
    };
    let (points, ways): (Vec<_>, Vec<_>) = (0..=68).map(frame).unzip();
    let bent = Tube::from_frames(&points, &ways, &[1.2; 68]).unwrap();
    let error = SelfQuery::new().clears_tube(&bent, 0.0, 0.1).unwrap_err();
    assert_eq!(error.kind(), "bends_within_radius");
    assert!(error.to_string().contains("arc length"), "{error}");
    let tube = coil.tube(9.0, 0.2);
    for (margin, resolution) in [(-1.0, 0.1), (f64::NAN, 0.1), (0.1, -1.0), (0.1, f64::NAN)] {
        assert_eq!(
            SelfQuery::new().clears_tube(&tube, margin, resolution).unwrap_err().kind(),
            "negative"
        );
    }
}

#[test]
fn a_scaled_problem_has_the_scaled_answer() {
    let mut random = Random::new(3);
    let mut seen = [0; 3];
    for _ in 0..100 {
        let arcs = winding(&mut random);
        let (points, radii) = arcs.samples(0.25, &[]);
        let margin = random.between(0.0, 2.0) * random.unit();
        let at = |scale: f64| {
            let points: Vec<_> = points.iter().map(|point| point * scale).collect();
            let radii: Vec<_> = radii.iter().map(|radius| radius * scale).collect();
            let tube = Tube::from_samples(&points, &radii, None).ok()?;
            Some(
                SelfQuery::new()
                    .clears_tube(&tube, margin * scale, 0.03 * scale)
                    .map_err(|error| error.kind()),
            )
        };
        let unit = at(1.0);
        for power in [-200, -1, 40, 200] {
            assert_eq!(at(2.0_f64.powi(power)), unit);
        }
        if let Some(Ok(decision)) = unit {
            seen[decision as usize] += 1;
        }
    }
    assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
}
