//! The dispatcher answers every query for links and chains, in both orders, through every composite, and
//! never lets a pair that it cannot answer read as a free one.

mod common;
mod host_common;

use common::Random;
use host_common::scene::{floor_field, floor_mesh, heap, parts, tube, zigzag};
use host_common::{Draw, U};
use parry_continuum::distance::{Vec3, triangle_modified_cylinder};
use parry_continuum::parry::math::{IVector, Pose, Real, Vector};
use parry_continuum::parry::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher, ShapeCastHit,
    ShapeCastOptions, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry_continuum::parry::shape::{
    Ball, Compound, Cuboid, HeightField, Shape, SharedShape, TriMesh, Triangle, Voxels,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};
use std::sync::Mutex;

fn vec3(v: Vector) -> Vec3<f64> {
    Vec3::from(v.to_array())
}

/// The kernel's distance for a link and a triangle placed in one frame.
fn kernel(link: &ModifiedCylinder, triangle: &Triangle) -> Real {
    let vertices = [triangle.a, triangle.b, triangle.c].map(vec3);
    let flat = link.caps().map(|cap| cap == Cap::Flat);
    triangle_modified_cylinder(vertices, vec3(link.start()), vec3(link.end()), link.radius(), flat).distance
}

/// A robot near a floor, apart or across it.
struct Scene {
    robot: SharedShape,
    surface: SharedShape,
    links: Vec<ModifiedCylinder>,
    triangles: Vec<Triangle>,
    /// Of the robot and of the surface.
    poses: [Pose; 2],
}

impl Scene {
    fn random(random: &mut Random) -> Self {
        let mesh = floor_mesh();
        let chain = tube(random);
        let poses = [random.pose(2.0), random.pose(2.0)];
        // The robot's frame is brought over the floor, wherever that is.
        let over = Pose::new(Vector::new(0.0, random.between(-0.6, 0.6), 0.0), random.direction());
        let poses = [poses[1] * over, poses[1]];
        let (robot, links) = if random.chance(0.5) {
            (SharedShape::new(chain.clone()), chain.links().to_vec())
        } else {
            (SharedShape::new(chain.links()[2]), vec![chain.links()[2]])
        };
        let (surface, triangles) = if random.chance(0.5) {
            (SharedShape::new(mesh.clone()), mesh.triangles().collect())
        } else {
            let one = mesh.triangle(random.below(288));
            (SharedShape::new(one), vec![one])
        };
        Self { robot, surface, links, triangles, poses }
    }

    /// In the world: the distance of a link from a triangle.
    fn pair(&self, link: u32, triangle: u32) -> Real {
        let link = self.links[link as usize].transformed(&self.poses[0]);
        kernel(&link, &self.triangles[triangle as usize].transformed(&self.poses[1]))
    }

    fn least(&self) -> Real {
        let all =
            (0..self.links.len() as u32).flat_map(|l| (0..self.triangles.len() as u32).map(move |t| (l, t)));
        all.map(|(link, triangle)| self.pair(link, triangle)).fold(Real::INFINITY, Real::min)
    }

    /// Of the contacts of all links and triangles.
    fn deepest(&self, dispatcher: &ContinuumDispatcher) -> Real {
        let mut deepest: Real = 0.0;
        for link in &self.links {
            for triangle in &self.triangles {
                let pos12 = self.poses[0].inv_mul(&self.poses[1]);
                let contact = dispatcher.contact(&pos12, link, triangle, 0.0).unwrap();
                deepest = contact.map_or(deepest, |contact| deepest.min(contact.dist));
            }
        }
        deepest
    }

    /// Both orders: whether the robot is first, the relative pose, the shapes.
    fn orders(&self) -> [(bool, Pose, &dyn Shape, &dyn Shape); 2] {
        let [robot, surface] = self.poses;
        [
            (true, robot.inv_mul(&surface), &*self.robot, &*self.surface),
            (false, surface.inv_mul(&robot), &*self.surface, &*self.robot),
        ]
    }
}

/// Rounding of a few poses on coordinates of up to about 8.
const ROUNDING: Real = 256.0 * U;

