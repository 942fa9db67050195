//! The GPU's kernels one by one, the paper's routes on it, and the program that measures it.

mod discs;
mod forms;
mod pairs;
mod shaders;
mod speed;
