//! For how long a plane stays between an end of a moving link and a point of what it moves towards.
//!
//! Of the two it is known how far they are apart along the plane's normal `n` (`gap`), how fast
//! they part (`rate`) and how much of that is lost to turning (`bend`). Then after the time `s`
//! they are at least
//!
//! ```text
//! gap + rate s - bend s^2 - reach(s)
//! ```
//!
//! apart, where `reach` is the end's cap. While the normal leans out over a round cap, that is its
//! radius. Otherwise it is the support function of the half ball or the disc along the normal, as
//! it turns seen from the link. With the axis `a` and `m` the way in which `n` turns,
//!
//! ```text
//! reach(s) = r |p - a (p . a)|,   p = n + s m,      and r |p| once p leans out over a round cap.
//! ```
//!
//! A support function is convex: over any span of time it lies below its chord. So within the span
//! nothing meets before the first root of a parabola. The bound is exact to second order but for
//! the chord, and the span can be shortened. (A cap does not change when it is turned about its
//! axis, so only the turning of the axis itself counts: a cylinder may roll as fast as it likes.)

use parry3d_f64::math::{Real, Vector};

/// What an end and a point along a normal do, at one moment (see the head of this file).
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneGap {
    pub gap: Real,
    pub rate: Real,
    pub bend: Real,
    pub reach: Reach,
}

/// How far a cap reaches along the normal from its centre.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reach {
    /// A round cap that the normal leans out over.
    Radius(Real),
    Support(Support),
}

/// A disc, or a half ball, and a direction that turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Support {
    pub radius: Real,
    pub outward: Vector,
    pub is_round: bool,
    pub normal: Vector,
    pub turning: Vector,
}

impl Support {
    fn after(&self, time: Real) -> Real {
        let toward = self.normal + self.turning * time;
        let lean = toward.dot(self.outward);
        let reach =
            if self.is_round && lean >= 0.0 { toward } else { toward - self.outward * lean };
        reach.length() * self.radius
    }
}

impl PlaneGap {
    /// A time until which the plane stays between the two, at most `span`.
    pub fn time_open(&self, span: Real) -> Real {
        let support = match &self.reach {
            Reach::Radius(radius) => {
                return first_root(self.gap - radius, self.rate, self.bend).min(span);
            }
            Reach::Support(support) => support,
        };
        let now = support.after(0.0);
        let mut span = span;
        loop {
            let growth = if span > 0.0 { (support.after(span) - now) / span } else { 0.0 };
            let open = first_root(self.gap - now, self.rate - growth, self.bend);
            if open >= span {
                return span;
            }
            // A shorter chord is worth drawing where it is much shorter. NaN is not.
            if open <= 0.0 || open.is_nan() || open >= 0.25 * span {
                return open.max(0.0);
            }
            span = 2.0 * open;
        }
    }
}

/// The first `s > 0` with `gap + rate s - bend s^2 = 0`; infinite if there is none, 0 without a
/// gap.
fn first_root(gap: Real, rate: Real, bend: Real) -> Real {
    if gap.is_nan() || gap <= 0.0 {
        return 0.0;
    }
    let root = (rate * rate + 4.0 * gap * bend).sqrt();
    if rate < 0.0 {
        2.0 * gap / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / (2.0 * bend)
    } else {
        Real::INFINITY
    }
}
