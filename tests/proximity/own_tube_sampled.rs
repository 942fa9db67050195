//! A tube beside itself, against all pairs of its discs and faces, sampled and then refined between
//! the samples. The arcs' own curvature decides which pairs count, and points of the discs decide
//! what is in front of a face. Beside a face only local minima must be found; other pairs in front
//! of it may be.

use super::own_tube::winding;
use super::tube::all_ways;
use continuum_testing::narrow_phase::disc_disc;
use continuum_testing::{Arcs, Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{Decision, ProximityError, SelfQuery};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// A difference of turn that counts as rounding.
const ROUNDING: f64 = 1e-9;

#[derive(Clone, Copy)]
struct Disc {
    centre: Vector,
    normal: Vector,
    radius: f64,
    /// By how much the centreline has turned up to here.
    turned: f64,
}

impl Disc {
    fn apart(&self, other: &Self) -> f64 {
        self.closest(other).0
    }

    /// How far another disc is, and the way there.
    fn closest(&self, other: &Self) -> (f64, Vector) {
        let v = |v: Vector| Vec3::from(v.to_array());
        let found = disc_disc(
            v(self.centre),
            v(self.normal),
            self.radius,
            v(other.centre),
            v(other.normal),
            other.radius,
        );
        let at = |place: Vec3<f64>| Vector::new(place.x, place.y, place.z);
        (found.distance, at(found.point2) - at(found.point1))
    }

    /// How far the surface around another disc's centre is from this disc, negative within.
    fn signed(&self, other: &Self) -> f64 {
        let offset = other.centre - self.centre;
        let ahead = offset.dot(self.normal);
        let across = (offset - self.normal * ahead).length();
        ahead.hypot((across - self.radius).max(0.0)) - other.radius
    }

    /// The distance from this disc, a face, to the part of another disc in front of it, where the
    /// normal points.
    fn front_apart(&self, other: &Self) -> f64 {
        let (distance, way) = self.closest(other);
        if distance > 0.0 && way.dot(self.normal) >= 0.0 {
            return distance;
        }
        // What is nearest is behind. So the nearest place in front is in the face's plane, on a
        // chord of the disc.
        let height = (other.centre - self.centre).dot(self.normal);
        let up = self.normal - other.normal * self.normal.dot(other.normal);
        let steepness = up.length();
        let half = other.radius * other.radius - (height / steepness).powi(2);
        if height.is_nan() || half.is_nan() || half < 0.0 {
            return f64::INFINITY;
        }
        let along = other.normal.cross(up) / steepness;
        let middle = other.centre - up * (height / steepness / steepness);
        let share = (self.centre - middle).dot(along).max(-half.sqrt()).min(half.sqrt());
        ((middle + along * share - self.centre).length() - self.radius).max(0.0)
    }
}

/// All arcs of a tube, as discs.
struct Sampled<'a> {
    arcs: &'a Arcs,
    /// Arc length, the number of the stretch, and the disc.
    discs: Vec<(f64, usize, Disc)>,
    /// The discs of faces, led outwards, and whether each is at the end of its stretch.
    faces: Vec<(bool, Disc)>,
}

/// The least distance of all pairs that must be found, and of all pairs that may be.
#[derive(Clone, Copy, Debug)]
struct Truth {
    minima: f64,
    all: f64,
}

impl<'a> Sampled<'a> {
    fn new(arcs: &'a Arcs, grid: u32) -> Self {
        let (mut discs, mut faces) = (Vec::<(f64, usize, Disc)>::new(), Vec::new());
        let mut from = 0.0;
        for (number, part) in arcs.stretches.iter().enumerate() {
            for k in 0..=grid {
                let s = from + part.length * f64::from(k) / f64::from(grid);
                let (centre, normal) = arcs.at(s);
                let turned = arcs.turned(s);
                discs.push((s, number, Disc { centre, normal, radius: part.radius, turned }));
            }
            let radius_of =
                |other: usize| arcs.stretches.get(other).map_or(0.0, |other| other.radius);
            let [(_, _, first), (_, _, last)] =
                [discs[discs.len() - 1 - grid as usize], discs[discs.len() - 1]];
            if radius_of(number.wrapping_sub(1)) < part.radius {
                faces.push((false, Disc { normal: -first.normal, ..first }));
            }
            if radius_of(number + 1) < part.radius {
                faces.push((true, last));
            }
            from += part.length;
        }
        Self { arcs, discs, faces }
    }

