// Segment against triangle: the twin of distance/segment_triangle.rs, which has the cases.

// The bound on the distance of a segment from an edge that it meets, due to rounding, in units of u
// and the largest coordinate.
const AT_AN_EDGE = real(4.0);

// The axis of a link against a triangle.
struct AxisTriangle {
    squared: real,
    s: real,
    on_triangle: vec3<real>,
    // Whether the two meet.
    meets: bool,
}

fn axis_triangle_nearer_where(condition: bool, other: AxisTriangle, nearest: AxisTriangle) -> AxisTriangle {
    let take = condition && other.squared < nearest.squared;
    return AxisTriangle(
        select(nearest.squared, other.squared, take),
        select(nearest.s, other.s, take),
        select(nearest.on_triangle, other.on_triangle, take),
        false,
    );
}

// For the segment from the origin to `end` and coordinates near 1.
fn segment_triangle_from_start(end: vec3<real>, face: Face) -> AxisTriangle {
    // Case 3.
    var nearest = segment_triangle_edge(end, face.a, face.b);
    nearest = axis_triangle_nearer_where(true, segment_triangle_edge(end, face.b, face.c), nearest);
    nearest = axis_triangle_nearer_where(true, segment_triangle_edge(end, face.c, face.a), nearest);
    // Case 2.
    let low = face_project(face, zero());
    let high = face_project(face, end);
    nearest = axis_triangle_nearer_where(low.inside, segment_triangle_above(face, real(0.0), low), nearest);
    nearest = axis_triangle_nearer_where(high.inside, segment_triangle_above(face, real(1.0), high), nearest);
    // Case 1.
    let normal = face.across;
    let start_side = -dot(normal, face.a);
    let end_side = dot(normal, end - face.a);
    let opposite = (start_side < real(0.0) && real(0.0) < end_side)
        || (end_side < real(0.0) && real(0.0) < start_side);
    let s = over(abs(start_side), abs(start_side) + abs(end_side));
    let pierced = AxisTriangle(real(0.0), s, end * s, true);
    let extent = max(max(largest(end), largest(face.a)), max(largest(face.b), largest(face.c)));
    let rounding = extent * (AT_AN_EDGE * UNIT_ROUNDOFF);
    let holds = face_holds_point(face, end * s, rounding);
    nearest = axis_triangle_nearer_where(opposite && holds, pierced, nearest);
    nearest.meets = nearest.squared <= real(0.0) || (opposite && nearest.squared <= rounding * rounding);
    return nearest;
}

// Case 3, for the edge between two vertices.
fn segment_triangle_edge(end: vec3<real>, edge_start: vec3<real>, edge_end: vec3<real>) -> AxisTriangle {
    let found = segment_segment_parameters(-edge_start, end, edge_end - edge_start);
    return AxisTriangle(
        norm_squared(found.gap),
        found.s,
        along(edge_start, edge_end - edge_start, found.t),
        false,
    );
}

// Case 2, for the end at `s`.
fn segment_triangle_above(face: Face, s: real, foot: Projection) -> AxisTriangle {
    return AxisTriangle(norm_squared(foot.residual), s, face_at(face, foot.alpha, foot.beta), false);
}

fn segment_triangle(start: vec3<real>, end: vec3<real>, a: vec3<real>, b: vec3<real>, c: vec3<real>) -> Closest {
    let found = segment_triangle_from_start(end - start, face_new(a - start, b - start, c - start));
    let distance = select(sqrt(found.squared), real(0.0), found.meets);
    return Closest(distance, along(start, end - start, found.s), start + found.on_triangle);
}
