// The first pass: the candidates of every link, nearest boxes first. The twin of Twin::search in
// gpu/search/twin.rs; gpu/search/batch.rs proves that no answer is lost.

var<workgroup> part_bound: atomic<u32>;
var<workgroup> part_below: atomic<u32>;
var<workgroup> part_hit: atomic<u32>;
var<workgroup> part_lost: atomic<u32>;
var<workgroup> part_count: atomic<u32>;
var<workgroup> part_first: u32;

var<private> own_bound: f32;
var<private> own_below: u32;
var<private> candidates: array<u32, ROOM>;
var<private> lowers: array<f32, ROOM>;
var<private> count: u32;
// The least lower bound of a candidate that found no room.
var<private> lost: f32;
var<private> stack: array<vec2<u32>, DEPTH>;

// An upper bound on the distance: of the link, of the robot, or the margin.
fn bound() -> f32 {
    if (QUESTION == MINIMUM) {
        return bitcast<f32>(atomicLoad(&part_bound));
    }
    return own_bound;
}

// The lowest triangle that certainly touches; higher ones are not wanted.
fn below() -> u32 {
    if (QUESTION == MINIMUM) {
        return atomicLoad(&part_below);
    }
    return own_below;
}

fn drop_far_candidates(limit: f32, lowest: u32) {
    var kept = 0u;
    for (var i = 0u; i < count; i++) {
        if (lowers[i] <= limit && candidates[i] <= lowest) {
            candidates[kept] = candidates[i];
            lowers[kept] = lowers[i];
            kept++;
        }
    }
    count = kept;
}

fn keep(triangle: u32, lower: f32, limit: f32) {
    if (count == ROOM) {
        drop_far_candidates(limit, below());
    }
    if (count < ROOM) {
        candidates[count] = triangle;
        lowers[count] = lower;
        count++;
        return;
    }
    var worst = 0u;
    for (var i = 1u; i < ROOM; i++) {
        if (lowers[worst] < lowers[i]) {
            worst = i;
        }
    }
    if (lower < lowers[worst]) {
        lost = min(lost, lowers[worst]);
        candidates[worst] = triangle;
        lowers[worst] = lower;
    } else {
        lost = min(lost, lower);
    }
}

fn visit_leaf(link: SearchedLink, leaf: u32) {
    let first = leaf_first(leaf);
    for (var k = 0u; k < leaf_count(leaf); k++) {
        let triangle = triangles[first + k];
        let bounds = triangle_bounds(link, triangle.a, triangle.b, triangle.c);
        if (bounds.lower > bound() + link.error || triangle.number > below()) {
            continue;
        }
        let certain = bounds.upper + link.error;
        if (QUESTION == CLEARS) {
            if (certain <= bitcast<f32>(query.certain)) {
                atomicStore(&part_hit, 1u);
                return;
            }
        } else if (QUESTION == MINIMUM) {
            if (certain < bound()) {
                atomicMin(&part_bound, bitcast<u32>(max(certain, 0.0)));
            }
            if (certain < 0.0) {
                atomicMin(&part_below, triangle.number);
            }
        } else {
            own_bound = min(own_bound, max(certain, 0.0));
            if (certain < 0.0) {
                own_below = min(own_below, triangle.number);
            }
        }
        keep(triangle.number, bounds.lower, bound() + link.error);
    }
}

fn search_link(link: SearchedLink) {
    var waiting = 0u;
    var place = 0u;
    var visited = 0u;
    var leaves = 0u;
    loop {
        var next = NOTHING;
        if (is_leaf(place)) {
            leaves++;
            visit_leaf(link, place);
            if (QUESTION == CLEARS && atomicLoad(&part_hit) != 0u) {
                break;
            }
        } else {
            visited++;
            let node = nodes[place];
            let limit = box_limit(link, bound());
            let lowest = below();
            let d0 = box_distance_squared(link, node.low0, node.high0);
            let d1 = box_distance_squared(link, node.low1, node.high1);
            let near0 = d0 <= limit && node.lowest0 <= lowest;
            let near1 = d1 <= limit && node.lowest1 <= lowest;
            let first0 = near0 && (!near1 || d0 <= d1);
            next = select(select(NOTHING, node.child1, near1), node.child0, first0);
            if (near0 && near1) {
                stack[waiting] = select(
                    vec2<u32>(node.child0, bitcast<u32>(d0)),
                    vec2<u32>(node.child1, bitcast<u32>(d1)),
                    first0,
                );
                waiting++;
            }
        }
        while (next == NOTHING && waiting > 0u) {
            waiting--;
            if (bitcast<f32>(stack[waiting].y) <= box_limit(link, bound())) {
                next = stack[waiting].x;
            }
        }
        if (next == NOTHING) {
            break;
        }
        place = next;
    }
    if (COUNTS_WORK) {
        atomicAdd(&counters[1], visited);
        atomicAdd(&counters[2], leaves);
        atomicAdd(&counters[3], 1u);
    }
}

@compute @workgroup_size(PART)
fn search(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = workgroup.y * workgroups.x + workgroup.x;
    if (lane == 0u) {
        atomicStore(&part_bound, bitcast<u32>(FAR));
        atomicStore(&part_below, NOTHING);
        atomicStore(&part_hit, 0u);
        atomicStore(&part_lost, 0u);
        atomicStore(&part_count, 0u);
    }
    workgroupBarrier();
    count = 0u;
    lost = FAR;
    own_bound = select(FAR, bitcast<f32>(query.margin), QUESTION == CLEARS);
    own_below = NOTHING;
    var error = 0.0;
    var is_link = false;
    if (number < query.parts) {
        let part = parts[number];
        is_link = lane < part.links;
        if (is_link) {
            let link = robot_link(part, lane);
            error = link.error;
            search_link(link);
        }
    }
    workgroupBarrier();
    var own_first = 0u;
    if (is_link) {
        let limit = bound() + error;
        drop_far_candidates(limit, below());
        if (lost <= limit) {
            atomicStore(&part_lost, 1u);
        }
        own_first = atomicAdd(&part_count, count);
        limits[number * PART + lane] = vec2<u32>(bitcast<u32>(bound()), below());
    }
    workgroupBarrier();
    if (lane == 0u && number < query.parts) {
        part_first = NOTHING;
        let total = atomicLoad(&part_count);
        if (atomicLoad(&part_hit) != 0u) {
            heads[number] = vec2<u32>(0u, HIT);
        } else if (atomicLoad(&part_lost) != 0u) {
            heads[number] = vec2<u32>(0u, SECOND);
        } else {
            let first = atomicAdd(&counters[0], total);
            if (first + total <= query.room) {
                part_first = first;
                heads[number] = vec2<u32>(first, FOUND + total);
            } else {
                heads[number] = vec2<u32>(0u, FULL);
            }
        }
    }
    workgroupBarrier();
    storageBarrier();
    if (is_link && part_first != NOTHING) {
        for (var i = 0u; i < count; i++) {
            entries[part_first + own_first + i] = vec2<u32>(lane, candidates[i]);
        }
    }
    if (is_link && !loops_run()) {
        heads[number] = vec2<u32>(0u, STOPPED);
    }
}
