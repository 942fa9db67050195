//! Few links in place of a finely sampled centreline, as short as its bends require.
//!
//! # Definitions
//! - Run: the vertices between two changes of radius; rounding is no change ([`is_same`]). Station:
//!   a vertex that stays.
//! - Chord: a segment between two vertices of a run; it replaces the part of the run between them.
//! - A chord *holds* if it and the part that it replaces are within the tolerance of each other
//!   (Hausdorff distance), and its length is not 0.
//! - *Probe*: the largest distance of three vertices of the part that a chord replaces from the
//!   chord's line.
//! - *Share* of a chord: `sqrt(probe / tolerance)`. It grows in proportion to the chord's length,
//!   since a chord of length l deviates by `kappa l^2 / 8` from a curve of curvature kappa.
//!
//! All chords deviate equally if their lengths are proportional to `1 / sqrt(kappa)`. Curvature
//! from neighbouring samples would be mostly noise, so it is measured over chords.
//!
//! # Claim
//! A chord holds if every vertex between its ends is within the tolerance of the chord.
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
//! 1. **Walk.** From each station, predict the next one from the last share, probe it and correct
//!    it, until no later sample has a share within one. This gives the number of chords and their
//!    density.
//! 2. **Spread.** Place the same number of chords, each with the same share.
//! 3. **Verify.** Compare every vertex with its chord. If a chord fails, verify the walk's own
//!    stations instead. Divide each chord that fails: a chord grows from each
//!    station, doubling its segments while it holds.
//!
//! # Faces
//! A flat face is perpendicular to the chord that ends in it. Let u be the direction of the input's
//! first segment, v the chord's direction and r the radius.
//!
//! 1. **At the face.** The rim moves by at most `r |u - v|`, which must be within the tolerance.
//! 2. **Chords behind it.** These too are flat where Algorithm 1 has no room for a ball. The rim at
//!    a chord's start reaches `r |u x v|` ahead of its centre. This must be at most the tolerance
//!    plus the depth of the centre behind the face.
//!
//! So stations come closer together towards a face, while the rim requires more than the deviation
//! does, and at most to the depth r. A single segment of the input is always accepted; at the face
//! itself it has the face's direction.
//!
//! # Cost
//! A probe reads three vertices, a station takes at most [`PROBES`] probes, and there are no more
//! stations than samples. Every vertex is verified at most twice, and four more times where chords
//! are divided. So the cost is at most proportional to the number of points.

use super::RobotError;
use super::chain::check_segments;
use super::compare::ToleranceSegment;
use super::radius_steps::{is_same, is_step};
use super::scale::direction;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};
use std::borrow::Cow;

/// Replaces a finely sampled centreline by few links, within a tolerance of it.
///
/// Returns points and segment radii, ready for any constructor of a [`Chain`](crate::Chain). The
/// points are a subset of the input's, in order. Both ends stay, and so does every point at which
/// the radius changes by more than a share of 2^-32; of radii that are equal so far, the largest is
/// returned. Each new segment and the part of the input that it replaces are within
/// `tolerance` of each other (Hausdorff distance); this is verified. On a smooth curve there are
/// nearly as few links as possible, and all of them deviate equally.
///
/// - `points`, `segment_radii`: as for [`Chain::from_centreline`](crate::Chain::from_centreline).
/// - `tolerance`: in the unit of the points. With 0, only points exactly on the new segments are
///   removed. Rounded points of an oblique straight line are seldom exactly on it: use the rounding
///   error as tolerance for such lines.
///
/// The time is at most proportional to the number of points, for every shape.
///
/// **Faces** are followed too: both ends of the robot and the wider side of each step, where a
/// [`Chain`](crate::Chain) ends flat. The first segment there is so short that no point of the face
/// moves by more than `tolerance`. The input's face is perpendicular to its own last segment, so
/// sample as closely there as the face matters. This takes one or two links per face. It is worth
/// it: on a bent tube, a tilted face is the largest error of a fine chain.
///
/// Repeated points are removed first, with the radius of the segment between them. A new segment
/// always has a length: a loop is never replaced by the point where it closes.
///
/// ```
/// use parry_continuum::{parry::math::Vector, simplify};
///
/// let arc: Vec<_> = (0..=90).map(|i| f64::from(i).to_radians().sin_cos()).collect();
/// let arc: Vec<_> = arc.iter().map(|&(sin, cos)| Vector::new(cos, sin, 0.0)).collect();
/// let (points, radii) = simplify(&arc, &[0.0; 90], 0.01)?;
/// assert_eq!(points.len(), 7); // a wire has no faces: 15 degrees each
/// let (points, radii) = simplify(&arc, &[0.2; 90], 0.01)?;
/// assert_eq!(points.len(), 8); // short links at the faces: one more in all
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
    let (mut kept, mut radii) = (Vec::with_capacity(ROOM), Vec::with_capacity(ROOM));
    kept.push(stretches.first_point());
    let mut found = Vec::with_capacity(ROOM);
    let mut stretches = stretches.iter().peekable();
    let mut radius_before = Real::NEG_INFINITY;
    while let Some(stretch) = stretches.next() {
        let radius_after = stretches.peek().map_or(Real::NEG_INFINITY, |next| next.radius);
        let faces = [radius_before, radius_after].map(|beside| is_step(beside, stretch.radius));
        found.clear();
        StationRun::new(&stretch, tolerance, faces).divide(&mut found);
        kept.extend(found.iter().map(|&vertex| stretch.points[vertex]));
        radii.resize(radii.len() + found.len(), stretch.radius);
        radius_before = stretch.radius;
    }
    Ok((kept, radii))
}

