//! Cap slivers: obtuse triangles whose three vertices are nearly collinear, as meshes of thin
//! surfaces have them. What lies above their interior is at the distance of their plane, and that
//! plane is hard to compute.
//!
//! The expected distance is the textbook's height above a plane, taken in double-double arithmetic
//! from the very numbers that the kernel gets; so is the proof that the sample projects inside the
//! face.

use continuum_testing::Random;
use continuum_testing::narrow_phase::{
    segment_triangle, triangle_disc, triangle_modified_cylinder,
};
use continuum_testing::precision::{Precision, extent, vector};
use parry_continuum::distance::*;
use parry_continuum::parry::math::Vector;

type Exact = Vec3<DoubleDouble>;

fn exact<T: Precision>(point: Vec3<T>) -> Exact {
    Vec3::from(vector(point).to_array().map(DoubleDouble::from))
}

fn lit(value: f64) -> DoubleDouble {
    value.into()
}

/// A triangle and its plane.
struct Sliver<T> {
    triangle: [Vec3<T>; 3],
    apex: Exact,
    edges: [Exact; 2],
    normal: Exact,
}

impl<T: Precision> Sliver<T> {
    /// Of the given ratio of height to length, in any position and order of vertices.
    fn new(random: &mut Random, ratio: f64) -> Self {
        let (a, edge) = (random.point(), random.direction() * random.between(0.5, 2.0));
        let across = random.perpendicular_to(edge.normalize()) * (edge.length() * ratio);
        let corners = [a, a + edge, a + edge * random.between(0.2, 0.8) + across];
        let first = random.below(3) as usize;
        let triangle = [0, 1, 2].map(|i| T::vec3(corners[(first + i) % 3]));
        let [p, q, r] = triangle.map(exact);
        let normal = (q - p).cross(r - p);
        Self {
            triangle,
            apex: p,
            edges: [q - p, r - p],
            normal: normal * (lit(1.0) / normal.norm()),
        }
    }

    /// A point at this height above some point of the interior.
    fn above(&self, random: &mut Random, height: f64) -> Exact {
        let (u, v) = (random.between(0.05, 0.95), random.between(0.05, 0.95));
        let (beta, alpha) = (lit(u * v), lit((1.0 - u) * v));
        self.apex + self.edges[0] * alpha + self.edges[1] * beta + self.normal * lit(height)
    }

    fn height(&self, point: Exact) -> DoubleDouble {
        self.normal.dot(point - self.apex)
    }

    /// Whether the point's foot lies in the interior.
    fn is_below(&self, point: Exact) -> bool {
        let [e1, e2] = self.edges;
        let relative = point - self.apex;
        let area = e1.cross(e2).dot(self.normal);
        let alpha = (relative.cross(e2).dot(self.normal) / area).rounded();
        let beta = (e1.cross(relative).dot(self.normal) / area).rounded();
        alpha > 0.0 && beta > 0.0 && alpha + beta < 1.0
    }

    /// The lowest point of a disc with a unit normal.
    fn lowest(&self, centre: Exact, normal: Exact, radius: DoubleDouble) -> Exact {
        let up = self.normal - normal * self.normal.dot(normal);
        let slope = up.norm();
        // If the tilt is within rounding, the centre is as low as any point.
        let is_parallel = slope.rounded() <= 2.0 * T::UNIT;
        if is_parallel { centre } else { centre - up * (radius / slope) }
    }
}

/// Rounds a point to the precision under test.
fn rounded<T: Precision>(point: Exact) -> Vec3<T> {
    T::vec3(Vector::new(point.x.rounded(), point.y.rounded(), point.z.rounded()))
}

fn unit(vector: Exact) -> Exact {
    vector * (lit(1.0) / vector.norm())
}

/// Collects errors in units of the extent.
#[derive(Default)]
struct Errors {
    checked: u32,
    worst: f64,
}

