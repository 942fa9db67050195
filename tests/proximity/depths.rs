//! The depth of a link in a triangle: it separates, along the normal; no sampled direction takes
//! less; the dispatcher's `contact` says the same; and it changes with a motion as `rate` tells,
//! unless there is a kink.

use super::scenes::mesh_of;
use continuum_testing::narrow_phase::segment_triangle;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::shape::{TriMesh, Triangle};
use parry_continuum::proximity::{BvhSearch, Contact, LinkProximity, Proximity};
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};

const U: f64 = f64::EPSILON / 2.0;

/// A link of a robot, and a triangle.
#[derive(Clone, Debug)]
struct Placed {
    start: Vector,
    end: Vector,
    radius: f64,
    caps: [Cap; 2],
    triangle: [Vector; 3],
}

/// How link and triangle lie to each other.
const KINDS: [&str; 10] = [
    "anyhow",
    "coplanar",
    "parallel to the face",
    "along an edge",
    "upright on the face",
    "an edge on the axis",
    "a corner on the axis",
    "a corner at a cap",
    "edge-on",
    "on a lattice",
];

const FLAT: Cap = Cap::Flat;
const ROUND: Cap = Cap::Round;

impl Placed {
    fn new(random: &mut Random, kind: usize) -> Self {
        let size = [1.0, 0.05, 5.0][random.below(3) as usize];
        let mut triangle = [(); 3].map(|()| random.point() * size);
        if random.below(2) == 0 {
            triangle = triangle.map(|corner| Vector::new(corner.x, corner.y, 0.0));
        }
        let length = [1.0, 0.3, 3.0, 0.01][random.below(4) as usize];
        let radius =
            [0.0, 0.25, 0.5, 1.0, 0.01, random.between(0.01, 1.0)][random.below(6) as usize];
        let caps = [[FLAT; 2], [ROUND; 2], [FLAT, ROUND], [ROUND, FLAT]][random.below(4) as usize];
        // A small offset of either sign, or none.
        let exponent = -random.between(2.0, 14.0);
        let little = [0.0, 1.0, -1.0][random.below(3) as usize] * 10.0_f64.powf(exponent);
        let [a, b, c] = triangle;
        let [u, v] = [random.unit(), random.unit()];
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let inside = a + (b - a) * u + (c - a) * v;
        let normal = (b - a).cross(c - a).normalize();
        let along_edge = (b - a).normalize();
        let across_edge = normal.cross(along_edge);
        let in_plane =
            along_edge * random.between(-1.0, 1.0) + across_edge * random.between(-1.0, 1.0);
        let in_plane = in_plane.normalize();
        let sideways = [0.0, radius, -radius][random.below(3) as usize] + little;
        let share = [0.0, 0.5, 1.0, random.unit()][random.below(4) as usize];
        let (point, way) = match kind {
            1 => (inside, in_plane),
            2 => (inside + normal * (radius + little), in_plane),
            3 => (
                a + across_edge * sideways + normal * [0.0, radius][random.below(2) as usize],
                along_edge,
            ),
            4 => {
                let tip = if caps[0] == FLAT { 0.0 } else { radius };
                return Self::at(
                    inside + normal * (tip + little),
                    normal,
                    length,
                    radius,
                    caps,
                    triangle,
                );
            }
            5 => (a + along_edge * little, along_edge),
            6 => (a, random.direction()),
            7 => {
                let little = if little.abs() < 1e-6 { 0.0 } else { little };
                // At the start, on the rim or inside of it.
                let way = random.direction();
                let side = way.any_orthonormal_vector()
                    * radius
                    * [0.0, 0.5, 1.0][random.below(3) as usize];
                let start = a + side + way * little;
                return Self::at(start, way, length, radius, caps, triangle);
            }
            8 => (
                inside + across_edge * little,
                (normal + along_edge * [0.0, 1.0][random.below(2) as usize]).normalize(),
            ),
            9 => {
                let place = |point: Vector| (point * 4.0).round() / 4.0;
                let way = Vector::AXES[random.below(3) as usize];
                return Self::at(place(inside), way, length, radius, caps, triangle.map(place));
            }
            _ => (
                inside + random.direction() * random.between(0.0, 1.2 * radius),
                random.direction(),
            ),
        };
        Self::at(point - way * length * share, way, length, radius, caps, triangle)
    }

