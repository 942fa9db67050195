// Computes the points of robots of sections of constant curvature. gpu/search/bending.rs derives
// the formulas and their errors; gpu/search/bending_tests.rs has the twin.

@group(0) @binding(0) var<uniform> bending: BendingQuery;
// The place and the quaternion (x, y, z, w) of the base; then for each section of each robot its
// length, and its bend towards x and y in rad.
@group(0) @binding(1) var<storage, read> sections: array<f32>;
// The points of the robots, in the order of the sections.
@group(0) @binding(2) var<storage, read_write> robots: array<f32>;

struct Arc {
    // From its start to its end.
    step: vec3<f32>,
    // The part of its rotation's quaternion across z, and the part without an axis. The part
    // along z is 0.
    turn: vec2<f32>,
    cosine: f32,
}

// A share of a section: an arc in its own frame.
fn arc_of(place: u32, share: f32) -> Arc {
    let length = sections[place] * share;
    let bend = vec2<f32>(sections[place + 1u], sections[place + 2u]) * share;
    let half_squared = 0.25 * (bend.x * bend.x + bend.y * bend.y);
    // Of half the angle.
    let cosine = cosine_of_root(half_squared);
    let sinc = sinc_of_root(half_squared);
    let across = (0.5 * length * sinc * sinc) * bend;
    let turn = (0.5 * sinc) * vec2<f32>(-bend.y, bend.x);
    return Arc(vec3<f32>(across, length * cosine * sinc), turn, cosine);
}

fn rotated(axis: vec3<f32>, w: f32, v: vec3<f32>) -> vec3<f32> {
    let twice = 2.0 * cross(axis, v);
    return v + w * twice + cross(axis, twice);
}

@compute @workgroup_size(BENDING_THREADS)
fn bend(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = (workgroup.y * workgroups.x + workgroup.x) * BENDING_THREADS + lane;
    let points = bending.sections * bending.segments + 1u;
    let robot = number / points;
    if (robot >= bending.robots) {
        return;
    }
    var at = vec3<f32>(sections[0], sections[1], sections[2]);
    var axis = vec3<f32>(sections[3], sections[4], sections[5]);
    var w = sections[6];
    var remaining = number % points;
    for (var section = 0u; remaining > 0u; section++) {
        let steps = min(remaining, bending.segments);
        remaining -= steps;
        let share = f32(steps) / f32(bending.segments);
        let arc = arc_of(BASE_SIZE + 3u * (robot * bending.sections + section), share);
        at += rotated(axis, w, arc.step);
        // The product of the two quaternions.
        let turn = vec3<f32>(arc.turn, 0.0);
        let next = w * turn + arc.cosine * axis + cross(axis, turn);
        w = w * arc.cosine - dot(axis, turn);
        axis = next;
    }
    robots[3u * number] = at.x;
    robots[3u * number + 1u] = at.y;
    robots[3u * number + 2u] = at.z;
}
