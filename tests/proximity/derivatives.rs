//! Derivatives of the distance: against differences at 32 digits on the reference cases, and
//! against differences of a robot's own distance along its joints.

use super::scenes::mesh_of;
use continuum_testing::narrow_phase::{segment_triangle, triangle_modified_cylinder};
use continuum_testing::{Case, Random, distance_cases, rounds};
use parry_continuum::distance::{DoubleDouble, Scalar, Vec3};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{
    BvhSearch, Contact, ContactFeature, Derivative, Exhaustive, LinkFeature, LinkProximity,
    Proximity,
};
use parry_continuum::{Cap, Chain};

type Point = Vec3<DoubleDouble>;

/// The numbers that a link and a triangle are made of: start, end, three corners, radius.
#[derive(Clone)]
struct Numbers {
    points: [Point; 5],
    radius: DoubleDouble,
    flat: [bool; 2],
}

impl Numbers {
    fn new(case: &Case, flat: [bool; 2]) -> Self {
        let point = |[x, y, z]: [f64; 3]| Vec3::new(x.into(), y.into(), z.into());
        let [a, b, c] = case.tri.map(point);
        Self { points: [point(case.p0), point(case.p1), a, b, c], radius: case.r.into(), flat }
    }

    /// Changes one of the sixteen numbers.
    fn moved(&self, number: usize, by: f64) -> Self {
        let mut moved = self.clone();
        let Some(point) = moved.points.get_mut(number / 3) else {
            moved.radius = moved.radius + by.into();
            return moved;
        };
        let coordinate = match number % 3 {
            0 => &mut point.x,
            1 => &mut point.y,
            _ => &mut point.z,
        };
        *coordinate = *coordinate + by.into();
        moved
    }

    /// The axis distance less the radius, or the distance itself.
    fn value(&self, is_depth: bool) -> DoubleDouble {
        let [start, end, a, b, c] = self.points;
        if is_depth {
            segment_triangle([start, end], [a, b, c]).distance - self.radius
        } else {
            triangle_modified_cylinder([a, b, c], start, end, self.radius, self.flat).distance
        }
    }
}

/// The answer about a case's link, which is the first of a chain whose caps are the case's; none if
/// there is no such chain.
fn answer(case: &Case) -> Option<(LinkProximity, Chain, TriMesh)> {
    let (start, end) = (Vector::from(case.p0), Vector::from(case.p1));
    let wanted = case.flat().map(|flat| if flat { Cap::Flat } else { Cap::Round });
    let beyond = end + (end - start) * 2.0;
    let made = match wanted {
        [Cap::Round, Cap::Round] => Chain::capsules(&[start, end], &[case.r]),
        [Cap::Flat, Cap::Flat] => Chain::cylinders(&[start, end], &[case.r]),
        [Cap::Flat, Cap::Round] => Chain::from_centreline(&[start, end, beyond], &[case.r; 2]),
        [Cap::Round, Cap::Flat] => return None,
    };
    let robot = made.ok().filter(|robot| robot.links()[0].caps() == wanted)?;
    let mesh = mesh_of(&[case.tri]);
    let mut out = Vec::new();
    BvhSearch::new(&mesh).unwrap().per_link(&robot, &Pose::IDENTITY, &mut out).unwrap();
    Some((out[0], robot, mesh))
}

/// Whether a contact is at a flat cap of its link.
fn is_at_flat_cap(contact: &Contact, robot: &Chain) -> bool {
    let [start, end] = robot.links()[contact.link as usize].caps().map(|cap| cap == Cap::Flat);
    match contact.feature.link {
        LinkFeature::StartCap => start,
        LinkFeature::EndCap => end,
        LinkFeature::Side => false,
    }
}

fn components(derivative: &Derivative) -> Vec<f64> {
    let [a, b, c] = derivative.vertices;
    let points = [derivative.start, derivative.end, a, b, c];
    points.iter().flat_map(|point| point.to_array()).chain([derivative.radius]).collect()
}

