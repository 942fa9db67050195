//! One link and one triangle: the narrow phase keeps to its bounds in both precisions.

use super::source::Source;
use parry_continuum::distance::{Closest, Scalar, Vec3, triangle_modified_cylinder};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Certificate;
use parry_continuum::{Cap, ModifiedCylinder};

/// A precision, with conversions.
trait Precision: Scalar<Mask = bool> + Into<f64> {
    fn round(x: f64) -> Self;
    /// The least positive number.
    const LEAST: f64;
}

impl Precision for f32 {
    const LEAST: f64 = f32::from_bits(1) as f64;
    fn round(x: f64) -> Self {
        x as f32
    }
}

impl Precision for f64 {
    const LEAST: f64 = f64::from_bits(1);
    fn round(x: f64) -> Self {
        x
    }
}

/// The distance is within 16 units of the extent, and the closest points realise it.
pub fn link_triangle(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let caps = [source.flag(), source.flag()].map(|flat| if flat { Cap::Flat } else { Cap::Round });
    let points = [source.point(), source.point(), source.point(), source.point(), source.point()];
    let radius = source.number();
    check::<f64>(points, radius, caps);
    check::<f32>(points, radius, caps);
}

fn check<T: Precision>(points: [Vector; 5], radius: f64, caps: [Cap; 2]) {
    let round = |x: f64| T::round(x).into();
    let [a, b, c, start, end] = points.map(|p| Vector::from(p.to_array().map(round)));
    let Ok(link) = ModifiedCylinder::new(start, end, round(radius), caps) else { return };
    let Ok(bounds) = Certificate::between(&link, &Pose::IDENTITY, [a, b, c]) else { return };
    let v = |p: Vector| Vec3::from(p.to_array().map(T::round));
    let flat = caps.map(|cap| cap == Cap::Flat);
    let found = triangle_modified_cylinder([a, b, c].map(v), v(start), v(end), T::round(radius), flat);

    let all = [a, b, c, start, end];
    let (low, high) = (all.into_iter().reduce(Vector::min), all.into_iter().reduce(Vector::max));
    let (Some(low), Some(high)) = (low, high) else { return };
    let extent = (high - low).max_element().max(round(radius));
    // A link whose squared length vanishes has no direction; its caps count as round, as documented.
    let shortest = if T::UNIT_ROUNDOFF < 1e-10 { 1e-150 } else { 1e-18 };
    if flat.contains(&true) && (end - start).abs().max_element() < shortest * extent && radius > 0.0 {
        return;
    }
    let magnitude = low.abs().max(high.abs()).max_element();
    let unit = T::UNIT_ROUNDOFF * extent;
    // Answers that are subnormal have their own roundings.
    let slack = 16.0 * unit + 4.0 * T::LEAST;
    let context = || {
        format!("{found:?}\n{bounds:?}\n{all:?} {radius} {caps:?}\nextent {extent}", found = values(&found))
    };
    let distance: f64 = found.distance.into();
    assert!(bounds.lower - slack <= distance && distance <= bounds.upper + slack, "{}", context());
    assert!(
        bounds.upper - bounds.lower <= 16.0 * f64::UNIT_ROUNDOFF * extent + 8.0 * f64::LEAST,
        "{}",
        context()
    );

    let [_, p, q] = values(&found);
    let between = length(p - q);
    let slack = 8.0 * T::UNIT_ROUNDOFF * (extent + magnitude) + 4.0 * T::LEAST;
    assert!((between - distance).abs() <= slack, "witnesses at {between}\n{}", context());
    if distance == 0.0 {
        assert_eq!(p, q, "{}", context());
    }
}

fn values<T: Precision>(closest: &Closest<T>) -> [Vector; 3] {
    let v = |p: Vec3<T>| Vector::from(<[T; 3]>::from(p).map(Into::into));
    [Vector::splat(closest.distance.into()), v(closest.point1), v(closest.point2)]
}

/// The length of a vector whose squares may overflow or vanish.
fn length(v: Vector) -> f64 {
    let unit = v.abs().max_element();
    if unit > 0.0 { (v / unit).length() * unit } else { 0.0 }
}
