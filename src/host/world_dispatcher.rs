//! The dispatcher for a rapier world: the exact one, except for the sweeps of fast bodies.
//!
//! rapier sweeps each fast body by a nonlinear cast that does not stop at the start. This
//! dispatcher casts links without their skin then ([`link_cast`](super::link_cast)). rapier does
//! the same with its own shapes: it sweeps them to a place inside their surface.

use super::ContinuumDispatcher;
use super::forward::{forward_manifolds, forward_queries};
use super::link_cast::StartContact;
use super::nonlinear_cast::{self, MovingShape};
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::{
    ContactManifold, DefaultQueryDispatcher, NonlinearRigidMotion, PersistentQueryDispatcher,
    QueryDispatcher, ShapeCastHit, Unsupported,
};
use parry3d_f64::shape::Shape;

/// A [`ContinuumDispatcher`] for the narrow phase of a rapier world.
///
/// Its answers are those of the dispatcher inside, except for `cast_shapes_nonlinear` that does not
/// stop at the start: rapier's sweep of a fast body. It ignores the outermost layer of a link, 5 %
/// of its radius. A solver lets bodies overlap by its allowed error; an exact sweep would hold them
/// there, step after step, in the air.
///
/// [`install`](super::rapier::install) puts one with parry's dispatcher inside into the world. For
/// a dispatcher of your own:
/// ```
/// use parry_continuum::{ContinuumDispatcher, rapier};
/// use parry_continuum::parry::query::DefaultQueryDispatcher;
/// use rapier3d_f64::prelude::PhysicsWorld;
///
/// let (mut world, yours) = (PhysicsWorld::default(), DefaultQueryDispatcher);
/// rapier::install(&mut world.narrow_phase, &mut world.integration_parameters, 1.0)?;
/// let dispatcher = rapier::WorldDispatcher(ContinuumDispatcher(yours));
/// world.narrow_phase.set_query_dispatcher(dispatcher);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct WorldDispatcher<L = DefaultQueryDispatcher>(pub ContinuumDispatcher<L>);

/// Has parry's own dispatcher inside.
impl Default for WorldDispatcher {
    fn default() -> Self {
        Self(ContinuumDispatcher::default())
    }
}

impl<L: QueryDispatcher> QueryDispatcher for WorldDispatcher<L> {
    forward_queries!(self, self.0, |answer| answer);

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let sides = [
            MovingShape { motion: motion1, shape: g1 },
            MovingShape { motion: motion2, shape: g2 },
        ];
        let start = if stop_at_penetration { StartContact::Stops } else { StartContact::Skin };
        nonlinear_cast::cast((self, &self.0.0), sides, (start_time, end_time), start)
    }
}

impl<M, C, L> PersistentQueryDispatcher<M, C> for WorldDispatcher<L>
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    L: PersistentQueryDispatcher<M, C>,
{
    forward_manifolds!(self, self.0, |answer| answer);
}