impl Errors {
    /// Checks a distance whose exact value is `expected` if the point that is the `nearest` is
    /// above the interior.
    fn check<T: Precision>(
        &mut self,
        sliver: &Sliver<T>,
        nearest: Exact,
        expected: DoubleDouble,
        points: &[Vec3<T>],
        radius: T,
        closest: Closest<T>,
    ) {
        if !sliver.is_below(nearest) || expected.rounded() < 0.0 {
            return;
        }
        let all: Vec<_> = sliver.triangle.iter().chain(points).map(|&p| vector(p)).collect();
        let unit = T::UNIT * extent(&all, radius.into());
        let error = (closest.distance.into() - expected.rounded()).abs() / unit;
        assert!(
            error <= 16.0,
            "{error} units: {closest:?} for {expected:?}\n{:?} {points:?} {radius:?}",
            sliver.triangle
        );
        self.worst = self.worst.max(error);
        self.checked += 1;
    }
}

/// Runs a check on slivers down to the height/length 10^`finest` and asserts that most samples
/// served.
fn on_slivers<T: Precision>(
    finest: f64,
    per_sliver: u32,
    check: impl Fn(&mut Random, &Sliver<T>, f64, &mut Errors),
) {
    let mut random = Random::new(5);
    let steps = 40;
    for step in 0..=steps {
        let mut errors = Errors::default();
        let ratio = 10.0_f64.powf(-1.0 + (finest + 1.0) * f64::from(step) / f64::from(steps));
        for _ in 0..40 {
            let sliver = Sliver::new(&mut random, ratio);
            let height = 10.0_f64.powf(random.between(-6.0, 0.5));
            check(&mut random, &sliver, height, &mut errors);
        }
        println!("{} {ratio:e}: {:.2} units, {}", T::UNIT, errors.worst, errors.checked);
        assert!(errors.checked >= 30 * per_sliver, "{ratio:e}: {}", errors.checked);
    }
}

fn points<T: Precision>(finest: f64) {
    on_slivers::<T>(finest, 1, |random, sliver, height, errors| {
        let p = rounded::<T>(sliver.above(random, height));
        let (nearest, zero) = (exact(p), T::from_f64(0.0));
        let closest = point_triangle(p, sliver.triangle);
        errors.check(sliver, nearest, sliver.height(nearest), &[p], zero, closest);
    });
}

#[test]
fn points_above_the_interior() {
    points::<f64>(-12.0);
    points::<f32>(-5.0);
}

fn segments<T: Precision>(finest: f64) {
    on_slivers::<T>(finest, 3, |random, sliver, height, errors| {
        let zero = T::from_f64(0.0);
        let low = rounded::<T>(sliver.above(random, height));
        let other = sliver.above(random, 0.0);
        let aside = other + Vec3::from(random.point().to_array().map(lit));
        // Nearly parallel above the interior; rising to anywhere; through the face.
        for end in [other + sliver.normal * lit(height), aside + sliver.normal * lit(4.0)] {
            let end = rounded::<T>(end);
            let ends = [exact(low), exact(end)];
            let heights = ends.map(|end| sliver.height(end));
            let (nearest, expected) = if heights[1].lt(heights[0]) {
                (ends[1], heights[1])
            } else {
                (ends[0], heights[0])
            };
            let closest = segment_triangle([end, low], sliver.triangle);
            errors.check(sliver, nearest, expected, &[low, end], zero, closest);
        }
        let end = rounded::<T>(other - sliver.normal * lit(random.between(0.0, 1.0)));
        let ends = [exact(low), exact(end)];
        let [above, below] = ends.map(|end| sliver.height(end));
        let crossing = ends[0] + (ends[1] - ends[0]) * (above / (above - below));
        let closest = segment_triangle([low, end], sliver.triangle);
        errors.check(sliver, crossing, DoubleDouble::ZERO, &[low, end], zero, closest);
    });
}

#[test]
fn segments_above_and_through_the_interior() {
    segments::<f64>(-12.0);
    segments::<f32>(-4.5);
}

