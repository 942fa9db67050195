// Step 1 of a query: a first limit for each link, from the bounding spheres of a sample of the
// triangles. The twin of Job::first_bounds in search/exhaustive/scan.rs.

var<workgroup> least: atomic<u32>;

@compute @workgroup_size(THREADS)
fn sample(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) {
        atomicStore(&least, bitcast<u32>(UNBOUNDED));
    }
    workgroupBarrier();
    let number = round.first_link + workgroup.x;
    let placed = load_link(number);
    let stride = (round.triangles + SAMPLES - 1u) / SAMPLES;
    var nearest = UNBOUNDED;
    for (var triangle = lane * stride; triangle < round.triangles; triangle += THREADS * stride) {
        let reach = reach_of_sphere(placed, spheres[triangle]) + real(2.0) * placed.error;
        nearest = min(nearest, from_above(reach));
    }
    atomicMin(&least, bitcast<u32>(nearest));
    workgroupBarrier();
    if (lane == 0u) {
        atomicMin(&limits[number], atomicLoad(&least));
    }
}
