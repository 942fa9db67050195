//! Every vertex of a chain moves straight at a constant speed of its own.
//!
//! # Speed of a point
//! The point at the share u of a link from a(t) to b(t) has the velocity `(1 - u) a' + u b'`. Its
//! length is a convex function of u. So between two shares it is at most the larger of the values
//! at these shares.
//!
//! # Turn of a link
//! **Definitions.** d(t) leads from the link's start to its end; d0 and d1 are its values at t = 0
//! and 1; `w = d1 - d0`; `n = d / |d|`. L is a lower bound on |d(t)| in the interval.
//!
//! **Claim 1.** n turns at most at the rate `|d0 x d1| / L^2`. **Proof.** `|n'| = |d x w| / |d|^2`,
//! and `d x w = d0 x w = d0 x d1` at all times.
//!
//! **Claim 2.** In the interval from t0 to t1, `|d(t)| >= min(m . d(t0), m . d(t1))` for any unit
//! vector m. **Proof.** `|d| >= m . d`, which is linear in t. We take m along d where |d| is least:
//! at `t = -<d0, w> / |w|^2`, or at the nearer end of the interval.
//!
//! # Rounding
//! - A difference of two points is off by u in each coordinate. So d0, d1 and d(t) are off by u
//!   relative to |d0| and |d1|, wherever the link is, and `d0 x d1` by less than `8 u |d0| |d1|`.
//! - The vertices of a shape are off by `e = 9 u reach` each, where reach bounds all coordinates.
//!   So the direction of a computed link is off by `2 e / |d|`, less than `32 u reach / |d|`.
//! - A link at least as long as its radius therefore moves its rims by less than `32 u reach`; the
//!   slack of a placed tube includes this. The faces of a shorter link are tilted by it
//!   (`tilt_faces`).
//!
//! # A link that loses its length
//! It is marked. In an interval in which its length may vanish, queries treat its flat ends as
//! round. A round end contains both (`cap_persistence`).

use super::{CommonFrame, DisplacementBound, Motion, Speed};
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::{RobotError, check_chain, direction, has_direction, length, without_length};
use parry3d_f64::math::{Pose, Real, Vector};

/// The motion of a chain whose vertices move straight at constant speed.
///
/// This is linear interpolation of two centrelines, as planners use it. Links become shorter or
/// longer in between. Points are in the mesh's frame.
///
/// The sections of the motion are its links. A segment without length both at the start and at the
/// end of the motion is not a link, as in a [`Chain`](crate::Chain): it is not counted among the
/// sections, and its radius is no step. The same holds for a segment that is too short for its
/// radius. A link that loses its length for an instant is a ball at that instant.
/// ```
/// use parry_continuum::{LinearMotion, parry::math::Vector, verify_motion};
///
/// let from = [Vector::ZERO, Vector::new(0.0, 0.0, 10.0), Vector::new(0.0, 0.0, 20.0)];
/// let to = [Vector::ZERO, Vector::new(1.0, 0.0, 10.0), Vector::new(4.0, 0.0, 19.0)];
/// let motion = LinearMotion::chain(&from, &to, &[1.0, 0.5])?;
/// verify_motion(&motion, 100)?;
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearMotion {
    from: Vec<Vector>,
    to: Vec<Vector>,
    radii: Vec<Real>,
    /// The input segments of the links.
    segments: Vec<u32>,
    /// `None` for capsules; otherwise the links that may lose their direction.
    fading: Option<Vec<usize>>,
    /// The largest absolute coordinate.
    reach: Real,
    /// The velocity that all vertices share within rounding, and the largest difference from it.
    shared: Option<(Vector, Real)>,
}

impl LinearMotion {
    /// Builds the motion with two round caps per link, as
    /// [`Chain::capsules`](crate::Chain::capsules).
    ///
    /// `from` and `to` are the points at t = 0 and 1, `segment_radii` one radius per segment.
    ///
    /// ```
    /// use parry_continuum::parry::{math::Vector, shape::Ball};
    /// use parry_continuum::{LinearMotion, proximity::BvhSearch};
    ///
    /// let (vertices, triangles) = Ball::new(10.0).to_trimesh(64, 32);
    /// let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    /// let (from, to) = ([Vector::ZERO, Vector::Z * 8.0], [Vector::X, Vector::new(1.0, 0.0, 8.0)]);
    /// // The flat tip keeps 1 mm, the round one does not.
    /// assert!(
    ///     search.clears_motion(&LinearMotion::chain(&from, &to, &[1.0])?, 1.0, 1e-3)?.is_clear()
    /// );
    /// assert!(
    ///     !search
    ///         .clears_motion(&LinearMotion::capsules(&from, &to, &[1.0])?, 1.0, 1e-3)?
    ///         .is_clear()
    /// );
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// - different numbers of points;
    /// - a point or a radius that [`Chain::capsules`](crate::Chain::capsules) refuses;
    /// - no segment has a length at the start or at the end of the motion. At one of the two all
    ///   points may be equal: a robot that grows out of a point is a ball there.
    pub fn capsules(
        from: &[Vector],
        to: &[Vector],
        segment_radii: &[Real],
    ) -> Result<Self, RobotError> {
        Self::new(from, to, segment_radii)
    }

