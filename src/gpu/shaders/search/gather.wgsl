// Gathers all candidates of a link within a bound. The second pass of a search: for the parts with
// more candidates than room, within the bounds that the first pass has found. The only pass of
// WITHIN: for all parts, within the margin. The twin of TwinTree::gather in gpu/search/twin.rs.
//
// Each link is visited twice: to count its candidates, and to write them. A compiler may fuse the
// two visits differently, so that their counts differ. Both find all wanted triangles (claim of
// gpu/search/batch.rs). So the second visit writes at most what the first has counted, and a part
// whose counts differ is FULL: the CPU searches for it.

var<workgroup> part_count: atomic<u32>;
var<workgroup> part_full: atomic<u32>;
var<workgroup> part_first: u32;

var<private> stack: array<u32, DEPTH>;

// Whether the candidates of a part are to be gathered.
fn is_asked(number: u32) -> bool {
    return number < query.parts && (QUESTION == WITHIN || heads[number].y == SECOND);
}

// The bound of a link, and its lowest triangle that certainly touches.
fn limit_of(number: u32, lane: u32) -> vec2<u32> {
    if (QUESTION == WITHIN) {
        return vec2<u32>(query.margin, NOTHING);
    }
    return limits[number * PART + lane];
}

// Visits the candidates of a link and counts them. Writes the first `room` of them, from `first`
// on.
fn gather_link(
    link: SearchedLink,
    lane: u32,
    bound: f32,
    below: u32,
    first: u32,
    room: u32,
) -> u32 {
    let limit = box_limit(link, bound);
    var waiting = 1u;
    stack[0] = 0u;
    var found = 0u;
    while (waiting > 0u && found <= MOST_GATHERED) {
        waiting--;
        let place = stack[waiting];
        if (is_leaf(place)) {
            for (var k = 0u; k < leaf_count(place); k++) {
                let triangle = triangles[leaf_first(place) + k];
                let bounds = triangle_bounds(link, triangle.a, triangle.b, triangle.c);
                if (bounds.lower <= bound + link.error && triangle.number <= below) {
                    if (found < room) {
                        entries[first + found] = vec2<u32>(lane, triangle.number);
                    }
                    found++;
                }
            }
            continue;
        }
        let node = nodes[place];
        if (node.lowest0 <= below && box_distance_squared(link, node.low0, node.high0) <= limit) {
            stack[waiting] = node.child0;
            waiting++;
        }
        if (node.lowest1 <= below && box_distance_squared(link, node.low1, node.high1) <= limit) {
            stack[waiting] = node.child1;
            waiting++;
        }
    }
    return found;
}

@compute @workgroup_size(PART)
fn gather(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = workgroup.y * workgroups.x + workgroup.x;
    if (lane == 0u) {
        atomicStore(&part_count, 0u);
        atomicStore(&part_full, 0u);
        part_first = NOTHING;
    }
    workgroupBarrier();
    var is_link = false;
    var own_first = 0u;
    var own_count = 0u;
    if (is_asked(number)) {
        let part = parts[number];
        is_link = lane < part.links;
        if (is_link) {
            let limit = limit_of(number, lane);
            let bound = bitcast<f32>(limit.x);
            own_count = gather_link(robot_link(part, lane), lane, bound, limit.y, 0u, 0u);
            own_first = atomicAdd(&part_count, own_count);
            if (own_count > MOST_GATHERED) {
                atomicStore(&part_full, 1u);
            }
        }
    }
    workgroupBarrier();
    if (lane == 0u && is_asked(number)) {
        let total = atomicLoad(&part_count);
        heads[number] = vec2<u32>(0u, FULL);
        if (atomicLoad(&part_full) == 0u) {
            let first = atomicAdd(&counters[0], total);
            if (first + total <= query.room) {
                part_first = first;
                heads[number] = vec2<u32>(first, FOUND + total);
            }
        }
    }
    workgroupBarrier();
    storageBarrier();
    if (is_link && part_first != NOTHING) {
        let limit = limit_of(number, lane);
        let bound = bitcast<f32>(limit.x);
        let link = robot_link(parts[number], lane);
        let first = part_first + own_first;
        if (gather_link(link, lane, bound, limit.y, first, own_count) != own_count) {
            atomicStore(&part_full, 1u);
        }
    }
    workgroupBarrier();
    if (lane == 0u && part_first != NOTHING && atomicLoad(&part_full) != 0u) {
        heads[number] = vec2<u32>(0u, FULL);
    }
    storageBarrier();
    if (is_link && !loops_run()) {
        heads[number] = vec2<u32>(0u, STOPPED);
    }
}
