//! A convex body that contains a piece of the tube.
//!
//! # Definitions
//! - c: the centreline by arc length, |c''| <= k. t(s): its tangent. l: the length of the piece. r:
//!   its radius.
//! - **Piece**: the union of the discs of radius r perpendicular to c, and of a ball at a round end
//!   of the section.
//! - x = c(s) + w: a point of a disc; w is perpendicular to t(s) and |w| <= r.
//! - d: the direction of the chord between the ends of the piece. u: the unit roundoff.
//!
//! # Claim
//! Each of the following bodies contains the piece.
//!
//! ## Case 1: along the chord, round ends
//! c(s) deviates from the linear interpolation of the ends by at most k l^2 / 8. So the capsule of
//! radius r + k l^2 / 8 contains all balls, and so all discs.
//!
//! **Shifted chord.** A point c(m) of the curve in between makes the capsule narrower. Let e be the
//! perpendicular from the chord to c(m), with its foot within the chord. Let D = k h^2 / 2, where h
//! is the longer of the two parts that c(m) separates. (m is a tick; ticks may be unevenly spaced.)
//! 1. In a part, at the share q of the way to c(m), the curve deviates from q e by at most D q (1 -
//!    q).
//! 2. Let v = |q - 1/2|. The distance of the curve from the chord moved by e / 2 is at most `|q -
//!    1/2| |e| + D q (1 - q) = v |e| + D (1/4 - v^2)`.
//! 3. The maximum over v is D / 4 + |e|^2 / (4 D) if |e| <= D, and |e| / 2 otherwise.
//!
//! ## Case 2: along the chord, flat ends
//! 1. For k l <= pi / 2, the angle between t(s) and d is at most k l / 2: let the curve be p behind
//!    and q ahead of s, p + q = l. Seen along t(s), the chord reaches at most (2 - cos kp - cos kq)
//!    / k across and at least (sin kp + sin kq) / k along. The quotient is largest for p = 0 or q =
//!    0, where it is tan(k l / 2).
//! 2. So the component of c(s) along d increases with s, and w reaches at most r sin(k l / 2) along
//!    d. So x is behind the plane that is this far beyond the end.
//! 3. The axis is extended to that plane. x is behind the plane, and within the capsule's radius of
//!    the extended axis, so the flat end cuts off no x.
//!
//! ## Case 3: at a face
//! Let T be the tangent at the face and s the arc length from the face. Let k r < 1, and let k l +
//! a (3.) be at most pi / 2.
//! 1. The angle between t(s) and T is at most k s. So c(s) is at least sin(k s) / k behind the
//!    face's plane, and at most (1 - cos ks) / k <= k l^2 / 2 beside its normal.
//! 2. The vector w reaches at most r sin ks ahead. Since k r < 1, x is behind the plane. It is
//!    within `r + k l^2 / 2` of the normal through the face's centre. The body's axis follows that
//!    normal for the length l.
//! 3. If the normal is known only to an angle a, the angle between t(s) and it is at most ks + a.
//!    Then x is at most r sin a ahead of the plane and r + k l^2 / 2 + a l beside the normal.
//! 4. If the other end must be flat too, x is at most l + r sin(k l + a) behind the plane.
//!
//! **Rounding.** The axis leads from the face to the back and has the length A = ahead + behind.
//! 1. Rounding moves its two ends relative to one another by at most 2 u (reach + A) per
//!    coordinate. So it turns the axis by up to 4 u (reach / A + 1), and the flat ends dip by r
//!    times that.
//! 2. `slack` covers 4 u r, and 4 u reach < slack / 16.
//! 3. For the rest, both ends are moved outwards by m = min(b / A, sqrt(b)) with b = r slack / 16.
//!    The body is then longer than A + m, and b / (A + m) <= m. The back moves sideways by less
//!    than a slack.
//!
//! ## Runs of pieces
//! **Claim.** Let a and b be the ends of a run of pieces along the tube, c = |b - a|, and L the
//! length of the curve between them. Each of its points is at most h = sqrt(L^2 - c^2) / 2 from the
//! segment between a and b. So the capsule of the radius h + the largest radius contains all balls
//! of the tube's radius in the run, and so all discs.
//!
//! **Proof.** Let p be a point of the curve: |p - a| + |p - b| <= L. If its foot is within the
//! segment, at the distance g, the sum is at least sqrt(c^2 + 4 g^2), so g <= h. If p is beyond b,
//! |p - a|^2 >= |p - b|^2 + c^2, so |p - b| <= (L^2 - c^2) / (2 L) = 2 h^2 / L <= h.
//!
//! **Rounding.** The arc length of a section errs by less than 8 u reach, which is slack / 16, and
//! so does the gap at a joint: the segments that a chain drops. The ends err by less than slack /
//! 8. So L is at most the difference of the arc lengths + slack (1 + sections / 8).
//!
//! ## Errors
//! The points of the discs are known to `error`, so everything is wider by `error`. The ends of a
//! chord may be off to either side, which turns the chord by up to 2 error / |chord|. The wall of a
//! flat body is then off by `error` once more. So a flat body can be the wider one. If the stated
//! turn is all that is known of the flat ends, queries about shapes at rest and `prove_tube` also
//! ask as if it were not stated, and return the better of both (`engine::bvh::clearance`). Queries
//! about motions do not.
//!
//! If directions may be off by a stated turn, w reaches farther along d by r times that turn.

