//! From what Python hands over to plain numbers, checked.

mod caps;
mod counts;
mod faces;
mod frames;
mod names;
mod numbers;
mod objects;
mod poses;
mod robots;
mod scalars;
mod sections;

pub(crate) use caps::Caps;
pub(crate) use counts::{place_in, together};
pub(crate) use faces::faces;
pub(crate) use frames::{HasWarned, in_frame, mesh_text, stated_frame};
pub(crate) use names::Names;
pub(crate) use numbers::{Numbers, numpy, shape_text, vectors};
pub(crate) use objects::of as object_of;
pub(crate) use poses::{Poses, matrices, pose_if_one, pose_of};
pub(crate) use robots::{Block, Given, Robots};
pub(crate) use scalars::{DeviceName, FrameName, check_length, is_bool, of, places};
pub(crate) use sections::{SectionRadii, Sections};
