//! The contact manifolds of a robot and a mesh or a height field: one per link and triangle in
//! contact.
//!
//! Each link searches the triangles within its own box in the surface's frame. (parry's routine for
//! two composites visits all triangles within the box of the whole chain; most of a bent robot's
//! box is far from it.) The manifold of a link and a triangle keeps the host's data. Their ids
//! identify it in the next step, so a change of the robot's shape loses nothing. Pairs without
//! contact leave no manifold.
//!
//! # Flags of the surface
//! The flags `FIX_INTERNAL_EDGES`, one-sided or two-sided, may turn normals. They never remove a
//! contact. For the contacts of one link with all triangles:
//!
//! 1. A contact from behind a one-sided surface counts, unless the link has a contact from the
//!    front that is at least as deep. Then the near side of a solid represents the far side.
//! 2. The deepest contact is in the manifolds. If its normal has been turned and none of the points
//!    is as deep, its closest points are added. Nothing is deeper than this contact.

use super::link_triangle::LinkTrianglePair;
use super::link_triangle_manifold::{self, Met, TriangleRules};
use super::range::rounding_of_depths;
use super::robot_surface::links_of;
use crate::distance::{Vec3, point_triangle};
use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::details::{NormalConstraints, VoxelsShapeContactManifoldsWorkspace};
use parry3d_f64::query::{ContactManifold, ContactManifoldsWorkspace, Unsupported};
use parry3d_f64::shape::{HeightField, Shape, TriMesh, Triangle, TrianglePseudoNormals};
use std::collections::HashMap;

