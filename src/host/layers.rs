//! A link without its outermost layer. A shape that touches the link does not touch this core.
//!
//! Without the layer of depth `t` the link is again a link: shorter by `t` at each flat end and
//! thinner by `t`. For a shape that meets the surface, the nearest point of the core has exactly
//! the normal of the link's surface there. At a rim that is met obliquely, the normal is off by
//! about `t`.

use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::Real;

/// The depths of the layers, as shares of the largest possible depth.
const LAYERS: [Real; 5] = [1e-5, 1e-3, 0.03, 0.3, 1.0];

/// Returns the depth of the thickest layer.
pub(super) fn thickest_layer(link: &ModifiedCylinder) -> Real {
    let is_flat = link.caps().contains(&Cap::Flat);
    if is_flat { link.radius().min(0.5 * link.length()) } else { link.radius() }
}

/// Yields the link without a layer and the layer's depth, from the thinnest to the thickest.
pub(super) fn shrunk_links(
    link: &ModifiedCylinder,
) -> impl Iterator<Item = (ModifiedCylinder, Real)> + use<> {
    let (link, most) = (*link, thickest_layer(link));
    LAYERS.into_iter().map(move |share| {
        let depth = share * most;
        let [back, front] = link.caps().map(|cap| if cap == Cap::Flat { depth } else { 0.0 });
        let (start, end) = (link.start() + link.axis() * back, link.end() - link.axis() * front);
        // A core that is not a valid link becomes the middle of its axis.
        let core = ModifiedCylinder::new(start, end, (link.radius() - depth).max(0.0), link.caps());
        let middle = 0.5 * start + 0.5 * end;
        let core = core.or_else(|_| ModifiedCylinder::capsule(middle, middle, 0.0));
        (core.unwrap_or(link), depth)
    })
}
