//! The scene is what it says: the wall, the robot, the files and the pictures.

mod concentric_tube;
mod joint_motion;
mod mesh_files;
mod ventricle;
