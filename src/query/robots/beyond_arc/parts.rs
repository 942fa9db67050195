//! A robot as a tree of parts, each with bounds on its cross-sections: the input of the search by
//! arc length.
//!
//! # Definitions
//! - c(s): the centreline by arc length, scaled by a power of two. t(s): its direction.
//! - **Part**: the places s in `[a, b]`. h = b - a, d = (c(b) - c(a)) / h.
//! - **Interpolation** of a part: `c(a) + (s - a) d`.
//! - `off`: an upper bound on |c(s) - interpolation|. `spread`: an upper bound on |t(s) - d|.
//! - k: an upper bound on the curvature of a part. l: an upper bound on its length.
//! - **Cap**: a round end of the robot, half a ball.
//!
//! # Bounds of a part
//! 1. **Link.** off = spread = 0.
//! 2. **Curve.** Linear interpolation in arc length errs by at most k l^2 / 8, and at most l / 2.
//!    Tangents of the part differ from their mean by at most k l / 2. The samples' arc lengths are
//!    those of their polyline: the curve is longer by at most the factor `stretch`, which moves
//!    places by at most (stretch - 1) l and changes d by at most stretch - 1. If the ends are known
//!    up to e, off grows by e and d changes by at most 2 e / h. A stated turn counts near flat
//!    faces, where it is stated. Of a fit all directions are unknown: spread excludes none.
//! 3. **Two neighbouring parts** i, with `off_i`, `spread_i` and `d_i`. Both interpolations and
//!    that of their union agree at the outer ends and differ at the middle by some vector m.
//!    Between they differ by a share of m. So off = max `off_i` + |m|, and spread = max(`spread_i`
//!    + |d_i - d|).

use crate::answer::ProximityError;
use crate::distance::Scalar;
use crate::refine::{Piece, PlacedTube};
use crate::robot::{Cap, Chain};
use parry3d_f64::math::{Real, Vector};

/// A spread that excludes no direction.
const ANY: Real = 2.0;

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub ends: [Vector; 2],
    pub arcs: [Real; 2],
    /// d.
    pub direction: Vector,
    pub radius: Real,
    pub off: Real,
    pub spread: Real,
    /// How far apart the bounds of a cross-section stay because its direction is uncertain.
    pub doubt: Real,
    /// The outward directions of caps. Only leaves have caps; the spread of all others includes
    /// them.
    pub caps: [Option<Vector>; 2],
    /// For a leaf, the piece of the tube, or the link with the ticks 0 and 1.
    pub piece: Piece,
    pub children: Option<[u32; 2]>,
}

impl Part {
    fn between(ends: [Vector; 2], arcs: [Real; 2], radius: Real) -> Self {
        let length = arcs[1] - arcs[0];
        let direction = if length > 0.0 { (ends[1] - ends[0]) / length } else { Vector::ZERO };
        Self {
            ends,
            arcs,
            direction,
            radius,
            off: 0.0,
            spread: if length > 0.0 { 0.0 } else { ANY },
            doubt: 0.0,
            caps: [None; 2],
            piece: Piece { section: 0, from: 0, to: 0 },
            children: None,
        }
    }

    /// Returns the union of two neighbouring parts (case 3).
    fn union(parts: [&Self; 2], children: [u32; 2]) -> Self {
        let [one, two] = parts;
        let mut union = Self::between(
            [one.ends[0], two.ends[1]],
            [one.arcs[0], two.arcs[1]],
            one.radius.max(two.radius),
        );
        for part in parts {
            let spread = if part.has_caps() { ANY } else { part.spread };
            union.spread = union.spread.max(spread + (part.direction - union.direction).length());
        }
        let between = union.ends[0] + union.direction * (one.arcs[1] - one.arcs[0]);
        let middles = [one.ends[1], two.ends[0]].map(|middle| (middle - between).length());
        union.off = one.off.max(two.off) + middles[0].max(middles[1]);
        union.doubt = one.doubt.max(two.doubt);
        union.children = Some(children);
        union
    }

    pub(super) fn has_caps(&self) -> bool {
        self.caps.iter().any(Option::is_some)
    }

    pub(super) fn length(&self) -> Real {
        self.arcs[1] - self.arcs[0]
    }

    /// Returns the interpolation at a share of the part.
    pub(super) fn place(&self, share: Real) -> Vector {
        self.ends[0] + (self.ends[1] - self.ends[0]) * share
    }

    pub(super) fn arc(&self, share: Real) -> Real {
        self.arcs[0] + self.length() * share
    }

