//! A link or a chain against a triangle or a triangle mesh, exactly.
//!
//! A triangle is measured in the frame of the first shape, so that only the second is moved. For a
//! mesh, the robot is moved into the mesh's frame. Answers are transformed back to the frames of
//! the two shapes at the end.

use super::link_triangle::{self, LinkContact};
use super::range::in_range;
use crate::pair::{Best, Nearest, PlacedLink};
use crate::robot::{Chain, ModifiedCylinder};
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::partitioning::BvhLeafCost;
use parry3d_f64::query::{ClosestPoints, Contact, ShapeDistance, ShapeIntersection, Unsupported};
use parry3d_f64::shape::{Shape, TriMesh, Triangle};
use std::cell::Cell;

/// Returns the links of a robot: a chain or a single link.
pub(super) fn links_of(shape: &dyn Shape) -> Option<&[ModifiedCylinder]> {
    let link = shape.as_shape::<ModifiedCylinder>().map(std::slice::from_ref);
    link.or_else(|| shape.as_shape::<Chain>().map(Chain::links))
}

#[derive(Clone, Copy)]
enum Surface<'a> {
    Triangle(&'a Triangle),
    Mesh(&'a TriMesh),
}

impl<'a> Surface<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        shape.as_triangle().map(Self::Triangle).or_else(|| shape.as_trimesh().map(Self::Mesh))
    }
}

/// A robot and a surface, in either order.
pub(super) struct RobotSurface<'a> {
    links: &'a [ModifiedCylinder],
    surface: Surface<'a>,
    pos12: &'a Pose,
    robot_is_first: bool,
}

/// The closest points of a robot and a surface, in the frame of measurement.
struct NearestPair {
    link: usize,
    triangle: u32,
    distance: Real,
    on_robot: Vector,
    on_surface: Vector,
}

impl<'a> RobotSurface<'a> {
    /// Returns the pair, if the shapes are one.
    pub fn of(pos12: &'a Pose, g1: &'a dyn Shape, g2: &'a dyn Shape) -> Option<Self> {
        let pair = |robot, surface, robot_is_first| {
            Some(Self {
                links: links_of(robot)?,
                surface: Surface::of(surface)?,
                pos12,
                robot_is_first,
            })
        };
        pair(g1, g2, true).or_else(|| pair(g2, g1, false))
    }

    pub fn distance(&self) -> Result<ShapeDistance, Unsupported> {
        let nearest = self.nearest(Real::INFINITY, SearchGoal::Nearest)?.ok_or(Unsupported)?;
        let (subshape1, subshape2) = self.subshapes(nearest.link, nearest.triangle);
        Ok(ShapeDistance::new(nearest.distance).with_subshapes(subshape1, subshape2))
    }

