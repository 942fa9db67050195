// Triangle against modified cylinder: the twin of distance/triangle_modified_cylinder.rs, which has
// the cases.

// The part of the answer about a link and a triangle that depends on the axis alone, in coordinates
// from the link's start.
struct Axial {
    // The squared distance between axis and triangle.
    axis_squared: real,
    // Whether the axis meets the triangle, up to rounding.
    meets: bool,
    // The triangle's point.
    on_triangle: vec3<real>,
    // Whether the disc at the start, or at the end, decides (case 2).
    at_flat_start: bool,
    at_flat_end: bool,
}

struct LinkCap {
    centre: vec3<real>,
    outward: vec3<real>,
}

fn axial_new(link: Link, face: Face) -> Axial {
    let axis = segment_triangle_from_start(link.end, face);
    let has_axis = real(0.0) < norm_squared(link.axis);
    // Both ends of a short link may be equally near within rounding. The end that the point is
    // beyond then decides.
    let before_start = dot(axis.on_triangle, link.axis) < real(0.0);
    let beyond_end = real(0.0) < dot(axis.on_triangle - link.end, link.axis);
    let at_start = before_start || (axis.s <= real(0.0) && !beyond_end);
    let at_end = beyond_end || (real(1.0) <= axis.s && !before_start);
    return Axial(
        axis.squared,
        axis.meets,
        axis.on_triangle,
        link.flat_start && has_axis && at_start,
        link.flat_end && has_axis && at_end,
    );
}

fn axial_beyond_flat_cap(axial: Axial) -> bool {
    return axial.at_flat_start || axial.at_flat_end;
}

// The distance between the triangle's point and the link: an upper bound, and the answer in case 1.
fn axial_without_caps(axial: Axial, link: Link) -> Closest {
    let found = link_closest_to(link, axial.on_triangle);
    return Closest(
        select(found.distance, real(0.0), axial.meets),
        axial.on_triangle,
        select(found.on_link, axial.on_triangle, axial.meets),
    );
}

// A lower and an upper bound on the answer in case 2.
fn axial_cap_bounds(axial: Axial, link: Link, face: Face) -> Bounds {
    let cap = axial_cap(axial, link);
    return bounds_separating_plane(
        face.a - cap.centre,
        face.b - cap.centre,
        face.c - cap.centre,
        axial.on_triangle - cap.centre,
        cap.outward,
        link.radius,
        largest(link.end) * real(2.0) + link.radius,
    );
}

// The answer, discs included.
fn axial_with_caps(axial: Axial, link: Link, face: Face) -> Closest {
    let upper = axial_without_caps(axial, link);
    let cap = axial_cap(axial, link);
    let disc = triangle_disc_from_centre(face_seen_from(face, cap.centre), cap.outward, link.radius);
    let moved = Closest(disc.distance, disc.point1 + cap.centre, disc.point2 + cap.centre);
    let beyond = axial_beyond_flat_cap(axial);
    let nearer = closest_select(beyond && disc.distance < upper.distance, moved, upper);
    let way_in = axial_way_in(axial, cap, link.radius, face);
    let met = Closest(real(0.0), way_in.point, way_in.point);
    let closest = closest_select(beyond && way_in.passes && real(0.0) < nearer.distance, met, nearer);
    return settled(closest, beyond, extent_with(link, face));
}

// The extent: the largest coordinate difference of two of the points, the link's start included, or
// the radius.
fn extent_with(link: Link, face: Face) -> real {
    let low = min(min(min(zero(), link.end), min(face.a, face.b)), face.c);
    let high = max(max(max(zero(), link.end), max(face.a, face.b)), face.c);
    return max(largest(high - low), link.radius);
}

// The same, but 0 with one common point if a flat cap decides and the distance is within rounding.
// The twin of distance/touching.rs.
fn settled(closest: Closest, at_cap: bool, extent: real) -> Closest {
    let limit = extent * (real(8.0) * UNIT_ROUNDOFF);
    let meets = at_cap && real(0.0) < closest.distance && closest.distance <= limit;
    let middle = (closest.point1 + closest.point2) * real(0.5);
    return closest_select(meets, Closest(real(0.0), middle, middle), closest);
}

struct WayIn {
    passes: bool,
    point: vec3<real>,
}

// Whether the segment from the triangle's point to the vertex deepest behind the cap passes through
// the disc, and where.
fn axial_way_in(axial: Axial, cap: LinkCap, radius: real, face: Face) -> WayIn {
    let a = face.a - cap.centre;
    let b = face.b - cap.centre;
    let c = face.c - cap.centre;
    let of_a = -dot(a, cap.outward);
    let of_b = -dot(b, cap.outward);
    let of_c = -dot(c, cap.outward);
    let depth = max(max(of_a, of_b), of_c);
    let deepest = select(select(c, b, depth <= of_b), a, depth <= of_a);
    let origin = axial.on_triangle - cap.centre;
    let height = max(dot(origin, cap.outward), real(0.0));
    let crossing = origin + (deepest - origin) * over(height, height + depth);
    let radial = crossing - cap.outward * dot(crossing, cap.outward);
    return WayIn(real(0.0) < depth && norm_squared(radial) <= radius * radius, cap.centre + radial);
}

// The centre and the outward normal of the cap that the triangle's point is beyond; of the start if
// it is beyond neither.
fn axial_cap(axial: Axial, link: Link) -> LinkCap {
    return LinkCap(
        select(zero(), link.end, axial.at_flat_end),
        select(-link.axis, link.axis, axial.at_flat_end),
    );
}

fn triangle_modified_cylinder(
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    start: vec3<real>,
    end: vec3<real>,
    radius: real,
    flat_start: bool,
    flat_end: bool,
) -> Closest {
    let face = face_new(a - start, b - start, c - start);
    let link = link_new(end - start, radius, flat_start, flat_end);
    let found = axial_with_caps(axial_new(link, face), link, face);
    return Closest(found.distance, start + found.point1, start + found.point2);
}

fn triangle_capsule(
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    start: vec3<real>,
    end: vec3<real>,
    radius: real,
) -> Closest {
    return triangle_modified_cylinder(a, b, c, start, end, radius, false, false);
}