    /// Returns the share of the part at an arc length; 0 if the part has no length.
    pub(super) fn share_of(&self, arc: Real) -> Real {
        let share = (arc - self.arcs[0]) / self.length();
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    pub(super) fn is_leaf(&self) -> bool {
        self.children.is_none()
    }

    /// Whether the part is one straight link whose discs are exactly known.
    pub(super) fn is_straight(&self) -> bool {
        self.is_leaf() && self.off == 0.0 && self.spread == 0.0
    }

    /// An estimate of what the bounds of a pair lose by this part.
    pub(super) fn loss(&self) -> Real {
        self.off + self.radius * self.spread.min(1.0)
    }

    /// Returns an upper bound on how far the discs of the part reach along the unit vector
    /// `towards` from their centres.
    ///
    /// **Proof.** A disc of direction t reaches r |towards x t| = r sqrt(1 - <towards, t>^2). Both
    /// products change by at most `spread` between t and d.
    pub(super) fn disc_reach(&self, towards: Vector) -> Real {
        let sine = towards.cross(self.direction).length() + self.spread;
        if sine >= 1.0 {
            return self.radius;
        }
        let cosine = (towards.dot(self.direction).abs() - self.spread).max(0.0);
        // Without a spread the sine alone is exact; the root loses digits near 0.
        let by_cosine =
            if self.spread > 0.0 { (1.0 - cosine * cosine).max(0.0).sqrt() } else { 1.0 };
        self.radius * sine.min(by_cosine)
    }

    /// Returns how far a cap reaches along the unit vector `towards`; `None` if there is no cap.
    pub(super) fn cap_reach(&self, end: usize, towards: Vector) -> Option<Real> {
        let outward = self.caps[end]?;
        let sine = if outward.dot(towards) >= 0.0 { 1.0 } else { outward.cross(towards).length() };
        Some(self.radius * sine)
    }

    /// Returns the radius vector that reaches farthest along the unit vector `towards`, of a
    /// cross-section at a share of the part.
    pub(super) fn radius_towards(&self, share: Real, towards: Vector) -> Vector {
        let is_towards = |cap: &Option<Vector>| cap.is_some_and(|out| out.dot(towards) >= 0.0);
        if share == 0.0 && is_towards(&self.caps[0]) || share == 1.0 && is_towards(&self.caps[1]) {
            towards * self.radius
        } else if self.spread < 1.0 {
            // Two cross products: the result is perpendicular to the axis even if it is rounding.
            let axis = self.direction.normalize_or_zero();
            axis.cross(towards.cross(axis).normalize_or_zero()) * self.radius
        } else {
            Vector::ZERO
        }
    }

    /// Returns an upper bound on the distance between a point of
    /// [`radius_towards`](Self::radius_towards) and the nearest point of the true cross-section.
    ///
    /// **Proof.** The centre is off by at most `off`. Let w be the unit radius vector,
    /// perpendicular to d, and t the true direction. |<w, t>| = |<w, t - d>| <= spread. The
    /// projection of w to the true disc, made a unit vector again, is within sqrt(2) spread of w.
    /// If the spread is 1 or more, the point is the centre.
    pub(super) fn error_of_radius(&self) -> Real {
        self.off + if self.spread < 1.0 { self.radius * 1.5 * self.spread } else { 0.0 }
    }
}

/// The parts of a robot, and what is common to all of them. A later query reuses the memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    parts: Vec<Part>,
    root: u32,
    /// The count of the first parts, one for each link or section.
    leaves: u32,
    /// Multiplies all lengths.
    pub scale: Real,
    /// An upper bound on the rounding errors of arc lengths.
    pub arc_slack: Real,
    /// An upper bound on the rounding errors of distances.
    pub slack: Real,
}

impl Parts {
    pub(super) fn root(&self) -> u32 {
        self.root
    }

    pub(super) fn leaves(&self) -> u32 {
        self.leaves
    }

    pub(super) fn part(&self, number: u32) -> &Part {
        &self.parts[number as usize]
    }

    /// Makes a part of each link.
    pub(super) fn set_chain(&mut self, chain: &Chain) {
        self.begin(chain.reach());
        let (links, scale) = (chain.links(), self.scale);
        for (number, link) in links.iter().enumerate() {
            let (length, axis) = link.length_and_axis();
            let start = chain.length_before(number) * scale;
            let mut part = Part {
                direction: axis,
                ..Part::between(
                    [link.start(), link.end()].map(|point| point * scale),
                    [start, start + length * scale],
                    link.radius() * scale,
                )
            };
            part.piece = Piece { section: number as u32, from: 0, to: 1 };
            let is_last = number + 1 == links.len();
            let is_cap = |end: usize, is_end| is_end && link.caps()[end] == Cap::Round;
            part.caps =
                [is_cap(0, number == 0).then_some(-axis), is_cap(1, is_last).then_some(axis)];
            self.parts.push(part);
        }
        self.finish();
    }

