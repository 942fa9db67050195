//! Scenes that are aligned within rounding, which random bytes never form. A derivation gives their
//! answers:
//!
//! 0. the level legs of a robot, in any frame, order and unit;
//! 1. a flat end on a wall, or on another flat end, at margin 0;
//! 2. two robots that are shifted together;
//! 3. a path of hundreds of parts under a moving base;
//! 4. a floor with T-vertices and a seam of an ulp;
//! 5. disks on a thin backbone.

use super::source::Source;
use crate::Random;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Decision, Proximity, RobotPair, SelfQuery};
use parry_continuum::{Chain, LinearMotion, MotionPath, MovingBase, RobotError, Tube};

/// The kinds of scenes.
pub const ALIGNED: usize = 6;

/// What a scene was.
#[derive(Clone, Copy, Debug)]
pub struct Visited {
    pub kind: usize,
    /// Whether the robot was farther away than the margin.
    pub is_clear: bool,
}

struct Scene<'s, 'b> {
    source: &'s mut Source<'b>,
    random: Random,
    frame: Pose,
    unit: f64,
}

/// Runs a scene; `None` if the library refuses its robot.
pub fn aligned(bytes: &[u8]) -> Option<Visited> {
    let mut source = Source::new(bytes);
    let kind = source.below(ALIGNED as u8);
    let unit = [1.0, 1e-3, 1e4][source.below(3)];
    let (turned, size) = (source.below(3), [0.0, 100.0][source.below(2)]);
    let mut random = Random::new(source.bits());
    let frame = if turned == 0 { Pose::IDENTITY } else { random.pose(size) };
    let mut scene = Scene { source: &mut source, random, frame, unit };
    let is_clear = match kind {
        0 => scene.level_legs(),
        1 => scene.faces(),
        2 => scene.together(),
        3 => scene.long_path(),
        4 => scene.seams(),
        _ => scene.disks(),
    };
    is_clear.ok().map(|is_clear| Visited { kind, is_clear })
}

impl Scene<'_, '_> {
    fn placed(&self, points: &[Vector]) -> Vec<Vector> {
        points.iter().map(|point| self.frame * *point * self.unit).collect()
    }

    fn scaled(&self, radii: &[f64]) -> Vec<f64> {
        radii.iter().map(|radius| radius * self.unit).collect()
    }

    /// A length of either sign around 0, from 1e-9 to 1.
    fn gap(&mut self) -> f64 {
        let sign = if self.source.flag() { 1.0 } else { -1.0 };
        sign * 10_f64.powf(self.random.between(-9.0, 0.0))
    }

    /// Asserts a decision about a robot that exceeds its margin by `slack`.
    fn check(&self, decision: Decision, slack: f64, resolution: f64) -> bool {
        // Rounding grows with the distance from the origin.
        let doubt = 1.5 * resolution + 1e-10;
        let is_right = match decision {
            Decision::Clear => slack > -doubt,
            Decision::Contact => slack < doubt,
            Decision::Undecided => slack.abs() <= doubt,
        };
        assert!(
            is_right,
            "{decision:?}, but {slack} (resolution {resolution}) in {:?}",
            self.frame
        );
        decision == Decision::Clear
    }

    fn level_legs(&mut self) -> Result<bool, RobotError> {
        let opening = [0.0, 1e-15, 1e-12, 1e-9, -1e-9][self.source.below(5)];
        let (cuts, is_reversed) = (1 + self.source.below(4), self.source.flag());
        let random = &mut self.random;
        let (leg, width) = (random.between(5.0, 60.0), random.between(3.0, 12.0));
        let wide = random.between(0.1, 0.48) * width;
        let thin = [wide, 0.3 * wide][self.source.below(2)].min(0.4 * width);
        let (sin, cos) = f64::sin_cos(0.5 * opening);
        let foot = |side: f64| Vector::X * (0.5 * side * width);
        let tip = |side: f64| foot(side) + Vector::new(side * leg * sin, leg * cos, 0.0);
        let share = |k: usize| k as f64 / cuts as f64;
        let mut points: Vec<_> = (0..cuts).map(|k| tip(-1.0).lerp(foot(-1.0), share(k))).collect();
        points.push(foot(-1.0));
        points.extend((0..=cuts).map(|k| foot(1.0).lerp(tip(1.0), share(k))));
        let mut radii = vec![wide; 2 * cuts + 1];
        radii[cuts] = thin;
        if is_reversed {
            points.reverse();
        }
        let build = [Chain::from_centreline, Chain::capsules][self.source.below(2)];
        let chain = build(&self.placed(&points), &self.scaled(&radii))?;
        // A square corner of short links may be too sharp.
        if let Ok(found) = SelfQuery::new().minimum(&chain) {
            let found = found.map(|found| found.distance / self.unit);
            let gap = width - 2.0 * wide;
            let is_right = found.is_some_and(|found| (found - gap).abs() < 1e-6);
            assert!(is_right, "{found:?}, but {gap}: {chain:?}");
        }
        Ok(false)
    }

