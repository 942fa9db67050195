// What a number is in single precision. The other shaders say `real` and are one text for both precisions.

alias real = f32;

// The largest relative error of one rounding.
const UNIT_ROUNDOFF: real = 0x1p-24f;
// The smallest normal number: what is smaller may be taken for 0, and its inverse may overflow.
const SMALLEST_NORMAL: real = 0x1p-126f;
// How often a foot on a triangle's plane is refined, and how many Halley steps segment-disc takes.
const FACE_PASSES = 2u;
const HALLEY_STEPS = 2u;
// Powers of what is larger may be infinite; and the steps of the iterations that start in single precision.
const LARGEST: real = 0x1p126f;
const ROOT_STEPS = 2u;

// The cube root of the magnitude within 5 %: a start value, never an answer.
fn cbrt_estimate(x: real) -> real {
    return bitcast<f32>(bitcast<u32>(abs(x)) / 3u + 0x2a510554u);
}

// The power of two p with 1 <= x p < 2, or 1 for 0. Saturates at the ends of the range.
fn power_of_two_to_unity(x: real) -> real {
    let exponent = (bitcast<u32>(x) >> 23u) & 0xffu;
    let mirrored = min(254u - min(exponent, 251u), 251u);
    return select(bitcast<f32>(mirrored << 23u), real(1.0), x == real(0.0));
}

// A bound as it is passed between workgroups: not above, and not below the number.
fn from_below(x: real) -> f32 {
    return x;
}

fn from_above(x: real) -> f32 {
    return x;
}
