//! The demo is what it says: the wall, the robot and the pictures.

mod concentric_tube;
mod joint_motion;
mod ventricle;
