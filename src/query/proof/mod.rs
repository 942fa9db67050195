//! Proofs that others can check: planes that separate a robot from a mesh.
//!
//! The planes are found here and checked by `docs/book/check_proof.py`. The book's page on proofs
//! has the format and the premises.
//!
//! # Definitions
//! - A *body* is the hull of two ends: discs across the line between them, or half balls.
//! - A *piece* is a part of the robot. `e` is the free space required around its body.
//! - A *group* is a set of triangles, L the least q . v over the corners v of the group.
//!   So q . x >= L on all its triangles, which are hulls of their corners. A lower L is allowed:
//!   the checker tries the box of the group first.
//! - h is half of a motion's interval, R the radius of a body's ends.
//!
//! # Claim
//! If the checker says yes and the premises hold, every point of the robot, at every time, is
//! farther than the margin from every triangle.
//!
//! # Proof
//! **All pairs.** Halving loses no pair. When no step is left and nothing is left to separate, each
//! triangle was in a group that a plane separated from a run with each piece. Any rule for the
//! halves would do, and no list of triangles is needed.
//!
//! **A plane.** If q . y + e |q| < L for every point y of both ends, the same holds for the body,
//! and no point of a triangle is within e of it. The largest q . y is
//!
//! 1. q . p + r |q'| for a disc across w around p, where |q'|^2 = q^2 - (q . w)^2 / w^2;
//! 2. q . p + r |q| for a half ball if q points out of that end, and otherwise case 1.
//!
//! With d = L - q . p the condition is d > a + b, where a is the reach of the end and b = e |q|.
//! For d > 0 that is
//!
//! ```text
//! d^2 - a^2 - b^2 > 0   and   (d^2 - a^2 - b^2)^2 > 4 a^2 b^2,
//! ```
//!
//! which contains only squares: rational numbers, and whole ones if multiplied by w^2.
//!
//! **A piece lies in its body.** With the premises `radius`, `curvature`, `length`, `off`, `speed`
//! and `turn` of the piece,
//!
//! ```text
//! R = radius + curvature length^2 / 8 + off,       e = margin + h speed.
//! ```
//!
//! If an end is flat, e grows by
//!
//! ```text
//! h turn radius + radius curvature length / 2 + off + (22 / 7) R off / |chord|.
//! ```
//!
//! *Theorem 1 (round ends).* Let c be a curve by arc length with curvature at most k (a bound on
//! how fast its direction turns) and length at most l. Each c(s) is within k l^2 / 8 of the point
//! on its chord at the same share. *Proof.* The difference vanishes at both ends, and its second
//! derivative is at most k, so it is at most k s (l - s) / 2. An offset adds at most `off`: of the
//! centreline from c, or of its ends from the points. So the centreline is within R - radius of the
//! line between the points, and all balls and discs lie in the capsule of radius R.
//!
//! *Theorem 2 (flat ends).* If k l <= 1, the direction of the curve is everywhere within the angle
//! k l / 2 of its chord. *Proof.* Seen from c(s), the parts of lengths p and q, p + q = l, advance
//! along its direction by at least (sin kp + sin kq) / k, and across it by at most (2 - cos kp -
//! cos kq) / k. The quotient is at most tan(k l / 2). So c(s) advances along the chord, and a disc
//! reaches beyond the planes across the chord at its ends by at most radius sin(k l / 2). The half
//! ball at a round end reaches back no farther: of its points c(l) + v with v . c'(l) >= 0, none is
//! farther than radius sin(k l / 2) behind the plane across the chord there. So the part of the
//! capsule that does not lie farther beyond a flat end contains the piece: the piece is within
//! radius k l / 2 of the hull whose flat ends are discs and whose round ends are half balls.
//!
//! *Theorem 3 (offset ends).* If the ends are within `off` of the points, and `off` is less than
//! half of the chord, the true chord is turned by an angle whose sine is at most 2 off / |chord|,
//! so by at most pi off / |chord|. Moving each point by at most off + R pi off / |chord| turns the
//! hull of the true ends into one around the given ends; and pi < 22 / 7.
//!
//! **Motion.** A point of a disc or a half ball is a point of the centreline plus an arm of at most
//! the radius. The point moves by at most h speed before or after the middle, the arm by h turn
//! radius. Round ends contain balls, for which arms do not count. The intervals join without a gap
//! from 0 to 1, so the margin is kept at every time.
//!
//! # Rounding
//! Coordinates are whole numbers after multiplication by one power of two; the checker takes 2^64
//! times that power. Radii and distances e that are not whole then are rounded up.

mod motion_proof;
mod plane_search;
mod text;

pub(crate) use motion_proof::{motion_proof, tube_shape};
pub(crate) use plane_search::PlaneSearch;
pub(crate) use text::{Kind, MAX_BYTES, MIN_PIECE_BYTES, Shape, size_of, write_proof};
