//! Stations along a finely sampled centreline, as close together as its bends ask for.
//!
//! A chord of length l leaves a curve of curvature kappa by kappa l^2 / 8, so that all chords
//! deviate alike if their lengths go with 1 / sqrt(kappa). Curvature from neighbouring samples
//! would be mostly noise. It is measured where it matters, over chords: a *probe* compares three
//! vertices of a stretch with its chord. The root of their largest deviation over the tolerance is
//! the chord's *share*, which grows with its length.
//!
//! 1. **Walk.** From each station the next is foreseen from the last share, probed, and corrected
//!    until no sample farther on has a share within one. That gives the number of chords, and the
//!    density along the way.
//! 2. **Spread.** As many chords, each with the same share.
//! 3. **Verify.** Every vertex is compared with its chord, as in `simplify`. If a chord fails, the
//!    walk's own stations are verified instead. Of these, those that fail are divided: a chord
//!    grows from each station to twice as many segments as before while it holds.
//!
//! # Faces
//! A flat face is perpendicular to the chord that ends in it. A chord of the direction v where the
//! first segment has u moves the rim, at the radius r, by no more than r |u - v|, which must be
//! within the tolerance. The chord after it is flat too where Algorithm 1 has no room for a ball.
//! The rim at its beginning reaches r |u x v| ahead of its centre, which must be no more than the
//! centre's depth behind the face and the tolerance. So stations come nearer together
//! towards a face, as long as that asks for more than the deviation does, and at most to the depth
//! r. A single segment of the input is let pass; at the face itself it has the face's direction
//! anyway.
//!
//! # What it costs
//! A probe looks at three vertices, a station takes at most eight probes, and there are no more
//! stations than samples. Every vertex is verified at most twice, and four times more where chords
//! are divided. So the cost is at most proportional to the number of points.

use super::RobotError;
use super::compare::ToleranceSegment;
use super::radius_runs::{RadiusRun, RadiusRuns};
use super::scale::direction;
use crate::distance::Scalar;
use parry3d_f64::math::{Real, Vector};

/// Stations that follow a centreline within a tolerance, spread evenly by its curvature: their
/// points and segment radii, ready for any constructor of a [`Chain`](crate::Chain).
///
/// As [`simplify`](crate::simplify), but for a control loop: the time grows with the number of
/// points at most, whatever the shape. The points are a subset of the input's, in order. Both ends
/// stay, and so does every point where the radius changes. Each new segment and the stretch of the
/// input that it replaces are within `tolerance` of each other (Hausdorff distance); that is
/// verified. `tolerance` is in the unit of the points.
///
/// **Faces** are followed too, which `simplify` leaves to chance: at both ends of the robot and on
/// the wider side of each step, where a [`Chain`](crate::Chain) ends flat, the first segment is so
/// short that no point of the face moves by more than `tolerance`. The face of the input is
/// perpendicular to its own last segment, so sample as closely there as the face matters. That
/// takes up to a link or two a face more than the fewest. It is not forgone: on a bent tube a
/// tilted face is the largest error of a fine chain.
///
/// Repeated points are dropped first, as by `simplify`.
///
/// ```
/// use parry_continuum::{parry::math::Vector, stations};
///
/// let arc: Vec<_> = (0..=90).map(|i| f64::from(i).to_radians().sin_cos()).collect();
/// let arc: Vec<_> = arc.iter().map(|&(sin, cos)| Vector::new(cos, sin, 0.0)).collect();
/// let (points, radii) = stations(&arc, &[0.0; 90], 0.01)?;
/// assert_eq!(points.len(), 7); // a wire has no faces: 15 degrees each
/// let (points, radii) = stations(&arc, &[0.2; 90], 0.01)?;
/// assert_eq!(points.len(), 8); // short links at the faces: one more in all
/// # Ok::<(), parry_continuum::RobotError>(())
/// ```
///
/// # Errors
/// As [`simplify`](crate::simplify).
pub fn stations(
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
        let faces = [radius_before, radius_after].map(|beside| stretch.radius > beside);
        found.clear();
        StationRun::new(&stretch, tolerance, faces).divide(&mut found);
        kept.extend(found.iter().map(|&vertex| stretch.points[vertex]));
        radii.resize(radii.len() + found.len(), stretch.radius);
        radius_before = stretch.radius;
    }
    Ok((kept, radii))
}

/// Stations for which there is memory from the start.
const ROOM: usize = 64;

/// How often the next station is foreseen and probed at most.
const PROBES: usize = 8;

/// A stretch on which stations are set.
struct StationRun<'a> {
    points: &'a [Vector],
    radius: Real,
    tolerance: Real,
    /// The power of two that brings the stretch near one, so that squares neither overflow nor
    /// vanish where it matters.
    scale: Real,
    /// The directions of the input at the start and at the end, where these are faces whose rim
    /// can move too far.
    faces: [Option<Vector>; 2],
}