/// A disc whose lowest point is above the interior, parallel to the face or tilted any way: centre
/// and radius rounded, and a point along its axis on the upper side.
fn disc<T: Precision>(
    random: &mut Random,
    sliver: &Sliver<T>,
    height: f64,
) -> (Vec3<T>, Vec3<T>, T) {
    let tilt =
        [0.0, random.magnitude(-6.0, 0.0), random.between(0.0, 1.4)][random.below(3) as usize];
    let radius = random.magnitude(-3.0, 0.0);
    let up = Vector::new(
        sliver.normal.x.rounded(),
        sliver.normal.y.rounded(),
        sliver.normal.z.rounded(),
    );
    let downhill = random.perpendicular_to(up);
    let (sin, cos) = tilt.sin_cos();
    let lowest = sliver.above(random, height);
    // A disc parallel to the face has no single lowest point: take its centre.
    let slope = (downhill * cos - up * sin) * if tilt == 0.0 { 0.0 } else { radius };
    let centre = lowest - Vec3::from(slope.to_array().map(lit));
    let axis = (up * cos + downhill * sin) * random.between(0.1, 2.0);
    let tip = centre + Vec3::from(axis.to_array().map(lit));
    (rounded(centre), rounded(tip), T::from_f64(radius))
}

fn discs<T: Precision>(finest: f64) {
    on_slivers::<T>(finest, 1, |random, sliver, height, errors| {
        let (centre, tip, radius) = disc::<T>(random, sliver, height);
        // The normal, of any length, is as exact as the points.
        let normal = rounded::<T>(exact(tip) - exact(centre));
        let lowest = sliver.lowest(exact(centre), unit(exact(normal)), lit(radius.into()));
        let closest = triangle_disc(sliver.triangle, centre, normal, radius);
        errors.check(sliver, lowest, sliver.height(lowest), &[centre], radius, closest);
    });
}

#[test]
fn discs_whose_lowest_point_is_above_the_interior() {
    discs::<f64>(-12.0);
    discs::<f32>(-4.5);
}

fn piercing_discs<T: Precision>(finest: f64) {
    on_slivers::<T>(finest, 1, |random, sliver, _, errors| {
        let (touching, tip, radius) = disc::<T>(random, sliver, 0.0);
        // Lowered until the disc cuts the plane.
        let axis = unit(exact(tip) - exact(touching));
        let down = lit(radius.into()) * lit(random.unit());
        let centre = rounded::<T>(sliver.lowest(exact(touching), axis, down));
        let tip = rounded::<T>(exact(centre) + axis);
        let normal = exact(tip) - exact(centre);
        let axis = unit(normal);
        let up = sliver.normal - axis * sliver.normal.dot(axis);
        if up.norm().rounded() < 1e-3 {
            return; // nearly parallel: it cuts the plane anywhere
        }
        let crossing = exact(centre) - up * (sliver.height(exact(centre)) / up.norm_squared());
        let closest = triangle_disc(sliver.triangle, centre, rounded(normal), radius);
        errors.check(sliver, crossing, DoubleDouble::ZERO, &[centre], radius, closest);
        let closest =
            triangle_modified_cylinder(sliver.triangle, centre, tip, radius, [true, true]);
        errors.check(sliver, crossing, DoubleDouble::ZERO, &[centre, tip], radius, closest);
    });
}

#[test]
fn discs_that_pierce_the_interior() {
    piercing_discs::<f64>(-12.0);
    piercing_discs::<f32>(-4.5);
}

fn links<T: Precision>(finest: f64) {
    on_slivers::<T>(finest, 4, |random, sliver, height, errors| {
        let (centre, tip, radius) = disc::<T>(random, sliver, height);
        let lowest =
            sliver.lowest(exact(centre), unit(exact(tip) - exact(centre)), lit(radius.into()));
        for other in [false, true] {
            for turned in [false, true] {
                let (ends, flat) = if turned {
                    ([tip, centre], [other, true])
                } else {
                    ([centre, tip], [true, other])
                };
                let closest =
                    triangle_modified_cylinder(sliver.triangle, ends[0], ends[1], radius, flat);
                // A round tip may be lower than the flat end, which then does not matter.
                let ball = sliver.height(exact(tip)) - lit(radius.into());
                if other || sliver.height(lowest).lt(ball) {
                    errors.check(sliver, lowest, sliver.height(lowest), &ends, radius, closest);
                }
                // A round end with its lowest point straight below.
                let ball = T::from_f64(height * 0.5);
                let start = rounded::<T>(sliver.above(random, height));
                let flat = if turned { [other, false] } else { [false, other] };
                let end = rounded::<T>(exact(start) + exact(tip) - exact(centre));
                let ends = if turned { [end, start] } else { [start, end] };
                let expected = sliver.height(exact(start)) - lit(ball.into());
                let other_end = sliver.height(exact(end)) - lit(ball.into());
                if expected.lt(other_end) {
                    let closest =
                        triangle_modified_cylinder(sliver.triangle, ends[0], ends[1], ball, flat);
                    errors.check(sliver, exact(start), expected, &ends, ball, closest);
                }
            }
        }
    });
}