#[test]
fn robots_and_surfaces_get_the_kernels_answers_in_both_orders() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(41);
    let (mut apart, mut across) = (0, 0);
    for _ in 0..400 {
        let scene = Scene::random(&mut random);
        let least = scene.least();
        if least > 0.0 {
            apart += 1
        } else {
            across += 1
        }
        for (robot_first, pos12, g1, g2) in scene.orders() {
            let named =
                |sub1, sub2| if robot_first { scene.pair(sub1, sub2) } else { scene.pair(sub2, sub1) };

            let answer = dispatcher.distance(&pos12, g1, g2).unwrap();
            assert!((answer.distance - least).abs() <= ROUNDING, "{answer:?} for {least}");
            assert!((named(answer.subshape1, answer.subshape2) - least).abs() <= ROUNDING);

            let meets = dispatcher.intersection_test(&pos12, g1, g2).unwrap();
            assert_eq!(meets.intersecting, answer.distance == 0.0);
            if meets.intersecting {
                assert!(named(meets.subshape1, meets.subshape2) <= ROUNDING);
            }

            match dispatcher.closest_points(&pos12, g1, g2, Real::MAX).unwrap() {
                ClosestPoints::Intersecting => assert_eq!(answer.distance, 0.0),
                ClosestPoints::WithinMargin(p1, p2) => {
                    assert!(((p1 - pos12 * p2).length() - least).abs() <= ROUNDING);
                    // Each in its own shape's frame, and in that shape.
                    assert!(g1.distance_to_local_point(p1, true) <= ROUNDING);
                    assert!(g2.distance_to_local_point(p2, true) <= ROUNDING);
                }
                ClosestPoints::Disjoint => panic!("everything is within the largest number"),
            }

            let contact = dispatcher.contact(&pos12, g1, g2, least + 0.1).unwrap().unwrap();
            assert!((contact.dist.max(0.0) - least).abs() <= ROUNDING, "{contact:?} for {least}");
            assert!((contact.normal1 + pos12.rotation * contact.normal2).length() <= ROUNDING);
            assert!((contact.normal1.length() - 1.0).abs() <= ROUNDING);
            assert!(named(contact.subshape1, contact.subshape2) <= least + ROUNDING);
            if least == 0.0 {
                let deepest = scene.deepest(&dispatcher);
                assert!((contact.dist - deepest).abs() <= 1e-6, "{contact:?} for {deepest}");
            }
            let between = pos12 * contact.point2 - contact.point1;
            assert!((between - contact.normal1 * contact.dist).length() <= 1e-5, "{contact:?} {between}");
        }
    }
    assert!(apart > 200 && across > 60, "{apart} apart, {across} across");
}

#[test]
fn margins_include_what_is_exactly_that_far() {
    let dispatcher = ContinuumDispatcher::default();
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, 0.5).unwrap();
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let wall =
        |x| Triangle::new(Vector::new(x, -9.0, -9.0), Vector::new(x, 9.0, -9.0), Vector::new(x, 0.0, 9.0));
    let mesh = |x| {
        let Triangle { a, b, c } = wall(x);
        TriMesh::new(vec![a, b, c], vec![[0, 1, 2]]).unwrap()
    };
    let robots: [&dyn Shape; 2] = [&link, &robot];
    for robot in robots {
        for (x, gap) in [(2.0, 1.5), (0.5, 0.0)] {
            let surfaces: [&dyn Shape; 2] = [&wall(x), &mesh(x)];
            for surface in surfaces {
                for (g1, g2) in [(robot, surface), (surface, robot)] {
                    let pose = Pose::IDENTITY;
                    assert_eq!(dispatcher.distance(&pose, g1, g2).unwrap().distance, gap);
                    assert_eq!(dispatcher.intersection_test(&pose, g1, g2).unwrap().intersecting, gap == 0.0);
                    for (margin, reached) in [(gap, true), (gap.next_down(), gap == 0.0), (-1.0, gap == 0.0)]
                    {
                        let points = dispatcher.closest_points(&pose, g1, g2, margin).unwrap();
                        let expected = if gap == 0.0 {
                            "Intersecting"
                        } else if reached {
                            "WithinMargin"
                        } else {
                            "Disjoint"
                        };
                        assert!(
                            format!("{points:?}").starts_with(expected),
                            "{points:?} at {gap} within {margin}"
                        );
                    }
                    let contact = |prediction| dispatcher.contact(&pose, g1, g2, prediction).unwrap();
                    assert_eq!(contact(gap).map(|contact| contact.dist), Some(gap));
                    assert_eq!(contact(gap.next_down()), None);
                    assert!(contact(gap).unwrap().normal1.x.abs() == 1.0);
                }
            }
        }
    }
}

