//! The contact of an answer: its normal, features and place on the robot; and the derivative of its
//! distance with respect to the points of link and triangle ([`Derivative`] states the formulas).
//!
//! The contacts of many answers are computed one pack at a time, with the bits of a single contact
//! on every instruction set.

use super::answer_check::{corners, placed_link, transformed_link};
use super::coordinates::{Nearest, Pair};
use super::measure_batch::NearestRows;
use super::nearest_features::{
    Measured, NearPair, NearestFeatures, NearestParts, link_feature, triangle_feature,
};
use super::pair_lanes::{BATCH, PairLanes, PairRows, Rows, put_pair, store};
use super::placed_link::PlacedLink;
use crate::answer::{Contact, ContactFeature, Derivative, LinkProximity, ProximityError, Witness};
use crate::distance::lanes::Pack;
use crate::distance::{DoubleDouble, Scalar, Unfused, Vec3, dispatch};
use crate::mesh::Mesh;
use crate::robot::{Chain, length};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};
use std::convert::Infallible;

/// Returns the contact of an answer about this mesh.
///
/// # Errors
/// As [`Proximity::contact_of`](crate::proximity::Proximity::contact_of).
pub(crate) fn contact(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<Contact, ProximityError> {
    let (link, corners, measured) = measured_answer(mesh, robot, pose, answer)?;
    let (length, before) = (length(link.along()), robot.length_before(answer.link as usize));
    let found = measured.features(|| NearPair::exactly(&link, corners));
    Ok(contact_of(answer, length, before, &found))
}

/// Replaces `out` by the contacts of answers about this mesh.
///
/// # Errors
/// As [`Proximity::contacts_of`](crate::proximity::Proximity::contacts_of). Then `out` is empty.
pub(crate) fn contacts(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answers: &[LinkProximity],
    out: &mut Vec<Contact>,
) -> Result<(), ProximityError> {
    out.clear();
    let pair_of = |answer: &LinkProximity| {
        let link = transformed_link(answer, robot, pose)?;
        let corners = corners(mesh.vertices(), mesh.indices(), answer.witness.triangle as usize)?;
        let before = robot.length_before(answer.link as usize);
        let ends = [link.start(), link.end()];
        Ok(PlacedPair { ends, radius: link.radius(), flat: link.flat(), corners, before })
    };
    let check = |answer: &LinkProximity, pair: &PlacedPair, measured: &Nearest| {
        answer.check_answer(measured, || pair.link(), pair.corners)
    };
    try_add_contacts(Level::new(), answers, pair_of, check, out).inspect_err(|_| out.clear())
}

/// Returns the link and the triangle's vertices of an answer that fits them, and both measured.
///
/// # Errors
/// One of them does not exist, the pose is not finite or moves the link out of range, or the answer
/// does not fit.
pub(crate) fn measured_answer(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<(PlacedLink, [Vector; 3], Measured), ProximityError> {
    let link = placed_link(answer, robot, pose)?;
    let corners = corners(mesh.vertices(), mesh.indices(), answer.witness.triangle as usize)?;
    let measured = Measured::new(&link, corners);
    answer.check_answer(&measured.nearest(&link, answer.witness.triangle), || link, corners)?;
    Ok((link, corners, measured))
}

/// Returns the contact of an answer about a link of this length. `before` is the length of the
/// links before it.
pub(crate) fn contact_of(
    answer: &LinkProximity,
    length: Real,
    before: Real,
    found: &NearestFeatures,
) -> Contact {
    let LinkProximity { link, distance, witness } = *answer;
    Contact {
        link,
        fraction: found.fraction,
        feature: ContactFeature { link: found.link, triangle: found.triangle },
        distance,
        depth: if distance > 0.0 { distance } else { found.depth.min(0.0) },
        normal: found.normal,
        witness: Witness { arc_length: before + found.fraction * length, ..witness },
        lever: found.lever,
        kink: found.kink,
    }
}

/// The inputs of a contact beside its answer: the link and the triangle, in the mesh's frame.
#[derive(Clone, Copy)]
pub(crate) struct PlacedPair {
    pub ends: [Vector; 2],
    pub radius: Real,
    pub flat: [bool; 2],
    pub corners: [Vector; 3],
    /// The total length of the links before this one.
    pub before: Real,
}

/// The results of several pairs.
struct ContactRows {
    /// The fraction, the normal, the depth and the lever.
    numbers: Rows<8>,
    /// One bit for each pair: the caps, the corners and the edges, as in [`NearestParts`].
    parts: [u64; 8],
    has_normal: u64,
    needs_closer_look: u64,
    nearest: NearestRows,
}

impl PlacedPair {
    pub(crate) fn new(link: &PlacedLink, corners: [Vector; 3], before: Real) -> Self {
        let ends = [link.start(), link.end()];
        Self { ends, radius: link.radius(), flat: link.flat(), corners, before }
    }

    /// Returns the placed link.
    pub(crate) fn link(&self) -> PlacedLink {
        let [start, end] = self.ends;
        PlacedLink::between(start, end, self.radius, self.flat)
    }
}

/// Appends the contacts of `answers`, each about the link and triangle that `pair_of` returns.
pub(crate) fn add_contacts(
    level: Level,
    answers: &[LinkProximity],
    mut pair_of: impl FnMut(&LinkProximity) -> PlacedPair,
    out: &mut Vec<Contact>,
) {
    let pair_of = |answer: &LinkProximity| Ok::<_, Infallible>(pair_of(answer));
    let add = try_add_contacts(level, answers, pair_of, |_, _, _| Ok(()), out);
    add.unwrap_or_else(|never| match never {});
}

/// Same as [`add_contacts`]; `pair_of` may fail, and `check` may refuse an answer after the
/// measurement.
///
/// # Errors
/// The first error of either. `out` then holds the contacts of some earlier answers.
fn try_add_contacts<E>(
    level: Level,
    answers: &[LinkProximity],
    mut pair_of: impl FnMut(&LinkProximity) -> Result<PlacedPair, E>,
    check: impl Fn(&LinkProximity, &PlacedPair, &Nearest) -> Result<(), E>,
    out: &mut Vec<Contact>,
) -> Result<(), E> {
    let mut rows = [[0.0; BATCH]; 18];
    for answers in answers.chunks(BATCH) {
        let mut pairs = [None; BATCH];
        for (lane, answer) in answers.iter().enumerate() {
            let PlacedPair { ends, radius, flat, corners, .. } =
                *pairs[lane].insert(pair_of(answer)?);
            put_pair(&mut rows, lane, corners, ends, radius, flat);
        }
        let parts = parts_at(level, &rows, answers.len());
        let with_pairs = answers.iter().zip(pairs.iter().flatten());
        for (lane, (answer, pair)) in with_pairs.clone().enumerate() {
            check(answer, pair, &parts.nearest.nearest(lane, answer.witness.triangle))?;
        }
        out.extend(with_pairs.enumerate().map(|(lane, (answer, pair))| {
            let [start, end] = pair.ends;
            let found = if parts.needs_closer_look >> lane & 1 == 1 {
                NearestFeatures::of(&pair.link(), pair.corners)
            } else {
                parts.of(lane)
            };
            contact_of(answer, length(end - start), pair.before, &found)
        }));
    }
    Ok(())
}

impl ContactRows {
    fn of(&self, lane: usize) -> NearestFeatures {
        let number = |row: usize| self.numbers[row][lane];
        let vector = |row: usize| Vector::new(number(row), number(row + 1), number(row + 2));
        let is = |bits: u64| bits >> lane & 1 == 1;
        let has_normal = is(self.has_normal);
        let [start, end, a, b, c, ab, bc, ca] = self.parts.map(is);
        NearestFeatures {
            link: link_feature([start, end]),
            triangle: triangle_feature([a, b, c], [ab, bc, ca]),
            fraction: number(0),
            normal: has_normal.then(|| vector(1)),
            depth: number(4),
            lever: vector(5),
            kink: false,
        }
    }
}

#[inline(never)] // compiled for each instruction set, not for each use as well
fn parts_at(level: Level, pairs: &PairRows, count: usize) -> ContactRows {
    let mut parts = ContactRows {
        numbers: [[0.0; BATCH]; 8],
        parts: [0; 8],
        has_normal: 0,
        needs_closer_look: 0,
        nearest: NearestRows::new(),
    };
    dispatch!(level, simd => fill::<Unfused<_>>(simd, pairs, count, &mut parts));
    parts
}

#[inline(always)]
fn fill<L: Pack<Element = f64>>(
    token: L::Token,
    pairs: &PairRows,
    count: usize,
    parts: &mut ContactRows,
) {
    for lane in (0..count).step_by(L::LANES) {
        let pack = PairLanes::<L>::new(token, pairs, lane);
        parts.nearest.take(lane, &pack);
        let PairLanes { pair: Pair { triangle, link, unit, .. }, face, axial, closest, .. } = pack;
        let found = NearestParts::new(&triangle, &link, &axial, &closest);
        parts.needs_closer_look |=
            L::bits(found.needs_closer_look(&triangle, &face, &link)) << lane;
        let ([start, end], [a, b, c], [ab, bc, ca]) = (found.caps, found.corners, found.edges);
        for (bits, masks) in parts.parts.iter_mut().zip([start, end, a, b, c, ab, bc, ca]) {
            *bits |= L::bits(masks) << lane;
        }
        parts.has_normal |= L::bits(found.has_normal) << lane;
        found.fraction.store(&mut parts.numbers[0][lane..]);
        store(&mut parts.numbers, 1, lane, found.normal);
        (found.depth * unit).store(&mut parts.numbers[4][lane..]);
        store(&mut parts.numbers, 5, lane, found.lever * unit);
    }
}

/// Returns the derivative of the distance, or of the depth, of an answer about this mesh.
///
/// # Errors
/// As [`Proximity::derivative`](crate::proximity::Proximity::derivative).
pub(crate) fn derivative(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<Option<Derivative>, ProximityError> {
    let (link, corners, measured) = measured_answer(mesh, robot, pose, answer)?;
    let way_out = || measured.pair.parting().derivative(|number| number);
    if measured.pair.parts.asks_way_out {
        return Ok(way_out());
    }
    let exact = NearPair::exactly(&link, corners);
    let found =
        if exact.parts.asks_way_out { way_out() } else { exact.derivative(DoubleDouble::rounded) };
    // The same decision on kinks as in the features.
    let kink = measured.features(|| exact).kink;
    Ok(found.map(|found| Derivative { kink, ..found }))
}

impl<T: Scalar<Mask = bool> + PartialEq> NearPair<T> {
    fn derivative(&self, round: impl Fn(T) -> Real) -> Option<Derivative> {
        let (link, parts) = (&self.link, &self.parts);
        let one = link.radius.one();
        if !parts.has_normal {
            return None;
        }
        let rounded = |v: Vec3<T>| Vector::new(round(v.x), round(v.y), round(v.z));
        let normal = parts.normal;
        let (mut start, mut end) = (normal * (one - parts.fraction), normal * parts.fraction);
        let mut radius = -one;
        if parts.at_flat_cap {
            let turn = parts.lever * normal.dot(link.axis).over(link.end.norm());
            (start, end) = (start + turn, end - turn);
            radius = -normal.cross(link.axis).norm();
        }
        Some(Derivative {
            start: rounded(start),
            end: rounded(end),
            radius: round(radius),
            vertices: self.weights().map(|weight| rounded(-normal * weight)),
            kink: self.kink,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::{LinkFeature, TriangleFeature};
    use crate::distance::lanes::tests::levels;
    use continuum_testing::Random;

    /// Returns a random link and triangle, often parallel, level or touching.
    fn pair(random: &mut Random) -> PlacedPair {
        let (size, level) = (2.0_f64.powi(random.below(41) as i32 - 20), random.below(3) == 0);
        let mut point = || {
            let point = random.point();
            (if level { (point * 3.0).round() / 3.0 } else { point }) * size
        };
        let (corners, start, way) = ([point(), point(), point()], point(), point());
        let radius = size * [0.0, 0.1, 0.5, 2.0][random.below(4) as usize];
        let flat =
            [random.below(2) == 0, random.below(2) == 0].map(|flat| flat && way != Vector::ZERO);
        let before = random.between(0.0, 9.0);
        PlacedPair { ends: [start, start + way], radius, flat, corners, before }
    }

    /// A contact computed in a batch has the bits of the contact computed alone, on each
    /// instruction set.
    #[test]
    fn together_is_alone_bit_for_bit() {
        let (mut kinks, mut touching, mut at_cap, mut parts) = (0, 0, 0, [0; 3]);
        for seed in 0..4000 {
            let random = &mut Random::new(seed);
            let pairs: Vec<_> = (0..1 + seed as usize % 19).map(|_| pair(random)).collect();
            let link = |pair: &PlacedPair| {
                let [start, end] = pair.ends;
                PlacedLink::between(start, end, pair.radius, pair.flat)
            };
            let measured = pairs.iter().enumerate();
            let answers: Vec<_> = measured
                .map(|(k, pair)| link(pair).answer(k, &link(pair).measure(0, pair.corners)))
                .collect();
            let alone = |answer: &LinkProximity| {
                let pair = &pairs[answer.link as usize];
                let length = length(pair.ends[1] - pair.ends[0]);
                contact_of(
                    answer,
                    length,
                    pair.before,
                    &NearestFeatures::of(&link(pair), pair.corners),
                )
            };
            let alone: Vec<_> = answers.iter().map(alone).collect();
            for level in levels() {
                let mut together = Vec::new();
                add_contacts(level, &answers, |answer| pairs[answer.link as usize], &mut together);
                // The text distinguishes -0 from 0.
                assert_eq!(format!("{together:?}"), format!("{alone:?}"), "{level:?}, {seed}");
            }
            for contact in &alone {
                kinks += usize::from(contact.kink);
                touching += usize::from(contact.distance <= 0.0);
                let at_flat = match contact.feature.link {
                    LinkFeature::StartCap => pairs[contact.link as usize].flat[0],
                    LinkFeature::EndCap => pairs[contact.link as usize].flat[1],
                    LinkFeature::Side => false,
                };
                at_cap += usize::from(contact.distance > 0.0 && at_flat);
                parts[match contact.feature.triangle {
                    TriangleFeature::Face => 0,
                    TriangleFeature::Edge(_) => 1,
                    TriangleFeature::Vertex(_) => 2,
                }] += 1;
            }
        }
        let seen = [kinks, touching, at_cap, parts[0], parts[1], parts[2]];
        assert!(seen.iter().all(|&count| count > 300), "{seen:?}");
    }
}
