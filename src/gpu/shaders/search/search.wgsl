// The first pass: the candidates of every link, nearest boxes first. The twin of TwinTree::search
// in gpu/search/twin.rs. gpu/search/batch.rs defines D, T and wanted triangles, and proves that no
// answer is lost.

var<workgroup> group_bound: atomic<u32>;
var<workgroup> group_highest_wanted: atomic<u32>;
var<workgroup> group_hit: atomic<u32>;
var<workgroup> group_overflows: atomic<u32>;
var<workgroup> group_count: atomic<u32>;
var<workgroup> group_first: u32;

var<private> own_bound: f32;
var<private> own_highest_wanted: u32;
var<private> candidates: array<u32, SLOTS>;
var<private> lowers: array<f32, SLOTS>;
var<private> count: u32;
// The least lower bound of a candidate that found no slot.
var<private> least_overflow: f32;
var<private> stack: array<vec2<u32>, DEPTH>;

// D: an upper bound on the distance of the link or of the link group, or the margin.
fn bound() -> f32 {
    if (QUESTION == MINIMUM) {
        return bitcast<f32>(atomicLoad(&group_bound));
    }
    return own_bound;
}

// T: the lowest triangle that certainly touches. Higher ones are not wanted.
fn highest_wanted() -> u32 {
    if (QUESTION == MINIMUM) {
        return atomicLoad(&group_highest_wanted);
    }
    return own_highest_wanted;
}

fn drop_unwanted_candidates(error: f32) {
    let bound = bound();
    let highest = highest_wanted();
    var kept = 0u;
    for (var i = 0u; i < count; i++) {
        if (is_wanted(lowers[i], candidates[i], bound, highest, error)) {
            candidates[kept] = candidates[i];
            lowers[kept] = lowers[i];
            kept++;
        }
    }
    count = kept;
}

// Keeps a wanted triangle if a slot is free, or else the nearer ones by their lower bounds.
fn add_candidate(triangle: u32, lower: f32, error: f32) {
    if (count == SLOTS) {
        drop_unwanted_candidates(error);
    }
    if (count < SLOTS) {
        candidates[count] = triangle;
        lowers[count] = lower;
        count++;
        return;
    }
    var worst = 0u;
    for (var i = 1u; i < SLOTS; i++) {
        if (lowers[worst] < lowers[i]) {
            worst = i;
        }
    }
    if (lower < lowers[worst]) {
        least_overflow = min(least_overflow, lowers[worst]);
        candidates[worst] = triangle;
        lowers[worst] = lower;
    } else {
        least_overflow = min(least_overflow, lower);
    }
}

fn visit_leaf(link: SearchedLink, leaf: u32) {
    let first = leaf_first(leaf);
    for (var k = 0u; k < leaf_count(leaf); k++) {
        let triangle = triangles[first + k];
        let bounds = triangle_bounds(link, triangle.a, triangle.b, triangle.c);
        if (!is_wanted(bounds.lower, triangle.number, bound(), highest_wanted(), link.error)) {
            continue;
        }
        // The triangle is at most this far from the link; if negative, it certainly touches.
        let at_most = bounds.upper + link.error;
        if (QUESTION == CLEARS) {
            if (at_most <= bitcast<f32>(query.margin_down)) {
                atomicStore(&group_hit, 1u);
                return;
            }
        } else if (QUESTION == MINIMUM) {
            if (at_most < bound()) {
                atomicMin(&group_bound, bitcast<u32>(max(at_most, 0.0)));
            }
            if (at_most < 0.0) {
                atomicMin(&group_highest_wanted, triangle.number);
            }
        } else {
            own_bound = min(own_bound, max(at_most, 0.0));
            if (at_most < 0.0) {
                own_highest_wanted = min(own_highest_wanted, triangle.number);
            }
        }
        add_candidate(triangle.number, bounds.lower, link.error);
    }
}

fn search_link(link: SearchedLink) {
    var waiting = 0u;
    // The node or leaf to visit; 0 is the root.
    var child = 0u;
    var visited = 0u;
    var leaves = 0u;
    loop {
        var next = NOTHING;
        if (is_leaf(child)) {
            leaves++;
            visit_leaf(link, child);
            if (QUESTION == CLEARS && atomicLoad(&group_hit) != 0u) {
                break;
            }
        } else {
            visited++;
            let node = nodes[child];
            let limit = box_limit(link, bound());
            let highest = highest_wanted();
            let d0 = box_distance_squared(link, node.low0, node.high0);
            let d1 = box_distance_squared(link, node.low1, node.high1);
            let visits0 = d0 <= limit && node.lowest0 <= highest;
            let visits1 = d1 <= limit && node.lowest1 <= highest;
            let first0 = visits0 && (!visits1 || d0 <= d1);
            next = select(select(NOTHING, node.child1, visits1), node.child0, first0);
            if (visits0 && visits1) {
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
        child = next;
    }
    if (COUNTS_WORK) {
        atomicAdd(&counters[1], visited);
        atomicAdd(&counters[2], leaves);
        atomicAdd(&counters[3], 1u);
    }
}

@compute @workgroup_size(GROUP_SIZE)
fn search(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = workgroup.y * workgroups.x + workgroup.x;
    if (lane == 0u) {
        atomicStore(&group_bound, bitcast<u32>(FAR));
        atomicStore(&group_highest_wanted, NOTHING);
        atomicStore(&group_hit, 0u);
        atomicStore(&group_overflows, 0u);
        atomicStore(&group_count, 0u);
    }
    workgroupBarrier();
    count = 0u;
    least_overflow = FAR;
    // FAR without a margin.
    own_bound = bitcast<f32>(query.margin_up);
    own_highest_wanted = NOTHING;
    var error = 0.0;
    var is_link = false;
    if (number < query.groups) {
        let group = groups[number];
        is_link = lane < group.links;
        if (is_link) {
            let link = robot_link(group, lane);
            error = link.error;
            search_link(link);
        }
    }
    workgroupBarrier();
    var own_first = 0u;
    if (is_link) {
        drop_unwanted_candidates(error);
        // Any triangle, also the lowest, may have found no slot.
        if (is_wanted(least_overflow, 0u, bound(), highest_wanted(), error)) {
            atomicStore(&group_overflows, 1u);
        }
        own_first = atomicAdd(&group_count, count);
        wanted[number * GROUP_SIZE + lane] = vec2<u32>(bitcast<u32>(bound()), highest_wanted());
    }
    workgroupBarrier();
    if (lane == 0u && number < query.groups) {
        group_first = NOTHING;
        let total = atomicLoad(&group_count);
        if (atomicLoad(&group_hit) != 0u) {
            heads[number] = vec2<u32>(0u, HIT);
        } else if (atomicLoad(&group_overflows) != 0u) {
            heads[number] = vec2<u32>(0u, SECOND);
        } else {
            let first = atomicAdd(&counters[0], total);
            if (first + total <= query.capacity) {
                group_first = first;
                heads[number] = vec2<u32>(first, FOUND + total);
            } else {
                heads[number] = vec2<u32>(0u, FULL);
            }
        }
    }
    workgroupBarrier();
    storageBarrier();
    if (is_link && group_first != NOTHING) {
        for (var i = 0u; i < count; i++) {
            entries[group_first + own_first + i] = vec2<u32>(lane, candidates[i]);
        }
    }
    if (is_link && !loops_run()) {
        heads[number] = vec2<u32>(0u, STOPPED);
    }
}
