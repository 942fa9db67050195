//! Nothing hangs: fresh engines that many threads ask at once, far and near, in batches and from a
//! caller's own tasks.
//!
//! Each query goes to an engine that has built nothing yet, so that threads meet while it builds.
//! How they meet is random. `src/threads/lazy.rs` and `tests/package/threads.rs` show without
//! chance that no build uses the pool. `PARRY_CONTINUUM_ROUNDS` sets the rounds, such as a
//! thousand.

use continuum_testing::{Random, answered, rounds};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::{Ball, TriMesh};
use parry_continuum::proximity::{BvhSearch, Exhaustive, Proximity, Side};
use parry_continuum::{Chain, LinearMotion, Tube};
use rayon::prelude::*;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

const RADIUS: f64 = 10.0;
/// Enough vertices that a box around them is worth several threads.
const WIDE: (u32, u32) = (192, 96);
/// Enough triangles that a hierarchy is worth several threads.
const SMALL: (u32, u32) = (96, 48);

/// Runs `work` in pools of 2, 16 and 32 threads. Fails if one takes longer than any machine needs.
fn in_time(rounds: usize, work: impl Fn(usize) + Clone + Send + Sync + 'static) {
    let asked = std::env::var("PARRY_CONTINUUM_ROUNDS").ok().and_then(|rounds| rounds.parse().ok());
    let rounds = asked.unwrap_or(rounds);
    for threads in [2, 16, 32] {
        let (done, is_done) = channel();
        let work = work.clone();
        thread::spawn(move || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for round in 0..rounds {
                pool.install(|| work(round));
            }
            done.send(()).unwrap();
        });
        let limit = Duration::from_secs(60 + rounds as u64);
        assert!(
            is_done.recv_timeout(limit).is_ok(),
            "{rounds} rounds in a pool of {threads} threads"
        );
    }
}

fn ball((rows, columns): (u32, u32)) -> TriMesh {
    let (vertices, triangles) = Ball::new(RADIUS).to_trimesh(rows, columns);
    TriMesh::new(vertices, triangles).unwrap()
}

/// Robots in the ball; every second one sticks through it.
fn robots(count: u32) -> Vec<(Chain, Pose)> {
    let mut random = Random::new(7);
    let robot = |k: u32| {
        let way = random.point().normalize_or_zero() * if k.is_multiple_of(2) { 1.2 } else { 0.5 };
        let points: Vec<_> = (0..8).map(|joint| way * (RADIUS * f64::from(joint) / 7.0)).collect();
        (Chain::from_centreline(&points, &[0.05; 7]).unwrap(), Pose::IDENTITY)
    };
    (0..count).map(robot).collect()
}

/// So far away that single precision does not resolve them beside the ball.
fn far(robots: &[(Chain, Pose)]) -> Vec<(Chain, Pose)> {
    let away = Pose::from_translation(Vector::new(4.0e4, 1.0e4, 0.0));
    robots.iter().map(|(robot, _)| (robot.clone(), away)).collect()
}

fn borrowed(robots: &[(Chain, Pose)]) -> Vec<(&Chain, Pose)> {
    robots.iter().map(|(robot, pose)| (robot, *pose)).collect()
}

#[test]
fn batches_of_far_robots_end() {
    let (mesh, robots) = (ball(SMALL), far(&robots(64)));
    in_time(rounds(80), move |_| {
        let mut search = BvhSearch::new(&mesh).unwrap();
        let mut out = Vec::new();
        search.minimum_batch(&borrowed(&robots), &mut out).unwrap();
        assert!(answered(&out).iter().all(|answer| answer.distance > 1.0e4));
    });
}

#[test]
fn batches_beside_a_wide_wall_end() {
    let (mesh, robots) = (ball(WIDE), robots(300));
    in_time(rounds(16), move |_| {
        let mut search = BvhSearch::new(&mesh).unwrap();
        let mut out = Vec::new();
        search.clears_batch(&borrowed(&robots), 0.1, &mut out).unwrap();
        assert!(
            out.iter()
                .zip([false, true].into_iter().cycle())
                .all(|(clears, expected)| *clears == Ok(expected))
        );
        let (mut least, mut each) = (Vec::new(), Vec::new());
        search.minimum_batch(&borrowed(&robots[..32]), &mut least).unwrap();
        search.per_link_batch(&borrowed(&robots[..32]), &mut each).unwrap();
        assert!(
            answered(&least)
                .iter()
                .zip(answered(&each))
                .all(|(least, each)| each.iter().all(|a| a.distance >= least.distance))
        );
    });
}

