//! The premises of a proof about one shape of the robot.

use super::body::ProofBody;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// The robot at rest, or at the middle of an interval of time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// The interval of time, for a motion.
    pub times: [Real; 2],
    /// Points of the centreline, in the mesh's frame.
    pub points: Vec<Vector>,
    /// The pieces between consecutive points.
    pub pieces: Vec<PiecePremises>,
}

/// The premises about a piece between two points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PiecePremises {
    pub radius: Real,
    /// Which ends are flat.
    pub flat: [bool; 2],
    /// An upper bound on the curvature.
    pub curvature: Real,
    /// An upper bound on the arc length.
    pub length: Real,
    /// An upper bound on the distance of the piece's ends from the two points.
    pub off: Real,
    /// Upper bounds on the speed of points of the centreline, and on the turn of its direction per
    /// unit of time.
    pub speed: Real,
    pub turn: Real,
}

impl Shape {
    /// Returns a chain at rest; `None` if its links are not consecutive.
    pub(crate) fn of_chain(robot: PlacedRobot) -> Option<Self> {
        let mut shape = Self { points: vec![robot.link(0).start()], ..Self::default() };
        for link in robot.placed_links() {
            if shape.points.last() != Some(&link.start()) {
                return None;
            }
            shape.points.push(link.end());
            shape.pieces.push(PiecePremises {
                radius: link.radius(),
                flat: link.flat(),
                ..PiecePremises::default()
            });
        }
        Some(shape)
    }

    /// Returns the bodies of the pieces, each with the free space required around it: the margin,
    /// and the displacement of the robot until the interval ends.
    ///
    /// The book's page on proofs derives them; `docs/book/check_proof.py` recomputes them.
    pub(crate) fn bodies(&self, margin: Real) -> Vec<ProofBody> {
        let half = 0.5 * (self.times[1] - self.times[0]);
        let between = self.points.windows(2).zip(&self.pieces);
        let body = |(ends, piece): (&[Vector], &PiecePremises)| {
            let PiecePremises { radius: own, curvature, length, off, .. } = *piece;
            let radius = own + 0.125 * curvature * length * length + off;
            let mut around = margin + half * piece.speed;
            if piece.flat != [false; 2] {
                let turned = if off > 0.0 {
                    radius * off * (22.0 / 7.0) / (ends[1] - ends[0]).length()
                } else {
                    0.0
                };
                around += half * piece.turn * own + 0.5 * own * curvature * length + off + turned;
            }
            ProofBody { ends: [ends[0], ends[1]], flat: piece.flat, radius, around }
        };
        between.map(body).collect()
    }
}
