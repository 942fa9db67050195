//! A chain is a tube whose pieces are straight: each link is a section without curvature.

use super::Tube;
use super::curve::Curve;
use super::section::{Face, Section};
use crate::{Cap, Chain};

/// Each link is a section of its own, with the link's caps. Queries have no error but rounding, so any tolerance will do.
impl From<&Chain> for Tube {
    fn from(chain: &Chain) -> Self {
        let mut tube = Self::empty();
        let (mut points, mut arcs, mut start) = (Vec::new(), Vec::new(), 0.0);
        for link in chain.links() {
            let (ends, axis, end) = ([link.start(), link.end()], link.axis(), start + link.length());
            let face = |end: usize| {
                let outward = if end == 0 { -axis } else { axis };
                (link.caps()[end] == Cap::Flat).then_some(Face { centre: ends[end], outward, tilt: 0.0 })
            };
            tube.sections.push(Section {
                first: points.len() as u32,
                last: points.len() as u32 + 1,
                start,
                end,
                radius: link.radius(),
                curvature: 0.0,
                stretch: 1.0,
                deviation: 0.0,
                faces: [face(0), face(1)],
            });
            points.extend(ends);
            arcs.extend([start, end]);
            start = end;
        }
        tube.reach = points.iter().fold(0.0, |reach, point| point.abs().max_element().max(reach));
        tube.curve = Curve::Samples { points, arcs };
        tube
    }
}
