// The roots of many polynomials, one thread each: the twin of `approximations` in lib.rs.
// `approximate` of one method is declared beside this text.

// An answer is the number of roots, then their real and imaginary parts.
fn solve(problem: u32, answer: u32) {
    var coefficients = Coefficients();
    for (var k = 0u; k < COEFFICIENTS; k++) {
        coefficients[k] = problems[problem + k];
    }
    root_count = 0u;
    approximations(&coefficients);
    answers[answer] = real(root_count);
    for (var i = 0u; i < COEFFICIENTS - 1u; i++) {
        answers[answer + 1u + 2u * i] = root_re[i];
        answers[answer + 2u + 2u * i] = root_im[i];
    }
}

fn approximations(coefficients: ptr<function, Coefficients>) {
    var high = COEFFICIENTS - 1u;
    while (0u < high && (*coefficients)[high] == real(0.0)) {
        high--;
    }
    var low = 0u;
    while (low < high && (*coefficients)[low] == real(0.0)) {
        push_root(real(0.0), real(0.0));
        low++;
    }
    let degree = high - low;
    if (degree == 0u) {
        return;
    }
    var monic = Coefficients();
    let leading = (*coefficients)[high];
    for (var k = 0u; k < degree; k++) {
        monic[k] = (*coefficients)[low + k] / leading;
    }
    monic[degree] = real(1.0);
    approximate(&monic, degree);
}
