// The tree of a mesh, as all kernels of the search see it: gpu/search/tree.rs.

// Two children with their boxes, and the lowest triangle below each.
struct Node {
    low0: vec3<f32>,
    child0: u32,
    high0: vec3<f32>,
    lowest0: u32,
    low1: vec3<f32>,
    child1: u32,
    high1: vec3<f32>,
    lowest1: u32,
}

struct Triangle {
    a: vec3<f32>,
    number: u32,
    b: vec3<f32>,
    c: vec3<f32>,
}

fn is_leaf(child: u32) -> bool {
    return (child & LEAF) != 0u;
}

fn leaf_first(child: u32) -> u32 {
    return (child & ~LEAF) / LEAF_SIZE;
}

fn leaf_count(child: u32) -> u32 {
    return child % LEAF_SIZE + 1u;
}