    /// Makes a part of each section of a tube.
    ///
    /// # Errors
    /// The curve is not finite.
    pub(super) fn set_tube(&mut self, placed: &PlacedTube) -> Result<(), ProximityError> {
        let tube = placed.tube;
        self.begin(tube.reach().max(tube.error()));
        let sections = tube.sections();
        for (number, section) in sections.iter().enumerate() {
            let piece = Piece { section: number as u32, from: section.first, to: section.last };
            let mut part = self.piece_of(placed, piece)?;
            let [base, tip] = section.faces.map(|face| face.is_none());
            let ends = [number == 0 && base, number + 1 == sections.len() && tip];
            part.caps = [ends[0].then_some(-part.direction), ends[1].then_some(part.direction)];
            self.parts.push(part);
        }
        self.finish();
        Ok(())
    }

    /// Returns the two halves of a part; `None` if it cannot be divided.
    ///
    /// # Errors
    /// The curve is not finite.
    pub(super) fn halves(
        &mut self,
        number: u32,
        tube: Option<&PlacedTube>,
    ) -> Result<Option<[u32; 2]>, ProximityError> {
        let part = *self.part(number);
        if part.children.is_some() {
            return Ok(part.children);
        }
        let Some(tube) = tube.filter(|_| !part.is_straight()) else { return Ok(None) };
        let Some(halves) = tube.halves(&part.piece, Real::INFINITY) else { return Ok(None) };
        let first = self.parts.len() as u32;
        for (end, piece) in halves.into_iter().enumerate() {
            let mut half = self.piece_of(tube, piece)?;
            half.caps[end] = part.caps[end];
            self.parts.push(half);
        }
        let children = Some([first, first + 1]);
        self.parts[number as usize].children = children;
        Ok(children)
    }

    fn piece_of(&self, placed: &PlacedTube, piece: Piece) -> Result<Part, ProximityError> {
        let (tube, section) = (placed.tube, placed.section(piece.section));
        let (points, arcs) = (
            [piece.from, piece.to].map(|tick| tube.point(section, tick) * self.scale),
            placed.arcs(&piece),
        );
        if !points.iter().all(|point| point.is_finite()) {
            return Err(ProximityError::CurveNotFinite { arc_length: arcs[0] });
        }
        let mut part =
            Part::between(points, arcs.map(|arc| arc * self.scale), section.radius * self.scale);
        part.piece = piece;
        // Case 2.
        let bound = tube.bound(section, [piece.from, piece.to]);
        let (longer, length) = (section.stretch - 1.0, part.length() * section.stretch);
        let bend = bound.curvature / self.scale * length;
        // The ends of a bent piece are computed from coordinates below 2.
        let rounding = if bend > 0.0 { 16.0 * Real::UNIT_ROUNDOFF } else { 0.0 };
        let known = bound.off * self.scale + rounding;
        part.off = (0.125 * bend * length).min(0.5 * length)
            + longer * length
            + known
            + tube.error() * self.scale;
        let mut faces = section.faces.iter().flatten();
        if tube.is_loose() || faces.any(|face| face.tilt == Real::INFINITY) {
            (part.spread, part.doubt) = (ANY, part.radius);
        } else if part.length() > 0.0 {
            let away = [arcs[0] - section.start, section.end - arcs[1]];
            let near = 2.0 * (section.radius + tube.error());
            let is_near = |end: usize| section.faces[end].is_some() && away[end] <= near;
            let turn = tube.turn().filter(|_| (0..2).any(is_near)).unwrap_or(0.0);
            part.spread = 0.5 * bend + longer + turn + 2.0 * known / part.length();
            part.doubt = part.radius * if turn < 1.0 { 2.5 * turn } else { 1.0 };
        }
        Ok(part)
    }

    fn begin(&mut self, reach: Real) {
        self.parts.clear();
        self.scale = reach.power_of_two_to_unity();
    }

    /// Builds the tree over the leaves.
    ///
    /// **Rounding.** n leaves of total length L: each arc length is a sum of n rounded lengths, so
    /// it errs by at most (n + 4) u L. Scaled coordinates and radii are below 2, and a bound is a
    /// sum of fewer than 64 products of a coordinate or radius and factors of at most 1.
    fn finish(&mut self) {
        let count = self.parts.len() as u32;
        let length = self.parts.last().map_or(0.0, |part| part.arcs[1]);
        let u = Real::UNIT_ROUNDOFF;
        self.arc_slack = 2.0 * (Real::from(count) + 4.0) * u * length;
        self.slack = 256.0 * u + 2.0 * self.arc_slack;
        self.leaves = count;
        self.root = self.join(0, count);
    }

    /// Returns the node over the leaves from `first` to before `last`.
    fn join(&mut self, first: u32, last: u32) -> u32 {
        if last - first < 2 {
            return first;
        }
        let middle = first + (last - first) / 2;
        let children = [self.join(first, middle), self.join(middle, last)];
        let union = Part::union(children.map(|child| self.part(child)), children);
        self.parts.push(union);
        self.parts.len() as u32 - 1
    }
}
