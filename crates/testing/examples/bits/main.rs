//! Answers to seeded questions as one number a kind, to compare versions, machines and instruction
//! sets to the last bit. `.ci/alone` runs it here and as WebAssembly, and compares both with
//! `tests/data/bits.txt`.
//!
//! `cargo run --release -p continuum-testing --example bits`

mod draw;
mod questions;
mod record;

/// Far from the origin the rounding of a coordinate is felt.
const OFFSETS: [f64; 3] = [0.0, 100.0, 1.5e7];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for offset in OFFSETS {
        println!("offset {offset:e}");
        for ask in [
            questions::chains,
            questions::curves,
            questions::pairs,
            questions::scenes,
            questions::hosts,
        ] {
            for record in ask(offset)? {
                println!("{}: {} numbers, {:016x}", record.name, record.numbers, record.hash);
            }
        }
    }
    Ok(())
}
