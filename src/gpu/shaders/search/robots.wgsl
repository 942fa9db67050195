// What a search reads and writes. A part is up to PART links of one robot: a workgroup, a thread a
// link.

struct Part {
    // Where its points and its radii begin in `robots`.
    points: u32,
    radii: u32,
    links: u32,
    // The error of its points.
    more_error: f32,
}

@group(0) @binding(0) var<uniform> query: SearchQuery;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> parts: array<Part>;
// Points; and for each link its radius and its caps.
@group(0) @binding(4) var<storage, read> robots: array<f32>;
// For each part its first entry, and a status or FOUND plus the number of its entries.
@group(0) @binding(5) var<storage, read_write> heads: array<vec2<u32>>;
// Candidates: a link of the part and a triangle.
@group(0) @binding(6) var<storage, read_write> entries: array<vec2<u32>>;
// The number of entries; nodes, leaves and links visited.
@group(0) @binding(7) var<storage, read_write> counters: array<atomic<u32>>;
// For the links of a part that takes a second pass: the bound, and the triangle limit.
@group(0) @binding(8) var<storage, read_write> limits: array<vec2<u32>>;

fn robot_point(place: u32) -> vec3<f32> {
    return vec3<f32>(robots[place], robots[place + 1u], robots[place + 2u]);
}

fn robot_link(part: Part, link: u32) -> SearchedLink {
    let place = part.points + 3u * link;
    let radius = part.radii + 2u * link;
    let start = robot_point(place);
    let end = robot_point(place + 3u);
    var searched = link_new(start, end, robots[radius], robots[radius + 1u]);
    searched.error += part.more_error;
    return searched;
}

// The limit on the squared distance of a box from the axis.
fn box_limit(link: SearchedLink, bound: f32) -> f32 {
    let limit = bound + link.radius + link.error;
    return limit * limit;
}

// Whether loops still run to their ends. A driver may stop them: once all loops of a thread together
// have taken 65,535 rounds, Mesa's llvmpipe leaves each loop after one round. This loop has two, and
// its count is not known to the compiler.
fn loops_run() -> bool {
    var rounds = 0u;
    for (var k = 0u; k < 2u * min(query.parts, 1u); k++) {
        rounds++;
    }
    return rounds == 2u;
}
