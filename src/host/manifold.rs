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
//!
//! # Points inside joints
//! [`remove_inner_points`] removes the contact points of a chain that lie inside its joints. At a
//! joint the ends of two links overlap. A wall touches the neighbour there, and the normal of
//! a cap inside the neighbour would catch on a wall along which the chain slides. So such a point
//! is removed, but *only while the neighbour makes a contact at least as deep*.
//!
//! **Algorithm.** For all links that touch the same part of the wall, visit the points from the
//! deepest. A point is removed if
//!
//! 1. its normal leans out over the end of the link at which it lies. (Sideways contacts stay, even
//!    if two links lie on the same floor.)
//! 2. it lies inside another link or on its surface;
//! 3. that link has kept a point against the same part that is at least as deep.
//!
//! So the deepest point is never removed, for any joint: a bend, a step in radius, links shorter
//! than their caps. The remaining points of a link count if the nearest of them is within the
//! prediction.
//!
//! **Equal depths.** At a joint both links often touch equally deep, and rounding decides the
//! order. Points at most `rounding` less deep than the deepest remaining one count as equally deep;
//! the lowest link goes first. So the same points stay while the placement changes by rounding.

use super::decomposition::{check_pair, has_parts};
use super::dispatcher::ContinuumDispatcher;
use super::feature::SAME_POINT;
use super::iterated::IteratedPair;
use super::link_triangle::LinkTrianglePair;
use super::link_triangle_manifold::TriangleRules;
use super::range::{check_margin, check_pose};
use super::robot_surface::links_of;
use super::strict_dispatcher::StrictDispatcher;
use super::thin_shape::ThinShape;
use super::{
    link_convex_manifold, link_halfspace_manifold, link_link_manifold, link_triangle_manifold,
    range, robot_surface_manifold,
};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::details::{self, NormalConstraints};
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, PersistentQueryDispatcher, PointQuery, Unsupported,
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
        check_pair(g1, g2)?;
        if g1.as_voxels().or(g2.as_voxels()).is_some() {
            return self.0.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        }
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
                remove_inner_points(chain.links(), side, (prediction, rounding), manifolds);
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
        check_pair(g1, g2)?;
        let thin = ThinShape::of(g1, g2);
        let [g1, g2] = thin.pair(g1, g2);
        let is_constrained = normal_constraints1.is_some() || normal_constraints2.is_some();
        if let Some(pair) = LinkTrianglePair::of(g1, g2)? {
            // The neighbours of the triangle are unknown.
            let constraints = (normal_constraints1, normal_constraints2);
            let rules = TriangleRules { constraints, is_free: &|_| false };
            let met = link_triangle_manifold::update(pos12, &pair, &rules, prediction, manifold)?;
            if let Some(met) = met {
                met.limit_depths(met.dist, manifold);
            }
            return Ok(());
        }
        if link_halfspace_manifold::update(pos12, (g1, g2), prediction, manifold)? {
            return Ok(());
        }
        // Find an overlap first, then measure it.
        let within = prediction.max(0.0);
        let is_link = links_of(g1).or(links_of(g2)).is_some();
        let is_answered = !is_constrained
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
            inner.contact_manifold_convex_convex(
                pos12,
                g1,
                g2,
                normal_constraints1,
                normal_constraints2,
                within,
                manifold,
            )?;
            keep_finite(manifold)?;
        }
        if prediction < 0.0 {
            drop_beyond(prediction, std::slice::from_mut(manifold));
        }
        Ok(())
    }
}

