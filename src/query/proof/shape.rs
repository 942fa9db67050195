//! What a proof takes for granted of one shape of the robot.

use super::body::ProofBody;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// The robot at rest, or at the middle of an interval of time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// The interval, if it moves.
    pub times: [Real; 2],
    /// Points of the centreline, in the mesh's frame.
    pub points: Vec<Vector>,
    /// The pieces between them.
    pub pieces: Vec<PiecePremises>,
}

/// What is known of a piece between two points.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PiecePremises {
    pub radius: Real,
    /// Which of its ends are flat.
    pub flat: [bool; 2],
    /// The curvature is at most this.
    pub curvature: Real,
    /// The arc length is at most this.
    pub length: Real,
    /// How far the ends of the piece may be from the two points.
    pub off: Real,
    /// How fast points of the centreline move, and how fast its direction turns.
    pub speed: Real,
    pub turn: Real,
}

impl Shape {
    /// A chain at rest; none if its links do not follow one another.
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

    /// The bodies that hold the pieces, each with what must be free around it: the margin, and what
    /// the robot may move until the interval ends. The book's page on proofs derives them;
    /// `docs/book/check_proof.py` computes them again.
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
