//! How far apart the bounds of certificates lie, by the features that are nearest to each other.

use super::measure::{Problem, scaled};
use super::reference::median_and_worst;
use continuum_testing::Case;
use continuum_testing::precision::{Precision, extent, vector};
use parry_continuum::distance::{Closest, triangle_modified_cylinder};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::Certificate;
use parry_continuum::{Cap, ModifiedCylinder};
use std::collections::BTreeMap;
use std::fmt::Write;

const CAPS: [[bool; 2]; 4] = [[false; 2], [true; 2], [true, false], [false, true]];

/// Where the nearest points of triangle and link lie; None where the two meet.
type Features = Option<(&'static str, &'static str)>;

/// A triangle and a link, in lengths near one times 2^exponent.
struct Pair {
    triangle: [Vector; 3],
    ends: [Vector; 2],
    radius: f64,
    flat: [bool; 2],
    exponent: i32,
}

impl Pair {
    fn of_case(case: &Case) -> Option<Self> {
        case.is_link().then(|| Self {
            triangle: case.tri.map(Vector::from),
            ends: [case.p0, case.p1].map(Vector::from),
            radius: case.r,
            flat: case.flat(),
            exponent: 0,
        })
    }

    fn of_problem(problem: &Problem<f64>, flat: [bool; 2]) -> Self {
        let input = &problem.near_one;
        Self {
            triangle: input.triangle.map(vector),
            ends: [vector(input.start), vector(input.end)],
            radius: input.radius,
            flat,
            exponent: problem.exponent,
        }
    }

    /// The gap between the bounds in units of u x extent, and between which features; None where
    /// there is no such link.
    fn gap(&self) -> Option<(Features, f64)> {
        let Self { triangle, ends: [start, end], radius, flat, exponent } = *self;
        let large =
            |point: Vector| Vector::from_array(point.to_array().map(|x| scaled(x, exponent)));
        let caps = flat.map(|flat| if flat { Cap::Flat } else { Cap::Round });
        let link =
            ModifiedCylinder::new(large(start), large(end), scaled(radius, exponent), caps).ok()?;
        let bounds = Certificate::between(&link, &Pose::IDENTITY, triangle.map(large)).ok()?;
        let [a, b, c] = triangle;
        let extent = extent(&[a, b, c, start, end], radius);
        let unit = (extent * f64::EPSILON / 2.0).max(scaled(0.5, -1074 - exponent));
        Some((self.features(64.0 * unit), scaled(bounds.upper - bounds.lower, -exponent) / unit))
    }

    /// Which features are nearest; differences within `rounding` count as ties.
    fn features(&self, rounding: f64) -> Features {
        let Self { triangle, ends: [start, end], radius, flat, .. } = *self;
        let [from, to] = [start, end].map(f64::vec3);
        let Closest { distance, point1, point2 } =
            triangle_modified_cylinder(triangle.map(f64::vec3), from, to, radius, flat);
        if distance <= 0.0 {
            return None;
        }
        let (on_triangle, on_link) = (vector(point1), vector(point2));
        let [a, b, c] = triangle;
        let is_on = |[p, q]: [Vector; 2]| {
            let along = (q - p).normalize_or_zero();
            let offset = on_triangle - p;
            (offset - along * offset.dot(along)).length() <= rounding
        };
        let mesh = if triangle.iter().any(|&vertex| (on_triangle - vertex).length() <= rounding) {
            "vertex"
        } else if [[a, b], [b, c], [c, a]].into_iter().any(is_on) {
            "edge"
        } else {
            "interior"
        };
        let axis = (end - start).normalize_or_zero();
        let (before, beyond) = ((on_link - start).dot(axis), (on_link - end).dot(axis));
        let cap = if beyond >= -rounding {
            Some(flat[1])
        } else {
            (before <= rounding).then_some(flat[0])
        };
        let link = match cap {
            None => "barrel",
            Some(false) => "round cap",
            Some(true) => {
                let from_axis = (on_link - start - axis * before).length();
                if from_axis >= radius - rounding { "rim" } else { "flat cap" }
            }
        };
        Some((mesh, link))
    }
}

/// The gaps of certificates, by the features that are nearest.
pub struct Gaps(BTreeMap<Features, Vec<f64>>);

/// The gaps on the links of the reference cases and of the extreme problems.
pub fn measure(cases: &[Case], problems: &[Problem<f64>]) -> Gaps {
    let of_problems =
        problems.iter().flat_map(|problem| CAPS.map(|flat| Pair::of_problem(problem, flat)));
    let mut gaps: BTreeMap<Features, Vec<f64>> = BTreeMap::new();
    for (features, gap) in
        cases.iter().filter_map(Pair::of_case).chain(of_problems).filter_map(|pair| pair.gap())
    {
        gaps.entry(features).or_default().push(gap);
    }
    Gaps(gaps)
}

impl Gaps {
    /// A row for each feature of the link.
    pub fn table(&self) -> String {
        let mut text = String::from(
            "| of the link | certificates | median gap | widest gap | wider than 16 |\n|---|---|---|---|---|\n",
        );
        let mut of_links: BTreeMap<Option<&str>, Vec<f64>> = BTreeMap::new();
        for (features, gaps) in &self.0 {
            of_links.entry(features.map(|(_, link)| link)).or_default().extend(gaps);
        }
        for (link, gaps) in of_links {
            writeln!(text, "| {} | {} |", link.unwrap_or(MEETING), summary(gaps).join(" | ")).ok();
        }
        text
    }

    /// A line for each feature of the triangle with each of the link.
    pub fn lines(&self) -> String {
        let mut text = String::from(
            "of the triangle,of the link,certificates,median gap,widest gap,wider than 16\n",
        );
        for (features, gaps) in &self.0 {
            let (mesh, link) = features.unwrap_or((MEETING, ""));
            writeln!(text, "{mesh},{link},{}", summary(gaps.clone()).join(",")).ok();
        }
        text
    }
}

/// What the two shapes are called that have no nearest features.
const MEETING: &str = "(they meet)";

/// How many there are, the median, the widest, and how many are wider than 16 units.
fn summary(gaps: Vec<f64>) -> [String; 4] {
    let (count, wide) = (gaps.len(), gaps.iter().filter(|&&gap| gap > 16.0).count());
    let (median, worst) = median_and_worst(gaps).unwrap_or_default();
    [count.to_string(), format!("{median:.2}"), format!("{worst:.2}"), wide.to_string()]
}
