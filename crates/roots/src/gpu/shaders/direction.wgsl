// Where the iterations start: on a circle, at 49 degrees and, after each failure, 94 degrees on.

fn first_direction() -> vec2<real> {
    return vec2<real>(real(0.6560590289905073), real(0.754709580222772));
}

fn turned(direction: vec2<real>) -> vec2<real> {
    let cosine = real(-0.0697564737441253);
    let sine = real(0.9975640502598242);
    return vec2<real>(cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y);
}
