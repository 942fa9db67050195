//! Algorithm 1: which ends of a chain's links are round, and what becomes of repeated points and
//! bad input.
//!
//! Expected caps come from an implementation of the paper's text that is not ours
//! (tests/data/algorithm1.jsonl: the paper's figures and random robots), and for the named tests
//! from working through the figures by hand.

use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::{Cap, Chain, ModifiedCylinder, RobotError};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    name: String,
    points: Vec<[Real; 3]>,
    segment_radius: Vec<Real>,
    /// Per segment: round at its start, at its end.
    sb: Vec<bool>,
    sf: Vec<bool>,
    vertex_radius: Option<Vec<Real>>,
    /// Per vertex, by the rule as printed.
    lb: Option<Vec<bool>>,
    lf: Option<Vec<bool>>,
    min_rule_radius: Option<Vec<Real>>,
    min_rule_sb: Option<Vec<bool>>,
    min_rule_sf: Option<Vec<bool>>,
}

impl Case {
    fn points(&self, scale: Real) -> Vec<Vector> {
        self.points.iter().map(|&point| Vector::from(point) * scale).collect()
    }

    fn has_repeated_points(&self) -> bool {
        self.points.windows(2).any(|ends| ends[0] == ends[1])
    }
}

fn cases() -> Vec<Case> {
    include_str!("../data/algorithm1.jsonl")
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

fn scaled(radii: &[Real], scale: Real) -> Vec<Real> {
    radii.iter().map(|radius| radius * scale).collect()
}

/// A chain's round starts and round ends as letters, e.g. "FTTT TTTF".
fn flags(chain: &Chain) -> String {
    let letters = |end: usize| -> String {
        chain
            .links()
            .iter()
            .map(|link| if link.caps()[end] == Cap::Round { 'T' } else { 'F' })
            .collect()
    };
    format!("{} {}", letters(0), letters(1))
}

/// A straight robot along x whose points are `spacing` apart.
fn straight(spacing: Real, segments: usize) -> Vec<Vector> {
    (0..=segments).map(|i| Vector::X * (spacing * i as Real)).collect()
}

/// A robot bent at a constant radius, with points `spacing` apart along the arc.
fn bent(spacing: Real, bend_radius: Real, segments: usize) -> Vec<Vector> {
    let arc = |i| (spacing * i as Real / bend_radius).sin_cos();
    (0..=segments)
        .map(arc)
        .map(|(sin, cos)| Vector::new(sin, 1.0 - cos, 0.0) * bend_radius)
        .collect()
}

fn centreline(points: &[Vector], radii: &[Real]) -> String {
    flags(&Chain::from_centreline(points, radii).unwrap())
}

fn vertices(points: &[Vector], radii: &[Real]) -> String {
    flags(&Chain::from_vertex_radii(points, radii).unwrap())
}

fn repeat<const N: usize>(runs: [(Real, usize); N]) -> Vec<Real> {
    runs.iter().flat_map(|&(radius, count)| std::iter::repeat_n(radius, count)).collect()
}

/// The one segment with a length in each link, and that the links cover all segments in order.
fn segments_with_length(chain: &Chain, points: &[Vector]) -> Vec<usize> {
    let mut covered = 0;
    let segments = (0..chain.links().len())
        .map(|link| {
            let range = chain.segments_of(link);
            assert_eq!(range.start, covered);
            covered = range.end;
            let mut with_length = range.filter(|&k| points[k] != points[k + 1]);
            let segment = with_length.next().expect("a link stands for a segment with length");
            assert_eq!(with_length.next(), None);
            segment
        })
        .collect();
    assert_eq!(covered, points.len() - 1);
    segments
}

/// Each link is its segment with these caps. `sb` and `sf` are per input segment.
fn assert_links(
    name: &str,
    chain: &Chain,
    points: &[Vector],
    radii: &[Real],
    sb: &[bool],
    sf: &[bool],
) {
    let segments = segments_with_length(chain, points);
    let with_length = points.windows(2).filter(|ends| ends[0] != ends[1]).count();
    assert_eq!(segments.len(), with_length, "{name}");
    for (link, k) in chain.links().iter().zip(segments) {
        let cap = |round: bool| if round { Cap::Round } else { Cap::Flat };
        let expected =
            ModifiedCylinder::new(points[k], points[k + 1], radii[k], [cap(sb[k]), cap(sf[k])])
                .unwrap();
        assert_eq!(*link, expected, "{name}, segment {k}");
    }
}

#[test]
fn every_reference_case_by_segment_radii() {
    let (mut count, mut repeated) = (0, 0);
    for case in cases() {
        let points = case.points(1.0);
        let chain = Chain::from_centreline(&points, &case.segment_radius).unwrap();
        assert_links(&case.name, &chain, &points, &case.segment_radius, &case.sb, &case.sf);
        count += 1;
        repeated += usize::from(case.has_repeated_points());
    }
    assert!(count >= 78 && repeated >= 8, "{count} cases, {repeated} with repeated points");
}

#[test]
fn every_reference_case_by_vertex_radii() {
    let (mut count, mut named) = (0, 0);
    for case in cases() {
        let (Some(radii), Some(lb), Some(lf)) = (&case.vertex_radius, &case.lb, &case.lf) else {
            continue;
        };
        let points = case.points(1.0);
        let chain = Chain::from_vertex_radii(&points, radii).unwrap();
        let smaller: Vec<_> = radii.windows(2).map(|r| r[0].min(r[1])).collect();
        assert_links(&case.name, &chain, &points, &smaller, lb, &lf[1..]);
        count += 1;
        if let (Some(radius), Some(sb), Some(sf)) =
            (&case.min_rule_radius, &case.min_rule_sb, &case.min_rule_sf)
        {
            assert_links(&case.name, &chain, &points, radius, sb, sf);
            named += 1;
        }
    }
    assert!(count >= 65 && named >= 10, "{count} cases, {named} with the radii spelt out");
}

#[test]
fn caps_do_not_depend_on_the_unit() {
    for exponent in [-300, -41, 300] {
        let scale = Real::powi(2.0, exponent);
        for case in cases() {
            let (points, radii) = (case.points(scale), scaled(&case.segment_radius, scale));
            let chain = Chain::from_centreline(&points, &radii).unwrap();
            assert_links(&case.name, &chain, &points, &radii, &case.sb, &case.sf);
        }
    }
}

#[test]
fn figure_7a_cylinders_and_7b_capsules() {
    let (points, radii) = (bent(1.5, 6.0, 4), [1.0; 4]);
    assert_eq!(flags(&Chain::cylinders(&points, &radii).unwrap()), "FFFF FFFF");
    assert_eq!(flags(&Chain::capsules(&points, &radii).unwrap()), "TTTT TTTT");
}

#[test]
fn figure_7e_spacing_above_the_radius() {
    assert_eq!(centreline(&straight(1.5, 4), &[1.0; 4]), "FTTT TTTF");
    assert_eq!(centreline(&bent(1.5, 6.0, 4), &[1.0; 4]), "FTTT TTTF");
}

#[test]
fn figure_7f_spacing_below_the_radius() {
    for points in [straight(0.4, 8), bent(0.4, 2.0, 8)] {
        assert_eq!(centreline(&points, &[1.0; 8]), "FFFTTTTT TTTTTFFF");
        assert_eq!(vertices(&points, &[1.0; 9]), "FFFTTTTT TTTTTFFF");
    }
}

#[test]
fn figure_7c_is_not_what_algorithm_1_gives() {
    // Round everywhere but at the two ends: the first caps stick out of the flat face.
    assert_ne!(centreline(&straight(0.4, 8), &[1.0; 8]), "FTTTTTTT TTTTTTTF");
}

#[test]
fn figures_7g_and_8_three_tubes() {
    let points = bent(1.0, 6.0, 9);
    let expected = "FFTTTTTTT TFFTFFTTF";
    assert_eq!(centreline(&points, &repeat([(1.5, 3), (1.0, 3), (0.5, 3)])), expected);
    assert_eq!(vertices(&points, &repeat([(1.5, 4), (1.0, 3), (0.5, 3)])), expected);
    // Spacing above every radius: flat at the base, at both steps and at the tip, as the paper
    // counts.
    let expected = "FTTTTTTTT TTFTTFTTF";
    assert_eq!(centreline(&bent(2.0, 12.0, 9), &repeat([(1.5, 3), (1.0, 3), (0.5, 3)])), expected);
}

#[test]
fn steps_up() {
    let radii = repeat([(0.5, 3), (1.0, 3)]);
    assert_eq!(centreline(&straight(0.7, 6), &radii), "FTTFFT TTTTFF");
    let radii = repeat([(0.5, 3), (1.0, 3), (0.5, 3)]);
    assert_eq!(centreline(&straight(0.6, 9), &radii), "FTTFFTTTT TTTTFFTTF");
}

#[test]
fn where_the_printed_rule_differs() {
    // After a thick tube shorter than its radius.
    let points = straight(1.0, 4);
    assert_eq!(&vertices(&points, &[2.0, 2.0, 1.0, 1.0, 1.0])[..4], "FFTT");
    assert_eq!(&centreline(&points, &[2.0, 1.0, 1.0, 1.0])[..4], "FTTT");
    // Around a lone thick vertex.
    let points = straight(3.0, 2);
    assert_eq!(vertices(&points, &[1.0, 2.0, 1.0]), "FF FF");
    assert_eq!(centreline(&points, &[1.0, 1.0]), "FT TF");
}

#[test]
fn wires_and_single_segments() {
    assert_eq!(centreline(&straight(1.0, 2), &[0.0; 2]), "FT TF");
    assert_eq!(centreline(&straight(1.0, 1), &[0.3]), "F F");
    assert_eq!(vertices(&straight(1.0, 1), &[0.3, 0.5]), "F F");
}

/// Joints exactly one radius from the limit are round, and a little nearer they are not. The
/// squares of the lengths 3 m, 4 m, 5 m are exact.
#[test]
fn ties_of_exact_squares_are_round() {
    assert_eq!(centreline(&straight(1.0, 2), &[1.0; 2]), "FT TF");
    let corner = Vector::new(3.0, 4.0, 0.0);
    for i in 0..100_u32 {
        let m = Real::from(2 * i + 1) * 12_345.0;
        for exponent in [-300, 0, 250] {
            let m = m * Real::powi(2.0, exponent);
            let (points, radius) = ([Vector::ZERO, corner * m, corner * (2.0 * m)], 5.0 * m);
            assert_eq!(centreline(&points, &[radius; 2]), "FT TF", "m = {m}");
            assert_eq!(centreline(&points, &[radius * (1.0 + 1e-15); 2]), "FF FF", "m = {m}");
        }
    }
}

#[test]
fn the_extremes_of_the_accepted_range() {
    for scale in [1e150, Real::MIN_POSITIVE * 16.0] {
        let points = [-1.0, 0.0, 1.0].map(|x| Vector::new(x, x, x) * scale);
        assert_eq!(centreline(&points, &[scale; 2]), "FT TF");
        let points = [0.0, 0.25, 0.5].map(|x| Vector::X * (x * scale));
        assert_eq!(centreline(&points, &[scale; 2]), "FF FF");
    }
    // A tiny robot far out along another coordinate.
    let points = [0.0, 1.0, 2.0].map(|x| Vector::new(x * 1e-300, -1e149, 1e149));
    assert_eq!(centreline(&points, &[1e-300; 2]), "FT TF");
    assert_eq!(centreline(&points, &[1.5e-300; 2]), "FF FF");
    assert_eq!(centreline(&points, &[0.0; 2]), "FT TF");
}

#[test]
fn repeating_points_changes_no_link() {
    let mut with_zero_radius = 0;
    for case in cases().iter().filter(|case| !case.has_repeated_points()) {
        let (points, radii) = (case.points(1.0), &case.segment_radius);
        let plain = Chain::from_centreline(&points, radii).unwrap();
        with_zero_radius += usize::from(radii.contains(&0.0));
        // Each point twice; what lies between them has the radius of the segment before, or after.
        let doubled: Vec<_> = points.iter().flat_map(|&point| [point, point]).collect();
        let last = radii.len() - 1;
        let before =
            (0..doubled.len() - 1).map(|i| radii[if i == 0 { 0 } else { (i - 1) / 2 }]).collect();
        let after = (0..doubled.len() - 1).map(|i| radii[(i / 2).min(last)]).collect();
        for doubled_radii in [before, after] as [Vec<Real>; 2] {
            let chain = Chain::from_centreline(&doubled, &doubled_radii).unwrap();
            assert_eq!(chain.links(), plain.links(), "{}", case.name);
            segments_with_length(&chain, &doubled);
        }
    }
    assert!(with_zero_radius > 0);
}

#[test]
fn a_repeated_point_with_a_wider_radius_is_no_step() {
    let points = [0.0, 2.0, 2.0, 4.0].map(|x| Vector::X * x);
    assert_eq!(centreline(&points, &[1.0, 3.0, 1.0]), "FT TF");
    assert_eq!(centreline(&points, &[1.0, 1.0, 1.0]), "FT TF");
}

#[test]
fn segments_of_says_where_a_link_comes_from() {
    let points = [0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0].map(|x| Vector::X * x);
    for chain in [
        Chain::from_centreline(&points, &[0.1; 7]),
        Chain::from_vertex_radii(&points, &[0.1; 8]),
        Chain::capsules(&points, &[0.1; 7]),
        Chain::cylinders(&points, &[0.1; 7]),
    ] {
        let chain = chain.unwrap();
        let ranges: Vec<_> = (0..4).map(|link| chain.segments_of(link)).collect();
        assert_eq!(ranges, [0..2, 2..5, 5..7, 0..0]);
    }
}

/// Every constructor of a chain on the same points, from per-segment radii that it widens to its
/// own needs.
fn all_errors(points: &[Vector], radii: &[Real]) -> Vec<RobotError> {
    let per_vertex: Vec<_> = radii.iter().copied().chain(radii.last().copied()).collect();
    vec![
        Chain::from_centreline(points, radii).unwrap_err(),
        Chain::capsules(points, radii).unwrap_err(),
        Chain::cylinders(points, radii).unwrap_err(),
        Chain::from_vertex_radii(points, &per_vertex).unwrap_err(),
    ]
}

#[test]
fn bad_input_is_named() {
    let good = straight(1.0, 3);
    let with = |value: Real| {
        let mut points = good.clone();
        points[2].y = value;
        points
    };
    for (points, radii, words) in [
        (vec![], vec![], vec!["at least 2", "0"]),
        (straight(1.0, 0), vec![], vec!["at least 2", "1"]),
        (with(Real::NAN), vec![0.1; 3], vec!["point 2", "NaN"]),
        (with(Real::NEG_INFINITY), vec![0.1; 3], vec!["point 2", "-inf"]),
        (with(2e150), vec![0.1; 3], vec!["point 2", "2e150", "1e150"]),
        (good.clone(), vec![0.1, -0.5, 0.1], vec!["radius 1", "-0.5"]),
        (good.clone(), vec![0.1, Real::NAN, 0.1], vec!["radius 1", "NaN"]),
        (good.clone(), vec![0.1, 0.1, Real::INFINITY], vec!["radius 2", "inf"]),
        (good.clone(), vec![0.1, 0.1, 1.5e150], vec!["radius 2", "1.5e150", "1e150"]),
        (vec![Vector::X; 4], vec![0.1; 3], vec!["all points"]),
    ] {
        for error in all_errors(&points, &radii) {
            let message = error.to_string();
            assert!(
                words.iter().all(|word| message.contains(word)),
                "{message} lacks one of {words:?}"
            );
        }
    }
    let per_segment = "; give one for each segment between two points";
    let per_point = "; give one for each point";
    for (points, expected, radii, end, error) in [
        (4, 3, 4, per_segment, Chain::from_centreline(&good, &[0.1; 4]).unwrap_err()),
        (4, 3, 2, "`segment_radii`", Chain::capsules(&good, &[0.1; 2]).unwrap_err()),
        (4, 3, 0, "`segment_radii`", Chain::cylinders(&good, &[]).unwrap_err()),
        (4, 4, 3, per_point, Chain::from_vertex_radii(&good, &[0.1; 3]).unwrap_err()),
    ] {
        assert!(error.to_string().ends_with(end), "{error}");
        let parameter = if expected == 4 { "vertex_radii" } else { "segment_radii" };
        assert_eq!(error, RobotError::LengthsDiffer { parameter, points, expected, radii });
    }
    let error = ModifiedCylinder::cylinder(Vector::X, Vector::X, 1.0).unwrap_err();
    assert!(error.to_string().contains("length 0"));
}

#[test]
fn chains_with_equal_links_are_equal() {
    let points = straight(1.0, 3);
    let chain = Chain::from_centreline(&points, &[0.1; 3]).unwrap();
    assert_eq!(chain, chain.clone());
    assert_ne!(chain, Chain::capsules(&points, &[0.1; 3]).unwrap());
}

/// The radii of a rod simulator differ in their last digits. They are no steps, and each link keeps
/// its own.
#[test]
fn radii_that_differ_by_rounding_are_no_steps() {
    let points: Vec<_> = (0..40)
        .map(|k| f64::from(k) * 0.05)
        .map(|a| Vector::new(1.0 - a.cos(), 0.0, a.sin()) * 20.0)
        .collect();
    let constant = Chain::from_centreline(&points, &[0.5; 39]).unwrap();
    let radii: Vec<_> = (0..39).map(|k| 0.5 * (1.0 + 1e-13 * f64::from(k * 7 % 5))).collect();
    let rounded = Chain::from_centreline(&points, &radii).unwrap();
    for ((a, b), radius) in constant.links().iter().zip(rounded.links()).zip(radii) {
        assert_eq!((a.caps(), radius), (b.caps(), b.radius()));
    }
    let steps: Vec<_> = (0..39).map(|k| 0.5 * (1.0 + 1e-8 * f64::from(k * 7 % 5))).collect();
    let stepped = Chain::from_centreline(&points, &steps).unwrap();
    assert!(stepped.links().iter().zip(constant.links()).any(|(a, b)| a.caps() != b.caps()));
}

/// A segment without length is no link, so its radius makes no step.
#[test]
fn a_segment_without_length_makes_no_face() {
    let points = [0.0, 1.0, 1.0, 2.0, 3.0].map(|z| Vector::Z * z);
    let without = [0.0, 1.0, 2.0, 3.0].map(|z| Vector::Z * z);
    for radius in [0.1, 0.2, 0.9] {
        let chain = Chain::from_centreline(&points, &[0.2, radius, 0.2, 0.2]).unwrap();
        let expected = Chain::from_centreline(&without, &[0.2; 3]).unwrap();
        assert_eq!(chain.links(), expected.links(), "{radius}");
    }
    // At both ends of the robot too.
    let points = [0.0, 0.0, 1.0, 2.0, 2.0].map(|z| Vector::Z * z);
    let chain = Chain::from_centreline(&points, &[0.9, 0.2, 0.2, 0.9]).unwrap();
    let expected = Chain::from_centreline(&without[..3], &[0.2; 2]).unwrap();
    assert_eq!(chain.links(), expected.links());
}
