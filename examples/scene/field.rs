//! Smooth bodies as the zero set of a distance-like field: tubes of elliptic cross-section, swept along splines and
//! blended into each other.
//!
//! A tube is a spline through [`Knot`]s, sampled into short straight pieces. At a point p the piece with the
//! parameter t nearest to p has the centre c, the cross directions u and v and the half-widths a and b. With the
//! offset q = p - c in that frame, scaled by (a, b, cap), k = |scaled q| is 1 on the surface, and k (k - 1) / |grad|
//! is, to first order, the distance to it: negative inside. Tubes are joined by a smooth minimum, which rounds the
//! crease between two of them over a length `blend` and leaves everything further away as it is.

use parry_continuum::parry::math::{Real, Vector};

/// One cross-section of a tube: its centre, the direction of its first half-width, and the two half-widths.
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

#[derive(Clone, Copy)]
struct Section {
    centre: Vector,
    u: Vector,
    v: Vector,
    half: [Real; 2],
}

/// A ball around something: what it holds is no nearer than its surface.
struct Ball {
    centre: Vector,
    reach: Real,
}

/// A swept tube, with balls around its pieces and around the whole, so that what is far away is skipped.
pub struct Tube {
    sections: Vec<Section>,
    balls: Vec<Ball>,
    whole: Ball,
}

/// Straight pieces per span of the spline.
const PIECES: usize = 5;

impl Tube {
    /// The tube through the given cross-sections (at least two).
    pub fn new(knots: &[Knot]) -> Self {
        let last = knots.len() - 1;
        let at = |i: isize| &knots[i.clamp(0, last as isize) as usize];
        let mut sections = Vec::with_capacity(last * PIECES + 1);
        for sample in 0..=last * PIECES {
            let span = (sample / PIECES).min(last - 1);
            let t = sample as Real / PIECES as Real - span as Real;
            let four = [-1, 0, 1, 2].map(|k| at(span as isize + k));
            let (w, d) = (spline(t), spline_slope(t));
            let mix = |f: &dyn Fn(&Knot) -> Vector, w: [Real; 4]| {
                four.iter().zip(w).map(|(knot, w)| f(knot) * w).sum::<Vector>()
            };
            let along = mix(&|k| k.centre, d).normalize();
            let across = mix(&|k| k.across, w);
            let u = (across - along * across.dot(along)).normalize();
            let half = mix(&|k| Vector::new(k.half[0], k.half[1], 0.0), w);
            let centre = mix(&|k| k.centre, w);
            sections.push(Section { centre, u, v: along.cross(u), half: [half.x, half.y] });
        }
        let balls = sections.windows(2).map(around).collect();
        let whole = around(&sections);
        Self { sections, balls, whole }
    }

    /// The field of this tube alone; where that exceeds `limit`, it may be infinite.
    fn value(&self, p: Vector, limit: Real) -> Real {
        if !self.whole.is_within(limit, p) {
            return Real::INFINITY;
        }
        // The piece whose ball is most central first: its value lets most of the others be skipped.
        let far = |ball: &Ball| (p - ball.centre).length_squared();
        let value = |k: usize| piece(p, &self.sections[k], &self.sections[k + 1]);
        let first = (0..self.balls.len())
            .min_by(|&j, &k| far(&self.balls[j]).total_cmp(&far(&self.balls[k])))
            .unwrap_or_default();
        let mut least = value(first);
        for (k, ball) in self.balls.iter().enumerate() {
            if k != first && ball.is_within(least.min(limit), p) {
                least = least.min(value(k));
            }
        }
        least
    }
}

impl Ball {
    /// Whether the ball's surface is nearer to p than `limit`.
    fn is_within(&self, limit: Real, p: Vector) -> bool {
        let span = limit + self.reach;
        span > 0.0 && (p - self.centre).length_squared() < span * span
    }
}

/// A ball around the sections.
fn around(sections: &[Section]) -> Ball {
    let centre = sections.iter().map(|s| s.centre).sum::<Vector>() / sections.len() as Real;
    let reach = |s: &Section| (s.centre - centre).length() + s.half[0].max(s.half[1]);
    Ball { centre, reach: sections.iter().map(reach).fold(0.0, Real::max) }
}

/// The field of one straight piece.
fn piece(p: Vector, from: &Section, to: &Section) -> Real {
    let axis = to.centre - from.centre;
    let t = ((p - from.centre).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    let mix = |a: Vector, b: Vector| a + (b - a) * t;
    let half = [0, 1].map(|i| from.half[i] + (to.half[i] - from.half[i]) * t);
    let cap = half[0].min(half[1]);
    let q = p - mix(from.centre, to.centre);
    let scale = Vector::new(1.0 / half[0], 1.0 / half[1], 1.0 / cap);
    let local = Vector::new(q.dot(mix(from.u, to.u)), q.dot(mix(from.v, to.v)), q.dot(axis) / axis.length());
    let k = (local * scale).length();
    if k == 0.0 {
        return -cap;
    }
    k * (k - 1.0) / (local * scale * scale).length()
}

/// Weights of a Catmull-Rom spline at t in [0, 1] between its second and third knot, and their slopes.
fn spline(t: Real) -> [Real; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-t3 + 2.0 * t2 - t, 3.0 * t3 - 5.0 * t2 + 2.0, -3.0 * t3 + 4.0 * t2 + t, t3 - t2].map(|w| 0.5 * w)
}

fn spline_slope(t: Real) -> [Real; 4] {
    let t2 = t * t;
    [-3.0 * t2 + 4.0 * t - 1.0, 9.0 * t2 - 10.0 * t, -9.0 * t2 + 8.0 * t + 1.0, 3.0 * t2 - 2.0 * t]
        .map(|w| 0.5 * w)
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

/// The smaller of a and b, rounded where they differ by less than `blend` (a cubic, so that curvature is continuous).
fn smooth_min(a: Real, b: Real, blend: Real) -> Real {
    let h = (blend - (a - b).abs()).max(0.0) / blend;
    a.min(b) - h * h * h * blend / 6.0
}
