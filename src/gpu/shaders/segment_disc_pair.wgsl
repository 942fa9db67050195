// Segment against disc by the route declared before this text: the twin of segment_disc in distance/segment_disc.rs.

fn segment_disc(start: vec3<real>, end: vec3<real>, centre: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    let found = segment_disc_from_centre(start - centre, end - centre, normalised(normal), radius);
    return Closest(found.distance, centre + found.point1, centre + found.point2);
}
