//! The oriented box around the triangles of leaves.
//!
//! # Algorithm
//! 1. The first axis is the mean normal of the triangles, weighted by area.
//! 2. The second axis is the best of four directions across it, a quarter of a right angle apart:
//!    the least area of the box across the normal.
//! 3. The third axis is the cross product. The half extents are rounded up.

use super::bound::NodeBound;
use super::node::Leaf;
use crate::distance::lanes::{Lane, Pack};
use crate::distance::{Scalar, Vec3};
use crate::mesh::{BLOCK, load_vertices, splat};

/// The directions across the normal that are tried: the cosine and sine of the angle from the first
/// one, in quarters of a right angle.
const TURNS: [[f64; 2]; 4] = [
    [1.0, 0.0],
    [0.923_879_532_511_286_7, 0.382_683_432_365_089_8],
    [std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2],
    [0.382_683_432_365_089_8, 0.923_879_532_511_286_7],
];

impl<E: Lane> NodeBound<E> {
    /// The box around the triangles of at least one leaf (see the module).
    #[inline(always)]
    pub(crate) fn around<L: Pack<Element = E>>(token: L::Token, leaves: &[Leaf<E>]) -> Self {
        let (one, zero) = (E::default().one(), E::default());
        let normal = mean_normal::<L>(token, leaves).normalised();
        // Without area any normal serves.
        let normal = if one.lit(0.5).lt(normal.norm_squared()) {
            normal
        } else {
            Vec3::new(one, zero, zero)
        };
        let [first, second] = across(normal);
        let mut tangent = first;
        let mut sides = [[zero; 2]; 2];
        let mut least = None;
        for [cosine, sine] in TURNS {
            let turned = (first * one.lit(cosine) + second * one.lit(sine)).normalised();
            let along = extent::<L>(token, leaves, turned);
            let across = extent::<L>(token, leaves, normal.cross(turned));
            let area = (along[1] - along[0]) * (across[1] - across[0]);
            if least.is_none() || least > Some(area) {
                (tangent, sides, least) = (turned, [along, across], Some(area));
            }
        }
        let axes = [normal, tangent, normal.cross(tangent)];
        let sides = [extent::<L>(token, leaves, normal), sides[0], sides[1]];
        let mut centre = Vec3::zero(zero);
        for (axis, [low, high]) in axes.into_iter().zip(sides) {
            centre = centre + axis * ((low + high) * one.lit(0.5));
        }
        let mut half = [zero; 3];
        for (half, (axis, [low, high])) in half.iter_mut().zip(axes.into_iter().zip(sides)) {
            let at = centre.dot(axis);
            // The rounding of numbers near one: products of a corner and of the centre with the
            // axis, their difference, and the third axis, which is computed again.
            *half = (high - at).max(at - low) + one.lit(32.0 * E::UNIT_ROUNDOFF);
        }
        Self { centre, half: half.into(), normal, tangent }
    }
}

/// Two unit vectors across a unit normal. The first lies in the plane of the normal and of the
/// coordinate axis that is most nearly perpendicular to it.
fn across<E: Lane>(normal: Vec3<E>) -> [Vec3<E>; 2] {
    let (one, zero) = (normal.x.one(), normal.x.zero());
    let [x, y, z] = [normal.x.abs(), normal.y.abs(), normal.z.abs()];
    let axis = if x <= y && x <= z {
        Vec3::new(one, zero, zero)
    } else if y <= z {
        Vec3::new(zero, one, zero)
    } else {
        Vec3::new(zero, zero, one)
    };
    let second = normal.cross(axis).normalised();
    [second.cross(normal), second]
}

/// The sum of the triangles' normals, each with twice the area as its length.
#[inline(always)]
fn mean_normal<L: Pack>(token: L::Token, leaves: &[Leaf<L::Element>]) -> Vec3<L::Element>
where
    L::Element: Lane,
{
    let mut area = Vec3::zero(L::splat(token, L::Element::default()));
    for leaf in leaves {
        for lane in (0..BLOCK).step_by(L::LANES) {
            let [a, b, c] = load_vertices::<L>(token, &leaf.rows, lane);
            area = area + (b - a).cross(c - a);
        }
    }
    Vec3::new(fold(area.x, add), fold(area.y, add), fold(area.z, add))
}