/// Updates the manifolds, if the shapes are a link or a chain and a mesh or a height field, in
/// either order. Returns whether they are.
///
/// Boxes are loosened by `loose`: the prediction, if it is positive, plus rounding.
///
/// # Errors
/// [`Unsupported`] for a triangle within reach that is not finite or out of range. Then there are
/// no manifolds.
pub(super) fn update<M, C>(
    pos12: &Pose,
    (g1, g2): (&dyn Shape, &dyn Shape),
    (prediction, loose): (Real, Real),
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> Result<bool, Unsupported>
where
    M: Default + Clone,
    C: Default + Copy,
{
    let pairs = (links_of(g1), TriangleSurface::of(g2), TriangleSurface::of(g1), links_of(g2));
    let (links, surface, robot_is_first) = match pairs {
        (Some(links), Some(surface), _, _) => (links, surface, true),
        (_, _, Some(surface), Some(links)) => (links, surface, false),
        _ => return Ok(false),
    };
    // rapier takes a workspace as the sign that manifolds come and go. The manifolds hold the whole
    // state, and an empty workspace of parry can be saved and loaded, unlike one of this crate.
    workspace.get_or_insert_with(|| VoxelsShapeContactManifoldsWorkspace::<2>::new().into());
    let robot_pose = if robot_is_first { pos12.inverse() } else { *pos12 };
    let rounding = rounding_of_depths(pos12, g1, g2);
    let name = |manifold: &ContactManifold<M, C>| (manifold.subshape1, manifold.subshape2);
    let mut before: HashMap<_, _> =
        manifolds.drain(..).map(|manifold| (name(&manifold), manifold)).collect();
    let (mut near, mut of_link, mut met) = (Vec::new(), Vec::new(), Vec::new());
    for (index, link) in links.iter().enumerate() {
        near.clear();
        met.clear();
        surface.collect_near(&link.aabb(&robot_pose).loosened(loose), &mut near);
        for (id, triangle) in &near {
            let normals = surface.constraints(*id);
            let has_free = normals.as_ref().is_some_and(|normals| surface.has_free_edge(normals));
            let normals = normals.as_ref().map(|normals| normals as &dyn NormalConstraints);
            let (ids, constraints) = if robot_is_first {
                ((index as u32, *id), (None, normals))
            } else {
                ((*id, index as u32), (normals, None))
            };
            let mut manifold = before
                .remove(&ids)
                .unwrap_or_else(|| ContactManifold::with_data(ids.0, ids.1, M::default()));
            let is_free = |edge: usize| has_free && surface.is_free(*id, triangle, edge);
            let rules = TriangleRules { constraints, is_free: &is_free };
            let updated = LinkTrianglePair::new(link, triangle, robot_is_first).and_then(|pair| {
                link_triangle_manifold::update(pos12, &pair, &rules, prediction, &mut manifold)
            });
            match updated {
                Err(refused) => {
                    manifolds.clear();
                    return Err(refused);
                }
                Ok(Some(contact)) => {
                    met.push(contact);
                    of_link.push(manifold);
                }
                Ok(None) => {}
            }
        }
        agree(&mut of_link, &met, rounding);
        manifolds.extend(of_link.drain(..).filter(|manifold| !manifold.points.is_empty()));
    }
    Ok(true)
}

/// Applies rules 1 and 2 to the manifolds of one link. Depths that differ by at most `rounding` are
/// equal.
fn agree<M, C: Copy>(manifolds: &mut [ContactManifold<M, C>], met: &[Met], rounding: Real) {
    let least = |dists: &mut dyn Iterator<Item = Real>| dists.fold(Real::INFINITY, Real::min);
    let deepest = least(&mut met.iter().map(|met| met.dist));
    let from_front = least(&mut met.iter().filter(|met| !met.is_from_behind).map(|met| met.dist));
    let mut shown = Real::INFINITY;
    let mut stand_in = None;
    for (index, (manifold, met)) in manifolds.iter_mut().zip(met).enumerate() {
        if met.is_from_behind && from_front <= met.dist + rounding {
            manifold.points.clear();
            continue;
        }
        let closest = manifold.points.last().copied().filter(|_| met.is_turned);
        met.drop_closest(deepest, manifold);
        shown = least(&mut manifold.points.iter().map(|point| point.dist)).min(shown);
        if stand_in.is_none() && met.dist <= deepest + rounding {
            stand_in = closest.map(|closest| (index, closest));
        }
    }
    if let Some((index, closest)) = stand_in.filter(|_| shown > deepest + rounding) {
        manifolds[index].points.push(closest);
    }
}

/// Pseudo-normals that differ from the face's by rounding differ by less.
const LEVEL: Real = 1e-9;

#[derive(Clone, Copy)]
enum TriangleSurface<'a> {
    Mesh(&'a TriMesh),
    Field(&'a HeightField),
}

impl<'a> TriangleSurface<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        shape.as_trimesh().map(Self::Mesh).or_else(|| shape.as_heightfield().map(Self::Field))
    }

    /// Appends the triangles whose boxes meet `bounds`, and their ids.
    fn collect_near(self, bounds: &Aabb, near: &mut Vec<(u32, Triangle)>) {
        match self {
            Self::Mesh(mesh) => {
                near.extend(mesh.bvh().intersect_aabb(bounds).map(|id| (id, mesh.triangle(id))))
            }
            Self::Field(field) => field
                .map_elements_in_local_aabb(bounds, &mut |id, triangle| near.push((id, *triangle))),
        }
    }

    fn constraints(self, id: u32) -> Option<TrianglePseudoNormals> {
        match self {
            Self::Mesh(mesh) => mesh.triangle_normal_constraints(id),
            Self::Field(field) => field.triangle_normal_constraints(id),
        }
    }

    /// Returns `false` if each edge has a neighbour: a mesh's pseudo-normal of an edge without a
    /// neighbour is the face's normal.
    fn has_free_edge(self, normals: &TrianglePseudoNormals) -> bool {
        let is_level = |edge: &Vector| (*edge - normals.face).length() <= LEVEL;
        matches!(self, Self::Field(_)) || normals.edges.iter().any(is_level)
    }

    /// Returns whether the middle of an edge lies on no other triangle with an area, within
    /// rounding.
    fn is_free(self, id: u32, triangle: &Triangle, edge: usize) -> bool {
        let corners = triangle.vertices();
        let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
        let middle = 0.5 * from + 0.5 * to;
        // A height field recomputes a corner for each cell, from places that are shares of its
        // size.
        let size = match self {
            Self::Mesh(_) => from.abs().max(to.abs()),
            Self::Field(field) => {
                let bounds = field.root_aabb();
                bounds.mins.abs().max(bounds.maxs.abs())
            }
        };
        let rounding = 8.0 * Real::EPSILON * size.max_element();
        let mut near = Vec::new();
        self.collect_near(&Aabb::new(middle, middle).loosened(rounding), &mut near);
        let holds = |other: &Triangle| {
            let corners = other.vertices().map(Vec3::from);
            other.normal().is_some()
                && point_triangle(Vec3::from(middle), corners).distance <= rounding
        };
        !near.iter().any(|(other_id, other)| *other_id != id && holds(other))
    }
}
