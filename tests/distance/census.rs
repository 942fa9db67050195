//! Every numbered case at the head of a kernel's file, and of Algorithm 1, is visited by the
//! problems that the other tests use: the reference cases and the seeded families. The case of a
//! problem follows from the geometry of the input and of the answer, in double-double arithmetic,
//! not from the library.

use continuum_testing::Random;
use continuum_testing::certificate::{Exact, Shape};
use continuum_testing::distance_cases;
use continuum_testing::kernels::Input;
use continuum_testing::narrow_phase::{segment_triangle, triangle_disc};
use continuum_testing::problems::Family;
use parry_continuum::distance::*;
use parry_continuum::parry::math::Vector;
use parry_continuum::{Cap, Chain};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// How often each case was seen: file and name, and the count in reference cases and in seeded
/// problems.
type Census = BTreeMap<(String, String), [u32; 2]>;

/// The numbered cases at the heads of the files.
fn numbered_cases() -> BTreeSet<(String, String)> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut files, mut folders) =
        (vec![source.join("robot/algorithm_1.rs")], vec![source.join("distance")]);
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(folder).expect("a directory of kernels");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let (inner, found): (Vec<_>, Vec<_>) = paths.partition(|path| path.is_dir());
        folders.extend(inner);
        files.extend(found);
    }
    let mut cases = BTreeSet::new();
    for file in files {
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&file).expect("source text");
        for line in text.lines().filter_map(|line| line.strip_prefix("//! ")) {
            let numbered =
                line.split_once(". **").filter(|(number, _)| number.parse::<u32>().is_ok());
            if let Some((case, _)) = numbered.and_then(|(_, rest)| rest.split_once("**")) {
                cases.insert((name.clone(), case.trim_end_matches('.').to_owned()));
            }
        }
    }
    cases
}

type Number = DoubleDouble;

fn exact(number: f64) -> Number {
    number.into()
}

fn is_zero(vector: Exact) -> bool {
    vector.norm_squared().rounded() == 0.0
}

/// One problem in twice the precision, with what the cases ask of it.
struct View {
    triangle: [Exact; 3],
    start: Exact,
    end: Exact,
    radius: f64,
    plane_normal: Exact,
    disc_normal: Exact,
    extent: f64,
}

impl View {
    fn new(input: &Input<f64>) -> Self {
        let extent = input.extents().into_iter().fold(0.0, f64::max);
        let precise = input.map(exact);
        Self {
            triangle: precise.triangle,
            start: precise.start,
            end: precise.end,
            radius: input.radius,
            plane_normal: precise.plane_normal,
            disc_normal: precise.disc_normal,
            extent,
        }
    }

    fn has_area(&self) -> bool {
        let [a, b, c] = self.triangle;
        !is_zero((b - a).cross(c - a))
    }

    /// Whether a point of the triangle is on none of its edges.
    fn is_interior(&self, point: Exact) -> bool {
        let [a, b, c] = self.triangle;
        let mut edges = [[a, b], [b, c], [c, a]].into_iter();
        self.has_area() && edges.all(|edge| self.off(Shape::Hull(edge.into()).distance_to(point)))
    }

    /// More than the rounding of the answers.
    fn off(&self, length: Number) -> bool {
        length.rounded() > 1e-24 * self.extent
    }

