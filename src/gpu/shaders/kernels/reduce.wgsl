// Step 3 of a query: the limit of each link, from the least upper bound of all blocks. A triangle
// that exceeds the limit by more than rounding is farther than another. The twin of
// SharedBound::lower_to in search/exhaustive/scan.rs.

var<workgroup> least: atomic<u32>;

@compute @workgroup_size(THREADS)
fn reduce(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) {
        atomicStore(&least, bitcast<u32>(UNBOUNDED));
    }
    workgroupBarrier();
    var nearest = bitcast<u32>(UNBOUNDED);
    for (var block = lane; block < round.blocks; block += THREADS) {
        nearest = min(nearest, block_bounds[workgroup.x * round.blocks + block].y);
    }
    atomicMin(&least, nearest);
    workgroupBarrier();
    if (lane == 0u) {
        let number = round.first_link + workgroup.x;
        let upper = real(bitcast<f32>(atomicLoad(&least)));
        let limit = from_above(upper + real(2.0) * load_link(number).error);
        atomicMin(&limits[number], bitcast<u32>(limit));
    }
}
