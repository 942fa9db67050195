// Bairstow's method: the twin of bairstow.rs, which has the derivation.

// u and v of a quadratic factor, if one was found.
struct QuadraticFactor {
    found: bool,
    u: real,
    v: real,
}

fn bairstow(monic: ptr<function, Coefficients>, start_degree: u32) {
    var rest = *monic;
    var degree = start_degree;
    while (2u < degree) {
        let factor = bairstow_factor(&rest, degree);
        if (!factor.found) {
            return;
        }
        rest = deflated(&rest, degree, factor.u, factor.v);
        degree -= 2u;
    }
    if (degree == 2u) {
        quadratic(rest[1], rest[0]);
    } else {
        push_root(-rest[0], real(0.0));
    }
}

fn bairstow_factor(p: ptr<function, Coefficients>, degree: u32) -> QuadraticFactor {
    var radius = smallest_root_bound(p, degree);
    var direction = first_direction();
    for (var guess = 0u; guess < BAIRSTOW_GUESSES; guess++) {
        let found = bairstow_refine(p, degree, -(direction.x * radius + direction.x * radius), radius * radius);
        if (found.found) {
            return found;
        }
        direction = turned(direction);
        radius *= real(1.5);
    }
    return QuadraticFactor(false, real(0.0), real(0.0));
}

fn bairstow_refine(p: ptr<function, Coefficients>, degree: u32, start_u: real, start_v: real) -> QuadraticFactor {
    var u = start_u;
    var v = start_v;
    for (var step = 0u; step < BAIRSTOW_STEPS; step++) {
        var first = by_quadratic(p, degree, u, v);
        if (division_is_exact(&first, degree, u, v, DIVISION_ROUNDINGS)) {
            return QuadraticFactor(true, u, v);
        }
        var quotient = first.quotient;
        let second = by_quadratic(&quotient, degree - 2u, u, v);
        let e = second.a * u + second.b * v;
        let determinant = second.a * second.a + second.b * e;
        if (determinant == real(0.0)) {
            break;
        }
        u += (first.b * second.a - first.a * second.b) / determinant;
        v += (first.a * second.a + first.b * e) / determinant;
        if (!(is_finite(u) && is_finite(v))) {
            break;
        }
    }
    return QuadraticFactor(false, real(0.0), real(0.0));
}
