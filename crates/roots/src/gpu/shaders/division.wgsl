// Synthetic division: the twin of division.rs.

// P = quotient (z^2 + u z + v) + b (z + u) + a.
struct Division {
    quotient: Coefficients,
    b: real,
    a: real,
}

// P = quotient (z - s) + value.
struct LinearDivision {
    quotient: Coefficients,
    value: real,
}

fn by_quadratic(p: ptr<function, Coefficients>, degree: u32, u: real, v: real) -> Division {
    var division = Division(Coefficients(), real(0.0), real(0.0));
    var q1 = real(0.0);
    var q2 = real(0.0);
    for (var k = degree; 2u <= k; k--) {
        let q = ((*p)[k] - v * q2) - u * q1;
        division.quotient[k - 2u] = q;
        q2 = q1;
        q1 = q;
    }
    division.b = (*p)[1] - u * q1 - v * q2;
    division.a = (*p)[0] - u * division.b - v * q1;
    return division;
}

fn by_linear(p: ptr<function, Coefficients>, degree: u32, s: real) -> LinearDivision {
    var division = LinearDivision(Coefficients(), (*p)[degree]);
    for (var k = degree; 0u < k; k--) {
        division.quotient[k - 1u] = division.value;
        division.value = division.value * s + (*p)[k - 1u];
    }
    return division;
}

// The sum of |q_k| size^k.
fn magnitude(quotient: ptr<function, Coefficients>, degree: u32, size: real) -> real {
    var sum = real(0.0);
    for (var k = degree + 1u; 0u < k; k--) {
        sum = sum * size + abs((*quotient)[k - 1u]);
    }
    return sum;
}

fn is_within(value: real, limit: real) -> bool {
    return value <= limit && is_finite(limit);
}

// Whether the divisor divides the polynomial of this degree, within rounding.
fn division_is_exact(division: ptr<function, Division>, degree: u32, u: real, v: real, roundings: real) -> bool {
    let b = (*division).b;
    let a = (*division).a;
    var quotient = (*division).quotient;
    let roundoff = roundings * UNIT_ROUNDOFF;
    let pair = quadratic_split(u, v);
    if (pair.is_real) {
        let large = abs(pair.first);
        let small = abs(pair.second);
        let high = abs(b * (pair.first + u) + a);
        // The division rounds what the larger root calls for, also at the smaller one.
        let low = max(abs(b * (pair.second + u) + a), abs(b * pair.second));
        let high_limit = magnitude(&quotient, degree - 2u, large) * large * large * roundoff;
        let low_limit = magnitude(&quotient, degree - 2u, small) * small * small * roundoff;
        return is_within(high, high_limit) && is_within(low * small, low_limit * large);
    }
    let size = sqrt(pair.first * pair.first + pair.second * pair.second);
    let value = abs(b * (pair.first + u) + a) + abs(b * size);
    return is_within(value, magnitude(&quotient, degree - 2u, size) * size * size * roundoff);
}

// Takes z^2 + u z + v out of p, adds its roots and returns the quotient.
fn deflated(p: ptr<function, Coefficients>, degree: u32, u: real, v: real) -> Coefficients {
    let pair = quadratic_split(u, v);
    if (pair.is_real && abs(pair.second) * real(2.0) < abs(pair.first)) {
        let small = division_polished(p, degree, pair.second);
        let large = division_polished(p, degree, pair.first);
        push_root(small, real(0.0));
        push_root(large, real(0.0));
        var rest = composite_linear(p, degree, small);
        return composite_linear(&rest, degree - 1u, large);
    }
    quadratic(u, v);
    let join = min(largest_term(p, degree, sqrt(abs(v))), degree);
    var quotient = by_quadratic(p, degree, u, v).quotient;
    var q1 = real(0.0);
    var q2 = real(0.0);
    for (var k = 0u; k + 1u < join; k++) {
        let q = ((*p)[k] - u * q1 - q2) / v;
        quotient[k] = q;
        q2 = q1;
        q1 = q;
    }
    return quotient;
}

// The real root after two Newton steps; a step that does not lower |p| is not taken.
fn division_polished(p: ptr<function, Coefficients>, degree: u32, start: real) -> real {
    var s = start;
    var division = by_linear(p, degree, s);
    for (var i = 0u; i < 2u; i++) {
        var quotient = division.quotient;
        let slope = by_linear(&quotient, degree - 1u, s).value;
        if (slope == real(0.0)) {
            break;
        }
        let next = s - division.value / slope;
        let next_division = by_linear(p, degree, next);
        if (abs(next_division.value) < abs(division.value)) {
            s = next;
            division = next_division;
        }
    }
    return s;
}

fn composite_linear(p: ptr<function, Coefficients>, degree: u32, s: real) -> Coefficients {
    var quotient = by_linear(p, degree, s).quotient;
    let join = largest_term(p, degree, abs(s));
    var q = real(0.0);
    for (var k = 0u; k < join; k++) {
        q = (q - (*p)[k]) / s;
        quotient[k] = q;
    }
    return quotient;
}

// The power whose term is largest at |z| = size.
fn largest_term(p: ptr<function, Coefficients>, degree: u32, size: real) -> u32 {
    var power = real(1.0);
    var most = real(0.0);
    var place = 0u;
    for (var k = 0u; k <= degree; k++) {
        let term = abs((*p)[k]) * power;
        if (most < term) {
            most = term;
            place = k;
        }
        power *= size;
    }
    return place;
}

// No root of p, which is monic, is nearer to 0 (Cauchy), to a few per cent.
fn smallest_root_bound(p: ptr<function, Coefficients>, degree: u32) -> real {
    let constant = abs((*p)[0]);
    var power = 126;
    for (var k = 1u; k <= degree; k++) {
        let a = (*p)[k];
        if (a != real(0.0)) {
            // Where this term alone reaches the constant, rounded up.
            let rise = exponent(constant) + 1 - exponent(a);
            let steps = i32(k);
            let quotient = select(rise / steps, (rise - steps + 1) / steps, rise < 0);
            power = min(power, quotient + 1);
        }
    }
    // From above on a convex increasing function, Newton's method only comes down.
    var x = times_power_of_two(real(1.0), power);
    for (var i = 0u; i < 16u; i++) {
        var value = real(0.0);
        var slope = real(0.0);
        for (var k = degree; 0u < k; k--) {
            slope = slope * x + value;
            value = value * x + abs((*p)[k]);
        }
        slope = slope * x + value;
        value = value * x - constant;
        let step = value / slope;
        x -= step;
        if (step <= x * real(0.02)) {
            break;
        }
    }
    return x;
}
