// One pair of the narrow phase for many problems at once: a thread each.

// Which pair; the order is that of Pair in pairs.rs.
override PAIR: u32 = 0u;

// 24 numbers a problem: triangle, plane normal, start, end, disc normal, radius, which caps are flat.
@group(0) @binding(0) var<storage, read> problems: array<real>;
// 7 numbers an answer: distance and both points.
@group(0) @binding(1) var<storage, read_write> answers: array<real>;

fn problem_point(problem: u32, place: u32) -> vec3<real> {
    let at = 24u * problem + place;
    return vec3<real>(problems[at], problems[at + 1u], problems[at + 2u]);
}

fn answer_of(problem: u32) -> Closest {
    let a = problem_point(problem, 0u);
    let b = problem_point(problem, 3u);
    let c = problem_point(problem, 6u);
    let plane_normal = problem_point(problem, 9u);
    let start = problem_point(problem, 12u);
    let end = problem_point(problem, 15u);
    let disc_normal = problem_point(problem, 18u);
    let radius = problems[24u * problem + 21u];
    let flat_start = real(0.0) < problems[24u * problem + 22u];
    let flat_end = real(0.0) < problems[24u * problem + 23u];
    switch (PAIR) {
        case 0u: {
            return segment_segment(start, end, a, b);
        }
        case 1u: {
            return point_triangle(end, a, b, c);
        }
        case 2u: {
            return segment_triangle(start, end, a, b, c);
        }
        case 3u: {
            return point_disc(a, end, disc_normal, radius);
        }
        case 4u: {
            return segment_disc(a, b, end, disc_normal, radius);
        }
        case 5u: {
            return plane_disc(a, plane_normal, end, disc_normal, radius);
        }
        case 6u: {
            return triangle_disc(a, b, c, end, disc_normal, radius);
        }
        case 7u: {
            return point_modified_cylinder(a, start, end, radius, flat_start, flat_end);
        }
        case 8u: {
            return triangle_capsule(a, b, c, start, end, radius);
        }
        default: {
            return triangle_modified_cylinder(a, b, c, start, end, radius, flat_start, flat_end);
        }
    }
}

@compute @workgroup_size(64)
fn pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let problem = (workgroup.y * workgroups.x + workgroup.x) * 64u + lane;
    if (arrayLength(&problems) <= 24u * problem) {
        return;
    }
    let answer = answer_of(problem);
    let place = 7u * problem;
    answers[place] = answer.distance;
    answers[place + 1u] = answer.point1.x;
    answers[place + 2u] = answer.point1.y;
    answers[place + 3u] = answer.point1.z;
    answers[place + 4u] = answer.point2.x;
    answers[place + 5u] = answer.point2.y;
    answers[place + 6u] = answer.point2.z;
}
