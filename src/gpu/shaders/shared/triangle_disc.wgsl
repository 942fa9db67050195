// Triangle against disc: the twin of distance/triangle_disc.rs, which has the cases.

// The bound on the distance of a computed point of the triangle from the triangle, in units of u
// and for coordinates near 1.
const TRIANGLE_DISC_ROUNDING = real(32.0);

// For a disc around the origin, a unit normal and coordinates near 1.
fn triangle_disc_from_centre(face: Face, normal: vec3<real>, radius: real) -> Closest {
    // Case 1.
    var edges = segment_disc_from_centre(face.a, face.b, normal, radius);
    edges = closest_nearer(edges, segment_disc_from_centre(face.b, face.c, normal, radius));
    edges = closest_nearer(edges, segment_disc_from_centre(face.c, face.a, normal, radius));
    // Cases 2 and 3.
    let plane_normal = face_normal(face);
    let nearest = plane_disc_from_centre(dot(plane_normal, face.a), plane_normal, normal, radius);
    let projection = face_project(face, nearest.point);
    let apart = Closest(
        norm(projection.residual),
        face_at(face, projection.alpha, projection.beta),
        nearest.point,
    );
    let meeting = Closest(real(0.0), nearest.point, nearest.point);
    let within_height = edges.distance <= face_height(face) + TRIANGLE_DISC_ROUNDING * UNIT_ROUNDOFF;
    let face_answer = closest_select(nearest.distance <= real(0.0) && within_height, meeting, apart);
    return closest_select(projection.inside && face_answer.distance <= edges.distance, face_answer, edges);
}

fn triangle_disc(
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    centre: vec3<real>,
    normal: vec3<real>,
    radius: real,
) -> Closest {
    let face = face_new(a - centre, b - centre, c - centre);
    let found = triangle_disc_from_centre(face, normalised(normal), radius);
    return Closest(found.distance, centre + found.point1, centre + found.point2);
}
