// Functions of double precision. The other shaders use the type `real` and are one text for both
// precisions.

// The cube root of the magnitude within 5 %: a start value, never an answer. The bits of an f64 are
// not accessible here, so it is computed in single precision, whose range is enough near one.
fn cbrt_estimate(x: real) -> real {
    let inside = f32(clamp(abs(x), real(0x1p-120lf), real(0x1p120lf)));
    return real(bitcast<f32>(bitcast<u32>(inside) / 3u + CBRT_BITS));
}

// A power of two p that brings the square of x p into range. Coordinates are near one, so only very
// small numbers need it.
fn power_of_two_to_unity(x: real) -> real {
    return select(real(1.0), real(0x1p500lf), abs(x) < real(0x1p-400lf));
}

// A nonnegative bound as it is passed between workgroups, in single precision: not above, and not
// below the number.
fn from_below(x: real) -> f32 {
    return f32(x * (real(1.0) - real(0x1p-22lf)));
}

fn from_above(x: real) -> f32 {
    return f32(x * (real(1.0) + real(0x1p-22lf)));
}
