//! Links with flat caps that overlap something deeply, placed as scenes are made: level ends, one
//! axis, one plane, edge-on. What is computed of faces that lie in one plane is rounding, which
//! must not part them.

use continuum_testing::Random;
use continuum_testing::narrow_phase::{
    modified_cylinder_modified_cylinder, triangle_modified_cylinder,
};
use continuum_testing::precision::{Precision, extent, vector};
use parry_continuum::distance::{Closest, point_modified_cylinder, point_triangle};
use parry_continuum::parry::math::{Pose, Vector};

/// How many pairs each test draws.
const ROUNDS: u32 = 6000;

/// An axis, a radius, and which caps are flat.
#[derive(Clone, Copy, Debug)]
struct Link {
    axis: [Vector; 2],
    radius: f64,
    flat: [bool; 2],
}

impl Link {
    /// How deep a point lies in the link, at least: round caps are left out.
    fn depth_of(&self, point: Vector) -> f64 {
        let [start, end] = self.axis;
        let axis = (end - start).normalize();
        let along = (point - start).dot(axis);
        let beside = (point - start - axis * along).length();
        (self.radius - beside).min(along).min((end - point).dot(axis))
    }

    fn is_outside(&self, point: Vector) -> f64 {
        let [start, end] = self.axis.map(<f64 as Precision>::vec3);
        point_modified_cylinder(Precision::vec3(point), start, end, self.radius, self.flat).distance
    }

    fn moved(&self, pose: &Pose, size: f64) -> Self {
        Self { axis: self.axis.map(|end| (pose * end) * size), radius: self.radius * size, ..*self }
    }

    fn turned(&self) -> Self {
        let ([start, end], [first, last]) = (self.axis, self.flat);
        Self { axis: [end, start], flat: [last, first], ..*self }
    }
}

/// Some flat cap, and others at random.
fn caps(random: &mut Random) -> [bool; 2] {
    [[true, true], [true, false], [false, true]][random.below(3) as usize]
}

/// A unit of length, and where the pair lies: in the axes' own directions, or any.
fn placed(random: &mut Random) -> (Pose, f64) {
    let size = [1.0, 1e-3, 1e-6, 1e3, random.magnitude(-6.0, 3.0)][random.below(5) as usize];
    let pose = match random.below(4) {
        0 => Pose::IDENTITY,
        1 => Pose::from_translation(random.point() * 4.0),
        2 => random.pose(0.0),
        _ => random.pose(4.0),
    };
    (pose, size)
}

/// The kinds of pairs of links.
const PAIRS: usize = 8;

/// Two links, and a point deep in both.
fn links(random: &mut Random, kind: usize) -> ([Link; 2], Vector) {
    let radii = [random.between(0.2, 1.0), random.between(0.2, 1.0)];
    let radii = if random.below(2) == 0 { [radii[0]; 2] } else { radii };
    let length = random.between(0.3, 4.0);
    let other = random.between(0.3, 4.0);
    // From a tenth of the smaller diameter to all of it.
    let less = radii[0].min(radii[1]);
    let aside = radii[0] + radii[1] - 2.0 * less * random.between(0.1, 1.0);
    let first = [Vector::ZERO, Vector::Z * length];
    // Half way between the two barrels, on the side of the thinner.
    let between =
        Vector::X * (0.5 * ((aside - radii[1]).max(-radii[0]) + radii[0].min(aside + radii[1])));
    let (second, place) = match kind {
        // Level at both ends, at the start, at the end of different lengths, and anywhere.
        0 => ([0.0, length], 0.5 * length),
        1 => ([0.0, other], 0.5 * length.min(other)),
        2 => ([length - other, length], length - 0.5 * length.min(other)),
        3 => {
            let shift = random.between(-0.8 * other, 0.8 * length);
            ([shift, shift + other], 0.5 * (shift.max(0.0) + length.min(shift + other)))
        }
        // On one axis: the end of the one is in the other, or faces lie in one plane.
        4 => {
            let shift = [0.0, length - other, random.between(-0.8 * other, 0.8 * length)]
                [random.below(3) as usize];
            ([shift, shift + other], 0.5 * (shift.max(0.0) + length.min(shift + other)))
        }
        _ => ([0.0; 2], 0.0),
    };
    let along = |at: f64| Vector::Z * at;
    let (second, inside) = match kind {
        0..=3 => (second.map(|at| Vector::X * aside + along(at)), between + along(place)),
        4 => (second.map(along), along(place)),
        // Across the first, with an end or the middle on its axis; at its cap or not.
        5 | 6 => {
            let at = if kind == 5 {
                length + radii[1] * random.between(-0.9, 0.3)
            } else {
                0.5 * length
            };
            let from = [0.0, -0.5 * other, -other][random.below(3) as usize];
            let ends = [from, from + other].map(|x| Vector::X * x + along(at));
            let low = (at - radii[1]).max(0.0);
            let x = if from == 0.0 {
                0.5
            } else if from == -other {
                -0.5
            } else {
                0.0
            };
            let x = x * radii[0].min(other);
            (ends, Vector::X * x + along(0.5 * (low + length.min(at + radii[1]))))
        }
        // In any direction from a point of the first.
        _ => {
            let inside = along(length * random.between(0.1, 0.9))
                + Vector::X * (0.8 * radii[0] * random.unit());
            let way = random.direction() * other;
            let share = random.between(0.1, 0.9);
            ([inside - way * share, inside + way * (1.0 - share)], inside)
        }
    };
    let flat = [caps(random), if random.below(3) == 0 { [false; 2] } else { caps(random) }];
    let pair =
        [(first, 0), (second, 1)].map(|(axis, k)| Link { axis, radius: radii[k], flat: flat[k] });
    (pair.map(|link| if random.below(2) == 0 { link } else { link.turned() }), inside)
}

