//! Lower bounds on the distances of a moving robot from the structures of a scene, without a query.
//!
//! # Definitions
//! - s: the reading of the [`Odometer`], an upper bound on the path of any point of the robot.
//! - d: a distance of the robot from a structure, recorded at the reading s0.
//! - r: the bound on rounding below.
//!
//! # Algorithm
//! 1. Advance the odometer once per query, for all structures ([`DistanceCache::begin`]).
//! 2. Record `reached_at = d - r + s0` ([`DistanceCache::record`]).
//! 3. The lower bound is `reached_at - s - r = d - (s - s0) - 2 r`
//!    ([`DistanceCache::lower_bound`]).
//!
//! **Claim.** The lower bound is at most the distance that an engine would measure now.
//! **Proof.** No point of the robot has moved by more than s - s0 since the record, so the distance
//! is at least d - (s - s0). Each r covers one measurement: step 2 the old one, step 3 the new one.
//!
//! **Rounding.** The path is measured in the scene's frame, the distance in a mesh's frame. Let M
//! be the largest coordinate of robot and structure in the scene, radius and translations included.
//!
//! 1. In the scene a link is placed with an error of 74 u M, as in [`PlacedRobot`].
//! 2. In the mesh's frame the product of two poses places the link. Its rotation errs by less than
//!    24 u and its length by as much, which moves points of size 2 M by less than 170 u M. The
//!    rotated point errs by 70 u M, the rotated translation and that of the inverse by 35 u M each,
//!    and sums by 11 u M.
//! 3. So the two places of an axis end are less than 400 u M apart.
//! 4. A distance errs by 16 u of an extent below 4 M. The subtractions here err by 4 u of it.
//! 5. All of that is less than 1024 u M, with the rim of a flat cap accounted for
//!    ([`Odometer::error_from_ends`]). The code uses r = 2048 u M.
//!
//! If coordinates are so large that a place in a mesh's frame could be out of range, r is infinite.
//! The lower bound is then -infinity, and the engine is asked.

use super::odometer::Odometer;
use crate::distance::Scalar;
use crate::pair::PlacedRobot;
use crate::query::nearest::PlacedOutline;
use crate::robot::COORDINATE_LIMIT;
use parry3d_f64::math::Real;

/// The number of steps of the robot that one look-ahead query serves.
const STEPS: Real = 8.0;

/// The distances of one robot from the structures of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct DistanceCache {
    odometer: Odometer,
    structures: Vec<CachedDistance>,
    /// The extra search radius of a look-ahead query; `None` if such a query does not pay.
    room: Option<Real>,
}

/// The distance from one structure.
#[derive(Clone, Copy, Debug)]
struct CachedDistance {
    /// The reading of the odometer at which the robot may reach the structure.
    reached_at: Real,
    /// Whether the robot was near at the last query. A look-ahead query would then fail.
    is_near: bool,
}

impl CachedDistance {
    const UNKNOWN: Self = Self { reached_at: Real::NEG_INFINITY, is_near: false };
}

impl DistanceCache {
    /// Begins a query: the robot has moved here, among `structures` structures.
    pub fn begin(&mut self, robot: PlacedRobot, structures: usize) {
        if !self.odometer.advance(robot) {
            self.structures.clear();
        }
        self.structures.resize(structures, CachedDistance::UNKNOWN);
        let room = STEPS * self.odometer.last_step();
        // A look-ahead query cannot cover a robot that jumps. For a robot that rests, the warm
        // start of the engines is enough.
        self.room = (0.0 < room && room < PlacedOutline::around_all(robot).size()).then_some(room);
    }

    /// Forgets the distance from a structure that has moved.
    pub fn forget(&mut self, structure: usize) {
        if let Some(watched) = self.structures.get_mut(structure) {
            *watched = CachedDistance::UNKNOWN;
        }
    }

    /// The extra search radius of a look-ahead query; `None` if such a query does not pay.
    pub fn look_ahead(&self) -> Option<Real> {
        self.room
    }

    /// Returns whether a look-ahead query is likely to succeed. Skips one such query after each
    /// failure, and after each answer that the robot is near.
    pub fn is_worth_a_query(&mut self, structure: usize) -> bool {
        !std::mem::take(&mut self.structures[structure].is_near)
    }

    /// Records that the robot is near a structure.
    pub fn mark_near(&mut self, structure: usize) {
        self.structures[structure].is_near = true;
    }

    /// Step 2: records that the robot is at least `apart` from a structure. `size` is the largest
    /// coordinate of its mesh and its pose.
    pub fn record(&mut self, structure: usize, apart: Real, size: Real) {
        let at = (apart - self.rounding(size) + self.odometer.reading()).next_down();
        let CachedDistance { reached_at, .. } = &mut self.structures[structure];
        *reached_at = reached_at.max(at);
    }

    /// Step 3: a lower bound on the distance from a structure of this `size`.
    pub fn lower_bound(&self, structure: usize, size: Real) -> Real {
        let left = self.structures[structure].reached_at - self.odometer.reading();
        left.next_down() - self.rounding(size)
    }

    /// Whether every place in the frame of a structure of this `size` is certainly in range.
    pub fn is_in_range(&self, size: Real) -> bool {
        self.odometer.extent() + size < COORDINATE_LIMIT / 16.0
    }

