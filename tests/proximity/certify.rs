//! The library's certificates: bounds that hold on the reference cases, that are tight, and that
//! catch a wrong answer.

use continuum_testing::narrow_phase::triangle_modified_cylinder;
use continuum_testing::precision::Precision;
use continuum_testing::problems::{Family, Problem};
use continuum_testing::{Random, distance_cases, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::*;
use parry_continuum::{Cap, Chain, ModifiedCylinder};

const UNIT: Real = Real::EPSILON / 2.0;

fn link_of(start: Vector, end: Vector, radius: Real, flat: [bool; 2]) -> ModifiedCylinder {
    let cap = |flat: bool| if flat && start != end { Cap::Flat } else { Cap::Round };
    ModifiedCylinder::new(start, end, radius, flat.map(cap)).unwrap()
}

/// The bounds of reference cases: how far apart they are at most, and how many cases of each kind
/// there were.
#[derive(Debug, Default)]
pub struct Tally {
    pub apart: usize,
    pub nearly_touching: usize,
    pub touching: usize,
    /// In units in the last place of a case's extent.
    widest: f64,
}

impl Tally {
    /// The reference, to 30 digits, lies between the bounds, and they lie within 16 units of each
    /// other.
    pub fn hold(&mut self, case: &str, expected: f64, scale: f64, bounds: Certificate) {
        let Certificate { lower, upper, .. } = bounds;
        assert!(
            lower <= expected && expected <= upper,
            "{case}: {expected} not in [{lower}, {upper}]"
        );
        let gap = (upper - lower) / (UNIT * scale);
        assert!(gap <= 16.0, "{case}: {gap} units in [{lower}, {upper}]");
        self.widest = self.widest.max(gap);
    }

    /// Takes note of a case whose distance is such a share of its extent.
    pub fn count(&mut self, relative: f64) {
        *match relative {
            0.0 => &mut self.touching,
            relative if relative < 1e-6 => &mut self.nearly_touching,
            _ => &mut self.apart,
        } += 1;
    }
}

/// The reference, to 30 digits, lies between the bounds, and they lie within 16 units of each
/// other.
#[test]
fn the_reference_cases_lie_within_tight_bounds() {
    let mut tally = Tally::default();
    for case in &distance_cases() {
        if !case.is_link() {
            continue;
        }
        let link = link_of(case.p0.into(), case.p1.into(), case.r, case.flat());
        let bounds =
            Certificate::between(&link, &Pose::IDENTITY, case.tri.map(Vector::from)).unwrap();
        tally.hold(&format!("{} {}", case.id, case.cat), case.distance(), case.scale, bounds);
        tally.count(case.distance() / case.scale);
    }
    println!("{tally:?}");
    assert!(tally.apart > 300 && tally.nearly_touching > 20 && tally.touching > 50);
}

/// Both ends of a link much shorter than its radius are as near as rounding can tell; the caps
/// still differ.
#[test]
fn links_much_shorter_than_their_radius() {
    let mut random = Random::new(41);
    let (mut apart, mut touching) = (0, 0);
    for round in 0..4000 {
        let length = 10.0_f64.powi(-(round % 18));
        let (start, axis) = (random.point(), random.direction());
        let flat = [[false, true], [true, false], [true, true]][random.below(3) as usize];
        let link = link_of(start, start + axis * length, random.between(0.1, 1.0), flat);
        let triangle = [random.point(), random.point(), random.point()].map(|v| v * 2.0);
        let bounds = Certificate::between(&link, &Pose::IDENTITY, triangle).unwrap();
        let found = kernel_distance(triangle, &link);
        let slack = 16.0 * UNIT * 4.0;
        assert!(bounds.upper - bounds.lower <= slack, "length {length}: {bounds:?}");
        assert!(
            bounds.lower - slack <= found && found <= bounds.upper + slack,
            "length {length}: {found} {bounds:?}"
        );
        if found > 0.0 { apart += 1 } else { touching += 1 }
    }
    assert!(apart > 1000 && touching > 500, "{apart} apart, {touching} touching");
}

/// A triangle of a random problem, its link, and the problem's extent.
fn random_pair(random: &mut Random, family: Family) -> ([Vector; 3], ModifiedCylinder, Real) {
    let Problem { triangle, start, end, radius, .. } = random.problem(family, -17.0);
    let flat = [random.below(2) == 0, random.below(2) == 0];
    let points = [triangle[0], triangle[1], triangle[2], start, end];
    (
        triangle,
        link_of(start, end, radius, flat),
        continuum_testing::precision::extent(&points, radius),
    )
}

#[test]
fn nasty_pairs_have_tight_bounds_around_the_kernels_answer() {
    let mut random = Random::new(5);
    let (mut count, mut widest) = (0, 0.0_f64);
    for family in Family::ALL {
        for _ in 0..300 {
            let (triangle, link, extent) = random_pair(&mut random, family);
            let Certificate { lower, upper, .. } =
                Certificate::between(&link, &Pose::IDENTITY, triangle).unwrap();
            let unit = UNIT * extent;
            assert!(0.0 <= lower && lower <= upper);
            assert!(upper - lower <= 16.0 * unit, "{family:?}: {} units", (upper - lower) / unit);
            let found = kernel_distance(triangle, &link);
            assert!(
                lower - 16.0 * unit <= found && found <= upper + 16.0 * unit,
                "{family:?}: {found}"
            );
            if extent > 0.0 {
                widest = widest.max((upper - lower) / unit);
                count += 1;
            }
        }
    }
    println!("widest gap {widest:.2} units in {count} pairs");
    assert!(count > 2000);
}

/// The narrow phase's answer.
fn kernel_distance(triangle: [Vector; 3], link: &ModifiedCylinder) -> Real {
    let flat = link.caps().map(|cap| cap == Cap::Flat);
    let (start, end) = (f64::vec3(link.start()), f64::vec3(link.end()));
    triangle_modified_cylinder(triangle.map(f64::vec3), start, end, link.radius(), flat).distance
}

fn strewn_mesh(random: &mut Random, count: usize) -> TriMesh {
    let mut vertices = Vec::new();
    for _ in 0..count {
        let centre = random.direction() * random.between(0.5, 3.0);
        vertices.extend((0..3).map(|_| centre + random.direction() * random.between(0.0, 0.4)));
    }
    let indices = (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriMesh::new(vertices, indices).unwrap()
}

fn random_robot(random: &mut Random) -> Chain {
    let mut points = vec![Vector::ZERO];
    for place in 0..6 {
        points.push(points[place] + random.direction() * 0.2);
    }
    Chain::from_centreline(&points, &[0.1, 0.1, 0.08, 0.08, 0.05, 0.05]).unwrap()
}

/// The engines' answers are the least of the whole mesh; any other triangle's is found out.
#[test]
fn wrong_answers_are_found_out() {
    let mut random = Random::new(21);
    let (mut right, mut wrong) = (0, 0);
    for _ in 0..rounds(20) {
        let mesh = strewn_mesh(&mut random, 300);
        let (robot, pose) = (random_robot(&mut random), random.pose(0.5));
        let mut answers = Vec::new();
        BvhSearch::new(&mesh).unwrap().per_link(&robot, &pose, &mut answers).unwrap();
        for mut answer in answers {
            let Certificate { lower, upper, .. } =
                answer.certify_among_all(&robot, &pose, &mesh).unwrap();
            let slack = 16.0 * UNIT * 8.0;
            assert!(lower - slack <= answer.distance && answer.distance <= upper + slack);
            assert!(upper - lower <= slack);
            right += u32::from(lower > 0.0);
            // The answer that there is about another triangle.
            let other = (answer.witness.triangle + 1) % mesh.num_triangles() as u32;
            let corners = mesh.triangle(other).vertices().to_owned();
            let mut of_other = Vec::new();
            let alone = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]);
            alone.unwrap().per_link(&robot, &pose, &mut of_other).unwrap();
            answer = of_other[answer.link as usize];
            answer.witness.triangle = other;
            let pair = answer.certify(&robot, &pose, &mesh).unwrap();
            if pair.lower > upper {
                let all = answer.certify_among_all(&robot, &pose, &mesh).unwrap();
                assert!(all.upper < pair.lower && all.lower <= lower + slack, "{all:?} {pair:?}");
                wrong += 1;
            }
        }
    }
    assert!(right > rounds(30) && wrong > rounds(80), "{right} right, {wrong} wrong");
}

