//! A dispatcher that records whether a pair was refused.
//!
//! parry's queries on composite shapes skip parts whose pair the dispatcher does not support: a
//! refused pair counts as infinitely far away. They get a [`StrictDispatcher`] instead. If one of
//! its pairs is refused, the whole query is refused.

use super::forward::{forward_manifolds, forward_queries};
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::{
    ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher,
    ShapeCastHit, Unsupported,
};
use parry3d_f64::shape::Shape;
use std::sync::atomic::{AtomicBool, Ordering};

/// Forwards every query and records refusals.
pub(super) struct StrictDispatcher<'a, D> {
    dispatcher: &'a D,
    refused: AtomicBool,
}

impl<'a, D> StrictDispatcher<'a, D> {
    /// Returns the result of `query` on `dispatcher`.
    ///
    /// # Errors
    /// [`Unsupported`] if one of the query's pairs was refused.
    pub fn ask<T>(dispatcher: &'a D, query: impl FnOnce(&Self) -> T) -> Result<T, Unsupported> {
        let watched = Self { dispatcher, refused: AtomicBool::new(false) };
        let answer = query(&watched);
        if watched.refused.into_inner() { Err(Unsupported) } else { Ok(answer) }
    }

    fn record<T>(&self, answer: Result<T, Unsupported>) -> Result<T, Unsupported> {
        if answer.is_err() {
            self.refused.store(true, Ordering::Relaxed);
        }
        answer
    }
}

impl<D: QueryDispatcher> QueryDispatcher for StrictDispatcher<'_, D> {
    forward_queries!(self, self.dispatcher, |answer| self.record(answer));

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
        let hit = self.dispatcher.cast_shapes_nonlinear(
            motion1,
            g1,
            motion2,
            g2,
            start_time,
            end_time,
            stop_at_penetration,
        );
        self.record(hit)
    }
}

impl<M, C, D> PersistentQueryDispatcher<M, C> for StrictDispatcher<'_, D>
where
    D: PersistentQueryDispatcher<M, C>,
{
    forward_manifolds!(self, self.dispatcher, |answer| self.record(answer));
}
