// What a number is in double precision. The other shaders say `real` and are one text for both precisions.

alias real = f64;

// The largest relative error of one rounding.
const UNIT_ROUNDOFF: real = 0x1p-53lf;
// The smallest normal number: what is smaller may be taken for 0, and its inverse may overflow.
const SMALLEST_NORMAL: real = 0x1p-1022lf;
// How often a foot on a triangle's plane is refined, and how many Halley steps segment-disc takes.
const FACE_PASSES = 3u;
const HALLEY_STEPS = 3u;
// Powers of what is larger may be infinite; and the steps of the iterations that start in single precision.
const LARGEST: real = 0x1p1022lf;
const ROOT_STEPS = 3u;

// The cube root of the magnitude within 5 %: a start value, never an answer. There are no bits of an f64 here, so
// it is taken in single precision; numbers beyond that range do not occur near one.
fn cbrt_estimate(x: real) -> real {
    let inside = f32(clamp(abs(x), real(0x1p-120lf), real(0x1p120lf)));
    return real(bitcast<f32>(bitcast<u32>(inside) / 3u + 0x2a510554u));
}

// A power of two p that brings the square of x p into range. Coordinates are near one, so that only what is very
// small needs one.
fn power_of_two_to_unity(x: real) -> real {
    return select(real(1.0), real(0x1p500lf), abs(x) < real(0x1p-400lf));
}

// A bound as it is passed between workgroups, in single precision: not above, and not below the number.
fn from_below(x: real) -> f32 {
    return f32(x * (real(1.0) - real(0x1p-22lf)));
}

fn from_above(x: real) -> f32 {
    return f32(x * (real(1.0) + real(0x1p-22lf)));
}