/// Every coordinate of the reference cases, against central differences with 32 digits. A step of
/// 1e-9 of the gap (or of a short link) is
/// exact where the distance is smooth. A step of 3e-16 is exact where a closest point passes to
/// another feature and the second derivative jumps. The derivative must equal a difference that a
/// step twice as long confirms. Where the two sides differ there is a kink.
#[test]
fn every_case_within_64_units() {
    let (mut compared, mut kinks, mut flat_caps, mut inside, mut unresolved) = (0, 0, 0, 0, 0);
    let mut worst = 0.0_f64;
    let all: Vec<_> = distance_cases().into_iter().filter(|case| case.is_link()).collect();
    for case in all.iter().step_by(all.len() / rounds(all.len())) {
        let Some((found, robot, mesh)) = answer(case) else { continue };
        let engine = Exhaustive::<f64>::new(&mesh).unwrap();
        let contact = engine.contact_of(&robot, &Pose::IDENTITY, &found).unwrap();
        let Some(derivative) = engine.derivative(&robot, &Pose::IDENTITY, &found).unwrap() else {
            assert!(found.distance < 1e-12 * case.scale, "{}: no derivative at {found:?}", case.id);
            continue;
        };
        let numbers = Numbers::new(case, robot.links()[0].caps().map(|cap| cap == Cap::Flat));
        let is_depth = !is_at_flat_cap(&contact, &robot);
        let value = numbers.value(is_depth);
        let is_capsule = is_depth && (value.rounded() - contact.depth).abs() < 1e-9 * case.scale;
        if found.distance <= 0.0 && !is_capsule {
            continue; // a way out at a flat cap or across the axis: the room of depths
        }
        let gap = if is_depth { value + case.r.into() } else { value }.rounded();
        if gap < 1e-6 * case.scale {
            continue; // too short to be told from its own rounding at 32 digits
        }
        let length = robot.links()[0].length();
        let reach = if length > 0.0 { gap.min(length) } else { gap };
        // A very short link turns fast: the largest derivative limits what the differences resolve.
        let largest = components(&derivative).into_iter().map(f64::abs).fold(1.0, f64::max);
        let unit = largest * 2.0_f64.powi(-53);
        for (number, computed) in components(&derivative).into_iter().enumerate() {
            let mut error = f64::INFINITY;
            let mut is_kink = true;
            for share in [1e-9, 3e-16] {
                // Powers of two: the steps themselves are not rounded.
                let step = 1.0 / (share * reach).power_of_two_to_unity();
                let side =
                    |by: f64| (numbers.moved(number, by).value(is_depth) - value).rounded() / by;
                let central = |step: f64| {
                    // No radius is below 0.
                    let ahead = side(step);
                    let behind = if number == 15 && case.r == 0.0 { ahead } else { side(-step) };
                    (0.5 * (ahead + behind), (ahead - behind).abs())
                };
                let ((wide, _), (narrow, jump)) = (central(2.0 * step), central(step));
                is_kink &= jump > 1e-4;
                // Over a shorter step than this, 32 digits tell no 64 units.
                let resolves = step >= 1e-16 * case.scale;
                if resolves && (wide - narrow).abs() <= 16.0 * unit {
                    error = error.min((narrow - computed).abs() / unit);
                }
            }
            if is_kink {
                assert!(
                    derivative.kink,
                    "{} {} {}: {contact:?} has a kink",
                    case.id, case.cat, number
                );
                kinks += 1;
            }
            if derivative.kink {
                continue;
            }
            if error.is_infinite() {
                unresolved += 1; // so close to a kink that no step is short enough
                continue;
            }
            assert!(error <= 64.0, "{} {} {number}: {error} u, {contact:?}", case.id, case.cat);
            worst = worst.max(error);
            compared += 1;
            inside += usize::from(found.distance == 0.0);
            flat_caps += usize::from(!is_depth);
        }
    }
    println!(
        "{compared} compared, worst {worst:.1} u; {kinks} kinks, {flat_caps} at flat caps, {inside} inside"
    );
    assert!(
        compared > rounds(8000)
            && kinks > rounds(100)
            && flat_caps > rounds(1500)
            && inside > rounds(300)
            && unresolved < compared / 10
    );
}

/// Two arcs of constant curvature and a turn of the base: six joints.
fn vertices(joints: &[f64; 6]) -> Vec<Vector> {
    let [bend1, plane1, bend2, plane2, length1, length2] = *joints;
    let mut place = Pose::IDENTITY;
    let mut points = vec![Vector::ZERO];
    for (bend, plane, length) in [(bend1, plane1, length1), (bend2, plane2, length2)] {
        for _ in 0..4 {
            let step = length / 4.0;
            let turn = Vector::new(-plane.sin(), plane.cos(), 0.0) * (bend * step);
            place *= Pose::new(Vector::Z * step, turn);
            points.push(place.translation);
        }
    }
    points
}

const RADII: [f64; 8] = [0.6, 0.6, 0.6, 0.6, 0.3, 0.3, 0.3, 0.3];

fn chain(joints: &[f64; 6]) -> Chain {
    Chain::from_centreline(&vertices(joints), &RADII).unwrap()
}

#[derive(Debug, Default)]
struct Seen {
    compared: usize,
    flat_caps: usize,
    with_lever: usize,
    kinks: usize,
    passing: usize,
    inside: usize,
    worst: f64,
}

