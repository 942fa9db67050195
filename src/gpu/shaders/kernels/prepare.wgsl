// Computes the sphere and the face of each triangle, after the vertices have moved. The twin of
// prepare in search/exhaustive/blocks.rs.

@group(0) @binding(0) var<storage, read> vertices: array<real>;
@group(0) @binding(1) var<storage, read> indices: array<u32>;
// Centres and radii of bounding spheres.
@group(0) @binding(2) var<storage, read_write> spheres: array<vec4<real>>;
@group(0) @binding(3) var<storage, read_write> faces: array<FaceRecord>;

fn vertex(index: u32) -> vec3<real> {
    return vec3<real>(vertices[3u * index], vertices[3u * index + 1u], vertices[3u * index + 2u]);
}

@compute @workgroup_size(THREADS)
fn prepare(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let triangle = (workgroup.y * workgroups.x + workgroup.x) * THREADS + lane;
    if (arrayLength(&spheres) <= triangle) {
        return;
    }
    let corner = 3u * triangle;
    let face = face_new(vertex(indices[corner]), vertex(indices[corner + 1u]), vertex(indices[corner + 2u]));
    // Around the midpoint of the longest edge. This sphere contains the apex of an obtuse triangle
    // too.
    let middle = (face.b + face.c) * real(0.5);
    let around_middle = max(norm_squared(face.a - middle), norm_squared(face.b - middle));
    // The apex of an acute triangle may lie outside. Then the sphere around the centroid is used,
    // if it is smaller.
    let centroid = (face.a + face.b + face.c) * real(1.0 / 3.0);
    let around_centroid = max(
        max(norm_squared(face.a - centroid), norm_squared(face.b - centroid)),
        norm_squared(face.c - centroid),
    );
    let take_middle = around_middle <= around_centroid;
    let centre = select(centroid, middle, take_middle);
    let radius = sqrt(select(around_centroid, around_middle, take_middle));
    // Twice the margin of the twin, because square roots of shading languages are less exact.
    spheres[triangle] = vec4<real>(centre, radius * (real(1.0) + real(16.0) * UNIT_ROUNDOFF));
    faces[triangle] = face_pack(face);
}
