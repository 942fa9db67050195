//! Tests each bound against dense sampling of curves of known curvature.

use super::placed_tube::{Piece, PlacedTube};
use super::refinable::Body;
use crate::curve::{Section, Tube, TubeSection};
use crate::distance::{Vec3, point_modified_cylinder};
use continuum_testing::{Arcs, Random, Stretch};
use parry3d_f64::math::{Pose, Real, Vector};
use std::sync::Arc;

fn random_arcs(random: &mut Random) -> Arcs {
    let frame = random.pose(10.0);
    Arcs::random(random, frame, 1.0)
}

/// Returns the tube as a function, and from samples where these show the curvature of every arc.
fn tubes(random: &mut Random, arcs: &Arc<Arcs>) -> Vec<Tube> {
    let curve = Arc::clone(arcs);
    let sections = arcs
        .stretches
        .iter()
        .map(|&Stretch { length, radius, curvature }| TubeSection { length, radius, curvature });
    let function = Tube::from_function(&sections.collect::<Vec<_>>(), move |s| curve.at(s));
    let (points, radii) = arcs.samples(arcs.shortest() / random.between(3.5, 8.0), &[]);
    let given = Tube::from_samples(&points, &radii, Some(arcs.end_tangents()));
    let measured = Tube::from_samples(&points, &radii, None);
    [function, given, measured].into_iter().flatten().collect()
}

/// Visits points of the tube between two arc lengths: on the rims of discs, and on the ball at a
/// round end.
fn points_between(
    random: &mut Random,
    arcs: &Arcs,
    section: &Section,
    [from, to]: [Real; 2],
    mut visit: impl FnMut(Vector),
) {
    for k in 0..=40 {
        let (centre, tangent) = arcs.at(from + (to - from) * Real::from(k) / 40.0);
        let across = tangent.cross(random.direction()).normalize();
        visit(centre + across * section.radius);
        visit(centre + tangent.cross(across) * section.radius);
    }
    for (end, is_there) in [from <= section.start, to >= section.end].into_iter().enumerate() {
        if is_there && section.faces[end].is_none() {
            let (centre, tangent) = arcs.at([from, to][end]);
            let is_cut = |point: Vector| {
                section.faces[1 - end]
                    .is_some_and(|face| (point - face.centre).dot(face.outward) > -1e-9)
            };
            for _ in 0..20 {
                let point = centre + random.direction() * section.radius;
                let ahead = (point - centre).dot(tangent) * if end == 0 { -1.0 } else { 1.0 };
                if ahead > 0.0 && !is_cut(point) {
                    visit(point);
                }
            }
        }
    }
}

/// Returns the arc length of the curve at a tick of the tube. Curve and tube share the ends of
/// sections.
fn true_arc(arcs: &Arcs, tube: &Tube, number: usize, tick: u32) -> Real {
    let section = &tube.sections()[number];
    let start: Real = arcs.stretches[..number].iter().map(|stretch| stretch.length).sum();
    let share = Real::from(tick - section.first) / Real::from(section.last - section.first);
    start + arcs.stretches[number].length * share
}

