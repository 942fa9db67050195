//! Contacts: every local minimum within the margin and none twice, against brute force over all
//! pairs of triangles; the minimum within a bound.

use super::scenes::mesh_of;
use super::seams::shared_stretches;
use continuum_testing::Random;
use continuum_testing::narrow_phase::{point_modified_cylinder, triangle_modified_cylinder};
use parry_continuum::Chain;
use parry_continuum::distance::{Vec3, point_triangle};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Contact, Exhaustive, Proximity};
use parry_continuum::{Cap, ModifiedCylinder};

/// What rounding may do to a distance: the room that the definition of a local minimum has.
const TIE: f64 = 64.0 * f64::EPSILON / 2.0;

/// A small mesh: a wall with bumps, a lumen, or triangles between any of a few points. On a
/// lattice, where ties and parallels are common, or not; with slivers, or not; with shared corners,
/// or each triangle with its own.
pub fn small_mesh(random: &mut Random) -> TriMesh {
    let is_lattice = random.below(3) == 0;
    let place = |point: Vector| if is_lattice { (point * 4.0).round() / 4.0 } else { point };
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    let rough = [0.0, 0.05, 0.3][random.below(3) as usize];
    let (rows, columns) = (5, 4);
    let kind = random.below(3);
    if kind < 2 {
        for row in 0..rows {
            for column in 0..columns {
                let (u, v) = (f64::from(row) - 2.0, f64::from(column));
                let bump = random.between(-rough, rough);
                let turn = std::f64::consts::TAU * v / f64::from(columns);
                vertices.push(match kind {
                    0 => place(Vector::new(u, v - 1.5, 1.0 + bump)),
                    _ => {
                        place(Vector::new(u, (1.5 + bump) * turn.cos(), (1.5 + bump) * turn.sin()))
                    }
                });
            }
        }
        for row in 0..rows - 1 {
            for column in 0..columns - u32::from(kind == 0) {
                let corner = |r: u32, c: u32| (row + r) * columns + (column + c) % columns;
                indices.push([corner(0, 0), corner(1, 0), corner(1, 1)]);
                indices.push([corner(0, 0), corner(1, 1), corner(0, 1)]);
            }
        }
    } else {
        vertices.extend((0..9).map(|_| place(random.point() * 2.0)));
        for _ in 0..20 {
            let from = random.below(9);
            indices.push([
                from,
                (from + 1 + random.below(4)) % 9,
                (from + 5 + random.below(3)) % 9,
            ]);
        }
    }
    if random.below(3) == 0 {
        // A corner next to another makes slivers of the triangles between them.
        let (one, other) = (random.below(9) as usize, random.below(9) as usize);
        vertices[one] = vertices[other] + random.point() * 1e-7;
    }
    let triangles: Vec<_> =
        indices.iter().map(|c| c.map(|i: u32| vertices[i as usize].to_array())).collect();
    if random.below(2) == 0 {
        mesh_of(&triangles)
    } else {
        TriMesh::new(vertices, indices).unwrap()
    }
}

pub fn small_robot(random: &mut Random) -> Chain {
    let place =
        |point: Vector, is_lattice| if is_lattice { (point * 4.0).round() / 4.0 } else { point };
    loop {
        let is_lattice = random.below(2) == 0;
        let mut points = vec![place(random.point(), is_lattice)];
        for _ in 0..2 {
            let last = points[points.len() - 1];
            points.push(place(last + random.point() * 1.2, is_lattice));
        }
        let radius = [0.0, 0.25, 0.5][random.below(3) as usize];
        let made = match random.below(3) {
            0 => Chain::from_centreline(&points, &[radius, 0.5 * radius]),
            1 => Chain::capsules(&points, &[radius; 2]),
            _ => Chain::cylinders(&points, &[radius; 2]),
        };
        if let Ok(robot) = made {
            return robot;
        }
    }
}

/// The distances between a link and triangles, and how far from the link one must go to come from
/// one to another on the mesh: over all ways, by Floyd and Warshall.
pub struct Passes {
    pub distances: Vec<f64>,
    pub heights: Vec<Vec<f64>>,
}

