//! The engines on the extreme problems: a mesh of a dozen of their triangles against the links of
//! two.

use super::measure::{Problem, scaled};
use super::problems::Extreme;
use continuum_testing::precision::vector;
use fearless_simd::Level;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Certificate, Exhaustive, LinkProximity, Proximity, SearchPrecision,
};
use parry_continuum::{Chain, ModifiedCylinder};
use std::collections::BTreeMap;

/// A mesh, a robot of one link, and what the distance is, in lengths near one.
struct Scene {
    mesh: TriMesh,
    robot: Chain,
    exponent: i32,
    near_one: Vec<[Vector; 3]>,
    link: ModifiedCylinder,
    /// Bounds on the least distance.
    bounds: [f64; 2],
}

impl Scene {
    fn new(problems: &[&Problem<f64>], of_link: usize, flat: bool) -> Option<Self> {
        let exponent = problems[of_link].exponent;
        let large =
            |point: Vector| Vector::from_array(point.to_array().map(|x| scaled(x, exponent)));
        let near_one: Vec<_> =
            problems.iter().map(|problem| problem.near_one.triangle.map(vector)).collect();
        let input = &problems[of_link].near_one;
        let (start, end) = (vector(input.start), vector(input.end));
        let link = if flat {
            ModifiedCylinder::cylinder(start, end, input.radius)
        } else {
            ModifiedCylinder::capsule(start, end, input.radius)
        }
        .ok()?;
        let (points, radii) = ([large(start), large(end)], [scaled(input.radius, exponent)]);
        let robot =
            if flat { Chain::cylinders(&points, &radii) } else { Chain::capsules(&points, &radii) }
                .ok()?;
        let vertices: Vec<_> = near_one.iter().flatten().map(|&point| large(point)).collect();
        let indices = (0..near_one.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mesh = TriMesh::new(vertices, indices).ok()?;
        let mut bounds = [f64::INFINITY; 2];
        for &triangle in &near_one {
            let Certificate { lower, upper, .. } =
                Certificate::between(&link, &Pose::IDENTITY, triangle).ok()?;
            bounds = [bounds[0].min(lower), bounds[1].min(upper)];
        }
        Some(Self { mesh, robot, exponent, near_one, link, bounds })
    }

    /// The error of an engine's answer in units of u x extent of the link and the triangle that it
    /// names.
    fn error(&self, answer: &LinkProximity) -> f64 {
        let [a, b, c] = self.near_one[answer.witness.triangle as usize];
        let points = [a, b, c, self.link.start(), self.link.end()];
        let extent = continuum_testing::precision::extent(&points, self.link.radius());
        let unit = (extent * f64::EPSILON / 2.0).max(scaled(0.5, -1074 - self.exponent));
        let distance = scaled(answer.distance, -self.exponent);
        let off = (distance - self.bounds[1]).max(self.bounds[0] - distance);
        if off.is_nan() { f64::INFINITY } else { off.max(0.0) / unit }
    }
}

/// The errors of every engine, by name.
pub type Errors = BTreeMap<String, Vec<f64>>;

/// Asks every engine at every instruction set.
pub fn measure(problems: &[Problem<f64>], levels: &[(&'static str, Level)]) -> Errors {
    let mut groups: BTreeMap<(Extreme, i32), Vec<&Problem<f64>>> = BTreeMap::new();
    for problem in problems {
        groups.entry((problem.extreme, problem.exponent)).or_default().push(problem);
    }
    let mut errors = Errors::new();
    for some in groups.values().flat_map(|group| group.chunks(12)) {
        for (of_link, flat) in [(0, true), (some.len() / 2, false)] {
            let Some(scene) = Scene::new(some, of_link, flat) else { continue };
            if let Ok(engine) = BvhSearch::new(&scene.mesh) {
                ask(&scene, engine, "BvhSearch", &mut errors);
            }
            for (name, level) in levels {
                exhaustive::<f64>(&scene, *level, &format!("Exhaustive, f64, {name}"), &mut errors);
                exhaustive::<f32>(&scene, *level, &format!("Exhaustive, f32, {name}"), &mut errors);
            }
        }
    }
    errors
}

fn exhaustive<T: SearchPrecision>(scene: &Scene, level: Level, name: &str, errors: &mut Errors) {
    for culling in [true, false] {
        if let Ok(mut engine) = Exhaustive::<T>::new(&scene.mesh) {
            engine.set_level(level);
            engine.set_culling(culling);
            ask(scene, engine, name, errors);
        }
    }
}

fn ask(scene: &Scene, mut engine: impl Proximity, name: &str, errors: &mut Errors) {
    let error =
        engine.minimum(&scene.robot, &Pose::IDENTITY).map_or(f64::INFINITY, |a| scene.error(&a));
    errors.entry(name.to_owned()).or_default().push(error);
}
