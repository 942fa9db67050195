//! Degenerate placements of a robot and a wall, which are common in scenes and which random poses
//! never reach: axes along edges, faces and axes, a common axis, a wall seen edge-on, and vertices
//! and rims that touch, in every order of the vertices.
//!
//! 1. A wall offers [`Spot`]s: places on its surface with an outward and a tangent direction.
//! 2. The robot is built in the wall's own frame so that it touches there with a barrel, a cap or a
//!    rim. So aligned parts are aligned to the last digit.
//! 3. A gap is added or removed, from 0 and 1e-14 up, and the robot is tilted by 0 or by 1e-15 to
//!    1e-3.
//! 4. Half of the pairs are moved as a whole, by any pose.

use crate::Random;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::{
    HalfSpace, HeightField, SharedShape, TriMesh, TriMeshFlags, Triangle,
};
use parry_continuum::parry::utils::Array2;
use parry_continuum::{Cap, Chain, ModifiedCylinder};

/// A shape that a robot is placed against.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wall {
    Triangle,
    /// Two triangles; all edges but one are free.
    Plate,
    /// Twelve triangles around a box.
    BoxMesh,
    HeightField,
    Segment,
    Polyline,
    HalfSpace,
    Ball,
    Cuboid,
    Capsule,
    Cylinder,
    Cone,
    ConvexPolyhedron,
    Link,
    Chain,
    /// Boxes and a ball.
    Compound,
}

impl Wall {
    pub const ALL: [Self; 16] = [
        Self::Triangle,
        Self::Plate,
        Self::BoxMesh,
        Self::HeightField,
        Self::Segment,
        Self::Polyline,
        Self::HalfSpace,
        Self::Ball,
        Self::Cuboid,
        Self::Capsule,
        Self::Cylinder,
        Self::Cone,
        Self::ConvexPolyhedron,
        Self::Link,
        Self::Chain,
        Self::Compound,
    ];
}

/// The part of the robot that touches, before the tilt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Touch {
    /// Its barrel.
    Lying,
    /// A cap.
    Standing,
    /// A rim, or the rounding of a cap.
    Leaning,
    /// The whole robot, which has no length.
    Ball,
}

/// A robot and a wall.
#[derive(Clone)]
pub struct Placement {
    /// The link that touches.
    pub link: ModifiedCylinder,
    /// This link, or a chain that begins with it.
    pub robot: SharedShape,
    pub wall: SharedShape,
    /// The wall's pose in the robot's frame.
    pub pose: Pose,
    pub kind: Wall,
    pub touch: Touch,
    /// The gap between the two at the spot; negative in overlap. Elsewhere the overlap may be
    /// deeper.
    pub gap: f64,
    /// The angle by which the robot is tilted.
    pub tilt: f64,
}

/// A place on a wall's surface, with a unit vector out of it and one along it. Other choices of
/// these vectors may be equally valid.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    pub at: Vector,
    pub out: Vector,
    pub along: Vector,
}

impl Random {
    /// Returns a robot at a wall of this kind. All lengths are about 1.
    pub fn placement(&mut self, kind: Wall) -> Placement {
        let (wall, spot) = self.wall(kind);
        let gap = self.gap();
        let tilt = self.tilt();
        let radius = self.size();
        let (touch, link) = self.touching(spot, radius, gap);
        let turn = Rot3::from_axis_angle(self.way(spot), tilt);
        let tilted = Pose::from_translation(spot.at)
            * Pose::from_rotation(turn)
            * Pose::from_translation(-spot.at);
        let link = if tilt == 0.0 { link } else { link.transformed(&tilted) };
        // The wall in the robot's frame: a translation that keeps the axes, or any pose.
        let pose = match self.below(4) {
            0 => Pose::IDENTITY,
            1 => Pose::from_translation(self.point()),
            _ => self.pose(1.0),
        };
        let link = link.transformed(&pose);
        let robot = if touch != Touch::Ball && self.below(4) == 0 {
            self.chain_of(&link).map_or_else(|| SharedShape::new(link), SharedShape::new)
        } else {
            SharedShape::new(link)
        };
        Placement { link, robot, wall, pose, kind, touch, gap, tilt }
    }

    /// Returns a length: half of them are multiples of 1/8.
    fn size(&mut self) -> f64 {
        if self.below(2) == 0 { f64::from(1 + self.below(8)) / 8.0 } else { self.between(0.1, 1.0) }
    }

