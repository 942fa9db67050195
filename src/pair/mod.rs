//! One link in the mesh's frame and one triangle: how near they are, alone and a pack at a time.

mod answered;
mod best;
mod certificate;
mod checks;
mod contact;
mod contacts_together;
mod coordinates;
mod derivative;
mod fit;
mod link_lanes;
mod measure_together;
mod nearest;
mod nearest_features;
mod nearest_rows;
mod pair_lanes;
mod placed_link;
mod placed_robot;
mod ranked;
mod search_link;
mod segments_together;
mod two_links;

pub(crate) use best::Best;
pub(crate) use checks::rigid_pose;
pub(crate) use contact::{contact, contacts};
pub(crate) use contacts_together::{PlacedPair, add_contacts};
pub(crate) use derivative::derivative;
pub(crate) use link_lanes::{LinkLanes, Nearer};
pub(crate) use nearest::Nearest;
pub(crate) use pair_lanes::TOGETHER;
pub(crate) use placed_link::PlacedLink;
pub(crate) use placed_robot::PlacedRobot;
pub(crate) use ranked::{Ranked, rank_each, rounding};
pub(crate) use search_link::SearchLink;
pub(crate) use segments_together::{Height, measure_points, measure_segments};
pub(crate) use two_links::NearestOfLinks;
