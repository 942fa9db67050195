// Step 2 of a query: every triangle against every link, with the least bounds of each block of
// triangles and each link. The twin of Job::scan in search/exhaustive/scan.rs.
//
// The first pass of two computes bounds. With culling, a triangle whose sphere meets the limit
// costs the distance from the axis and the bounds of the cap. Without culling, every pair costs its
// full distance.

override CULLING: bool = true;

// The limits of the workgroup's links, and their least bounds.
var<workgroup> own_limits: array<f32, MOST_LINKS>;
var<workgroup> least_lower: array<atomic<u32>, MOST_LINKS>;
var<workgroup> least_upper: array<atomic<u32>, MOST_LINKS>;

@compute @workgroup_size(THREADS)
fn nearest(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = workgroup.y * round.links_at_once;
    let count = min(round.links_at_once, round.links - first);
    if (lane < count) {
        own_limits[lane] = load_limit(round.first_link + first + lane);
        atomicStore(&least_lower[lane], bitcast<u32>(UNBOUNDED));
        atomicStore(&least_upper[lane], bitcast<u32>(UNBOUNDED));
    }
    workgroupBarrier();
    for (var k = 0u; k < round.triangles_at_once; k++) {
        let triangle = (workgroup.x * round.triangles_at_once + k) * THREADS + lane;
        if (round.triangles <= triangle) {
            break;
        }
        let sphere = spheres[triangle];
        for (var i = 0u; i < count; i++) {
            let placed = load_link(round.first_link + first + i);
            if (CULLING && !meets_sphere(placed, sphere, real(own_limits[i]))) {
                continue;
            }
            let face = load_face(triangle);
            var bounds = near_bounds(placed, face);
            if (!CULLING) {
                bounds.upper = full_distance(placed, face);
            }
            let lower = bitcast<u32>(from_below(bounds.lower));
            let upper = bitcast<u32>(from_above(bounds.upper));
            // A load first, because most bounds are not the least.
            if (lower < atomicLoad(&least_lower[i])) {
                atomicMin(&least_lower[i], lower);
            }
            if (upper < atomicLoad(&least_upper[i])) {
                atomicMin(&least_upper[i], upper);
            }
        }
    }
    workgroupBarrier();
    if (lane < count) {
        let place = block_place(first + lane, workgroup.x);
        block_bounds[place] = vec2<u32>(atomicLoad(&least_lower[lane]), atomicLoad(&least_upper[lane]));
    }
}
