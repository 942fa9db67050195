//! What is computed once per triangle: a basis of its plane that stays accurate on slivers.
//!
//! A point p relative to the apex is p = alpha e1 + beta e2 + r with r normal to the plane. Two measures
//! keep this exact to rounding on triangles whose height is 1e-12 of their length, where the textbook
//! formula |<n, p>| falls below the true distance by millions of units:
//!
//! 1. **The apex lies opposite the longest edge**, so e1 and e2 are the two shorter edges, and their cross
//!    product is freed of its component along the longest edge. What tilt is left turns the plane about
//!    the longest edge and moves the apex by no more than rounding, so the normal is that of a triangle
//!    which cannot be told from the given one.
//! 2. **The coordinates are refined**: alpha and beta come from the dual basis, then again from what they
//!    leave over. The distance is |r|, the distance to an actual point of the triangle.
//! 3. **Zero area**: the dual basis is zero and the face is marked as having no interior. The edges serve.

use super::scalar::Scalar;
use super::vec3::Vec3;

/// Refinements of (alpha, beta). Each wins the digits that the dual basis has; three serve a height of 1e-12.
const PASSES: usize = 3;

/// A triangle with the basis of its plane.
#[derive(Clone, Copy)]
pub(crate) struct Face<T: Scalar> {
    /// The vertices in the caller's order.
    pub vertices: [Vec3<T>; 3],
    /// The vertex opposite the longest edge.
    apex: Vec3<T>,
    /// The two edges from the apex.
    edges: [Vec3<T>; 2],
    /// The basis dual to `edges` within the plane.
    dual: [Vec3<T>; 2],
    /// The unit normal, zero for a triangle without area.
    pub normal: Vec3<T>,
    /// Whether the triangle has an area.
    pub has_area: T::Mask,
}

/// A point seen from the plane of a [`Face`].
#[derive(Clone, Copy)]
pub(crate) struct Projection<T: Scalar> {
    /// The foot on the plane.
    pub foot: Vec3<T>,
    /// From the foot to the point, normal to the plane.
    pub residual: Vec3<T>,
    /// Whether the foot lies in the triangle.
    pub inside: T::Mask,
}

impl<T: Scalar> Face<T> {
    #[inline(always)]
    pub(crate) fn new(vertices: [Vec3<T>; 3]) -> Self {
        let [a, b, c] = vertices;
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let (lab, lbc, lca) = (ab.norm_squared(), bc.norm_squared(), ca.norm_squared());
        let ab_longest = lbc.le(lab) & lca.le(lab);
        let bc_longest = lca.le(lbc);
        let pick = |at_c, at_a, at_b| Vec3::select(ab_longest, at_c, Vec3::select(bc_longest, at_a, at_b));
        let apex = pick(c, a, b);
        let (e1, e2) = (pick(ca, ab, bc), pick(-bc, -ca, -ab));
        let longest = pick(ab, bc, ca);

        let one = lab.one();
        let across = e1.cross(e2);
        let along = across.dot(longest).over(longest.norm_squared());
        let normal = across.along(longest, -along);
        let squared = normal.norm_squared();
        let inverse = one.over(squared);
        Self {
            vertices,
            apex,
            edges: [e1, e2],
            dual: [e2.cross(normal) * inverse, normal.cross(e1) * inverse],
            normal: normal * one.over(squared.sqrt()),
            has_area: lab.zero().lt(squared),
        }
    }

    /// The same triangle in coordinates from `origin`.
    #[inline(always)]
    pub(crate) fn seen_from(&self, origin: Vec3<T>) -> Self {
        Self { vertices: self.vertices.map(|vertex| vertex - origin), apex: self.apex - origin, ..*self }
    }

    /// The foot of `point` on the plane and what is left, refined.
    #[inline(always)]
    pub(crate) fn project(&self, point: Vec3<T>) -> Projection<T> {
        let relative = point - self.apex;
        let mut residual = relative;
        let (mut alpha, mut beta) = (relative.x.zero(), relative.x.zero());
        for _ in 0..PASSES {
            alpha = alpha + residual.dot(self.dual[0]);
            beta = beta + residual.dot(self.dual[1]);
            residual = relative.along(self.edges[0], -alpha).along(self.edges[1], -beta);
        }
        let foot = self.apex.along(self.edges[0], alpha).along(self.edges[1], beta);
        Projection { foot, residual, inside: self.holds(alpha, beta) }
    }

    /// Whether a point of the plane lies in the triangle. What one pass leaves out is within rounding of an edge.
    #[inline(always)]
    pub(crate) fn holds_point(&self, point: Vec3<T>) -> T::Mask {
        let relative = point - self.apex;
        self.holds(relative.dot(self.dual[0]), relative.dot(self.dual[1]))
    }

    /// Whether the coordinates along the edges from the apex are those of a point of the triangle.
    #[inline(always)]
    fn holds(&self, alpha: T, beta: T) -> T::Mask {
        let zero = alpha.zero();
        self.has_area & zero.le(alpha) & zero.le(beta) & (alpha + beta).le(alpha.one())
    }

    /// The height of the apex above the plane through `point` with this face's normal.
    #[inline(always)]
    pub(crate) fn height_from(&self, point: Vec3<T>) -> T {
        self.normal.dot(self.apex - point)
    }
}
