//! Contact manifolds: how a pair is split into parts, and which file answers for each pair of
//! parts.
//!
//! [`robot_surface_manifold`] splits a robot and a mesh or a height field. parry's routines split
//! all other composites, because they keep the manifolds of a pair from step to step. The pairs of
//! parts are answered by
//!
//! - [`link_triangle_manifold`]: a link and a triangle, exactly;
//! - [`link_halfspace_manifold`]: a link and a half-space, exactly;
//! - [`link_link_manifold`]: two links, or a link and a ball, a capsule or a cylinder, exactly;
//! - [`link_convex_manifold`]: a link and another convex shape, along the contact's normal with
//!   polygons that approximate the surfaces;
//! - `L`: a link and a shape without polygons. parry keeps a manifold while it has drifted by less
//!   than 1e-3, in any unit of length. So that a small link never rests on a stale manifold, `L` is
//!   told at each step that the shapes have changed.

use super::decomposition::{check_scale, has_parts};
use super::dispatcher::ContinuumDispatcher;
use super::inner_points::WhichShape;
use super::iterated::IteratedPair;
use super::link_triangle::LinkTrianglePair;
use super::link_triangle_manifold::TriangleRules;
use super::range::{check_margin, check_pose};
use super::robot_surface::links_of;
use super::strict_dispatcher::StrictDispatcher;
use super::thin_shape::ThinShape;
use super::{
    inner_points, link_convex_manifold, link_halfspace_manifold, link_link_manifold,
    link_triangle_manifold, range, robot_surface_manifold,
};
use crate::robot::Chain;
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::details::{self, NormalConstraints};
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, PersistentQueryDispatcher, Unsupported,
};
use parry3d_f64::shape::{Shape, ShapeType};

impl<M, C, L> PersistentQueryDispatcher<M, C> for ContinuumDispatcher<L>
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
    L: PersistentQueryDispatcher<M, C>,
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
        check_pose(pos12)?;
        check_margin(prediction)?;
        check_scale(g1)?;
        check_scale(g2)?;
        let is_robot = [g1, g2].into_iter().any(|shape| links_of(shape).is_some());
        // Boxes are loosened by the prediction, which parry expects to be positive, and by the
        // rounding error of a test of two boxes that touch.
        let has_boxes = is_robot && (has_parts(g1) || has_parts(g2));
        let rounding = if has_boxes { range::rounding_of_boxes(pos12, g1, g2) } else { 0.0 };
        let loose = prediction.max(0.0) + rounding;
        if !robot_surface_manifold::update(
            pos12,
            (g1, g2),
            (prediction, loose),
            manifolds,
            workspace,
        )? {
            self.update_by_parts(pos12, (g1, g2), loose, manifolds, workspace)?;
            if is_robot || prediction < 0.0 {
                drop_beyond(prediction, manifolds);
            }
        }
        for (shape, side) in [(g1, WhichShape::First), (g2, WhichShape::Second)] {
            if let Some(chain) = shape.as_shape::<Chain>() {
                let rounding = range::rounding_of_depths(pos12, g1, g2);
                inner_points::remove_inner_points(
                    chain.links(),
                    side,
                    (prediction, rounding),
                    manifolds,
                );
            }
        }
        Ok(())
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
        check_pose(pos12)?;
        check_margin(prediction)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        let constraints = (normal_constraints1, normal_constraints2);
        let is_free = normal_constraints1.is_none() && normal_constraints2.is_none();
        if let Some(pair) = LinkTrianglePair::of(g1, g2)? {
            // The neighbours of the triangle are unknown.
            let rules = TriangleRules { constraints, is_free: &|_| false };
            let met = link_triangle_manifold::update(pos12, &pair, &rules, prediction, manifold)?;
            if let Some(met) = met {
                met.keep_closest(met.dist, manifold);
            }
            return Ok(());
        }
        if link_halfspace_manifold::update(pos12, (g1, g2), prediction, manifold)? {
            return Ok(());
        }
        // Find an overlap first, then measure it.
        let within = prediction.max(0.0);
        let is_link = links_of(g1).or(links_of(g2)).is_some();
        let is_answered = is_free
            && (link_link_manifold::update(pos12, (g1, g2), within, manifold)?
                || is_link && {
                    let pair = IteratedPair::of(pos12, g1, g2)?;
                    let contact = || self.contact_of_iterated(&pair, pair.length(within));
                    link_convex_manifold::update(&pair, contact, manifold)?
                });
        if !is_answered {
            let inner = self.inner(pos12, g1, g2)?;
            if is_link {
                manifold.mark_shapes_deformed();
            }
            let (constraints1, constraints2) = constraints;
            inner.contact_manifold_convex_convex(
                pos12,
                g1,
                g2,
                constraints1,
                constraints2,
                within,
                manifold,
            )?;
        }
        if prediction < 0.0 {
            drop_beyond(prediction, std::slice::from_mut(manifold));
        }
        Ok(())
    }
}

