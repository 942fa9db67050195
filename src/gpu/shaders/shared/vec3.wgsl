// Vectors: the twin of distance/vec3.rs. The functions of distance/scalar.rs beyond arithmetic
// precede every text.
//
// A compiler may assume that no NaN and no infinity arises, so both arms of every choice are
// finite.

fn norm_squared(v: vec3<real>) -> real {
    return dot(v, v);
}

fn norm(v: vec3<real>) -> real {
    return sqrt(dot(v, v));
}

// start + factor * direction
fn along(start: vec3<real>, direction: vec3<real>, factor: real) -> vec3<real> {
    return start + direction * factor;
}

// The largest magnitude of a coordinate.
fn largest(v: vec3<real>) -> real {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// The unit vector; zero for zero.
fn normalised(v: vec3<real>) -> vec3<real> {
    let near_one = v * power_of_two_to_unity(largest(v));
    return near_one * over(real(1.0), norm(near_one));
}

fn zero() -> vec3<real> {
    return vec3<real>(real(0.0), real(0.0), real(0.0));
}