    pub fn intersection_test(&self) -> Result<ShapeIntersection, Unsupported> {
        Ok(match self.nearest(0.0, SearchGoal::FirstWithinBound)? {
            Some(touching) => {
                let (subshape1, subshape2) = self.subshapes(touching.link, touching.triangle);
                ShapeIntersection::new(true).with_subshapes(subshape1, subshape2)
            }
            None => ShapeIntersection::new(false),
        })
    }

    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        Ok(match self.nearest(max_dist, SearchGoal::Nearest)? {
            None => ClosestPoints::Disjoint,
            Some(nearest) if nearest.distance > 0.0 => {
                let (point1, point2) = self.points(nearest.on_robot, nearest.on_surface);
                ClosestPoints::WithinMargin(point1, point2)
            }
            Some(_) => ClosestPoints::Intersecting,
        })
    }

    pub fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        let Some(nearest) = self.nearest(prediction, SearchGoal::Nearest)? else {
            return Ok(None);
        };
        let mut best =
            (self.contact_of(nearest.link, nearest.triangle)?, nearest.link, nearest.triangle);
        // The distance decides whether it is within the prediction.
        if nearest.distance > 0.0 {
            best.0.distance = nearest.distance;
        } else {
            best.0.distance = best.0.distance.min(0.0);
            // In an overlap the search may skip places that overlap; the deepest counts.
            for link in 0..self.links.len() {
                for triangle in self.triangles_near(link) {
                    let contact = self.contact_of(link, triangle)?;
                    if contact.distance < best.0.distance {
                        best = (contact, link, triangle);
                    }
                }
            }
        }
        let (contact, link, triangle) = best;
        let (subshape1, subshape2) = self.subshapes(link, triangle);
        let report = || self.report(&contact).with_subshapes(subshape1, subshape2);
        Ok((contact.distance <= prediction).then(report))
    }

    /// Returns the closest link and triangle at most `margin` apart. A negative margin asks for
    /// overlap, so its bound is 0.
    fn nearest(&self, margin: Real, until: SearchGoal) -> Result<Option<NearestPair>, Unsupported> {
        let margin = margin.max(0.0);
        match self.surface {
            Surface::Triangle(_) => self.nearest_to_triangle(margin),
            Surface::Mesh(mesh) => self.nearest_in_mesh(mesh, margin, until),
        }
    }

    fn nearest_to_triangle(&self, margin: Real) -> Result<Option<NearestPair>, Unsupported> {
        let triangle = self.triangle(0)?;
        let mut best: Option<NearestPair> = None;
        for (index, link) in self.links.iter().enumerate() {
            let link = self.placed(link)?;
            let (distance, on_robot, on_surface) = link_triangle::closest(&link, triangle);
            let is_nearer = best.as_ref().is_none_or(|best| distance < best.distance);
            if distance <= margin && is_nearer {
                best =
                    Some(NearestPair { link: index, triangle: 0, distance, on_robot, on_surface });
            }
        }
        Ok(best)
    }

    fn nearest_in_mesh(
        &self,
        mesh: &TriMesh,
        margin: Real,
        until: SearchGoal,
    ) -> Result<Option<NearestPair>, Unsupported> {
        let (bounds, pose) = (mesh.bvh().root_aabb(), self.robot_pose());
        in_range(bounds.mins).and(in_range(bounds.maxs))?;
        let mut best: Option<(usize, Nearest)> = None;
        for (number, link) in self.links.iter().enumerate() {
            self.placed(link)?;
            // The search returns triangles strictly nearer than its bound.
            let bound = best.map_or(margin.next_up(), |(_, nearest)| nearest.distance);
            let placed = PlacedLink::new(link, &pose);
            if let Some(nearest) = search(mesh, &placed, bound, until).map_err(|_| Unsupported)? {
                best = Some((number, nearest));
                if until == SearchGoal::FirstWithinBound {
                    break;
                }
            }
        }
        Ok(best.map(|(link, nearest)| NearestPair {
            link,
            triangle: nearest.triangle,
            distance: nearest.distance,
            on_robot: nearest.on_robot,
            on_surface: nearest.on_mesh,
        }))
    }

    fn contact_of(&self, link: usize, triangle: u32) -> Result<LinkContact, Unsupported> {
        link_triangle::contact(&self.placed(&self.links[link])?, self.triangle(triangle)?)
            .ok_or(Unsupported)
    }

    /// Returns the triangles whose boxes meet the link's box.
    fn triangles_near(&self, link: usize) -> Vec<u32> {
        match self.surface {
            Surface::Triangle(_) => vec![0],
            Surface::Mesh(mesh) => {
                mesh.bvh().intersect_aabb(&self.links[link].aabb(&self.robot_pose())).collect()
            }
        }
    }

    /// Returns the robot's pose in the frame of measurement.
    fn robot_pose(&self) -> Pose {
        match (self.surface, self.robot_is_first) {
            (_, false) => *self.pos12,
            (Surface::Triangle(_), true) => Pose::IDENTITY,
            (Surface::Mesh(_), true) => self.pos12.inverse(),
        }
    }

    /// Returns a link in the frame of measurement.
    fn placed(&self, link: &ModifiedCylinder) -> Result<ModifiedCylinder, Unsupported> {
        let placed = link.transformed(&self.robot_pose());
        in_range(placed.start()).and(in_range(placed.end())).map(|_| placed)
    }

    /// Returns a triangle in the frame of measurement.
    fn triangle(&self, index: u32) -> Result<[Vector; 3], Unsupported> {
        let vertices = match self.surface {
            Surface::Triangle(triangle) if self.robot_is_first => triangle.transformed(self.pos12),
            Surface::Triangle(triangle) => *triangle,
            Surface::Mesh(mesh) => mesh.triangle(index),
        };
        let [a, b, c] = [vertices.a, vertices.b, vertices.c];
        in_range(a).and(in_range(b)).and(in_range(c)).map(|_| [a, b, c])
    }

    /// Returns the sub-shapes of the first and the second shape. A single link or triangle is
    /// sub-shape 0.
    fn subshapes(&self, link: usize, triangle: u32) -> (u32, u32) {
        let link = link as u32;
        if self.robot_is_first { (link, triangle) } else { (triangle, link) }
    }

    /// Returns each point in the frame of its shape, the first shape's point first.
    fn points(&self, on_robot: Vector, on_surface: Vector) -> (Vector, Vector) {
        match (self.surface, self.robot_is_first) {
            (Surface::Triangle(_), true) => {
                (on_robot, self.pos12.inverse_transform_point(on_surface))
            }
            (Surface::Mesh(_), true) => (self.pos12 * on_robot, on_surface),
            (_, false) => (on_surface, self.pos12.inverse_transform_point(on_robot)),
        }
    }

    fn report(&self, contact: &LinkContact) -> Contact {
        let (point1, point2) = self.points(contact.on_link, contact.on_other);
        // Out of the first shape, in the frame of measurement.
        let outward = if self.robot_is_first { contact.normal } else { -contact.normal };
        let rotation = self.pos12.rotation;
        let (normal1, normal2) = match (self.surface, self.robot_is_first) {
            (Surface::Mesh(_), true) => (rotation * outward, -outward),
            _ => (outward, rotation.inverse() * -outward),
        };
        Contact::new(point1, point2, normal1, normal2, contact.distance)
    }
}

