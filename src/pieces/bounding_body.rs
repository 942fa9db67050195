//! A convex body that holds a piece of the tube.
//!
//! The piece is the union of the discs of radius r across the centreline c, and of a ball at a
//! round end of the section. Let c be given by arc length with |c''| <= k, the piece have the
//! length l, and x = c(s) + w be a point of a disc: w is perpendicular to the tangent t(s), and at
//! most r long.
//!
//! **Chord, round ends.** c(s) differs from the linear interpolation of the ends by at most k l^2 /
//! 8, so the capsule of radius r + k l^2 / 8 holds all balls, and so all discs. A point c(m) of the
//! curve between makes it narrower. Let e lead from the chord to it, perpendicular to the chord,
//! with its foot within the chord, and let D = k h^2 / 2 with h the longer of the two parts. In a
//! part, at the share q of the way to c(m), the curve differs from q e by at most D q (1 - q), so
//! it is at most |q - 1/2| |e| + D q (1 - q) from the chord moved by e / 2. With u = |q - 1/2| that
//! is u |e| + D (1/4 - u^2), whose maximum is D / 4 + |e|^2 / (4 D) if |e| <= D, and |e| / 2
//! otherwise.
//!
//! **Chord, flat ends.** Let d be the direction of the chord. t(s) is within k l / 2 of it (as an
//! angle, for k l <= pi / 2: seen from t(s), the two parts p + q = l of the curve add up to at most
//! (2 - cos kp - cos kq) / k across and at least (sin kp + sin kq) / k along, and the quotient is
//! at most tan(k l / 2)). So <c(s), d> grows with s, and w reaches at most r sin(k l / 2) along d:
//! x is behind the plane that far beyond the end. A flat end there keeps all of x, since x is
//! within the capsule's radius of the longer axis too.
//!
//! **At a face.** With the tangent T at the face and a distance s from there, t is within k s of T,
//! so c(s) is at least sin(k s) / k behind the face's plane and at most (1 - cos ks) / k <= k l^2 /
//! 2 beside its normal, and w reaches at most r sin ks ahead: as k r < 1, x is behind the plane,
//! and within r + k l^2 / 2 of the normal through the face's centre, which is taken l long. If the
//! normal is known to an angle a alone, t is within ks + a of it: x is at most r sin a ahead of the
//! plane and r + k l^2 / 2 + a l beside the normal. Where the other end must be flat too, x is at
//! most l + r sin(k l + a) behind.
//!
//! Such a body is led from the face to its back, A = ahead + behind long. Rounding moves its two
//! ends against one another by at most 2 u (reach + A) in each coordinate, so it turns the axis by
//! up to 4 u (reach / A + 1), and the flat ends dip by r times that where they should hold all. 4 u
//! r is within `slack`, of which 4 u reach is less than a sixteenth. For the rest both ends lie
//! farther out by x = min(e / A, sqrt(e)) with e = r slack / 16: the body is then longer than
//! A + x, and e / (A + x) is at most x. The back moves aside by less than a slack.
//!
//! Points of the discs are known to `error`: everything is `error` wider. Of that, what is stated
//! for the curve that was given (its own error, the deviation of a fit) moves discs whose chord is
//! known. The rest, `loose`, is how far the ticks may be from the curve, and what was taken for
//! one; it may turn the chord by up to 2 loose / |chord|, which puts the wall of a flat body off by
//! `loose` once more. Where directions may be off by a stated turn, w reaches as much farther along
//! d.

use super::piece::Piece;
use super::placed_tube::PlacedTube;
use super::refinable::Body;
use crate::answer::{ProximityError, TubePiece};
use crate::pair::PlacedLink;
use crate::robot::{Cap, CurveBound, ModifiedCylinder, Section};
use parry3d_f64::math::{Real, Vector};
use std::f64::consts::FRAC_PI_2;

/// A convex body around a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundingBody {
    pub body: PlacedLink,
    /// By how much, about, it is larger than the piece. Only for the choice of what to do next, as
    /// all below.
    pub excess: Real,
    /// How much smaller, about, the bodies of its halves are.
    pub narrows: Real,
}

