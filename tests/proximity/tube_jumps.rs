//! Tubes from samples whose curvature jumps anywhere, mostly between two samples and next to faces.

use continuum_testing::{Arcs, Random};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Clearance, Decision, ProximityError};
use parry_continuum::{Tube, TubeSection};
use std::sync::Arc;

/// A speck of a wall.
fn speck(at: Vector, size: f64, random: &mut Random) -> BvhSearch {
    let corners = [at, at + random.direction() * size, at + random.direction() * size];
    BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap()
}

/// The finest bounds that the samples allow, beginning with a tolerance.
fn finest(search: &mut BvhSearch, tube: &Tube, tolerance: f64) -> Clearance {
    search.forget();
    search.clearance(tube, &Pose::IDENTITY, tolerance).unwrap()
}

/// A tube that is bent up to 0.3 and straight from there on, sampled at every 1, behind a face at z
/// = 0. A speck is 0.02 ahead of its rim.
#[test]
fn a_joint_next_to_a_face_leaves_its_direction_open() {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    // About y: the curve bends towards x.
    let bend = Vector::Y * 0.1;
    arcs.push(1.0, &[(0.3, bend), (5.7, Vector::ZERO), (14.0, bend)]);
    let (points, radii) = arcs.samples(1.0, &[]);
    assert_eq!(points.len(), 21);
    let rim = Vector::new(-1.0, 0.0, -0.02);
    let corners = [rim, rim - Vector::X * 1e-6, rim - Vector::Z * 1e-6];
    let mut search =
        BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    for tangents in [None, Some(arcs.end_tangents())] {
        let tube = Tube::from_samples(&points, &radii, tangents).unwrap();
        let found = finest(&mut search, &tube, 1e-6);
        assert!(found.lower <= 0.02 && 0.02 - 2e-6 <= found.upper, "{found:?}");
        let cleared = search.clears_tube(&tube, &Pose::IDENTITY, 0.0293, 0.1);
        assert!(!matches!(cleared, Ok(Decision::Clear)), "{cleared:?}");
        // Directions that are given leave nothing open.
        assert_eq!(tangents.is_some(), found.upper - found.lower < 1e-5, "{found:?}");
    }
}

/// Arcs in one plane or in many, of any length from a tenth of the spacing on, and what a section
/// of each bends at most.
fn jumping(random: &mut Random, spacing: f64) -> Arcs {
    let mut arcs =
        Arcs::from_frame(if random.below(2) == 0 { Pose::IDENTITY } else { random.pose(3.0) });
    let plane = random.between(0.0, 7.0);
    let (is_plane, helical) = (random.below(2) == 0, random.below(4) == 0);
    for _ in 0..=random.below(2) {
        let curvature =
            [0.02, 0.1, 0.3][random.below(3) as usize] / spacing * random.between(0.5, 1.0);
        let radius = random.between(0.05, 0.95) / curvature;
        let mut angle = plane;
        let mut arc = |length: f64, share: f64, random: &mut Random| {
            if helical {
                angle += random.between(0.0, 0.8);
            } else if !is_plane {
                angle = random.between(0.0, 7.0);
            }
            (length, Vector::new(angle.cos(), angle.sin(), 0.0) * (curvature * share))
        };
        // Long enough for two segments, wherever they begin: its curvature shows.
        let mut all = vec![arc(spacing * random.between(3.0, 6.0), 1.0, random)];
        for _ in 0..=random.below(4) {
            let length =
                spacing * [0.1, 1.0, 1.0, 5.0][random.below(4) as usize] * random.between(0.0, 1.0);
            let share = [0.0, 1.0, -1.0, random.between(-1.0, 1.0)][random.below(4) as usize];
            let at = random.below(all.len() as u32 + 1) as usize;
            all.insert(at, arc(length.max(1e-3 * spacing), share, random));
        }
        arcs.push(radius, &all);
    }
    arcs
}

/// Whether the samples show how much each section bends, as the documentation means it.
fn show_the_curvature(points: &[Vector], radii: &[f64], arcs: &Arcs) -> bool {
    let mut from = 0;
    arcs.stretches.iter().all(|stretch| {
        let count = radii[from..].iter().take_while(|radius| **radius == stretch.radius).count();
        let own = &points[from..=from + count];
        from += count;
        let shown = own.windows(3).map(|three| {
            let [a, b] = [three[1] - three[0], three[2] - three[1]];
            (b.normalize() - a.normalize()).length() / (0.5 * (a.length() + b.length()))
        });
        shown.fold(0.0, f64::max) >= stretch.curvature * (1.0 - 1e-12)
    })
}

