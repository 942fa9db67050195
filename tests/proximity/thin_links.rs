//! Links far longer than thick beside triangles stretched along them: a bound of the search that is
//! tilted by rounding would rule out the nearest.

use continuum_testing::narrow_phase::triangle_modified_cylinder;
use continuum_testing::precision::{Precision, extent};
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::QueryDispatcher;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};
use parry_continuum::{Chain, ContinuumDispatcher};

struct Scene {
    start: Vector,
    end: Vector,
    radius: Real,
    triangles: Vec<[Vector; 3]>,
}

impl Scene {
    /// Triangles that touch nearly the same cylinder around the axis, some of them beyond the ends.
    fn new(random: &mut Random) -> Self {
        let start = random.point();
        let axis = random.direction();
        let length = 10.0_f64.powf(random.between(-1.0, 0.5));
        let radius = length * 10.0_f64.powf(random.between(-12.0, -1.0));
        let spread = 10.0_f64.powf(random.between(-14.0, -3.0));
        let near = match random.below(8) {
            0 => -0.1 * spread,
            _ => radius * 10.0_f64.powf(random.between(-3.0, 1.0)),
        };
        // Some lean away from an end, so that a cap decides.
        let lean = spread * f64::from(random.below(2));
        let triangles = (0..64)
            .map(|_| {
                let side = random.perpendicular_to(axis);
                let other = axis.cross(side);
                let height = radius + near + spread * random.unit();
                [0; 3].map(|_| {
                    let along = random.between(-0.2, 1.05);
                    let slope = spread * random.unit() * random.unit() + lean * (1.05 - along);
                    start
                        + axis * (length * along)
                        + side * (height + slope)
                        + other * (2.0 * radius * random.between(-1.0, 1.0))
                })
            })
            .collect();
        Self { start, end: start + axis * length, radius, triangles }
    }

    /// The least distance by the narrow phase alone.
    fn least(&self, flat: bool) -> Real {
        let (start, end) = (f64::vec3(self.start), f64::vec3(self.end));
        let distance = |triangle: &[Vector; 3]| {
            triangle_modified_cylinder(triangle.map(f64::vec3), start, end, self.radius, [flat; 2])
                .distance
        };
        self.triangles.iter().map(distance).fold(Real::INFINITY, Real::min)
    }

    fn extent(&self) -> Real {
        let mut points: Vec<_> = self.triangles.as_flattened().to_vec();
        points.extend([self.start, self.end]);
        extent(&points, self.radius)
    }

    fn mesh(&self) -> TriMesh {
        let indices =
            (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        TriMesh::new(self.triangles.as_flattened().to_vec(), indices).unwrap()
    }
}

#[test]
fn no_bound_rules_out_the_nearest_triangle() {
    let mut random = Random::new(71);
    let (mut apart, mut touching, mut wrong) = (0, 0, 0);
    let mut worst = std::collections::BTreeMap::<_, Real>::new();
    for _ in 0..rounds(1500) {
        let scene = Scene::new(&mut random);
        let mesh = scene.mesh();
        let unit = scene.extent() * Real::EPSILON / 2.0;
        for flat in [false, true] {
            let (points, radii) = ([scene.start, scene.end], [scene.radius]);
            let robot = if flat {
                Chain::cylinders(&points, &radii)
            } else {
                Chain::capsules(&points, &radii)
            };
            let robot = robot.unwrap();
            let expected = scene.least(flat);
            if expected > 0.0 {
                apart += 1
            } else {
                touching += 1
            }
            let engines: [(_, Box<dyn Proximity>); 3] = [
                ("search", Box::new(BvhSearch::new(&mesh).unwrap())),
                ("exhaustive, f32", Box::new(Exhaustive::<f32>::new(&mesh).unwrap())),
                ("exhaustive, f64", Box::new(Exhaustive::<f64>::new(&mesh).unwrap())),
            ];
            let dispatched = ContinuumDispatcher::default()
                .distance(&Pose::IDENTITY, &robot.links()[0], &mesh)
                .unwrap();
            let off = worst.entry(("dispatcher", flat)).or_default();
            *off = off.max((dispatched.distance - expected).abs() / unit);
            for (name, mut engine) in engines {
                let found = engine.minimum(&robot, &Pose::IDENTITY).unwrap().distance;
                let worst = worst.entry((name, flat)).or_default();
                *worst = worst.max((found - expected).abs() / unit);
                wrong += usize::from(engine.clears(&robot, &Pose::IDENTITY, found).unwrap());
            }
        }
    }
    println!("{apart} apart, {touching} touching, {wrong} wrong: {worst:?}");
    assert!(apart > rounds(1000) && touching > rounds(100));
    assert_eq!(wrong, 0, "clear of what they found");
    assert!(worst.values().all(|worst| *worst <= 16.0), "{worst:?}");
}
