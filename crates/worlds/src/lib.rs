//! Rapier's worlds as text.
//!
//! All that a world can hold is written and read by code of its own. It is in this package because it takes longer to be
//! optimised than all tests that rapier's worlds are for, and runs for a moment: the workspace compiles it as it stands.

use rapier3d_f64::prelude::PhysicsWorld;

/// A world as JSON.
///
/// # Errors
/// It has a shape that rapier cannot write.
pub fn write(world: &PhysicsWorld) -> serde_json::Result<String> {
    serde_json::to_string(world)
}

/// A world from JSON.
///
/// # Errors
/// The text is no world.
pub fn read(text: &str) -> serde_json::Result<PhysicsWorld> {
    serde_json::from_str(text)
}
