// Point against triangle: the twin of distance/point_triangle.rs.

fn point_triangle(point: vec3<real>, a: vec3<real>, b: vec3<real>, c: vec3<real>) -> Closest {
    let face = face_new(a - point, b - point, c - point);
    let projection = face_project(face, zero());
    var foot = on_segment(face.a, face.b);
    let second = on_segment(face.b, face.c);
    foot = select(foot, second, norm_squared(second) < norm_squared(foot));
    let third = on_segment(face.c, face.a);
    foot = select(foot, third, norm_squared(third) < norm_squared(foot));
    let face_nearer = projection.inside && norm_squared(projection.residual) < norm_squared(foot);
    return Closest(
        select(norm(foot), norm(projection.residual), face_nearer),
        point,
        point + select(foot, face_at(face, projection.alpha, projection.beta), face_nearer),
    );
}

// The point of the segment nearest to the origin.
fn on_segment(start: vec3<real>, end: vec3<real>) -> vec3<real> {
    let edge = end - start;
    let squared = norm_squared(edge);
    let t = over(min(max(-dot(edge, start), real(0.0)), squared), squared);
    return along(start, edge, t);
}
