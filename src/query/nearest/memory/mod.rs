//! What a query leaves for the next one about a robot that has moved a little.

mod kept_distances;
mod odometer;
mod outline;
mod widening;

pub(crate) use kept_distances::KeptDistances;
pub(crate) use odometer::Odometer;
pub(crate) use outline::Outline;