/// Removes the points with numbers that are not finite.
///
/// # Errors
/// [`Unsupported`] if no point remains.
fn keep_finite<M, C>(manifold: &mut ContactManifold<M, C>) -> Result<(), Unsupported> {
    let had_points = !manifold.points.is_empty();
    manifold.points.retain(link_convex_manifold::is_finite);
    let has_normals = manifold.local_n1.is_finite() && manifold.local_n2.is_finite();
    if had_points && manifold.points.is_empty() || !has_normals {
        manifold.points.clear();
        return Err(Unsupported);
    }
    Ok(())
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

/// The cosine between normal and axis above which a point leans out over an end. A normal that
/// leans less cannot catch. It exceeds the vibration of a chain at rest, so the points do not
/// change with each change of sign. (Measured: with 1e-9 a straight chain in a corner changes its
/// points in 62 of 200 steps.)
const LEANS: Real = 1e-4;

/// Which of the two shapes of a pair is the chain.
#[derive(Clone, Copy, PartialEq, Eq)]
enum WhichShape {
    First,
    Second,
}

impl WhichShape {
    /// Returns the link of a manifold and the part of the other shape.
    fn names<M, C>(self, manifold: &ContactManifold<M, C>) -> (usize, u32) {
        let (link, other) = match self {
            Self::First => (manifold.subshape1, manifold.subshape2),
            Self::Second => (manifold.subshape2, manifold.subshape1),
        };
        (link as usize, other)
    }

    fn normal<M, C>(self, manifold: &ContactManifold<M, C>) -> Vector {
        if self == Self::First { manifold.local_n1 } else { manifold.local_n2 }
    }
}

/// Removes the points inside joints from the manifolds of a chain with these `links`. Depths that
/// differ by at most `rounding` are equal.
fn remove_inner_points<M, C>(
    links: &[ModifiedCylinder],
    side: WhichShape,
    (prediction, rounding): (Real, Real),
    manifolds: &mut [ContactManifold<M, C>],
) {
    if links.len() < 2 {
        return;
    }
    let mut order: Vec<usize> =
        (0..manifolds.len()).filter(|&m| !manifolds[m].points.is_empty()).collect();
    order.sort_by_key(|&m| {
        let (link, other) = side.names(&manifolds[m]);
        (other, link)
    });
    let (mut points, mut hidden, mut touching) = (Vec::new(), Vec::new(), Vec::new());
    for group in order.chunk_by(|&m, &n| side.names(&manifolds[m]).1 == side.names(&manifolds[n]).1)
    {
        if group.len() < 2 {
            continue;
        }
        points.clear();
        touching.clear();
        for &m in group {
            points.extend(
                manifolds[m].points.iter().enumerate().map(|(p, point)| (point.dist, m, p)),
            );
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut left = &mut points[..];
        while let Some(&(deepest, ..)) = left.first() {
            let (equal, others) = left
                .split_at_mut(left.partition_point(|point| point.0 <= deepest + rounding).max(1));
            equal.sort_unstable_by_key(|&(_, m, p)| (side.names(&manifolds[m]).0, m, p));
            left = others;
            for &(_, m, p) in &*equal {
                let manifold = &manifolds[m];
                let (index, _) = side.names(manifold);
                let point = &manifold.points[p];
                let at = if side == WhichShape::First { point.local_p1 } else { point.local_p2 };
                let Some(link) = links.get(index) else { continue };
                let is_covered =
                    |other: usize| other != index && is_inside(at, &links[other], link);
                let is_out = leans_out(link, at, side.normal(manifold));
                if is_out && touching.iter().any(|&other| is_covered(other)) {
                    hidden.push((m, p));
                } else if !touching.contains(&index) {
                    touching.push(index);
                }
            }
        }
    }
    // From the last point of each manifold, so that the indices of the others stay valid.
    hidden.sort_unstable_by(|a, b| b.cmp(a));
    for of_one in hidden.chunk_by(|a, b| a.0 == b.0) {
        let points = &mut manifolds[of_one[0].0].points;
        for &(_, p) in of_one {
            points.remove(p);
        }
        if points.iter().all(|point| point.dist > prediction) {
            points.clear();
        }
    }
}

/// Case 1.
fn leans_out(link: &ModifiedCylinder, at: Vector, normal: Vector) -> bool {
    let lean = normal.dot(link.axis());
    let from_middle = (at - link.start()).dot(link.axis()) - 0.5 * link.length();
    lean.abs() > LEANS && (lean > 0.0) == (from_middle > 0.0)
}

/// Case 2.
fn is_inside(at: Vector, other: &ModifiedCylinder, link: &ModifiedCylinder) -> bool {
    other.distance_to_local_point(at, true) <= SAME_POINT * (link.length() + link.radius())
}