#[test]
fn bodies_hold_their_pieces() {
    let mut random = Random::new(1);
    let (mut checked, mut flat, mut faces, mut tight) = (0, 0, 0, 0);
    for _ in 0..600 {
        let arcs = Arc::new(random_arcs(&mut random));
        for tube in tubes(&mut random, &arcs) {
            assert_eq!(tube.sections().len(), arcs.stretches.len());
            let placed = PlacedTube::new(&tube, &Pose::IDENTITY, 0.0).unwrap();
            for (number, section) in tube.sections().iter().enumerate() {
                for _ in 0..6 {
                    let ticks = section.last - section.first;
                    let size = (ticks / [1, 2, 5, 20][random.below(4) as usize]).max(1);
                    let from = match random.below(3) {
                        0 => section.first,
                        1 => section.last - size,
                        _ => section.first + random.below(ticks - size + 1),
                    };
                    let piece = Piece { section: number as u32, from, to: from + size };
                    let outer = placed.outer(&piece);
                    let [start, end] = [outer.body.start(), outer.body.end()].map(Vec3::from);
                    let (radius, caps) = (outer.body.radius(), outer.body.flat());
                    let between =
                        [from, from + size].map(|tick| true_arc(&arcs, &tube, number, tick));
                    // The curve ends exactly here; the arc length is rounded.
                    let section = Section { start: between[0], end: between[1], ..*section };
                    let section = Section {
                        start: if from == section.first { section.start } else { -1.0 },
                        end: if from + size == section.last { section.end } else { 1e9 },
                        ..section
                    };
                    points_between(&mut random, &arcs, &section, between, |point| {
                        let beyond =
                            point_modified_cylinder(Vec3::from(point), start, end, radius, caps)
                                .distance;
                        assert!(
                            beyond <= 0.0,
                            "{beyond} out of {outer:?} of {piece:?} in {section:?}"
                        );
                        checked += 1;
                    });
                    flat += usize::from(outer.is_flat());
                    faces += usize::from(section.faces.iter().any(Option::is_some));
                    tight += usize::from(outer.excess < 0.01 * section.radius);
                }
            }
        }
    }
    assert!(
        checked > 100_000 && flat > 1_000 && faces > 1_000 && tight > 1_000,
        "{checked} {flat} {faces} {tight}"
    );
}

/// The capsule of a run of pieces contains the balls along the curve between its ends, over joints
/// and steps in radius. A nearly straight run has one; arcs give a tight one.
#[test]
#[cfg(feature = "robots")]
fn capsules_of_runs_hold_the_curve() {
    let mut random = Random::new(5);
    let (mut checked, mut long, mut tight) = (0, 0, 0);
    for _ in 0..600 {
        let arcs = Arc::new(random_arcs(&mut random));
        for tube in tubes(&mut random, &arcs) {
            let placed = PlacedTube::new(&tube, &Pose::IDENTITY, 0.0).unwrap();
            let mut pieces = Vec::new();
            placed.begin_along(0.02, |piece| pieces.push(piece));
            for _ in 0..6 {
                let from = random.below(pieces.len() as u32) as usize;
                let count = 1 + random.below((pieces.len() - from) as u32) as usize;
                let [first, last] = [from, from + count - 1].map(|place| &pieces[place]);
                let Some((ends, radius)) = placed.around_run([first, last]) else { continue };
                let arc = |section: u32, tick| true_arc(&arcs, &tube, section as usize, tick);
                let between = [arc(first.section, first.from), arc(last.section, last.to)];
                let sections = first.section..=last.section;
                for k in 0..=60 {
                    let at = between[0] + (between[1] - between[0]) * Real::from(k) / 60.0;
                    let own = |number: u32| {
                        let section = &tube.sections()[number as usize];
                        let range = [section.first, section.last].map(|tick| arc(number, tick));
                        let is_here = (range[0]..=range[1]).contains(&at);
                        if is_here { section.radius } else { 0.0 }
                    };
                    let radius_here = sections.clone().map(own).fold(0.0, Real::max);
                    let [start, end] = ends.map(Vec3::from);
                    let place = Vec3::from(arcs.at(at).0);
                    let beside =
                        point_modified_cylinder(place, start, end, 0.0, [false; 2]).distance;
                    assert!(
                        beside + radius_here <= radius + 1e-9,
                        "{beside} + {radius_here} > {radius}: {first:?} {last:?}"
                    );
                    checked += 1;
                }
                long += usize::from(first.section != last.section);
                let widest = placed.widest();
                let length = between[1] - between[0];
                tight += usize::from(radius < widest + 0.16 * length);
            }
        }
    }
    assert!(checked > 100_000 && long > 300 && tight > 1_000, "{checked} {long} {tight}");
}