    /// The disc at an arc length of the stretch of a sample, between its neighbours.
    fn disc(&self, sample: usize, s: f64) -> Disc {
        let (_, number, near) = self.discs[sample];
        let stretch = |k: usize| self.discs.get(k).filter(|disc| disc.1 == number);
        let low = stretch(sample.wrapping_sub(1)).map_or(self.discs[sample].0, |disc| disc.0);
        let high = stretch(sample + 1).map_or(self.discs[sample].0, |disc| disc.0);
        let s = s.max(low).min(high);
        let (centre, normal) = self.arcs.at(s);
        Disc { centre, normal, turned: self.arcs.turned(s), ..near }
    }

    /// Whether the tube leads nearer to a face from the place of a disc, near a sample at this arc
    /// length.
    fn leads_nearer(&self, face: &Disc, sample: usize, s: f64) -> bool {
        let here = self.disc(sample, s);
        let (apart, signed) = (face.apart(&here), face.signed(&here));
        // Beyond the ends of a stretch its neighbours go on.
        [-1e-4, 1e-4].into_iter().any(|step| {
            let s = s + step;
            let next = self
                .discs
                .windows(2)
                .position(|pair| pair[0].0 <= s && s <= pair[1].0 && pair[0].1 == pair[1].1);
            next.is_some_and(|next| {
                let there = self.disc(next, s);
                let is_nearer = face.apart(&there) < apart - 1e-10 || apart == 0.0;
                is_nearer && face.signed(&there) < signed - 1e-10
            })
        })
    }

    /// Upper bounds on the least distances of all pairs that count.
    fn nearest(&self) -> Truth {
        let step = |k: usize| {
            let next = self.discs.get(k + 1).filter(|next| next.1 == self.discs[k].1);
            next.map_or_else(
                || self.discs[k].0 - self.discs[k - 1].0,
                |next| next.0 - self.discs[k].0,
            )
        };
        let mut starts = Vec::new();
        for (i, (_, m, one)) in self.discs.iter().enumerate() {
            for (j, (_, n, two)) in self.discs.iter().enumerate().skip(i) {
                if two.turned - one.turned >= PI - ROUNDING {
                    let balls = (one.centre - two.centre).length() - one.radius - two.radius;
                    starts.push((balls, [*m, *n], [i, j]));
                }
            }
        }
        let mut least = f64::INFINITY;
        for [i, j] in best(starts) {
            let apart = |[s, t]: [f64; 2]| {
                let (one, two) = (self.disc(i, s), self.disc(j, t));
                if two.turned - one.turned < PI - ROUNDING {
                    f64::INFINITY
                } else {
                    one.apart(&two)
                }
            };
            let (found, _) = descend([self.discs[i].0, self.discs[j].0], [step(i), step(j)], apart);
            least = least.min(found);
        }
        let mut starts = Vec::new();
        for (number, (_, face)) in self.faces.iter().enumerate() {
            for (k, (_, n, disc)) in self.discs.iter().enumerate() {
                if (disc.turned - face.turned).abs() < FRAC_PI_2 - ROUNDING {
                    continue;
                }
                starts.push((face.front_apart(disc), [number, *n], (number, k)));
            }
        }
        let mut minima = least;
        for (number, k) in best(starts) {
            let (_, face) = &self.faces[number];
            let apart = |[s]: [f64; 1]| {
                let disc = self.disc(k, s);
                let is_asked = (disc.turned - face.turned).abs() >= FRAC_PI_2 - ROUNDING;
                if is_asked { face.front_apart(&disc) } else { f64::INFINITY }
            };
            let (found, [s]) = descend([self.discs[k].0], [step(k)], apart);
            least = least.min(found);
            // What is nearest may be behind the face.
            let is_behind = found > face.apart(&self.disc(k, s)) + ROUNDING;
            if !is_behind && !self.leads_nearer(face, k, s) {
                minima = minima.min(found);
            }
        }
        for (number, (at_end, one)) in self.faces.iter().enumerate() {
            for (ends, two) in &self.faces[number + 1..] {
                let (distance, way) = one.closest(two);
                if way.dot(one.normal) >= -ROUNDING && way.dot(two.normal) <= ROUNDING {
                    least = least.min(distance);
                    // Other faces are found beside the link whose end they are.
                    minima = if *at_end && !ends { minima.min(distance) } else { minima };
                }
            }
        }
        Truth { minima, all: least }
    }
}

