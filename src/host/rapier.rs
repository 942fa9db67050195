//! Links and chains in a [rapier](https://rapier.rs) world (feature `rapier`).
//!
//! Call [`install`] once per world. Then choose how the robot takes part:
//!
//! - **One collider for the whole robot**, a [`Chain`](crate::Chain) on one body, if something else
//!   moves the robot and only its contacts matter.
//! - **One body per link**, connected by joints, if contacts shall bend the robot. Neighbouring
//!   links overlap at round joints, so build each joint with `contacts_enabled(false)`. If a link
//!   is closer than a radius to its next but one, exclude the robot from itself by
//!   `InteractionGroups`.
//! ```
//! use parry_continuum::{Chain, parry::math::Vector, rapier};
//! use rapier3d_f64::prelude::*;
//!
//! let mut world = PhysicsWorld::default();
//! rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 1.0)?;
//! world.insert(
//!     RigidBodyBuilder::fixed(),
//!     ColliderBuilder::trimesh(
//!         vec![
//!             Vector::new(-9.0, 0.0, -9.0),
//!             Vector::new(9.0, 0.0, -9.0),
//!             Vector::new(0.0, 0.0, 18.0),
//!         ],
//!         vec![[0, 2, 1]],
//!     )?,
//! );
//! let robot = Chain::from_centreline(
//!     &[Vector::ZERO, 2.0 * Vector::X, Vector::new(3.5, 0.0, 1.0)],
//!     &[0.5, 0.5],
//! )?;
//! let above = RigidBodyBuilder::dynamic().translation(Vector::new(-1.0, 0.6, 0.0));
//! let (robot, _) = world.insert(above, ColliderBuilder::new(SharedShape::new(robot)));
//! for _ in 0..120 {
//!     world.step();
//! }
//! assert!((world.bodies[robot].translation().y - 0.5).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Limits of rapier with custom shapes
//! | limit | reason | remedy |
//! |---|---|---|
//! | save a `ColliderSet` or `PhysicsWorld` | parry's serialiser returns an error for custom shapes | save links and chains on their own (feature `serde-serialize`), with balls in their place in the world, and restore them to their colliders after loading: [below](#saving-a-world-with-robots) |
//! | load a `NarrowPhase` | it is loaded with parry's dispatcher, whose answers for links are approximate, and wrong for a half-space | call [`install`] after loading |
//! | `KinematicCharacterController` | it always uses parry's dispatcher | move a kinematic body and query the free path with [`ContinuumDispatcher`](crate::ContinuumDispatcher) |
//! | draw in the debug renderer | it draws boxes and contacts, but no custom shape | draw [`to_trimesh`](crate::ModifiedCylinder::to_trimesh) of each link through the same backend: `tests/rapier/drawn.rs` |
//!
//! A query pipeline takes its dispatcher when it is built:
//! `broad_phase.as_query_pipeline(&dispatcher, ..)`, or `narrow_phase.query_dispatcher()` for the
//! installed one. A kinematic robot and a fixed wall are compared only if one of their colliders
//! has `ActiveCollisionTypes::KINEMATIC_FIXED`. For a robot inside a closed mesh use
//! `TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED`. Under the one-sided flag, a contact from outside
//! replaces a contact from inside that is equally deep.
#![cfg_attr(feature = "serde-serialize", doc = "")]
#![cfg_attr(feature = "serde-serialize", doc = include_str!("../../docs/book/saving.md"))]

pub use super::world_dispatcher::WorldDispatcher;
use parry3d_f64::math::Real;
/// The rapier whose worlds [`install`] prepares.
pub use rapier3d_f64;
use rapier3d_f64::dynamics::IntegrationParameters;
use rapier3d_f64::geometry::NarrowPhase;
use thiserror::Error;

/// Prepares a rapier world for links and chains.
///
/// `size` is the thickness of a link in the world's unit of length: for a robot of one millimetre,
/// 1e-3 in metres and 1 in millimetres.
///
/// - The narrow phase gets a [`WorldDispatcher`].
/// - `length_unit` becomes `size`. rapier is tuned for bodies of size 1: prediction, slop, the
///   speed at which overlaps are resolved and the speed below which bodies fall asleep are
///   multiples of `length_unit`.
/// - Contact recycling is switched off. It would keep a contact while the link moves by up to
///   `size / 20`.
/// - The largest speed is unlimited. It would be 400 `size` per second, which a link of one
///   millimetre reaches after falling 8 mm.
///
/// Gravity, time step and damping are unchanged. They are in the world's own units.
///
/// # Errors
/// `size` is not finite or not above 0. Then nothing is changed.
pub fn install(
    narrow_phase: &mut NarrowPhase,
    parameters: &mut IntegrationParameters,
    size: Real,
) -> Result<(), BadSize> {
    if !(size.is_finite() && size > 0.0) {
        return Err(BadSize { size });
    }
    narrow_phase.set_query_dispatcher(WorldDispatcher::default());
    parameters.length_unit = size;
    parameters.contact_recycling = false;
    parameters.normalized_max_linear_velocity = Real::MAX;
    Ok(())
}

/// The error for an invalid `size` in [`install`].
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the size of a link is {size}; it must be finite and above 0")]
#[non_exhaustive]
pub struct BadSize {
    /// The wrong size.
    pub size: Real,
}
