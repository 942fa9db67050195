//! A robot and a mesh: all engines give the answer that the certificate proves.

use crate::source::Source;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity};

/// Beyond this parry's own mesh is not asked for.
const LARGEST: f64 = 1e150;

/// Every link's distance lies within 16 units of its certificate; minimum and clearance agree with it.
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
    let indices: Vec<_> = (0..1 + usize::from(count)).map(|_| [corner(), corner(), corner()]).collect();
    if !vertices.iter().all(|vertex| vertex.abs().max_element() <= LARGEST && vertex.is_finite()) {
        return;
    }
    let Ok(mesh) = TriMesh::new(vertices, indices) else { return };

    let mut engines: [(&str, Box<dyn Proximity>); 3] = [
        ("search", Box::new(BvhSearch::new(&mesh).expect("a valid mesh"))),
        ("exhaustive f64", Box::new(Exhaustive::<f64>::new(&mesh).expect("a valid mesh"))),
        ("exhaustive f32", Box::new(Exhaustive::<f32>::new(&mesh).expect("a valid mesh"))),
    ];
    let slack = 16.0 * f64::EPSILON * reach(&robot, &pose, &mesh) + 4.0 * f64::from_bits(1);
    let mut answers = Vec::new();
    for (name, engine) in &mut engines {
        if engine.per_link(&robot, &pose, &mut answers).is_err() {
            assert!(engine.minimum(&robot, &pose).is_err(), "{name}");
            continue;
        }
        let problem = || format!("{name}\n{robot:?}\n{pose:?}\n{:?} {:?}", mesh.vertices(), mesh.indices());
        assert_eq!(answers.len(), robot.links().len(), "{}", problem());
        for answer in &answers {
            let bounds = answer.certify_among_all(&robot, &pose, &mesh).expect("what was answered exists");
            let distance = answer.distance;
            assert!(
                bounds.lower - slack <= distance && distance <= bounds.upper + slack,
                "{answer:?} {bounds:?} {}",
                problem()
            );
        }
        let least = answers.iter().map(|answer| answer.distance).fold(f64::INFINITY, f64::min);
        let minimum = engine.minimum(&robot, &pose).expect("an answer as before");
        assert_eq!(minimum.distance, least, "{}", problem());
        // A subnormal answer was rounded once more than what the margin is compared with; half way between two numbers
        // it may have gone to either.
        if 0.0 < least && least < f64::MIN_POSITIVE {
            continue;
        }
        for margin in [0.0, least, least.next_up(), least.next_down().max(0.0)] {
            let clears = engine.clears(&robot, &pose, margin).expect("a good margin");
            assert_eq!(clears, least > margin, "{least:e} against {margin:e} {}", problem());
        }
    }
}

/// How far the problem reaches, from the mesh's origin and from the robot's own.
fn reach(robot: &Chain, pose: &Pose, mesh: &TriMesh) -> f64 {
    let of = |point: Vector| point.abs().max_element();
    let links = robot.links().iter().flat_map(|link| {
        let ends = [link.start(), link.end()];
        ends.into_iter().map(of).chain(ends.map(|end| of(pose * end))).chain([link.radius()])
    });
    links.chain(mesh.vertices().iter().map(|&vertex| of(vertex))).fold(0.0, f64::max)
}
