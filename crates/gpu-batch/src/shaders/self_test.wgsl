// The quotient of two numbers and the square root of the first. The host compares them with its own
// before it accepts a device's double precision.

fn solve(problem: u32, answer: u32) {
    answers[answer] = problems[problem] / problems[problem + 1u];
    answers[answer + 1u] = sqrt(problems[problem]);
}
