// Segment against segment: the twin of distance/segment_segment.rs, which has the derivation and
// the cases.

struct Parameters {
    s: real,
    t: real,
    // From the point of the second segment to that of the first.
    gap: vec3<real>,
}

// The closest parameters of S0 + s e and U0 + t f, where w = S0 - U0.
fn segment_segment_parameters(w: vec3<real>, e: vec3<real>, f: vec3<real>) -> Parameters {
    let n = cross(f, e);
    let a = norm_squared(e);
    let b = dot(e, f);
    let c = norm_squared(f);
    let d = -dot(e, w);
    let g = dot(f, w);
    let free = over(dot(cross(w, f), n), norm_squared(n)); // case 2: 0, moved by the clamps
    var s = min(max(min(max(free * a, min(d, d + b)), max(d, d + b)), real(0.0)), a);
    s = over(s, a);
    let t = over(min(max(s * b + g, real(0.0)), c), c);
    s = over(min(max(t * b + d, real(0.0)), a), a);
    return Parameters(s, t, along(along(w, e, s), f, -t));
}

fn segment_segment(s0: vec3<real>, s1: vec3<real>, u0: vec3<real>, u1: vec3<real>) -> Closest {
    let found = segment_segment_parameters(s0 - u0, s1 - s0, u1 - u0);
    return Closest(norm(found.gap), along(s0, s1 - s0, found.s), along(u0, u1 - u0, found.t));
}
