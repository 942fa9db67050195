// Step 4 of a query: the candidates of each link, the triangles within the limit, discs included.
// The twin of what ThreadFindings in search/exhaustive/scan.rs collect.
//
// The second pass of two visits only blocks and triangles whose lower bound is within the limit. It
// computes a disc only if a flat cap decides. The candidates come in any order; the host sorts
// them.

// For each slot: the number of blocks that have answered, times the submission's number; the number
// of candidates; and the triangles of the first CAPACITY candidates.
@group(0) @binding(6) var<storage, read_write> found: array<atomic<u32>>;
// The distances of the candidates.
@group(0) @binding(7) var<storage, read_write> distances: array<real>;

var<workgroup> survives: array<u32, MOST_LINKS>;

@compute @workgroup_size(THREADS)
fn collect(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = workgroup.y * round.links_at_once;
    let count = min(round.links_at_once, round.links - first);
    if (lane < count) {
        let lower = block_bounds[block_place(first + lane, workgroup.x)].x;
        survives[lane] = select(0u, 1u, lower <= atomicLoad(&limits[round.first_link + first + lane]));
    }
    workgroupBarrier();
    for (var i = 0u; i < count; i++) {
        if (survives[i] == 0u) {
            continue;
        }
        let number = round.first_link + first + i;
        let placed = load_link(number);
        let limit = real(load_limit(number));
        for (var k = 0u; k < round.triangles_at_once; k++) {
            let triangle = (workgroup.x * round.triangles_at_once + k) * THREADS + lane;
            if (round.triangles <= triangle) {
                break;
            }
            if (!meets_sphere(placed, spheres[triangle], limit)) {
                continue;
            }
            let face = load_face(triangle);
            let bounds = near_bounds(placed, face);
            if (limit < bounds.lower) {
                continue;
            }
            var distance = bounds.lower;
            if (bounds.lower < bounds.upper) {
                distance = full_distance(placed, face);
                if (limit < distance) {
                    continue;
                }
            }
            let slot = round.first_slot + first + i;
            let place = atomicAdd(&found[slot * SLOT + 1u], 1u);
            if (place < CAPACITY) {
                atomicStore(&found[slot * SLOT + 2u + place], triangle);
                distances[slot * CAPACITY + place] = distance;
            }
        }
    }
    // The host counts the blocks, so that it recognises a slot that a block has not written.
    if (lane < count) {
        atomicAdd(&found[(round.first_slot + first + lane) * SLOT], round.submission);
    }
}
