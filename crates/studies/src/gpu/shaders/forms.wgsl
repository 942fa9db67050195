// The two distances of the paper's Tables II and III by clamping and by a decision tree, squared,
// with the same products, so that they differ in branching alone. Both are less exact than the
// functions of the narrow phase.

// Segment p0 p1 and segment q0 q1: the first part of both forms.
struct TwoSegments {
    along1: vec3<real>,
    along2: vec3<real>,
    gap: vec3<real>,
    a: real,
    b: real,
    c: real,
    d: real,
    e: real,
}

fn two_segments(p0: vec3<real>, p1: vec3<real>, q0: vec3<real>, q1: vec3<real>) -> TwoSegments {
    let along1 = p1 - p0;
    let along2 = q0 - q1;
    let gap = p0 - q0;
    return TwoSegments(
        along1,
        along2,
        gap,
        dot(along1, along1),
        dot(along1, along2),
        dot(along2, along2),
        dot(along1, gap),
        dot(along2, gap),
    );
}

fn two_squared(two: TwoSegments, t: real, v: real) -> real {
    return norm_squared(two.gap + two.along1 * t + two.along2 * v);
}

// (7) and (8) without a branch, corrected.
fn clamped_segments(two: TwoSegments) -> real {
    let numerator = two.e * two.b - two.d * two.c;
    let free = over(numerator, two.a * two.c - two.b * two.b);
    let to_start = -two.d;
    let to_end = -(two.d + two.b);
    let on_line = min(max(free * two.a, min(to_start, to_end)), max(to_start, to_end));
    let t = over(min(max(on_line, real(0.0)), two.a), two.a);
    let v = over(min(max(-(two.e + two.b * t), real(0.0)), two.c), two.c);
    return two_squared(two, t, v);
}

// By a decision tree: which of interior, end or start holds the closest point of either segment.
fn tree_segments(two: TwoSegments) -> real {
    // The first segment's parameter if the second were a line.
    let numerator = two.e * two.b - two.d * two.c;
    let determinant = two.a * two.c - two.b * two.b;
    var t: real;
    if (determinant <= real(0.0) || numerator <= real(0.0)) {
        t = real(0.0);
    } else if (determinant <= numerator) {
        t = real(1.0);
    } else {
        t = numerator / determinant;
    }
    let v = -(two.e + two.b * t);
    // If that leaves the second segment, its end decides, and the first follows.
    if (v <= real(0.0)) {
        return two_squared(two, tree_follow(two, real(0.0)), real(0.0));
    } else if (two.c <= v) {
        return two_squared(two, tree_follow(two, real(1.0)), real(1.0));
    }
    return two_squared(two, t, v / two.c);
}

fn tree_follow(two: TwoSegments, v: real) -> real {
    let t = -(two.d + two.b * v);
    if (t <= real(0.0)) {
        return real(0.0);
    } else if (two.a <= t) {
        return real(1.0);
    }
    return t / two.a;
}

// Point and triangle without a branch: the face if the foot lies inside, and the three edges by
// clamping.
fn clamped_triangle(p: vec3<real>, a: vec3<real>, b: vec3<real>, c: vec3<real>) -> real {
    let ab = b - a;
    let ac = c - a;
    let ap = p - a;
    let normal = cross(ab, ac);
    let squared = norm_squared(normal);
    // Barycentric coordinates of the foot, times the normal's square.
    let beta = dot(cross(ap, ac), normal);
    let gamma = dot(cross(ab, ap), normal);
    let inside = real(0.0) <= beta && real(0.0) <= gamma && beta + gamma <= squared && real(0.0) < squared;
    let height = dot(normal, ap);
    let edges = min(min(clamped_edge(p, a, b), clamped_edge(p, b, c)), clamped_edge(p, c, a));
    return select(edges, over(height * height, squared), inside);
}

fn clamped_edge(p: vec3<real>, start: vec3<real>, end: vec3<real>) -> real {
    let edge = end - start;
    let squared = norm_squared(edge);
    let t = over(min(max(dot(edge, p - start), real(0.0)), squared), squared);
    return norm_squared(along(p - start, edge, -t));
}

// By a decision tree over the seven regions of the triangle's plane.
fn tree_triangle(p: vec3<real>, a: vec3<real>, b: vec3<real>, c: vec3<real>) -> real {
    let ab = b - a;
    let ac = c - a;
    let ap = p - a;
    let b_a = dot(ab, ap);
    let c_a = dot(ac, ap);
    if (b_a <= real(0.0) && c_a <= real(0.0)) {
        return norm_squared(ap); // vertex a
    }
    let bp = p - b;
    let b_b = dot(ab, bp);
    let c_b = dot(ac, bp);
    if (real(0.0) <= b_b && c_b <= b_b) {
        return norm_squared(bp); // vertex b
    }
    let gamma = b_a * c_b - b_b * c_a;
    if (gamma <= real(0.0) && real(0.0) <= b_a && b_b <= real(0.0)) {
        return norm_squared(along(ap, ab, -(b_a / (b_a - b_b)))); // edge ab
    }
    let cp = p - c;
    let b_c = dot(ab, cp);
    let c_c = dot(ac, cp);
    if (real(0.0) <= c_c && b_c <= c_c) {
        return norm_squared(cp); // vertex c
    }
    let beta = b_c * c_a - b_a * c_c;
    if (beta <= real(0.0) && real(0.0) <= c_a && c_c <= real(0.0)) {
        return norm_squared(along(ap, ac, -(c_a / (c_a - c_c)))); // edge ac
    }
    let alpha = b_b * c_c - b_c * c_b;
    let to_c = c_b - b_b;
    let to_b = b_c - c_c;
    if (alpha <= real(0.0) && real(0.0) <= to_c && real(0.0) <= to_b) {
        return norm_squared(along(bp, c - b, -(to_c / (to_c + to_b)))); // edge bc
    }
    let scale = real(1.0) / (alpha + beta + gamma);
    return norm_squared(along(along(ap, ab, -(beta * scale)), ac, -(gamma * scale))); // face
}

fn form_point(place: u32) -> vec3<real> {
    return vec3<real>(problems[place], problems[place + 1u], problems[place + 2u]);
}