    fn at(
        start: Vector,
        way: Vector,
        length: f64,
        radius: f64,
        caps: [Cap; 2],
        triangle: [Vector; 3],
    ) -> Self {
        Self { start, end: start + way * length, radius, caps, triangle }
    }

    /// A robot that has the link, and which of its links it is; none if no robot has its caps.
    fn robot(&self) -> Option<(Chain, u32)> {
        let Self { start, end, radius, caps, .. } = *self;
        let (ends, along) = ([start, end], end - start);
        let made = match caps {
            [Cap::Round, Cap::Round] => Chain::capsules(&ends, &[radius]),
            [Cap::Flat, Cap::Flat] => Chain::cylinders(&ends, &[radius]),
            [Cap::Flat, Cap::Round] => {
                Chain::from_centreline(&[start, end, end + along * 2.0], &[radius; 2])
            }
            _ => {
                let aside = along.any_orthonormal_vector() * 2.0 * along.length();
                Chain::from_centreline(
                    &[start - along * 0.1 - aside, start, end],
                    &[1.5 * radius, radius],
                )
            }
        };
        let robot = made.ok()?;
        let is_it = |link: &ModifiedCylinder| {
            link.caps() == caps
                && link.start() == start
                && link.end() == end
                && link.radius() == radius
        };
        let number = robot.links().iter().position(is_it)?;
        Some((robot, number as u32))
    }

    fn mesh(&self) -> TriMesh {
        mesh_of(&[self.triangle.map(|corner| corner.to_array())])
    }

    fn contact(&self) -> Option<(Contact, LinkProximity, Chain)> {
        let (robot, number) = self.robot()?;
        let (mesh, mut out) = (self.mesh(), Vec::new());
        let mut search = BvhSearch::new(&mesh).unwrap();
        search.per_link(&robot, &Pose::IDENTITY, &mut out).unwrap();
        let answer = out[number as usize];
        Some((search.contact_of(&robot, &Pose::IDENTITY, &answer).unwrap(), answer, robot))
    }

    fn extent(&self) -> f64 {
        let points = [self.end, self.triangle[0], self.triangle[1], self.triangle[2]];
        points
            .iter()
            .map(|&point| (point - self.start).abs().max_element())
            .fold(self.radius, f64::max)
    }

    /// How far the triangle begins beyond the end of the link along a unit vector.
    fn gap(&self, n: Vector) -> f64 {
        let axis = (self.end - self.start).normalize_or_zero();
        let reach = |end: usize| {
            let (point, outward) =
                if end == 0 { (Vector::ZERO, -axis) } else { (self.end - self.start, axis) };
            let is_ball = self.caps[end] == ROUND && n.dot(outward) >= 0.0;
            point.dot(n) + self.radius * if is_ball { 1.0 } else { n.cross(axis).length() }
        };
        let begin = self.triangle.map(|corner| (corner - self.start).dot(n));
        begin[0].min(begin[1]).min(begin[2]) - reach(0).max(reach(1))
    }

    /// Directions along what is special of the two.
    fn special(&self) -> Vec<Vector> {
        let axis = (self.end - self.start).normalize_or_zero();
        let [a, b, c] = self.triangle;
        let mut special = vec![axis, (b - a).cross(c - a)];
        special.extend([b - a, c - b, a - c].iter().flat_map(|edge| [*edge, edge.cross(axis)]));
        for corner in self.triangle {
            special.extend([corner - self.start, corner - self.end]);
            let mut across = |from: Vector, line: Vector| {
                // Twice, for the digits that the first time loses.
                let once = (corner - from).reject_from_normalized(line).normalize_or_zero();
                special.push(once.reject_from_normalized(line));
            };
            across(self.start, axis);
            for edge in [b - a, c - b, a - c].into_iter().filter_map(Vector::try_normalize) {
                across(self.start, edge);
                across(self.end, edge);
            }
        }
        special
    }

