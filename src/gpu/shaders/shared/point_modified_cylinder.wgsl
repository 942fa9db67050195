// Point against modified cylinder: the twin of distance/point_modified_cylinder.rs, which has the
// cases.

// A link that starts at the origin.
struct Link {
    end: vec3<real>,
    // The unit direction of the axis; zero for a ball, whose caps count as round.
    axis: vec3<real>,
    radius: real,
    // Which caps are flat.
    flat_start: bool,
    flat_end: bool,
}

struct PointLink {
    distance: real,
    on_link: vec3<real>,
}

fn link_new(end: vec3<real>, radius: real, flat_start: bool, flat_end: bool) -> Link {
    // If the squared length is below the normal numbers, the ends cannot be told apart. It is
    // compared without a factor: a smaller multiple would be 0 on devices without subnormal
    // numbers.
    let has_direction = SMALLEST_NORMAL <= norm_squared(end);
    return Link(end, select(zero(), normalised(end), has_direction), radius, flat_start, flat_end);
}

// The distance of a point from the solid link, and the link's nearest point (the point itself
// inside).
fn link_closest_to(link: Link, point: vec3<real>) -> PointLink {
    let beyond_end = real(0.0) < dot(point - link.end, link.axis);
    let before_start = !beyond_end && dot(point, link.axis) < real(0.0);

    // Cases 2 and 3 measure from the end that the point is beyond; case 1 from the nearest axis
    // point.
    let centre = select(zero(), link.end, beyond_end);
    let relative = point - centre;
    let radial = along(relative, link.axis, -dot(relative, link.axis));
    let round = (beyond_end && !link.flat_end) || (before_start && !link.flat_start);
    let flat_cap = (beyond_end && link.flat_end) || (before_start && link.flat_start);

    let arm = select(radial, relative, round);
    let reach = norm(arm);
    let outward = select(real(1.0), over(link.radius, reach), link.radius < reach);
    let pulled = along(point, arm, outward - real(1.0));
    let barrel = max(reach - link.radius, real(0.0));

    let disc = point_disc_from_centre(relative, link.axis, link.radius);
    return PointLink(
        select(barrel, disc.distance, flat_cap),
        select(pulled, centre + disc.on_disc, flat_cap),
    );
}

fn point_modified_cylinder(
    point: vec3<real>,
    start: vec3<real>,
    end: vec3<real>,
    radius: real,
    flat_start: bool,
    flat_end: bool,
) -> Closest {
    let link = link_new(end - start, radius, flat_start, flat_end);
    let found = link_closest_to(link, point - start);
    return Closest(found.distance, point, start + found.on_link);
}
