// Segment against disc, by the convex route: the twin of Convex in distance/segment_disc.rs.

// For the disc around the origin with a unit normal.
fn segment_disc_from_centre(start: vec3<real>, end: vec3<real>, normal: vec3<real>, radius: real) -> Closest {
    return segment_disc_convex(start, end, normal, radius);
}
