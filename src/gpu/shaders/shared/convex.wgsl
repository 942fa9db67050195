// The convex route from a segment to a disc: the twin of Convex in distance/segment_disc.rs.

struct NearestToDisc {
    s: real,
    pierces: bool,
}

// For the disc around the origin with a unit normal.
fn segment_disc_from_centre(start: vec3<real>, end: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let line = line_new(start, end, normal);
    let found = line_nearest_to_disc(line, radius);
    return line_closest_at(line, found.s, found.pierces, normal, radius);
}

// The s at which the line is closest to the solid disc, and whether it meets the disc there.
fn line_nearest_to_disc(line: Line, radius: real) -> NearestToDisc {
    let root_m = sqrt(line.m);
    let rim = radius * root_m;
    let reaches_plane = line.h <= line.lambda * rim;
    let plane = over(line.h, line.lambda);
    let top = select(rim, plane, reaches_plane);

    // Case 3.
    let rho0 = sqrt(line.q);
    let ratio0 = disc_ratio(over(radius, rho0));
    let turn0 = over(line.n, rho0);
    let slope0 = line.lambda * line.lambda + (line.m * (real(1.0) - ratio0) + ratio0 * turn0 * turn0);
    let from_zero = select(top, over(ratio0 * line.n, slope0), real(0.0) < slope0);
    // Case 4, as tau x, so that tau = 0 is no special case.
    let rim_m = rim * line.m;
    let tangent = sqrt(max((rim_m - line.tau) * (rim_m + line.tau), real(0.0)));
    let cusp = cbrt_estimate(over(line.n + line.n, line.tau)) * line.tau + tangent;
    let from_cusp = max(over(cusp - line.n, line.m), ratio0 * line.n);
    var s = min(min(top, from_zero), from_cusp);
    var low = real(0.0);
    var high = top;
    for (var step = 0u; step < HALLEY_STEPS; step++) {
        let radial = line_radial_at(line, s);
        let inverse = over(real(1.0), radial.rho);
        let ratio = disc_ratio(radius * inverse);
        let turn = radial.w * inverse;
        let k = real(1.0) - ratio;
        let g = line.lambda * (line.lambda * s - line.h) + radial.w * k;
        let g1 = line.lambda * line.lambda + (line.m * k + ratio * turn * turn);
        let g2 = real(3.0) * ratio * turn * (line.m - turn * turn) * inverse;
        let halley = (g1 * g1) * real(2.0) - g * g2;
        let change = select(over(g, g1), over(g * g1 * real(2.0), halley), real(0.0) < halley);
        let below = g < real(0.0);
        low = select(low, s, below);
        high = select(s, high, below);
        s = min(max(s - change, low), high);
    }

    // Case 1.
    let pierces = reaches_plane && line_radial_at(line, plane).rho <= radius;
    return NearestToDisc(select(s, plane, pierces), pierces);
}

// The radius over the distance from the axis, limited so that its powers are finite. Above the
// limit the line meets the axis.
fn disc_ratio(ratio: real) -> real {
    return min(ratio, real(1099511627776.0)); // 2^40
}
