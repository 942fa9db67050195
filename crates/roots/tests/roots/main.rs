//! The root finders, judged in 256-bit arithmetic.

mod exact;
mod known;
mod random;
mod scale;
