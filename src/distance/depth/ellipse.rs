//! The shadow of a flat cap: the way out of an ellipse through one of its halves.
//!
//! Seen along a direction that is not in its plane, a disc of radius 1 is an ellipse with half axes
//! 1 and `b <= 1`, here along `x` and `y`. Wanted is the point of its upper half, `y >= 0`, that is
//! closest to a given point `p`, and the outward normal there. With `p = (x, y)`, `x >= 0` without
//! loss of generality, the normal at the closest point passes through `p`, so that for some number
//! `w`
//!
//! ```text
//! (X, Y) = (z0 r / (w + r - 1), z1 / w)   with   X^2 + Y^2 = 1,   r = 1 / b^2,   z0 = x,   z1 = y / b,
//! ```
//!
//! where `(X, b Y)` is the closest point and `(b X, Y)` the direction of the normal. (This is the
//! equation of Eberly, "Distance from a point to an ellipse", with his `s + 1` as `w`.)
//!
//! 1. **`p` in the upper half**, `y > 0`: `w > 0`, where the left side falls from infinity to 0 and
//!    is convex. Neither term may exceed 1, so `w >= max(z1, 1 + r (z0 - 1))`. Newton's steps from
//!    there rise to the one root and never pass it.
//! 2. **`p` on the long axis**, `y = 0`: the limit of case 1. Either the lower bound on `w` is
//!    positive, or `w = 0` and `Y` follows from `X`.
//! 3. **`p` in the lower half**, `y < 0`: the upper half has a closest point only if `p` is near
//!    enough to it, and then `1 - r < w <= z1 < 0`. Between its two poles the left side is convex;
//!    the largest root is the one that is a minimum. Newton's steps from `z1` fall to it and never
//!    pass it; if there is no root, the slope changes its sign on the way, or the pole is passed.

use parry3d_f64::math::{Real, Vector2};

/// The direction, not of unit length, of the outward normal where the upper half of the ellipse
/// with the half axes 1 and `b` in (0, 1] is closest to `point`. Nothing if no point of the half is
/// closest in its surroundings.
pub(super) fn way_out_above(point: Vector2, b: Real) -> Option<Vector2> {
    let r = 1.0 / (b * b);
    let (z0, z1) = (point.x.abs(), point.y / b);
    if !(r.is_finite() && z0.is_finite() && z1.is_finite()) {
        return None;
    }
    let across = |w: Real| r * z0 / (w + (r - 1.0));
    let excess = |w: Real| across(w).powi(2) + (z1 / w).powi(2) - 1.0;
    let slope = |w: Real| -2.0 * (across(w).powi(2) / (w + (r - 1.0)) + (z1 / w).powi(2) / w);

    // Case 2 has no step to make.
    let mut w = if z1 < 0.0 { z1 } else { z1.max(1.0 + r * (z0 - 1.0)) };
    // Each step at least doubles the correct digits in the end; before, a term falls by more than
    // half.
    for _ in 0..MAX_STEPS {
        if z1 == 0.0 {
            break;
        }
        let step = excess(w) / slope(w);
        let next = w - step;
        if z1 > 0.0 {
            // Case 1.
            if next.is_nan() || next <= w {
                break;
            }
        } else {
            // Case 3.
            if slope(w).is_nan() || slope(w) <= 0.0 || next <= 1.0 - r {
                return None;
            }
            if next >= w {
                break;
            }
        }
        w = next;
    }
    let (x, y) = if w > 0.0 || z1 < 0.0 {
        (across(w), z1 / w)
    } else {
        let x = r * z0 / (r - 1.0);
        (x, (1.0 - x * x).max(0.0).sqrt())
    };
    let way = Vector2::new((b * x).copysign(point.x), y);
    way.is_finite().then_some(way)
}

/// More than rounding leaves to do.
const MAX_STEPS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a fine walk along the half, and the definition of a normal.
    #[test]
    fn no_point_of_the_half_is_closer() {
        let mut state = 1u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as Real / (1u64 << 53) as Real
        };
        let mut found = [0; 2];
        for _ in 0..2000 {
            let b = random().powi(2).max(1e-3);
            let inside = Vector2::new(2.0 * random() - 1.0, 2.0 * random() - 1.0);
            let point = Vector2::new(inside.x, inside.y * if random() < 0.5 { b } else { 1.0 });
            let on = |turn: Real| Vector2::new(turn.cos(), b * turn.sin());
            let nearest = (1..4000).map(|k| on(std::f64::consts::PI * k as Real / 4000.0));
            let nearest = nearest.map(|q| (q - point).length()).fold(Real::INFINITY, Real::min);
            let in_ellipse = point.x.powi(2) + (point.y / b).powi(2) < 1.0;
            let ends = (Vector2::new(1.0, 0.0) - point)
                .length()
                .min((Vector2::new(-1.0, 0.0) - point).length());
            match way_out_above(point, b) {
                Some(n) => {
                    let n = n.normalize();
                    let at =
                        Vector2::new(n.x, b * b * n.y) / (n.x * n.x + b * b * n.y * n.y).sqrt();
                    let offset = at - point;
                    assert!(offset.perp_dot(n).abs() < 1e-9, "{point} {b}: {n} at {at}");
                    if point.y >= 0.0 && in_ellipse {
                        found[0] += 1;
                        assert!(offset.length() <= nearest + 1e-9, "{point} {b}");
                    } else if point.y < 0.0 && nearest < ends - 1e-3 {
                        found[1] += 1;
                        assert!(offset.length() <= nearest + 1e-9, "{point} {b}");
                    }
                }
                None => assert!(point.y < 0.0 && nearest >= ends - 1e-3, "{point} {b}"),
            }
        }
        assert!(found.iter().all(|&n| n > 200), "{found:?}");
    }

    #[test]
    fn on_the_axes() {
        let up = way_out_above(Vector2::new(0.0, 0.0), 0.5).unwrap();
        assert_eq!(up.normalize(), Vector2::Y);
        let up = way_out_above(Vector2::new(0.0, -0.25), 0.5).unwrap();
        assert_eq!(up.normalize(), Vector2::Y);
        let side = way_out_above(Vector2::new(-0.9, 0.0), 0.5).unwrap();
        assert_eq!(side.normalize(), -Vector2::X);
        // Beyond the centre of curvature of the top, 1 / b below it.
        assert_eq!(way_out_above(Vector2::new(0.0, -2.0), 0.5), None);
    }
}
