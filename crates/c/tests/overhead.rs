//! The cost of a call through the C interface beside the same call in Rust, in one run.
//!
//! Both ask about the same robots in turn, in blocks that alternate; the least time of all blocks
//! counts. Fails if a call costs more than 50 ns more.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum_c::{
    pc_chain, pc_chain_free, pc_chain_new, pc_mesh, pc_mesh_clears, pc_mesh_free, pc_mesh_minimum,
    pc_mesh_new, pc_minimum, pc_status,
};
use std::hint::black_box;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};
use std::time::Instant;

const ROBOTS: usize = 64;
const BLOCKS: usize = 400;
const MARGIN: f64 = 1.0;
/// Nanoseconds.
const MOST: f64 = 50.0;

/// A robot of `links` links that bends a little more for each `k`.
fn points(links: usize, k: usize) -> Vec<Vector> {
    let bend = 0.02 * k as f64 / ROBOTS as f64;
    let place = |i: usize| {
        let length = 10.0 * i as f64 / links as f64;
        Vector::new(bend * length * length, 0.3, length - 5.0)
    };
    (0..=links).map(place).collect()
}

/// The least time of a call of each of the two, in nanoseconds.
fn compare(mut rust: impl FnMut(usize), mut c: impl FnMut(usize)) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for _ in 0..BLOCKS {
        for (k, least) in least.iter_mut().enumerate() {
            let start = Instant::now();
            for robot in 0..ROBOTS {
                if k == 0 { rust(robot) } else { c(robot) }
            }
            *least = least.min(start.elapsed().as_nanos() as f64 / ROBOTS as f64);
        }
    }
    least
}

fn main() {
    let (vertices, triangles) = Ball::new(10.0).to_trimesh(100, 50);
    let mut worst: f64 = 0.0;
    for links in [1, 30] {
        let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
        let shapes: Vec<_> = (0..ROBOTS).map(|k| points(links, k)).collect();
        let chains: Vec<_> = shapes
            .iter()
            .map(|points| Chain::from_centreline(points, &vec![0.5; links]).unwrap())
            .collect();
        let (mut mesh, mut handles): (*mut pc_mesh, Vec<*mut pc_chain>) = (null_mut(), Vec::new());
        // SAFETY: all pointers are to as many items as is said.
        let status = unsafe {
            pc_mesh_new(
                vertices.as_ptr().cast(),
                vertices.len(),
                triangles.as_ptr().cast(),
                triangles.len(),
                &mut mesh,
            )
        };
        assert_eq!(status, pc_status::PC_OK);
        for points in &shapes {
            let mut chain = null_mut();
            let start = points.as_ptr().cast();
            // SAFETY: all pointers are to as many items as is said.
            let status = unsafe { pc_chain_new(start, points.len(), &0.5, 1, 0, &mut chain) };
            assert_eq!(status, pc_status::PC_OK);
            handles.push(chain);
        }

        let mut found = MaybeUninit::<pc_minimum>::uninit();
        let minimum = compare(
            |k| {
                black_box(search.minimum(&chains[k], &Pose::IDENTITY).unwrap());
            },
            |k| {
                // SAFETY: live handles, and a place for the answer.
                let status =
                    unsafe { pc_mesh_minimum(mesh, handles[k], null(), found.as_mut_ptr()) };
                assert_eq!(black_box(status), pc_status::PC_OK);
            },
        );
        let mut truth = false;
        let clears = compare(
            |k| {
                black_box(search.clears(&chains[k], &Pose::IDENTITY, MARGIN).unwrap());
            },
            |k| {
                // SAFETY: live handles, and a place for the answer.
                let status =
                    unsafe { pc_mesh_clears(mesh, handles[k], null(), MARGIN, &mut truth) };
                assert_eq!(black_box(status), pc_status::PC_OK);
            },
        );
        for (name, [rust, c]) in [("minimum", minimum), ("clears", clears)] {
            println!("{name}, {links} links: Rust {rust:.0} ns, C {c:.0} ns, {:+.0} ns", c - rust);
            worst = worst.max(c - rust);
        }
        for chain in handles {
            // SAFETY: each handle is freed once.
            unsafe { pc_chain_free(chain) };
        }
        // SAFETY: as above.
        unsafe { pc_mesh_free(mesh) };
    }
    assert!(worst <= MOST, "a call costs {worst:.0} ns more than in Rust");
}