/// The derivatives along all joints of each link's distance, or depth.
fn compare(seed: u64, mesh: &TriMesh, search: &mut BvhSearch, seen: &mut Seen) {
    let mut random = Random::new(seed);
    let joints: [f64; 6] = std::array::from_fn(|joint| match joint {
        0 | 2 => random.between(0.02, 0.25),
        1 | 3 => random.between(0.0, 6.0),
        _ => random.between(3.0, 6.0),
    });
    let pose = random.pose(1.5);
    let robot = chain(&joints);
    let mut out = Vec::new();
    search.per_link(&robot, &pose, &mut out).unwrap();
    for answer in out {
        let contact = search.contact_of(&robot, &pose, &answer).unwrap();
        if answer.distance > 2.0 {
            continue;
        }
        let Some(derivative) = search.derivative(&robot, &pose, &answer).unwrap() else { continue };
        let radius = robot.links()[answer.link as usize].radius();
        let at_flat_cap = is_at_flat_cap(&contact, &robot);
        let room = if at_flat_cap { answer.distance - 1e-3 } else { contact.depth + radius - 0.15 };
        if room < 0.0 {
            continue; // a step away the cap touches, or the normal has turned
        }
        let only = Only::new(mesh, answer.witness.triangle);
        for joint in 0..6 {
            let step = 1e-5;
            let at = |by: f64| {
                let mut moved = joints;
                moved[joint] += by;
                moved
            };
            let rate = |link: usize| {
                let at = |by: f64| vertices(&at(by))[link];
                pose.rotation * ((at(step) - at(-step)) * 8.0 - (at(2.0 * step) - at(-2.0 * step)))
                    / (12.0 * step)
            };
            let link = answer.link as usize;
            let (start, end) = (rate(link), rate(link + 1));
            let by_ends = derivative.rate(start, end);
            // The same by the velocity of the axis point and the turn of the link.
            let along = pose.rotation * (robot.links()[link].end() - robot.links()[link].start());
            let velocity = start.lerp(end, contact.fraction);
            let turn = along.cross(end - start) / along.length_squared();
            let by_velocities = contact.rate(velocity, turn).unwrap();
            assert!(
                (by_ends - by_velocities).abs() < 1e-9,
                "{seed} {contact:?}: {by_ends} {by_velocities}"
            );

            let around = [-2.0, -1.0, 0.0, 1.0, 2.0]
                .map(|by| only.value(&chain(&at(by * step)), &pose, &contact));
            let values = around.map(|(value, _)| value);
            let one_sided =
                [values[3] - values[2], values[2] - values[1]].map(|change| change / step);
            let is_kink = (one_sided[0] - one_sided[1]).abs() > 0.03 * (1.0 + one_sided[0].abs());
            assert!(contact.kink || !is_kink, "{seed}: {contact:?} has a kink, {one_sided:?}");
            if contact.kink {
                seen.kinks += 1;
                continue;
            }
            if around.iter().any(|(_, feature)| *feature != contact.feature) {
                seen.passing += 1; // the second derivative jumps between the steps
                continue;
            }
            let difference =
                (8.0 * (values[3] - values[1]) - (values[4] - values[0])) / (12.0 * step);
            let error = (difference - by_ends).abs();
            assert!(
                error < 1e-7,
                "{seed} joint {joint}: {error:e}, {one_sided:?} {by_ends} {contact:?}"
            );
            seen.worst = seen.worst.max(error);
            seen.compared += 1;
            seen.inside += usize::from(answer.distance == 0.0);
            seen.flat_caps += usize::from(at_flat_cap);
            let without_lever = contact.normal.unwrap().dot(velocity);
            seen.with_lever += usize::from((without_lever - by_ends).abs() > 1e-3);
        }
    }
}

/// A mesh of the one triangle that an answer names: that another is nearer a step away is a tie of
/// two contacts.
struct Only(TriMesh);

impl Only {
    fn new(mesh: &TriMesh, triangle: u32) -> Self {
        let corners =
            mesh.indices()[triangle as usize].map(|i| mesh.vertices()[i as usize].to_array());
        Self(mesh_of(&[corners]))
    }

    /// The depth, and the features.
    fn value(&self, robot: &Chain, pose: &Pose, of: &Contact) -> (f64, ContactFeature) {
        let mut out = Vec::new();
        let mut search = BvhSearch::new(&self.0).unwrap();
        search.per_link(robot, pose, &mut out).unwrap();
        let answer = out[of.link as usize];
        let contact = search.contact_of(robot, pose, &answer).unwrap();
        (contact.depth, contact.feature)
    }
}

#[test]
fn every_joint_against_differences() {
    let mut seen = Seen::default();
    let (ball, indices) = Ball::new(5.0).to_trimesh(24, 16);
    let bumpy =
        ball.iter().map(|v| v * (1.0 + 0.08 * (2.0 * v.x).sin() * (1.7 * v.y).cos())).collect();
    let mesh = TriMesh::new(bumpy, indices).unwrap();
    let mut search = BvhSearch::new(&mesh).unwrap();
    (0..rounds(350)).for_each(|seed| compare(seed, &mesh, &mut search, &mut seen));
    println!("{seen:?}");
    let Seen { compared, flat_caps, with_lever, inside, passing, .. } = seen;
    assert!(
        compared > rounds(10_000)
            && flat_caps > rounds(300)
            && with_lever > rounds(200)
            && inside > rounds(1000)
            && passing < rounds(100),
        "{seen:?}"
    );
}