#[test]
fn margins_mean_the_same_through_a_compound() {
    let dispatcher = ContinuumDispatcher::default();
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, 0.5).unwrap();
    let wall = |x| {
        let corners = [(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(y, z)| Vector::new(x, y, z));
        Compound::new(vec![(Pose::IDENTITY, SharedShape::new(Triangle::from(corners)))])
    };
    let (pose, apart, across) = (Pose::IDENTITY, wall(2.0), wall(0.375));
    for (g1, g2) in [(&apart as &dyn Shape, &link as &dyn Shape), (&link, &apart)] {
        assert_ne!(dispatcher.closest_points(&pose, g1, g2, 1.5).unwrap(), ClosestPoints::Disjoint);
        assert_eq!(dispatcher.closest_points(&pose, g1, g2, 1.5 - 1e-9).unwrap(), ClosestPoints::Disjoint);
        assert!(dispatcher.contact(&pose, g1, g2, 1.5).unwrap().is_some());
    }
    // A negative margin asks for an overlap that deep. This one is 0.125.
    for (g1, g2) in [(&across as &dyn Shape, &link as &dyn Shape), (&link, &across)] {
        assert!(dispatcher.contact(&pose, g1, g2, -0.1).unwrap().is_some());
        assert_eq!(dispatcher.contact(&pose, g1, g2, -0.2).unwrap(), None);
    }
    // parry finds no part where squares of coordinates overflow, and takes that for the largest number.
    let ball = SharedShape::new(Ball::new(1.0));
    let far = Compound::new(vec![(Pose::from_translation(Vector::splat(1e200)), ball)]);
    assert!(dispatcher.distance(&pose, &far, &link).is_err());
}