    /// Returns 0, a gap of random sign from 1e-14 to 0.3, or an overlap of 0.1 to 1.5.
    fn gap(&mut self) -> f64 {
        let sign = if self.below(2) == 0 { -1.0 } else { 1.0 };
        match self.below(8) {
            0 | 1 => 0.0,
            2..6 => sign * 10.0_f64.powf(self.between(-14.0, -2.0)),
            6 => sign * self.between(0.01, 0.3),
            _ => -self.between(0.1, 1.5),
        }
    }

    /// Returns 0 in half of the cases, otherwise a number from 1e-15 to 1e-3.
    fn tilt(&mut self) -> f64 {
        if self.below(2) == 0 { 0.0 } else { 10.0_f64.powf(self.between(-15.0, -3.0)) }
    }

    /// Returns the axis of the tilt.
    fn way(&mut self, spot: Spot) -> Vector {
        match self.below(4) {
            0 => spot.along,
            1 => spot.along.cross(spot.out),
            2 => spot.out,
            _ => self.direction(),
        }
    }

    /// Returns a fraction of a length: an end, the middle, a quarter, beyond an end, or any.
    fn share(&mut self) -> f64 {
        match self.below(6) {
            0 => 0.0,
            1 => 0.5,
            2 => 1.0,
            3 => 0.25,
            4 => -0.25,
            _ => self.unit(),
        }
    }

    fn touching(&mut self, spot: Spot, radius: f64, gap: f64) -> (Touch, ModifiedCylinder) {
        let Spot { at, out, along } = spot;
        let across = out.cross(along);
        let along = match self.below(4) {
            0 | 1 => along,
            2 => across,
            _ => (along + across) * 0.5_f64.sqrt(),
        };
        let length = 2.0 * self.size();
        let cap = |random: &mut Self| if random.below(2) == 0 { Cap::Flat } else { Cap::Round };
        let mut caps = [cap(self), cap(self)];
        let near = at + out * gap;
        let touch = [
            Touch::Lying,
            Touch::Standing,
            Touch::Leaning,
            Touch::Lying,
            Touch::Standing,
            Touch::Ball,
        ][self.below(6) as usize];
        let (mut start, mut end) = match touch {
            Touch::Lying => {
                let start = near + out * radius - along * (self.share() * length);
                (start, start + along * length)
            }
            Touch::Standing => {
                let aside = along * (self.share() * radius);
                let start =
                    near + aside + if caps[0] == Cap::Flat { Vector::ZERO } else { out * radius };
                (start, start + out * length)
            }
            Touch::Leaning => {
                // A 3-4-5 triangle keeps the numbers short.
                let (axis, lateral) = (out * 0.6 + along * 0.8, along * 0.6 - out * 0.8);
                let low = if caps[0] == Cap::Flat { -lateral } else { out };
                let start = near + low * radius;
                (start, start + axis * length)
            }
            Touch::Ball => {
                caps = [Cap::Round; 2];
                let centre = near + out * radius;
                (centre, centre)
            }
        };
        if self.below(2) == 0 {
            (start, end) = (end, start);
            caps.reverse();
        }
        let link = ModifiedCylinder::new(start, end, radius, caps).expect("a link of size one");
        (touch, link)
    }

    /// Returns a chain that begins with `link` and continues straight or bent.
    fn chain_of(&mut self, link: &ModifiedCylinder) -> Option<Chain> {
        let axis = (link.end() - link.start()).normalize();
        let bend = if self.below(2) == 0 { axis } else { (axis + 0.5 * self.point()).normalize() };
        let points = [link.start(), link.end(), link.end() + bend * link.length()];
        let radii =
            [link.radius(), if self.below(3) == 0 { 0.5 * link.radius() } else { link.radius() }];
        Chain::from_centreline(&points, &radii).ok()
    }

