//! Which way the links of a chain may be touched.
//!
//! At a joint the caps of two links lie inside each other. What a wall touches there is the neighbour, so a
//! cap that its neighbour covers makes no contacts of its own: a contact's normal may not point into the
//! neighbour. With `outward` along the link's axis beyond the end, and `onward` along the neighbour's away from
//! the joint:
//!
//! 1. **A narrower neighbour** leaves part of the cap bare: every normal is fine.
//! 2. **A round cap** shows in the gap that a bend opens: not where a normal points both outward and onward.
//! 3. **A flat cap** does not show: not where a normal points outward.
//!
//! Such a normal is turned to the nearest one that is fine. Sideways contacts keep their normals to the last
//! digit but that; of the others, no point of the link is left that has the wall along the new normal.

use super::axial::unit_across;
use crate::{Cap, ModifiedCylinder};
use parry3d_f64::math::Vector;
use parry3d_f64::query::details::NormalConstraints;

/// What the neighbours of a link forbid at its start and end.
#[derive(Clone, Copy, Debug)]
pub struct Joints([Option<Joint>; 2]);

#[derive(Clone, Copy, Debug)]
struct Joint {
    outward: Vector,
    onward: Vector,
    is_round: bool,
}

impl Joints {
    /// The joints of link `index`.
    pub(super) fn of(links: &[ModifiedCylinder], index: usize) -> Option<Self> {
        let link = links.get(index)?;
        let before = index.checked_sub(1).and_then(|index| links.get(index));
        let joint = |neighbour: Option<&ModifiedCylinder>, sign, end: usize| {
            let neighbour = neighbour.filter(|neighbour| neighbour.radius() >= link.radius())?;
            let is_round = link.caps()[end] == Cap::Round;
            Some(Joint { outward: link.axis() * sign, onward: neighbour.axis() * sign, is_round })
        };
        Some(Self([joint(before, -1.0, 0), joint(links.get(index + 1), 1.0, 1)]))
    }
}

impl NormalConstraints for Joints {
    fn project_local_normal_mut(&self, normal: &mut Vector) -> bool {
        for joint in self.0.into_iter().flatten() {
            let (outward, onward) = (normal.dot(joint.outward), normal.dot(joint.onward));
            if outward <= 0.0 || (joint.is_round && onward <= 0.0) {
                continue;
            }
            let across = if joint.is_round && onward < outward { joint.onward } else { joint.outward };
            match unit_across(*normal, across) {
                Some(turned) => *normal = turned,
                None => return false,
            }
        }
        true
    }
}
