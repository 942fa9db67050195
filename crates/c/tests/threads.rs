//! 8 threads ask clones of one mesh through the C interface; each answer is that of one thread.
//! `threads CALLS`. ThreadSanitizer sees this program whole; `threads.c` is the same in C.

use parry_continuum::parry::shape::Ball;
use parry_continuum_c::{
    pc_chain, pc_chain_free, pc_chain_new, pc_mesh, pc_mesh_clone, pc_mesh_free, pc_mesh_minimum,
    pc_mesh_minimum_batch, pc_mesh_new, pc_minimum, pc_status,
};
use std::ptr::{null, null_mut};
use std::thread;

const THREADS: usize = 8;
const SHAPES: usize = 64;

/// Handles that may move from thread to thread, as the header says.
struct Shared(*mut pc_mesh, Vec<*mut pc_chain>);
// SAFETY: the mesh is only cloned, and nobody changes the chains.
unsafe impl Sync for Shared {}

fn check(status: pc_status) {
    assert_eq!(status, pc_status::PC_OK);
}

fn minimum(mesh: *mut pc_mesh, chain: *const pc_chain) -> f64 {
    let mut found = std::mem::MaybeUninit::<pc_minimum>::uninit();
    // SAFETY: live handles, and a place for the answer.
    check(unsafe { pc_mesh_minimum(mesh, chain, null(), found.as_mut_ptr()) });
    // SAFETY: it is written after `PC_OK`.
    unsafe { found.assume_init() }.distance
}

fn main() {
    let calls: usize = std::env::args().nth(1).expect("the number of calls").parse().unwrap();
    let (vertices, triangles) = Ball::new(10.0).to_trimesh(50, 25);
    let [points, faces] = [vertices.as_ptr().cast::<u8>(), triangles.as_ptr().cast::<u8>()];
    let mut mesh = null_mut();
    // SAFETY: both pointers have as many items as is said.
    check(unsafe {
        pc_mesh_new(points.cast(), vertices.len(), faces.cast(), triangles.len(), &mut mesh)
    });
    let robot = |k: usize| {
        let place = |i: usize| [0.001 * (k * i * i) as f64, 0.1 * (k % 7) as f64, i as f64 - 5.0];
        let points: Vec<_> = (0..10).map(place).collect();
        let mut chain = null_mut();
        // SAFETY: ten points and one radius.
        check(unsafe { pc_chain_new(points.as_ptr().cast(), 10, &0.2, 1, 0, &mut chain) });
        chain
    };
    let shared = Shared(mesh, (0..SHAPES).map(robot).collect());
    let expected: Vec<_> = shared.1.iter().map(|chain| minimum(mesh, *chain)).collect();
    thread::scope(|scope| {
        for thread in 0..THREADS {
            let (shared, expected) = (&shared, &expected);
            scope.spawn(move || {
                let mut own = null_mut();
                // SAFETY: many threads may clone one mesh that nobody asks.
                check(unsafe { pc_mesh_clone(shared.0, &mut own) });
                for call in 0..calls / THREADS {
                    let shape = (5 * call + thread) % SHAPES;
                    assert_eq!(minimum(own, shared.1[shape]), expected[shape]);
                    if call % 10_000 == 0 {
                        let mut minima = Vec::with_capacity(SHAPES);
                        let chains = shared.1.as_ptr().cast();
                        let (answers, statuses) = (minima.as_mut_ptr(), null_mut());
                        // SAFETY: live handles, and places for as many answers.
                        check(unsafe {
                            pc_mesh_minimum_batch(own, chains, null(), SHAPES, answers, statuses)
                        });
                        // SAFETY: all are written after `PC_OK`.
                        unsafe { minima.set_len(SHAPES) };
                        assert!(minima.iter().zip(expected).all(|(a, b)| a.distance == *b));
                    }
                }
                // SAFETY: freed once.
                unsafe { pc_mesh_free(own) };
            });
        }
    });
    for chain in shared.1 {
        // SAFETY: freed once.
        unsafe { pc_chain_free(chain) };
    }
    // SAFETY: freed once.
    unsafe { pc_mesh_free(mesh) };
    println!("{calls} calls on {THREADS} threads, none wrong");
}
