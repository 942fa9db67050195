//! Motions against the truth: their shapes in steps so fine that nothing fits between.

mod chains;
mod cylinders;
mod displacement_bounds;
mod edges;
mod fading;
mod first_contact;
mod jumps;
mod least;
mod left_out;
mod limits;
mod moving_base;
mod moving_mesh;
mod narrow;
mod own;
mod path;
mod refused;
mod speeds;
mod together;
mod two_robots;

use continuum_demo::ctr::Robot;
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::ventricle;
use continuum_testing::{Arcs, Random};
use parry_continuum::Tube;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::BvhSearch;

fn anatomy() -> BvhSearch {
    let (vertices, indices) = ventricle::mesh(6_000);
    BvhSearch::new(&TriMesh::new(vertices, indices).unwrap()).unwrap()
}

/// An edge whose tip ends `distance` from where it begins.
fn random_edge(robot: &Robot, random: &mut Random, distance: Real) -> JointMotion {
    JointMotion::random(robot, ventricle::entry(), distance, || random.unit())
}

/// The centreline at a time.
fn arcs(motion: &JointMotion, t: Real) -> Arcs {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    for section in motion.sections(t) {
        let bend = Vector::new(-section.bend[1], section.bend[0], 0.0);
        arcs.push(section.radius, &[(section.length, bend)]);
    }
    arcs
}

/// How a motion fares in steps.
struct Steps {
    /// Between these is the clearance of each shape.
    bounds: Vec<[Real; 2]>,
}

impl Steps {
    fn new(
        search: &mut BvhSearch,
        count: usize,
        tolerance: Real,
        mut shape: impl FnMut(Real) -> (Tube, Pose),
    ) -> Self {
        let bounds = (0..=count).map(|step| {
            let (tube, pose) = shape(step as Real / count as Real);
            let found = search.clearance(&tube, &pose, tolerance).unwrap();
            [found.lower, found.upper]
        });
        Self { bounds: bounds.collect() }
    }

    fn least(&self) -> [Real; 2] {
        self.bounds
            .iter()
            .fold([Real::INFINITY; 2], |least, bounds| [0, 1].map(|k| least[k].min(bounds[k])))
    }

    /// The first step that is at most `margin` away.
    fn first_touch(&self, margin: Real) -> Option<usize> {
        self.bounds.iter().position(|bounds| bounds[1] <= margin)
    }
}

/// A polyline near a vertex of the anatomy, with links shorter and longer than their radii, and
/// steps in radius.
fn polyline(random: &mut Random, from: Vector) -> (Vec<Vector>, Vec<Real>) {
    let mut points = vec![from];
    let (mut heading, mut radii, mut radius) =
        (random.direction(), Vec::new(), random.between(0.2, 1.0));
    for k in 0..2 + random.below(6) as usize {
        heading = (heading + random.direction() * 0.6).normalize();
        points.push(points[k] + heading * random.between(0.1, 2.0));
        radii.push(radius);
        radius *= [1.0, 1.0, 1.0, 0.7, 1.3][random.below(5) as usize];
    }
    (points, radii)
}