    /// The same pair, its link moved.
    fn moved(&self, [start, end]: [Vector; 2], by: f64) -> Self {
        Self { start: self.start + start * by, end: self.end + end * by, ..self.clone() }
    }

    fn depth(&self) -> Option<f64> {
        Some(self.contact()?.0.depth)
    }
}

/// What the sample has seen.
#[derive(Debug, Default)]
struct Census {
    overlaps: [usize; KINDS.len()],
    without_side: usize,
    same_bits: usize,
    at_flat_caps: usize,
    wires: usize,
    smooth: usize,
    kinks: usize,
    silent_kinks: usize,
    worst_rate: f64,
}

fn judge(seed: u64, census: &mut Census) {
    let random = &mut Random::new(seed);
    let kind = seed as usize % KINDS.len();
    let placed = Placed::new(random, kind);
    let Some((contact, answer, robot)) = placed.contact() else { return };
    if answer.distance > 0.0 {
        return;
    }
    census.overlaps[kind] += 1;
    let at = || format!("seed {seed}, {}: {placed:?} {contact:?}", KINDS[kind]);
    let rounding = 16.0 * U * placed.extent();
    let depth = contact.depth;
    assert!(depth <= 0.0, "{}", at());

    // No direction needs less: drawn anywhere, next to the way out, and along what is special of
    // the two.
    let special = placed.special();
    let around = contact.normal.unwrap_or(Vector::Z);
    let drawn = (0..400).map(|_| random.direction());
    let mut near = Random::new(seed);
    let near =
        (0..100).map(|_| -around + near.direction() * 0.3_f64.powi(1 + near.below(12) as i32));
    for direction in special.iter().flat_map(|&n| [n, -n]).chain(drawn).chain(near) {
        let Some(direction) = direction.try_normalize() else { continue };
        let gap = placed.gap(direction);
        assert!(gap <= depth + rounding, "{gap} along {direction}, {}", at());
    }
    // It separates, along the normal.
    match contact.normal {
        Some(normal) => {
            // A plane through the normal as it is rounded is off by that rounding, where the
            // triangle is large: any plane that keeps the two apart will do.
            let out = placed.moved([normal; 2], -depth);
            let ways = out.special().into_iter().flat_map(|n| [n, -n]).chain([-normal]);
            let apart = ways.filter_map(Vector::try_normalize).map(|n| out.gap(n));
            let apart = apart.fold(f64::NEG_INFINITY, f64::max);
            assert!(
                apart
                    >= -2.0
                        * rounding
                        * (placed.radius / (placed.end - placed.start).length()).max(1.0),
                "still {apart}, {}",
                at()
            );
        }
        None => census.without_side += 1,
    }
    // The host's contact is the same.
    let link = robot.links()[contact.link as usize];
    let [a, b, c] = placed.triangle;
    let triangle = Triangle::new(a, b, c);
    let host =
        ContinuumDispatcher::default().contact(&Pose::IDENTITY, &link, &triangle, 1.0).unwrap();
    let host = host.unwrap_or_else(|| panic!("no contact, {}", at()));
    assert!((host.dist.min(0.0) - depth).abs() <= rounding, "{host:?}, {}", at());
    census.same_bits += usize::from(host.dist.min(0.0) == depth);
    census.wires += usize::from(placed.radius == 0.0);

    let search = BvhSearch::new(&placed.mesh()).unwrap();
    let derivative = search.derivative(&robot, &Pose::IDENTITY, &answer).unwrap();
    assert_eq!(derivative.is_some(), contact.normal.is_some(), "{}", at());
    // Closer to a corner, the depth is smooth over less than a step.
    let axis_distance =
        segment_triangle([placed.start.into(), placed.end.into()], placed.triangle.map(Vec3::from))
            .distance;
    let near_corner = (16.0 * U..1e-6).contains(&(axis_distance / placed.extent()));
    // And where another way out is hardly longer.
    let near_tie =
        special.iter().flat_map(|&n| [n, -n]).filter_map(Vector::try_normalize).any(|n| {
            (n + around).length() > 1e-6 && (rounding..1e-6).contains(&(depth - placed.gap(n)))
        });
    if let Some(derivative) = derivative.filter(|_| !near_corner && !near_tie) {
        assert_eq!(derivative.kink, contact.kink, "{}", at());
        changes(&placed, &contact, &derivative, random, census, &at);
    }
}

