//! The fewest links that replace a finely sampled centreline.
//!
//! # Definitions
//! - Run: the vertices between two vertices that must stay. Chord: a segment between two vertices
//!   of a run; it replaces the part of the run between them.
//! - A chord is *admissible* if it and the part that it replaces are within the tolerance of each
//!   other (Hausdorff distance), and its length is not 0.
//!
//! # Claim
//! A chord is admissible if every vertex between its ends is within the tolerance of the chord.
//!
//! # Proof
//! 1. **From the run to the chord.** The distance to the chord is convex along each segment, so it
//!    is largest at a vertex.
//! 2. **From the chord to the run.** Let c be a point of the chord. The run connects the ends of
//!    the chord without a gap. So a point q of the run lies in the plane through c perpendicular to
//!    the chord. Then c is the point of the chord nearest to q, and `|q - c|` is within the
//!    tolerance by 1.
//!
//! So hooks and parts that run backwards need no test of their own. The distance is to the chord,
//! not to its line: a hook that overshoots the end must fail.
//!
//! # Algorithm
//! If a long chord fails, a shorter one may hold, and the reverse. So no greedy choice is safe. The
//! fewest links are a shortest path over admissible chords, found breadth first in each run. The
//! first chord that reaches a vertex settles it. From most vertices no unsettled vertex can be
//! reached; three tests find that out, cheapest first:
//!
//! 1. **Wall.** The wall (`sight.rs`) that ended the last walk usually holds for the next vertex
//!    too: nothing behind it can be reached. Cost: one comparison.
//! 2. **Obstacle.** Before the wall, the vertex that ruled out the last chord usually rules out the
//!    next one. Cost: one comparison per target.
//! 3. **Walk.** Otherwise a walk goes vertex by vertex to the wall and decides nearly all chords.
//!    Chords left open are compared with each vertex in between.
//!
//! # Cost
//! Let n be the number of vertices of a run and m the number that a link replaces.
//!
//! - On a smooth curve: a few walks per link, and one or two comparisons per other vertex. Each
//!   link adds a part of `m^2`, for chords that a walk leaves open and for targets before a wall.
//!   This part dominates if m is in the hundreds.
//! - With noise about as large as the tolerance, admissible and other chords alternate. Every
//!   vertex then costs a walk: `n m` steps.
//! - At worst every chord is compared with all its vertices: `n^3`.

use super::RobotError;
use super::compare::ToleranceSegment;
use super::sight::{Sight, SightLimit};
use super::stations::RadiusRuns;
use parry3d_f64::math::{Real, Vector};

/// Finds the fewest links that follow a centreline within a tolerance.
///
/// Returns points and segment radii, ready for any constructor of a [`Chain`](crate::Chain). The
/// points are a subset of the input's, in order. Both ends stay, and so does every point at which
/// the radius changes. Each new segment and the part of the input that it replaces are within
/// `tolerance` of each other (Hausdorff distance). No other choice of points with these properties
/// has fewer links.
///
/// - `points`, `segment_radii`: as for [`Chain::from_centreline`](crate::Chain::from_centreline).
/// - `tolerance`: in the unit of the points. With 0, only points exactly on the new segments are
///   removed. Rounded points of an oblique straight line are seldom exactly on it: use the rounding
///   error as tolerance for such lines.
///
/// On a smooth curve the time is proportional to the number of points if links replace few points.
/// It grows with the square of that number if links replace hundreds. At worst, with noise about as
/// large as the tolerance or with loops, it grows with the cube of the points between two changes
/// of radius. For bounded time use [`stations`](crate::stations): it takes a few more links and
/// time proportional to the points.
///
/// Repeated points are removed first, with the radius of the segment between them. (If that radius
/// differs from a neighbour's, the point counts as a change of radius.) A new segment always has a
/// length: a loop is never replaced by the point where it closes.
///
/// ```
/// use parry_continuum::{parry::math::Vector, simplify};
///
/// let arc: Vec<_> = (0..=90).map(|i| f64::from(i).to_radians().sin_cos()).collect();
/// let arc: Vec<_> = arc.iter().map(|&(sin, cos)| Vector::new(cos, sin, 0.0)).collect();
/// let (points, radii) = simplify(&arc, &[0.1; 90], 0.01)?;
/// assert_eq!(points.len(), 7);
/// assert_eq!(radii, [0.1; 6]);
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
///
/// # Errors
/// As [`Chain::from_centreline`](crate::Chain::from_centreline); a tolerance that is negative or
/// not finite.
pub fn simplify(
    points: &[Vector],
    segment_radii: &[Real],
    tolerance: Real,
) -> Result<(Vec<Vector>, Vec<Real>), RobotError> {
    let stretches = RadiusRuns::of(points, segment_radii, tolerance)?;
    let (mut kept, mut radii) = (vec![stretches.first_point()], vec![]);
    for stretch in stretches.iter() {
        let path = Search::new(stretch.points, tolerance).fewest_chords();
        radii.resize(radii.len() + path.len(), stretch.radius);
        kept.extend(path.into_iter().map(|vertex| stretch.points[vertex]));
    }
    Ok((kept, radii))
}

