// Many problems at once, one thread per problem: `solve` of the text before this one takes the
// indices of the first number of a problem and of its answer.

@group(0) @binding(0) var<uniform> head: Head;
@group(0) @binding(1) var<storage, read> problems: array<real>;
// Each answer begins with the submission's number, so that an unwritten answer is detected.
@group(0) @binding(2) var<storage, read_write> answers: array<real>;

@compute @workgroup_size(THREADS)
fn batch(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let problem = (workgroup.y * workgroups.x + workgroup.x) * THREADS + lane;
    if (head.problems <= problem) {
        return;
    }
    solve(PROBLEM * problem, ANSWER * problem + ANSWER_HEAD);
    answers[ANSWER * problem] = real(head.submission);
}