impl Passes {
    pub fn new(link: &ModifiedCylinder, triangles: &[[Vector; 3]]) -> Self {
        let to = |corners: [Vector; 3]| {
            let flat = link.caps().map(|cap| cap == Cap::Flat);
            let [start, end] = [link.start(), link.end()].map(Vec3::from);
            triangle_modified_cylinder(corners.map(Vec3::from), start, end, link.radius(), flat)
                .distance
        };
        let count = triangles.len();
        let distances: Vec<_> = triangles.iter().map(|&corners| to(corners)).collect();
        let mut heights = vec![vec![f64::INFINITY; count]; count];
        let shared = shared_stretches(triangles);
        for one in 0..count {
            heights[one][one] = distances[one];
            for other in 0..one {
                let stretches = shared[one][other].iter();
                let least = stretches.map(|&[from, along]| to([from, along, along]));
                heights[one][other] = least.fold(f64::INFINITY, f64::min);
                heights[other][one] = heights[one][other];
            }
        }
        for through in 0..count {
            for one in 0..count {
                for other in 0..count {
                    let way = heights[one][through].max(heights[through][other]);
                    heights[one][other] = heights[one][other].min(way);
                }
            }
        }
        Self { distances, heights }
    }
}

fn contacts(engine: &mut impl Proximity, robot: &Chain, margin: f64) -> Vec<Contact> {
    let mut out = Vec::new();
    engine.contacts_within(robot, &Pose::IDENTITY, margin, 0.0, &mut out).unwrap();
    out
}

/// What the sample has seen.
#[derive(Debug, Default)]
struct Census {
    contacts: usize,
    touching: usize,
    several: usize,
    ties: usize,
    merged: usize,
    sampled: usize,
}

fn judge(seed: u64, census: &mut Census) {
    let mut random = Random::new(seed);
    let (mesh, robot) = (small_mesh(&mut random), small_robot(&mut random));
    let triangles: Vec<[Vector; 3]> =
        mesh.indices().iter().map(|corners| corners.map(|i| mesh.vertices()[i as usize])).collect();
    let margin = [0.0, 0.3, 1.0, 4.0][random.below(4) as usize];
    let mut search = BvhSearch::new(&mesh).unwrap();
    let found = contacts(&mut search, &robot, margin);
    assert_eq!(
        found,
        contacts(&mut Exhaustive::<f32>::new(&mesh).unwrap(), &robot, margin),
        "{seed}"
    );
    assert_eq!(
        found,
        contacts(&mut Exhaustive::<f64>::new(&mesh).unwrap(), &robot, margin),
        "{seed}"
    );
    // A smaller margin has the nearer of them.
    let mut nearer = found.clone();
    nearer.retain(|contact| contact.distance <= 0.4 * margin);
    assert_eq!(nearer, contacts(&mut search, &robot, 0.4 * margin), "{seed}");

    for (number, link) in robot.links().iter().enumerate() {
        let of_link: Vec<_> =
            found.iter().filter(|contact| contact.link as usize == number).collect();
        assert!(of_link.is_sorted_by_key(|contact| contact.distance));
        let passes = Passes::new(link, &triangles);
        // No coordinate is beyond 5, so no extent beyond 10.
        let tie = 10.0 * TIE;
        let height = |one: u32, other: u32| passes.heights[one as usize][other as usize];
        for (triangle, &distance) in passes.distances.iter().enumerate() {
            if distance <= margin - tie {
                // From everywhere a way leads to a contact that is no farther, hardly rising.
                let reached = of_link.iter().filter(|contact| {
                    contact.distance <= distance + tie
                        && height(triangle as u32, contact.witness.triangle) <= distance + 2.0 * tie
                });
                assert!(
                    reached.count() > 0,
                    "{seed}: triangle {triangle} at {distance} leads nowhere"
                );
            }
            let at_a_contact = of_link
                .iter()
                .filter(|contact| contact.witness.triangle != triangle as u32)
                .any(|contact| {
                    height(triangle as u32, contact.witness.triangle)
                        <= contact.distance + tie / 8.0
                });
            census.merged += usize::from(at_a_contact);
        }
        for (place, one) in of_link.iter().enumerate() {
            let true_distance = passes.distances[one.witness.triangle as usize];
            assert!((one.distance - true_distance).abs() <= tie, "{seed}: {one:?} {true_distance}");
            for other in &of_link[..place] {
                let farther = one.distance.max(other.distance);
                let pass = height(one.witness.triangle, other.witness.triangle);
                assert!(
                    pass > farther + tie / 64.0,
                    "{seed}: {one:?} and {other:?} are one, over {pass}"
                );
                census.ties += usize::from((one.distance - other.distance).abs() <= tie);
            }
            census.contacts += 1;
            census.touching += usize::from(one.distance == 0.0);
            census.several += usize::from(place == 1);
            census.sampled += sample_around(link, &triangles, one, &mut random);
        }
    }
}

