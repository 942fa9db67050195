// Gathers all candidates of a link within a bound. The second pass of a search: for the link groups
// in which a candidate found no slot, within the bounds of the first pass. The only pass of WITHIN:
// for all link groups, within the margin. The twin of TwinTree::gather in gpu/search/twin.rs.
//
// Each link is visited twice: to count its candidates, and to write them. A compiler may fuse the
// two visits differently, so that their counts differ. Both find all wanted triangles (claim of
// gpu/search/batch.rs). So the second visit writes at most what the first has counted, and a
// link group whose counts differ is FULL: the CPU searches for the robot.

var<workgroup> group_count: atomic<u32>;
var<workgroup> group_full: atomic<u32>;
var<workgroup> group_first: u32;

var<private> stack: array<u32, DEPTH>;

// Whether the candidates of a link group are to be gathered.
fn is_gathered(number: u32) -> bool {
    return number < query.groups && (QUESTION == WITHIN || heads[number].y == SECOND);
}

// D and T of a link: the bound, and the highest wanted triangle.
fn wanted_of(number: u32, lane: u32) -> vec2<u32> {
    if (QUESTION == WITHIN) {
        return vec2<u32>(query.margin_up, NOTHING);
    }
    return wanted[number * GROUP_SIZE + lane];
}

// Visits the candidates of a link and returns their number. Writes the first `slots` of them to
// `entries`, from the index `first` on.
fn gather_link(
    link: SearchedLink,
    lane: u32,
    bound: f32,
    highest: u32,
    first: u32,
    slots: u32,
) -> u32 {
    let limit = box_limit(link, bound);
    var waiting = 1u;
    stack[0] = 0u;
    var found = 0u;
    while (waiting > 0u && found <= MOST_GATHERED) {
        waiting--;
        let child = stack[waiting];
        if (is_leaf(child)) {
            for (var k = 0u; k < leaf_count(child); k++) {
                let triangle = triangles[leaf_first(child) + k];
                let bounds = triangle_bounds(link, triangle.a, triangle.b, triangle.c);
                if (is_wanted(bounds.lower, triangle.number, bound, highest, link.error)) {
                    if (found < slots) {
                        entries[first + found] = vec2<u32>(lane, triangle.number);
                    }
                    found++;
                }
            }
            continue;
        }
        let node = nodes[child];
        if (node.lowest0 <= highest && box_distance_squared(link, node.low0, node.high0) <= limit) {
            stack[waiting] = node.child0;
            waiting++;
        }
        if (node.lowest1 <= highest && box_distance_squared(link, node.low1, node.high1) <= limit) {
            stack[waiting] = node.child1;
            waiting++;
        }
    }
    return found;
}

@compute @workgroup_size(GROUP_SIZE)
fn gather(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let number = workgroup.y * workgroups.x + workgroup.x;
    if (lane == 0u) {
        atomicStore(&group_count, 0u);
        atomicStore(&group_full, 0u);
        group_first = NOTHING;
    }
    workgroupBarrier();
    var is_link = false;
    var link: SearchedLink;
    var bound = 0.0;
    var highest = 0u;
    var own_first = 0u;
    var own_count = 0u;
    if (is_gathered(number)) {
        let group = groups[number];
        is_link = lane < group.links;
        if (is_link) {
            let found = wanted_of(number, lane);
            link = robot_link(group, lane);
            bound = bitcast<f32>(found.x);
            highest = found.y;
            own_count = gather_link(link, lane, bound, highest, 0u, 0u);
            own_first = atomicAdd(&group_count, own_count);
            if (own_count > MOST_GATHERED) {
                atomicStore(&group_full, 1u);
            }
        }
    }
    workgroupBarrier();
    if (lane == 0u && is_gathered(number)) {
        let total = atomicLoad(&group_count);
        heads[number] = vec2<u32>(0u, FULL);
        if (atomicLoad(&group_full) == 0u) {
            let first = atomicAdd(&counters[0], total);
            if (first + total <= query.capacity) {
                group_first = first;
                heads[number] = vec2<u32>(first, FOUND + total);
            }
        }
    }
    workgroupBarrier();
    storageBarrier();
    if (is_link && group_first != NOTHING) {
        let first = group_first + own_first;
        if (gather_link(link, lane, bound, highest, first, own_count) != own_count) {
            atomicStore(&group_full, 1u);
        }
    }
    workgroupBarrier();
    if (lane == 0u && group_first != NOTHING && atomicLoad(&group_full) != 0u) {
        heads[number] = vec2<u32>(0u, FULL);
    }
    storageBarrier();
    if (is_link && !loops_run()) {
        heads[number] = vec2<u32>(0u, STOPPED);
    }
}