/// The range of the triangles along an axis.
#[inline(always)]
fn extent<L: Pack>(
    token: L::Token,
    leaves: &[Leaf<L::Element>],
    axis: Vec3<L::Element>,
) -> [L::Element; 2]
where
    L::Element: Lane,
{
    let axis = splat::<L>(token, axis);
    let far = L::splat(token, L::Element::round(1.0e9 * L::Element::FARTHEST));
    let (mut low, mut high) = (far, -far);
    for leaf in leaves {
        for lane in (0..BLOCK).step_by(L::LANES) {
            for corner in load_vertices::<L>(token, &leaf.rows, lane) {
                let along = corner.dot(axis);
                (low, high) = (low.min(along), high.max(along));
            }
        }
    }
    [fold(low, L::Element::min), fold(high, L::Element::max)]
}

#[inline(always)]
fn add<E: Scalar>(a: E, b: E) -> E {
    a + b
}

/// Combines all lanes into one number.
#[inline(always)]
fn fold<L: Pack>(row: L, both: impl Fn(L::Element, L::Element) -> L::Element) -> L::Element
where
    L::Element: Lane,
{
    let mut lanes = [L::Element::default(); BLOCK];
    row.store(&mut lanes);
    let mut count = L::LANES;
    // By halves, which keeps the operations independent.
    while count > 1 {
        count /= 2;
        for lane in 0..count {
            lanes[lane] = both(lanes[lane], lanes[lane + count]);
        }
    }
    lanes[0]
}

#[cfg(test)]
mod tests {
    use super::super::bound::tests::{children, corners_below, wall};
    use super::super::build::WideBvh;
    use super::super::node::Child;
    use crate::mesh::Mesh;
    use fearless_simd::Level;
    use parry3d_f64::math::{Rotation, Vector};

    /// Where the cosine of the angle between normals rounds to one, the box must still hold them.
    #[test]
    fn every_bound_holds_its_triangles() {
        let (mut checked, mut slight) = (0, 0);
        for round in 0..60 {
            let bend = 10.0_f64.powf(-f64::from(round % 12) * 0.5);
            let turn = Rotation::from_scaled_axis(Vector::new(0.3, 1.7, -0.6) * f64::from(round));
            let (vertices, triangles) = wall(bend, turn);
            let tree = WideBvh::new(Level::new(), &Mesh::of(vertices, triangles));
            for (child, bound) in tree.nodes.iter().flat_map(children) {
                let [centre, half, normal, tangent] =
                    [bound.centre, bound.half, bound.normal, bound.tangent]
                        .map(|v| Vector::from(<[f32; 3]>::from(v).map(f64::from)));
                let third = normal.cross(tangent);
                let axes = [normal, tangent, third];
                for (axis, other) in [(normal, tangent), (tangent, third), (third, normal)] {
                    let (long, aslant) = ((axis.length() - 1.0).abs(), axis.dot(other).abs());
                    assert!(long < 6e-7 && aslant < 4e-7, "bend {bend}: {long} {aslant}");
                }
                let mut corners = Vec::new();
                corners_below(&tree, child, &mut corners);
                for corner in corners {
                    let offset = Vector::from(corner) - centre;
                    for (axis, reach) in axes.into_iter().zip(half.to_array()) {
                        let along = offset.dot(axis).abs();
                        assert!(along <= reach, "bend {bend}: {along} beyond {reach}");
                    }
                    checked += 1;
                }
                slight += usize::from(matches!(child, Child::Node(_)) && bound.half.x < 1e-3);
            }
        }
        assert!(
            checked > 100_000 && slight > 100,
            "{checked} corners, {slight} nearly flat bounds of nodes"
        );
    }
}