/// Initial capacity for stations.
const ROOM: usize = 64;

/// Most probes per station.
const PROBES: usize = 8;

/// A run of one radius in which stations are placed.
struct StationRun<'a> {
    points: &'a [Vector],
    radius: Real,
    tolerance: Real,
    /// A power of two that scales the run near one. Squares then stay in the range of numbers.
    scale: Real,
    /// The input's directions at start and end, if a face there has a rim that can move too far.
    faces: [Option<Vector>; 2],
}

impl<'a> StationRun<'a> {
    fn new(stretch: &RadiusRun<'a>, tolerance: Real, is_face: [bool; 2]) -> Self {
        let (points, radius) = (stretch.points, stretch.radius);
        let start = points[0];
        let extent = points.iter().fold(Vector::ZERO, |extent, &p| extent.max((p - start).abs()));
        let scale = extent.max_element().power_of_two_to_unity();
        // In every direction, a rim moves by at most the diameter.
        let matters = 2.0 * radius > tolerance;
        let last = points.len() - 1;
        let faces = [
            (is_face[0] && matters).then(|| direction(points[1] - start)),
            (is_face[1] && matters).then(|| direction(points[last] - points[last - 1])),
        ];
        Self { points, radius, tolerance, scale, faces }
    }

    /// Appends the stations after the first vertex to `found`.
    fn divide(&self, found: &mut Vec<usize>) {
        let last = self.points.len() - 1;
        let graded = |face: Option<Vector>, vertex: usize, end: usize| {
            face.map_or(vec![], |direction| self.grade(vertex, end, direction))
        };
        let front = graded(self.faces[0], 0, last);
        let from = front.last().copied().unwrap_or(0);
        let back = graded(self.faces[1], last, from);
        let to = back.last().copied().unwrap_or(last);

        let ends = std::iter::once(0).chain(front.iter().copied());
        ends.zip(&front).for_each(|(from, &to)| self.verify_and_add(from, to, found));
        self.spread(from, to, found);
        let ends = back.iter().rev().copied().chain([last]);
        ends.clone().zip(ends.skip(1)).for_each(|(from, to)| self.verify_and_add(from, to, found));
    }

    /// Returns the stations next to a face while its rim requires closer ones than the deviation
    /// (see **Faces**). They run from the face's vertex and stop before `end`.
    fn grade(&self, face: usize, end: usize, direction: Vector) -> Vec<usize> {
        let mut stations = vec![];
        let vertex = |at: usize, steps: usize| if face < end { at + steps } else { at - steps };
        let (mut at, mut guess) = (face, 2);
        loop {
            let depth = direction.dot(self.points[at] - self.points[face]).abs();
            let share = |steps: usize| {
                let (from, to) = (at.min(vertex(at, steps)), at.max(vertex(at, steps)));
                let reach = if at == face {
                    self.rim_moves(from, to, direction)
                } else {
                    self.rim_reaches(from, to, direction)
                };
                if reach > 0.0 { reach / (self.tolerance + depth) } else { 0.0 }
            };
            let (steps, _) = foresee(guess, at.abs_diff(end), share);
            let next = vertex(at, steps);
            if depth > self.radius || next == end || self.share(at.min(next), at.max(next)) > 1.0 {
                return stations;
            }
            stations.push(next);
            (at, guess) = (next, 2 * steps);
        }
    }

