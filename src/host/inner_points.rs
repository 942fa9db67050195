//! Removes the contact points of a chain that lie inside its joints.
//!
//! At a joint the ends of two links overlap. A wall touches the neighbour there, and the normal of
//! a cap inside the neighbour would catch on a wall along which the chain slides. So such a point
//! is removed, but *only while the neighbour makes a contact at least as deep*.
//!
//! # Algorithm
//! For all links that touch the same part of the wall, visit the points from the deepest. A point
//! is removed if
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
//! # Equal depths
//! At a joint both links often touch equally deep, and rounding decides the order. Points at most
//! `rounding` less deep than the deepest remaining one count as equally deep; the lowest link goes
//! first. So the same points stay while the placement changes by rounding.

use super::feature::SAME_POINT;
use crate::robot::ModifiedCylinder;
use parry3d_f64::math::{Real, Vector};
use parry3d_f64::query::{ContactManifold, PointQuery};

/// The cosine between normal and axis above which a point leans out over an end. A normal that
/// leans less cannot catch. It exceeds the vibration of a chain at rest, so the points do not
/// change with each change of sign. (Measured: with 1e-9 a straight chain in a corner changes its
/// points in 62 of 200 steps.)
const LEANS: Real = 1e-4;

/// Which of the two shapes of a pair is the chain.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum WhichShape {
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
pub(super) fn remove_inner_points<M, C>(
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
