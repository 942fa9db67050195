//! Segment against disc on plain and nasty problems, against twice the digits.

use continuum_testing::disc_problems::{DiscProblem, problems, worst};
use continuum_testing::narrow_phase::segment_disc;
use continuum_testing::precision::Precision;
use parry_continuum::parry::math::Vector;

#[test]
fn the_convex_route_is_right_to_rounding_on_every_kind() {
    assert!(worst::<f64>(segment_disc, &problems::<f64>(3000)) <= 8.0);
    assert!(worst::<f32>(segment_disc, &problems::<f32>(3000)) <= 8.0);
}

#[test]
fn the_convex_route_where_it_once_failed() {
    // Two steps of Halley's method from a start too far to the left of the root, and a step that
    // rounding led astray.
    let touching_the_rim = DiscProblem {
        ends: [
            Vector::new(0.3158080279827118, -0.5550690293312073, -0.9345921874046326),
            Vector::new(-0.9483529925346375, -2.2700159549713135, 1.1725966930389404),
        ],
        centre: Vector::new(-0.3020027279853821, -0.3507661819458008, 0.6647735834121704),
        normal: Vector::new(-0.33829623460769653, -0.23519772291183472, 0.9111738204956055),
        radius: 1.2715799808502197,
    };
    let flat_to_rounding = DiscProblem {
        ends: [
            Vector::new(1.8183904886245728, -0.29342177510261536, 1.5228297710418701),
            Vector::new(1.7374763488769531, -0.11341158300638199, 1.8671146631240845),
        ],
        centre: Vector::new(0.6104958653450012, -0.22664667665958405, 0.8624231219291687),
        normal: Vector::new(0.26559582352638245, 0.8785749077796936, -0.396944522857666),
        radius: 1.3460198640823364,
    };
    for problem in [touching_the_rim, flat_to_rounding] {
        assert!(
            problem.error::<f32>(segment_disc, problem.distance()) <= 8.0 * f32::UNIT,
            "{problem:?}"
        );
    }
}
