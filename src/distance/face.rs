//! A triangle with a basis of its plane that stays accurate on slivers.
//!
//! # Definitions
//! The apex is the first vertex, `e1` and `e2` the edges from it. A point `p` relative to the apex
//! is `p = alpha e1 + beta e2 + r`, with `r` normal to the plane.
//!
//! # Rounding
//! On triangles whose height is 1e-12 of their length, the textbook formula `|<n, p>|` falls below
//! the true distance by millions of units in the last place. Three measures keep the result exact
//! within rounding:
//!
//! 1. **The apex lies opposite the longest edge.** So `e1` and `e2` are the shorter edges. The
//!    component of their cross product along the longest edge is removed. The remaining tilt turns
//!    the plane about the longest edge and moves the apex at most by rounding: the normal belongs
//!    to a triangle that cannot be distinguished from the given one.
//! 2. **The coordinates are refined.** `alpha` and `beta` come from the dual basis, then again from
//!    the residual. The distance is `|r|`, the distance to an actual point of the triangle.
//! 3. **Zero area.** The dual basis is zero, and the face is marked as having no interior. The
//!    edges decide.

use super::scalar::Scalar;
use super::vec3::Vec3;

/// A triangle with the basis of its plane.
#[derive(Clone, Copy)]
pub(crate) struct Face<T: Scalar> {
    /// The vertices; the first is opposite the longest edge.
    pub vertices: [Vec3<T>; 3],
    /// A normal whose length is twice the area.
    pub across: Vec3<T>,
    /// The basis dual to the edges from the first vertex, within the plane; zero if the area is
    /// zero.
    pub dual: [Vec3<T>; 2],
}

/// The projection of a point onto the plane of a [`Face`].
#[derive(Clone, Copy)]
pub(crate) struct Projection<T: Scalar> {
    /// The vector from the foot to the point, normal to the plane.
    pub residual: Vec3<T>,
    /// Whether the foot lies in the triangle.
    pub inside: T::Mask,
    /// The coordinate of the foot along the first edge from the first vertex.
    pub alpha: T,
    /// The coordinate along the second edge.
    pub beta: T,
}

impl<T: Scalar> Face<T> {
    #[inline(always)]
    pub(crate) fn new([a, b, c]: [Vec3<T>; 3]) -> Self {
        let [ab_longest, bc_longest] = Self::longest([a, b, c]);
        Self::in_order([
            Vec3::select(ab_longest, c, Vec3::select(bc_longest, a, b)),
            Vec3::select(ab_longest, a, Vec3::select(bc_longest, b, c)),
            Vec3::select(ab_longest, b, Vec3::select(bc_longest, c, a)),
        ])
    }

    /// Same as [`Face::new`], for vertices in the order of [`Face::vertices`].
    #[inline(always)]
    pub(crate) fn in_order(vertices: [Vec3<T>; 3]) -> Self {
        let ([e1, e2], across) = (edges(&vertices), across(&vertices));
        let inverse = across.x.one().over(across.norm_squared());
        Self { vertices, across, dual: [e2.cross(across) * inverse, across.cross(e1) * inverse] }
    }

    /// Returns whether the edge from the first vertex to the second is the longest; and whether the
    /// second edge is, if the first is not.
    #[inline(always)]
    fn longest([a, b, c]: [Vec3<T>; 3]) -> [T::Mask; 2] {
        let (ab, bc, ca) = ((b - a).norm_squared(), (c - b).norm_squared(), (a - c).norm_squared());
        [bc.le(ab) & ca.le(ab), ca.le(bc)]
    }

    /// Returns the index of the vertex that comes first in [`Face::vertices`]. The others follow in
    /// their order.
    #[inline(always)]
    pub(crate) fn first_of(corners: [Vec3<T>; 3]) -> usize
    where
        T: Scalar<Mask = bool>,
    {
        match Self::longest(corners) {
            [true, _] => 2,
            [false, true] => 0,
            [false, false] => 1,
        }
    }