fn distance_to_segment(point: Vector, from: Vector, to: Vector) -> f64 {
    point_triangle(point.into(), [from, to, to].map(Vec3::from)).distance
}

/// No point of the mesh next to a contact is nearer.
fn sample_around(
    link: &ModifiedCylinder,
    triangles: &[[Vector; 3]],
    contact: &Contact,
    random: &mut Random,
) -> usize {
    let flat = link.caps().map(|cap| cap == Cap::Flat);
    let mut sampled = 0;
    for corners in triangles {
        for _ in 0..4 {
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let inside = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
            // Joined with the contact's triangle where the contact is.
            let own = &triangles[contact.witness.triangle as usize];
            let shared: Vec<_> = corners.iter().filter(|corner| own.contains(corner)).collect();
            let holds = |&&from: &&Vector, &&along: &&Vector| {
                distance_to_segment(contact.witness.on_mesh, from, along) < 1e-15
            };
            if !shared.iter().any(|from| shared.iter().any(|along| holds(from, along))) {
                continue;
            }
            let near = contact.witness.on_mesh.lerp(inside, 1e-3);
            let [start, end] = [link.start(), link.end()].map(Vec3::from);
            let away =
                point_modified_cylinder(near.into(), start, end, link.radius(), flat).distance;
            assert!(away >= contact.distance - 1e-13, "{contact:?}: {away} at {near}");
            sampled += 1;
        }
    }
    sampled
}

#[test]
fn every_local_minimum_once() {
    let mut census = Census::default();
    (0..400).for_each(|seed| judge(seed, &mut census));
    let Census { contacts, touching, several, ties, merged, sampled } = census;
    assert!(contacts > 1000 && touching > 100 && several > 200, "{census:?}");
    assert!(ties > 20 && merged > 500 && sampled > 4000, "{census:?}");
}

#[test]
#[ignore = "minutes: run it by name, in release"]
fn every_local_minimum_once_of_many_scenes() {
    let mut census = Census::default();
    (1000..21_000).for_each(|seed| judge(seed, &mut census));
    println!("{census:?}");
}

/// A wall of many triangles along a link is one contact, and so is one that it lies in.
#[test]
fn a_flat_wall_is_one_contact() {
    for height in [0.0, 0.4, 0.5, 2.0] {
        let corner = |i: u32| Vector::new(f64::from(i % 9) - 4.0, f64::from(i / 9) - 4.0, height);
        let squares = (0..72).filter(|i| i % 9 != 8);
        let indices = squares.flat_map(|i| [[i, i + 1, i + 10], [i, i + 10, i + 9]]).collect();
        let mesh = TriMesh::new((0..81).map(corner).collect(), indices).unwrap();
        let ends = [Vector::new(-3.3, 0.2, 0.0), Vector::new(3.1, 0.2, 0.0)];
        for robot in [Chain::capsules(&ends, &[0.5]), Chain::cylinders(&ends, &[0.5])] {
            let robot = robot.unwrap();
            let found = contacts(&mut BvhSearch::new(&mesh).unwrap(), &robot, 3.0);
            assert_eq!(found.len(), 1, "{found:?}");
            let contact = &found[0];
            assert!((contact.distance - (height - 0.5).max(0.0)).abs() < 1e-15);
            if height > 0.0 {
                assert!(contact.kink && (contact.depth - (height - 0.5)).abs() < 1e-15);
                assert!((contact.normal.unwrap() + Vector::Z).length() < 1e-15);
            } else if robot.links()[0].caps() == [Cap::Round; 2] {
                assert!((contact.depth + 0.5).abs() < 1e-15, "{contact:?}");
                assert_eq!(contact.normal, None, "the axis lies in the wall");
            } else {
                // The lowest triangle on the axis reaches from x = -4 to -3, past the flat start:
                // out along the axis is shorter than across.
                let corners = mesh.triangle(contact.witness.triangle).vertices().map(|v| v.x);
                assert_eq!(corners.into_iter().fold(f64::MIN, f64::max), -3.0);
                assert!((contact.depth + 0.3).abs() < 1e-15, "{contact:?}");
                assert_eq!(contact.normal, Some(Vector::X), "{contact:?}");
            }
        }
    }
}

