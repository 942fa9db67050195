//! One link and one triangle, or two links: distance, features, contact, derivative and
//! certificate, for one pair and for batches.

mod answer_check;
mod answer_check_of_links;
mod answer_subject;
mod beside_itself;
mod best;
mod certificate;
mod certificate_of_links;
mod checks;
mod contact;
mod contact_batch;
mod coordinates;
mod derivative;
mod exact_link;
mod link_lanes;
mod link_pair_batch;
mod measure_batch;
mod nearest;
mod nearest_features;
mod nearest_rows;
mod pair_lanes;
mod placed_link;
mod placed_robot;
mod ranked;
mod search_link;
mod segment_batch;
mod two_links;

pub(crate) use beside_itself::{JoinedLink, MovedLinks, Tolerance};
pub(crate) use best::Best;
pub(crate) use checks::rigid_pose;
pub(crate) use contact::{contact, contacts};
pub(crate) use contact_batch::{PlacedPair, add_contacts};
pub(crate) use derivative::derivative;
pub(crate) use link_lanes::{LinkLanes, Nearer};
pub(crate) use link_pair_batch::{LinkPairBatch, PlacedEnds};
pub(crate) use nearest::Nearest;
pub(crate) use pair_lanes::BATCH;
pub(crate) use placed_link::PlacedLink;
pub(crate) use placed_robot::PlacedRobot;
pub(crate) use ranked::{Ranked, rank_each, rounding};
pub(crate) use search_link::SearchLink;
pub(crate) use segment_batch::{Height, measure_points, measure_segments};
pub(crate) use two_links::NearestOfLinks;
