// A line seen from a disc around the origin, and the convex route to its nearest point: the twin of
// distance/segment_disc.rs, which has the derivation and the cases.

struct Line {
    // Unit direction of the segment.
    direction: vec3<real>,
    // The end nearer to the foot of the disc's centre, from which positions along the direction count.
    near: vec3<real>,
    far: vec3<real>,
    // The positions of the foot and of the far end.
    foot: real,
    far_at: real,
    // -1 where s runs against the direction.
    sign: real,
    h: real,
    lambda: real,
    m: real,
    n: real,
    tau: real,
    // |q|^2
    q: real,
}

struct RadialAt {
    rho: real,
    w: real,
}

struct NearestToDisc {
    s: real,
    pierces: bool,
}

fn line_new(start: vec3<real>, end: vec3<real>, normal: vec3<real>) -> Line {
    let edge = end - start;
    let direction = normalised(edge);
    let edge_length = dot(edge, direction);
    let from_start = -dot(start, direction);
    let from_end = -dot(end, direction);
    let start_nearer = abs(from_start) <= abs(from_end);
    let near = select(end, start, start_nearer);
    let far = select(start, end, start_nearer);
    let foot = select(from_end, from_start, start_nearer);
    let far_at = select(-edge_length, edge_length, start_nearer);
    let from_centre = along(near, direction, foot);

    let height = dot(from_centre, normal);
    let slope = dot(direction, normal);
    let radial = along(from_centre, normal, -height);
    let flat_part = along(direction, normal, -slope);
    let m = norm_squared(flat_part);
    let tau = abs(dot(from_centre, cross(normal, flat_part)));
    let shallow = slope * slope < real(0.5) && real(0.0) < m;
    let n = select(dot(radial, flat_part), -(height * slope), shallow);
    let q = select(norm_squared(radial), over(n * n + tau * tau, m), shallow);
    let sign = select(real(1.0), real(-1.0), n < real(0.0));
    return Line(direction, near, far, foot, far_at, sign, abs(height), abs(slope), m, abs(n), tau, q);
}

// The distance from the disc's axis, and w, at s.
fn line_radial_at(line: Line, s: real) -> RadialAt {
    let w = line.m * s + line.n;
    return RadialAt(sqrt(max(s * (line.n + w) + line.q, real(0.0))), w);
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
    // Case 4, as tau x, so that tau = 0 needs no exception.
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

// The radius over the distance from the axis, kept where its powers are finite: beyond, the line meets the axis.
fn disc_ratio(ratio: real) -> real {
    return min(ratio, real(1099511627776.0)); // 2^40
}

// The closest points for the line's minimiser `s`, clamped to the segment.
fn line_closest_at(line: Line, s: real, pierces: bool, normal: vec3<real>, radius: real) -> Closest {
    let position = s * line.sign + line.foot;
    let low = min(line.far_at, real(0.0));
    let high = max(line.far_at, real(0.0));
    let pierced = pierces && low <= position && position <= high;
    let t = min(max(position, low), high);
    // From the end nearer to it, so that the rounding of a long segment's direction counts least.
    let by_near_end = abs(t + t) <= abs(line.far_at);
    let point = select(
        along(line.far, line.direction, t - line.far_at),
        along(line.near, line.direction, t),
        by_near_end,
    );
    let found = point_disc_from_centre(point, normal, radius);
    return Closest(
        select(found.distance, real(0.0), pierced),
        select(point, found.on_disc, pierced),
        found.on_disc,
    );
}

// The convex route.
fn segment_disc_convex(start: vec3<real>, end: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let line = line_new(start, end, normal);
    let found = line_nearest_to_disc(line, radius);
    return line_closest_at(line, found.s, found.pierces, normal, radius);
}