/// Every pair of a robot and a composite, with the poses that bring them near each other.
fn composites(random: &mut Random) -> Vec<(&'static str, SharedShape, SharedShape, Pose)> {
    let mut pairs: Vec<(&'static str, SharedShape, SharedShape, Pose)> = vec![];
    let chain = tube(random);
    let link = SharedShape::new(chain.links()[1]);
    let chain = SharedShape::new(chain);
    for robot in [link, chain] {
        for (name, other) in [
            ("compound", SharedShape::new(heap(random))),
            ("mesh", SharedShape::new(floor_mesh())),
            ("field", SharedShape::new(floor_field())),
            ("polyline", SharedShape::new(zigzag(random))),
            ("chain", SharedShape::new(tube(random))),
        ] {
            let place = Pose::new(Vector::new(0.0, random.between(-0.2, 0.7), 0.0), random.direction());
            pairs.push((name, robot.clone(), other, place.inverse()));
        }
    }
    pairs
}

/// A query on a composite is the best of the queries on its parts, which the dispatcher is asked for one by
/// one.
#[test]
fn composites_get_the_best_of_their_parts() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(42);
    let mut visits = std::collections::BTreeMap::new();
    for _ in 0..40 {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in [(&robot, &other, pos12), (&other, &robot, pos12.inverse())] {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                let pair = |id1: u32, id2: u32| {
                    let (parts1, parts2) = (parts(g1), parts(g2));
                    let part1 = parts1.into_iter().find(|part| part.0 == id1).unwrap();
                    let part2 = parts2.into_iter().find(|part| part.0 == id2).unwrap();
                    (part1.1.inv_mul(&(pos12 * part2.1)), part1.2, part2.2)
                };
                let mut least = Real::INFINITY;
                for (_, pose1, part1) in parts(g1) {
                    for (_, pose2, part2) in parts(g2) {
                        let pose = pose1.inv_mul(&(pos12 * pose2));
                        least = least.min(dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance);
                    }
                }
                // GJK answers for the pairs that are not ours, at its own accuracy.
                let tolerance = if matches!(name, "mesh" | "field") { ROUNDING } else { 1e-5 };

                let answer = dispatcher.distance(&pos12, g1, g2).unwrap();
                assert!((answer.distance - least).abs() <= tolerance, "{name}: {answer:?} for {least}");
                let (pose, part1, part2) = pair(answer.subshape1, answer.subshape2);
                let again = dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance;
                assert!(
                    (again - least).abs() <= tolerance,
                    "{name}: ids of {answer:?}, but {again} for {least}"
                );

                let meets = dispatcher.intersection_test(&pos12, g1, g2).unwrap();
                assert_eq!(meets.intersecting, least == 0.0, "{name}: {meets:?} for {least}");
                if meets.intersecting {
                    let (pose, part1, part2) = pair(meets.subshape1, meets.subshape2);
                    let again = dispatcher.intersection_test(&pose, &*part1, &*part2).unwrap().intersecting;
                    assert!(again, "{name}: {meets:?} {:?} {:?}", part1.shape_type(), part2.shape_type());
                }

                let contact = dispatcher.contact(&pos12, g1, g2, least + 0.01).unwrap();
                let contact = contact.unwrap_or_else(|| panic!("{name}: no contact at {least}"));
                assert!(
                    (contact.dist.max(0.0) - least).abs() <= tolerance.max(1e-5),
                    "{name}: {contact:?} {least}"
                );
                let (pose, part1, part2) = pair(contact.subshape1, contact.subshape2);
                let again = dispatcher.distance(&pose, &*part1, &*part2).unwrap().distance;
                assert!((again - least).abs() <= tolerance.max(1e-5), "{name}: {contact:?}, but {again}");

                if least > 0.0 {
                    let near = dispatcher.closest_points(&pos12, g1, g2, least + 1e-4).unwrap();
                    let ClosestPoints::WithinMargin(p1, p2) = near else {
                        panic!("{name}: {near:?} at {least}")
                    };
                    assert!(((p1 - pos12 * p2).length() - least).abs() <= tolerance, "{name}");
                    let far = dispatcher.closest_points(&pos12, g1, g2, 0.9 * least).unwrap();
                    assert_eq!(far, ClosestPoints::Disjoint, "{name}");
                    assert_eq!(dispatcher.contact(&pos12, g1, g2, 0.9 * least).unwrap(), None, "{name}");
                } else {
                    let near = dispatcher.closest_points(&pos12, g1, g2, 1.0).unwrap();
                    assert_eq!(near, ClosestPoints::Intersecting, "{name}");
                }
                let tally = visits.entry(name).or_insert([0; 2]);
                tally[usize::from(least == 0.0)] += 1;
            }
        }
    }
    assert!(visits.len() == 5 && visits.values().flatten().all(|&n| n >= 5), "{visits:?}");
}

/// A cast stops where the distance is gone, and nothing was met before.
#[test]
fn casts_stop_at_the_first_part_that_is_met() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(43);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..20 {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in [(&robot, &other, pos12), (&other, &robot, pos12.inverse())] {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                if dispatcher.distance(&pos12, g1, g2).unwrap().distance < 1e-3 {
                    continue;
                }
                let (centre1, centre2) = (g1.compute_local_aabb().center(), g2.compute_aabb(&pos12).center());
                let velocity = (centre1 - centre2) + random.vector(1.0);
                let options = ShapeCastOptions::with_max_time_of_impact(1.5);
                let at = |time: Real| {
                    let pose = Pose::from_translation(velocity * time) * pos12;
                    dispatcher.distance(&pose, g1, g2).unwrap().distance
                };
                // No point of the one comes nearer to the other than their speed allows.
                let mut time = 0.0;
                while time < 1.5 && at(time) > 1e-5 {
                    time += at(time) / velocity.length();
                }
                match dispatcher.cast_shapes(&pos12, velocity, g1, g2, options).unwrap() {
                    Some(hit) => {
                        hits += 1;
                        assert!(at(hit.time_of_impact) < 1e-3, "{name}: {hit:?}");
                        assert!(hit.time_of_impact > time - 1e-3, "{name}: {hit:?} for {time}");
                        let (ids1, ids2) = (parts(g1), parts(g2));
                        assert!(ids1.iter().any(|part| part.0 == hit.subshape1), "{name}: {hit:?}");
                        assert!(ids2.iter().any(|part| part.0 == hit.subshape2), "{name}: {hit:?}");
                    }
                    None => {
                        misses += 1;
                        assert!(time >= 1.5 || at(time) > -1.0 && grazes(&at, time), "{name}: {time}");
                    }
                }
            }
        }
    }
    assert!(hits > 100 && misses > 20, "{hits} hits, {misses} misses");
}

