//! What the tests of `host` share: random links, and membership in a link by a formula of its own.
#![allow(dead_code)]

use continuum_testing::Random;
use continuum_testing::placements::Wall;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{SharedShape, Triangle};
use parry_continuum::{Cap, ModifiedCylinder};

/// Half the distance from 1 to the next f64.
pub const U: Real = Real::EPSILON / 2.0;

/// The four combinations of caps.
pub const CAPS: [[Cap; 2]; 4] =
    [[Cap::Flat; 2], [Cap::Round; 2], [Cap::Flat, Cap::Round], [Cap::Round, Cap::Flat]];

/// What these tests draw besides points and poses.
pub trait Draw {
    /// Uniform in the logarithm.
    fn log_between(&mut self, low: Real, high: Real) -> Real;
    fn index(&mut self, count: usize) -> usize;
    fn chance(&mut self, p: Real) -> bool;
    /// Uniform in a cube of this half width.
    fn vector(&mut self, reach: Real) -> Vector;
    fn caps(&mut self) -> [Cap; 2];
    /// A link of extent about 1, from thin to flat, some along a coordinate axis, some balls and
    /// wires.
    fn link(&mut self) -> ModifiedCylinder;
    /// A link at a wall, and the wall's pose: aligned with it and touching, or all but.
    fn aligned(&mut self, wall: Wall) -> (ModifiedCylinder, SharedShape, Pose);
    /// A link and a triangle, and the triangle's pose: aligned, or as often a link near or somewhat
    /// inside of any triangle.
    fn meeting(&mut self) -> (ModifiedCylinder, Triangle, Pose);
}

impl Draw for Random {
    fn log_between(&mut self, low: Real, high: Real) -> Real {
        self.between(low.ln(), high.ln()).exp()
    }

    fn index(&mut self, count: usize) -> usize {
        self.below(count as u32) as usize
    }

    fn chance(&mut self, p: Real) -> bool {
        self.unit() < p
    }

    fn vector(&mut self, reach: Real) -> Vector {
        self.point() * reach
    }

    fn caps(&mut self) -> [Cap; 2] {
        CAPS[self.index(4)]
    }

    fn link(&mut self) -> ModifiedCylinder {
        let start = self.vector(1.0);
        let axis = if self.chance(0.2) { Vector::AXES[self.index(3)] } else { self.direction() };
        let radius = if self.chance(0.05) { 0.0 } else { self.log_between(1e-3, 2.0) };
        if self.chance(0.05) {
            return ModifiedCylinder::capsule(start, start, radius).unwrap();
        }
        let end = start + axis * self.log_between(1e-3, 2.0);
        ModifiedCylinder::new(start, end, radius, self.caps()).unwrap()
    }

    fn aligned(&mut self, wall: Wall) -> (ModifiedCylinder, SharedShape, Pose) {
        let placement = self.placement(wall);
        (placement.link, placement.wall, placement.pose)
    }

    fn meeting(&mut self) -> (ModifiedCylinder, Triangle, Pose) {
        if self.chance(0.5) {
            let (link, wall, pose) = self.aligned(Wall::Triangle);
            (link, *wall.as_triangle().unwrap(), pose)
        } else {
            let triangle = Triangle::new(self.vector(1.5), self.vector(1.5), self.vector(1.5));
            (self.link(), triangle, Pose::new(self.vector(1.0), self.direction()))
        }
    }
}

/// How far `p` is outside `link` by the worst of its defining inequalities (negative inside): a
/// membership test, not the distance. Uses nothing of the crate but the link's data.
pub fn violation(link: &ModifiedCylinder, p: Vector) -> Real {
    let span = link.end() - link.start();
    let axis = span.normalize_or_zero();
    let length = span.length();
    let z = (p - link.start()).dot(axis);
    let nearest = link.start() + axis * z.max(0.0).min(length);
    let mut worst = (p - nearest).length() - link.radius();
    if link.caps()[0] == Cap::Flat {
        worst = worst.max(-z);
    }
    if link.caps()[1] == Cap::Flat {
        worst = worst.max(z - length);
    }
    worst
}

/// A point of the link's surface, every piece and rim being visited.
pub fn surface_point(random: &mut Random, link: &ModifiedCylinder) -> Vector {
    let axis = (link.end() - link.start()).normalize_or(Vector::X);
    let side = axis.cross(random.direction()).normalize_or(axis.any_orthonormal_vector());
    let (piece, r) = (random.index(4), link.radius());
    if piece == 0 {
        let t = if random.chance(0.1) { random.index(2) as Real } else { random.unit() };
        return link.start() * (1.0 - t) + link.end() * t + side * r;
    }
    let end = random.index(2);
    let (centre, outward) = if end == 0 { (link.start(), -axis) } else { (link.end(), axis) };
    match link.caps()[end] {
        Cap::Flat => centre + side * (r * if piece == 1 { 1.0 } else { random.unit().sqrt() }),
        Cap::Round => {
            let v = random.direction();
            centre + (if v.dot(outward) < 0.0 { -v } else { v }) * r
        }
    }
}

/// The largest coordinate difference of a problem made of a link and a point.
pub fn extent(link: &ModifiedCylinder, p: Vector) -> Real {
    let (a, b) = (p - link.start(), link.end() - link.start());
    a.abs().max_element().max(b.abs().max_element()).max(link.radius())
}

/// The largest coordinate involved.
pub fn largest(link: &ModifiedCylinder, p: Vector) -> Real {
    let ends = link.start().abs().max(link.end().abs()).max_element();
    ends.max(p.abs().max_element()) + link.radius()
}

/// The link with every length multiplied by `factor`.
pub fn scaled(link: &ModifiedCylinder, factor: Real) -> ModifiedCylinder {
    ModifiedCylinder::new(
        link.start() * factor,
        link.end() * factor,
        link.radius() * factor,
        link.caps(),
    )
    .unwrap()
}
