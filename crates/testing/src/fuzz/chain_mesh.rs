//! A robot and a mesh: all engines return the answer that the certificate proves.

use super::source::Source;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Certificate, Exhaustive, LinkProximity, Proximity};
use parry_continuum::{Chain, ModifiedCylinder};

/// The largest coordinate for which parry's own mesh is compared.
const LARGEST: f64 = 1e150;

/// Asserts three properties.
///
/// - Every link's distance lies within 16 units of its pair's extent of the certificate.
/// - No triangle is nearer by more than 16 units of the extent of its own pair.
/// - Minimum and clearance agree with these distances.
pub fn chain_mesh(bytes: &[u8]) {
    let mut source = Source::new(bytes);
    let pose = source.pose();
    let points: Vec<_> = (0..2 + source.below(5)).map(|_| source.point()).collect();
    let radii: Vec<_> = points[1..].iter().map(|_| source.number().abs()).collect();
    let robot = match source.below(4) {
        0 => Chain::capsules(&points, &radii),
        1 => Chain::cylinders(&points, &radii),
        _ => Chain::from_centreline(&points, &radii),
    };
    let Ok(robot) = robot else { return };
    let vertices: Vec<_> = (0..3 + source.below(10)).map(|_| source.point()).collect();
    let count = vertices.len() as u8;
    let mut corner = || source.below(count) as u32;
    let indices: Vec<_> =
        (0..1 + usize::from(count)).map(|_| [corner(), corner(), corner()]).collect();
    if !vertices.iter().all(|vertex| vertex.abs().max_element() <= LARGEST && vertex.is_finite()) {
        return;
    }
    let Ok(mesh) = TriMesh::new(vertices, indices) else { return };

    let mut engines: [(&str, Box<dyn Proximity>); 3] = [
        ("search", Box::new(BvhSearch::new(&mesh).expect("a valid mesh"))),
        ("exhaustive f64", Box::new(Exhaustive::<f64>::new(&mesh).expect("a valid mesh"))),
        ("exhaustive f32", Box::new(Exhaustive::<f32>::new(&mesh).expect("a valid mesh"))),
    ];
    let mut answers = Vec::new();
    let mut pairs = Vec::new();
    for (name, engine) in &mut engines {
        if engine.per_link(&robot, &pose, &mut answers).is_err() {
            assert!(engine.minimum(&robot, &pose).is_err(), "{name}");
            continue;
        }
        if pairs.is_empty() {
            pairs = robot.links().iter().map(|link| Pair::all(link, &pose, &mesh)).collect();
        }
        let problem =
            || format!("{name}\n{robot:?}\n{pose:?}\n{:?} {:?}", mesh.vertices(), mesh.indices());
        assert_eq!(answers.len(), robot.links().len(), "{}", problem());
        for (answer, pairs) in answers.iter().zip(&pairs) {
            check(answer, pairs).unwrap_or_else(|why| panic!("{why}: {answer:?} {}", problem()));
        }
        let least = answers.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min);
        let minimum = engine.minimum(&robot, &pose).expect("an answer as before");
        assert_eq!(minimum.distance, least, "{}", problem());
        for margin in [0.0, least, least.next_up(), least.next_down().max(0.0)] {
            let clears = engine.clears(&robot, &pose, margin).expect("a good margin");
            assert_eq!(clears, least > margin, "{least:e} against {margin:e} {}", problem());
        }
    }
}

/// A link and a triangle: proven bounds on their distance, and its rounding error.
struct Pair {
    bounds: Certificate,
    slack: f64,
}

impl Pair {
    /// Returns the pairs of the link with every triangle.
    fn all(link: &ModifiedCylinder, pose: &Pose, mesh: &TriMesh) -> Vec<Self> {
        let pair = |corners: [Vector; 3]| {
            let start = pose * link.start();
            let others = corners.into_iter().chain([pose * link.end()]);
            let extent = others
                .map(|point| (point - start).abs().max_element())
                .fold(link.radius(), f64::max);
            let bounds =
                Certificate::between(link, pose, corners).expect("what was answered is in range");
            Self { bounds, slack: 16.0 * f64::EPSILON * extent + 4.0 * f64::from_bits(1) }
        };
        mesh.triangles().map(|triangle| pair([triangle.a, triangle.b, triangle.c])).collect()
    }
}

fn check(answer: &LinkProximity, pairs: &[Pair]) -> Result<(), String> {
    let own = &pairs[answer.witness.triangle as usize];
    if !(own.bounds.lower - own.slack..=own.bounds.upper + own.slack).contains(&answer.distance) {
        return Err(format!("not its triangle's distance, {:?}", own.bounds));
    }
    match pairs.iter().position(|pair| answer.distance > pair.bounds.upper + pair.slack) {
        Some(nearer) => Err(format!("triangle {nearer} is nearer, {:?}", pairs[nearer].bounds)),
        None => Ok(()),
    }
}