/// The depth changes with motions as the derivative says, and on both sides alike, unless there is
/// a kink.
fn changes(
    placed: &Placed,
    contact: &Contact,
    derivative: &parry_continuum::proximity::Derivative,
    random: &mut Random,
    census: &mut Census,
    at: &impl Fn() -> String,
) {
    let value = contact.depth;
    let along = placed.end - placed.start;
    let mut largest_jump = 0.0_f64;
    for motion in 0..8 {
        let velocity = [random.direction(), random.direction()];
        let ends = match motion % 4 {
            0 => [velocity[0]; 2],
            1 => [velocity[0], -velocity[0]],
            _ => velocity,
        };
        let rate = derivative.rate(ends[0], ends[1]);
        let turn = along.cross(ends[1] - ends[0]) / along.length_squared();
        let by_turn = contact.rate(ends[0].lerp(ends[1], contact.fraction), turn).unwrap();
        let fast =
            1.0 + (ends[1] - ends[0]).length() * (placed.radius + placed.extent()) / along.length();
        assert!((by_turn - rate).abs() < 1e-12 * fast, "{by_turn}, {rate}, {}", at());
        let (mut least, mut jump) = (f64::INFINITY, f64::INFINITY);
        for step in [1e-6, 1e-8, 1e-10] {
            let step = step * along.length().min(1.0);
            let side = |by: f64| placed.moved(ends, by).depth().map(|depth| (depth - value) / by);
            let (Some(ahead), Some(behind)) = (side(step), side(-step)) else { return };
            jump = jump.min((ahead - behind).abs() / fast);
            least = least.min((0.5 * (ahead + behind) - rate).abs() / fast);
        }
        largest_jump = largest_jump.max(jump);
        if !contact.kink {
            assert!(
                jump < 1e-2 && least < 1e-3,
                "jump {jump}, error {least}, rate {rate}, {}",
                at()
            );
            census.worst_rate = census.worst_rate.max(least);
        }
    }
    if contact.kink {
        census.kinks += 1;
        census.silent_kinks += usize::from(largest_jump < 1e-4);
    } else {
        census.smooth += 1;
    }
    census.at_flat_caps +=
        usize::from(contact.lever.cross(contact.normal.unwrap()).length() > 1e-6);
}

#[test]
fn the_depth_is_the_least_translation_and_changes_as_its_rate_says() {
    let mut census = Census::default();
    (0..rounds(10_000)).for_each(|seed| judge(seed, &mut census));
    let Census {
        overlaps,
        without_side,
        same_bits,
        at_flat_caps,
        wires,
        smooth,
        kinks,
        silent_kinks,
        ..
    } = census;
    assert!(overlaps.iter().all(|&count| count > rounds(400)), "{census:?}");
    assert!(
        without_side > rounds(1000) && at_flat_caps > rounds(800) && wires > rounds(800),
        "{census:?}"
    );
    assert!(
        smooth > rounds(2500) && kinks > rounds(1500) && same_bits > rounds(6000),
        "{census:?}"
    );
    // Triangles without area, of a lattice.
    assert!(silent_kinks < kinks / 8, "{census:?}");
}

