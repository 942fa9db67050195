// Functions of single precision. The other shaders use the type `real` and are one text for both
// precisions.

// The cube root of the magnitude within 5 %: a start value, never an answer.
fn cbrt_estimate(x: real) -> real {
    return bitcast<f32>(bitcast<u32>(abs(x)) / 3u + CBRT_BITS);
}

// The power of two p with 1 <= x p < 2, or 1 for 0. Saturates at the ends of the range.
fn power_of_two_to_unity(x: real) -> real {
    let exponent = (bitcast<u32>(x) >> 23u) & 0xffu;
    let mirrored = min(254u - min(exponent, 251u), 251u);
    return select(bitcast<f32>(mirrored << 23u), real(1.0), x == real(0.0));
}

// A nonnegative bound as it is passed between workgroups: not above, and not below the number.
fn from_below(x: real) -> f32 {
    return x;
}

fn from_above(x: real) -> f32 {
    return x;
}