/// The places of the least numbers, some of each group.
fn best<T>(mut all: Vec<(f64, [usize; 2], T)>) -> impl Iterator<Item = T> {
    const EACH: usize = 4;
    all.retain(|(number, ..)| *number < f64::INFINITY);
    all.sort_unstable_by(|a, b| a.1.cmp(&b.1).then(a.0.total_cmp(&b.0)));
    let mut last = (None, 0);
    all.into_iter().filter_map(move |(_, group, place)| {
        last = if last.0 == Some(group) { (last.0, last.1 + 1) } else { (Some(group), 0) };
        (last.1 < EACH).then_some(place)
    })
}

/// The least of a function near a place: steps to all sides and between them, halved where none
/// leads down.
fn descend<const N: usize>(
    mut place: [f64; N],
    mut steps: [f64; N],
    f: impl Fn([f64; N]) -> f64,
) -> (f64, [f64; N]) {
    let mut least = f(place);
    for _ in 0..60 {
        let from = place;
        for code in 0..3_usize.pow(N as u32) {
            let next = std::array::from_fn(|k| {
                from[k] + steps[k] * ((code / 3_usize.pow(k as u32) % 3) as f64 - 1.0)
            });
            let there = f(next);
            if there < least {
                (place, least) = (next, there);
            }
        }
        if place == from {
            steps = steps.map(|step| 0.5 * step);
        }
        if least <= 0.0 {
            break;
        }
    }
    (least, place)
}

/// What a run of problems has seen.
#[derive(Debug, Default)]
struct Seen {
    touching: usize,
    free: usize,
    none: usize,
    clear: usize,
    contact: usize,
    undecided: usize,
    wide: usize,
    /// Contacts of a curve with a place that is no local minimum, beyond the resolution.
    beside: usize,
}

const RESOLUTION: f64 = 1e-3;

fn ask(query: &mut SelfQuery, arcs: Arcs, margins: &[f64], seen: &mut Seen, name: &str) {
    let arcs = Arc::new(arcs);
    let truth = Sampled::new(&arcs, 80).nearest();
    // As wide as the tightest bend, at a step and elsewhere.
    let most = |of: fn(&continuum_testing::Stretch) -> f64| {
        arcs.stretches.iter().map(of).fold(0.0, f64::max)
    };
    let (curvature, radius) = (most(|part| part.curvature), most(|part| part.radius));
    let width = (1.0 / curvature - radius).min(2.0 / curvature - 2.0 * radius);
    let mut margins = margins.to_vec();
    for truth in [truth.minima, truth.all] {
        margins.extend([-0.1, -2e-3, 0.0, 2e-3, 0.1].map(|off| truth + off));
    }
    for (way, tube) in all_ways(&arcs).iter().enumerate() {
        for &margin in &margins {
            if !(0.0..1e9).contains(&margin) {
                continue;
            }
            let decision = match query.clears_tube(tube, margin, RESOLUTION) {
                Ok(decision) => decision,
                Err(ProximityError::ToleranceTooFine { .. }) if way > 0 => Decision::Undecided,
                Err(error) => panic!("{name}: {error}"),
            };
            let told = || format!("{name}, way {way}: margin {margin} of {truth:?}, width {width}");
            match decision {
                Decision::Clear => {
                    assert!(truth.minima > margin - ROUNDING, "{}", told());
                    seen.clear += 1;
                }
                Decision::Contact => {
                    assert!(truth.all <= margin + 1e-6, "{}", told());
                    seen.contact += 1;
                    seen.beside += usize::from(way == 0 && truth.minima > margin + RESOLUTION);
                }
                _ if margin > width - 2.0 * RESOLUTION => seen.wide += 1,
                _ => {
                    let near = RESOLUTION + 1e-6;
                    let is_near = truth.all <= margin + near && margin - near <= truth.minima;
                    assert!(way > 0 || is_near, "undecided: {}", told());
                    seen.undecided += 1;
                }
            }
        }
    }
    match truth.minima {
        0.0 => seen.touching += 1,
        f64::INFINITY => seen.none += 1,
        _ => seen.free += 1,
    }
}

