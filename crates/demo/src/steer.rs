//! Finds a start and a goal in any mesh.
//!
//! The start: the point deepest inside, looking along the longest free line. The goal: the joints
//! that bring the robot furthest with room around it, found by sampling thousands of shapes and
//! improving the best; each costs one `minimum` query. A robot that touches nothing and whose base
//! is inside is inside all along. The way to the goal needs no plan of its own: the sections come
//! out one after the other, so that all of them stay on the goal's shape (`Robot::on_the_way`; to
//! keep that exact, a goal's first two sections are together no longer than the second).

use crate::ctr::{Joints, Robot};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity, ProximityError};
use parry_continuum::{Chain, RobotError};
use std::f64::consts::TAU;

/// Reproducible random numbers (splitmix64).
pub struct Random(pub u64);

impl Random {
    /// Uniform between 0 and 1.
    pub fn share(&mut self) -> Real {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as Real / (1u64 << 53) as Real
    }

    /// About normal, with standard deviation 1.
    fn normal(&mut self) -> Real {
        (0..12).map(|_| self.share()).sum::<Real>() - 6.0
    }
}

/// The point furthest from the surface among those inside it, or none if the surface encloses
/// nothing.
pub fn deepest_point(mesh: &TriMesh) -> Option<Vector> {
    const GRID: usize = 40;
    let aabb = mesh.local_aabb();
    let step = aabb.extents() / GRID as Real;
    let mut best: Option<(Real, Vector)> = None;
    let mut consider = |p: Vector| {
        let depth = mesh.distance_to_local_point(p, false);
        if best.is_none_or(|(deepest, _)| depth > deepest) {
            best = Some((depth, p));
        }
    };
    for i in 0..GRID {
        for j in 0..GRID {
            // Along a line upwards, inside and outside alternate where it crosses the surface.
            let foot = aabb.mins + step * Vector::new(i as Real + 0.5, j as Real + 0.5, -1.0);
            let crossings =
                crossings(mesh, Ray::new(foot, Vector::Z), aabb.extents().z + 2.0 * step.z);
            for inside in crossings.as_chunks::<2>().0 {
                let count = ((inside[1] - inside[0]) / step.z).ceil();
                (0..count as usize).for_each(|k| {
                    consider(
                        foot + Vector::Z
                            * (inside[0] + (inside[1] - inside[0]) * (k as Real + 0.5) / count),
                    );
                });
            }
        }
    }
    best.map(|(_, p)| p)
}

/// Where a ray crosses the surface, or nothing if their number shows that the surface is open
/// there.
fn crossings(mesh: &TriMesh, ray: Ray, limit: Real) -> Vec<Real> {
    let (mut all, mut from) = (Vec::new(), 0.0);
    while let Some(t) =
        mesh.cast_local_ray(&Ray::new(ray.point_at(from), ray.dir), limit - from, false)
    {
        all.push(from + t);
        from += t + 1e-9 * limit;
    }
    if all.len() % 2 == 0 { all } else { Vec::new() }
}

/// The direction of the longest free line from a point.
pub fn clear_direction(mesh: &TriMesh, from: Vector) -> Vector {
    const DIRECTIONS: usize = 500;
    let limit = 2.0 * mesh.local_aabb().extents().length();
    let spiral = (0..DIRECTIONS).map(|k| {
        let z = 1.0 - (2 * k + 1) as Real / DIRECTIONS as Real;
        let turn = k as Real * TAU * 0.618_033_988_749_894_9;
        Vector::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
    });
    let free = |d: &Vector| mesh.cast_local_ray(&Ray::new(from, *d), limit, false).unwrap_or(limit);
    spiral.max_by(|a, b| free(a).total_cmp(&free(b))).unwrap_or(Vector::Z)
}

/// Shapes tried at random, how many of the best are improved, and in how many steps each.
const SAMPLES: usize = 6000;
const CLIMBERS: usize = 8;
const STEPS: usize = 2500;

/// Whether a point is inside the surface: whether the surface winds around it.
pub fn is_inside(mesh: &TriMesh, p: Vector) -> bool {
    // The solid angle of a triangle (Van Oosterom and Strackee, 1983).
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| mesh.vertices()[i as usize] - p);
        let [x, y, z] = [a.length(), b.length(), c.length()];
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    mesh.indices().iter().map(angle).sum::<Real>().abs() > TAU
}

/// Why no goal was found.
#[derive(Debug)]
pub enum NoGoal {
    /// Every shape that was tried touches the wall.
    NoRoom,
    Robot(RobotError),
    Query(ProximityError),
}

/// The joints that bring the robot far into the lumen with room around it: the longest shape, where
/// one that comes nearer to the wall than half the robot's largest radius counts for less in
/// proportion.
pub fn find_goal(robot: &Robot, mesh: &mut BvhSearch, base: &Pose) -> Result<Joints, NoGoal> {
    let mut random = Random(1);
    let wide = robot.sections.iter().map(|section| section.radius).fold(0.0, Real::max);
    let mut score = |joints: &Joints| {
        let line = robot.centreline(joints, 16);
        let chain = Chain::capsules(&line.points, &line.radii).map_err(NoGoal::Robot)?;
        let clearance = mesh.minimum(&chain, base).map_err(NoGoal::Query)?.distance;
        Ok(robot.length(joints) * (2.0 * clearance / wide).min(1.0))
    };

    let mut shapes = Vec::new();
    for _ in 0..SAMPLES {
        let joints = robot.any_joints(&mut random);
        shapes.push((score(&joints)?, joints));
    }
    shapes.sort_by(|a, b| b.0.total_cmp(&a.0));
    shapes.truncate(CLIMBERS);
    for (height, joints) in &mut shapes {
        for step in 0..STEPS {
            let next = robot.nearby(joints, 1.0 - step as Real / STEPS as Real, &mut random);
            let reached = score(&next)?;
            if reached > *height {
                (*height, *joints) = (reached, next);
            }
        }
    }
    let best = shapes.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(height, _)| *height > 0.0).map(|(_, joints)| joints).ok_or(NoGoal::NoRoom)
}

impl Robot {
    /// Random joints, short extensions being as likely as long ones.
    pub fn any_joints(&self, random: &mut Random) -> Joints {
        let reach = random.share();
        let extensions = self.sections.iter().map(|s| s.length * reach * random.share()).collect();
        let tubes = self.sections.iter().map(|section| section.tubes.len()).sum();
        self.limited(Joints {
            extensions,
            angles: (0..tubes).map(|_| TAU * random.share()).collect(),
        })
    }

    /// Joints a random step away.
    fn nearby(&self, joints: &Joints, spread: Real, random: &mut Random) -> Joints {
        let lengths = self.sections.iter().map(|section| section.length);
        let extensions = joints.extensions.iter().zip(lengths);
        let extensions =
            extensions.map(|(e, length)| e + 0.1 * spread * length * random.normal()).collect();
        let angles = joints.angles.iter().map(|angle| angle + spread * random.normal()).collect();
        self.limited(Joints { extensions, angles })
    }

    /// The joints within their limits, so that every section is seen and the way in is exact.
    fn limited(&self, mut joints: Joints) -> Joints {
        for (extension, section) in joints.extensions.iter_mut().zip(&self.sections) {
            *extension = extension.clamp(0.05 * section.length, section.length);
        }
        let room = self.sections[1].length - joints.extensions[1];
        joints.extensions[0] = joints.extensions[0].min(room.max(0.0));
        joints
    }
}
