// Bounds on the distance of a link from a box and from a triangle, in single precision. The twin of
// gpu/search/bounds.rs, which derives their errors.

struct SearchedLink {
    start: vec3<f32>,
    radius: f32,
    end: vec3<f32>,
    // The bound on the error of every bound of this link.
    error: f32,
    axis: vec3<f32>,
    length: f32,
    // The box around the axis.
    low: vec3<f32>,
    high: vec3<f32>,
    // 1 / length^2.
    inverse: f32,
    // Whether a cap is flat or may be.
    flat_start: bool,
    flat_end: bool,
    // Whether a cap is round or may be.
    round_start: bool,
    round_end: bool,
    // A link with flat caps that is too short for a direction.
    is_thin: bool,
}

// Bounds on the signed distance of a triangle from a link.
struct Bounds {
    lower: f32,
    upper: f32,
}

// A place on the axis (from 0 to 1) and one on a triangle, as shares of two edges.
struct Places {
    s: f32,
    v: f32,
    w: f32,
}

fn largest(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

// `caps`: ROUND, FLAT or EITHER for the start, plus 3 times the same for the end.
fn link_new(start: vec3<f32>, end: vec3<f32>, radius: f32, caps: f32) -> SearchedLink {
    let start_cap = u32(caps) % 3u;
    let end_cap = u32(caps) / 3u;
    let along = end - start;
    let squared = dot(along, along);
    let length = sqrt(squared);
    let reach = max(max(largest(abs(start)), largest(abs(end))), max(radius, 1.0));
    let has_flat = start_cap != ROUND || end_cap != ROUND;
    let is_thin = has_flat && length < THIN * reach;
    let short = 1.0 / max(length, TINY);
    var error = ROUND_ERROR * reach;
    if (has_flat && !is_thin) {
        error = reach * (FLAT_ERROR + TURN_ERROR * radius * short);
    }
    return SearchedLink(
        start,
        radius,
        end,
        error,
        along * short,
        length,
        min(start, end),
        max(start, end),
        1.0 / max(squared, TINY),
        !is_thin && start_cap != ROUND,
        !is_thin && end_cap != ROUND,
        is_thin || start_cap != FLAT,
        is_thin || end_cap != FLAT,
        is_thin,
    );
}

// The square of a lower bound on the distance between the axis and a box.
fn box_distance_squared(link: SearchedLink, low: vec3<f32>, high: vec3<f32>) -> f32 {
    // 1. The gaps between two boxes.
    let gap = max(max(low - link.high, link.low - high), vec3<f32>(0.0));
    // 2. The plane across the vector from the axis to the centre.
    let centre = 0.5 * (low + high);
    let half = high - centre;
    let along = link.end - link.start;
    let s = clamp(dot(centre - link.start, along) * link.inverse, 0.0, 1.0);
    let normal = centre - (link.start + s * along);
    let behind = max(dot(normal, link.start), dot(normal, link.end));
    let ahead = max(dot(normal, centre) - dot(abs(normal), half) - behind, 0.0);
    let squared = dot(normal, normal);
    let plane = select(0.0, ahead * ahead / max(squared, TINY), squared > TINY);
    return max(dot(gap, gap), plane);
}

// Places where a segment from 0 to `along` and the segment from `a` to `a + edge` are close.
fn close_segments(along: vec3<f32>, a: vec3<f32>, edge: vec3<f32>) -> vec2<f32> {
    let aa = dot(along, along);
    let ee = dot(edge, edge);
    let ae = dot(along, edge);
    let c = -dot(along, a);
    let f = -dot(edge, a);
    let determinant = aa * ee - ae * ae;
    let is_skew = determinant > PARALLEL * aa * ee;
    let skew = clamp((ae * f - c * ee) / select(1.0, determinant, is_skew), 0.0, 1.0);
    let s = select(0.0, skew, is_skew);
    let t = clamp((ae * s + f) / max(ee, TINY), 0.0, 1.0);
    return vec2<f32>(clamp((ae * t - c) / max(aa, TINY), 0.0, 1.0), t);
}

// The places of a triangle's point, relative to `a`, if its foot lies in the triangle.
fn foot(
    point: vec3<f32>,
    e1: vec3<f32>,
    e2: vec3<f32>,
    normal: vec3<f32>,
    inverse: f32,
) -> vec2<f32> {
    return vec2<f32>(dot(cross(point, e2), normal), dot(cross(e1, point), normal)) * inverse;
}

fn squared_between(
    places: Places,
    along: vec3<f32>,
    a: vec3<f32>,
    e1: vec3<f32>,
    e2: vec3<f32>,
) -> f32 {
    let d = a + places.v * e1 + places.w * e2 - places.s * along;
    return dot(d, d);
}

// A guess at the closest places of an axis from 0 to `along` and a triangle.
fn close_places(along: vec3<f32>, a: vec3<f32>, e1: vec3<f32>, e2: vec3<f32>) -> Places {
    let ab = close_segments(along, a, e1);
    let ac = close_segments(along, a, e2);
    let bc = close_segments(along, a + e1, e2 - e1);
    var best = Places(ab.x, ab.y, 0.0);
    var least = squared_between(best, along, a, e1, e2);
    let normal = cross(e1, e2);
    let squared = dot(normal, normal);
    let has_face = squared > TINY;
    let inverse = 1.0 / select(1.0, squared, has_face);
    let start_height = dot(a, normal);
    let end_height = dot(a - along, normal);
    let crosses = (start_height < 0.0) != (end_height < 0.0);
    let difference = start_height - end_height;
    let divisor = select(1.0, difference, crosses && difference != 0.0);
    let crossing = clamp(start_height / divisor, 0.0, 1.0);
    for (var k = 0u; k < 5u; k++) {
        var other = Places(ac.x, 0.0, ac.y);
        if (k == 1u) {
            other = Places(bc.x, 1.0 - bc.y, bc.y);
        }
        if (k >= 2u) {
            let s = select(select(0.0, 1.0, k == 3u), crossing, k == 4u);
            let at = foot(s * along - a, e1, e2, normal, inverse);
            let is_in = has_face && at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0;
            if (!is_in || (k == 4u && !crosses)) {
                continue;
            }
            let v = clamp(at.x, 0.0, 1.0);
            other = Places(s, v, clamp(at.y, 0.0, 1.0 - v));
        }
        let squared_other = squared_between(other, along, a, e1, e2);
        if (squared_other < least) {
            best = other;
            least = squared_other;
        }
    }
    return best;
}

// How far the triangle lies ahead of the link along a normal. `caps`: the reach of a flat start and
// a flat end along that normal, beyond the ends of the axis.
fn ahead_of_plane(
    link: SearchedLink,
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    normal: vec3<f32>,
    caps: vec2<f32>,
) -> f32 {
    let triangle = min(dot(normal, a), min(dot(normal, b), dot(normal, c)));
    return triangle - max(dot(normal, link.start) + caps.x, dot(normal, link.end) + caps.y);
}

fn triangle_bounds(link: SearchedLink, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Bounds {
    let along = link.end - link.start;
    let e1 = b - a;
    let e2 = c - a;
    let places = close_places(along, a - link.start, e1, e2);
    let on_triangle = a + places.v * e1 + places.w * e2;
    let between = on_triangle - (link.start + places.s * along);
    let axis = sqrt(dot(between, between));
    let axis_ahead = max(ahead_of_plane(link, a, b, c, between, vec2<f32>(0.0)), 0.0);
    let axis_lower = select(0.0, axis_ahead / max(axis, SMALL), axis > SMALL);
    var bounds = Bounds(axis_lower - link.radius, axis - select(link.radius, 0.0, link.is_thin));
    if (!link.flat_start && !link.flat_end) {
        return bounds;
    }
    // The height of the point over the cap that is nearer to it.
    let from_start = on_triangle - link.start;
    let along_axis = dot(from_start, link.axis);
    let below_start = select(-FAR, -along_axis, link.flat_start);
    let above_end = select(-FAR, along_axis - link.length, link.flat_end);
    let height = max(below_start, above_end);
    if (height <= 0.0) {
        bounds.upper = max(bounds.upper, height);
        return bounds;
    }
    let is_end = above_end > below_start;
    let outward = select(-link.axis, link.axis, is_end);
    let radial = from_start - along_axis * link.axis;
    let rho = sqrt(dot(radial, radial));
    let beside = max(rho - link.radius, 0.0);
    bounds.upper = sqrt(height * height + beside * beside);
    let normal = height * outward + (beside / max(rho, SMALL)) * radial;
    let length = sqrt(dot(normal, normal));
    let across = normal - dot(normal, link.axis) * link.axis;
    let flat_reach = link.radius * sqrt(dot(across, across));
    let round_reach = link.radius * length;
    let caps = vec2<f32>(
        select(flat_reach, round_reach, link.round_start),
        select(flat_reach, round_reach, link.round_end),
    );
    if (length > SMALL) {
        bounds.lower = max(bounds.lower, ahead_of_plane(link, a, b, c, normal, caps) / length);
    }
    return bounds;
}
