// Vectors: the twin of distance/vec3.rs, and of Scalar::over in distance/scalar.rs.
//
// A shader may be compiled as if no NaN and no infinity arose, so both arms of every choice are finite and a
// divisor is replaced before the division.

// dividend / divisor for a positive divisor, 0 for any other. What rounds to 0 on some devices counts as 0.
fn over(dividend: real, divisor: real) -> real {
    let positive = SMALLEST_NORMAL <= divisor;
    return select(real(0.0), dividend, positive) / select(real(1.0), divisor, positive);
}

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