/// Returns the distance of a point from a section: from its discs, and from the half balls beyond
/// the discs at round ends. The other half of such a ball may stick out of the section's own face:
/// it is no part of the tube.
fn distance(arcs: &Arcs, tube: &Tube, number: usize, x: Vector) -> Real {
    let section = &tube.sections()[number];
    let start: Real = arcs.stretches[..number].iter().map(|stretch| stretch.length).sum();
    let end = start + arcs.stretches[number].length;
    let mut least = distance_from_discs(arcs, [start, end], section.radius, x);
    for (end, s) in [start, end].into_iter().enumerate() {
        let (centre, tangent) = arcs.at(s);
        let ahead = (x - centre).dot(tangent) * if end == 0 { -1.0 } else { 1.0 };
        // If x is not ahead of a half ball, the disc is nearest.
        if section.faces[end].is_none() && ahead > 0.0 {
            least = least.min(((x - centre).length() - section.radius).max(0.0));
        }
    }
    least
}

/// Returns the distance of a point from the discs between two arc lengths, by successively finer
/// sampling.
fn distance_from_discs(arcs: &Arcs, [start, end]: [Real; 2], radius: Real, x: Vector) -> Real {
    let from_disc = |s: Real| {
        let (centre, tangent) = arcs.at(s);
        let ahead = (x - centre).dot(tangent);
        let across = (x - centre - tangent * ahead).length();
        ahead.hypot((across - radius).max(0.0))
    };
    let mut least = Real::INFINITY;
    // Refine around each local minimum of the first sampling.
    let first = |k: i32| start + (end - start) * Real::from(k.clamp(0, 800)) / 800.0;
    for k in 0..=800 {
        let here = from_disc(first(k));
        if here > from_disc(first(k - 1)) || here > from_disc(first(k + 1)) {
            continue;
        }
        let (mut around, mut step) = (first(k), (end - start) / 8_000.0);
        for _ in 0..6 {
            let near = (-12..=12).map(|k| (around + step * Real::from(k)).max(start).min(end));
            let best = near.map(|s| (from_disc(s), s)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            least = least.min(best.0);
            (around, step) = (best.1, step / 10.0);
        }
    }
    least
}

#[test]
fn witnesses_are_no_nearer_than_the_tube() {
    let mut random = Random::new(2);
    let (mut checked, mut ahead, mut touching, mut loose) = (0, 0, 0, 0.0_f64);
    for _ in 0..150 {
        let arcs = Arc::new(random_arcs(&mut random));
        for tube in tubes(&mut random, &arcs) {
            let placed = PlacedTube::new(&tube, &Pose::IDENTITY, 0.0).unwrap();
            for (number, section) in tube.sections().iter().enumerate() {
                for _ in 0..10 {
                    let s = random.between(section.start, section.end);
                    let s = [s, s, section.start, section.end][random.below(4) as usize];
                    let (centre, tangent) = arcs.at(s);
                    let x = centre
                        + tangent.cross(random.direction())
                            * (section.radius * random.between(0.5, 2.0))
                        + tangent
                            * (section.radius
                                * [0.0, random.between(-1.0, 1.0)][random.below(2) as usize]);
                    let witness = placed.near(number as u32, s, x);
                    let truth = distance(&arcs, &tube, number, x);
                    assert!(
                        witness.upper >= truth - 1e-6 * section.radius,
                        "{witness:?} but {truth} from {x} to {section:?}"
                    );
                    checked += 1;
                    touching += usize::from(truth <= 0.0);
                    ahead += usize::from(truth > 0.0 && (s <= section.start || s >= section.end));
                    if tube.samples_around(section, 0.5).is_none() {
                        loose = loose.max((witness.upper - truth) / section.radius);
                    }
                }
            }
        }
    }
    assert!(checked > 3_000 && touching > 200 && ahead > 300, "{checked} {touching} {ahead}");
    println!("{loose}");
}

/// Sections with one flat and one round end that are shorter than their radius: straight, as links
/// of a chain, and bent. The distance of a point ahead of the face is its distance from the face,
/// even inside the ball at the other end.
#[test]
fn witnesses_know_that_a_short_section_ends_at_its_face() {
    let mut random = Random::new(4);
    let (mut links, mut bent, mut tight) = (0, 0, 0);
    for _ in 0..300 {
        let radius = random.between(0.2, 2.0);
        let mut arc = |least: Real, most: Real| {
            let angle = random.between(0.0, 7.0);
            let bend = [0.0, random.between(0.3, 0.95) / radius][random.below(2) as usize];
            (
                radius * random.between(least, most),
                Vector::new(angle.cos(), angle.sin(), 0.0) * bend,
            )
        };
        let (short, long) = (arc(0.02, 0.9), arc(1.0, 3.0));
        let wider = radius * [1.0, 1.1][random.below(2) as usize];
        let mut arcs = Arcs::from_frame(random.pose(10.0));
        let is_turned = random.below(2) == 1;
        if is_turned {
            arcs.push(wider, &[long]);
        }
        arcs.push(radius, &[short]);
        if !is_turned {
            arcs.push(wider, &[long]);
        }
        let (arcs, number) = (Arc::new(arcs), usize::from(is_turned));
        let points = [0.0, arcs.stretches[0].length, arcs.length()].map(|s| arcs.at(s).0);
        let chain = crate::Chain::from_centreline(
            &points,
            &arcs.stretches.iter().map(|stretch| stretch.radius).collect::<Vec<_>>(),
        )
        .unwrap();
        let straight = Tube::from(&chain);
        let curved = tubes(&mut random, &arcs);
        for tube in std::iter::once(&straight)
            .chain(curved.iter().filter(|tube| tube.sections().len() == 2))
        {
            let section = &tube.sections()[number];
            let end = number;
            let (Some(face), None) = (section.faces[end], section.faces[1 - end]) else {
                continue;
            };
            let placed = PlacedTube::new(tube, &Pose::IDENTITY, 0.0).unwrap();
            let (link, is_link) = (&chain.links()[number], std::ptr::eq(tube, &straight));
            let other = [link.end(), link.start()][end];
            for _ in 0..10 {
                let across = face.outward.cross(random.direction()) * random.between(0.0, radius);
                let x = face.centre + across + face.outward * (radius * random.between(-0.2, 1.0));
                let witness =
                    placed.near(number as u32, random.between(section.start, section.end), x);
                let truth = if is_link {
                    let [start, end] = [link.start(), link.end()].map(Vec3::from);
                    point_modified_cylinder(Vec3::from(x), start, end, radius, link.flat()).distance
                } else {
                    distance(&arcs, tube, number, x)
                };
                assert!(
                    witness.upper >= truth - 1e-6 * radius,
                    "{witness:?} but {truth} from {x} to {section:?}"
                );
                let in_ball = truth > 0.01 * radius && (x - other).length() < radius;
                links += usize::from(is_link && in_ball);
                bent += usize::from(!is_link && in_ball);
                tight += usize::from(is_link && witness.upper <= truth + 1e-9 * radius);
            }
        }
    }
    assert!(links > 300 && bent > 300 && tight > 300, "{links} {bent} {tight}");
}

/// The part of a ball that sticks out of its own section lies in the discs of other sections: the
/// tube is its discs. The joint is about one radius behind the base, or ahead of the tip, and the
/// centreline bends.
#[test]
fn balls_at_round_ends_lie_in_discs() {
    let mut random = Random::new(3);
    let (mut checked, mut beyond) = (0, 0);
    for _ in 0..400 {
        let (radius, narrower) = (random.between(0.2, 2.0), random.between(0.9, 1.0));
        let mut arc = |longest: Real| {
            let angle = random.between(0.0, 7.0);
            let bend =
                Vector::new(angle.cos(), angle.sin(), 0.0) * (random.between(0.3, 0.95) / radius);
            (radius * random.between(0.9, longest), bend)
        };
        let parts = [vec![arc(1.5)], vec![arc(8.0), arc(8.0)]];
        let is_turned = random.below(2) == 1;
        let mut arcs = Arcs::from_frame(random.pose(10.0));
        for part in if is_turned { [1, 0] } else { [0, 1] } {
            arcs.push(if part == 0 { radius } else { radius * narrower }, &parts[part]);
        }
        let arcs = Arc::new(arcs);
        let joint = arcs.stretches[0].length;
        let stretches = [
            ([0.0, joint], arcs.stretches[0].radius),
            ([joint, arcs.length()], arcs.stretches[1].radius),
        ];
        let (near, from_face) = if is_turned { (0, arcs.length()) } else { (1, 0.0) };
        let (face, normal) = arcs.at(from_face);
        let normal = if is_turned { normal } else { -normal };
        let (centre, tangent) = arcs.at(joint);
        let outward = if is_turned { tangent } else { -tangent };
        for tube in tubes(&mut random, &arcs) {
            let section = &tube.sections()[near];
            if section.faces[1 - near].is_some() {
                continue;
            }
            for k in 0..4 {
                let to = (normal * Real::from(k) + random.direction()).normalize();
                let to = if to.dot(outward) < 0.0 { -to } else { to };
                let x = centre + to * section.radius;
                let beside =
                    stretches.map(|(ends, radius)| distance_from_discs(&arcs, ends, radius, x));
                let apart = beside[0].min(beside[1]);
                assert!(apart <= 1e-6 * radius, "{apart} from {x} to {:?}", arcs.stretches);
                checked += 1;
                beyond += usize::from((x - face).dot(normal) > -0.1 * radius);
            }
        }
    }
    assert!(checked > 1_200 && beyond > 120, "{checked} {beyond}");
}

/// A thin wire starts with as many pieces as its bends need, not with millions.
#[test]
fn thin_wires_begin_with_few_pieces() {
    let arc = |s: Real| {
        (
            Vector::new(1.0 - (0.1 * s).cos(), 0.0, (0.1 * s).sin()) * 10.0,
            Vector::new((0.1 * s).sin(), 0.0, (0.1 * s).cos()),
        )
    };
    for radius in [0.0, 1e-300, 1e-9, 0.1] {
        let sections = [TubeSection { length: 10.0, radius, curvature: 0.1 }; 2];
        let tube = Tube::from_function(&sections, arc).unwrap();
        let placed = PlacedTube::new(&tube, &Pose::IDENTITY, 10.0).unwrap();
        for coarse in [0.0, radius, 1.0, 1e3] {
            let mut pieces = Vec::new();
            placed.begin(coarse, &mut pieces);
            assert!((2..2100).contains(&pieces.len()), "{radius}, {coarse}: {}", pieces.len());
        }
    }
}

/// Lengths along the tube are rounded, too: this tube winds to and fro in a small space.
#[test]
fn bodies_hold_links_of_a_long_chain() {
    let mut random = Random::new(9);
    let points: Vec<_> =
        (0..=20_000).map(|k| random.point() + Vector::X * Real::from(k % 2)).collect();
    let chain = crate::Chain::cylinders(&points, &[0.01; 20_000]).unwrap();
    let tube = Tube::from(&chain);
    let placed = PlacedTube::new(&tube, &Pose::IDENTITY, 1.0).unwrap();
    for (number, (section, link)) in tube.sections().iter().zip(chain.links()).enumerate() {
        let outer =
            placed.outer(&Piece { section: number as u32, from: section.first, to: section.last });
        let [start, end] = [outer.body.start(), outer.body.end()].map(Vec3::from);
        let across = link.axis().cross(random.direction()).normalize() * link.radius();
        for centre in [link.start(), link.end()] {
            let rim = Vec3::from(centre + across);
            let (radius, flat) = (outer.body.radius(), outer.body.flat());
            let beyond = point_modified_cylinder(rim, start, end, radius, flat).distance;
            assert!(beyond <= 0.0, "{number}: {beyond:e}");
        }
    }
}