    fn faces(&mut self) -> Result<bool, RobotError> {
        let gap = self.gap();
        let resolution = [1e-3, 1e-6][self.source.below(2)];
        let [radius, other] = [(); 2].map(|()| self.random.between(0.2, 2.0));
        let [x, y] = [(); 2].map(|()| self.random.between(-0.4, 0.4));
        let tip = Vector::new(x, y, gap);
        let length = self.random.between(2.0, 9.0);
        let ends = self.placed(&[tip, tip + Vector::Z * length]);
        let rod = Tube::from(&Chain::from_centreline(&ends, &self.scaled(&[radius]))?);
        let scaled = resolution * self.unit;
        let decision = if self.source.flag() {
            let ends = self.placed(&[-Vector::Z * 3.0, Vector::ZERO]);
            let below = Tube::from(&Chain::from_centreline(&ends, &self.scaled(&[other]))?);
            let at = Pose::IDENTITY;
            RobotPair::new().clears_tubes(&rod, &at, &below, &at, 0.0, scaled)
        } else {
            let square = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
            let square = self.placed(&square.map(|[x, y]| Vector::new(x, y, 0.0)));
            let mut search =
                BvhSearch::from_triangles(&square, &[[0, 1, 2], [0, 2, 3]]).expect("two triangles");
            search.clears_tube(&rod, &Pose::IDENTITY, 0.0, scaled)
        };
        Ok(self.check(decision.expect("a tube in range"), gap, resolution))
    }

    fn together(&mut self) -> Result<bool, RobotError> {
        let (margin, resolution) = (self.random.between(0.0, 1.0), 1e-3);
        let (radius, slack) = (self.random.between(0.2, 1.0), self.gap().max(-margin));
        let shift = self.random.direction() * [0.0, 20.0, 2000.0][self.source.below(3)];
        let motion = |x: f64| {
            let from = [Vector::X * x, Vector::X * x + Vector::Z * 20.0];
            let to = self.placed(&from.map(|point| point + shift));
            LinearMotion::chain(&self.placed(&from), &to, &self.scaled(&[radius]))
        };
        let robots = [motion(0.0)?, motion(2.0 * radius + margin + slack)?];
        let [wanted, scaled] = [margin, resolution].map(|length| length * self.unit);
        let answer = RobotPair::new().clears_motions(&robots[0], &robots[1], wanted, scaled);
        Ok(self.check(answer.expect("two motions in range").decision, slack, resolution))
    }

    fn long_path(&mut self) -> Result<bool, RobotError> {
        let (margin, resolution) = (self.random.between(0.0, 1.0), 1e-2);
        let (radius, slack) = (self.random.between(0.2, 1.0), self.gap().max(-margin));
        let parts = 100 * (1 + self.source.below(3));
        // Above a square floor the robot goes up and down, and the base moves along the floor.
        let lowest = radius + margin + slack;
        let shape = |k: usize| {
            let at = Vector::Z * (lowest + [0.0, 1.0][k % 2]);
            self.placed(&[at - Vector::X * 3.0, at + Vector::X * 3.0])
        };
        let radii = self.scaled(&[radius]);
        let part = |k: usize| LinearMotion::capsules(&shape(k), &shape(k + 1), &radii);
        let path = MotionPath::new((0..parts).map(part).collect::<Result<_, _>>()?)?;
        let way = self.frame.rotation * Vector::Y * [0.0, 5.0, 30.0][self.source.below(3)];
        let to = Pose::from_translation(way * self.unit);
        let motion = MovingBase::new(path, [Pose::IDENTITY, to])?;
        let square = [[-90.0, -90.0], [90.0, -90.0], [90.0, 90.0], [-90.0, 90.0]];
        let square = self.placed(&square.map(|[x, y]| Vector::new(x, y, 0.0)));
        let mut search =
            BvhSearch::from_triangles(&square, &[[0, 1, 2], [0, 2, 3]]).expect("two triangles");
        let [wanted, scaled] = [margin, resolution].map(|length| length * self.unit);
        let answer = search.clears_motion(&motion, wanted, scaled).expect("a motion in range");
        Ok(self.check(answer.decision, slack, resolution))
    }

