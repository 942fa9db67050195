//! The dispatcher answers every query for links and chains, in both orders, through every
//! composite, and never reports an unsupported pair as free.

use crate::draw::{Draw, U};
use crate::inner::ask_everything;
use crate::scene::{floor_mesh, heap, tube};
use continuum_testing::Random;
use continuum_testing::narrow_phase::triangle_modified_cylinder;
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{ClosestPoints, QueryDispatcher, ShapeCastOptions};
use parry_continuum::parry::shape::{
    Ball, Compound, HeightField, RoundShape, Shape, SharedShape, TriMesh, Triangle,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ContinuumDispatcher, ModifiedCylinder};

fn vec3(v: Vector) -> Vec3<f64> {
    Vec3::from(v.to_array())
}

/// The kernel's distance for a link and a triangle placed in one frame.
fn kernel(link: &ModifiedCylinder, triangle: &Triangle) -> Real {
    let vertices = [triangle.a, triangle.b, triangle.c].map(vec3);
    let flat = link.caps().map(|cap| cap == Cap::Flat);
    triangle_modified_cylinder(vertices, vec3(link.start()), vec3(link.end()), link.radius(), flat)
        .distance
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
        let all = (0..self.links.len() as u32)
            .flat_map(|l| (0..self.triangles.len() as u32).map(move |t| (l, t)));
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
pub const ROUNDING: Real = 256.0 * U;

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
            let named = |sub1, sub2| {
                if robot_first { scene.pair(sub1, sub2) } else { scene.pair(sub2, sub1) }
            };

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
            assert!(
                (between - contact.normal1 * contact.dist).length() <= 1e-5,
                "{contact:?} {between}"
            );
        }
    }
    assert!(apart > 200 && across > 60, "{apart} apart, {across} across");
}

#[test]
fn margins_include_what_is_exactly_that_far() {
    let dispatcher = ContinuumDispatcher::default();
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::Z, 0.5).unwrap();
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5]).unwrap();
    let wall = |x| {
        Triangle::new(
            Vector::new(x, -9.0, -9.0),
            Vector::new(x, 9.0, -9.0),
            Vector::new(x, 0.0, 9.0),
        )
    };
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
                    assert_eq!(
                        dispatcher.intersection_test(&pose, g1, g2).unwrap().intersecting,
                        gap == 0.0
                    );
                    for (margin, reached) in
                        [(gap, true), (gap.next_down(), gap == 0.0), (-1.0, gap == 0.0)]
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
                    let contact =
                        |prediction| dispatcher.contact(&pose, g1, g2, prediction).unwrap();
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
        assert_eq!(
            dispatcher.closest_points(&pose, g1, g2, 1.5 - 1e-9).unwrap(),
            ClosestPoints::Disjoint
        );
        assert!(dispatcher.contact(&pose, g1, g2, 1.5).unwrap().is_some());
    }
    // A negative margin asks for an overlap that deep. This one is 0.125.
    for (g1, g2) in [(&across as &dyn Shape, &link as &dyn Shape), (&link, &across)] {
        assert!(dispatcher.contact(&pose, g1, g2, -0.1).unwrap().is_some());
        assert_eq!(dispatcher.contact(&pose, g1, g2, -0.2).unwrap(), None);
    }
    // parry finds no part where squares of coordinates overflow, and takes that for the largest
    // number.
    let ball = SharedShape::new(Ball::new(1.0));
    let far = Compound::new(vec![(Pose::from_translation(Vector::splat(1e200)), ball)]);
    assert!(dispatcher.distance(&pose, &far, &link).is_err());
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

/// An endless shape is not a thin one, and a turned infinity is NaN, which boxes leave out.
#[test]
fn endless_convex_shapes_are_refused() {
    let (dispatcher, far) = (ContinuumDispatcher::default(), Real::INFINITY);
    let corners = |b| Triangle::new(Vector::ZERO, b, Vector::X);
    let rounded = |b, border| RoundShape { inner_shape: corners(b), border_radius: border };
    let shapes = [
        SharedShape::capsule_y(1.0, far),
        SharedShape::capsule(Vector::ZERO, Vector::new(1.0, far, 2.0), 0.5),
        SharedShape::capsule(Vector::ZERO, Vector::NAN, 0.5),
        SharedShape::cuboid(1.0, far, far),
        SharedShape::cuboid(1.0, far, 1.0),
        SharedShape::cylinder(1.0, far),
        SharedShape::cone(1.0, far),
        SharedShape::new(rounded(Vector::Y, far)),
        SharedShape::new(rounded(Vector::new(1.0, far, 2.0), 0.5)),
        SharedShape::new(rounded(Vector::NAN, 0.5)),
    ];
    let link = ModifiedCylinder::capsule(Vector::ZERO, Vector::X, 0.5).unwrap();
    let pose = Pose::new(Vector::splat(5.0), Vector::new(0.3, 0.2, 0.1));
    for shape in shapes {
        for (pos12, g1, g2) in
            [(pose, &link as &dyn Shape, &*shape), (pose.inverse(), &*shape, &link)]
        {
            // Except in motions, which may not visit it.
            let answered = ask_everything(&dispatcher, &pos12, g1, g2);
            assert_eq!(answered[..5], [false; 5], "{:?}", shape.as_typed_shape());
        }
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
            let (link, triangle) = (crate::draw::scaled(&link, unit), triangle.scaled(scale));
            let mesh = TriMesh::new(triangle.vertices().to_vec(), vec![[0, 1, 2]]).unwrap();
            let pose = Pose::from_parts(pose.translation * unit, pose.rotation);
            assert_eq!(
                dispatcher.distance(&pose, &link, &triangle).unwrap().distance,
                expected * unit
            );
            let from_mesh = dispatcher.distance(&pose.inverse(), &mesh, &link).unwrap().distance;
            assert!((from_mesh / unit - expected).abs() <= ROUNDING);
            let scaled = dispatcher.contact(&pose, &link, &triangle, 9.0 * unit).unwrap().unwrap();
            assert_eq!((scaled.dist, scaled.normal1), (contact.dist * unit, contact.normal1));
        }
    }
}
