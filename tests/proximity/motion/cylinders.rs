//! Chains whose links are cylinders: the wedges between them stay open while the robot moves.

use super::least::Counted;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, Proximity, RobotPair};
use parry_continuum::{Chain, Motion, RigidMotion, RobotError, Speed, Tube};

/// A user's own motion: a chain of cylinders that moves straight.
struct Shifted<'a> {
    chain: &'a Chain,
    shift: Vector,
}

impl Motion for Shifted<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(self.chain);
        Ok(Pose::from_translation(self.shift * t))
    }

    fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
        Speed { point: self.shift.length() * (1.0 + 1e-12), turn: 0.0 }
    }
}

/// A robot with one bend, and a point or a wire in the wedge that is open there, where the chain of
/// cylinders is farther away than the chain with fitted caps. Both in the given unit.
fn bend_and_obstacle(random: &mut Random, unit: Real) -> ([Vector; 3], Vector, [Vector; 2]) {
    let turn = random.between(0.3, 1.4);
    let along = Vector::new(turn.sin(), 0.0, turn.cos());
    let bend = Vector::Z * 10.0;
    // Outside of the bend, between the two planes of the caps.
    let out = -(along - Vector::Z).normalize();
    let place = bend + out * random.between(1.5, 4.0);
    let wire = [place - Vector::Y * 5.0, place + Vector::Y * 5.0];
    let points = [Vector::ZERO, bend, bend + along * random.between(6.0, 12.0)];
    (points.map(|p| p * unit), place * unit, wire.map(|p| p * unit))
}

#[test]
fn wedges_between_cylinders_stay_open() {
    let random = &mut Random::new(31);
    let mut wider = 0;
    for round in 0..rounds(100) {
        let unit = [1.0, 1e-3, 1e-6][round % 3];
        let (points, place, wire) = bend_and_obstacle(random, unit);
        let radii = [unit; 2];
        let cylinders = Chain::cylinders(&points, &radii).unwrap();
        let fitted = Chain::from_centreline(&points, &radii).unwrap();
        let mut search = BvhSearch::from_triangles(&[place; 3], &[[0, 1, 2]]).unwrap();
        let of_mesh = search.minimum(&cylinders, &Pose::IDENTITY).unwrap().distance;
        let obstacle = Chain::capsules(&wire, &[0.1 * unit]).unwrap();
        let mut pair = RobotPair::new();
        let [here, there] = [&Pose::IDENTITY; 2];
        let of_pair = pair.minimum(&cylinders, here, &obstacle, there).unwrap().distance;
        let as_fitted = search.minimum(&fitted, &Pose::IDENTITY).unwrap().distance;
        wider += usize::from(of_mesh > as_fitted + 0.01 * unit);

        // At rest, the motion and the chain are equally far away.
        let rest = RigidMotion::new(Tube::from(&cylinders), [Pose::IDENTITY; 2]).unwrap();
        let wire = RigidMotion::new(Tube::from(&obstacle), [Pose::IDENTITY; 2]).unwrap();
        let own = Shifted { chain: &cylinders, shift: Vector::ZERO };
        let (tolerance, resolution) = (1e-3 * unit, 1e-3 * unit);
        for motion in [&rest as &dyn Motion, &own] {
            let motion = &Counted::new(motion);
            let bounds = search.clearance_of_motion(motion, tolerance).unwrap();
            assert!(bounds.resolved, "{round}: {bounds:?}, {of_mesh}");
            assert!(bounds.lower <= of_mesh + 1e-9 * unit && of_mesh <= bounds.upper + 1e-9 * unit);
            let bounds = pair.clearance_of_motion(motion, &wire, tolerance).unwrap();
            assert!(bounds.resolved, "{round}: {bounds:?}, {of_pair}");
            assert!(bounds.lower <= of_pair + 1e-9 * unit && of_pair <= bounds.upper + 1e-9 * unit);
            for (off, decision) in [(-0.01, Decision::Clear), (0.01, Decision::Contact)] {
                let margin = (of_mesh + off * unit).max(0.0);
                let found = search.clears_motion(motion, margin, resolution).unwrap().decision;
                assert_eq!(found, decision, "{round}: {of_mesh} {off}");
                let margin = (of_pair + off * unit).max(0.0);
                let found = pair.clears_motions(motion, &wire, margin, resolution).unwrap();
                assert_eq!(found.decision, decision, "{round}: {of_pair} {off}");
            }
        }

        // On the way, too: the least distance of many steps.
        let shift = Vector::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0) * unit;
        let moved = Pose::from_translation(shift);
        let moving = RigidMotion::new(Tube::from(&cylinders), [Pose::IDENTITY, moved]).unwrap();
        let own = Shifted { chain: &cylinders, shift };
        let least = (0..=400)
            .map(|k| {
                let pose = Pose::from_translation(shift * (f64::from(k) / 400.0));
                search.minimum(&cylinders, &pose).unwrap().distance
            })
            .fold(Real::INFINITY, Real::min);
        let step = shift.length() / 800.0;
        for motion in [&moving as &dyn Motion, &own] {
            let motion = &Counted::new(motion);
            let bounds = search.clearance_of_motion(motion, tolerance).unwrap();
            assert!(bounds.resolved, "{round}: {bounds:?}, {least}");
            assert!(motion.count() < 2000, "{round}: {} shapes", motion.count());
            assert!(bounds.lower <= least + 1e-9 * unit, "{round}: {bounds:?}, {least}");
            assert!(least - step <= bounds.upper, "{round}: {bounds:?}, {least}");
        }
    }
    assert!(wider > 5, "the wedge was nearest in {wider} rounds only");
}