fn between<T: Precision>([first, second]: &[Link; 2]) -> Closest<T> {
    let [axis1, axis2] = [first, second].map(|link| link.axis.map(T::vec3));
    let [radius1, radius2] = [first, second].map(|link| T::from_f64(link.radius));
    modified_cylinder_modified_cylinder(axis1, radius1, first.flat, axis2, radius2, second.flat)
}

fn check_links<T: Precision>(pair: &[Link; 2]) {
    let closest = between::<T>(pair);
    assert_eq!(closest.distance.into(), 0.0, "{pair:?}");
    let (point, same) = (vector(closest.point1), vector(closest.point2));
    assert_eq!(point, same, "{pair:?}");
    let ends = pair.map(|link| link.axis).concat();
    let largest = ends.iter().fold(0.0, |most: f64, end| most.max(end.abs().max_element()));
    let slack = 8.0 * T::UNIT * (largest + extent(&ends, pair[0].radius.max(pair[1].radius)));
    for link in pair {
        let off = link.is_outside(point);
        // In single precision the links themselves are rounded, and so turned, if they are short.
        let turn = if T::UNIT > f64::EPSILON { 8.0 } else { 1.0 };
        assert!(off <= slack * turn, "{off} of {slack}: {pair:?}");
    }
}

#[test]
fn links_that_overlap_deeply_meet() {
    let mut random = Random::new(51);
    let mut count = [0; PAIRS];
    for round in 0..ROUNDS {
        let kind = round as usize % PAIRS;
        let (pair, inside) = links(&mut random, kind);
        let deep = pair.iter().fold(f64::INFINITY, |least, link| least.min(link.depth_of(inside)));
        if deep < 1e-3 {
            continue;
        }
        count[kind] += 1;
        let (pose, size) = placed(&mut random);
        let pair = pair.map(|link| link.moved(&pose, size));
        for pair in [pair, [pair[1], pair[0]]] {
            check_links::<f64>(&pair);
            check_links::<f32>(&pair);
        }
    }
    println!("{count:?}");
    assert!(count.iter().all(|&count| count > ROUNDS / (2 * PAIRS as u32)), "{count:?}");
}

/// The kinds of triangles.
const TRIANGLES: usize = 8;

