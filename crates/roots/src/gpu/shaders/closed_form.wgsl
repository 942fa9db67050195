// Closed form for degree 1 to 4: the twin of closed_form.rs, which has the derivation.

fn closed_form(monic: ptr<function, Coefficients>, degree: u32) {
    switch (degree) {
        case 1u: {
            push_root(-(*monic)[0], real(0.0));
        }
        case 2u: {
            quadratic((*monic)[1], (*monic)[0]);
        }
        case 3u: {
            cubic((*monic)[2], (*monic)[1], (*monic)[0]);
        }
        case 4u: {
            quartic((*monic)[3], (*monic)[2], (*monic)[1], (*monic)[0]);
        }
        default: {}
    }
}

// Adds the roots of x^3 + a x^2 + b x + c.
fn cubic(a: real, b: real, c: real) {
    let third = a * real(1.0 / 3.0);
    let q = (a * a - b * real(3.0)) * real(1.0 / 9.0);
    let r = ((a * a * a * real(2.0) - a * b * real(9.0)) + c * real(27.0)) * real(1.0 / 54.0);
    // The root farthest from the centre -a / 3 of the three, or Cardano's: it lies on the side of
    // -r.
    var x = -largest_of_depressed(q, r) - third;
    x = cubic_polished(x, a, b, c);
    x = cubic_polished(x, a, b, c);
    push_root(x, real(0.0));
    if (x == real(0.0)) {
        quadratic(a, b);
        return;
    }
    // x^2 + u x + v: from the top if x is the smallest root, from the bottom if it is the
    // largest.
    if (abs(c) < abs(x * x * x)) {
        let v = -(c / x);
        quadratic((v - b) / x, v);
    } else {
        let u = a + x;
        quadratic(u, b + x * u);
    }
}

// The root of t^3 - 3 q t - 2 r of the sign of r, the one farthest from 0.
fn largest_of_depressed(q: real, r: real) -> real {
    let cube = q * q * q;
    var size: real;
    if (r * r < cube) {
        let root = sqrt(q);
        size = root * real(2.0) * cos_of_third(min(abs(r) / (root * q), real(1.0)));
    } else {
        let a = cbrt(abs(r) + sqrt(max(r * r - cube, real(0.0))));
        size = select(a + q / select(a, real(1.0), a == real(0.0)), real(0.0), a == real(0.0));
    }
    return select(size, -size, r < real(0.0));
}

// The largest real root of y^3 - b y^2 + p y + s; or the middle of two larger roots, if rounding
// may have hidden them.
fn largest_of_resolvent(b: real, p: real, s: real) -> vec2<real> {
    let third = b * real(1.0 / 3.0);
    let q = (third * third) - p * real(1.0 / 3.0);
    let r = third * third * third - (third * p + s) * real(0.5);
    if (r * r < q * q * q) {
        let root = sqrt(q);
        let cosine = min(max(r / (root * q), real(-1.0)), real(1.0));
        let y = root * real(2.0) * cos_of_third(cosine) + third;
        return vec2<real>(y, y);
    }
    let t = largest_of_depressed(q, r);
    return vec2<real>(third + t, third - t * real(0.5));
}

// Adds the roots of x^4 + a x^3 + b x^2 + c x + d.
fn quartic(a: real, b: real, c: real, d: real) {
    let half = a * real(0.5);
    let p = a * c - d * real(4.0);
    let s = (b * d * real(4.0) - a * a * d) - c * c;
    let resolved = largest_of_resolvent(b, p, s);
    // r^2 and w^2, and their rounding: y carries the rounding of all terms of its dimension in the
    // resolvent.
    let size = abs(b) + sqrt(abs(d));
    var y = cubic_polished(resolved.x, -b, p, s);
    if ((half * half - b) + y < -((half * half + abs(y) + size) * real(1.0 / 256.0))) {
        y = cubic_polished(resolved.y, -b, p, s);
    }
    let g = y * real(0.5);
    let r2 = (half * half - b) + y;
    let w2 = g * g - d;
    let r_terms = half * half + abs(y) + size;
    let w_terms = g * g + abs(d);
    let product = (a * g - c) * real(0.5);
    var r: real;
    var w: real;
    if (w2 * r_terms <= r2 * w_terms) {
        r = sqrt(max(r2, real(0.0)));
        w = select(sqrt(max(w2, real(0.0))), product / select(real(1.0), r, real(0.0) < r), real(0.0) < r);
    } else {
        w = sqrt(max(w2, real(0.0)));
        r = select(real(0.0), product / select(real(1.0), w, real(0.0) < w), real(0.0) < w);
    }
    var low = g - w;
    var high = g + w;
    // The smaller constant by division: the sum may have cancelled.
    if (abs(low) < abs(high)) {
        low = d / high;
    } else if (low != real(0.0)) {
        high = d / low;
    }
    let factors = factors_refined(Factors(half - r, half + r, low, high), a, b, c, d);
    quadratic(factors.u0, factors.v0);
    quadratic(factors.u1, factors.v1);
}

