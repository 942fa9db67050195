//! Tubes of frames and of measured points against the truth: the nearest of all discs across curves
//! that are known everywhere.

mod crowds;
mod fit;
mod frames;
mod uneven;

use continuum_testing::{Arcs, Random};
use parry_continuum::Tube;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Clearance};

/// A place of a curve, and the direction there.
type Curve<'a> = &'a dyn Fn(f64) -> (Vector, Vector);

/// All discs of a radius across a curve, from one parameter to another.
struct Discs {
    range: [f64; 2],
    radius: f64,
}

/// How far a point is from a disc.
fn to_disc(point: Vector, (centre, normal): (Vector, Vector), radius: f64) -> f64 {
    let offset = point - centre;
    let ahead = offset.dot(normal);
    ahead.hypot(((offset - normal * ahead).length() - radius).max(0.0))
}

/// How far a point is from the nearest of all discs: sampled, and each low sample followed down.
fn distance(all: &[Discs], curve: Curve, point: Vector) -> f64 {
    const SAMPLES: usize = 300;
    let mut least = f64::INFINITY;
    for &Discs { range: [from, to], radius } in all {
        let at = |share: f64| to_disc(point, curve(from + (to - from) * share), radius);
        let shares: Vec<_> = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64).collect();
        let sampled: Vec<_> = shares.iter().map(|&share| at(share)).collect();
        let lowest = sampled.iter().copied().fold(f64::INFINITY, f64::min);
        // A disc's distance changes by at most the motion of its centre and its rim.
        let near = lowest + 4.0 * (to - from) / SAMPLES as f64;
        for k in 0..=SAMPLES {
            let (before, behind) = (k.saturating_sub(1), (k + 1).min(SAMPLES));
            if sampled[k] > near || sampled[k] > sampled[before] || sampled[k] > sampled[behind] {
                continue;
            }
            let (mut low, mut high) = (shares[before], shares[behind]);
            for _ in 0..60 {
                let [a, b] = [0.382, 0.618].map(|share| low + (high - low) * share);
                if at(a) < at(b) { high = b } else { low = a }
            }
            least = least.min(at(0.5 * (low + high))).min(sampled[k]);
        }
    }
    least
}

/// The discs of arcs, stretch by stretch.
fn discs(arcs: &Arcs) -> Vec<Discs> {
    let mut from = 0.0;
    let stretch = |part: &continuum_testing::Stretch| {
        let range = [from, from + part.length];
        from = range[1];
        Discs { range, radius: part.radius }
    };
    arcs.stretches.iter().map(stretch).collect()
}

/// A mesh of one point.
fn speck(point: Vector) -> BvhSearch {
    BvhSearch::new(&TriMesh::new(vec![point; 3], vec![[0, 1, 2]]).unwrap()).unwrap()
}

/// A point near a curve: beside it, ahead of a face, exactly on its axis or in its plane, on the
/// tube or in it.
fn near(random: &mut Random, discs: &[Discs], curve: Curve, away: f64) -> Vector {
    let Discs { range, radius } = discs[random.below(discs.len() as u32) as usize];
    let inner = range[0] + (range[1] - range[0]) * random.unit();
    let place = [range[0], range[1], inner, inner][random.below(4) as usize];
    let (centre, tangent) = curve(place);
    let across = tangent.cross(random.direction()).normalize();
    let off = away * random.unit();
    let outward = if place == range[0] { -tangent } else { tangent };
    match random.below(6) {
        0 => centre + outward * off,
        1 => centre + across * (radius + off),
        2 => centre + across * radius + outward * off,
        3 => centre + across * (radius * random.unit()),
        4 => {
            centre
                + (across * random.between(0.5, 1.5) + outward * random.unit()).normalize()
                    * (radius + off)
        }
        _ => centre + random.direction() * (radius + off),
    }
}

/// The query.
#[derive(Debug, Default)]
struct Seen {
    asked: usize,
    resolved: usize,
    touching: usize,
    /// The nearest disc is a face's, and the point ahead of it.
    at_faces: usize,
}

/// Asks a tube about points near the truth.
fn judge(
    random: &mut Random,
    tube: &Tube,
    (discs, curve): (&[Discs], Curve),
    [away, tolerance]: [f64; 2],
    rounds: usize,
    seen: &mut Seen,
) {
    for _ in 0..rounds {
        let point = near(random, discs, curve, away);
        let truth = distance(discs, curve, point);
        let found = speck(point).clearance(tube, &Pose::IDENTITY, tolerance).unwrap();
        let Clearance { lower, upper, resolved, uncertainty, .. } = found;
        let size = 1e-9 * (1.0 + point.length());
        assert!(lower <= truth + size && truth <= upper + size, "{truth} at {point} in {found:?}");
        assert_eq!(resolved, upper - lower <= tolerance + uncertainty);
        seen.asked += 1;
        seen.resolved += usize::from(resolved);
        seen.touching += usize::from(truth < size);
        let is_ahead = |end: f64| {
            let (centre, _) = curve(end);
            let radius = discs.iter().map(|part| part.radius).fold(0.0, f64::max);
            (point - centre).length() < truth + 1.01 * radius
        };
        seen.at_faces += usize::from(
            truth > size
                && (is_ahead(discs[0].range[0]) || is_ahead(discs[discs.len() - 1].range[1])),
        );
    }
}