    fn rounding(&self, size: Real) -> Real {
        if self.is_in_range(size) {
            let largest = self.odometer.extent() + size;
            self.odometer.error_from_ends(2048.0 * Real::UNIT_ROUNDOFF * largest)
        } else {
            Real::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{BvhSearch, Proximity};
    use crate::robot::Chain;
    use crate::scene::structure::Structure;
    use continuum_testing::Random;
    use parry3d_f64::math::{Pose, Vector};

    /// The motion that brings a robot to the wall z = 0.
    #[derive(Clone, Copy, Debug, PartialEq)]
    enum Way {
        Whole,
        Start,
        End,
        Radius,
        /// The rim of a thin disc that turns.
        Rim,
        /// A little of each of these, forward and back.
        Any,
        /// Another robot takes its place: with other caps, or with more links.
        Swaps,
    }

    const WAYS: [Way; 7] =
        [Way::Whole, Way::Start, Way::End, Way::Radius, Way::Rim, Way::Any, Way::Swaps];

    struct Robot {
        points: [Vector; 3],
        radius: Real,
        local: Pose,
        model: usize,
        links: usize,
    }

    impl Robot {
        fn new(random: &mut Random, way: Way) -> Self {
            let (low, slanted) = (random.between(2.0, 3.0), random.direction());
            let flat = Vector::new(slanted.x, slanted.y, 0.0);
            let thin = [0.02, 1e-4][random.below(2) as usize];
            let (points, radius) = match way {
                Way::Rim => ([low, low + thin, low + 2.0 * thin].map(|z| Vector::Z * z), 1.0),
                Way::Start => {
                    ([Vector::Z * low, Vector::new(1.0, 0.0, low + 1.0), Vector::Z * 5.0], 0.3)
                }
                Way::End => {
                    ([Vector::Z * 5.0, Vector::new(1.0, 0.0, low + 1.0), Vector::Z * low], 0.3)
                }
                _ => ([Vector::Z * low + flat, Vector::Z * low, Vector::Z * (low + 1.0)], 0.3),
            };
            let model = if way == Way::Rim { 1 } else { random.below(2) as usize };
            Self { points, radius, local: Pose::IDENTITY, model, links: 2 }
        }

        fn walk(&mut self, random: &mut Random, way: Way, step: Real) {
            match way {
                Way::Whole => self.local.translation.z -= step,
                Way::Start => self.points[0].z -= step,
                Way::End => self.points[2].z -= step,
                Way::Radius => self.radius += step,
                Way::Rim => {
                    let about = Pose::from_translation(self.points[1]);
                    let turn = Pose::rotation(Vector::X * step);
                    self.local = self.local * about * turn * about.inverse();
                }
                Way::Any => {
                    let way = WAYS[random.below(5) as usize];
                    let share = [1.0, -0.5][random.below(2) as usize];
                    self.walk(random, way, step * share);
                }
                Way::Swaps => match random.below(8) {
                    0 => self.model = 1 - self.model,
                    1 => self.links = 3 - self.links,
                    2 => self.points.reverse(),
                    _ => self.local.translation.z += step * random.between(-1.0, 1.0),
                },
            }
        }

        fn chain(&self, size: Real) -> Chain {
            let points: Vec<_> =
                self.points[2 - self.links..].iter().map(|&point| point * size).collect();
            let make = [Chain::capsules, Chain::cylinders][self.model];
            make(&points, &vec![self.radius * size; self.links]).unwrap()
        }
    }

    /// The lower bound never exceeds the distance, at any place and in any unit. If the nearest
    /// point heads for the wall, the bound is almost the distance.
    #[test]
    fn no_robot_is_nearer_than_told() {
        let (mut told, mut sharp) = ([0_u32; 7], [0_u32; 7]);
        for seed in 0..1400 {
            let (random, kind) = (&mut Random::new(seed), seed as usize % WAYS.len());
            let size = [1.0, 2.0_f64.powi(-300), 2.0_f64.powi(300)][random.below(3) as usize];
            let wall = [[-99.0, -99.0, 0.0], [99.0, -99.0, 0.0], [0.0, 99.0, 0.0]];
            let wall = wall.map(|corner| Vector::from_array(corner) * size);
            let search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]]).unwrap();
            let mut structure = Structure::new(String::new(), search, None);
            let far = [1.0, 1e5][random.below(2) as usize];
            let mut pose = random.pose(far);
            pose.translation *= size;
            structure.set_pose(&pose).unwrap();

            let (way, step) = (WAYS[kind], 10.0_f64.powf(random.between(-4.0, -1.7)));
            let (mut robot, mut watch, mut noted) =
                (Robot::new(random, way), DistanceCache::default(), None);
            for question in 0..40 {
                robot.walk(random, way, step);
                let mut local = robot.local;
                local.translation *= size;
                let (chain, at) = (robot.chain(size), pose * local);
                watch.begin(PlacedRobot::new(&chain, &at).unwrap(), 1);
                let mut fresh = structure.search.clone();
                let distance = fresh.minimum(&chain, &structure.in_mesh(&at)).unwrap().distance;
                let bound = watch.lower_bound(0, structure.size());
                assert!(bound <= distance, "seed {seed}, {way:?}: {bound:e} of {distance:e}");
                if let Some(noted) = noted
                    && bound > 0.0
                {
                    told[kind] += 1;
                    sharp[kind] += u32::from(distance - bound < 0.1 * (noted - distance));
                }
                if question % 10 == 1 {
                    watch.record(0, distance, structure.size());
                    noted = Some(distance);
                }
            }
        }
        assert!(told.iter().all(|&told| told > 1000), "{told:?}");
        assert!(sharp[..5].iter().all(|&sharp| sharp > 1000), "{sharp:?}");
    }
}