// A Newton step on x^3 + a x^2 + b x + c, if it brings the value down.
fn cubic_polished(x: real, a: real, b: real, c: real) -> real {
    let before = ((x + a) * x + b) * x + c;
    let slope = (x * real(3.0) + a * real(2.0)) * x + b;
    if (slope == real(0.0)) {
        return x;
    }
    let next = x - before / slope;
    let after = ((next + a) * next + b) * next + c;
    return select(x, next, abs(after) < abs(before));
}

// Two quadratics x^2 + u x + v whose product is the quartic.
struct Factors {
    u0: real,
    u1: real,
    v0: real,
    v1: real,
}

// The differences of the coefficients from the product's, highest power first, and the largest
// relative to its terms.
struct Lack {
    r3: real,
    r2: real,
    r1: real,
    r0: real,
    worst: real,
}

fn factors_lack(f: Factors, a: real, b: real, c: real, d: real) -> Lack {
    let uu = f.u0 * f.u1;
    let uv = f.u0 * f.v1;
    let vu = f.u1 * f.v0;
    let vv = f.v0 * f.v1;
    let r3 = a - (f.u0 + f.u1);
    let r2 = (b - (f.v0 + f.v1)) - uu;
    let r1 = (c - uv) - vu;
    let r0 = d - vv;
    let worst3 = over(abs(r3), abs(f.u0) + abs(f.u1));
    let worst2 = over(abs(r2), abs(f.v0) + abs(f.v1) + abs(uu));
    let worst1 = over(abs(r1), abs(uv) + abs(vu));
    let worst0 = over(abs(r0), abs(vv));
    return Lack(r3, r2, r1, r0, max(max(worst3, worst2), max(worst1, worst0)));
}

// Newton's method until the product is the quartic to rounding or no longer comes closer.
fn factors_refined(start: Factors, a: real, b: real, c: real, d: real) -> Factors {
    var best = start;
    var lack = factors_lack(best, a, b, c, d);
    for (var i = 0u; i < FACTOR_STEPS; i++) {
        if (lack.worst <= FACTOR_ROUNDINGS * UNIT_ROUNDOFF) {
            break;
        }
        let du = best.u1 - best.u0;
        let dv = best.v1 - best.v0;
        // Eliminating the second factor's changes leaves two equations for the first's.
        let right1 = (lack.r1 - best.u0 * lack.r2) + (best.u0 * best.u0 - best.v0) * lack.r3;
        let right0 = (lack.r0 - best.v0 * lack.r2) + best.u0 * best.v0 * lack.r3;
        let m11 = dv - best.u0 * du;
        let m21 = -(best.v0 * du);
        let determinant = m11 * dv - m21 * du;
        if (determinant == real(0.0)) {
            break;
        }
        let du0 = (right1 * dv - right0 * du) / determinant;
        let dv0 = (m11 * right0 - m21 * right1) / determinant;
        let du1 = lack.r3 - du0;
        let dv1 = ((lack.r2 - dv0) - best.u0 * du1) - best.u1 * du0;
        let next = Factors(best.u0 + du0, best.u1 + du1, best.v0 + dv0, best.v1 + dv1);
        let next_lack = factors_lack(next, a, b, c, d);
        if (next_lack.worst < lack.worst) {
            best = next;
            lack = next_lack;
        } else {
            break;
        }
    }
    return best;
}