#[test]
fn bounds_scale_with_the_problem() {
    let mut random = Random::new(33);
    for _ in 0..200 {
        let family = Family::ALL[random.below(13) as usize];
        let (triangle, link, _) = random_pair(&mut random, family);
        let plain = Certificate::between(&link, &Pose::IDENTITY, triangle).unwrap();
        for power in [-400, -60, 60, 400] {
            let factor = (2.0_f64).powi(power);
            let scaled = ModifiedCylinder::new(
                link.start() * factor,
                link.end() * factor,
                link.radius() * factor,
                link.caps(),
            )
            .unwrap();
            let bounds =
                Certificate::between(&scaled, &Pose::IDENTITY, triangle.map(|v| v * factor))
                    .unwrap();
            assert_eq!(bounds.upper, plain.upper * factor);
            assert_eq!(bounds.lower, plain.lower * factor);
        }
    }
}

#[test]
fn what_does_not_exist_or_is_not_finite_is_an_error() {
    let mut random = Random::new(3);
    let mesh = strewn_mesh(&mut random, 4);
    let robot = random_robot(&mut random);
    let answer = BvhSearch::new(&mesh).unwrap().minimum(&robot, &Pose::IDENTITY).unwrap();
    let nan = Pose::from_translation(Vector::new(0.0, f64::NAN, 0.0));
    let far = Pose::from_translation(Vector::X * 1e200);
    let certify =
        |answer: &LinkProximity, pose: &Pose| answer.certify(&robot, pose, &mesh).unwrap_err();
    assert_eq!(certify(&answer, &nan), ProximityError::Pose(PlacementFault::PoseNotFinite));
    assert!(matches!(
        certify(&answer, &far),
        ProximityError::Pose(PlacementFault::OutOfRange { .. })
    ));
    let mut other = answer;
    other.link = 6;
    assert_eq!(certify(&other, &Pose::IDENTITY), ProximityError::NoSuchLink { link: 6, links: 6 });
    other = answer;
    other.witness.triangle = 4;
    let missing = ProximityError::NoSuchTriangle { triangle: 4, triangles: 4 };
    assert_eq!(certify(&other, &Pose::IDENTITY), missing);
    let bad = Certificate::between(
        &robot.links()[0],
        &Pose::IDENTITY,
        [Vector::ZERO, Vector::NAN, Vector::X],
    );
    assert!(matches!(bad, Err(ProximityError::Mesh(MeshError::NotFinite { vertex: 1, .. }))));
}