#[test]
fn batches_of_tubes_end() {
    let (mesh, robots) = (ball(SMALL), robots(32));
    let tubes: Vec<_> = robots.iter().map(|(robot, pose)| (Tube::from(robot), *pose)).collect();
    in_time(rounds(16), move |round| {
        let mut search = BvhSearch::new(&mesh).unwrap();
        let away = if round % 2 == 0 { Vector::ZERO } else { Vector::new(4.0e4, 1.0e4, 0.0) };
        let asked: Vec<_> =
            tubes.iter().map(|(tube, pose)| (tube, Pose::from_translation(away) * *pose)).collect();
        let (mut clearances, mut decisions) = (Vec::new(), Vec::new());
        search.clearance_batch(&asked, 0.5, &mut clearances).unwrap();
        search.clears_tube_batch(&asked, 0.1, 0.01, &mut decisions).unwrap();
        assert!(clearances.len() == tubes.len() && decisions.len() == tubes.len());
    });
}

/// Every question, by a caller's own tasks, of clones that share what is built.
fn ask_all(
    number: usize,
    search: &BvhSearch,
    scan: &Exhaustive<f32>,
    robot: &Chain,
    pose: &Pose,
    mesh: &TriMesh,
) {
    let (mut search, mut scan) = (search.clone(), scan.clone());
    let base = pose * robot.links()[0].start();
    let expected = if base.length() < RADIUS { Side::Inside } else { Side::Outside };
    // Another question first for each.
    for turn in number..number + 7 {
        match turn % 7 {
            0 => assert_eq!(search.side(base), expected),
            1 => {
                let mut contacts = Vec::new();
                search.contacts_within(robot, pose, 1.0, 0.0, &mut contacts).unwrap();
                assert!(contacts.iter().all(|contact| contact.distance <= 1.0));
            }
            2 => {
                let least = search.minimum(robot, pose).unwrap();
                let proven = least.certify(robot, pose, mesh).unwrap();
                assert!(proven.lower <= proven.upper);
                assert_eq!(least.distance, scan.minimum(robot, pose).unwrap().distance);
            }
            3 => drop(search.clears(robot, pose, 0.1).unwrap()),
            4 => {
                let mut each = Vec::new();
                search.per_link(robot, pose, &mut each).unwrap();
                assert_eq!(each.len(), robot.links().len());
            }
            5 => drop(scan.clears(robot, pose, 0.1).unwrap()),
            _ => drop(search.clears_inside(robot, pose, 0.1).unwrap()),
        }
    }
}

#[test]
fn questions_from_a_callers_tasks_end() {
    let (mesh, near) = (ball(SMALL), robots(64));
    let far = far(&near);
    in_time(rounds(40), move |round| {
        let (search, scan) =
            (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f32>::new(&mesh).unwrap());
        let robots = if round % 2 == 0 { &near } else { &far };
        robots.par_iter().enumerate().for_each(|(number, (robot, pose))| {
            ask_all(number, &search, &scan, robot, pose, &mesh);
        });
    });
}

/// A wide mesh, so that what is built would be worth several threads.
#[test]
fn the_side_of_points_from_a_callers_tasks_is_found() {
    let mesh = ball(WIDE);
    in_time(rounds(16), move |_| {
        let search = BvhSearch::new(&mesh).unwrap();
        let inside = |k: u32| search.side(Vector::X * (0.1 * f64::from(k))) == Side::Inside;
        assert_eq!((0..200).into_par_iter().filter(|&k| inside(k)).count(), 100);
    });
}

/// Threads outside of the pool wait for what a task in the pool builds, and the other way round.
#[test]
fn questions_from_threads_and_tasks_together_end() {
    let (mesh, near) = (ball(SMALL), robots(24));
    let far = far(&near);
    in_time(rounds(24), move |round| {
        let (search, scan) =
            (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f32>::new(&mesh).unwrap());
        let robots = if round % 2 == 0 { &near } else { &far };
        let ask = |number: usize| {
            let (robot, pose) = &robots[number];
            ask_all(number, &search, &scan, robot, pose, &mesh);
        };
        thread::scope(|scope| {
            for first in 0..4 {
                scope.spawn(move || (first..24).step_by(4).for_each(ask));
            }
            (0..24).into_par_iter().for_each(ask);
        });
    });
}

/// Motions have no batch: each task queries a clone.
#[test]
fn motions_from_a_callers_tasks_are_judged() {
    let (mesh, robots) = (ball(SMALL), robots(16));
    in_time(rounds(16), move |round| {
        let search = BvhSearch::new(&mesh).unwrap();
        let away = if round % 2 == 0 { 0.0 } else { 4.0e4 };
        robots.par_iter().for_each(|(robot, _)| {
            let points: Vec<_> = robot.links().iter().map(|link| link.start()).collect();
            let [from, to] = [0.0, 0.1].map(|step| {
                points.iter().map(|&point| point + Vector::X * (away + step)).collect::<Vec<_>>()
            });
            let motion = LinearMotion::chain(&from, &to, &[0.05; 6]).unwrap();
            search.clone().clears_motion(&motion, 0.1, 0.1).unwrap();
        });
    });
}
