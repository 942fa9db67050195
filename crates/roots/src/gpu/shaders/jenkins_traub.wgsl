// Jenkins and Traub's algorithm: the twin of jenkins_traub.rs, which has the description.

// A factor, z - u or z^2 + u z + v, and the quotient; degree 0 if there is none.
struct Factor {
    degree: u32,
    u: real,
    v: real,
    quotient: Coefficients,
}

// A divisor that three successive polynomials agree on.
struct Estimate {
    valid: bool,
    u: real,
    v: real,
}

// Whether a sequence has settled: two successive relative changes at most `within`.
struct Settling {
    last: real,
    was_close: bool,
    within: real,
}

fn jenkins_traub(monic: ptr<function, Coefficients>, start_degree: u32) {
    var p = *monic;
    var degree = start_degree;
    while (2u < degree) {
        let factor = jenkins_traub_factor(&p, degree);
        if (factor.degree == 0u) {
            return;
        }
        if (factor.degree == 1u) {
            push_root(factor.u, real(0.0));
        } else {
            quadratic(factor.u, factor.v);
        }
        p = factor.quotient;
        degree -= factor.degree;
    }
    if (degree == 2u) {
        quadratic(p[1], p[0]);
    } else {
        push_root(-p[0], real(0.0));
    }
}

fn no_factor(u: real) -> Factor {
    return Factor(0u, u, real(0.0), Coefficients());
}

fn jenkins_traub_factor(p: ptr<function, Coefficients>, degree: u32) -> Factor {
    let start = without_shift(p, degree);
    let bound = smallest_root_bound(p, degree);
    var direction = first_direction();
    for (var attempt = 1u; attempt <= DIRECTIONS; attempt++) {
        let x = direction.x * bound;
        let factor = with_fixed_shift(p, degree, start, -(x + x), bound * bound, 20u * attempt);
        if (factor.degree != 0u) {
            return factor;
        }
        direction = turned(direction);
    }
    return no_factor(real(0.0));
}

// Stage 1.
fn without_shift(p: ptr<function, Coefficients>, n: u32) -> Coefficients {
    var k = Coefficients();
    for (var i = 0u; i < n; i++) {
        k[i] = (*p)[i + 1u] * (real(i + 1u) / real(n));
    }
    for (var step = 0u; step < NO_SHIFT_STEPS; step++) {
        // K(0) = 0, or so little that the quotient drowns P: z divides K as it is.
        let divides = !(UNIT_ROUNDOFF * abs((*p)[0]) < abs(k[0]));
        let scale = -((*p)[0] / select(k[0], real(1.0), divides));
        for (var i = 0u; i < n; i++) {
            var above = real(0.0);
            if (i + 1u < n) {
                above = k[i + 1u];
            }
            k[i] = select((*p)[i + 1u] + scale * above, above, divides);
        }
    }
    return k;
}

fn settles(settling: ptr<function, Settling>, value: real) -> bool {
    let close = abs(value - (*settling).last) <= (*settling).within * abs((*settling).last);
    let both = close && (*settling).was_close;
    (*settling).last = value;
    (*settling).was_close = close;
    return both;
}

// Stages 2 and 3.
fn with_fixed_shift(
    p: ptr<function, Coefficients>,
    n: u32,
    start: Coefficients,
    u: real,
    v: real,
    steps: u32,
) -> Factor {
    var of_p = by_quadratic(p, n, u, v);
    var k = start;
    var of_k = by_quadratic(&k, n - 1u, u, v);
    var linear_settling = Settling(real(0.0), false, real(0.5));
    var quadratic_settling = Settling(real(0.0), false, real(0.5));
    for (var step = 0u; step < steps; step++) {
        k = next_k(&of_p, &of_k, n, u, v);
        of_k = by_quadratic(&k, n - 1u, u, v);
        let estimate = estimate_divisor(p, &k, &of_p, &of_k, u, v);
        let root = -((*p)[0] / select(k[0], SMALLEST_NORMAL, k[0] == real(0.0)));
        let linear_settled = settles(&linear_settling, root);
        var quadratic_settled = false;
        if (estimate.valid) {
            quadratic_settled = settles(&quadratic_settling, estimate.v);
        }
        if (quadratic_settled) {
            let factor = quadratic_stage(p, n, k, estimate.u, estimate.v);
            if (factor.degree != 0u) {
                return factor;
            }
            quadratic_settling.within *= real(0.25);
        }
        if (linear_settled) {
            let factor = linear_stage(p, n, k, root);
            if (factor.degree != 0u) {
                return factor;
            }
            // Two roots close together stop the linear iteration near them.
            let near = factor.u;
            let both = quadratic_stage(p, n, k, -(near + near), near * near);
            if (both.degree != 0u) {
                return both;
            }
            linear_settling.within *= real(0.25);
        }
    }
    return no_factor(real(0.0));
}

