//! The search on the GPU with robots and meshes of hostile sizes and shapes: the answers of the
//! search on the CPU, to the last bit.

use crate::search::{same_contacts, same_decisions, same_links, same_minima};
use continuum_testing::{Random, answered, gpu};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};

fn ball(around: u32, up: u32) -> TriMesh {
    let (vertices, indices) = Ball::new(10.0).to_trimesh(around, up);
    TriMesh::new(vertices, indices).unwrap()
}

/// A robot of this many links that wanders through the ball and its wall.
fn robot(random: &mut Random, links: usize) -> Chain {
    let mut points = vec![random.point() * 4.0];
    let mut heading = random.direction();
    for k in 0..links {
        heading = (heading + random.direction() * 0.3 - points[k] * 0.02).normalize();
        points.push(points[k] + heading * 0.3);
    }
    let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][links % 3];
    build(&points, &vec![random.between(0.05, 0.2); links]).unwrap()
}

/// Compares all three batches for several margins, and contacts. Returns the distances.
fn check(mesh: &TriMesh, robots: &[(&Chain, Pose)]) -> Option<Vec<f64>> {
    let mut engine = gpu::search(mesh)?;
    let mut reference = BvhSearch::new(mesh).unwrap();
    let minima = same_minima(&mut engine, &mut reference, robots);
    same_links(&mut engine, &mut reference, robots);
    let distances: Vec<_> = answered(&minima).iter().map(|least| least.distance).collect();
    for &margin in distances.iter().take(3).chain(&[0.0, 0.1, 1e6]) {
        same_decisions(&mut engine, &mut reference, robots, margin);
    }
    for &robot in robots.iter().step_by(7) {
        same_contacts(&mut engine, &mut reference, robot, 0.5);
    }
    Some(distances)
}

/// Parts have 32 links: sizes around one, two and more parts, alone and in one batch.
#[test]
fn robots_have_any_number_of_links() {
    let (mesh, mut random) = (ball(40, 20), Random::new(51));
    let sizes = [1, 2, 31, 32, 33, 64, 65, 1000, 10_000];
    let robots = sizes.map(|links| robot(&mut random, links));
    let robots: Vec<_> = robots.iter().map(|robot| (robot, random.pose(1.0))).collect();
    for count in [0, 1, 2, robots.len()] {
        check(&mesh, &robots[..count]);
        check(&mesh, &robots[robots.len() - count..]);
    }
}

/// No buffer of a device holds such a robot, and no word counts its candidates.
#[test]
fn a_robot_of_very_many_links_is_left_to_the_cpu() {
    let mesh = ball(8, 4);
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let mut random = Random::new(52);
    let (long, short) = (robot(&mut random, (1 << 20) + 1), robot(&mut random, 5));
    let robots = [&short, &long, &short].map(|robot| (robot, Pose::IDENTITY));
    same_minima(&mut engine, &mut BvhSearch::new(&mesh).unwrap(), &robots);
    assert_eq!(engine.answered_on_cpu(), 1);
}

/// Points and segments in place of triangles, some of them many times.
#[test]
fn triangles_without_area_are_met() {
    let mut random = Random::new(53);
    let mut corners = Vec::new();
    for k in 0..500 {
        let [a, b] = [0, 1].map(|_| random.direction() * random.between(5.0, 7.0));
        let b = a + (b - a) * 0.1;
        corners.extend([[a; 3], [a, b, b], [a, a.lerp(b, 0.3), b]][k % 3]);
    }
    corners.extend_from_within(..300);
    let indices = (0..corners.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let mesh = TriMesh::new(corners, indices).unwrap();
    let robots: Vec<_> = (0..60).map(|k| robot(&mut random, 3 + k)).collect();
    let robots: Vec<_> = robots.iter().map(|robot| (robot, random.pose(1.0))).collect();
    if let Some(distances) = check(&mesh, &robots) {
        let touching = distances.iter().filter(|&&distance| distance == 0.0).count();
        assert!((5..55).contains(&touching), "{touching}");
    }
}

/// A mesh that is one point, or one segment.
#[test]
fn meshes_without_area_are_met() {
    let mut random = Random::new(54);
    for corners in [[Vector::X; 3], [Vector::X, Vector::Y, Vector::Y]] {
        for count in [1, 2, 40] {
            let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]; count]).unwrap();
            let robots: Vec<_> = (0..20).map(|k| robot(&mut random, 1 + k)).collect();
            let robots: Vec<_> = robots.iter().map(|robot| (robot, random.pose(1.0))).collect();
            check(&mesh, &robots);
        }
    }
}

/// Points that repeat make no link, and nearly equal points make links far shorter than their
/// radius, down to lengths that single precision does not see.
#[test]
fn links_have_any_length() {
    let (mesh, mut random) = (ball(40, 20), Random::new(55));
    let robots: Vec<_> = (0..90)
        .map(|number| {
            let mut points = vec![random.direction() * random.between(7.0, 10.5)];
            for k in 0..20 {
                let length = [0.5, 0.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-12][(number + k) % 7];
                points.push(points[k] + random.direction() * length);
            }
            let build = [Chain::from_centreline, Chain::capsules, Chain::cylinders][number % 3];
            build(&points, &[random.between(0.01, 0.8); 20]).unwrap()
        })
        .collect();
    let robots: Vec<_> = robots.iter().map(|robot| (robot, random.pose(1.0))).collect();
    if let Some(distances) = check(&mesh, &robots) {
        let touching = distances.iter().filter(|&&distance| distance == 0.0).count();
        assert!((5..85).contains(&touching), "{touching}");
    }
}

/// A margin that no triangle is within needs no candidate, and one that all are within no search.
#[test]
fn a_margin_may_hold_no_triangle_or_all() {
    let (mesh, mut random) = (ball(40, 20), Random::new(56));
    let Some(mut engine) = gpu::search(&mesh) else { return };
    let robot = Chain::from_centreline(&[Vector::ZERO, Vector::X, Vector::Y], &[0.5; 2]).unwrap();
    let robots: Vec<_> = (0..500).map(|_| (&robot, random.pose(1.0))).collect();
    let mut clear = Vec::new();
    for (margin, expected) in [(0.0, true), (1e-300, true), (20.0, false), (f64::MAX, false)] {
        engine.clears_batch(&robots, margin, &mut clear).unwrap();
        assert_eq!(clear, vec![Ok(expected); robots.len()], "{margin}");
    }
    assert_eq!(engine.answered_on_cpu(), 0);
}