impl BoundingBody {
    pub(crate) fn is_flat(&self) -> bool {
        self.body.flat() != [false; 2]
    }
}

impl Body for BoundingBody {
    fn excess(&self) -> Real {
        self.excess
    }
}

impl PlacedTube<'_> {
    /// A piece with its finite body, which is at least `lower` away from the mesh.
    pub(crate) fn report(&self, piece: &Piece, outer: &BoundingBody, lower: Real) -> TubePiece {
        let body = &outer.body;
        let caps = body.flat().map(|flat| if flat { Cap::Flat } else { Cap::Round });
        // Flat bodies are longer than rounding, and nothing is farther out than a few times what
        // tube and pose were checked for.
        let body = ModifiedCylinder::unchecked(body.start(), body.end(), body.radius(), caps);
        TubePiece { section: piece.section, arc_lengths: self.arcs(piece), body, lower }
    }

    /// # Errors
    /// The curve is not finite there, and so the body around the piece.
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

    /// The body of a piece without its outermost layer: `depth` times twice what the body is larger
    /// than the piece, and than what rounding can do. Nothing where no more is left of it.
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

    /// A body that holds the piece.
    pub(crate) fn outer(&self, piece: &Piece) -> BoundingBody {
        let section = self.section(piece.section);
        let arcs = self.arcs(piece);
        let exposed = self.exposed(section, arcs);
        let length = (arcs[1] - arcs[0]) * section.stretch;
        let known = self.tube.bound(section, [piece.from, piece.to]);
        let bend = known.curvature * length;
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
        for (end, face) in ends.into_iter().enumerate() {
            let Some(face) = face else { continue };
            // Elsewhere the flat end behind is inside the tube, and does no harm there.
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
                    // What the face's direction leaves open stays.
                    narrows: excess - face.tilt * section.radius,
                };
            }
        }
        self.along_chord(section, piece, &known, length, exposed)
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
        let loose = self.tube.merged() + known.off;
        let along = end - start;
        let mut excess = 0.125 * curvature * length * length;
        let mut shift = Vector::ZERO;
        if excess > self.slack && piece.to - piece.from >= 2 {
            let arcs = self.arcs(piece);
            let tick = self
                .tube
                .tick(section, 0.5 * (arcs[0] + arcs[1]))
                .max(piece.from + 1)
                .min(piece.to - 1);
            let arc = self.tube.arc(section, tick);
            let longer = (arc - arcs[0]).max(arcs[1] - arc) * section.stretch;
            let most = 0.5 * curvature * longer * longer;
            let offset = self.point(section, tick) - start;
            let share = offset.dot(along) / along.length_squared();
            if (0.0..=1.0).contains(&share) {
                let off = offset - along * share;
                let size = off.length();
                let moved =
                    if size < most { 0.25 * (most + size * (size / most)) } else { 0.5 * size };
                if moved < excess {
                    (shift, excess) = (off * 0.5, moved);
                }
            }
        }
        start += shift;
        end += shift;
        let (mut wider, mut narrows) = (excess, 0.75 * excess);
        let chord = along.length();
        // A chord that is mere rounding has no direction.
        let flat = if chord > 4.0 * (loose + self.slack) { flat } else { [false; 2] };
        if flat != [false; 2] {
            let unit = along / chord;
            let bend = 0.5 * curvature * length;
            let tilt = bend + 2.0 * (loose + self.slack) / chord + self.turn();
            // The halves bend half as much, and rounding turns their chords twice as far.
            narrows += section.radius * (0.5 * bend - 2.0 * self.slack / chord);
            let beyond = section.radius * tilt + error + self.slack;
            wider += section.radius * tilt;
            if flat[0] {
                start -= unit * beyond;
            }
            if flat[1] {
                end += unit * beyond;
            }
        }
        let errors = if flat == [false; 2] { error } else { error + loose };
        let radius = section.radius + excess + errors + self.slack;
        BoundingBody { body: PlacedLink::between(start, end, radius, flat), excess: wider, narrows }
    }
}
