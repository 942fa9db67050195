// Fills the triangles with the vertices as they are now. The twin of TwinTree::refit in
// gpu/search/twin.rs.

@group(0) @binding(0) var<storage, read> vertices: array<f32>;
// Three vertices, and the triangle's number in the mesh.
@group(0) @binding(1) var<storage, read> corners_of: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read_write> triangles: array<Triangle>;

fn vertex(index: u32) -> vec3<f32> {
    return vec3<f32>(vertices[3u * index], vertices[3u * index + 1u], vertices[3u * index + 2u]);
}

@compute @workgroup_size(REFIT_THREADS)
fn corners(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let place = (workgroup.y * workgroups.x + workgroup.x) * REFIT_THREADS + lane;
    if (arrayLength(&corners_of) <= place) {
        return;
    }
    let corner = corners_of[place];
    triangles[place] = Triangle(vertex(corner.x), corner.w, vertex(corner.y), vertex(corner.z));
}
