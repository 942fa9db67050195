//! The fewest links that stand for a finely sampled centreline.
//!
//! A chord may replace a stretch of the centreline if the two are within the tolerance of each other, in both
//! directions (Hausdorff distance). One direction says it all:
//!
//! 1. From the stretch to the chord: the distance to the chord is convex along each segment, so it is greatest at
//!    a vertex. The direction holds if every vertex is within the tolerance of the chord.
//! 2. From the chord to the stretch: the stretch runs from the chord's one end to its other without a gap, so for
//!    every point c of the chord some point q of the stretch lies in the plane through c perpendicular to the
//!    chord. Then c is the point of the chord nearest to q, and |q - c| is within the tolerance by 1.
//!
//! So hooks and stretches that run back on themselves need no test of their own. The distance must be to the
//! chord, not to its line: a hook that overshoots the end must not pass.
//!
//! If a long chord fails a shorter one may fail too, and the reverse, so no greedy choice is safe. The fewest links
//! are a shortest path over admissible chords, found breadth first between each two vertices that must stay. A
//! vertex is settled by the first chord that reaches it. One that has just ruled out a chord is asked first about
//! the next: most chords fail at once, and the search usually costs about the square of the number of vertices.

use super::RobotError;
use super::chain::check;
use super::compare::is_within;
use parry3d_f64::math::{Real, Vector};

/// The fewest links that follow a centreline within a tolerance: their points and segment radii, ready for any
/// constructor of a [`Chain`](crate::Chain).
///
/// The points are a subset of the input's, in order. Both ends stay, and so does every point where the radius
/// changes. Each new segment and the stretch of the input that it replaces are within `tolerance` of each other:
/// no point of either is further than that from the other (Hausdorff distance). No other choice of points with
/// these properties has fewer links. `tolerance` is in the unit of the points. With 0, only points exactly on the
/// new segments go, and the centreline keeps its shape; points meant to be on an oblique straight line seldom are
/// after rounding, so give those the rounding error as tolerance.
///
/// Repeated points are dropped first, together with the radius of the segment without length between them. (If
/// that radius differs from a neighbour's the point counts as a change of radius.) A new segment always has a
/// length: a loop is not replaced by the point where it closes, however large the tolerance.
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
/// As [`Chain::from_centreline`](crate::Chain::from_centreline), and a tolerance that is not finite or negative.
pub fn simplify(
    points: &[Vector],
    segment_radii: &[Real],
    tolerance: Real,
) -> Result<(Vec<Vector>, Vec<Real>), RobotError> {
    check(points, segment_radii, points.len().saturating_sub(1))?;
    if !(0.0..Real::INFINITY).contains(&tolerance) {
        return Err(RobotError::BadTolerance { value: tolerance });
    }
    let (stations, must_stay) = stations(points, segment_radii);
    if stations.len() < 2 {
        return Err(RobotError::AllPointsEqual);
    }
    let (mut kept, mut radii) = (vec![stations[0].point], vec![]);
    for ends in must_stay.windows(2) {
        let stretch: Vec<_> = stations[ends[0]..=ends[1]].iter().map(|station| station.point).collect();
        for vertex in fewest_chords(&stretch, tolerance) {
            kept.push(stretch[vertex]);
            radii.push(stations[ends[1]].radius_before);
        }
    }
    Ok((kept, radii))
}

/// A point of the centreline that differs from the one before.
struct Station {
    point: Vector,
    /// Of the segment that ends here; at the first station, of the first segment.
    radius_before: Real,
}

/// The stations, and which of them must stay: the ends and those where the radius changes.
fn stations(points: &[Vector], segment_radii: &[Real]) -> (Vec<Station>, Vec<usize>) {
    let mut stations = vec![Station { point: points[0], radius_before: segment_radii[0] }];
    let mut must_stay = vec![0];
    let mut last_radius = segment_radii[0];
    for (ends, &radius) in points.windows(2).zip(segment_radii) {
        let here = stations.len() - 1;
        if radius != last_radius && must_stay.last() != Some(&here) {
            must_stay.push(here);
        }
        last_radius = radius;
        if ends[0] != ends[1] {
            stations.push(Station { point: ends[1], radius_before: radius });
        }
    }
    let tip = stations.len() - 1;
    if must_stay.last() != Some(&tip) {
        must_stay.push(tip);
    }
    (stations, must_stay)
}

/// The vertices after the first that a shortest path of admissible chords from the first to the last visits.
fn fewest_chords(stretch: &[Vector], tolerance: Real) -> Vec<usize> {
    let last = stretch.len() - 1;
    let mut previous: Vec<Option<usize>> = vec![None; stretch.len()];
    let mut queue = vec![0];
    let mut next = 0;
    while previous[last].is_none() {
        // The queue never runs dry before the last vertex is reached: each vertex reaches the one after it.
        let from = queue[next];
        next += 1;
        let mut obstacle = from;
        for to in (from + 1..=last).rev() {
            if previous[to].is_some() || stretch[from] == stretch[to] {
                continue;
            }
            let is_off = |&vertex: &usize| !is_within(stretch[vertex], stretch[from], stretch[to], tolerance);
            let suspects = (from < obstacle && obstacle < to).then_some(obstacle);
            match suspects.into_iter().chain(from + 1..to).find(is_off) {
                Some(vertex) => obstacle = vertex,
                None => {
                    previous[to] = Some(from);
                    queue.push(to);
                    if to == last {
                        break;
                    }
                }
            }
        }
    }
    let mut path: Vec<_> = std::iter::successors(Some(last), |&vertex| previous[vertex]).collect();
    path.pop();
    path.reverse();
    path
}