    /// Returns a wall and a spot on it, in its own frame.
    pub fn wall(&mut self, kind: Wall) -> (SharedShape, Spot) {
        let half = Vector::new(self.size(), self.size(), self.size());
        let (radius, long) = (self.size(), self.size());
        match kind {
            Wall::Triangle => {
                let corners = self.corners();
                (
                    SharedShape::new(Triangle::from(self.shuffled(corners))),
                    self.on_triangle(corners),
                )
            }
            Wall::Plate => {
                let [x, z] = [half.x, half.z];
                let corners =
                    [[-x, -z], [x, -z], [x, z], [-x, z]].map(|[x, z]| Vector::new(x, 0.0, z));
                let cut = self.below(2) as usize;
                let triangles = [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| ((k + cut) % 4) as u32));
                let spot = self.on_triangle([corners[cut], corners[1 + cut], corners[2 + cut % 2]]);
                (self.mesh(corners.to_vec(), &triangles), spot)
            }
            Wall::BoxMesh => {
                let (vertices, triangles) = SharedShape::cuboid(half.x, half.y, half.z)
                    .as_cuboid()
                    .map(|cuboid| cuboid.to_trimesh())
                    .expect("a cuboid");
                (self.mesh(vertices, &triangles), self.on_box(half))
            }
            Wall::HeightField => {
                let ridge = if self.below(2) == 0 { 0.0 } else { 0.25 };
                let heights =
                    Array2::new(3, 3, vec![0.0, 0.0, 0.0, ridge, ridge, ridge, 0.0, 0.0, 0.0]);
                let field = HeightField::new(heights, Vector::new(2.0 * half.x, 1.0, 2.0 * half.z));
                let triangles: Vec<_> = field.triangles().collect();
                let triangle = triangles[self.below(triangles.len() as u32) as usize];
                (SharedShape::new(field), self.on_triangle([triangle.a, triangle.b, triangle.c]))
            }
            Wall::Segment | Wall::Polyline => {
                let [a, b, c] = self.corners();
                let shape = if kind == Wall::Segment {
                    SharedShape::segment(a, b)
                } else {
                    SharedShape::polyline(vec![a, b, c], None)
                };
                (shape, self.on_line(a, b))
            }
            Wall::HalfSpace => {
                let out = if self.below(2) == 0 { Vector::Y } else { self.direction() };
                let along = out.any_orthonormal_vector();
                (SharedShape::new(HalfSpace::new(out)), Spot { at: along * radius, out, along })
            }
            Wall::Ball => {
                let out = if self.below(2) == 0 { Vector::X } else { self.direction() };
                let along = out.any_orthonormal_vector();
                (SharedShape::ball(radius), Spot { at: out * radius, out, along })
            }
            Wall::Cuboid => (SharedShape::cuboid(half.x, half.y, half.z), self.on_box(half)),
            Wall::Capsule => (
                SharedShape::capsule_y(long, radius),
                self.on_round([radius; 2], long, [Cap::Round; 2]),
            ),
            Wall::Cylinder => (
                SharedShape::cylinder(long, radius),
                self.on_round([radius; 2], long, [Cap::Flat; 2]),
            ),
            Wall::Cone => (
                SharedShape::cone(long, radius),
                self.on_round([radius, 0.0], long, [Cap::Flat; 2]),
            ),
            Wall::ConvexPolyhedron => {
                let corner = |k: u32| {
                    half * Vector::from([0, 1, 2].map(|i| if k >> i & 1 == 0 { -1.0 } else { 1.0 }))
                };
                let corners: Vec<_> = (0..8).map(corner).collect();
                (SharedShape::convex_hull(&corners).expect("a box"), self.on_box(half))
            }
            Wall::Link | Wall::Chain => {
                let cap = |round| if round { Cap::Round } else { Cap::Flat };
                let caps = [cap(self.below(2) == 0), cap(self.below(2) == 0)];
                let link = ModifiedCylinder::new(-long * Vector::Y, long * Vector::Y, radius, caps)
                    .expect("a link of size one");
                let spot = self.on_round([radius; 2], long, caps);
                let chain = self.chain_of(&link).filter(|_| kind == Wall::Chain);
                (chain.map_or_else(|| SharedShape::new(link), SharedShape::new), spot)
            }
            Wall::Compound => {
                let part = |place: Vector, shape| (Pose::from_translation(place), shape);
                let cuboid = SharedShape::cuboid(half.x, half.y, half.z);
                let parts = vec![
                    part(Vector::ZERO, cuboid.clone()),
                    part(2.0 * half.x * Vector::X, cuboid),
                    part(-8.0 * Vector::Y, SharedShape::ball(radius)),
                ];
                (SharedShape::compound(parts), self.on_box(half))
            }
        }
    }

    /// Returns the triangles in random order, each from a random vertex and of random orientation,
    /// with and without a mesh's normal constraints.
    fn mesh(&mut self, vertices: Vec<Vector>, triangles: &[[u32; 3]]) -> SharedShape {
        let constrained = self.below(2) == 0;
        // Normal constraints require one orientation.
        let mut shuffled: Vec<_> = triangles
            .iter()
            .map(|&[a, b, c]| {
                let turned = [[a, b, c], [b, c, a], [c, a, b]][self.below(3) as usize];
                if constrained || self.below(2) == 0 {
                    turned
                } else {
                    [turned[1], turned[0], turned[2]]
                }
            })
            .collect();
        let first = self.below(shuffled.len() as u32) as usize;
        shuffled.rotate_left(first);
        let flags =
            if constrained { TriMeshFlags::FIX_INTERNAL_EDGES } else { TriMeshFlags::empty() };
        SharedShape::new(
            TriMesh::with_flags(vertices, shuffled, flags).expect("a mesh of size one"),
        )
    }

    /// Returns the vertices of a triangle, in a coordinate plane or anywhere.
    fn corners(&mut self) -> [Vector; 3] {
        if self.below(3) == 0 {
            return [0; 3].map(|_| self.point() * 2.0);
        }
        let [a, b, c] = [self.size(), self.size(), self.size()];
        let flat = [[-a, 0.0], [b, 0.0], [0.25 * (b - a), c]]
            .map(|[x, y]| Vector::new(2.0 * x, 2.0 * y, 0.0));
        let turn = self.below(3);
        flat.map(|v| match turn {
            0 => v,
            1 => Vector::new(v.z, v.x, v.y),
            _ => Vector::new(v.y, v.z, v.x),
        })
    }

    /// Returns the three in one of six orders.
    pub fn shuffled<T: Copy>(&mut self, [a, b, c]: [T; 3]) -> [T; 3] {
        [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]][self.below(6) as usize]
    }

    fn on_triangle(&mut self, corners: [Vector; 3]) -> Spot {
        let [a, b, c] = self.shuffled(corners);
        let face = (b - a).cross(c - a).normalize();
        let face = if self.below(2) == 0 { face } else { -face };
        let along = (b - a).normalize();
        // In the triangle's plane, pointing away from it: the triangle is seen edge-on.
        let within = along.cross(face);
        let beyond = if within.dot(c - a) > 0.0 { -within } else { within };
        let on_edge = a.lerp(b, [0.5, 0.25, 0.0][self.below(3) as usize]);
        match self.below(6) {
            0 => Spot { at: (a + b + c) / 3.0, out: face, along },
            1 => Spot { at: on_edge, out: face, along },
            2 => Spot { at: on_edge, out: (face + beyond) * 0.5_f64.sqrt(), along },
            3 => Spot { at: a, out: -along, along: beyond },
            _ => Spot { at: on_edge, out: beyond, along },
        }
    }

    fn on_line(&mut self, a: Vector, b: Vector) -> Spot {
        let along = (b - a).normalize();
        let across = along.any_orthonormal_vector();
        match self.below(3) {
            0 => Spot { at: a, out: -along, along: across },
            1 => Spot { at: a, out: across, along },
            _ => Spot { at: a.lerp(b, 0.5), out: across, along },
        }
    }

    /// Returns a spot on a face, an edge or a vertex of a box.
    fn on_box(&mut self, half: Vector) -> Spot {
        let [i, j, k] = self.shuffled([0, 1, 2]);
        let (x, y, z) = (Vector::AXES[i], Vector::AXES[j], Vector::AXES[k]);
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        let out = x * sign;
        let on_face = out * half;
        match self.below(5) {
            0 => Spot { at: on_face, out, along: y },
            1 => Spot { at: on_face + z * half * 0.5, out, along: y },
            2 => Spot { at: on_face + z * half, out, along: y },
            3 => Spot { at: on_face + z * half, out: (out + z) * 0.5_f64.sqrt(), along: y },
            _ => Spot { at: on_face + y * half + z * half, out, along: y },
        }
    }

    /// Returns a spot on a surface of revolution about the y axis, from `-half` to `half`: a
    /// barrel, cap, rim or cone's tip.
    fn on_round(&mut self, radii: [f64; 2], half: f64, caps: [Cap; 2]) -> Spot {
        let side = if self.below(2) == 0 { Vector::X } else { Vector::new(0.6, 0.0, 0.8) };
        let end = self.below(2) as usize;
        let out = if end == 0 { -Vector::Y } else { Vector::Y };
        let (centre, radius) = (out * half, radii[end]);
        let slope = Vector::new(0.0, radii[0] - radii[1], 0.0) + side * (2.0 * half);
        let (lateral, middle) = (slope.normalize(), 0.5 * (radii[0] + radii[1]));
        let down = lateral.cross(side.cross(Vector::Y)).normalize();
        match self.below(4) {
            0 => Spot { at: side * middle, out: lateral, along: down },
            1 => Spot { at: centre + side * radius, out: side, along: Vector::Y },
            2 if caps[end] == Cap::Flat => Spot { at: centre + side * radius, out, along: side },
            _ if caps[end] == Cap::Flat => Spot { at: centre, out, along: side },
            _ => Spot { at: centre + out * radius, out, along: side },
        }
    }
}
