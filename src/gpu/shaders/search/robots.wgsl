// What a search reads and writes. A link group is up to GROUP_SIZE links of one robot. A workgroup
// searches a link group, with a thread for each link.

struct LinkGroup {
    // The indices in `robots` at which its points and its radii begin.
    points: u32,
    radii: u32,
    links: u32,
    // A bound on the error of its points, beside the rounding of uploaded points.
    more_error: f32,
}

@group(0) @binding(0) var<uniform> query: SearchQuery;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> groups: array<LinkGroup>;
// The points of all robots; then for each link its radius and its caps.
@group(0) @binding(4) var<storage, read> robots: array<f32>;
// For each link group the index of its first entry, and a status or FOUND plus the number of its
// entries.
@group(0) @binding(5) var<storage, read_write> heads: array<vec2<u32>>;
// Candidates: the lane of a link in its group, and a triangle.
@group(0) @binding(6) var<storage, read_write> entries: array<vec2<u32>>;
// The number of entries that all link groups have; and the nodes, leaves and links visited.
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>>;
// For each link the bound of the first pass, and the highest wanted triangle. The second pass reads
// them.
@group(0) @binding(8) var<storage, read_write> wanted: array<vec2<u32>>;

fn robot_point(index: u32) -> vec3<f32> {
    return vec3<f32>(robots[index], robots[index + 1u], robots[index + 2u]);
}

fn robot_link(group: LinkGroup, lane: u32) -> SearchedLink {
    let point = group.points + 3u * lane;
    let radius = group.radii + 2u * lane;
    let start = robot_point(point);
    let end = robot_point(point + 3u);
    var searched = link_new(start, end, robots[radius], robots[radius + 1u]);
    searched.error += group.more_error;
    return searched;
}

// The limit on the squared distance of a box from the axis: a farther box holds no triangle within
// `bound` of the link (claim 1 of gpu/search/bounds.rs).
fn box_limit(link: SearchedLink, bound: f32) -> f32 {
    let limit = bound + link.radius + link.error;
    return limit * limit;
}

// Whether a triangle with this lower bound is wanted. D, T and e of gpu/search/batch.rs are
// `bound`, `highest` and `error`.
fn is_wanted(lower: f32, triangle: u32, bound: f32, highest: u32, error: f32) -> bool {
    return lower <= bound + error && triangle <= highest;
}

// Whether loops still run to their ends. A driver may stop them: once all loops of a thread
// together have taken 65,535 rounds, Mesa's llvmpipe leaves each loop after one round. This loop
// has two, and its count is not known to the compiler.
fn loops_run() -> bool {
    var rounds = 0u;
    for (var k = 0u; k < 2u * min(query.groups, 1u); k++) {
        rounds++;
    }
    return rounds == 2u;
}
