// Segment against disc: a line in the frame of a disc around the origin, and the parts that every
// route to its nearest point shares. The twin of distance/segment_disc.rs, which has the derivation
// and the cases. Another text has the route itself, the function `segment_disc_from_centre`.

struct Line {
    // Unit direction of the segment.
    direction: vec3<real>,
    // The end nearer to the foot of the disc's centre. Positions along the direction start here.
    near: vec3<real>,
    far: vec3<real>,
    // The positions of the foot and of the far end.
    foot: real,
    far_at: real,
    // -1 if s runs against the direction.
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

// The closest points for the line's minimiser `s`, clamped to the segment.
fn line_closest_at(line: Line, s: real, pierces: bool, normal: vec3<real>, radius: real) -> Closest {
    let position = s * line.sign + line.foot;
    let low = min(line.far_at, real(0.0));
    let high = max(line.far_at, real(0.0));
    let pierced = pierces && low <= position && position <= high;
    let t = min(max(position, low), high);
    // From the nearer end, so that the rounding of a long segment's direction has the least effect.
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

fn segment_disc(start: vec3<real>, end: vec3<real>, centre: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let found = segment_disc_from_centre(start - centre, end - centre, normalised(normal), radius);
    return Closest(found.distance, centre + found.point1, centre + found.point2);
}
