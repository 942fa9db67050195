// Quotients and square roots, which the host compares with its own before it trusts a device's double precision.

@group(0) @binding(0) var<storage, read> operands: array<real>;
@group(0) @binding(1) var<storage, read_write> results: array<real>;

@compute @workgroup_size(64)
fn self_test(@builtin(global_invocation_id) thread: vec3<u32>) {
    let pair = 2u * thread.x;
    if (arrayLength(&operands) <= pair) {
        return;
    }
    results[pair] = operands[pair] / operands[pair + 1u];
    results[pair + 1u] = sqrt(operands[pair]);
}