/// The error for a visited triangle with a vertex that is NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TriangleNotFinite;

/// When a search ends.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum SearchGoal {
    /// When the nearest triangle is known.
    Nearest,
    /// When some triangle is nearer than the bound.
    FirstWithinBound,
}

/// Returns the triangle nearest to the link among those strictly nearer than `bound`.
///
/// Visits nearer boxes first and prunes boxes at least as far as the best triangle so far.
///
/// # Errors
/// A visited triangle is not finite.
pub(super) fn search(
    mesh: &TriMesh,
    link: &PlacedLink,
    bound: Real,
    until: SearchGoal,
) -> Result<Option<Nearest>, TriangleNotFinite> {
    let all_finite = Cell::new(true);
    let found = mesh.bvh().find_best(
        bound,
        // Inlined, the two boxes of a node are computed together.
        #[inline(always)]
        |node, _| link.distance_to_box(node.mins(), node.maxs()),
        |triangle, bound| {
            let vertices = mesh.triangle(triangle).vertices().to_owned();
            if !vertices.iter().all(|vertex| vertex.is_finite()) {
                all_finite.set(false);
                return None;
            }
            let mut best = Best::within(bound);
            best.measure(link, triangle, vertices);
            let nearest = best.nearest()?;
            // A cost of 0 prunes everything else.
            let cost = if until == SearchGoal::FirstWithinBound { 0.0 } else { nearest.distance };
            Some(LeafCost { cost, nearest })
        },
    );
    if all_finite.get() {
        Ok(found.map(|(_, candidate)| candidate.nearest))
    } else {
        Err(TriangleNotFinite)
    }
}

struct LeafCost {
    cost: Real,
    nearest: Nearest,
}

impl BvhLeafCost for LeafCost {
    fn cost(&self) -> Real {
        self.cost
    }
}
