//! What the fuzzer runs for hours, for a moment: random bytes, and all that once broke something
//! (fuzz/corpus).

use continuum_testing::{Random, fuzz, rounds};
use std::fs;
use std::path::Path;

fn try_bytes(name: &str, body: fn(&[u8]), count: usize) {
    let count = rounds(count);
    let mut random = Random::new(1);
    for _ in 0..count {
        let bytes: Vec<_> = (0..random.below(400)).map(|_| random.bits() as u8).collect();
        body(&bytes);
    }
    for bytes in corpus(name) {
        body(&bytes);
        // What is all but right gets further than noise does: another of its bytes here and there,
        // or a digit.
        for _ in 0..count {
            let mut near = bytes.clone();
            for _ in 0..=random.below(2) {
                let [to, from] = [0; 2].map(|_| random.below(bytes.len() as u32) as usize);
                near[to] =
                    if random.below(2) == 0 { bytes[from] } else { b'0' + random.below(10) as u8 };
            }
            body(&near);
        }
    }
}

/// Everything that once broke something.
fn corpus(name: &str) -> impl Iterator<Item = Vec<u8>> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(name);
    let entries = fs::read_dir(corpus).expect("a corpus").map(|entry| entry.expect("an entry"));
    entries.map(|entry| fs::read(entry.path()).expect("a file"))
}

#[test]
fn link_triangle() {
    try_bytes("link_triangle", fuzz::link_triangle, 3000);
}

/// The scenes are of all kinds, clear and not.
#[test]
fn aligned() {
    let (mut random, mut seen) = (Random::new(1), [[0; 2]; fuzz::ALIGNED]);
    let count = rounds(2400);
    for _ in 0..count {
        let bytes: Vec<_> = (0..32).map(|_| random.bits() as u8).collect();
        if let Some(visited) = fuzz::aligned(&bytes) {
            seen[visited.kind][usize::from(visited.is_clear)] += 1;
        }
    }
    // Legs are never asked about a margin, floors are always clear.
    let [legs, others @ .., floors, disks] = seen;
    assert!(legs[0] >= count / 10 && floors[1] >= count / 10, "{seen:?}");
    assert!(others.iter().chain([&disks]).flatten().all(|&n| n >= count / 60), "{seen:?}");
}

#[test]
fn chain_mesh() {
    try_bytes("chain_mesh", fuzz::chain_mesh, 400);
}

#[test]
fn constructors() {
    try_bytes("constructors", fuzz::constructors, 3000);
}

#[test]
fn dispatcher() {
    try_bytes("dispatcher", fuzz::dispatcher, 1000);
}

#[test]
fn mesh_file() {
    try_bytes("mesh_file", fuzz::mesh_file, 3000);
}

#[test]
fn root_finders() {
    try_bytes("root_finders", fuzz::root_finders, 2000);
}

#[test]
fn tube() {
    try_bytes("tube", fuzz::tube, 1000);
}

#[test]
fn coherence() {
    try_bytes("coherence", fuzz::coherence, 1000);
}

#[test]
fn motions() {
    try_bytes("motions", fuzz::motions, 200);
}

#[test]
fn scenes() {
    try_bytes("scenes", fuzz::scenes, 200);
}

#[test]
fn touching() {
    try_bytes("touching", fuzz::touching, 300);
}

#[test]
fn robots() {
    try_bytes("robots", fuzz::robots, 1000);
}