    /// Rebuilds the face that [`Face::new`] returned, from its `vertices` and `dual`.
    #[cfg(feature = "exhaustive")]
    #[inline(always)]
    pub(crate) fn again(vertices: [Vec3<T>; 3], dual: [Vec3<T>; 2]) -> Self {
        Self { vertices, across: across(&vertices), dual }
    }

    /// Returns the unit normal; zero if the area is zero.
    #[inline(always)]
    pub(crate) fn normal(&self) -> Vec3<T> {
        let norm = self.across.norm();
        self.across * norm.one().over(norm)
    }

    /// Returns the height above the longest edge; zero if all vertices coincide.
    #[inline(always)]
    pub(crate) fn height(&self) -> T {
        let [_, from, to] = self.vertices;
        self.across.norm().over((to - from).norm())
    }

    /// Returns whether the area is positive.
    #[inline(always)]
    fn has_area(&self) -> T::Mask {
        let dual = self.dual[0];
        dual.x.zero().lt(dual.norm_squared())
    }

    /// Returns the same triangle relative to `origin`.
    ///
    /// Far from the triangle this rounds the vertices, but the basis of the plane is kept: a normal
    /// of the rounded vertices would contradict the basis, or be 0.
    #[inline(always)]
    pub(crate) fn seen_from(&self, origin: Vec3<T>) -> Self {
        let [a, b, c] = self.vertices;
        Self { vertices: [a - origin, b - origin, c - origin], ..*self }
    }

    /// Returns the refined projection of `point` onto the plane.
    #[inline(always)]
    pub(crate) fn project(&self, point: Vec3<T>) -> Projection<T> {
        let relative = point - self.vertices[0];
        let [e1, e2] = edges(&self.vertices);
        let mut residual = relative;
        let (mut alpha, mut beta) = (relative.x.zero(), relative.x.zero());
        for _ in 0..T::FACE_PASSES {
            alpha = alpha + residual.dot(self.dual[0]);
            beta = beta + residual.dot(self.dual[1]);
            residual = relative.along(e1, -alpha).along(e2, -beta);
        }
        Projection { residual, inside: self.holds(alpha, beta), alpha, beta }
    }

    /// Returns the point of the plane with these coordinates along the edges from the first vertex.
    #[inline(always)]
    pub(crate) fn at(&self, alpha: T, beta: T) -> Vec3<T> {
        let [e1, e2] = edges(&self.vertices);
        self.vertices[0].along(e1, alpha).along(e2, beta)
    }

    /// Returns whether a point of the plane lies in the triangle.
    ///
    /// One pass is enough: its error is within rounding of the lines of the edges. At the sharp
    /// vertex of a sliver two lines stay within rounding of each other far beyond the vertex. Such
    /// vertices are ends of the longest edge. So the point must not lie beyond either end by more
    /// than about `rounding`, along that edge.
    #[inline(always)]
    pub(crate) fn holds_point(&self, point: Vec3<T>, rounding: T) -> T::Mask {
        let [apex, from, to] = self.vertices;
        let (relative, longest) = (point - apex, to - from);
        let (place, slack) = ((point - from).dot(longest), rounding * longest.largest());
        self.holds(relative.dot(self.dual[0]), relative.dot(self.dual[1]))
            & (-slack).le(place)
            & place.le(longest.norm_squared() + slack)
    }

    /// Returns whether these coordinates belong to a point of the triangle.
    #[inline(always)]
    fn holds(&self, alpha: T, beta: T) -> T::Mask {
        let zero = alpha.zero();
        self.has_area() & zero.le(alpha) & zero.le(beta) & (alpha + beta).le(alpha.one())
    }
}

/// Returns the edges from the first vertex.
#[inline(always)]
fn edges<T: Scalar>([apex, b, c]: &[Vec3<T>; 3]) -> [Vec3<T>; 2] {
    [*b - *apex, *c - *apex]
}

/// Returns a normal whose length is twice the area, without a component along the longest edge.
#[inline(always)]
fn across<T: Scalar>(vertices: &[Vec3<T>; 3]) -> Vec3<T> {
    let ([e1, e2], longest) = (edges(vertices), vertices[2] - vertices[1]);
    let across = e1.cross(e2);
    across.along(longest, -across.dot(longest).over(longest.norm_squared()))
}