use super::placed_tube::{Piece, PlacedTube};
use super::refinable::Body;
use crate::answer::{ProximityError, TubePiece};
use crate::curve::{CurveBound, Section};
use crate::pair::PlacedLink;
use crate::robot::{Cap, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::FRAC_PI_2;

/// How many cores are tried for a body that overlaps a triangle or another body.
pub(super) const MOST_CORES: u32 = 4;

/// A run is nearly straight if its curve is at most this share of its chord beside the chord: an
/// arc of .9 rad. (1/4 to 1/32 take the same time.)
#[cfg(feature = "robots")]
const MOST_BESIDE: Real = 1.0 / 8.0;

/// A convex body around a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundingBody {
    pub body: PlacedLink,
    /// By about how much the body is larger than the piece. A heuristic: correctness does not
    /// depend on it.
    pub excess: Real,
    /// By about how much the bodies of the halves are narrower. It decides whether the piece is
    /// divided; soundness does not depend on it.
    pub narrows: Real,
}

impl Body for BoundingBody {
    fn excess(&self) -> Real {
        self.excess
    }

    fn is_flat(&self) -> bool {
        self.body.flat() != [false; 2]
    }
}

/// A piece as a range of its section, which is the same in every shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SectionRange<'a> {
    pub section: u32,
    /// The range along the section, as shares of its length.
    #[cfg_attr(not(feature = "robots"), expect(dead_code, reason = "pairs alone need it"))]
    pub shares: [Real; 2],
    /// Its body in the current shape.
    pub outer: &'a BoundingBody,
    pub radius: Real,
}

