//! One link and one triangle: the narrow phase satisfies its error bounds in both precisions.

use super::source::Source;
use crate::narrow_phase::triangle_modified_cylinder;
use crate::precision::{Precision, extent, vector};
use parry_continuum::distance::Closest;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Certificate;
use parry_continuum::{Cap, ModifiedCylinder};

/// Asserts that the distance is within 16 units of the extent, and that the closest points realise
/// it.
pub fn link_triangle(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let caps = [source.flag(), source.flag()].map(|flat| if flat { Cap::Flat } else { Cap::Round });
    let points = [source.point(), source.point(), source.point(), source.point(), source.point()];
    let radius = source.number();
    check::<f64>(points, radius, caps);
    check::<f32>(points, radius, caps);
}

fn check<T: Precision>(points: [Vector; 5], radius: f64, caps: [Cap; 2]) {
    let round = |x: f64| T::from_f64(x).into();
    let [a, b, c, start, end] = points.map(|p| Vector::from(p.to_array().map(round)));
    let Ok(link) = ModifiedCylinder::new(start, end, round(radius), caps) else { return };
    let Ok(bounds) = Certificate::between(&link, &Pose::IDENTITY, [a, b, c]) else { return };
    let flat = caps.map(|cap| cap == Cap::Flat);
    let found = triangle_modified_cylinder(
        [a, b, c].map(T::vec3),
        T::vec3(start),
        T::vec3(end),
        T::from_f64(radius),
        flat,
    );

    let all = [a, b, c, start, end];
    let extent = extent(&all, round(radius));
    let magnitude = all.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let (least, shortest) = if T::UNIT == f64::UNIT {
        (f64::from_bits(1), 1e-150)
    } else {
        (f32::from_bits(1).into(), 1e-18)
    };
    // A link whose squared length underflows has no direction; its caps count as round, as
    // documented.
    if flat.contains(&true) && (end - start).abs().max_element() < shortest * extent && radius > 0.0
    {
        return;
    }
    // Subnormal answers have an absolute rounding error.
    let slack = 16.0 * T::UNIT * extent + 4.0 * least;
    let context = || {
        format!(
            "{found:?}\n{bounds:?}\n{all:?} {radius} {caps:?}\nextent {extent}",
            found = values(&found)
        )
    };
    let distance: f64 = found.distance.into();
    let largest = if T::UNIT == f64::UNIT { f64::MAX } else { f32::MAX.into() };
    if distance.is_infinite() {
        assert!(bounds.upper + slack >= largest, "{}", context());
        return;
    }
    assert!(bounds.lower - slack <= distance && distance <= bounds.upper + slack, "{}", context());
    assert!(
        bounds.upper - bounds.lower <= 16.0 * f64::UNIT * extent + 8.0 * f64::from_bits(1),
        "{}",
        context()
    );

    let [_, p, q] = values(&found);
    let between = length(p - q);
    let slack = 8.0 * T::UNIT * (extent + magnitude) + 4.0 * least;
    assert!((between - distance).abs() <= slack, "witnesses at {between}\n{}", context());
    if distance == 0.0 {
        assert_eq!(p, q, "{}", context());
    }
}

fn values<T: Precision>(closest: &Closest<T>) -> [Vector; 3] {
    [Vector::splat(closest.distance.into()), vector(closest.point1), vector(closest.point2)]
}

/// Returns the length of a vector whose squares may overflow or underflow.
fn length(v: Vector) -> f64 {
    let unit = v.abs().max_element();
    if unit > 0.0 { (v / unit).length() * unit } else { 0.0 }
}