fn contact_of(
    points: [Vector; 2],
    radius: f64,
    caps: [Cap; 2],
    triangle: [Vector; 3],
) -> (Placed, Contact) {
    let placed = Placed { start: points[0], end: points[1], radius, caps, triangle };
    let contact = placed.contact().unwrap().0;
    (placed, contact)
}

const FLOOR: [Vector; 3] =
    [Vector::new(-9.0, -9.0, 0.0), Vector::new(9.0, -9.0, 0.0), Vector::new(0.0, 9.0, 0.0)];

/// A flat tip that has gone through a wall by 0.01 is led back by that.
#[test]
fn a_flat_tip_in_a_wall_has_a_depth_and_a_way_back() {
    let (_, contact) = contact_of([Vector::new(0.0, 0.0, -0.01), Vector::Z], 0.2, [FLAT; 2], FLOOR);
    assert!((contact.depth + 0.01).abs() < 1e-15, "{contact:?}");
    assert_eq!(contact.normal, Some(Vector::Z));
    assert!((contact.rate(Vector::Z, Vector::ZERO).unwrap() - 1.0).abs() < 1e-15);
    // Tilted, its rim is deepest: by 0.2 sin(0.1), seen from the end of the axis.
    let way = Vector::new(0.1_f64.sin(), 0.0, 0.1_f64.cos());
    let (_, contact) = contact_of([Vector::ZERO, way], 0.2, [FLAT; 2], FLOOR);
    assert!((contact.depth + 0.2 * 0.1_f64.sin()).abs() < 1e-15, "{contact:?}");
    assert!((contact.normal.unwrap() - Vector::Z).length() < 1e-15 && !contact.kink);
    assert!((contact.lever.length() - 0.2).abs() < 1e-15 && contact.fraction == 0.0);
}

/// An axis that lies in a wall is on neither side of it, however it was rounded.
#[test]
fn an_axis_in_the_wall_has_no_side() {
    let mut beside = 0;
    for seed in 0..2000 {
        let random = &mut Random::new(seed);
        let (origin, across) = (random.point(), random.direction());
        let first = across.any_orthonormal_vector();
        let second = across.cross(first);
        let mut in_plane = |size: f64| {
            origin + first * random.between(-size, size) + second * random.between(-size, size)
        };
        let triangle = [in_plane(4.0), in_plane(4.0), in_plane(4.0)];
        let ends = [in_plane(1.0), in_plane(1.0)];
        let [a, b, c] = triangle;
        if (b - a).cross(c - a).length() < 2.0 {
            continue; // the plane of a sliver is not known to rounding
        }
        let radius = [0.0, 0.1][seed as usize % 2];
        let (placed, contact) = contact_of(ends, radius, [ROUND; 2], triangle);
        let (plane_depth, rounding) =
            (placed.gap(across).max(placed.gap(-across)), 64.0 * U * placed.extent());
        if contact.distance > rounding
            || plane_depth + radius < -rounding
            || (plane_depth - contact.depth).abs() > rounding
        {
            beside += 1;
            continue;
        }
        assert_eq!(contact.normal, None, "{seed}: {placed:?} {contact:?}");
    }
    assert!(beside < 1800, "{beside}");
}

/// A wire along a wall may turn either way: at its end, whose cap has no radius, as well.
#[test]
fn a_wire_along_a_wall_has_a_kink() {
    for caps in [[FLAT; 2], [ROUND; 2]] {
        let ends = [Vector::new(-0.5, 0.0, 0.3), Vector::new(0.5, 0.0, 0.3)];
        let (placed, contact) = contact_of(ends, 0.0, caps, FLOOR);
        let value = |by: f64| placed.moved([Vector::Z, -Vector::Z], by).depth().unwrap();
        let [ahead, behind] = [1e-6, -1e-6].map(|by| (value(by) - value(0.0)) / by);
        assert!((ahead - behind).abs() > 1.0, "{ahead} {behind}");
        assert!(contact.kink, "{contact:?}");
    }
}
