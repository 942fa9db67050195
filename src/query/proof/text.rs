//! A proof as text, in the format of the book's page on proofs; and its premises about each shape
//! of the robot ([`Shape`]).

use super::plane_search::{ProofBody, Step};
use crate::answer::Proof;
use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};
use sha2::{Digest, Sha256};
use std::fmt::{self, Write};

/// A shape, and the steps that separate it from the mesh.
pub(crate) type ProvenShape = (Shape, Vec<Step>);

/// The subject of a proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Chain,
    Tube,
    Motion,
}

/// How many steps are written on one line.
const ON_A_LINE: usize = 16;

/// Writes the proof that shapes, each with its steps, keep a margin.
pub(crate) fn write_proof(mesh: &Mesh, margin: Real, kind: Kind, shapes: &[ProvenShape]) -> Proof {
    let (mut text, mut planes) = (String::new(), 0);
    let name = match kind {
        Kind::Chain => "chain",
        Kind::Tube => "tube",
        Kind::Motion => "motion",
    };
    let (vertices, triangles) = (mesh.vertices().len(), mesh.len());
    let mut write = |line: std::fmt::Arguments| text.write_fmt(line).unwrap_or_default();
    write(format_args!("proof of clearance 2\nmesh {vertices} {triangles} {}\n", digest(mesh)));
    write(format_args!("margin {margin:?}\n{name} {}\n", shapes.len()));
    for parted in shapes {
        planes += write_shape(kind, parted, &mut text).unwrap_or_default();
    }
    text.push_str("end\n");
    Proof::new(text, planes, shapes.len())
}

/// Returns the length of the text of a shape, in bytes.
pub(crate) fn size_of(kind: Kind, parted: &ProvenShape) -> usize {
    let mut size = Size(0);
    write_shape(kind, parted, &mut size).unwrap_or_default();
    size.0
}

/// Counts the bytes that are written.
struct Size(usize);

impl Write for Size {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 += text.len();
        Ok(())
    }
}

/// The longest text of a proof, in bytes: 16 MiB.
pub(crate) const MAX_BYTES: usize = 1 << 24;

/// The least bytes of a piece of a tube: three coordinates, five numbers and caps, with blanks.
pub(crate) const MIN_PIECE_BYTES: usize = 35;

/// Writes a shape and its steps. Returns the number of planes.
fn write_shape(
    kind: Kind,
    (shape, steps): &ProvenShape,
    text: &mut impl Write,
) -> Result<usize, fmt::Error> {
    let mut planes = 0;
    write!(text, "shape")?;
    if kind == Kind::Motion {
        let [from, to] = shape.times;
        write!(text, " {from:?} {to:?}")?;
    }
    writeln!(text, " {}", shape.pieces.len())?;
    for Vector { x, y, z } in &shape.points {
        writeln!(text, "{x:?} {y:?} {z:?}")?;
    }
    for piece in &shape.pieces {
        let PiecePremises { radius, flat, stated, curvature, length, off, tilt, speed, turn } =
            piece;
        let mut caps = flat.map(|flat| if flat { 'f' } else { 'r' });
        if let Some((end, _)) = stated {
            caps[*end] = 'd';
        }
        write!(text, "{radius:?} {}{}", caps[0], caps[1])?;
        if kind != Kind::Chain {
            write!(text, " {curvature:?} {length:?} {off:?} {tilt:?}")?;
        }
        if kind == Kind::Motion {
            write!(text, " {speed:?} {turn:?}")?;
        }
        if let Some((_, Vector { x, y, z })) = stated {
            write!(text, " {x:?} {y:?} {z:?}")?;
        }
        writeln!(text)?;
    }
    writeln!(text, "steps {}", steps.len())?;
    for (number, step) in (1..).zip(steps) {
        match step {
            Step::Triangles => write!(text, "t")?,
            Step::Pieces => write!(text, "p")?,
            Step::Plane([x, y, z]) => {
                planes += 1;
                write!(text, "{x},{y},{z}")?;
            }
        }
        let is_last = number % ON_A_LINE == 0 || number == steps.len();
        write!(text, "{}", if is_last { '\n' } else { ' ' })?;
    }
    Ok(planes)
}

/// Returns the SHA-256 of all coordinates, then the vertex indices of all triangles, little-endian.
fn digest(mesh: &Mesh) -> String {
    let mut sha = Sha256::new();
    for vertex in mesh.vertices() {
        // Maps -0 to 0.
        (*vertex + Vector::ZERO).to_array().iter().for_each(|x| sha.update(x.to_le_bytes()));
    }
    mesh.indices().as_flattened().iter().for_each(|corner| sha.update(corner.to_le_bytes()));
    sha.finalize().iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

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
    /// An upper bound on the distance of the curve's ends from the two points, plus that of the
    /// piece's points from the discs.
    pub off: Real,
    /// An upper bound on the angle between a disc and the plane across the curve; at a stated
    /// direction, on its error.
    pub tilt: Real,
    /// An end whose direction is known, and this direction, out of the piece.
    pub stated: Option<(usize, Vector)>,
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
    /// The head of [`super`] derives them; `docs/book/check_proof.py` recomputes them.
    pub(crate) fn bodies(&self, margin: Real) -> Vec<ProofBody> {
        let half = 0.5 * (self.times[1] - self.times[0]);
        let between = self.points.windows(2).zip(&self.pieces);
        let body = |(points, piece): (&[Vector], &PiecePremises)| {
            let PiecePremises { radius: own, flat, curvature, length, off, tilt, .. } = *piece;
            let mut ends = [points[0], points[1]];
            let mut axis = ends[1] - ends[0];
            let bend = curvature * length;
            let mut radius = own + 0.125 * bend * length + off;
            let mut around = margin + half * piece.speed;
            if flat != [false; 2] {
                around += half * piece.turn * own;
            }
            if let Some((at, outward)) = piece.stated {
                radius = own + 0.5 * bend * length + tilt * length + off;
                let other = if flat[1 - at] { own * (bend + tilt) + off } else { 0.0 };
                let unit = outward / outward.length();
                let tip = ends[at];
                ends[at] = tip + unit * (own * tilt + off);
                ends[1 - at] = tip - unit * (length + other);
                axis = if at == 0 { -outward } else { outward };
            } else if flat != [false; 2] {
                let chord = axis.length();
                let turned = if off > 0.0 { (22.0 / 7.0) * off / chord } else { 0.0 };
                let beyond = own * (0.5 * bend + tilt + turned) + off;
                // The flat ends of a chain are where they are.
                if beyond > 0.0 {
                    let beyond = axis * (beyond / chord);
                    ends[0] -= if flat[0] { beyond } else { Vector::ZERO };
                    ends[1] += if flat[1] { beyond } else { Vector::ZERO };
                }
            }
            ProofBody { ends, axis, flat, radius, around }
        };
        between.map(body).collect()
    }
}
