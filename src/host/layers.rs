//! A link without its outermost layer, which what touches the link does not touch.
//!
//! Without the layer of depth `t` the link is a link again, shorter by `t` at each flat end and
//! thinner by `t`. For all that it meets but a rim aslant, the nearest point of what is left has
//! the very normal of the link's own surface, and at a rim one that is off by about `t`.

use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::Real;

/// The layers that are taken off, as shares of the largest that there is.
const LAYERS: [Real; 5] = [1e-5, 1e-3, 0.03, 0.3, 1.0];

/// The depth of the largest layer.
pub(super) fn thickest_layer(link: &ModifiedCylinder) -> Real {
    let is_flat = link.caps().contains(&Cap::Flat);
    if is_flat { link.radius().min(0.5 * link.length()) } else { link.radius() }
}

/// The link without a layer, and how thick that is, from thin ones to the thickest.
pub(super) fn shrunk_links(
    link: &ModifiedCylinder,
) -> impl Iterator<Item = (ModifiedCylinder, Real)> + use<> {
    let (link, most) = (*link, thickest_layer(link));
    LAYERS.into_iter().map(move |share| {
        let depth = share * most;
        let [back, front] = link.caps().map(|cap| if cap == Cap::Flat { depth } else { 0.0 });
        let (start, end) = (link.start() + link.axis() * back, link.end() - link.axis() * front);
        // What is no link any more is its axis' middle.
        let core = ModifiedCylinder::new(start, end, (link.radius() - depth).max(0.0), link.caps());
        let middle = 0.5 * start + 0.5 * end;
        let core = core.or_else(|_| ModifiedCylinder::capsule(middle, middle, 0.0));
        (core.unwrap_or(link), depth)
    })
}
