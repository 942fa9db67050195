//! A chain as a tube: each link is a section without curvature.

use super::Tube;
use super::centreline::{Curve, Samples};
use super::section::{CapPersistence, EndFace, Section};
use crate::robot::{Cap, Chain, direction, from_link_radii, has_direction, length};
use parry3d_f64::math::{Real, Vector};

/// Makes each link a section with the link's caps. Queries err by rounding alone, so every
/// tolerance is met.
impl From<&Chain> for Tube {
    fn from(chain: &Chain) -> Self {
        let mut tube = Self::empty();
        tube.set_chain(chain);
        tube
    }
}

impl Tube {
    /// Replaces this tube by `Tube::from(chain)`, in the same memory.
    ///
    /// ```
    /// use parry_continuum::{Chain, Tube, parry::math::Vector};
    ///
    /// let mut tube = Tube::from(&Chain::capsules(&[Vector::ZERO, Vector::Z], &[0.5])?);
    /// tube.set_chain(&Chain::capsules(&[Vector::ZERO, 2.0 * Vector::Z], &[0.5])?);
    /// assert_eq!(tube.length(), 2.0);
    /// # Ok::<(), parry_continuum::RobotError>(())
    /// ```
    pub fn set_chain(&mut self, chain: &Chain) {
        let links = chain.links().iter().enumerate().map(|(number, link)| StraightSection {
            ends: [link.start(), link.end()],
            radius: link.radius(),
            caps: link.caps(),
            segment: chain.segment_of(number) as u32,
        });
        let persistence =
            if chain.is_uniform() { CapPersistence::Always } else { CapPersistence::WhileAllNear };
        self.set_straight(links, persistence);
    }

    /// Replaces this tube by the links between `points`, as capsules or with caps by Algorithm 1.
    ///
    /// A link without length stays a section, as a ball. `segments` are the links' input segments.
    pub(crate) fn set_links(
        &mut self,
        points: impl Iterator<Item = Vector>,
        radii: &[Real],
        segments: &[u32],
        by_algorithm_1: bool,
    ) {
        let (mut ends, mut caps) = (std::mem::take(&mut self.ends), std::mem::take(&mut self.caps));
        ends.clear();
        ends.extend(points);
        if by_algorithm_1 {
            from_link_radii(&ends, radii, &mut caps);
        } else {
            caps.clear();
            caps.resize(radii.len(), [Cap::Round; 2]);
        }
        let links = ends.windows(2).zip(radii).zip(&caps).zip(segments).map(
            |(((ends, &radius), &caps), &segment)| {
                let ends = [ends[0], ends[1]];
                let caps =
                    if has_direction(ends[0], ends[1], radius) { caps } else { [Cap::Round; 2] };
                StraightSection { ends, radius, caps, segment }
            },
        );
        self.set_straight(links, CapPersistence::WhileNear);
        (self.ends, self.caps) = (ends, caps);
    }

    /// Replaces this tube by links that represent every tube whose centreline is within `deviation`
    /// of theirs, point by point, with discs in any direction.
    ///
    /// Its flat ends are the two ends of the robot and the ends of each run of links with one
    /// radius, in any direction. A step in radius counts as two flat ends. That is conservative:
    /// their centres are in the tube, and a ball around each contains its disc.
    pub(crate) fn set_loose_links(
        &mut self,
        links: impl Iterator<Item = ([Vector; 2], Real, u32)>,
        deviation: Real,
    ) {
        let links = links.map(|(ends, radius, segment)| StraightSection {
            ends,
            radius,
            caps: [Cap::Round; 2],
            segment,
        });
        self.set_straight(links, CapPersistence::Never);
        self.error = deviation;
        let count = self.sections.len();
        for number in 0..count {
            let Section { radius, first, last, .. } = self.sections[number];
            let ticks = [first, last];
            let is_other =
                |other: Option<&Section>| other.is_none_or(|other| other.radius != radius);
            let is_end = [
                is_other(number.checked_sub(1).and_then(|before| self.sections.get(before))),
                is_other(self.sections.get(number + 1)),
            ];
            for end in [0, 1] {
                let centre = self.point(&self.sections[number], ticks[end]);
                let face = EndFace {
                    centre,
                    outward: Vector::ZERO,
                    tilt: Real::INFINITY,
                    persistence: CapPersistence::Never,
                };
                self.sections[number].faces[end] = is_end[end].then_some(face);
            }
        }
    }

    /// Returns whether its points are known without directions ([`Tube::set_loose_links`]).
    pub(crate) fn is_loose(&self) -> bool {
        let first = self.sections.first().and_then(|section| section.faces[0]);
        first.is_some_and(|face| {
            face.tilt == Real::INFINITY && face.persistence == CapPersistence::Never
        })
    }

    /// Replaces this tube by sections without curvature, in the same memory.
    ///
    /// A section without length and with round caps is a ball. `persistence` applies to flat ends
    /// that are not flat by the radii alone.
    fn set_straight(
        &mut self,
        sections: impl Iterator<Item = StraightSection>,
        persistence: CapPersistence,
    ) {
        let Samples { mut points, mut arcs, mut segments, mut bounds } =
            std::mem::take(&mut self.curve).into_samples();
        bounds.clear();
        points.clear();
        segments.clear();
        arcs.clear();
        self.sections.clear();
        let mut start = 0.0;
        for StraightSection { ends, radius, caps, segment } in sections {
            let along = ends[1] - ends[0];
            let (axis, end) = (direction(along), start + length(along));
            let face = |end: usize| {
                let outward = if end == 0 { -axis } else { axis };
                (caps[end] == Cap::Flat).then_some(EndFace {
                    centre: ends[end],
                    outward,
                    tilt: 0.0,
                    persistence,
                })
            };
            self.sections.push(Section {
                last: points.len() as u32 + 1,
                end,
                faces: [face(0), face(1)],
                ..Section::beginning(points.len(), start, radius)
            });
            points.extend(ends);
            arcs.extend([start, end]);
            segments.extend([segment; 2]);
            start = end;
        }
        (self.error, self.merged, self.turn) = (0.0, 0.0, None);
        (self.residual, self.deviation) = (0.0, 0.0);
        // Lengths along the tube are rounded too.
        self.reach =
            points.iter().fold(start, |reach: Real, point| point.abs().max_element().max(reach));
        self.curve = Curve::Samples(Samples { points, arcs, segments, bounds });
        self.mark_persistent_faces();
    }
}

/// A section without curvature.
struct StraightSection {
    ends: [Vector; 2],
    radius: Real,
    caps: [Cap; 2],
    /// The input segment of the link.
    segment: u32,
}