    /// Builds the motion with the caps of
    /// [`Chain::from_centreline`](crate::Chain::from_centreline) at each time.
    ///
    /// Arguments as for [`capsules`](Self::capsules). Caps may change during the motion:
    ///
    /// - The robot's two ends and the wider side of each step in radius are always flat.
    /// - Another link's end is flat while it is less than a radius behind such a face, and round
    ///   otherwise. At the change the shape jumps. If the jump decides the margin, the answer is
    ///   `Undecided`.
    ///
    /// A chain by vertex radii ([`Chain::from_vertex_radii`](crate::Chain::from_vertex_radii)),
    /// with the smaller radius of each segment's two points, has the same caps with two exceptions:
    /// a single thick point, and the first joint after a thick tube that is shorter than its
    /// radius. For these caps implement [`Motion`] and call
    /// [`Tube::set_chain`](crate::Tube::set_chain), which accepts both kinds of chain.
    ///
    /// # Errors
    /// As [`capsules`](Self::capsules).
    pub fn chain(
        from: &[Vector],
        to: &[Vector],
        segment_radii: &[Real],
    ) -> Result<Self, RobotError> {
        let mut motion = Self::new(from, to, segment_radii)?;
        motion.fading = Some(motion.fading_links());
        Ok(motion)
    }

    fn new(from: &[Vector], to: &[Vector], radii: &[Real]) -> Result<Self, RobotError> {
        if from.len() != to.len() {
            return Err(RobotError::PointsDiffer { from: from.len(), to: to.len() });
        }
        for (name, points) in [("from", from), ("to", to)] {
            check_chain([name, "segment_radii"], points, radii, points.len().saturating_sub(1))?;
        }
        // As in chains. A segment that is too short at both ends is too short in between.
        let has_length =
            |k: &usize| [from, to].iter().any(|p| has_direction(p[*k], p[*k + 1], radii[*k]));
        let segments: Vec<_> = (0..radii.len()).filter(has_length).collect();
        let Some(&first) = segments.first() else {
            return Err(without_length(from, radii, "segment_radii"));
        };
        let vertices = || std::iter::once(first).chain(segments.iter().map(|k| k + 1));
        let (from, to): (Vec<_>, Vec<_>) = vertices().map(|k| (from[k], to[k])).unzip();
        let reach =
            from.iter().chain(&to).fold(0.0, |most: Real, p| most.max(p.abs().max_element()));
        // Differences of rounded points are off by u each.
        let (low, high) = from
            .iter()
            .zip(&to)
            .map(|(from, to)| *to - *from)
            .fold((Vector::INFINITY, Vector::NEG_INFINITY), |(low, high), way| {
                (low.min(way), high.max(way))
            });
        let middle = 0.5 * low + 0.5 * high;
        let most =
            length(high - middle).max(length(middle - low)) + 4.0 * Real::UNIT_ROUNDOFF * reach;
        let shared = (most <= 16.0 * Real::UNIT_ROUNDOFF * reach).then_some((middle, most));
        Ok(Self {
            shared,
            radii: segments.iter().map(|&k| radii[k]).collect(),
            segments: segments.iter().map(|&k| k as u32).collect(),
            fading: None,
            from,
            to,
            reach,
        })
    }

    /// Returns d0 and d1 of a link.
    fn link(&self, link: usize) -> [Vector; 2] {
        [&self.from, &self.to].map(|points| points[link + 1] - points[link])
    }

    /// Returns the velocity of a vertex.
    fn velocity(&self, vertex: usize) -> Vector {
        self.to[vertex] - self.from[vertex]
    }

    /// Returns an upper bound on the rounding error of a few coordinates.
    fn rounding(&self) -> Real {
        16.0 * Real::UNIT_ROUNDOFF * self.reach
    }

