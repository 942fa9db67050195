//! A dispatcher that records whether a pair was refused.
//!
//! parry's queries on composite shapes skip parts whose pair the dispatcher does not support: a
//! refused pair counts as infinitely far away. They get a [`StrictDispatcher`] instead. If one of
//! its pairs is refused, the whole query is refused.

use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::details::NormalConstraints;
use parry3d_f64::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeDistance,
    ShapeIntersection, Unsupported,
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
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        self.record(self.dispatcher.intersection_test(pos12, g1, g2))
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        self.record(self.dispatcher.distance(pos12, g1, g2))
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        self.record(self.dispatcher.contact(pos12, g1, g2, prediction))
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        self.record(self.dispatcher.closest_points(pos12, g1, g2, max_dist))
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        self.record(self.dispatcher.cast_shapes(pos12, local_vel12, g1, g2, options))
    }

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
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        self.record(
            self.dispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace),
        )
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        self.record(self.dispatcher.contact_manifold_convex_convex(
            pos12,
            g1,
            g2,
            normal_constraints1,
            normal_constraints2,
            prediction,
            manifold,
        ))
    }
}