    fn segments(&self) -> &'static str {
        let [a, b, _] = self.triangle;
        let (e, f) = (self.end - self.start, b - a);
        if is_zero(e) || is_zero(f) {
            "Degenerate segments"
        } else if is_zero(e.cross(f)) {
            "Parallel lines"
        } else {
            "Skew lines"
        }
    }

    fn face(&self, seen: &mut impl FnMut(&str, &str), foot: Exact) {
        let [a, b, c] = self.triangle;
        if !self.has_area() {
            return seen("face", "Zero area");
        }
        let lengths = [(b - a), (c - b), (a - c)].map(|edge| edge.norm());
        let longest = lengths.into_iter().fold(exact(0.0), Scalar::max);
        if lengths[0] != longest {
            // As given, the third vertex is the one that is opposite to the first edge.
            seen("face", "The apex lies opposite the longest edge");
        }
        let height = (b - a).cross(c - a).norm() / longest;
        if (height / longest).rounded() < 1e-4 && self.is_interior(foot) {
            seen("face", "The coordinates are refined");
        }
    }

    fn point_disc(&self) -> &'static str {
        let relative = self.triangle[0] - self.end;
        let across = relative.cross(self.disc_normal);
        let rho = across.norm() / self.disc_normal.norm();
        if is_zero(across) {
            "On the axis"
        } else if rho.rounded() <= self.radius {
            "Above the interior"
        } else {
            "Outside"
        }
    }

    /// By the formulas of the head of `segment_disc.rs`.
    fn segment_disc(&self) -> &'static [&'static str] {
        let [a, b, _] = self.triangle;
        let (edge, normal) = (b - a, self.disc_normal.normalised());
        if is_zero(edge) {
            return &["A point"];
        }
        if is_zero(edge.cross(self.disc_normal)) {
            return &["Along the normal"];
        }
        let (direction, one, zero) = (edge.normalised(), exact(1.0), exact(0.0));
        let foot = a - self.end - direction * direction.dot(a - self.end);
        let (h, l) = (foot.dot(normal).abs(), direction.dot(normal).abs());
        let flat = direction - normal * direction.dot(normal);
        let (m, tau) = (flat.norm_squared(), foot.dot(normal.cross(flat)).abs());
        let (n, radius) = (h * l, exact(self.radius));
        let q = (foot - normal * foot.dot(normal)).norm_squared();
        let plane = if zero.lt(l) { h / l } else { exact(f64::MAX) };
        let rho_squared = q + plane * (n + n + m * plane);
        if zero.lt(l) && rho_squared.le(radius * radius) {
            return &["The line meets the plane inside the disc"];
        }
        let top = plane.min(radius * m.sqrt());
        let rho = q.sqrt();
        let turn = n.over(rho);
        let slope = l * l + m * (one - radius.over(rho)) + (radius * turn * turn).over(rho);
        let from_left = if zero.lt(slope) { (radius * n).over(rho) / slope } else { top };
        let k = (radius * m * m.sqrt()).over(tau);
        let x =
            ((k - one) * (k + one)).max(zero).sqrt() + exact((n + n).over(tau).rounded().cbrt());
        let cusp = ((x * tau - n) / m).max((radius * n).over(rho));
        if cusp.lt(from_left) && cusp.lt(top) {
            &["The line does not", "Start at the cusp"]
        } else if from_left.lt(top) {
            &["The line does not", "Start from the left"]
        } else {
            &["The line does not"]
        }
    }

    fn triangle_disc(&self) -> &'static str {
        let [a, b, c] = self.triangle;
        let radius = exact(self.radius);
        let closest = triangle_disc(self.triangle, self.end, self.disc_normal, radius);
        let normal = (b - a).cross(c - a).normalised();
        let sine = normal.cross(self.disc_normal.normalised()).norm();
        // Strictly on either side of the plane.
        let crosses = (self.end - a).dot(normal).abs().lt(radius * sine);
        match (self.is_interior(closest.point1), closest.distance.rounded() == 0.0 && crosses) {
            (false, _) => "Edges",
            (true, false) => "Face, apart",
            (true, true) => "Face, crossing",
        }
    }

    fn segment_triangle(&self) -> &'static str {
        let [a, b, c] = self.triangle;
        let closest = segment_triangle([self.start, self.end], self.triangle);
        let normal = (b - a).cross(c - a);
        let [low, high] = [self.start, self.end].map(|end| (end - a).dot(normal).rounded());
        if !self.is_interior(closest.point2) {
            "An edge"
        } else if low * high < 0.0 && closest.distance.rounded() == 0.0 {
            "Piercing"
        } else {
            "An end above the interior"
        }
    }

    /// Whether the axis point nearest to the triangle is an end.
    fn axis_ends(&self) -> [bool; 2] {
        let closest = segment_triangle([self.start, self.end], self.triangle);
        [self.start, self.end].map(|end| !self.off((closest.point1 - end).norm()))
    }

    /// Where the triangle's first vertex is along the axis: before the start, beyond the end.
    fn beyond(&self) -> [bool; 2] {
        let axis = self.end - self.start;
        let point = self.triangle[0];
        [
            (point - self.start).dot(axis).rounded() < 0.0,
            (point - self.end).dot(axis).rounded() > 0.0,
        ]
    }

    /// Where the edges' shadows are to the halves of the flat caps' shadows, seen along the edges:
    /// if link and triangle overlap.
    fn ellipses(&self, mut seen: impl FnMut(&str, &str)) {
        let (Self { triangle, start, end, .. }, radius) = (self, exact(self.radius));
        let flat = triangle_modified_cylinder(*triangle, *start, *end, radius, [true; 2]);
        if flat.distance.rounded() != 0.0 {
            return;
        }
        let axis = *end - *start;
        for (centre, outward) in [(*start, -axis), (*end, axis)] {
            for corner in 0..3 {
                let (point, edge) =
                    (triangle[corner] - centre, triangle[(corner + 1) % 3] - triangle[corner]);
                let (lean, across) = (outward.dot(edge), outward.cross(edge));
                if is_zero(across) {
                    continue;
                }
                if lean.rounded() == 0.0 {
                    seen("ellipse", "Edge-on");
                    continue;
                }
                // In the plane of both, perpendicular to the edge, as far from it as the cap faces.
                let height = point.dot(edge.cross(across).normalised());
                let case = match height.rounded() > 0.0 {
                    _ if !self.off(height.abs()) => "`p` on the long axis",
                    true => "`p` in the upper half",
                    false => "`p` in the lower half",
                };
                seen("ellipse", case);
            }
        }
    }

    fn count(&self, mut seen: impl FnMut(&str, &str)) {
        seen("segment_segment", self.segments());
        let to_point = point_triangle(self.end, self.triangle);
        seen("point_triangle", if self.is_interior(to_point.point2) { "Face" } else { "Edges" });
        self.face(&mut seen, to_point.point2);
        seen("segment_triangle", self.segment_triangle());
        if !is_zero(self.disc_normal) {
            seen("point_disc", self.point_disc());
            self.segment_disc().iter().for_each(|case| seen("segment_disc", case));
            seen("triangle_disc", self.triangle_disc());
            if !is_zero(self.plane_normal) {
                let parallel = is_zero(self.plane_normal.cross(self.disc_normal));
                seen("plane_disc", if parallel { "Parallel" } else { "Tilted" });
            }
        }
        if is_zero(self.end - self.start) {
            return;
        }
        self.ellipses(&mut seen);
        let apart = segment_triangle([self.start, self.end], self.triangle).distance;
        // The links of the kernels: both caps flat, both round, and one of each.
        let (ends, beyond) = (self.axis_ends(), self.beyond());
        for flat in [[true; 2], [false; 2], [true, false], [false, true]] {
            let at_flat = (0..2).any(|end| ends[end] && flat[end]);
            let case = if at_flat { "Flat cap" } else { "Barrel or round cap" };
            seen("triangle_modified_cylinder", case);
            if !at_flat && self.off(apart) {
                seen("foot", if apart.le(exact(self.radius)) { "Overlapping" } else { "Apart" });
            }
            let case = match (0..2).find(|&end| beyond[end]) {
                None => "Beside the barrel",
                Some(end) if flat[end] => "Beyond a flat end",
                Some(_) => "Beyond a round end",
            };
            seen("point_modified_cylinder", case);
        }
    }
}

