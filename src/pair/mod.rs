//! One link and one triangle, or two links: distance, features, contact, derivative and
//! certificate, for one pair and for batches.

mod answer_check;
#[cfg(feature = "robots")]
mod beside_itself;
#[cfg(feature = "tubes")]
mod certificate;
mod contact;
mod coordinates;
mod link_lanes;
#[cfg(feature = "robots")]
mod link_pair_batch;
#[cfg(feature = "robots")]
mod links_certificate;
#[cfg(feature = "robots")]
mod links_of_robots;
mod measure_batch;
mod nearest_features;
mod pair_lanes;
mod placed_link;
mod placed_robot;
mod segment_batch;
mod two_links;

pub(crate) use answer_check::rigid_pose;
#[cfg(feature = "robots")]
pub(crate) use beside_itself::{JoinedLink, MovedLinks, Tolerance};
pub(crate) use contact::{PlacedPair, add_contacts, contact, contacts, derivative};
pub(crate) use coordinates::Nearest;
pub(crate) use link_lanes::{LinkLanes, Nearer, SearchLink};
#[cfg(feature = "robots")]
pub(crate) use link_pair_batch::{LinkPairBatch, PlacedEnds};
pub(crate) use measure_batch::{Best, Measurement, measure_each, rounding};
pub(crate) use pair_lanes::BATCH;
pub(crate) use placed_link::PlacedLink;
pub(crate) use placed_robot::PlacedRobot;
pub(crate) use segment_batch::{PartDistance, measure_points, measure_segments};
pub(crate) use two_links::NearestOfLinks;
