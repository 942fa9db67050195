// Point against disc: the twin of distance/point_disc.rs.

struct PointDisc {
    distance: real,
    on_disc: vec3<real>,
}

// The distance of `point` from the disc around the origin, and the disc's point.
fn point_disc_from_centre(point: vec3<real>, unit_normal: vec3<real>, radius: real) -> PointDisc {
    let height = dot(point, unit_normal);
    let radial = along(point, unit_normal, -height);
    let rho = norm(radial);
    let beyond = max(rho - radius, real(0.0));
    let shrink = select(real(1.0), over(radius, rho), radius < rho);
    return PointDisc(sqrt(height * height + beyond * beyond), radial * shrink);
}

fn point_disc(point: vec3<real>, centre: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let found = point_disc_from_centre(point - centre, normalised(normal), radius);
    return Closest(found.distance, point, centre + found.on_disc);
}
