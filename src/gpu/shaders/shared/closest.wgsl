// The distance between two shapes and a pair of points that realises it: the twin of
// distance/mod.rs.

struct Closest {
    distance: real,
    point1: vec3<real>,
    point2: vec3<real>,
}

// `yes` if the condition holds.
fn closest_select(condition: bool, yes: Closest, no: Closest) -> Closest {
    return Closest(
        select(no.distance, yes.distance, condition),
        select(no.point1, yes.point1, condition),
        select(no.point2, yes.point2, condition),
    );
}

// The nearer of two answers.
fn closest_nearer(first: Closest, other: Closest) -> Closest {
    return closest_select(other.distance < first.distance, other, first);
}