/// Clears the manifolds whose nearest point is beyond the prediction.
fn drop_beyond<M, C>(prediction: Real, manifolds: &mut [ContactManifold<M, C>]) {
    for manifold in manifolds {
        if manifold.points.iter().all(|point| point.dist > prediction) {
            manifold.points.clear();
        }
    }
}

impl<L> ContinuumDispatcher<L> {
    /// Splits the shapes by parry's routines.
    fn update_by_parts<M, C>(
        &self,
        pos12: &Pose,
        (g1, g2): (&dyn Shape, &dyn Shape),
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
        L: PersistentQueryDispatcher<M, C>,
    {
        let pos21 = pos12.inverse();
        let parts = (g1.as_composite_shape(), g2.as_composite_shape());
        let fields = (g1.as_heightfield(), g2.as_heightfield());
        let is_either = |kind| g1.shape_type() == kind || g2.shape_type() == kind;
        StrictDispatcher::ask(self, |watched| {
            match (parts, fields) {
                ((Some(parts1), Some(parts2)), _) => {
                    details::contact_manifolds_composite_shape_composite_shape(
                        watched, pos12, parts1, parts2, prediction, manifolds, workspace,
                    );
                }
                ((_, Some(parts2)), (Some(field1), _)) => {
                    details::contact_manifolds_heightfield_composite_shape(
                        watched, pos12, &pos21, field1, parts2, prediction, manifolds, workspace,
                        false,
                    );
                }
                ((Some(parts1), _), (_, Some(field2))) => {
                    details::contact_manifolds_heightfield_composite_shape(
                        watched, &pos21, pos12, field2, parts1, prediction, manifolds, workspace,
                        true,
                    );
                }
                (_, (Some(_), _) | (_, Some(_))) => {
                    details::contact_manifolds_heightfield_shape_shapes(
                        watched, pos12, g1, g2, prediction, manifolds, workspace,
                    )
                }
                _ if is_either(ShapeType::TriMesh) => {
                    details::contact_manifolds_trimesh_shape_shapes(
                        watched, pos12, g1, g2, prediction, manifolds, workspace,
                    )
                }
                _ if is_either(ShapeType::Voxels) => {
                    voxels(watched, pos12, g1, g2, prediction, manifolds, workspace);
                }
                ((Some(parts1), _), _) => details::contact_manifolds_composite_shape_shape(
                    watched, pos12, parts1, g2, prediction, manifolds, workspace, false,
                ),
                ((_, Some(parts2)), _) => details::contact_manifolds_composite_shape_shape(
                    watched, &pos21, parts2, g1, prediction, manifolds, workspace, true,
                ),
                ((None, None), _) => {
                    if manifolds.is_empty() {
                        manifolds.push(ContactManifold::new());
                    }
                    let manifold = &mut manifolds[0];
                    return self.contact_manifold_convex_convex(
                        pos12, g1, g2, None, None, prediction, manifold,
                    );
                }
            }
            Ok(())
        })?
    }
}

/// Calls parry's routines for voxels.
fn voxels<M, C>(
    dispatcher: &dyn PersistentQueryDispatcher<M, C>,
    pos12: &Pose,
    g1: &dyn Shape,
    g2: &dyn Shape,
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    let has_parts = |shape: &dyn Shape| shape.as_composite_shape().is_some();
    if g1.as_voxels().is_some() && g2.as_voxels().is_some() {
        details::contact_manifolds_voxels_voxels_shapes(
            dispatcher, pos12, g1, g2, prediction, manifolds, workspace,
        );
    } else if g1.as_ball().is_some() || g2.as_ball().is_some() {
        details::contact_manifolds_voxels_ball_shapes(pos12, g1, g2, prediction, manifolds);
    } else if has_parts(g1) || has_parts(g2) {
        details::contact_manifolds_voxels_composite_shape_shapes(
            dispatcher, pos12, g1, g2, prediction, manifolds, workspace,
        );
    } else {
        details::contact_manifolds_voxels_shape_shapes(
            dispatcher, pos12, g1, g2, prediction, manifolds, workspace,
        );
    }
}
