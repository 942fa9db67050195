// Shared by the kernels of a query: the links of a round, the triangles of a part of the mesh, and
// bounds.
//
// Distances are measured from the axis, as in pair/link_lanes.rs: the distance from the link plus
// the radius. Between workgroups a bound is the bits of a non-negative f32. These bits have the
// order of the numbers, so integer arithmetic finds the least bound, the same in any order.

// A link in the frame of the mesh; `link` is relative to its start.
struct DeviceLink {
    start: vec3<real>,
    length: real,
    // The bound on the rounding error of a distance.
    error: real,
    link: Link,
}

@group(0) @binding(0) var<uniform> round: Round;
@group(0) @binding(1) var<storage, read> links: array<LinkRecord>;
// For each link, as the bits of an f32: the limit on the lower bound of a candidate.
@group(0) @binding(2) var<storage, read_write> limits: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read> spheres: array<vec4<real>>;
@group(0) @binding(4) var<storage, read> faces: array<FaceRecord>;
// For each link of the round and each block of triangles: the least lower and the least upper
// bound, as bits.
@group(0) @binding(5) var<storage, read_write> block_bounds: array<vec2<u32>>;

fn load_link(number: u32) -> DeviceLink {
    let record = links[number];
    let flat_start = real(0.0) < record.flat_start;
    let flat_end = real(0.0) < record.flat_end;
    let link = Link(record.end, record.axis, record.radius, flat_start, flat_end);
    return DeviceLink(record.start, record.length, record.error, link);
}

fn load_face(triangle: u32) -> Face {
    return face_unpack(faces[triangle]);
}

fn load_limit(number: u32) -> f32 {
    return bitcast<f32>(atomicLoad(&limits[number]));
}

// The index of the bounds of a link of this round and a block.
fn block_place(link: u32, block: u32) -> u32 {
    return link * round.blocks + round.first_block + block;
}

// The vector from the nearest axis point to `point`.
fn offset_from_axis(placed: DeviceLink, point: vec3<real>) -> vec3<real> {
    let relative = point - placed.start;
    let t = min(max(dot(relative, placed.link.axis), real(0.0)), placed.length);
    return along(relative, placed.link.axis, -t);
}

// An upper bound on the distance of the triangle in a sphere.
fn reach_of_sphere(placed: DeviceLink, sphere: vec4<real>) -> real {
    // With F the axis distance and d the link's distance: a point of the triangle bounds F from
    // above. At a flat cap d <= F, so that d + radius <= F + radius.
    let flat_cap = placed.link.flat_start || placed.link.flat_end;
    let beyond = select(real(0.0), placed.link.radius, flat_cap);
    return norm(offset_from_axis(placed, sphere.xyz)) + sphere.w + beyond;
}

// Whether a sphere comes within `limit` of the axis.
fn meets_sphere(placed: DeviceLink, sphere: vec4<real>, limit: real) -> bool {
    let reach = limit + sphere.w;
    return norm_squared(offset_from_axis(placed, sphere.xyz)) <= reach * reach;
}

// Bounds on the distance of a triangle. Both are the axis distance if no flat cap decides.
fn near_bounds(placed: DeviceLink, face: Face) -> Bounds {
    let seen = face_seen_from(face, placed.start);
    let axial = axial_new(placed.link, seen);
    let axis = sqrt(axial.axis_squared);
    if (!axial_beyond_flat_cap(axial)) {
        let beside = beside_barrel(placed, axial, axis);
        return Bounds(beside, beside);
    }
    let cap = axial_cap_bounds(axial, placed.link, seen);
    return Bounds(max(axis, cap.lower + placed.link.radius), cap.upper + placed.link.radius);
}

// The distance with every disc that decides it: the paper's work for a pair.
fn full_distance(placed: DeviceLink, face: Face) -> real {
    let seen = face_seen_from(face, placed.start);
    let axial = axial_new(placed.link, seen);
    if (axial_beyond_flat_cap(axial)) {
        return axial_with_caps(axial, placed.link, seen).distance + placed.link.radius;
    }
    return beside_barrel(placed, axial, sqrt(axial.axis_squared));
}

// The axis distance if no flat cap decides. If rounding alone has put p* behind a flat cap, there
// is a gap however near the axis is. So no triangle counts as nearer than one that touches.
fn beside_barrel(placed: DeviceLink, axial: Axial, axis: real) -> real {
    let along = dot(axial.on_triangle, placed.link.axis);
    let before = placed.link.flat_start && along <= placed.error;
    let beyond = placed.link.flat_end && placed.length - placed.error <= along;
    return select(axis, max(axis, placed.link.radius), before || beyond);
}