impl<'a> StationRun<'a> {
    fn new(stretch: &RadiusRun<'a>, tolerance: Real, is_face: [bool; 2]) -> Self {
        let (points, radius) = (stretch.points, stretch.radius);
        let start = points[0];
        let extent = points.iter().fold(Vector::ZERO, |extent, &p| extent.max((p - start).abs()));
        let scale = extent.max_element().power_of_two_to_unity();
        // Whatever the direction, a rim moves by no more than the diameter.
        let matters = 2.0 * radius > tolerance;
        let last = points.len() - 1;
        let faces = [
            (is_face[0] && matters).then(|| direction(points[1] - start)),
            (is_face[1] && matters).then(|| direction(points[last] - points[last - 1])),
        ];
        Self { points, radius, tolerance, scale, faces }
    }

    /// Adds the stations after the first vertex to `found`.
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

    /// The stations next to a face, from its vertex towards another, as long as its rim asks for
    /// nearer ones than the deviation. They end before the other vertex.
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

    /// Adds stations after `from`, up to `to`.
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

    /// Adds as many stations as there are chords, each with the same part of all shares, unless one
    /// of them fails.
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
            if next <= at || !self.is_admissible(at, next) {
                return false;
            }
            found.push(next);
            at = next;
        }
        true
    }

    /// The first vertex after `start` that is past a fraction of the chord, and `end` at the
    /// latest.
    fn vertex_at(&self, fraction: Real, start: usize, end: usize) -> usize {
        let chord = (self.points[end] - self.points[start]) * self.scale;
        let length = fraction * chord.length_squared();
        let is_before = |&p: &Vector| ((p - self.points[start]) * self.scale).dot(chord) < length;
        start + 1 + self.points[start + 1..end].partition_point(is_before)
    }

    /// The root of a chord's deviation over the tolerance, from three of the vertices between.
    fn share(&self, from: usize, to: usize) -> Real {
        let start = self.points[from];
        let chord = (self.points[to] - start) * self.scale;
        let cross_squared = [1, 2, 3].map(|quarter| {
            let vertex = self.points[from + (to - from) * quarter / 4];
            ((vertex - start) * self.scale).cross(chord).length_squared()
        });
        let largest = cross_squared.into_iter().fold(0.0, Real::max);
        let tolerance = self.tolerance * self.scale;
        // A loop that closes has no chord.
        if chord == Vector::ZERO {
            Real::INFINITY
        } else if largest == 0.0 {
            0.0
        } else {
            ((largest / chord.length_squared()).sqrt() / tolerance).sqrt()
        }
    }

    /// By how much the rim of a face moves if a chord stands for the input there.
    fn rim_moves(&self, from: usize, to: usize, face: Vector) -> Real {
        self.radius * (direction(self.points[to] - self.points[from]) - face).length()
    }

    /// How far ahead of its centre the rim at the end of a chord reaches, as a face looks.
    fn rim_reaches(&self, from: usize, to: usize, face: Vector) -> Real {
        self.radius * direction(self.points[to] - self.points[from]).cross(face).length()
    }

    /// Adds a station, and as many before it as it takes.
    fn verify_and_add(&self, from: usize, to: usize, found: &mut Vec<usize>) {
        let mut at = from;
        if self.is_admissible(from, to) {
            at = to;
            found.push(to);
        }
        while at < to {
            let mut steps = 1;
            while at + steps < to {
                let twice = (2 * steps).min(to - at);
                if !self.is_admissible(at, at + twice) {
                    break;
                }
                steps = twice;
            }
            at += steps;
            found.push(at);
        }
    }

    /// Whether a chord is within the tolerance of what it replaces, and so is the rim of a face at
    /// its end.
    fn is_admissible(&self, from: usize, to: usize) -> bool {
        let ends = [(0, from), (self.points.len() - 1, to)];
        let is_face_fine = |(face, (vertex, end)): (&Option<Vector>, (usize, usize))| {
            vertex != end
                || face.is_none_or(|face| self.rim_moves(from, to, face) <= self.tolerance)
        };
        let (start, end) = (self.points[from], self.points[to]);
        // A single segment is what it replaces.
        from + 1 == to
            || start != end && self.faces.iter().zip(ends).all(is_face_fine) && {
                let chord = ToleranceSegment::new(start, end, self.tolerance);
                self.points[from + 1..to].iter().all(|&p| chord.has_near(p))
            }
    }
}

/// How many steps can be taken, at least one and at most `most`, while their share is at most one:
/// the most, where the share is proportional to the steps, and mostly near it elsewhere. Also their
/// share.
fn foresee(guess: usize, most: usize, share: impl Fn(usize) -> Real) -> (usize, Real) {
    let (mut good, mut bad) = ((1, 0.0), (most + 1, 0.0));
    // One step is always good, and its share of 0 says nothing.
    let mut steps = guess.max(2).min(most);
    for _ in 0..PROBES {
        let probed = share(steps);
        if probed <= 1.0 {
            good = (steps, probed);
        } else {
            bad = (steps, probed);
        }
        // Without tolerance a share is infinite or 0, and proportional to nothing.
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
