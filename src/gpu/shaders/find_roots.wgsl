// The roots of many polynomials, a thread each: the twin of `approximations` in roots/mod.rs. `approximate` is that of
// one method, declared before this text.

@group(0) @binding(0) var<storage, read> polynomials: array<real>;
// How many roots were found, then their real and imaginary parts.
@group(0) @binding(1) var<storage, read_write> answers: array<real>;

@compute @workgroup_size(64)
fn find_roots(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let polynomial = (workgroup.y * workgroups.x + workgroup.x) * 64u + lane;
    if (arrayLength(&polynomials) <= COEFFICIENTS * polynomial) {
        return;
    }
    var coefficients = Coefficients();
    for (var k = 0u; k < COEFFICIENTS; k++) {
        coefficients[k] = polynomials[COEFFICIENTS * polynomial + k];
    }
    root_count = 0u;
    approximations(&coefficients);
    let record = 2u * COEFFICIENTS - 1u;
    let place = record * polynomial;
    answers[place] = real(root_count);
    for (var i = 0u; i < COEFFICIENTS - 1u; i++) {
        answers[place + 1u + 2u * i] = root_re[i];
        answers[place + 2u + 2u * i] = root_im[i];
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
