//! One link in the mesh's frame and one triangle: how near they are, alone and a pack at a time.

mod answered;
mod certificate;
mod checks;
mod contact;
mod contacts_together;
mod derivative;
mod fit;
mod link_lanes;
mod measure_together;
mod nearest_features;
mod pair_lanes;
mod placed;
mod ranked;
mod search_frame;

pub(crate) use checks::{
    check_bound, check_margin, check_not_negative, check_triangles, check_vertices, rigid_pose,
};
pub(crate) use contact::{contact, contacts};
pub(crate) use contacts_together::{Place, add_contacts};
pub(crate) use derivative::derivative;
pub(crate) use link_lanes::{LinkLanes, Nearer};
pub(crate) use pair_lanes::TOGETHER;
pub(crate) use placed::{Best, Nearest, PlacedLink, PlacedRobot};
pub(crate) use ranked::{Ranked, rank_each, rounding};
pub(crate) use search_frame::{SearchFrame, SearchLink};
