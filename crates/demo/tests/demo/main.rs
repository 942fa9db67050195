//! The demo's wall, robot and pictures are as documented.

mod concentric_tube;
mod joint_motion;
mod ventricle;
