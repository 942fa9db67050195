// Shared by the root finders: the output, quadratics, and powers of two. The twins are found.rs,
// quadratic.rs and real.rs.
//
// COEFFICIENTS, one more than the degree, LARGEST and ROOT_STEPS are declared beside this text.
// Coefficients are lowest power first and of comparable size: polynomials are not cut into pieces
// here.

// There is always room for a quartic.
const ROOM = max(COEFFICIENTS, 5u);
alias Coefficients = array<real, ROOM>;

var<private> root_re: Coefficients;
var<private> root_im: Coefficients;
var<private> root_count: u32;

fn push_root(re: real, im: real) {
    if (root_count < ROOM) {
        root_re[root_count] = re;
        root_im[root_count] = im;
        root_count++;
    }
}

fn push_pair(re: real, im: real) {
    push_root(re, abs(im));
    push_root(re, -abs(im));
}

// Whether the number is finite. False for NaN on devices that produce NaN.
fn is_finite(x: real) -> bool {
    return abs(x) <= LARGEST;
}

// The e with 2^e <= |x| < 2^(e+1), up to the rounding to single precision.
fn exponent(x: real) -> i32 {
    return i32((bitcast<u32>(clamp(f32(abs(x)), 0x1p-120f, 0x1p120f)) >> 23u) & 0xffu) - 127;
}

fn times_power_of_two(x: real, power: i32) -> real {
    return x * real(bitcast<f32>(u32(clamp(power, -126, 127) + 127) << 23u));
}

// The cube root of a nonnegative number: Halley's method triples the digits of the estimate.
fn cbrt(x: real) -> real {
    var root = cbrt_estimate(x);
    for (var i = 0u; i < ROOT_STEPS; i++) {
        let cube = root * root * root;
        root = root * over(cube + x + x, cube + cube + x);
    }
    return select(real(0.0), root, real(0.0) < x);
}

// The cosine of a third of the angle with this cosine. Newton's method on 4 y^3 - 3 y = cosine
// refines a start in single precision.
fn cos_of_third(cosine: real) -> real {
    var y = real(cos(acos(f32(cosine)) / 3.0f));
    for (var i = 0u; i < ROOT_STEPS; i++) {
        y -= over((real(4.0) * y * y - real(3.0)) * y - cosine, real(12.0) * y * y - real(3.0));
    }
    return y;
}

// Two real roots, the larger in magnitude first; or the real part and the positive imaginary part.
struct QuadraticPair {
    is_real: bool,
    first: real,
    second: real,
}

// The roots of x^2 + u x + v.
fn quadratic_split(u: real, v: real) -> QuadraticPair {
    let half = u * real(0.5);
    let discriminant = half * half - v;
    if (discriminant < real(0.0)) {
        return QuadraticPair(false, -half, sqrt(-discriminant));
    }
    let root = sqrt(discriminant);
    let q = select(root - half, -(half + root), real(0.0) <= half);
    return QuadraticPair(true, q, select(v / select(q, real(1.0), q == real(0.0)), real(0.0), q == real(0.0)));
}

fn quadratic(u: real, v: real) {
    let pair = quadratic_split(u, v);
    if (pair.is_real) {
        push_root(pair.second, real(0.0));
        push_root(pair.first, real(0.0));
    } else {
        push_pair(pair.first, pair.second);
    }
}
