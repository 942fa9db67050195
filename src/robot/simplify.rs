//! The fewest links that stand for a finely sampled centreline.
//!
//! A chord may replace a stretch of the centreline if the two are within the tolerance of each
//! other, in both directions (Hausdorff distance). One direction says it all:
//!
//! 1. From the stretch to the chord: the distance to the chord is convex along each segment, so it
//!    is greatest at a vertex. The direction holds if every vertex is within the tolerance of the
//!    chord.
//! 2. From the chord to the stretch: the stretch runs from the chord's one end to its other without
//!    a gap, so for every point c of the chord some point q of the stretch lies in the plane
//!    through c perpendicular to the chord. Then c is the point of the chord nearest to q, and |q -
//!    c| is within the tolerance by 1.
//!
//! So hooks and stretches that run back on themselves need no test of their own. The distance must
//! be to the chord, not to its line: a hook that overshoots the end must not pass.
//!
//! If a long chord fails a shorter one may fail too, and the reverse, so no greedy choice is safe.
//! The fewest links are a shortest path over admissible chords, found breadth first between each
//! two vertices that must stay. A vertex is settled by the first chord that reaches it.
//!
//! # What it costs
//! From most vertices there is nothing left to settle within reach, and that must be seen at once:
//!
//! 1. The wall (`sight.rs`) that ended the search from the vertex before mostly stands here too:
//!    nothing behind it can be reached. That is one comparison.
//! 2. Before the wall, the vertex that ruled out the last chord mostly rules out the next. One
//!    comparison a target.
//! 3. Only if that fails does a search walk to the wall, vertex by vertex, and it decides nearly
//!    all chords on the way. Those that it leaves in question are compared with vertex after
//!    vertex.
//!
//! On a smooth curve there are a few walks a link, and a comparison or two from every other vertex.
//! To that comes, for each link, a part of the square of the number of points that it replaces: for
//! chords that a walk leaves in question, and for targets before a wall. Where links replace
//! hundreds of points it is the larger part. Where the chords that hold and those that do not
//! alternate, as with noise about as large as the tolerance, every vertex costs a walk: as many
//! steps as vertices times those that a chord spans. At worst every chord of a stretch is compared
//! with all its vertices, the cube of their number.

use super::RobotError;
use super::compare::ToleranceSegment;
use super::radius_runs::RadiusRuns;
use super::sight::{Sight, SightLimit};
use parry3d_f64::math::{Real, Vector};

/// The fewest links that follow a centreline within a tolerance: their points and segment radii,
/// ready for any constructor of a [`Chain`](crate::Chain).
///
/// The points are a subset of the input's, in order. Both ends stay, and so does every point where
/// the radius changes. Each new segment and the stretch of the input that it replaces are within
/// `tolerance` of each other: no point of either is further than that from the other (Hausdorff
/// distance). No other choice of points with these properties has fewer links. `tolerance` is in
/// the unit of the points. With 0, only points exactly on the new segments go, and the centreline
/// keeps its shape; points meant to be on an oblique straight line seldom are after rounding, so
/// give those the rounding error as tolerance.
///
/// On a smooth curve the time grows with the number of points, while links replace few of them, and
/// with its square where they replace hundreds. At worst, with noise about as large as the
/// tolerance or with loops, it can grow with the cube of the points between two changes of radius;
/// where time must be bounded, [`stations`](crate::stations) needs a few more links and time in
/// proportion to the points.
///
/// Repeated points are dropped first, together with the radius of the segment without length
/// between them. (If that radius differs from a neighbour's the point counts as a change of
/// radius.) A new segment always has a length: a loop is not replaced by the point where it closes,
/// however large the tolerance.
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
/// As [`Chain::from_centreline`](crate::Chain::from_centreline), and a tolerance that is not finite
/// or negative.
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

/// The search for the fewest chords of a stretch.
struct Search<'a> {
    stretch: &'a [Vector],
    tolerance: Real,
    /// Where the path to each vertex that is settled comes from. The first vertex has no need of
    /// it.
    previous: Vec<Option<usize>>,
    /// The first vertex that is not settled.
    first_open: usize,
    /// The settled vertices in the order in which they were.
    queue: Vec<usize>,
    /// What last ruled out a chord.
    obstacle: usize,
    /// What last ended a walk.
    wall: Option<SightLimit>,
    /// Comparisons of a vertex with a chord or a gate.
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

    /// The vertices after the first that a shortest path of admissible chords from the first to the
    /// last visits.
    fn fewest_chords(mut self) -> Vec<usize> {
        let last = self.stretch.len() - 1;
        self.settle(last);
        let mut path: Vec<_> =
            std::iter::successors(Some(last), |&vertex| self.previous[vertex]).collect();
        path.pop();
        path.reverse();
        path
    }

    /// Settles vertices, those nearest in links first and of these the farthest first, until the
    /// last one is.
    fn settle(&mut self, last: usize) {
        let sight = Sight::new(self.stretch, self.tolerance);
        let mut targets = Vec::new();
        let mut next = 0;
        while self.previous[last].is_none() {
            // The queue never runs dry before the last vertex is reached: each vertex reaches the
            // one after it.
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

    /// Whether walls that are known or likely, and the last obstacle, rule out every open vertex,
    /// without a walk.
    fn sees_nothing_new(&self, from: usize, sight: &Sight) -> bool {
        let first = self.first_open.max(from + 1);
        // On an arc, a wall is nearest if its distances are as 1 to 1 + sqrt(2).
        let likely = SightLimit::new(from + (first - from) * 12 / 29, first);
        // The one that is known first, if it leaves no more vertices in question.
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
        // No more comparisons than a walk would cost.
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

    /// Whether every vertex of the stretch in between is within the tolerance of a chord.
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

    /// Comparisons for a sine of so many points within 1e-3, and its links.
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

    /// The same curve with ever more points: far fewer comparisons than there are pairs of
    /// vertices.
    #[test]
    fn most_pairs_are_never_compared() {
        for count in [500, 1000, 2000, 4000, 8000] {
            let (steps, links) = steps(count);
            let count = count as usize;
            assert!(links < 90, "{links}");
            // Linear, but for a part of the square of what a link replaces, for every link.
            let limit = 12 * count + count * count / links / 3;
            assert!(steps < limit, "{count}: {steps}, {limit}");
        }
    }
}
