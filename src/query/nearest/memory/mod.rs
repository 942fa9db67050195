//! State that lets a query reuse the distances of the last one, for a robot that has moved a
//! little.

mod link_lower_bounds;
mod look_ahead;
mod odometer;
mod placed_outline;

pub(crate) use link_lower_bounds::LinkLowerBounds;
pub(crate) use odometer::Odometer;
pub(crate) use placed_outline::PlacedOutline;
