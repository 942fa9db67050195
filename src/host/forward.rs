//! The queries that a dispatcher passes on to another one.

/// Implements all queries of `QueryDispatcher` except for nonlinear casts: passes each to a
/// dispatcher, and returns what becomes of the answer.
macro_rules! forward_queries {
    ($self:ident, $inner:expr, |$answer:ident| $result:expr) => {
        fn intersection_test(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
        ) -> Result<parry3d_f64::query::ShapeIntersection, Unsupported> {
            let $answer = $inner.intersection_test(pos12, g1, g2);
            $result
        }

        fn distance(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
        ) -> Result<parry3d_f64::query::ShapeDistance, Unsupported> {
            let $answer = $inner.distance(pos12, g1, g2);
            $result
        }

        fn contact(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            prediction: Real,
        ) -> Result<Option<parry3d_f64::query::Contact>, Unsupported> {
            let $answer = $inner.contact(pos12, g1, g2, prediction);
            $result
        }

        fn closest_points(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            max_dist: Real,
        ) -> Result<parry3d_f64::query::ClosestPoints, Unsupported> {
            let $answer = $inner.closest_points(pos12, g1, g2, max_dist);
            $result
        }

        fn cast_shapes(
            &$self,
            pos12: &Pose,
            local_vel12: parry3d_f64::math::Vector,
            g1: &dyn Shape,
            g2: &dyn Shape,
            options: parry3d_f64::query::ShapeCastOptions,
        ) -> Result<Option<ShapeCastHit>, Unsupported> {
            let $answer = $inner.cast_shapes(pos12, local_vel12, g1, g2, options);
            $result
        }
    };
}

/// Implements `PersistentQueryDispatcher<M, C>` as [`forward_queries`] does the other queries.
macro_rules! forward_manifolds {
    ($self:ident, $inner:expr, |$answer:ident| $result:expr) => {
        fn contact_manifolds(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            prediction: Real,
            manifolds: &mut Vec<ContactManifold<M, C>>,
            workspace: &mut Option<parry3d_f64::query::ContactManifoldsWorkspace>,
        ) -> Result<(), Unsupported> {
            let $answer =
                $inner.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
            $result
        }

        fn contact_manifold_convex_convex(
            &$self,
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            constraints1: Option<&dyn parry3d_f64::query::details::NormalConstraints>,
            constraints2: Option<&dyn parry3d_f64::query::details::NormalConstraints>,
            prediction: Real,
            manifold: &mut ContactManifold<M, C>,
        ) -> Result<(), Unsupported> {
            let $answer = $inner.contact_manifold_convex_convex(
                pos12,
                g1,
                g2,
                constraints1,
                constraints2,
                prediction,
                manifold,
            );
            $result
        }
    };
}

pub(super) use {forward_manifolds, forward_queries};
