//! The time for which a plane stays between an end of a moving link and a point of the other shape.
//!
//! # Definitions
//! - `n`: the plane's normal. `gap`: the distance of the two along n.
//! - `rate`: the speed at which they part. `bend`: an upper bound on the loss by turning.
//! - `reach(s)`: the extent of the end's cap along n after the time s.
//! - `r`: the radius. `a`: the axis. `m`: the velocity of n as seen from the link.
//!
//! # Bound
//! After the time s they are at least this far apart:
//!
//! ```text
//! gap + rate s - bend s^2 - reach(s)
//! ```
//!
//! While the normal leans out over a round cap, `reach` is the radius. Otherwise it is the support
//! function of the half ball or the disc along the turning normal:
//!
//! ```text
//! reach(s) = r |p - a (p . a)|,   p = n + s m,      and r |p| once p leans out over a round cap.
//! ```
//!
//! **Claim.** Within a span of time there is no contact before the first root of a parabola.
//! **Proof.** A support function is convex, so over the span it lies below its chord.
//!
//! The bound is exact to second order except for the chord, and a shorter span improves the chord.
//! A cap does not change when it turns about its axis. So only the turning of the axis itself
//! counts: a cylinder may roll at any speed.

use parry3d_f64::math::{Real, Vector};

/// The motion of an end and a point along a normal, at one time (see the head of this file).
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneGap {
    pub gap: Real,
    pub rate: Real,
    pub bend: Real,
    pub reach: Reach,
}

/// The extent of a cap along the normal from its centre.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reach {
    /// The normal leans out over a round cap.
    Radius(Real),
    Support(Support),
}

/// A disc or a half ball, and a turning direction.
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
    /// Returns a time for which the plane stays between the two, at most `span`.
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
            // A much shorter span improves the chord. NaN ends the loop.
            if open <= 0.0 || open.is_nan() || open >= 0.25 * span {
                return open.max(0.0);
            }
            span = 2.0 * open;
        }
    }
}

/// Returns the first `s > 0` with `gap + rate s - bend s^2 = 0`; infinite if there is none, 0
/// without a gap.
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