/// Whether the shapes part again at once.
fn grazes(at: &impl Fn(Real) -> Real, time: Real) -> bool {
    (1..=20).all(|i| at(time + 1e-3 * Real::from(i)) > 0.0)
}

/// The same motions as linear casts, and turning ones.
#[test]
fn nonlinear_casts_stop_at_the_first_part_that_is_met() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(44);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..6 {
        for (name, robot, other, pos12) in composites(&mut random) {
            for (first, second, pos12) in [(&robot, &other, pos12), (&other, &robot, pos12.inverse())] {
                let (g1, g2): (&dyn Shape, &dyn Shape) = (&**first, &**second);
                if dispatcher.distance(&pos12, g1, g2).unwrap().distance < 1e-2 {
                    continue;
                }
                let turn = if random.chance(0.5) { random.vector(0.5) } else { Vector::ZERO };
                let approach = g1.compute_local_aabb().center() - g2.compute_aabb(&pos12).center();
                let still = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
                let moving =
                    NonlinearRigidMotion::new(pos12, Vector::ZERO, approach + random.vector(0.3), turn);
                let hit = dispatcher.cast_shapes_nonlinear(&still, g1, &moving, g2, 0.0, 1.0, true).unwrap();
                let at = |time: Real| {
                    let pose = moving.position_at_time(time);
                    dispatcher.distance(&pose, g1, g2).unwrap().distance
                };
                // The first of a thousand moments at which they meet.
                let met = (0..=1000).map(|i| Real::from(i) / 1000.0).find(|&time| at(time) == 0.0);
                match hit {
                    Some(hit) => {
                        hits += 1;
                        assert!(
                            at(hit.time_of_impact) < 1e-3,
                            "{name}: {hit:?} at {}",
                            at(hit.time_of_impact)
                        );
                        assert!(
                            met.is_none_or(|met| hit.time_of_impact <= met + 1e-6),
                            "{name}: {hit:?} {met:?}"
                        );
                    }
                    None => {
                        misses += 1;
                        assert_eq!(met, None, "{name}: missed, first met at {met:?}");
                    }
                }
            }
        }
    }
    assert!(hits > 50 && misses > 5, "{hits} hits, {misses} misses");
}

/// A cast along a floor, which parry's own casts against height fields miss beyond the starting cells.
#[test]
fn a_level_cast_meets_the_hill_at_the_other_end_of_the_field() {
    let heights: Vec<Real> = (0..81).map(|k| if k / 9 == 7 || k % 9 == 7 { 1.0 } else { 0.0 }).collect();
    let field = HeightField::new(Array2::new(9, 9, heights), Vector::new(8.0, 1.0, 8.0));
    let link = ModifiedCylinder::capsule(-0.1 * Vector::X, 0.1 * Vector::X, 0.05).unwrap();
    let pose = Pose::from_translation(Vector::new(-3.5, 0.5, -3.5));
    let options = ShapeCastOptions::default();
    let dispatcher = ContinuumDispatcher::default();
    let hit = dispatcher.cast_shapes(&pose, Vector::X, &field, &link, options).unwrap().unwrap();
    // The slope from x = 2 up to x = 3 is half way up at 2.5; the capsule's end is 0.1 ahead, and its round
    // cap touches the slope of 45 degrees earlier by 0.05 sqrt 2.
    let expected = 6.0 - 0.1 - 0.05 * 2.0_f64.sqrt();
    assert!((hit.time_of_impact - expected).abs() < 1e-4, "{hit:?}");
    let hill = field.triangle_at_id(hit.subshape1).unwrap();
    assert!(hill.compute_local_aabb().maxs.x > 2.0);
    let back = dispatcher.cast_shapes(&pose.inverse(), -Vector::X, &link, &field, options).unwrap().unwrap();
    assert!((back.time_of_impact - hit.time_of_impact).abs() < 1e-9 && back.subshape2 == hit.subshape1);
}