    /// Appends stations after `from`, up to `to` (steps 1 to 3).
    fn spread(&self, from: usize, to: usize, found: &mut Vec<usize>) {
        let mut chords: Vec<(usize, Real)> = Vec::with_capacity(ROOM);
        let (mut at, mut guess) = (from, to - from);
        while at < to {
            let (steps, share) = foresee(guess, to - at, |steps| self.share(at, at + steps));
            at += steps;
            chords.push((at, share));
            guess = steps;
        }
        let before = found.len();
        if !self.spread_evenly(from, &chords, found) {
            found.truncate(before);
            let mut at = from;
            for (next, _) in chords {
                self.verify_and_add(at, next, found);
                at = next;
            }
        }
    }

    /// Appends one station per chord, each with an equal part of the sum of shares (step 2).
    ///
    /// Returns false if a chord fails.
    fn spread_evenly(&self, from: usize, chords: &[(usize, Real)], found: &mut Vec<usize>) -> bool {
        let whole: Real = chords.iter().map(|(_, share)| share).sum();
        let part = whole / chords.len() as Real;
        let mut ahead = chords.iter().scan((from, 0.0), |(start, passed), &(end, share)| {
            let chord = (*start, end, *passed, share);
            (*start, *passed) = (end, *passed + share);
            Some(chord)
        });
        let mut at = from;
        let Some(mut chord) = ahead.next() else { return true };
        for number in 1..=chords.len() {
            let target = number as Real * part;
            while chord.2 + chord.3 < target
                && let Some(next) = ahead.next()
            {
                chord = next;
            }
            let (start, end, passed, share) = chord;
            let is_last = number == chords.len();
            let next = if is_last {
                chords[number - 1].0
            } else {
                self.vertex_at((target - passed) / share, start, end)
            };
            if next <= at || !self.holds(at, next) {
                return false;
            }
            found.push(next);
            at = next;
        }
        true
    }

    /// Returns the first vertex after `start` beyond a fraction of the chord, at most `end`.
    fn vertex_at(&self, fraction: Real, start: usize, end: usize) -> usize {
        let chord = (self.points[end] - self.points[start]) * self.scale;
        let length = fraction * chord.length_squared();
        let is_before = |&p: &Vector| ((p - self.points[start]) * self.scale).dot(chord) < length;
        start + 1 + self.points[start + 1..end].partition_point(is_before)
    }

    /// Returns the share of a chord, from three of the vertices between its ends.
    fn share(&self, from: usize, to: usize) -> Real {
        let start = self.points[from];
        let chord = (self.points[to] - start) * self.scale;
        let cross_squared = [1, 2, 3].map(|quarter| {
            let vertex = self.points[from + (to - from) * quarter / 4];
            ((vertex - start) * self.scale).cross(chord).length_squared()
        });
        let largest = cross_squared.into_iter().fold(0.0, Real::max);
        let tolerance = self.tolerance * self.scale;
        // A closed loop has no chord.
        if chord == Vector::ZERO {
            Real::INFINITY
        } else if largest == 0.0 {
            0.0
        } else {
            ((largest / chord.length_squared()).sqrt() / tolerance).sqrt()
        }
    }

    /// Returns an upper bound on how far a face's rim moves if a chord replaces the input (case 1).
    fn rim_moves(&self, from: usize, to: usize, face: Vector) -> Real {
        self.radius * (direction(self.points[to] - self.points[from]) - face).length()
    }

    /// Returns how far the rim at a chord's end reaches ahead of its centre (case 2).
    fn rim_reaches(&self, from: usize, to: usize, face: Vector) -> Real {
        self.radius * direction(self.points[to] - self.points[from]).cross(face).length()
    }

    /// Appends the station `to`, preceded by as many others as needed (step 3).
    fn verify_and_add(&self, from: usize, to: usize, found: &mut Vec<usize>) {
        let mut at = from;
        if self.holds(from, to) {
            at = to;
            found.push(to);
        }
        while at < to {
            let mut steps = 1;
            while at + steps < to {
                let twice = (2 * steps).min(to - at);
                if !self.holds(at, at + twice) {
                    break;
                }
                steps = twice;
            }
            at += steps;
            found.push(at);
        }
    }