#[test]
fn the_minimum_within_a_bound() {
    let (mut within, mut beyond, mut touching) = (0, 0, 0);
    for seed in 5000..5200 {
        let mut random = Random::new(seed);
        let (mesh, robot) = (small_mesh(&mut random), small_robot(&mut random));
        let pose = random.pose(1.0);
        let mut search = BvhSearch::new(&mesh).unwrap();
        let least = search.minimum(&robot, &pose).unwrap();
        let mut engines: [Box<dyn Proximity>; 3] = [
            Box::new(BvhSearch::new(&mesh).unwrap()),
            Box::new(search),
            Box::new(Exhaustive::<f32>::new(&mesh).unwrap()),
        ];
        for engine in &mut engines {
            for bound in
                [0.0, 0.5 * least.distance, least.distance, 2.0 * least.distance, f64::INFINITY]
            {
                let found = engine.minimum_within(&robot, &pose, bound).unwrap();
                assert_eq!(found, (least.distance <= bound).then_some(least), "{seed} {bound}");
                within += usize::from(found.is_some());
                beyond += usize::from(found.is_none());
                touching += usize::from(least.distance == 0.0);
            }
            assert_eq!(engine.minimum_within(&robot, &pose, -1.0), Ok(None));
            assert!(engine.contacts_within(&robot, &pose, f64::NAN, 0.0, &mut Vec::new()).is_err());
        }
    }
    assert!(within > 1000 && beyond > 300 && touching > 300, "{within} {beyond} {touching}");
}

/// What is computed together is what is computed alone, and an error leaves nothing behind.
#[test]
fn the_contacts_of_all_answers_are_those_of_each() {
    let (mut answers, mut together, mut kinks, mut touching) = (Vec::new(), Vec::new(), 0, 0);
    for seed in 0..600 {
        let random = &mut Random::new(seed);
        let (mesh, robot) = (small_mesh(random), small_robot(random));
        // What is level or parallel stays so where it is not turned.
        let pose = if seed % 3 == 0 { random.pose(0.3) } else { Pose::IDENTITY };
        let mut search = BvhSearch::new(&mesh).unwrap();
        search.per_link(&robot, &pose, &mut answers).unwrap();
        search.contacts_of(&robot, &pose, &answers, &mut together).unwrap();
        let alone = answers.iter().map(|answer| search.contact_of(&robot, &pose, answer).unwrap());
        assert_eq!(together, alone.collect::<Vec<_>>(), "{seed}");
        kinks += together.iter().filter(|contact| contact.kink).count();
        touching += together.iter().filter(|contact| contact.distance <= 0.0).count();

        let shorter = Chain::capsules(&[Vector::ZERO, Vector::X], &[0.1]).unwrap();
        let result = search.contacts_of(&shorter, &pose, &answers, &mut together);
        assert!(result.is_err() && together.is_empty(), "{seed}");
    }
    assert!(kinks > 5 && touching > 100, "{kinks} {touching}");
}

/// A margin beyond everything finds what any margin does that is large enough.
#[test]
fn a_margin_without_end_finds_all_contacts() {
    let mut found = 0;
    for seed in 0..300 {
        let random = &mut Random::new(seed);
        let (mesh, robot) = (small_mesh(random), small_robot(random));
        let mut search = BvhSearch::new(&mesh).unwrap();
        let all = contacts(&mut search, &robot, 1e3);
        found += all.len();
        for margin in [1e12, 1e16, 1e160, f64::INFINITY] {
            assert_eq!(contacts(&mut search, &robot, margin), all, "{seed}: {margin}");
        }
        assert!(!search.clears(&robot, &Pose::IDENTITY, f64::INFINITY).unwrap());
    }
    assert!(found > 600, "{found}");
}
