// Bounds on the distance to a flat cap: the twin of distance/triangle_modified_cylinder.rs, which
// has the derivation.

struct Bounds {
    lower: real,
    upper: real,
}

// The plane's lower bound minus the rounding that may be in it, and the distance of the triangle's
// point.
fn bounds_separating_plane(
    a: vec3<real>,
    b: vec3<real>,
    c: vec3<real>,
    on_triangle: vec3<real>,
    outward: vec3<real>,
    radius: real,
    behind: real,
) -> Bounds {
    let height = dot(on_triangle, outward);
    let radial = along(on_triangle, outward, -height);
    let rho = norm(radial);
    let direction = radial * over(real(1.0), rho);
    let up = max(height, real(0.0));
    let out = max(rho - radius, real(0.0));
    let normal = outward * up + direction * out;
    let upper = sqrt(up * up + out * out);

    let support = direction * min(rho, radius);
    let ahead = min(min(dot(normal, a - support), dot(normal, b - support)), dot(normal, c - support));
    let extent = max(max(max(largest(a), largest(b)), largest(c)), behind);
    let tilt = max(-dot(normal, outward), real(0.0));
    let bound = over(ahead - tilt * behind, upper) - extent * (real(16.0) * UNIT_ROUNDOFF);
    return Bounds(select(real(0.0), max(bound, real(0.0)), real(0.0) < upper), upper);
}