#[derive(Debug, Default)]
struct Seen {
    asked: usize,
    hidden: usize,
    free: usize,
    face: usize,
    near: usize,
    decided: usize,
    wrong: usize,
}

/// Specks next to faces, rims, steps and sides.
fn judge(random: &mut Random, rounds: usize) -> Seen {
    let mut seen = Seen::default();
    for _ in 0..rounds {
        let spacing = [0.3, 1.0][random.below(2) as usize];
        let arcs = Arc::new(jumping(random, spacing));
        let (points, radii) = arcs.samples(spacing, &[]);
        if arcs.stretches.windows(2).any(|pair| pair[0].radius == pair[1].radius)
            || !show_the_curvature(&points, &radii, &arcs)
        {
            seen.hidden += 1;
            continue;
        }
        let sections: Vec<_> = arcs
            .stretches
            .iter()
            .map(|part| TubeSection {
                length: part.length,
                radius: part.radius,
                curvature: part.curvature,
            })
            .collect();
        let curve = Arc::clone(&arcs);
        let Ok(exact) = Tube::from_function(&sections, move |s| curve.at(s)) else { continue };
        let ways =
            [None, Some(arcs.end_tangents())].map(|ends| Tube::from_samples(&points, &radii, ends));
        // Next to the base, the tip or the step, or anywhere.
        let joint = arcs.stretches[0].length;
        let s =
            [0.0, arcs.length(), joint, arcs.length() * random.unit()][random.below(4) as usize];
        let (centre, tangent) = arcs.at(s);
        let widest = arcs.stretches.iter().fold(0.0, |most: f64, part| part.radius.max(most));
        let radius =
            if s == joint { widest } else { arcs.stretches[usize::from(s > joint)].radius };
        let across = tangent.cross(random.direction()).normalize();
        let out = [-1.0, 1.0, 0.0][random.below(3) as usize];
        let gap = radius * [1e-3, 1e-2, 0.1][random.below(3) as usize] * random.between(0.1, 1.0);
        // On a rim, in the face, beside it.
        let at = centre
            + across
                * (radius * [1.0, 1.0, 0.9, 1.0 + random.unit() * 0.1][random.below(4) as usize])
            + tangent * (out * gap)
            + if out == 0.0 { across * gap } else { Vector::ZERO };
        let mut search = speck(at, 1e-3 * gap, random);
        let truth = search.clearance(&exact, &Pose::IDENTITY, 1e-4 * gap).unwrap();
        seen.free += usize::from(truth.lower > 0.0);
        for tube in ways.into_iter().flatten() {
            seen.asked += 1;
            seen.face += usize::from(out != 0.0);
            search.forget();
            let found = finest(&mut search, &tube, 1e-3 * gap);
            let is_wrong = found.lower > truth.upper || found.upper < truth.lower;
            seen.near += usize::from(found.lower > 0.5 * truth.lower);
            search.forget();
            let margin = truth.upper;
            let decision = search.clears_tube(&tube, &Pose::IDENTITY, margin, 1e-3 * gap);
            let is_misjudged = match decision {
                Ok(Decision::Clear) => true,
                Ok(_) => {
                    seen.decided += 1;
                    false
                }
                Err(ProximityError::ToleranceTooFine { .. }) => false,
                Err(error) => panic!("{error}"),
            };
            let below = truth.lower * (1.0 - 1e-9);
            search.forget();
            let touches = search.clears_tube(&tube, &Pose::IDENTITY, below, 1e-3 * gap);
            let is_misjudged =
                is_misjudged || truth.lower > 0.0 && touches == Ok(Decision::Contact);
            if is_wrong || is_misjudged {
                seen.wrong += 1;
                if seen.wrong < 5 {
                    println!(
                        "{found:?} {decision:?} {touches:?} {truth:?} {gap} {out} at {s} of {arcs:?}"
                    );
                }
            }
        }
    }
    seen
}

#[test]
fn jumps_between_samples_are_never_misjudged() {
    let rounds = std::env::var("JUMPS").map_or(3_000, |n| n.parse().unwrap());
    let seed = std::env::var("SEED").map_or(1, |n| n.parse().unwrap());
    let seen = judge(&mut Random::new(seed), rounds);
    println!("{seen:?}");
    assert!(seen.asked > rounds && seen.free > rounds / 4 && seen.face > rounds / 2, "{seen:?}");
    assert_eq!(seen.wrong, 0, "{seen:?}");
    assert!(seen.near > seen.asked / 4 && seen.decided > seen.asked / 4, "{seen:?}");
}