    fn seams(&mut self) -> Result<bool, RobotError> {
        let ulps = self.source.below(5) as f64 - 2.0;
        let offset = [0.0, 1.0, 1e3, -1e7][self.source.below(4)];
        let cuts = 1 + self.source.below(6);
        let seam = offset + ulps * f64::EPSILON * f64::abs(offset).max(2.0);
        // The near half has one corner on the seam, the far half several: T-vertices.
        let place = |x: f64, y: f64| Vector::new(x, y, 0.0);
        let mut corners = vec![place(-4.0, seam), place(4.0, seam), place(0.0, offset - 4.0)];
        let mut triangles = vec![[0, 1, 2]];
        let apex = corners.len() as u32;
        corners.push(place(0.0, offset + 4.0));
        for k in 0..=cuts {
            corners.push(place(-4.0 + 8.0 * k as f64 / cuts as f64, offset));
            if k > 0 {
                triangles.push([apex, apex + k as u32, apex + k as u32 + 1]);
            }
        }
        let height = self.random.between(0.5, 1.5);
        let end = |y: f64| Vector::new(0.3, offset + y, height);
        let robot = Chain::capsules(&[end(-0.5), end(0.5)], &[0.25])?;
        let mut search = BvhSearch::from_triangles(&corners, &triangles).expect("a floor");
        let mut found = Vec::new();
        for prominence in [0.0, 0.1] {
            let asked =
                search.contacts_within(&robot, &Pose::IDENTITY, 2.0, prominence, &mut found);
            asked.expect("a chain in range");
            let is_right = found.len() == 1 && (found[0].distance - (height - 0.25)).abs() < 1e-12;
            assert!(is_right, "{found:?}: {ulps} ulps at {offset}, {cuts} cuts");
        }
        Ok(true)
    }

    fn disks(&mut self) -> Result<bool, RobotError> {
        let theta = self.random.between(0.05, 1.0);
        let (chords, thickness) = (1 + self.source.below(8), self.random.between(0.6, 1.0));
        let radius = 4.0 / theta;
        let on_arc = |k: usize| {
            let (sin, cos) = f64::sin_cos(theta * k as f64 / chords as f64);
            Vector::new(radius * (1.0 - cos), 0.0, radius * sin)
        };
        let mut points = vec![Vector::Z * -thickness];
        points.extend((0..=chords).map(on_arc));
        let (sin, cos) = f64::sin_cos(theta);
        points.push(on_arc(chords) + Vector::new(sin, 0.0, cos) * thickness);
        let mut radii = vec![0.5; chords + 2];
        (radii[0], radii[chords + 1]) = (5.0, 5.0);
        let chain = Chain::from_centreline(&self.placed(&points), &self.scaled(&radii))?;
        let gap = 2.0 * (radius - 5.0) * f64::sin(0.5 * theta);
        let found = SelfQuery::new().minimum(&chain).expect("a chain in range");
        let found = found.map(|found| found.distance / self.unit);
        let is_right = found.is_some_and(|found| (found - gap.max(0.0)).abs() < 1e-9);
        assert!(is_right, "{found:?}, but {gap}: {chain:?}");
        let tube = Tube::from(&chain);
        let decision = SelfQuery::new().clears_tube(&tube, 0.0, 1e-6 * self.unit);
        Ok(self.check(decision.expect("a tube in range"), gap, 1e-6))
    }
}
