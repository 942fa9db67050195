//! Tubes against the truth: a chain so fine that its own error does not matter.

use continuum_scene::ctr::{self, Joints, Robot};
use continuum_scene::ventricle;
use continuum_testing::Random;
use parry_continuum::parry::math::Vector;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Proximity, ProximityError};
use parry_continuum::{Chain, Tube, TubeSection};
use std::sync::Arc;

/// A curve by arc length: sections with a length and a radius, and points and directions.
struct Shape {
    sections: Vec<(f64, f64)>,
    curve: Arc<dyn Fn(f64) -> (Vector, Vector) + Send + Sync>,
    curvature: f64,
}

impl Shape {
    fn arc_lengths(&self, spacing: f64, at_faces: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut arcs, mut radii, mut from) = (vec![0.0], Vec::new(), 0.0);
        for &(length, radius) in &self.sections {
            let count = (length / spacing).ceil().max(1.0) as usize;
            let mut here: Vec<_> = (1..=count).map(|k| length * k as f64 / count as f64).collect();
            here.extend(
                at_faces.iter().filter(|off| **off < 0.4 * length).flat_map(|off| [*off, length - off]),
            );
            here.sort_by(f64::total_cmp);
            here.dedup();
            radii.extend(std::iter::repeat_n(radius, here.len()));
            arcs.extend(here.iter().map(|s| from + s));
            from += length;
        }
        (arcs, radii)
    }

    fn samples(&self, spacing: f64) -> (Vec<Vector>, Vec<f64>) {
        let (arcs, radii) = self.arc_lengths(spacing, &[]);
        (arcs.iter().map(|&s| (self.curve)(s).0).collect(), radii)
    }

    fn end_tangents(&self) -> [Vector; 2] {
        [0.0, self.length()].map(|s| (self.curve)(s).1)
    }

    fn length(&self) -> f64 {
        self.sections.iter().map(|section| section.0).sum()
    }

    /// A chain within 1e-5 of the tube.
    fn fine(&self) -> Chain {
        let (arcs, radii) = self.arc_lengths(0.02, &[1e-4]);
        let points: Vec<_> = arcs.iter().map(|&s| (self.curve)(s).0).collect();
        Chain::from_centreline(&points, &radii).unwrap()
    }

    fn from_samples(&self, spacing: f64, tangents: bool) -> Tube {
        let (points, radii) = self.samples(spacing);
        Tube::from_samples(&points, &radii, tangents.then(|| self.end_tangents())).unwrap()
    }

    fn from_function(&self) -> Tube {
        let sections: Vec<_> = self
            .sections
            .iter()
            .map(|&(length, radius)| TubeSection { length, radius, curvature: self.curvature })
            .collect();
        let curve = Arc::clone(&self.curve);
        Tube::from_function(&sections, move |s| curve(s)).unwrap()
    }
}

/// A concentric tube robot.
fn concentric(robot: &Robot, random: &mut Random) -> Shape {
    let reach = [0.15, 0.3, 0.6][random.below(3) as usize];
    let extensions: Vec<_> =
        robot.sections.iter().map(|section| section.length * reach * random.between(0.05, 1.0)).collect();
    let angles = (0..3).map(|_| random.between(0.0, std::f64::consts::TAU)).collect();
    let joints = Joints { extensions: extensions.clone(), angles };
    let sections =
        extensions.iter().zip(&robot.sections).map(|(&out, section)| (out, section.radius)).collect();
    let robot = robot.clone();
    let curve = move |s: f64| {
        let frame = robot.frames(&joints, &[s])[0];
        (frame.translation, frame.rotation * Vector::Z)
    };
    Shape { sections, curve: Arc::new(curve), curvature: 0.0527 }
}

#[test]
fn clearances_hold_the_truth_between_their_bounds() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let (base, robot) = (ventricle::entry(), ctr::three_tubes());
    let mut search = BvhSearch::new(&mesh).unwrap();
    let mut random = Random::new(1);
    let (mut free, mut touching, mut worst) = (0, 0, 0.0_f64);
    for round in 0..300 {
        let shape = concentric(&robot, &mut random);
        let truth = search.minimum(&shape.fine(), &base).unwrap().distance;
        let tubes = [shape.from_samples(0.15, true), shape.from_samples(0.15, false), shape.from_function()];
        for (way, tube) in tubes.iter().enumerate() {
            for tolerance in [1.0, 0.1, 0.01, 0.003] {
                let found = match search.clearance(tube, &base, tolerance) {
                    Ok(found) => found,
                    Err(ProximityError::ToleranceTooFine { possible, .. }) if way < 2 => {
                        println!("round {round}, way {way}, {tolerance}: {possible} {:?}", shape.sections);
                        continue;
                    }
                    Err(error) => panic!("round {round}, way {way}, {tolerance}: {error}"),
                };
                assert!(
                    found.lower <= truth + 1e-5 && truth <= found.upper + 1e-5,
                    "round {round}, way {way}, {tolerance}: {truth} in {found:?}"
                );
                assert!(found.upper - found.lower <= tolerance);
                assert!((found.on_robot - found.on_mesh).length() <= found.upper + 1e-9);
                worst = worst.max(found.upper - found.lower);
            }
            for off in [-0.1, -0.003, -3e-4, 3e-4, 0.003, 0.1] {
                let margin = truth + off;
                if margin < 0.0 {
                    continue;
                }
                let Ok(decision) = search.tube_clears(tube, &base, margin, 0.002) else {
                    println!("clears {round} {way}");
                    continue;
                };
                let right = if off < 0.0 { Decision::Clear } else { Decision::Touches };
                assert!(
                    decision == right || (decision == Decision::Undecided && off.abs() <= 0.002),
                    "round {round}, way {way}, {margin} of {truth}: {decision:?}"
                );
            }
        }
        if truth > 0.0 { free += 1 } else { touching += 1 }
    }
    println!("{free} free, {touching} touching, worst {worst}");
    assert!(free > 50 && touching > 50);
}
