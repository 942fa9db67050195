// Fits the boxes of the nodes of one level; the levels below are fitted. The twin of
// TwinTree::refit in gpu/search/twin.rs.

@group(0) @binding(0) var<uniform> level: RefitLevel;
@group(0) @binding(1) var<storage, read> order: array<u32>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read_write> nodes: array<Node>;

struct Box {
    low: vec3<f32>,
    high: vec3<f32>,
}

fn box_of(child: u32) -> Box {
    if (!is_leaf(child)) {
        let node = nodes[child];
        return Box(min(node.low0, node.low1), max(node.high0, node.high1));
    }
    let first = leaf_first(child);
    var all = Box(vec3<f32>(FAR), vec3<f32>(-FAR));
    for (var k = 0u; k < leaf_count(child); k++) {
        let triangle = triangles[first + k];
        all.low = min(all.low, min(triangle.a, min(triangle.b, triangle.c)));
        all.high = max(all.high, max(triangle.a, max(triangle.b, triangle.c)));
    }
    return all;
}

@compute @workgroup_size(REFIT_THREADS)
fn refit(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = (workgroup.y * workgroups.x + workgroup.x) * REFIT_THREADS + lane;
    if (level.nodes <= place) {
        return;
    }
    let number = order[level.first + place];
    let box0 = box_of(nodes[number].child0);
    let box1 = box_of(nodes[number].child1);
    nodes[number].low0 = box0.low;
    nodes[number].high0 = box0.high;
    nodes[number].low1 = box1.low;
    nodes[number].high1 = box1.high;
}
