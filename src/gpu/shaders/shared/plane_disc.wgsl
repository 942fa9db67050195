// Plane against disc: the twin of distance/plane_disc.rs.

// The disc's point nearest to a plane.
struct PlaneDisc {
    point: vec3<real>,
    distance: real,
}

// The point nearest to the plane at signed `height` along its unit normal, for the disc around the
// origin.
fn plane_disc_from_centre(height: real, plane_normal: vec3<real>, disc_normal: vec3<real>, radius: real) -> PlaneDisc {
    let radial = along(plane_normal, disc_normal, -dot(plane_normal, disc_normal));
    let slope = norm(radial);
    // The distance along the radial direction at which it meets the plane, at most the radius.
    let reach = abs(height);
    let out = select(over(reach, slope), radius, radius * slope < reach);
    let tilted = radial * over(real(1.0), slope);
    // Projects back into the disc's plane: a radial part no longer than its rounding has any
    // direction.
    let direction = along(tilted, disc_normal, -dot(tilted, disc_normal));
    return PlaneDisc(
        direction * select(out, -out, height < real(0.0)),
        max(reach - radius * slope, real(0.0)),
    );
}

fn plane_disc(
    plane_point: vec3<real>,
    plane_normal: vec3<real>,
    centre: vec3<real>,
    disc_normal: vec3<real>,
    radius: real,
) -> Closest {
    let normal = normalised(plane_normal);
    let height = dot(normal, plane_point - centre);
    let nearest = plane_disc_from_centre(height, normal, normalised(disc_normal), radius);
    let on_plane = along(nearest.point, normal, height - dot(normal, nearest.point));
    return Closest(nearest.distance, centre + on_plane, centre + nearest.point);
}
