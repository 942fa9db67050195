//! Search through a hierarchy 16 children wide, a pack of them at a time.

mod across;
mod bound;
mod build;
mod candidates;
mod engine;
mod few_each;
mod fit;
mod gathering;
mod hierarchy;
mod joint;
mod kept_distances;
mod minimum;
mod moment;
mod motion_engine;
mod motion_queries;
mod node;
mod outline;
mod queries;
mod rough_sides;
mod side_engine;
mod traverse;
mod tube_engine;
mod tube_queries;
mod widening;
mod winding;

pub use engine::BvhSearch;