#[derive(Deserialize)]
struct Robot {
    points: Vec<[f64; 3]>,
    segment_radius: Vec<f64>,
}

/// The case of each link's beginning on a walk, and whether it is round.
fn walk(points: &[Vector], radii: &[f64]) -> Vec<(&'static str, bool)> {
    let mut limit = points[0];
    let mut cases = vec![("First link", false)];
    for k in 1..radii.len() {
        let vec3 = |point: Vector| Vec3::from(point.to_array().map(exact));
        let (apart, radius) = (vec3(points[k]) - vec3(limit), exact(radii[k]));
        let room = (radius * radius).le(apart.norm_squared());
        cases.push(if radii[k] > radii[k - 1] {
            limit = points[k];
            ("Link thicker than the one before", false)
        } else if room {
            ("Room for a ball", true)
        } else {
            ("Too near", false)
        });
    }
    cases
}

/// Counts the cases of both walks along a robot and checks that the chain has the caps that belong
/// to them.
fn count_caps(robot: &Robot, mut seen: impl FnMut(&str, &str)) {
    let mut points: Vec<_> = robot.points.iter().map(|&point| Vector::from(point)).collect();
    let mut radii = robot.segment_radius.clone();
    let Ok(chain) = Chain::from_centreline(&points, &radii) else { return };
    if chain.links().len() != radii.len() {
        return; // repeated points
    }
    for end in 0..2 {
        let mut caps: Vec<_> = chain.links().iter().map(|link| link.caps()[end]).collect();
        if end == 1 {
            caps.reverse();
            points.reverse();
            radii.reverse();
        }
        for ((case, round), cap) in walk(&points, &radii).into_iter().zip(caps) {
            seen("algorithm_1", case);
            assert_eq!(
                cap == Cap::Round,
                round,
                "{case}: {:?} {:?}",
                robot.points,
                robot.segment_radius
            );
        }
    }
}

#[test]
fn every_numbered_case_is_visited() {
    let mut census: Census = numbered_cases().into_iter().map(|case| (case, [0; 2])).collect();
    assert!(census.len() >= 30, "the heads of the files have numbered cases: {census:?}");
    let mut count = |sample: usize, file: &str, case: &str| {
        let counts = census.get_mut(&(file.to_owned(), case.to_owned()));
        counts.unwrap_or_else(|| panic!("{file}.rs has no case '{case}'"))[sample] += 1;
    };
    for case in distance_cases() {
        // Near one, so that the fourth powers of the geometry stay in range.
        let unit = (case.scale.max(case.mag)).power_of_two_to_unity();
        let input = Input::from(&case).map(|x| x * unit);
        View::new(&input).count(|file, name| count(0, file, name));
    }
    let mut random = Random::new(17);
    for family in Family::ALL {
        for _ in 0..150 {
            let input = Input::from(&random.problem(family, -16.0));
            View::new(&input).count(|file, name| count(1, file, name));
        }
    }
    for robot in continuum_testing::read_lines::<Robot>(include_str!("../data/algorithm1.jsonl")) {
        count_caps(&robot, |file, name| count(0, file, name));
    }
    for ((file, case), [reference, seeded]) in &census {
        println!("{file}: {case}: {reference} and {seeded}");
    }
    for ((file, case), counts) in &census {
        assert!(counts.iter().sum::<u32>() > 0, "{file}: nothing visits '{case}'");
    }
}
