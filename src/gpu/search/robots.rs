//! The robots of a batch in the form that the device gets.

use super::bounds::{ErrorBound, SearchCap};
use crate::answer::ProximityError;
use crate::distance::Vec3;
use crate::distance::lanes::Lane;
use crate::mesh::{SearchFrame, round};
use crate::pair::PlacedRobot;
use crate::robot::{Chain, ModifiedCylinder};
use gpu_batch::record;
use gpu_batch::wgpu::WriteOnly;
use parry3d_f64::math::{Pose, Real, Vector};

record! {
    /// The parameters with which the device computes the points of a chunk of robots.
    pub(super) struct BendingQuery {
        pub robots: u32,
        /// The sections of each robot, and the segments of each section.
        pub sections: u32,
        pub segments: u32,
    }
}

/// The robots of a batch. A **shape** is what the device gets of a robot beside its radii and caps:
/// its points, or the sections from which the device computes its points.
pub(super) trait Packed: Copy + Sync {
    /// The most link groups of a chunk, which has at least one robot. Larger chunks overlap less;
    /// smaller chunks wait more often.
    const CHUNK: usize;

    fn len(self) -> usize;

    /// The number of links of a robot.
    fn links(self, robot: usize) -> usize;

    /// Whether a robot is known to have the radii and caps of the robot before.
    fn is_like_before(self, robot: usize) -> bool;

    /// Writes the radius and the caps of each link; nothing if `bytes` is empty.
    fn write_radii(self, robot: usize, frame: &SearchFrame, bytes: WriteOnly<[u8]>);

    /// The parameters with which the device computes the points of a chunk of robots; `None` if the
    /// shapes are the points.
    fn bending(self, robots: usize) -> Option<BendingQuery>;

    /// Appends the numbers that all robots share, which come before their shapes.
    fn write_base(self, frame: &SearchFrame, bytes: &mut Vec<u8>);

    /// The bytes of the shape of a robot with this number of links; 0 for none.
    fn shape_size(self, links: u32) -> usize;

    /// Writes a shape. Returns the error of its points beside rounding; `None` if the device cannot
    /// search for the robot.
    ///
    /// # Errors
    /// The error of a bad robot.
    fn write_shape(
        self,
        robot: usize,
        frame: &SearchFrame,
        bytes: WriteOnly<[u8]>,
    ) -> Result<Option<f32>, ProximityError>;
}

/// The robots of a query, as chains. A shape is the points.
#[derive(Clone, Copy)]
pub(super) enum Robots<'a> {
    Batch(&'a [(&'a Chain, Pose)]),
    One(&'a PlacedRobot<'a>),
}

impl<'a> Robots<'a> {
    fn links_of(self, robot: usize) -> &'a [ModifiedCylinder] {
        match self {
            Self::Batch(robots) => robots[robot].0.links(),
            Self::One(placed) => placed.links(),
        }
    }

    /// # Errors
    /// The error of a bad robot.
    pub(super) fn placed(self, robot: usize) -> Result<PlacedRobot<'a>, ProximityError> {
        match self {
            Self::Batch(robots) => PlacedRobot::new(robots[robot].0, &robots[robot].1),
            Self::One(placed) => Ok(*placed),
        }
    }
}

impl Packed for Robots<'_> {
    const CHUNK: usize = 1 << 13;

    fn len(self) -> usize {
        match self {
            Self::Batch(robots) => robots.len(),
            Self::One(_) => 1,
        }
    }

    fn links(self, robot: usize) -> usize {
        self.links_of(robot).len()
    }

    /// Whether both are the same chain. To read all links for a comparison takes longer than to
    /// upload radii and caps again.
    fn is_like_before(self, robot: usize) -> bool {
        std::ptr::eq(self.links_of(robot - 1), self.links_of(robot))
    }

    fn write_radii(self, robot: usize, frame: &SearchFrame, bytes: WriteOnly<[u8]>) {
        let (pairs, _) = bytes.into_chunks::<8>();
        for (pair, link) in pairs.into_iter().zip(self.links_of(robot)) {
            let caps = SearchCap::of(link.flat());
            pair.write(bytes_of([radius_of(link, frame), SearchCap::code(caps)]));
        }
    }

    fn bending(self, _: usize) -> Option<BendingQuery> {
        None
    }

    fn write_base(self, _: &SearchFrame, _: &mut Vec<u8>) {}

    fn shape_size(self, links: u32) -> usize {
        if links == 0 { 0 } else { 12 * (links as usize + 1) }
    }

    /// The device can search for the robot if all numbers are in range, and if the error of its
    /// bounds is small beside a triangle.
    fn write_shape(
        self,
        robot: usize,
        frame: &SearchFrame,
        bytes: WriteOnly<[u8]>,
    ) -> Result<Option<f32>, ProximityError> {
        let robot = self.placed(robot)?;
        let links = robot.links();
        let (points, _) = bytes.into_chunks::<12>();
        let mut points = points.into_iter();
        let mut write = |point: Vec3<f32>| {
            if let Some(bytes) = points.next() {
                bytes.write(bytes_of(<[f32; 3]>::from(point)));
            }
        };
        let ([x, y, z], origin) = robot.axes_in(frame);
        let placed = |point: Vector| round(x * point.x + y * point.y + z * point.z + origin);
        let mut start = placed(links[0].start());
        write(start);
        let mut bound = ErrorBound::default();
        for link in links {
            let end = placed(link.end());
            write(end);
            bound.add([start, end], radius_of(link, frame), link.flat());
            start = end;
        }
        // R of the module `bounds`.
        let reach = Real::from(bound.reach());
        let is_resolved = is_fine(frame)
            // The links are measured where another formula places them.
            && robot.rounding() * frame.scale <= Real::from(f32::EPSILON) * 1e-3 * reach
            && reach <= <f32 as Lane>::FARTHEST
            && 4.0 * Real::from(bound.error()) <= frame.typical;
        Ok(is_resolved.then_some(0.0))
    }
}

/// Whether the least numbers of the mesh's unit do not show in the search frame.
pub(super) fn is_fine(frame: &SearchFrame) -> bool {
    frame.least < Real::from(f32::EPSILON) * 1e-3
}

/// Numbers as the device reads them.
pub(super) fn bytes_of<const N: usize, const BYTES: usize>(numbers: [f32; N]) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    bytes.copy_from_slice(numbers.map(f32::to_ne_bytes).as_flattened());
    bytes
}

fn radius_of(link: &ModifiedCylinder, frame: &SearchFrame) -> f32 {
    (link.radius() * frame.scale) as f32
}