#[test]
fn links_whose_lowest_point_is_above_the_interior() {
    links::<f64>(-12.0);
    links::<f32>(-4.5);
}

fn vanishing<T: Precision>(lengths: std::ops::Range<i32>, widths: std::ops::Range<i32>) {
    let end = Vector::new(0.0, 0.5, -0.5);
    for (length, width) in
        lengths.flat_map(|length| widths.clone().map(move |width| (length, width)))
    {
        let (far, thin) = (2.0_f64.powi(length), 2.0_f64.powi(-width));
        let triangle = [Vector::splat(thin), Vector::X * thin, Vector::splat(0.5)].map(T::vec3);
        let start = T::vec3(Vector::new(far, thin, 0.0));
        for flat in [[true; 2], [false; 2], [true, false], [false, true]] {
            for radius in [0.0, 0.125] {
                let found = triangle_modified_cylinder(
                    triangle,
                    start,
                    T::vec3(end),
                    T::from_f64(radius),
                    flat,
                );
                // The end's foot is the corner at the origin, and the cap's nearest point has the
                // same foot.
                let error = (found.distance.into() - (0.5_f64.sqrt() - radius)).abs();
                assert!(
                    error <= 16.0 * T::UNIT * far,
                    "2^{length}, 2^-{width}, {flat:?}, {radius}: {error}"
                );
            }
        }
    }
}

#[test]
fn slivers_whose_width_is_lost_beside_a_long_link() {
    vanishing::<f64>(20..40, 60..110);
    vanishing::<f32>(8..16, 26..50);
}

/// A wire that passes a sliver right where its two long sides would meet again beyond the sharp
/// corner touches nothing.
fn beyond_the_sharp_corner<T: Precision>() {
    let mut random = Random::new(11);
    let (mut beside, mut through) = (0, 0);
    for round in 0..100_000 {
        let length = random.direction();
        let width = random.perpendicular_to(length);
        let height = 2.0_f64.powi(-(random.below(60) as i32));
        let apex = length * random.between(0.01, 0.99) + width * height;
        let gap =
            2.0_f64.powi(-(2 + random.below(20) as i32)) * [1.0, -1.0][random.below(2) as usize];
        let crossing = length * (1.0 + gap);
        let along = length.cross(width) + width * random.between(-1.0, 1.0);
        let mut triangle = [Vector::ZERO, length, apex];
        triangle.rotate_left(random.below(3) as usize);
        let wire = [
            crossing - along * random.between(0.2, 2.0),
            crossing + along * random.between(0.2, 2.0),
        ];
        let found: f64 = segment_triangle(wire.map(T::vec3), triangle.map(T::vec3)).distance.into();
        // What rounding the numbers that the kernel gets adds to what the kernel may err by.
        let rounding = 8.0 * T::UNIT * extent(&[&wire[..], &triangle].concat(), 0.0);
        // Within the triangle's length it is the long side that the wire meets.
        let expected = gap.max(0.0);
        assert!(
            (found - expected).abs() <= rounding,
            "{round}: {found} beside {gap}, height {height}"
        );
        if gap > 0.0 { beside += 1 } else { through += 1 }
    }
    assert!(beside > 40_000 && through > 40_000);
}

#[test]
fn a_wire_beyond_the_sharp_corner_of_a_sliver_keeps_away() {
    beyond_the_sharp_corner::<f32>();
    beyond_the_sharp_corner::<f64>();
}
