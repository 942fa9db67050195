// A triangle with a basis of its plane that stays accurate on slivers: the twin of
// distance/face.rs.

struct Face {
    // The vertices, the one opposite the longest edge first.
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    // A normal whose length is twice the area.
    across: vec3<real>,
    // The basis dual to the edges from the first vertex; zero without area.
    dual1: vec3<real>,
    dual2: vec3<real>,
}

// The projection of a point onto the plane of a face.
struct Projection {
    residual: vec3<real>,
    inside: bool,
    alpha: real,
    beta: real,
}

fn face_new(a: vec3<real>, b: vec3<real>, c: vec3<real>) -> Face {
    let ab = norm_squared(b - a);
    let bc = norm_squared(c - b);
    let ca = norm_squared(a - c);
    let ab_longest = bc <= ab && ca <= ab;
    let bc_longest = ca <= bc;
    var face = Face(
        select(select(b, a, bc_longest), c, ab_longest),
        select(select(c, b, bc_longest), a, ab_longest),
        select(select(a, c, bc_longest), b, ab_longest),
        zero(),
        zero(),
        zero(),
    );
    let e1 = face.b - face.a;
    let e2 = face.c - face.a;
    face.across = face_across(face.a, face.b, face.c);
    let inverse = over(real(1.0), norm_squared(face.across));
    face.dual1 = cross(e2, face.across) * inverse;
    face.dual2 = cross(face.across, e1) * inverse;
    return face;
}

// The face that face_new made, rebuilt from its vertices and its dual basis.
fn face_again(a: vec3<real>, b: vec3<real>, c: vec3<real>, dual1: vec3<real>, dual2: vec3<real>) -> Face {
    return Face(a, b, c, face_across(a, b, c), dual1, dual2);
}

// A normal whose length is twice the area, without a component along the longest edge.
fn face_across(a: vec3<real>, b: vec3<real>, c: vec3<real>) -> vec3<real> {
    let longest = c - b;
    let across = cross(b - a, c - a);
    return along(across, longest, -over(dot(across, longest), norm_squared(longest)));
}

// The unit normal, zero for a triangle without area.
fn face_normal(face: Face) -> vec3<real> {
    return face.across * over(real(1.0), norm(face.across));
}

fn face_has_area(face: Face) -> bool {
    return real(0.0) < norm_squared(face.dual1);
}

// The same triangle in coordinates from `start`. Far from the triangle this rounds its vertices,
// but not its plane.
fn face_seen_from(face: Face, start: vec3<real>) -> Face {
    return Face(face.a - start, face.b - start, face.c - start, face.across, face.dual1, face.dual2);
}

// The foot of `point` on the plane and the residual, refined.
fn face_project(face: Face, point: vec3<real>) -> Projection {
    let relative = point - face.a;
    let e1 = face.b - face.a;
    let e2 = face.c - face.a;
    var residual = relative;
    var alpha = real(0.0);
    var beta = real(0.0);
    for (var i = 0u; i < FACE_PASSES; i++) {
        alpha += dot(residual, face.dual1);
        beta += dot(residual, face.dual2);
        residual = along(along(relative, e1, -alpha), e2, -beta);
    }
    return Projection(residual, face_holds(face, alpha, beta), alpha, beta);
}

// The point of the plane with these coordinates along the edges from the first vertex.
fn face_at(face: Face, alpha: real, beta: real) -> vec3<real> {
    return along(along(face.a, face.b - face.a, alpha), face.c - face.a, beta);
}

// The height above the longest edge; zero without one.
fn face_height(face: Face) -> real {
    return over(norm(face.across), norm(face.c - face.b));
}

// Whether a point of the plane lies in the triangle.
fn face_holds_point(face: Face, point: vec3<real>, rounding: real) -> bool {
    let relative = point - face.a;
    let longest = face.c - face.b;
    let place = dot(point - face.b, longest);
    let slack = rounding * largest(longest);
    return face_holds(face, dot(relative, face.dual1), dot(relative, face.dual2))
        && -slack <= place && place <= norm_squared(longest) + slack;
}

fn face_holds(face: Face, alpha: real, beta: real) -> bool {
    return face_has_area(face) && real(0.0) <= alpha && real(0.0) <= beta && alpha + beta <= real(1.0);
}
