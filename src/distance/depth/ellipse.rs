//! The closest point of one half of an ellipse, which is the projection of a flat cap.
//!
//! ```text
//!             Y
//!         ____|____     upper half
//!       /     | b   \
//!      |------+------1--- X
//!             |   . p
//! ```
//!
//! # Definitions
//! - A disc of radius 1, projected along a direction that is not in its plane, is an ellipse with
//!   the half axes 1 and `b <= 1`, here along `x` and `y`.
//! - `p = (x, y)`: a given point, with `x >= 0` without loss of generality.
//! - `(X, b Y)`: the point of the upper half, `y >= 0`, closest to `p`. `(b X, Y)`: the direction
//!   of its outward normal.
//!
//! The normal at the closest point passes through `p`, so for some number `w`
//!
//! ```text
//! (X, Y) = (z0 r / (w + r - 1), z1 / w)   with   X^2 + Y^2 = 1,
//! r = 1 / b^2,   z0 = x,   z1 = y / b.
//! ```
//!
//! This is the equation of Eberly, "Distance from a point to an ellipse", with `w` for his `s + 1`.
//!
//! # Algorithm
//! 1. **`p` in the upper half**, `y > 0`: `w > 0`, where `X^2 + Y^2` decreases from infinity to 0
//!    and is convex. Neither term may exceed 1, so `w >= max(z1, 1 + r (z0 - 1))`. Newton's steps
//!    from this bound increase to the only root and never pass it.
//! 2. **`p` on the long axis**, `y = 0`: the limit of case 1. Either the lower bound on `w` is
//!    positive, or `w = 0` and `Y` follows from `X`.
//! 3. **`p` in the lower half**, `y < 0`: the upper half has a closest point only if `p` is near
//!    enough to it; then `1 - r < w <= z1 < 0`. Between its two poles `X^2 + Y^2` is convex, and
//!    its largest root is the minimum. Newton's steps from `z1` decrease to it and never pass it.
//!    If there is no root, the slope changes its sign on the way, or a step passes the pole.
//! 4. **Edge-on**, `b = 0` within rounding: the limit of the cases above. The ellipse is the
//!    segment from -1 to 1 on the x-axis. Its inner points have the normal `y`. Its ends have all
//!    normals between `x` and `y`, so `p` beyond an end needs `y >= 0`, and the normal leads from
//!    the end to `p`. Normals that differ by b move the surface by b at most.

use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector2};

/// Returns the direction, not of unit length, of the outward normal at the point of the upper half
/// that is closest to `point`.
///
/// The ellipse has the half axes 1 and `b` in [0, 1]. Returns `None` if no point of the half is a
/// local minimum of the distance.
pub(super) fn way_out_above(point: Vector2, b: Real) -> Option<Vector2> {
    if !point.is_finite() {
        return None;
    }
    if b <= Real::UNIT_ROUNDOFF {
        // Case 4.
        let beyond = point.x - point.x.clamp(-1.0, 1.0);
        return if beyond == 0.0 {
            Some(Vector2::Y)
        } else {
            (point.y >= 0.0).then_some(Vector2::new(beyond, point.y))
        };
    }
    let r = 1.0 / (b * b);
    let (z0, z1) = (point.x.abs(), point.y / b);
    let across = |w: Real| r * z0 / (w + (r - 1.0));
    let excess = |w: Real| across(w).powi(2) + (z1 / w).powi(2) - 1.0;
    let slope = |w: Real| -2.0 * (across(w).powi(2) / (w + (r - 1.0)) + (z1 / w).powi(2) / w);

    // Case 2 has no step to make.
    let mut w = if z1 < 0.0 { z1 } else { z1.max(1.0 + r * (z0 - 1.0)) };
    // Finally each step at least doubles the correct digits; before, each step more than halves a
    // term.
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

/// A limit that is never reached: rounding ends the iteration earlier.
const MAX_STEPS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with a dense sampling of the half, and with the definition of a normal.
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

    /// A disc seen edge-on is the limit of narrower ellipses.
    #[test]
    fn edge_on_is_the_limit() {
        let places = [[1.1, 0.3], [-1.1, 0.3], [2.0, 0.0], [1.1, -0.3], [0.4, 0.3], [0.4, -0.3]];
        let [mut beyond, mut without] = [0; 2];
        for [x, y] in places {
            let point = Vector2::new(x, y);
            let [limit, near] = [0.0, 1e-9].map(|b| way_out_above(point, b));
            match (limit, near) {
                (Some(limit), Some(near)) => {
                    let off = limit.normalize() - near.normalize();
                    assert!(off.length() < 1e-6, "{point}: {limit} and {near}");
                    beyond += usize::from(limit.x != 0.0);
                }
                (None, None) => without += 1,
                other => panic!("{point}: {other:?}"),
            }
        }
        assert_eq!([beyond, without], [3, 1]);
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
