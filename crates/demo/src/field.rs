//! Smooth bodies as the zero set of a distance-like field: tubes of elliptic cross-section, swept
//! along splines and blended into each other.
//!
//! A tube is a spline through [`Knot`]s. The point of its centreline nearest to p has the centre c,
//! the directions u and v across and the half-widths a and b. With the offset q = p - c in that
//! frame, scaled by (a, b, cap), where cap rounds the two ends, k = |scaled q| is 1 on the surface,
//! and k (k - 1) / |grad| is, to first order, the distance to it: negative inside. Tubes are joined
//! by a smooth minimum, which rounds the crease between two of them over a length `blend` and
//! leaves everything further away as it is.

use parry_continuum::parry::math::{Real, Vector};

/// One cross-section of a tube: its centre, the direction of its first half-width, and the two
/// half-widths.
pub struct Knot {
    pub centre: Vector,
    pub across: Vector,
    pub half: [Real; 2],
}

/// A knot whose first half-width points along `across`, made perpendicular to the tube.
pub fn knot(centre: [Real; 3], across: [Real; 3], half: [Real; 2]) -> Knot {
    Knot { centre: centre.into(), across: across.into(), half }
}

/// A round knot.
pub fn round(centre: [Real; 3], radius: Real) -> Knot {
    knot(centre, [1.0, 0.3, 0.2], [radius, radius])
}

/// A swept tube, with a ball around it, so that it is skipped where it is far away.
pub struct Tube {
    knots: Vec<Knot>,
    /// Points of the centreline: parameter and place.
    samples: Vec<(Real, Vector)>,
    middle: Vector,
    reach: Real,
}

/// Samples per span of the spline.
const SAMPLES: usize = 4;

impl Tube {
    /// The tube through the given cross-sections (at least two).
    pub fn new(knots: Vec<Knot>) -> Self {
        let mut tube = Self { knots, samples: Vec::new(), middle: Vector::ZERO, reach: 0.0 };
        let count = (tube.knots.len() - 1) * SAMPLES;
        let parameters = (0..=count).map(|k| k as Real / SAMPLES as Real);
        tube.samples = parameters
            .map(|s| {
                let (four, t) = tube.around(s);
                (s, mix(four, spline(t), |knot| knot.centre))
            })
            .collect();
        tube.middle = tube.samples.iter().map(|(_, p)| *p).sum::<Vector>() / (count + 1) as Real;
        let wide =
            tube.knots.iter().map(|knot| knot.half[0].max(knot.half[1])).fold(0.0, Real::max);
        let far =
            tube.samples.iter().map(|(_, p)| (*p - tube.middle).length()).fold(0.0, Real::max);
        tube.reach = far + 1.1 * wide;
        tube
    }

    /// The four knots around parameter s (0 at the first, 1 at the second knot), and how far s is
    /// between the middle two.
    fn around(&self, s: Real) -> ([&Knot; 4], Real) {
        let last = self.knots.len() - 1;
        let span = (s as usize).min(last - 1);
        let four = [span.saturating_sub(1), span, span + 1, (span + 2).min(last)];
        (four.map(|k| &self.knots[k]), s - span as Real)
    }

    /// The field of this tube alone; where that exceeds `limit`, it may be infinite.
    fn value(&self, p: Vector, limit: Real) -> Real {
        let span = limit + self.reach;
        if span <= 0.0 || (p - self.middle).length_squared() >= span * span {
            return Real::INFINITY;
        }
        // The nearest sample, then a few steps to where the offset is perpendicular to the
        // centreline.
        let (mut s, mut nearest) = (0.0, Real::INFINITY);
        for (parameter, place) in &self.samples {
            let square = (p - place).length_squared();
            if square < nearest {
                (s, nearest) = (*parameter, square);
            }
        }
        let end = (self.knots.len() - 1) as Real;
        for _ in 0..3 {
            let (four, t) = self.around(s);
            let [off, along, turn] =
                [spline(t), slope(t), bend(t)].map(|weights| mix(four, weights, |k| k.centre));
            let off = p - off;
            // Newton's method, held back where the tube bends around p.
            let square = along.length_squared();
            s = (s + off.dot(along) / (square - off.dot(turn)).max(0.3 * square)).clamp(0.0, end);
        }
        let (four, t) = self.around(s);
        let weights = spline(t);
        let along = mix(four, slope(t), |knot| knot.centre).normalize();
        let across = mix(four, weights, |knot| knot.across);
        let u = (across - along * across.dot(along)).normalize();
        let half = mix(four, weights, |knot| Vector::new(knot.half[0], knot.half[1], 0.0));
        let cap = half.x.min(half.y);
        let q = p - mix(four, weights, |knot| knot.centre);
        let scale = Vector::new(1.0 / half.x, 1.0 / half.y, 1.0 / cap);
        let local = Vector::new(q.dot(u), q.dot(along.cross(u)), q.dot(along));
        let k = (local * scale).length();
        if k == 0.0 {
            return -cap;
        }
        k * (k - 1.0) / (local * scale * scale).length()
    }
}

/// A quantity of four knots, weighted.
#[inline]
fn mix(four: [&Knot; 4], weights: [Real; 4], of: impl Fn(&Knot) -> Vector) -> Vector {
    (0..4).fold(Vector::ZERO, |sum, k| sum + of(four[k]) * weights[k])
}

/// Weights of a Catmull-Rom spline at t in [0, 1] between its second and third knot, and their two
/// derivatives.
fn spline(t: Real) -> [Real; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t, t3 - t2]
        .map(|w| 0.5 * w)
}

fn slope(t: Real) -> [Real; 4] {
    let t2 = t * t;
    [-3.0 * t2 + 4.0 * t - 1.0, 9.0 * t2 - 10.0 * t, -9.0 * t2 + 8.0 * t + 1.0, 3.0 * t2 - 2.0 * t]
        .map(|w| 0.5 * w)
}

fn bend(t: Real) -> [Real; 4] {
    [-3.0 * t + 2.0, 9.0 * t - 5.0, -9.0 * t + 4.0, 3.0 * t - 1.0]
}

/// The smooth union of tubes.
pub struct Body {
    pub tubes: Vec<Tube>,
    /// Length over which two tubes blend into each other.
    pub blend: Real,
}

impl Body {
    /// The field: negative inside, near the surface the distance to it.
    pub fn value(&self, p: Vector) -> Real {
        self.tubes.iter().fold(Real::INFINITY, |so_far, tube| {
            smooth_min(so_far, tube.value(p, so_far + self.blend), self.blend)
        })
    }
}

/// The smaller of a and b, rounded where they differ by less than `blend` (a cubic, so that
/// curvature is continuous).
fn smooth_min(a: Real, b: Real, blend: Real) -> Real {
    let apart = (a - b).abs();
    // Also for one infinity, or two, whose difference is no number.
    if apart.is_nan() || apart >= blend {
        return a.min(b);
    }
    let h = (blend - apart) / blend;
    a.min(b) - h * h * h * blend / 6.0
}