#[test]
fn winding_tubes_are_as_near_to_themselves_as_their_discs() {
    let mut random = Random::new(1);
    let (mut query, mut seen) = (SelfQuery::new(), Seen::default());
    for round in 0..rounds(40) {
        ask(
            &mut query,
            winding(&mut random),
            &[0.0, 0.3, 2.0, 5.0],
            &mut seen,
            &format!("{round}"),
        );
    }
    assert!(seen.touching >= rounds(5) && seen.free >= rounds(10), "{seen:?}");
}

/// Arcs of quarters of a turn in planes at right angles, straight stretches between, and few radii:
/// parts are parallel, coplanar, in one line, end on end, and touch as often as not.
fn aligned(random: &mut Random) -> Arcs {
    let mut all = Arcs::from_frame(Pose::IDENTITY);
    for _ in 0..1 + random.below(4) {
        let radius = [0.125, 0.25, 0.5, 1.0][random.below(4) as usize];
        let arcs: Vec<_> = (0..1 + random.below(2))
            .map(|_| {
                let bend: f64 = [radius * 1.0625, radius * 1.5, radius * 2.0, 1.0, 2.0]
                    [random.below(5) as usize];
                let curvature = 1.0 / bend.max(radius * 1.0625);
                let way = [Vector::X, -Vector::X, Vector::X, Vector::Y][random.below(4) as usize];
                let turn = FRAC_PI_2 * f64::from(1 + random.below(4));
                let straight = [0.25, 0.5, 1.0, 2.0, 4.0][random.below(5) as usize];
                if random.below(2) == 0 {
                    (straight, Vector::ZERO)
                } else {
                    (turn / curvature, way * curvature)
                }
            })
            .collect();
        all.push(radius, &arcs);
    }
    all
}

#[test]
fn aligned_tubes_are_as_near_to_themselves_as_their_discs() {
    let mut random = Random::new(2);
    let (mut query, mut seen) = (SelfQuery::new(), Seen::default());
    for round in 0..rounds(120) {
        ask(
            &mut query,
            aligned(&mut random),
            &[0.0, 0.25, 0.5, 1.0],
            &mut seen,
            &format!("{round}"),
        );
    }
    assert!(
        seen.touching >= rounds(5) && seen.free >= rounds(10) && seen.none >= rounds(10),
        "{seen:?}"
    );
}

/// Two bends that bring the tip back to the tube's side. The nearest place in front of the tip's
/// face need not be a local minimum: from it the tube leads nearer to what is behind the face.
fn tip_beside_bend(random: &mut Random) -> Arcs {
    let mut arcs = Arcs::from_frame(random.pose(10.0));
    let radii = [random.between(0.6, 1.0), random.between(0.4, 1.0)];
    let mut way = random.direction();
    for (k, radius) in radii.into_iter().enumerate() {
        let curvature = random.between(0.3, 0.8) / 5.0 / radius;
        let turn = [random.between(1.0, 2.5), random.between(2.5, 3.6)][k];
        way = Vector::new(way.x, way.y, 0.0).normalize();
        arcs.push(radius, &[(turn / curvature, way * curvature)]);
        way = -way + 0.3 * random.direction();
    }
    arcs
}

#[test]
fn beside_a_tip_only_local_minima_count() {
    let (mut query, mut seen) = (SelfQuery::new(), Seen::default());
    // Length and curvature of two bends, and their radii. In front of the face the first tube is at
    // 8.37 and the second at 9.01; the local minima are at 10.48 and 9.03.
    let bends = [
        ([(24.2354, [-0.06605, 0.05248]), (22.2537, [0.069, -0.14808])], [0.6832, 0.564]),
        ([(16.3030, [-0.04048, 0.09963]), (16.8159, [0.08321, -0.16271])], [1.0; 2]),
    ];
    for (bends, radii) in bends {
        let mut arcs = Arcs::from_frame(Pose::IDENTITY);
        for ((length, [x, y]), radius) in bends.into_iter().zip(radii) {
            arcs.push(radius, &[(length, Vector::new(x, y, 0.0))]);
        }
        ask(&mut query, arcs, &[9.02, 10.2], &mut seen, "two bends");
    }
    let mut random = Random::new(3);
    for round in 0..rounds(40) {
        ask(&mut query, tip_beside_bend(&mut random), &[], &mut seen, &format!("{round}"));
    }
    assert_eq!(seen.beside, 0, "{seen:?}");
    assert!(seen.contact > rounds(20) && seen.clear > rounds(40), "{seen:?}");
}