impl PlacedTube<'_> {
    /// Returns a piece as a range of its section, which is the same in every shape, with its body.
    #[cfg(feature = "robots")]
    pub(super) fn section_range<'o>(
        &self,
        piece: &Piece,
        outer: &'o BoundingBody,
    ) -> SectionRange<'o> {
        SectionRange {
            section: piece.section,
            shares: self.shares(piece),
            outer,
            radius: self.radius(piece),
        }
    }

    /// Returns a piece with its finite body, which is at least `lower` away from the mesh.
    pub(crate) fn report(&self, piece: &Piece, outer: &BoundingBody, lower: Real) -> TubePiece {
        let body = &outer.body;
        let caps = body.flat().map(|flat| if flat { Cap::Flat } else { Cap::Round });
        // Flat bodies are longer than rounding, and all coordinates stay within a few times the
        // limit that tube and pose were checked for.
        let body = ModifiedCylinder::unchecked(body.start(), body.end(), body.radius(), caps);
        TubePiece { section: piece.section, arc_lengths: self.arcs(piece), body, lower }
    }

    /// Checks the body of a piece.
    ///
    /// # Errors
    /// The curve of the piece, and so its body, is not finite.
    pub(crate) fn check_finite(
        &self,
        piece: &Piece,
        outer: &BoundingBody,
    ) -> Result<(), ProximityError> {
        if outer.body.is_finite() {
            Ok(())
        } else {
            Err(ProximityError::CurveNotFinite { arc_length: self.arcs(piece)[0] })
        }
    }

    /// Returns the body of a piece without its outermost layer; `None` if too little remains.
    ///
    /// The layer is 2 `depth` (max(radius of the body - radius of the piece, `excess`) + slack)
    /// thick.
    pub(super) fn core(
        &self,
        piece: &Piece,
        outer: &BoundingBody,
        depth: Real,
    ) -> Option<PlacedLink> {
        let (body, radius) = (&outer.body, self.section(piece.section).radius);
        let layer = depth * 2.0 * ((body.radius() - radius).max(outer.excess) + self.slack);
        let inward = Vector::from(body.axis()) * (2.0 * layer);
        let [start, end] = body.flat();
        let ends = [
            if start { body.start() + inward } else { body.start() },
            if end { body.end() - inward } else { body.end() },
        ];
        let is_left =
            layer < 0.5 * radius && (ends[1] - ends[0]).dot(Vector::from(body.axis())) > 0.0;
        is_left.then(|| PlacedLink::between(ends[0], ends[1], radius - layer, body.flat()))
    }

    /// Returns a body that contains the piece: case 3 at a face if it is tighter, otherwise case 1
    /// or 2.
    pub(crate) fn outer(&self, piece: &Piece) -> BoundingBody {
        let section = self.section(piece.section);
        let arcs = self.arcs(piece);
        let exposed = self.exposed(section, arcs);
        let length = (arcs[1] - arcs[0]) * section.stretch;
        let known = self.tube.bound(section, [piece.from, piece.to]);
        let bend = known.curvature * length;
        // Case 1.
        if exposed == [false; 2] || bend > FRAC_PI_2 || known.curvature * section.radius >= 1.0 {
            return self.along_chord(section, piece, &known, length, [false; 2]);
        }
        let error = self.tube.error() + known.off;
        let sideways = 0.5 * bend * length;
        let faces = self.faces(section);
        let ends = [
            (piece.from == section.first).then_some(faces[0]).flatten(),
            (piece.to == section.last).then_some(faces[1]).flatten(),
        ];
        let flat_ends = Real::from(u8::from(exposed[0])) + Real::from(u8::from(exposed[1]));
        let by_chord = 0.25 * sideways + 0.5 * section.radius * bend * flat_ends;
        // Case 3.
        for (end, face) in ends.into_iter().enumerate() {
            let Some(face) = face else { continue };
            // A heuristic, as all of `excess`: a back that is not at a face does not stick out of
            // the tube.
            let other =
                if ends[1 - end].is_some() { section.radius * (bend + face.tilt) } else { 0.0 };
            let excess = sideways + face.tilt * (length + section.radius) + other;
            if excess <= by_chord && bend + face.tilt <= FRAC_PI_2 {
                let wider = sideways + face.tilt * length + error + 2.0 * self.slack;
                let mut beyond = section.radius * face.tilt + error + self.slack;
                let mut behind = length;
                if exposed[1 - end] {
                    behind += section.radius * (bend + face.tilt) + error + self.slack;
                }
                let turning = section.radius * self.slack / 16.0;
                let turned = turning / (beyond + behind).max(turning.sqrt());
                beyond += turned;
                behind += turned;
                let face = self.face(&face);
                let tip = face.centre + face.outward * beyond;
                let back = face.centre - face.outward * behind;
                let (ends, flat) = if end == 0 {
                    ([tip, back], [true, exposed[1]])
                } else {
                    ([back, tip], [exposed[0], true])
                };
                return BoundingBody {
                    body: PlacedLink::between(ends[0], ends[1], section.radius + wider, flat),
                    excess,
                    // Halving does not reduce the tilt of the face.
                    narrows: excess - face.tilt * section.radius,
                };
            }
        }
        // Case 1 or 2.
        self.along_chord(section, piece, &known, length, exposed)
    }

    /// Returns the ends and the radius of a capsule around the tube from one piece to a later one
    /// (section "Runs of pieces"); `None` if the curve between them is not nearly straight.
    #[cfg(feature = "robots")]
    pub(super) fn around_run(&self, [first, last]: [&Piece; 2]) -> Option<([Vector; 2], Real)> {
        let [from, to] = [first, last].map(|piece| self.section(piece.section));
        let ends = [self.point(from, first.from), self.point(to, last.to)];
        let chord = (ends[1] - ends[0]).length();
        let along = self.tube.arc(to, last.to) - self.tube.arc(from, first.from);
        // A cheap first test.
        if along > (1.0 + 2.0 * MOST_BESIDE * MOST_BESIDE) * chord {
            return None;
        }
        let (mut radius, mut stretch, mut off): (Real, Real, Real) = (0.0, 1.0, 0.0);
        for number in first.section..=last.section {
            let section = self.section(number);
            let from = if number == first.section { first.from } else { section.first };
            let to = if number == last.section { last.to } else { section.last };
            radius = radius.max(section.radius);
            stretch = stretch.max(section.stretch);
            off = off.max(self.tube.bound(section, [from, to]).off);
        }
        let count = Real::from(last.section - first.section);
        let length = along * stretch + (1.0 + 0.125 * count) * self.slack;
        let beside = 0.5 * ((length - chord).max(0.0).sqrt() * (length + chord).sqrt());
        let wider = radius + off + self.tube.error() + self.slack;
        (beside <= MOST_BESIDE * chord).then_some((ends, beside + wider))
    }

    fn along_chord(
        &self,
        section: &Section,
        piece: &Piece,
        known: &CurveBound,
        length: Real,
        flat: [bool; 2],
    ) -> BoundingBody {
        let [mut start, mut end] = [piece.from, piece.to].map(|tick| self.point(section, tick));
        let (error, curvature) = (self.tube.error() + known.off, known.curvature);
        let along = end - start;
        let mut excess = 0.125 * curvature * length * length;
        let mut shift = Vector::ZERO;
        // Case 1, shifted chord.
        if excess > self.slack && piece.to - piece.from >= 2 {
            let arcs = self.arcs(piece);
            let tick = self
                .tube
                .tick(section, 0.5 * (arcs[0] + arcs[1]))
                .max(piece.from + 1)
                .min(piece.to - 1);
            let arc = self.tube.arc(section, tick);
            let longer = (arc - arcs[0]).max(arcs[1] - arc) * section.stretch;
            // D, e and the excess of step 3.
            let deviation = 0.5 * curvature * longer * longer;
            let offset = self.point(section, tick) - start;
            let share = offset.dot(along) / along.length_squared();
            if (0.0..=1.0).contains(&share) {
                let perpendicular = offset - along * share;
                let size = perpendicular.length();
                let moved = if size < deviation {
                    0.25 * (deviation + size * (size / deviation))
                } else {
                    0.5 * size
                };
                if moved < excess {
                    (shift, excess) = (perpendicular * 0.5, moved);
                }
            }
        }
        start += shift;
        end += shift;
        let (mut wider, mut narrows) = (excess, 0.75 * excess);
        let chord = along.length();
        // A chord within rounding has no direction.
        let flat = if chord > 4.0 * (error + self.slack) { flat } else { [false; 2] };
        // Case 2.
        if flat != [false; 2] {
            let unit = along / chord;
            let half_bend = 0.5 * curvature * length;
            let tilt = half_bend + 2.0 * (error + self.slack) / chord + self.turn();
            // The halves bend half as much; rounding turns their chords twice as far.
            narrows += section.radius * (0.5 * half_bend - 2.0 * self.slack / chord);
            let beyond = section.radius * tilt + error + self.slack;
            wider += section.radius * tilt;
            if flat[0] {
                start -= unit * beyond;
            }
            if flat[1] {
                end += unit * beyond;
            }
        }
        let errors = if flat == [false; 2] { error } else { 2.0 * error };
        let radius = section.radius + excess + errors + self.slack;
        BoundingBody { body: PlacedLink::between(start, end, radius, flat), excess: wider, narrows }
    }
}
