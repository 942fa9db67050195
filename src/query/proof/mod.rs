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
//! **A piece lies in its body.** Let k = `curvature`, l = `length`, r = `radius`, h = half of the
//! interval. Let c be a curve by arc length with curvature at most k and length at most l. Its ends
//! are within `off_1` of the two points. Each point of the piece is within `off_2` of a point of a
//! disc or ball of radius r around a c(s), and `off_1 + off_2 <= off`. With a stated direction the
//! disc at c(s) and c'(s) differ from it by at most `tilt` + k s; without one each disc differs by
//! at most `tilt` from the plane across c'(s). The body has the radius R and e of free space:
//!
//! ```text
//! round ends        R = r + k l^2 / 8 + off              e = margin + h speed
//! flat, by chord    R = r + k l^2 / 8 + off              e = margin + h speed + h turn r
//! flat, stated      R = r + k l^2 / 2 + tilt l + off     e = margin + h speed + h turn r
//! ```
//!
//! *Theorem 1 (the sides).* Each c(s) is within k l^2 / 8 of the point on its chord at the same
//! share. *Proof.* The difference vanishes at both ends, and its second derivative is at most k, so
//! it is at most k s (l - s) / 2. The ends of c add at most `off_1`, the points of the piece
//! `off_2`. So all balls and discs lie in the capsule of radius R around the line between the
//! points.
//!
//! *Theorem 2 (flat ends by the chord).* If k l <= 1 and `4 off < |chord|`, a flat end is the disc
//! of radius R across the chord that is beyond its point by
//!
//! ```text
//! r (k l / 2 + tilt + (22 / 7) off / |chord|) + off.
//! ```
//!
//! *Proof.* Seen from c(s), the parts of lengths p and q, p + q = l, advance along its direction by
//! at least (sin kp + sin kq) / k, and across it by at most (2 - cos kp - cos kq) / k. The quotient
//! is at most tan(k l / 2). So c'(s) differs from the true chord by at most k l / 2. The true chord
//! is turned by an angle of sine at most 2 off / |chord| <= 1/2, so by at most (22 / 7) off /
//! |chord|. The sum of both angles is below pi / 2, so c advances along the given chord, and no
//! c(s) is farther than `off_1` beyond the points. A disc reaches beyond c(s) by at most r times
//! the sine of the sum and `tilt`. The half ball at a round end reaches back no farther: of its
//! points c(l) + v with v . c'(l) >= 0, none is farther than that behind the plane across the chord
//! there. So the part of the capsule that does not lie farther beyond a flat end contains the
//! piece.
//!
//! *Theorem 3 (a stated direction).* Let one end be flat with the direction T, out of the piece, a
//! = `tilt`, k r < 1 and k l + a <= 3/2. The body's axis follows T from r a + off ahead of the
//! point to l behind it, and by r (k l + a) + off more if the other end is flat. *Proof.* c(s) is
//! at most the integral of sin(k s + a), so k l^2 / 2 + a l, beside the line along T. A point of
//! its disc is ahead of the end of c by at most r sin(k s + a) minus the integral of cos(k s + a).
//! The derivative is (k r - 1) cos(k s + a) < 0, so this is largest at s = 0: r sin a. A disc is
//! behind the end by at most l + r sin(k l + a). A point of the half ball at a round end, beyond l,
//! is no farther from the axis' end there than R, and otherwise within R of the axis.
//!
//! **Motion.** A point of a disc or a half ball is a point of the centreline plus an arm of at most
//! the radius. The point moves by at most h speed before or after the middle, the arm by h turn
//! radius. Round ends contain balls, for which arms do not count. The intervals join without a gap
//! from 0 to 1, so the margin is kept at every time.
//!
//! # Rounding
//! Coordinates are whole numbers after multiplication by one power of two; the checker takes 2^64
//! times that power. Radii, distances e, and ways along an axis that are not whole then are rounded
//! up.

mod motion_proof;
mod plane_search;
mod text;

pub(crate) use motion_proof::{motion_proof, tube_shape};
pub(crate) use plane_search::PlaneSearch;
pub(crate) use text::{Kind, MAX_BYTES, MIN_PIECE_BYTES, Shape, size_of, write_proof};
