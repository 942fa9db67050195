//! Tubes against their discs, one by one: what a curve is where sections are about as short as they
//! are thick, near faces and joints. A fine chain is no truth there, because the rims of its tilted
//! links stand out.

use crate::tube::all_ways;
use continuum_testing::narrow_phase::triangle_disc;
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision};
use std::sync::Arc;

/// The error of the sampled discs at the size of these scenes, and how near they come to a touched
/// triangle.
const OFF: Real = 1e-4;
const TOUCHING: Real = 1e-3;

/// Sections from a tenth of their radius to three times as long, most of them as thick as the one
/// before.
fn short_sections(random: &mut Random) -> Arcs {
    let mut arcs =
        Arcs::from_frame(Pose::new(random.point(), random.direction() * random.between(0.0, 3.0)));
    let mut radius = random.between(0.2, 0.6);
    for _ in 0..=random.below(3) {
        if random.below(2) == 0 {
            radius *= [0.5, 0.9, 1.0, 1.1, 2.0][random.below(5) as usize];
        }
        let mut part = |_| {
            let angle = random.between(0.0, 7.0);
            let length =
                radius * [0.1, 1.0, 1.2, 3.0][random.below(4) as usize] * random.between(0.8, 1.2);
            (
                length,
                Vector::new(angle.cos(), angle.sin(), 0.0) * (random.between(0.0, 0.95) / radius),
            )
        };
        let parts = [0, 1].map(&mut part);
        arcs.push(radius, &parts[..1 + random.below(2) as usize]);
    }
    arcs
}

/// A triangle near a face or a joint.
fn near_an_end(random: &mut Random, arcs: &Arcs) -> TriMesh {
    let number = random.below(arcs.stretches.len() as u32 + 1) as usize;
    let s: Real = arcs.stretches[..number].iter().map(|part| part.length).sum();
    let radius = arcs.stretches[number.saturating_sub(1)].radius;
    let (centre, tangent) = arcs.at(s);
    let across = tangent.cross(random.direction()).normalize() * random.between(0.0, 1.3);
    let place = centre + (across + tangent * random.between(-0.3, 0.3)) * radius;
    let size = radius * [0.01, 0.1, 2.0][random.below(3) as usize];
    let vertices = (0..3).map(|_| place + random.direction() * size).collect();
    TriMesh::new(vertices, vec![[0, 1, 2]]).unwrap()
}

/// The distance to the nearest disc: of many, and ever closer around the nearest of each section.
fn distance(arcs: &Arcs, mesh: &TriMesh) -> Real {
    let corners = mesh.triangle(0).vertices().map(Vec3::from);
    let (mut least, mut start) = (Real::INFINITY, 0.0);
    for part in &arcs.stretches {
        let end = start + part.length;
        let at = |s: Real| {
            let (centre, tangent) = arcs.at(s);
            triangle_disc(corners, centre.into(), tangent.into(), part.radius).distance
        };
        let nearest = |around: Real, width: Real, count: i32| {
            let places =
                (-count..=count).map(|k| around + width * Real::from(k) / Real::from(count));
            let all = places.map(|s| s.max(start).min(end)).map(|s| (at(s), s));
            all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
        };
        let mut width = 0.5 * part.length;
        let mut best = nearest(start + width, width, 600);
        width /= 600.0;
        for _ in 0..8 {
            best = nearest(best.1, width, 8);
            width /= 6.0;
        }
        (least, start) = (least.min(best.0), end);
    }
    least
}

#[test]
fn short_sections_are_their_discs() {
    let mut random = Random::new(9);
    let (mut free, mut touching, mut answers, mut too_fine) = (0, 0, 0, 0);
    for round in 0..rounds(1_500) {
        let arcs = Arc::new(short_sections(&mut random));
        let mesh = near_an_end(&mut random, &arcs);
        let truth = distance(&arcs, &mesh);
        let mut search = BvhSearch::new(&mesh).unwrap();
        let context = || format!("{truth} in round {round}: {:?}", arcs.stretches);
        for (way, tube) in all_ways(&arcs).iter().enumerate() {
            for tolerance in [1.0, 0.1, 0.01, 0.003] {
                let found = search.clearance(tube, &Pose::IDENTITY, tolerance).unwrap();
                // Samples leave the direction of a face open where the curvature changes next to
                // it.
                assert!(found.resolved || way > 0, "way {way}, {}", context());
                too_fine += usize::from(!found.resolved);
                assert!(found.lower <= truth + OFF, "way {way}: {found:?} for {}", context());
                let is_touched = found.upper <= 0.0 && truth <= TOUCHING;
                assert!(
                    is_touched || truth <= found.upper + OFF,
                    "way {way}: {found:?} for {}",
                    context()
                );
                let decision = search.clears_tube(
                    tube,
                    &Pose::IDENTITY,
                    truth + OFF + 0.2 * tolerance,
                    0.5 * tolerance,
                );
                assert!(
                    decision != Ok(Decision::Clear),
                    "way {way}: clear of more than {}",
                    context()
                );
                answers += 1;
            }
        }
        if truth > TOUCHING { free += 1 } else { touching += 1 }
    }
    assert!(
        free > rounds(400) && touching > rounds(400) && too_fine < answers / 4,
        "{free} {touching} {answers} {too_fine}"
    );
}
