// Segment against disc by the paper's quartic, recentred: the twin of RecentredQuartic in
// quartic.rs.
// `approximate` is the root finder, declared beside this text.

// For the disc around the origin with a unit normal.
fn segment_disc_from_centre(start: vec3<real>, end: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let line = line_new(start, end, normal);
    // The squared distance is convex along the line, so the best point of the line serves, clamped.
    var s = real(0.0);
    var least = squared_distance(line, s, radius);
    if (real(0.0) < radius) {
        let n = line.n / radius;
        let p = line.q / (radius * radius);
        root_count = 0u;
        quartic_roots(-(n * n), -(real(2.0) * line.m * n), p - line.m * line.m, real(2.0) * n, line.m);
        for (var i = 0u; i < root_count; i++) {
            let candidate = root_re[i] * radius;
            let squared = squared_distance(line, candidate, radius);
            if (squared < least) {
                least = squared;
                s = candidate;
            }
        }
    }
    let plane = over(line.h, line.lambda);
    s = select(s, plane, squared_distance(line, plane, radius) < least);
    return line_closest_at(line, s, false, normal, radius);
}

// Finds the roots of a quartic, whose leading coefficients may be 0.
fn quartic_roots(a0: real, a1: real, a2: real, a3: real, a4: real) {
    var coefficients = Coefficients();
    coefficients[0] = a0;
    coefficients[1] = a1;
    coefficients[2] = a2;
    coefficients[3] = a3;
    coefficients[4] = a4;
    var high = 4u;
    while (0u < high && abs(coefficients[high]) < SMALLEST_NORMAL) {
        high--;
    }
    var low = 0u;
    while (low < high && coefficients[low] == real(0.0)) {
        push_root(real(0.0), real(0.0));
        low++;
    }
    let degree = high - low;
    if (degree == 0u) {
        return;
    }
    var monic = Coefficients();
    for (var k = 0u; k < degree; k++) {
        monic[k] = coefficients[low + k] / coefficients[high];
    }
    monic[degree] = real(1.0);
    approximate(&monic, degree);
}

// The squared distance of the line's point from the solid disc.
fn squared_distance(line: Line, s: real, radius: real) -> real {
    let height = line.lambda * s - line.h;
    let beyond = max(line_radial_at(line, s).rho - radius, real(0.0));
    return height * height + beyond * beyond;
}