#[test]
fn voxels_are_met_and_cast_against_but_have_no_distance() {
    let voxels =
        Voxels::new(Vector::ONE, &[IVector::new(0, 0, 0), IVector::new(1, 0, 0), IVector::new(3, 0, 0)]);
    let robot = Chain::cylinders(&[-Vector::Y, Vector::ZERO, Vector::Y], &[0.25, 0.25]).unwrap();
    let dispatcher = ContinuumDispatcher::default();
    for (x, meets) in [(0.5, true), (2.5, false), (3.5, true), (-0.5, false)] {
        let place = Pose::from_translation(Vector::new(x, 0.5, 0.5));
        let found = dispatcher.intersection_test(&place, &voxels, &robot).unwrap();
        let swapped = dispatcher.intersection_test(&place.inverse(), &robot, &voxels).unwrap();
        assert_eq!((found.intersecting, swapped.intersecting), (meets, meets), "at {x}");
        if meets {
            assert_eq!((found.subshape1, found.subshape2), (swapped.subshape2, swapped.subshape1));
        }
        assert!(dispatcher.distance(&place, &voxels, &robot).is_err());
        assert!(dispatcher.distance(&place.inverse(), &robot, &voxels).is_err());
        assert!(dispatcher.contact(&place, &voxels, &robot, 1.0).is_err());
        assert!(dispatcher.closest_points(&place, &voxels, &robot, 1.0).is_err());
    }
    let place = Pose::from_translation(Vector::new(-2.0, 0.5, 0.5));
    let hit =
        dispatcher.cast_shapes(&place, Vector::X, &voxels, &robot, ShapeCastOptions::default()).unwrap();
    assert!((hit.unwrap().time_of_impact - 1.75).abs() < 1e-4, "{hit:?}");
}

/// Passes on to parry and keeps a record of the pairs.
#[derive(Default)]
struct Recorder(Mutex<Vec<String>>);

impl Recorder {
    fn note(&self, query: &str, g1: &dyn Shape, g2: &dyn Shape) {
        let name = |shape: &dyn Shape| {
            let composite = shape.as_composite_shape().is_some() || shape.as_heightfield().is_some();
            let link = if shape.as_shape::<ModifiedCylinder>().is_some() { "Link" } else { "" };
            format!("{link}{:?}{}", shape.shape_type(), if composite { " composite" } else { "" })
        };
        self.0.lock().unwrap().push(format!("{query}: {} and {}", name(g1), name(g2)));
    }
}

macro_rules! recorded {
    ($name:ident($($arg:ident: $type:ty),*) -> $answer:ty, $g1:ident, $g2:ident) => {
        fn $name(&self, $($arg: $type),*) -> Result<$answer, Unsupported> {
            self.note(stringify!($name), $g1, $g2);
            DefaultQueryDispatcher.$name($($arg),*)
        }
    };
}