    /// Returns the links that may lose their direction.
    fn fading_links(&self) -> Vec<usize> {
        let has_direction = |&link: &usize| {
            least_length(self.link(link), [0.0, 1.0]) > 2.0 * self.rounding() + self.needed(link)
        };
        (0..self.radii.len()).filter(|link| !has_direction(link)).collect()
    }

    /// The length above which a link has a direction. (`has_direction` accepts far less.)
    fn needed(&self, link: usize) -> Real {
        1e-100 * self.radii[link]
    }

    /// Returns an upper bound on the angular speed of a link (claim 1).
    fn turn(&self, link: usize, times: [Real; 2]) -> Real {
        // The angle does not depend on the scale, and near 1 no product underflows.
        let [first, last] = self.link(link);
        let scale = first.abs().max(last.abs()).max_element().power_of_two_to_unity();
        let [first, last] = [first * scale, last * scale];
        // Covers fewer than 32 roundings.
        let up = 1.0 + 32.0 * Real::UNIT_ROUNDOFF;
        let sizes = first.length() * last.length();
        let cross = first.cross(last).length() + 8.0 * Real::UNIT_ROUNDOFF * sizes;
        if cross == 0.0 {
            return 0.0;
        }
        let least = least_length([first, last], times);
        if least > self.needed(link) * scale { cross / least / least * up } else { Real::INFINITY }
    }
}

impl Motion for LinearMotion {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        let points = self.from.iter().zip(&self.to).map(|(&from, &to)| from + (to - from) * t);
        tube.set_links(points, &self.radii, &self.segments, self.fading.is_some());
        if let Some(fading) = &self.fading {
            for (link, radius) in self.radii.iter().enumerate() {
                let length = tube.length_of(link);
                if length < *radius {
                    tube.tilt_faces(link, 2.0 * self.rounding() / length);
                }
            }
            fading.iter().for_each(|&link| tube.mark_fading(link));
        }
        Ok(Pose::IDENTITY)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        if section >= self.radii.len() {
            return Speed { point: 0.0, turn: 0.0 };
        }
        // Covers fewer than 32 roundings each of differences, squares and quotients.
        let up = 1.0 + 32.0 * Real::UNIT_ROUNDOFF;
        let [start, end] = [self.velocity(section), self.velocity(section + 1)];
        let speed = |share: Real| length(start + (end - start) * share);
        let point = speed(shares[0]).max(speed(shares[1])) * up + self.rounding();
        Speed { point, turn: self.turn(section, times) }
    }

    /// A point at a share of a link moves straight at constant speed, as the link's ends do.
    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        if section >= self.radii.len() {
            return None;
        }
        let [start, end] = [self.velocity(section), self.velocity(section + 1)];
        let apart = times[1] - times[0];
        let ways = shares.map(|share| (start + (end - start) * share) * apart);
        // Two places and a displacement, each off by a few roundings.
        Some(DisplacementBound { ways, off: 8.0 * self.rounding() })
    }

    /// A shift that all vertices share.
    fn common_frame(&self, _: [Real; 2]) -> Option<CommonFrame> {
        self.shared.map(|(velocity, _)| CommonFrame::shifting(velocity))
    }

    fn speed_in_frame(&self, section: usize, _: [Real; 2], times: [Real; 2]) -> Speed {
        let Some((_, most)) = self.shared else {
            return Speed { point: Real::INFINITY, turn: Real::INFINITY };
        };
        let turn = if section < self.radii.len() { self.turn(section, times) } else { 0.0 };
        Speed { point: most + self.rounding(), turn }
    }
}

/// Returns a lower bound on |d(t)| between two times (claim 2).
fn least_length([first, last]: [Vector; 2], times: [Real; 2]) -> Real {
    let at = |t: Real| first * (1.0 - t) + last * t;
    let change = last - first;
    let fastest = -first.dot(change) / change.length_squared();
    // Without a change the quotient is NaN, and any time is right.
    let time = if fastest > times[0] { fastest.min(times[1]) } else { times[0] };
    let direction = direction(at(time));
    // Both vectors are off by u, as are weights, products, sums and the direction: less than 16 u
    // in total.
    let rounding =
        |t: Real| 16.0 * Real::UNIT_ROUNDOFF * (first.length() * (1.0 - t) + last.length() * t);
    let least = times.map(|t| direction.dot(at(t)) - rounding(t));
    least[0].min(least[1]).max(0.0)
}