/// Breadth-first search for the fewest chords of a run.
struct Search<'a> {
    stretch: &'a [Vector],
    tolerance: Real,
    /// The predecessor of each settled vertex. The first vertex has none.
    previous: Vec<Option<usize>>,
    /// The first vertex that is not settled.
    first_open: usize,
    /// The settled vertices, in the order of settling.
    queue: Vec<usize>,
    /// The vertex that last ruled out a chord (test 2).
    obstacle: usize,
    /// The wall that ended the last walk (test 1).
    wall: Option<SightLimit>,
    /// Number of comparisons of a vertex with a chord or a gate.
    #[cfg(test)]
    steps: std::cell::Cell<usize>,
}

impl<'a> Search<'a> {
    fn new(stretch: &'a [Vector], tolerance: Real) -> Self {
        Self {
            stretch,
            tolerance,
            previous: vec![None; stretch.len()],
            first_open: 1,
            queue: vec![0],
            obstacle: 0,
            wall: None,
            #[cfg(test)]
            steps: Default::default(),
        }
    }

    /// Returns the vertices of a shortest path of admissible chords, without the first vertex.
    fn fewest_chords(mut self) -> Vec<usize> {
        let last = self.stretch.len() - 1;
        self.settle(last);
        let mut path: Vec<_> =
            std::iter::successors(Some(last), |&vertex| self.previous[vertex]).collect();
        path.pop();
        path.reverse();
        path
    }

    /// Settles vertices in order of their number of links, and farthest first among equals, until
    /// `last` is settled.
    fn settle(&mut self, last: usize) {
        let sight = Sight::new(self.stretch, self.tolerance);
        let mut targets = Vec::new();
        let mut next = 0;
        while self.previous[last].is_none() {
            // The queue cannot run dry: each vertex reaches the next one.
            let from = self.queue[next];
            next += 1;
            while self.previous[self.first_open].is_some() {
                self.first_open += 1;
            }
            if self.sees_nothing_new(from, &sight) {
                continue;
            }
            let previous = &self.previous;
            self.wall = sight.look(from, |vertex| previous[vertex].is_none(), &mut targets);
            self.count(self.wall.map_or(last, SightLimit::vertex) - from);
            for target in targets.iter().rev() {
                let to = target.vertex;
                if target.is_sure || self.is_admissible(from, to) {
                    self.previous[to] = Some(from);
                    self.queue.push(to);
                    if to == last {
                        return;
                    }
                }
            }
        }
    }

    /// Returns whether tests 1 and 2 rule out every unsettled vertex without a walk.
    fn sees_nothing_new(&self, from: usize, sight: &Sight) -> bool {
        let first = self.first_open.max(from + 1);
        // On an arc, the nearest wall has distances in the ratio 1 : 1 + sqrt(2) (12 / 29).
        let likely = SightLimit::new(from + (first - from) * 12 / 29, first);
        // The known wall first, if it leaves no more vertices open.
        let known = self.wall;
        let order = match known {
            Some(wall) if wall.vertex() <= first => [known, Some(likely)],
            _ => [Some(likely), known],
        };
        let wall = order.into_iter().flatten().find(|&wall| {
            self.count(1);
            sight.is_wall(from, wall)
        });
        let end = wall.map_or(self.stretch.len() - 1, SightLimit::vertex) + 1;
        // At most as many comparisons as a walk.
        end < first + (first - from)
            && (first..end).filter(|&to| self.previous[to].is_none()).all(|to| {
                self.count(1);
                self.stretch[from] == self.stretch[to]
                    || from < self.obstacle
                        && self.obstacle < to
                        && !ToleranceSegment::new(
                            self.stretch[from],
                            self.stretch[to],
                            self.tolerance,
                        )
                        .has_near(self.stretch[self.obstacle])
            })
    }

    /// Returns whether a chord is admissible (see the claim above).
    fn is_admissible(&mut self, from: usize, to: usize) -> bool {
        if self.stretch[from] == self.stretch[to] {
            return false;
        }
        let chord = ToleranceSegment::new(self.stretch[from], self.stretch[to], self.tolerance);
        let is_off = |&vertex: &usize| {
            self.count(1);
            !chord.has_near(self.stretch[vertex])
        };
        let suspect = (from < self.obstacle && self.obstacle < to).then_some(self.obstacle);
        let found = suspect.into_iter().chain(from + 1..to).find(is_off);
        self.obstacle = found.unwrap_or(self.obstacle);
        found.is_none()
    }

    #[cfg(test)]
    fn count(&self, steps: usize) {
        self.steps.set(self.steps.get() + steps);
    }

    #[cfg(not(test))]
    fn count(&self, _: usize) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the comparisons and the links for a sine of `count` points within 1e-3.
    fn steps(count: u32) -> (usize, usize) {
        let point = |k| {
            let x = 10.0 * Real::from(k) / Real::from(count);
            Vector::new(x, x.sin(), 0.0)
        };
        let points: Vec<_> = (0..=count).map(point).collect();
        let mut search = Search::new(&points, 1e-3);
        search.settle(points.len() - 1);
        let steps = search.steps.get();
        (steps, search.fewest_chords().len())
    }

    /// With ever more points on one curve, the comparisons stay far below the pairs of vertices.
    #[test]
    fn most_pairs_are_never_compared() {
        for count in [500, 1000, 2000, 4000, 8000] {
            let (steps, links) = steps(count);
            let count = count as usize;
            assert!(links < 90, "{links}");
            // Linear, plus a part of m^2 per link.
            let limit = 12 * count + count * count / links / 3;
            assert!(steps < limit, "{count}: {steps}, {limit}");
        }
    }
}
