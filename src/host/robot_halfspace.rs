//! A link or a chain against a half-space, exactly.
//!
//! The half-space is bounded by the plane through its origin; its normal points out of it. The
//! lowest point of a link over the plane is its support point against the normal (see
//! [`support_map`](super::support_map)). Its height, if positive, is the distance. Otherwise it is
//! minus the length of the least separating translation. (parry's `contact` inverts the pose if the
//! half-space comes second, and parry has no nonlinear cast for the pair.)

use super::axial::unit;
use super::range::in_range;
use super::robot_surface::links_of;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Pose, Real, Vector};
use parry3d_f64::query::{
    ClosestPoints, Contact, ShapeCastHit, ShapeCastOptions, ShapeCastStatus, ShapeDistance,
    ShapeIntersection, Unsupported,
};
use parry3d_f64::shape::{Shape, SupportMap};

/// A robot and a half-space, in either order.
pub(super) struct RobotHalfSpace<'a> {
    links: &'a [ModifiedCylinder],
    /// The unit normal, in the half-space's frame.
    normal: Vector,
    /// The robot's pose in the half-space's frame.
    pose: Pose,
    robot_is_first: bool,
}

/// The lowest point of a robot, in the half-space's frame.
struct LowestPoint {
    link: u32,
    height: Real,
    point: Vector,
}

impl<'a> RobotHalfSpace<'a> {
    /// Returns the pair, if the shapes are one.
    ///
    /// # Errors
    /// [`Unsupported`] if the half-space's normal has no direction.
    pub fn of(
        pos12: &Pose,
        g1: &'a dyn Shape,
        g2: &'a dyn Shape,
    ) -> Result<Option<Self>, Unsupported> {
        let (links, plane, robot_is_first) =
            match (links_of(g1), g2.as_halfspace(), g1.as_halfspace(), links_of(g2)) {
                (Some(links), Some(plane), _, _) => (links, plane, true),
                (_, _, Some(plane), Some(links)) => (links, plane, false),
                _ => return Ok(None),
            };
        let normal = unit(plane.normal).ok_or(Unsupported)?;
        let pose = if robot_is_first { pos12.inverse() } else { *pos12 };
        Ok(Some(Self { links, normal, pose, robot_is_first }))
    }

    pub fn distance(&self) -> Result<ShapeDistance, Unsupported> {
        let lowest = self.lowest()?;
        let (subshape1, subshape2) = self.in_order(lowest.link, 0);
        Ok(ShapeDistance::new(lowest.height.max(0.0)).with_subshapes(subshape1, subshape2))
    }

    pub fn intersection_test(&self) -> Result<ShapeIntersection, Unsupported> {
        let lowest = self.lowest()?;
        if lowest.height > 0.0 {
            return Ok(ShapeIntersection::new(false));
        }
        let (subshape1, subshape2) = self.in_order(lowest.link, 0);
        Ok(ShapeIntersection::new(true).with_subshapes(subshape1, subshape2))
    }

    pub fn closest_points(&self, max_dist: Real) -> Result<ClosestPoints, Unsupported> {
        let lowest = self.lowest()?;
        Ok(if lowest.height <= 0.0 {
            ClosestPoints::Intersecting
        } else if lowest.height <= max_dist {
            let (point1, point2) = self.points(lowest.point, lowest.height);
            ClosestPoints::WithinMargin(point1, point2)
        } else {
            ClosestPoints::Disjoint
        })
    }

    pub fn contact(&self, prediction: Real) -> Result<Option<Contact>, Unsupported> {
        let lowest = self.lowest()?;
        if lowest.height > prediction {
            return Ok(None);
        }
        let (point1, point2) = self.points(lowest.point, lowest.height);
        let (normal1, normal2) = self.normals();
        let contact = Contact::new(point1, point2, normal1, normal2, lowest.height);
        let (subshape1, subshape2) = self.in_order(lowest.link, 0);
        Ok(Some(contact.with_subshapes(subshape1, subshape2)))
    }

    /// Returns the time at which the lowest point reaches the target distance. All other points
    /// reach it later.
    pub fn cast_shapes(
        &self,
        local_vel12: Vector,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let lowest = self.lowest()?;
        // The robot's velocity in the half-space's frame.
        let velocity =
            if self.robot_is_first { -(self.pose.rotation * local_vel12) } else { local_vel12 };
        let speed = -velocity.dot(self.normal);
        let excess = lowest.height - options.target_distance;
        let (time_of_impact, status) = if excess > 0.0 {
            if speed <= 0.0 {
                return Ok(None);
            }
            (excess / speed, ShapeCastStatus::Converged)
        } else if options.stop_at_penetration || speed > 0.0 {
            (0.0, ShapeCastStatus::PenetratingOrWithinTargetDist)
        } else {
            return Ok(None);
        };
        if time_of_impact.is_nan() || time_of_impact > options.max_time_of_impact {
            return Ok(None);
        }
        // The point on the plane at the time of impact, and the point on the robot now.
        let below = lowest.point - self.normal * lowest.height;
        let along = velocity + self.normal * speed;
        let (witness1, witness2) = self.in_order(
            self.pose.inverse_transform_point(lowest.point),
            below + along * time_of_impact,
        );
        let (normal1, normal2) = self.normals();
        let (subshape1, subshape2) = self.in_order(lowest.link, 0);
        Ok(Some(ShapeCastHit {
            time_of_impact,
            witness1,
            witness2,
            normal1,
            normal2,
            status,
            subshape1,
            subshape2,
        }))
    }

    fn lowest(&self) -> Result<LowestPoint, Unsupported> {
        let mut lowest: Option<LowestPoint> = None;
        for (index, link) in self.links.iter().enumerate() {
            let link = link.transformed(&self.pose);
            in_range(link.start())?;
            in_range(link.end())?;
            let point = link.local_support_point_toward(-self.normal);
            let height = self.normal.dot(point);
            if lowest.as_ref().is_none_or(|lowest| height < lowest.height) {
                lowest = Some(LowestPoint { link: index as u32, height, point });
            }
        }
        lowest.filter(|lowest| lowest.height.is_finite()).ok_or(Unsupported)
    }

    /// Returns a point of the robot and its projection onto the plane, each in its shape's frame.
    fn points(&self, on_robot: Vector, height: Real) -> (Vector, Vector) {
        self.in_order(self.pose.inverse_transform_point(on_robot), on_robot - self.normal * height)
    }

    /// Returns the normals out of the first and the second shape, each in its shape's frame.
    fn normals(&self) -> (Vector, Vector) {
        self.in_order(self.pose.rotation.inverse() * -self.normal, self.normal)
    }

    fn in_order<T>(&self, robot: T, half_space: T) -> (T, T) {
        if self.robot_is_first { (robot, half_space) } else { (half_space, robot) }
    }
}
