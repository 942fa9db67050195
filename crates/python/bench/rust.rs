//! What the Rust library takes for the shapes of `bench/peers.py`, to see what Python adds.
//!
//! Reads 64-bit floats, little-endian: the counts of vertices, triangles, robots and points each,
//! the vertices, the triangles, and the robots' points; all radii are the last number. Writes one
//! line for each question: its name, and the nanoseconds of processor time that it took for one
//! robot after the other, and for all of them as a batch. Linux and macOS alone.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{BvhSearch, Proximity};
use std::error::Error;
use std::io::{Read, stdin};

/// Rounds; the fastest counts.
const ROUNDS: usize = 15;

/// The processor time of this process, in seconds.
fn processor_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is that of a structure which lives as long as the call.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The nanoseconds that the work takes for one robot.
fn time(
    robots: usize,
    mut work: impl FnMut() -> Result<(), Box<dyn Error>>,
) -> Result<f64, Box<dyn Error>> {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let begin = processor_time();
        work()?;
        least = least.min(processor_time() - begin);
    }
    Ok(1e9 * least / robots as f64)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut bytes = Vec::new();
    stdin().read_to_end(&mut bytes)?;
    let numbers: Vec<_> =
        bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let (counts, rest) = numbers.split_at_checked(4).ok_or("there are no counts")?;
    let [vertices, triangles, robots, points]: [usize; 4] =
        std::array::from_fn(|k| counts[k] as usize);
    let (coordinates, rest) =
        rest.split_at_checked(3 * vertices).ok_or("there are too few vertices")?;
    let (corners, rest) =
        rest.split_at_checked(3 * triangles).ok_or("there are too few triangles")?;
    let (centrelines, radius) =
        rest.split_at_checked(3 * robots * points).ok_or("there are too few points")?;
    let to_vectors = |numbers: &[f64]| -> Vec<_> {
        numbers.as_chunks::<3>().0.iter().map(|&point| Vector::from_array(point)).collect()
    };
    let faces: Vec<_> =
        corners.as_chunks::<3>().0.iter().map(|face| face.map(|corner| corner as u32)).collect();
    let mut search = BvhSearch::from_triangles(&to_vectors(coordinates), &faces)?;
    search.prepare();
    let centrelines: Vec<_> = centrelines.chunks(3 * points).map(to_vectors).collect();
    let radii = vec![*radius.first().ok_or("there is no radius")?; points - 1];

    let mut chain = Chain::from_centreline(&centrelines[0], &radii)?;
    let (pose, mut links, mut contacts) = (Pose::IDENTITY, Vec::new(), Vec::new());
    let one = time(robots, || {
        for points in &centrelines {
            chain.set_centreline(points, &radii)?;
            search.minimum(&chain, &pose)?;
        }
        Ok(())
    })?;
    let mut answers = Vec::new();
    let many = time(robots, || {
        let chains = centrelines.iter().map(|points| Chain::from_centreline(points, &radii));
        let chains = chains.collect::<Result<Vec<_>, _>>()?;
        let robots: Vec<_> = chains.iter().map(|chain| (chain, pose)).collect();
        Ok(search.minimum_batch(&robots, &mut answers)?)
    })?;
    println!("distance {one} {many}");
    let one = time(robots, || {
        for points in &centrelines {
            chain.set_centreline(points, &radii)?;
            search.clears(&chain, &pose, 1.0)?;
        }
        Ok(())
    })?;
    println!("clears {one}");
    let one = time(robots, || {
        for points in &centrelines {
            chain.set_centreline(points, &radii)?;
            search.per_link(&chain, &pose, &mut links)?;
        }
        Ok(())
    })?;
    println!("per_link {one}");
    let one = time(robots, || {
        for points in &centrelines {
            chain.set_centreline(points, &radii)?;
            search.contacts_within(&chain, &pose, 1.0, 0.0, &mut contacts)?;
        }
        Ok(())
    })?;
    println!("contacts_within {one}");
    Ok(())
}