impl QueryDispatcher for Recorder {
    recorded!(intersection_test(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeIntersection, g1, g2);
    recorded!(distance(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeDistance, g1, g2);
    recorded!(contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, prediction: Real) -> Option<Contact>, g1, g2);
    recorded!(closest_points(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, max: Real) -> ClosestPoints, g1, g2);
    recorded!(cast_shapes(pos12: &Pose, vel12: Vector, g1: &dyn Shape, g2: &dyn Shape, options: ShapeCastOptions)
        -> Option<ShapeCastHit>, g1, g2);
    recorded!(cast_shapes_nonlinear(motion1: &NonlinearRigidMotion, g1: &dyn Shape, motion2: &NonlinearRigidMotion,
        g2: &dyn Shape, start: Real, end: Real, stop: bool) -> Option<ShapeCastHit>, g1, g2);
}

/// Asks everything of a pair; true for each query that is answered.
fn ask_everything(
    dispatcher: &impl QueryDispatcher,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
) -> [bool; 6] {
    let options = ShapeCastOptions::with_max_time_of_impact(1.0);
    let motion1 = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
    let motion2 = NonlinearRigidMotion::new(*pos12, Vector::ZERO, Vector::X, Vector::ZERO);
    [
        dispatcher.intersection_test(pos12, g1, g2).is_ok(),
        dispatcher.distance(pos12, g1, g2).is_ok(),
        dispatcher.contact(pos12, g1, g2, 9.0).is_ok(),
        dispatcher.closest_points(pos12, g1, g2, 9.0).is_ok(),
        dispatcher.cast_shapes(pos12, -Vector::X, g1, g2, options).is_ok(),
        dispatcher.cast_shapes_nonlinear(&motion1, g1, &motion2, g2, 0.0, 1.0, true).is_ok(),
    ]
}

#[test]
fn the_inner_dispatcher_is_asked_only_for_simple_pairs_of_others() {
    let dispatcher = ContinuumDispatcher(Recorder::default());
    let mut random = Random::new(45);
    for (name, robot, other, pos12) in composites(&mut random) {
        assert_eq!(ask_everything(&dispatcher, &pos12, &*robot, &*other), [true; 6], "{name}");
        assert_eq!(ask_everything(&dispatcher, &pos12.inverse(), &*other, &*robot), [true; 6], "{name}");
    }
    let record = dispatcher.0.0.into_inner().unwrap();
    let asked = |what: &str| record.iter().any(|line| line.contains(what));
    assert!(!asked("composite"), "{record:?}");
    assert!(!asked("LinkCustom and Triangle") && !asked("Triangle and LinkCustom"), "{record:?}");
    assert!(asked("Cuboid") && asked("Segment") && asked("LinkCustom and LinkCustom"), "{record:?}");
}

/// Knows nothing.
struct Ignorant;

macro_rules! refused {
    ($($name:ident($($type:ty),*) -> $answer:ty;)*) => {
        $(fn $name(&self, $(_: $type),*) -> Result<$answer, Unsupported> {
            Err(Unsupported)
        })*
    };
}

impl QueryDispatcher for Ignorant {
    refused! {
        intersection_test(&Pose, &dyn Shape, &dyn Shape) -> ShapeIntersection;
        distance(&Pose, &dyn Shape, &dyn Shape) -> ShapeDistance;
        contact(&Pose, &dyn Shape, &dyn Shape, Real) -> Option<Contact>;
        closest_points(&Pose, &dyn Shape, &dyn Shape, Real) -> ClosestPoints;
        cast_shapes(&Pose, Vector, &dyn Shape, &dyn Shape, ShapeCastOptions) -> Option<ShapeCastHit>;
        cast_shapes_nonlinear(&NonlinearRigidMotion, &dyn Shape, &NonlinearRigidMotion, &dyn Shape, Real, Real, bool)
            -> Option<ShapeCastHit>;
    }
}

/// parry would say that these pairs are infinitely far apart.
#[test]
fn a_pair_that_is_refused_makes_the_whole_query_refused() {
    let mut random = Random::new(46);
    let dispatcher = ContinuumDispatcher(Ignorant);
    // A box that is touched by nothing and that nobody knows how to measure, among triangles that are known.
    let cuboid = SharedShape::new(Cuboid::new(Vector::splat(0.5)));
    let triangle = SharedShape::new(Triangle::new(Vector::X, Vector::Y, Vector::Z));
    let mixed = Compound::new(vec![(Pose::IDENTITY, triangle), (Pose::IDENTITY, cuboid)]);
    for robot in [SharedShape::new(tube(&mut random)), SharedShape::new(tube(&mut random).links()[0])] {
        let place = Pose::from_translation(Vector::new(0.3, 0.1, 0.0));
        assert_eq!(ask_everything(&dispatcher, &place, &mixed, &*robot)[1..], [false; 5]);
        assert_eq!(ask_everything(&dispatcher, &place, &*robot, &mixed)[1..], [false; 5]);
        // With nothing but triangles all is well. (To leave out parts of a mesh in a nonlinear cast, parry
        // asks about balls.)
        assert_eq!(ask_everything(&dispatcher, &place, &floor_mesh(), &*robot)[..5], [true; 5]);
        assert_eq!(ask_everything(&dispatcher, &place, &floor_field(), &*robot)[..5], [true; 5]);
    }
    // Found before anything was refused: they do meet.
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::X, 0.5).unwrap();
    assert!(dispatcher.intersection_test(&Pose::IDENTITY, &floor_mesh(), &link).unwrap().intersecting);
}

