// One problem of a pair of the narrow phase: every pair uses a part of it.

struct PairProblem {
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    plane_normal: vec3<real>,
    start: vec3<real>,
    end: vec3<real>,
    disc_normal: vec3<real>,
    radius: real,
    flat_start: bool,
    flat_end: bool,
}

fn load_point(place: u32) -> vec3<real> {
    return vec3<real>(problems[place], problems[place + 1u], problems[place + 2u]);
}

fn load_problem(problem: u32) -> PairProblem {
    return PairProblem(
        load_point(problem),
        load_point(problem + 3u),
        load_point(problem + 6u),
        load_point(problem + 9u),
        load_point(problem + 12u),
        load_point(problem + 15u),
        load_point(problem + 18u),
        problems[problem + 21u],
        real(0.0) < problems[problem + 22u],
        real(0.0) < problems[problem + 23u],
    );
}

fn store_closest(answer: u32, found: Closest) {
    answers[answer] = found.distance;
    answers[answer + 1u] = found.point1.x;
    answers[answer + 2u] = found.point1.y;
    answers[answer + 3u] = found.point1.z;
    answers[answer + 4u] = found.point2.x;
    answers[answer + 5u] = found.point2.y;
    answers[answer + 6u] = found.point2.z;
}