    /// Returns whether a chord, and the rim of a face at its end, are within the tolerance.
    fn holds(&self, from: usize, to: usize) -> bool {
        let ends = [(0, from), (self.points.len() - 1, to)];
        let is_face_fine = |(face, (vertex, end)): (&Option<Vector>, (usize, usize))| {
            vertex != end
                || face.is_none_or(|face| self.rim_moves(from, to, face) <= self.tolerance)
        };
        let (start, end) = (self.points[from], self.points[to]);
        // A single segment replaces itself.
        from + 1 == to
            || start != end && self.faces.iter().zip(ends).all(is_face_fine) && {
                let chord = ToleranceSegment::new(start, end, self.tolerance);
                self.points[from + 1..to].iter().all(|&p| chord.has_near(p))
            }
    }
}

/// Returns the largest number of steps, from 1 to `most`, whose share is at most one, and that
/// share. Exact if the share is proportional to the steps, and usually close otherwise.
fn foresee(guess: usize, most: usize, share: impl Fn(usize) -> Real) -> (usize, Real) {
    let (mut good, mut bad) = ((1, 0.0), (most + 1, 0.0));
    // One step is always accepted, and its share of 0 carries no information.
    let mut steps = guess.max(2).min(most);
    for _ in 0..PROBES {
        let probed = share(steps);
        if probed <= 1.0 {
            good = (steps, probed);
        } else {
            bad = (steps, probed);
        }
        // With tolerance 0 a share is infinite or 0: bisect.
        let ideal = if probed < Real::INFINITY {
            (steps as Real / probed) as usize
        } else {
            (good.0 + bad.0) / 2
        };
        steps = ideal.clamp(good.0, (bad.0 - 1).max(good.0));
        if steps == good.0 {
            break;
        }
    }
    if good.0 == 1 { (1, (bad.1 / bad.0 as Real).min(1.0)) } else { good }
}

/// A centreline without repeated points, with the indices of the points that must stay.
struct RadiusRuns<'a> {
    points: Cow<'a, [Vector]>,
    /// The two ends and each change of radius, ascending.
    must_stay: Vec<usize>,
    /// The radius of each run between two points that must stay.
    radii: Vec<Real>,
}

/// The points of one run. Both ends must stay, and no two consecutive points are equal.
struct RadiusRun<'a> {
    points: &'a [Vector],
    radius: Real,
}

impl<'a> RadiusRuns<'a> {
    /// Splits a centreline, to be simplified within a tolerance, into runs.
    ///
    /// A segment without length is removed with its radius.
    ///
    /// # Errors
    /// As [`check_segments`]; a tolerance that is negative or not finite; all points equal.
    fn of(
        points: &'a [Vector],
        segment_radii: &'a [Real],
        tolerance: Real,
    ) -> Result<Self, RobotError> {
        check_segments(points, segment_radii)?;
        if !(0.0..Real::INFINITY).contains(&tolerance) {
            return Err(RobotError::Negative { parameter: "tolerance", value: tolerance });
        }
        let has_repeats = points.windows(2).any(|ends| ends[0] == ends[1]);
        let mut distinct = Vec::with_capacity(if has_repeats { points.len() } else { 0 });
        distinct.extend_from_slice(if has_repeats { &points[..1] } else { &[] });
        let (mut must_stay, mut radii) = (vec![0], vec![]);
        // `here`: index of the last distinct point. `first`: the first radius of the run; not a
        // number before the first run. `widest`: the largest radius of the run.
        let (mut here, mut first, mut widest): (usize, Real, Real) = (0, Real::NAN, 0.0);
        for (ends, &radius) in points.windows(2).zip(segment_radii) {
            if ends[0] == ends[1] {
                continue;
            }
            if radius != first {
                if is_same(first, radius) {
                    widest = widest.max(radius);
                } else {
                    if here > 0 {
                        must_stay.push(here);
                        radii.push(widest);
                    }
                    (first, widest) = (radius, radius);
                }
            }
            here += 1;
            if has_repeats {
                distinct.push(ends[1]);
            }
        }
        if here == 0 {
            return Err(RobotError::AllPointsEqual);
        }
        must_stay.push(here);
        radii.push(widest);
        let points = if has_repeats { Cow::Owned(distinct) } else { Cow::Borrowed(points) };
        Ok(Self { points, must_stay, radii })
    }

    fn first_point(&self) -> Vector {
        self.points[0]
    }

    fn iter(&self) -> impl ExactSizeIterator<Item = RadiusRun<'_>> {
        let ends = self.must_stay.windows(2);
        ends.zip(&self.radii)
            .map(|(ends, &radius)| RadiusRun { points: &self.points[ends[0]..=ends[1]], radius })
    }
}
