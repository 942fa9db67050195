// The start of the iterations: on a circle, and after each failure elsewhere on it. The twins are
// first_direction and turned in bairstow.rs.

fn first_direction() -> vec2<real> {
    return vec2<real>(FIRST_X, FIRST_Y);
}

fn turned(direction: vec2<real>) -> vec2<real> {
    return vec2<real>(
        TURN_COSINE * direction.x - TURN_SINE * direction.y,
        TURN_SINE * direction.x + TURN_COSINE * direction.y,
    );
}