#[test]
fn nothing_that_is_not_finite_gets_a_number() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(47);
    let chain = tube(&mut random);
    let link = chain.links()[0];
    let robots: [&dyn Shape; 2] = [&chain, &link];
    let broken = Triangle::new(Vector::X, Vector::new(Real::NAN, 1.0, 0.0), Vector::Z);
    let mesh = TriMesh::new(vec![broken.a, broken.b, broken.c], vec![[0, 1, 2]]).unwrap();
    let field = HeightField::new(Array2::new(2, 2, vec![0.0, Real::NAN, 0.0, 0.0]), Vector::ONE);
    let far = Triangle::new(Vector::X, Vector::new(1e300, 1.0, 0.0), Vector::Z);
    let far_mesh = TriMesh::new(vec![far.a, far.b, far.c], vec![[0, 1, 2]]).unwrap();
    for robot in robots {
        let surfaces: [&dyn Shape; 5] = [&broken, &mesh, &field, &far, &far_mesh];
        for surface in surfaces {
            for (g1, g2) in [(robot, surface), (surface, robot)] {
                let answered = ask_everything(&dispatcher, &Pose::IDENTITY, g1, g2);
                assert_eq!(answered[1..4], [false; 3], "{:?}", surface.shape_type());
            }
        }
        for bad in [Real::NAN, Real::INFINITY, 1e200] {
            let pose = Pose::from_translation(Vector::new(0.0, bad, 0.0));
            let (floor, heap) = (floor_mesh(), heap(&mut random));
            let others: [&dyn Shape; 3] = [&floor, &heap, &floor.triangle(3)];
            for other in others {
                assert_eq!(ask_everything(&dispatcher, &pose, robot, other), [false; 6]);
                assert_eq!(ask_everything(&dispatcher, &pose, other, robot), [false; 6]);
            }
        }
        let (pose, floor) = (Pose::IDENTITY, floor_mesh());
        assert!(dispatcher.contact(&pose, robot, &floor, Real::NAN).is_err());
        assert!(dispatcher.closest_points(&pose, robot, &floor, Real::NAN).is_err());
        let mut options = ShapeCastOptions::default();
        assert!(dispatcher.cast_shapes(&pose, Vector::NAN, robot, &floor, options).is_err());
        options.max_time_of_impact = Real::NAN;
        assert!(dispatcher.cast_shapes(&pose, Vector::X, robot, &floor, options).is_err());
    }
}

#[test]
fn a_change_of_unit_changes_no_bit() {
    let dispatcher = ContinuumDispatcher::default();
    let mut random = Random::new(48);
    for _ in 0..40 {
        let link = random.link();
        let triangle = Triangle::new(random.vector(1.0), random.vector(1.0), random.vector(1.0));
        let pose = random.pose(1.0);
        let expected = dispatcher.distance(&pose, &link, &triangle).unwrap().distance;
        let contact = dispatcher.contact(&pose, &link, &triangle, 9.0).unwrap().unwrap();
        for k in [-300, -20, 300] {
            let unit = Real::powi(2.0, k);
            let scale = Vector::splat(unit);
            let (link, triangle) = (host_common::scaled(&link, unit), triangle.scaled(scale));
            let mesh = TriMesh::new(triangle.vertices().to_vec(), vec![[0, 1, 2]]).unwrap();
            let pose = Pose::from_parts(pose.translation * unit, pose.rotation);
            assert_eq!(dispatcher.distance(&pose, &link, &triangle).unwrap().distance, expected * unit);
            let from_mesh = dispatcher.distance(&pose.inverse(), &mesh, &link).unwrap().distance;
            assert!((from_mesh / unit - expected).abs() <= ROUNDING);
            let scaled = dispatcher.contact(&pose, &link, &triangle, 9.0 * unit).unwrap().unwrap();
            assert_eq!((scaled.dist, scaled.normal1), (contact.dist * unit, contact.normal1));
        }
    }
}
