//! The contact manifolds of a robot and a mesh: one for each link and triangle that meet.
//!
//! Each link looks for triangles within its own box in the mesh's frame. (parry's routine for two composites
//! goes through all triangles within the box of the whole chain: most of a bent robot's box is far from it.) The
//! manifold of a link and a triangle keeps what the host has stored with it, and is found again by their ids;
//! so nothing is lost when the robot changes its shape. Pairs that do not meet leave no manifold behind.

use super::link_triangle::LinkTrianglePair;
use super::link_triangle_manifold;
use super::robot_surface::links_of;
use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::{Pose, Real};
use parry3d_f64::query::details::{NormalConstraints, VoxelsShapeContactManifoldsWorkspace};
use parry3d_f64::query::{ContactManifold, ContactManifoldsWorkspace, Unsupported};
use parry3d_f64::shape::Shape;
use std::collections::HashMap;

/// Brings the manifolds up to date, if the shapes are a link or a chain and a mesh, in either order. Returns
/// whether they are. Boxes are loosened by `loose`: by the prediction, if it is positive, and by rounding.
///
/// # Errors
/// [`Unsupported`] for a triangle within reach that is not finite or out of range. There are no manifolds then.
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
    let (links, mesh, robot_is_first) = match (links_of(g1), g2.as_trimesh(), g1.as_trimesh(), links_of(g2)) {
        (Some(links), Some(mesh), _, _) => (links, mesh, true),
        (_, _, Some(mesh), Some(links)) => (links, mesh, false),
        _ => return Ok(false),
    };
    // rapier takes a workspace for the sign that manifolds come and go. The manifolds hold all there is to keep, and an
    // empty one of parry's own can be saved and loaded, which one of ours could not.
    workspace.get_or_insert_with(|| VoxelsShapeContactManifoldsWorkspace::<2>::new().into());
    let robot_pose = if robot_is_first { pos12.inverse() } else { *pos12 };
    let name = |manifold: &ContactManifold<M, C>| (manifold.subshape1, manifold.subshape2);
    let mut before: HashMap<_, _> = manifolds.drain(..).map(|manifold| (name(&manifold), manifold)).collect();
    for (index, link) in links.iter().enumerate() {
        let bounds = link.aabb(&robot_pose).loosened(loose);
        for id in mesh.bvh().intersect_aabb(&bounds) {
            let triangle = mesh.triangle(id);
            let normals = mesh.triangle_normal_constraints(id);
            let normals = normals.as_ref().map(|normals| normals as &dyn NormalConstraints);
            let (ids, constraints) = if robot_is_first {
                ((index as u32, id), (None, normals))
            } else {
                ((id, index as u32), (normals, None))
            };
            let mut manifold =
                before.remove(&ids).unwrap_or_else(|| ContactManifold::with_data(ids.0, ids.1, M::default()));
            let updated = LinkTrianglePair::new(link, &triangle, robot_is_first).and_then(|pair| {
                link_triangle_manifold::update(pos12, &pair, constraints, prediction, &mut manifold)
            });
            if let Err(refused) = updated {
                manifolds.clear();
                return Err(refused);
            }
            if !manifold.points.is_empty() {
                manifolds.push(manifold);
            }
        }
    }
    Ok(true)
}