/// A link and a triangle that holds a point deep in it.
fn link_and_triangle(random: &mut Random, kind: usize) -> (Link, [Vector; 3], Vector) {
    let (radius, length) = (random.between(0.2, 1.0), random.between(0.3, 4.0));
    let link = Link { axis: [Vector::ZERO, Vector::Z * length], radius, flat: caps(random) };
    let at = |x: f64, y: f64, z: f64| Vector::new(x, y, z);
    let z = length * random.between(0.1, 0.9);
    let x = radius * random.between(0.0, 0.9);
    let wide = random.between(0.1, 3.0);
    let (triangle, inside) = match kind {
        // Through the axis, with one corner, an edge in the plane of the cap.
        0 => (
            [at(0.0, 0.0, length), at(wide, 0.0, z), at(-wide, 0.0, z)],
            at(0.0, 0.0, 0.5 * (z + length)),
        ),
        1 => (
            [at(-wide, 0.0, length), at(wide, 0.0, length), at(0.0, 0.0, z)],
            at(0.0, 0.0, 0.5 * (z + length)),
        ),
        // Beside the axis.
        2 => (
            [at(-wide, x, length), at(wide, x, length), at(0.0, x, z)],
            at(0.0, x, 0.5 * (z + length)),
        ),
        // From one cap's plane to the other's.
        3 => ([at(x, -wide, 0.0), at(x, wide, 0.0), at(x, 0.0, length)], at(x, 0.0, 0.5 * length)),
        // From the axis at the cap, slanted; level with the cap, within.
        4 => ([at(0.0, 0.0, length), at(wide, 0.0, z - wide), at(wide, 0.1, z)], Vector::ZERO),
        5 => ([at(-wide, -wide, z), at(wide, -wide, z), at(x, wide, z)], at(0.3 * x, 0.0, z)),
        // Edge-on, from outside through the rim.
        6 => (
            [at(x, 0.0, length), at(radius + wide, 0.0, length), at(x, 0.0, z)],
            at(x, 0.0, 0.5 * (z + length)),
        ),
        _ => {
            let inside = at(x, 0.0, z);
            let [one, two] = [random.direction() * wide, random.direction() * wide];
            ([inside + one, inside + two, inside - one - two], inside)
        }
    };
    let inside =
        if kind == 4 { (triangle[0] * 6.0 + triangle[1] + triangle[2]) / 8.0 } else { inside };
    let mut triangle = triangle;
    triangle.rotate_left(random.below(3) as usize);
    let link = if random.below(2) == 0 { link } else { link.turned() };
    (link, triangle, inside)
}

fn check_triangle<T: Precision>(link: &Link, triangle: [Vector; 3]) {
    let [start, end] = link.axis.map(T::vec3);
    let radius = T::from_f64(link.radius);
    let closest = triangle_modified_cylinder(triangle.map(T::vec3), start, end, radius, link.flat);
    assert_eq!(closest.distance.into(), 0.0, "{link:?} {triangle:?}");
    let (point, same) = (vector(closest.point1), vector(closest.point2));
    assert_eq!(point, same, "{link:?} {triangle:?}");
    let points = [&link.axis[..], &triangle[..]].concat();
    let largest = points.iter().fold(0.0, |most: f64, end| most.max(end.abs().max_element()));
    let slack = 8.0 * T::UNIT * (largest + extent(&points, link.radius));
    let turn = if T::UNIT > f64::EPSILON { 8.0 } else { 1.0 };
    let beside =
        point_triangle(<f64 as Precision>::vec3(point), triangle.map(<f64 as Precision>::vec3));
    for off in [link.is_outside(point), beside.distance] {
        assert!(off <= slack * turn, "{off} of {slack}: {link:?} {triangle:?}");
    }
}

#[test]
fn triangles_deep_in_a_link_meet_it() {
    let mut random = Random::new(52);
    let mut count = [0; TRIANGLES];
    for round in 0..ROUNDS {
        let kind = round as usize % TRIANGLES;
        let (link, triangle, inside) = link_and_triangle(&mut random, kind);
        let beside = point_triangle(
            <f64 as Precision>::vec3(inside),
            triangle.map(<f64 as Precision>::vec3),
        );
        if link.depth_of(inside) < 1e-3 || beside.distance > 1e-12 {
            continue;
        }
        count[kind] += 1;
        let (pose, size) = placed(&mut random);
        let (link, triangle) =
            (link.moved(&pose, size), triangle.map(|corner| (pose * corner) * size));
        check_triangle::<f64>(&link, triangle);
        check_triangle::<f32>(&link, triangle);
    }
    println!("{count:?}");
    assert!(count.iter().all(|&count| count > ROUNDS / (4 * TRIANGLES as u32)), "{count:?}");
}