// The divisor that K, K1 and K2 agree on, given the divisions by z^2 + u z + v.
fn estimate_divisor(
    p: ptr<function, Coefficients>,
    k: ptr<function, Coefficients>,
    of_p: ptr<function, Division>,
    of_k: ptr<function, Division>,
    u: real,
    v: real,
) -> Estimate {
    // Remainders x z + y, as (x, y).
    let rest = vec2<real>((*of_p).b, (*of_p).a + u * (*of_p).b);
    let k0 = vec2<real>((*of_k).b, (*of_k).a + u * (*of_k).b);
    let first = (*k)[0] / (*p)[0];
    let k1 = divided_by_z(k0 - first * rest, u, v);
    let second = ((*k)[1] - first * (*p)[1]) / (*p)[0];
    let k2 = divided_by_z(k1 - second * rest, u, v);
    let leading = k1.x * k2.y - k1.y * k2.x;
    if (leading == real(0.0)) {
        return Estimate(false, real(0.0), real(0.0));
    }
    let next_u = -((k0.x * k2.y - k0.y * k2.x) / leading);
    let next_v = (k0.x * k1.y - k0.y * k1.x) / leading;
    return Estimate(is_finite(next_u) && is_finite(next_v) && next_v != real(0.0), next_u, next_v);
}

fn divided_by_z(rest: vec2<real>, u: real, v: real) -> vec2<real> {
    return vec2<real>(-(rest.y / v), rest.x - u * rest.y / v);
}

// The factor, or in its u the last estimate if the steps ran out.
fn linear_stage(p: ptr<function, Coefficients>, n: u32, start: Coefficients, root: real) -> Factor {
    var k = start;
    var s = root;
    for (var step = 0u; step < LINEAR_STEPS; step++) {
        let of_p = by_linear(p, n, s);
        var quotient = of_p.quotient;
        let limit = magnitude(&quotient, n - 1u, abs(s)) * abs(s) * (DIVISION_ROUNDINGS * UNIT_ROUNDOFF);
        if (is_within(abs(of_p.value), limit)) {
            return Factor(1u, s, real(0.0), quotient);
        }
        let of_k = by_linear(&k, n - 1u, s);
        let divides = of_k.value == real(0.0);
        let scale = of_p.value / select(of_k.value, real(1.0), divides);
        for (var i = 0u; i < n; i++) {
            k[i] = select(of_p.quotient[i] - scale * of_k.quotient[i], of_k.quotient[i], divides);
        }
        let slope = by_linear(&k, n - 1u, s).value;
        if (slope == real(0.0)) {
            break;
        }
        let change = of_p.value / slope;
        if (!is_finite(change)) {
            break;
        }
        s -= change;
    }
    return no_factor(s);
}

fn quadratic_stage(p: ptr<function, Coefficients>, n: u32, start: Coefficients, start_u: real, start_v: real) -> Factor {
    var k = start;
    var u = start_u;
    var v = start_v;
    for (var step = 0u; step < QUADRATIC_STEPS; step++) {
        // Two real roots far apart are better found one by one.
        let pair = quadratic_split(u, v);
        if (pair.is_real && abs(pair.second) * real(0.01) < abs(pair.first) - abs(pair.second)) {
            break;
        }
        var of_p = by_quadratic(p, n, u, v);
        if (division_is_exact(&of_p, n, u, v, DIVISION_ROUNDINGS)) {
            return Factor(2u, u, v, of_p.quotient);
        }
        var of_k = by_quadratic(&k, n - 1u, u, v);
        k = next_k(&of_p, &of_k, n, u, v);
        of_k = by_quadratic(&k, n - 1u, u, v);
        let estimate = estimate_divisor(p, &k, &of_p, &of_k, u, v);
        if (!estimate.valid) {
            break;
        }
        u = estimate.u;
        v = estimate.v;
    }
    return no_factor(real(0.0));
}

// The next K, monic, with the divisor z^2 + u z + v.
fn next_k(of_p: ptr<function, Division>, of_k: ptr<function, Division>, n: u32, u: real, v: real) -> Coefficients {
    let a = (*of_p).a;
    let b = (*of_p).b;
    let c = (*of_k).a;
    let d = (*of_k).b;
    let e = a * u + b * v;
    // -K / A = z Qp + (B / A) Qp + b - Qk / A.
    let numerator = a * d - b * c;
    let divides = numerator == real(0.0);
    let divisor = select(numerator, real(1.0), divides);
    let ratio = (a * c + e * d) / divisor;
    let inverse = (a * a + b * e) / divisor;
    if (divides || !(is_finite(ratio) && is_finite(inverse))) {
        return (*of_k).quotient;
    }
    var k = Coefficients();
    k[0] = b + ratio * (*of_p).quotient[0] - inverse * (*of_k).quotient[0];
    for (var i = 1u; i < n; i++) {
        k[i] = (*of_p).quotient[i - 1u] + ratio * (*of_p).quotient[i] - inverse * (*of_k).quotient[i];
    }
    return k;
}
