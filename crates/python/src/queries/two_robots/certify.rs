//! Proofs of answers about two robots.

use super::RobotPair;
use super::answers::segment_of;
use super::session::{Placed, Session};
use crate::error::Refused;
use crate::input::{Caps, Given, vectors};
use crate::output::{answer, array_or_number};
use crate::queries::certify::{answer_field, check_arc_length};
use crate::threads::{Asked, ask_each};
use parry_continuum::Chain;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::Certificate;
use pyo3::prelude::*;

#[pymethods]
impl RobotPair {
    /// Bounds on the distances of a `RobotProximity` answer that hold despite all rounding.
    ///
    /// Each bounds the distance between the two segments that the answer names, as `Mesh.certify`
    /// does for a segment and a triangle: ``lower <= answer.distance <= upper`` up to the last bits
    /// of the distance. The answer's distances, points and arc lengths are checked first: an answer
    /// for other points, another radius or pose is an error.
    ///
    /// Parameters
    /// ----------
    /// points_a, radii_a, points_b, radii_b, pose_a, pose_b, caps
    ///     As they were given to the function that answered.
    /// answer : RobotProximity
    ///     Of `RobotPair.minimum` or `RobotPair.per_link`.
    ///
    /// Returns
    /// -------
    /// Certificate
    ///     ``lower`` and ``upper``, in the shape of ``answer.distance``; NaN for segments without
    ///     length.
    ///
    /// Raises
    /// ------
    /// ContinuumError
    ///     The answer does not fit robots and poses: a point is not where it says, the distance or
    ///     an arc length is another, it names no pair of links, or the shapes differ. Or as for
    ///     `minimum`.
    ///
    /// Examples
    /// --------
    /// >>> from parry_continuum import RobotPair
    /// >>> pair, robots = RobotPair(), ([[0, 0, 0], [0, 0, 9]], 0.5, [[3, -5, 4], [3, 5, 4]], 0.5)
    /// >>> proof = pair.certify(*robots, pair.minimum(*robots))
    /// >>> proof.upper - proof.lower < 1e-14 and proof.lower <= 2.0 <= proof.upper
    /// True
    #[pyo3(signature = (points_a, radii_a, points_b, radii_b, answer, *, pose_a = None, pose_b = None, caps = Caps::Fitted), text_signature = "($self, points_a, radii_a, points_b, radii_b, answer, *, pose_a=None, pose_b=None, caps=\"fitted\")")]
    #[allow(clippy::too_many_arguments)] // they are named in Python
    fn certify<'py>(
        &self,
        py: Python<'py>,
        points_a: &Bound<'py, PyAny>,
        radii_a: &Bound<'py, PyAny>,
        points_b: &Bound<'py, PyAny>,
        radii_b: &Bound<'py, PyAny>,
        answer: &Bound<'py, PyAny>,
        pose_a: Option<&Bound<'py, PyAny>>,
        pose_b: Option<&Bound<'py, PyAny>>,
        caps: Caps,
    ) -> PyResult<Bound<'py, PyAny>> {
        let robots = self.robots([points_a, radii_a, points_b, radii_b], [pose_a, pose_b])?;
        // One row a pair of robots, or one for each segment of the first.
        let each = robots.segments_each();
        let fields = |name: &str, last: &[usize]| {
            let of_links: Vec<_> = [each].iter().chain(last).copied().collect();
            let shapes = [robots.shape(last), robots.shape(&of_links)];
            answer_field(answer, "minimum", name, &shapes)
        };
        let (named, kind) = fields("segments", &[2])?;
        let named = named.values().to_vec();
        let distances = fields("distance", &[])?.0.values().to_vec();
        let lengths = fields("arc_lengths", &[2])?.0.values().to_vec();
        let on_first = vectors(fields("on_first", &[3])?.0.points());
        let on_second = vectors(fields("on_second", &[3])?.0.points());
        let (shape, rows) = [(robots.shape(&[]), 1), (robots.shape(&[each]), each)][kind].clone();
        if named.len() != 2 * distances.len() || on_first.len() != on_second.len() {
            let text = "the fields of `answer` have different numbers of rows; give the answer as it was returned";
            return Err(Refused::other("answer_does_not_fit", text).raise(py, None));
        }
        let mut bounds: Vec<[f64; 2]> = Vec::with_capacity(robots.len() * rows);
        let ask = |session: &mut Session, robot: &Given<'_>, found: &mut [[f64; 2]]| {
            let Placed { pair, chains: [a, b], poses, points, .. } = session.place(robot, caps)?;
            let links = [in_order(a, points[0]), in_order(b, points[1])];
            // Takes an answer of the library's own, and overwrites its fields with the given ones.
            let mut answer = pair.minimum(a, &poses[0], b, &poses[1])?;
            for (row, bounds) in found.iter_mut().enumerate().take(rows) {
                let row = robot.number * rows + row;
                let at = 2 * row;
                if named[at..at + 2] == [-1.0; 2] {
                    // Of a segment of the first robot without length there is nothing to prove.
                    let place = robot.number * rows;
                    let is_link = kind == 0 || links[0].contains(&((row - place) as i64));
                    check_nothing(is_link, distances[row], row - place)?;
                    continue;
                }
                answer.links = [
                    link_of(&links[0], named[at], "points_a")?,
                    link_of(&links[1], named[at + 1], "points_b")?,
                ];
                answer.distance = distances[row];
                (answer.witness.on_first, answer.witness.on_second) =
                    (on_first[row], on_second[row]);
                answer.witness.arc_lengths = [lengths[at], lengths[at + 1]];
                let Certificate { lower, upper, .. } =
                    answer.certify(a, &poses[0], b, &poses[1])?;
                let others = [on_second[row], on_first[row]];
                for (k, chain) in [a, b].into_iter().enumerate() {
                    let place = (chain, &poses[k], answer.links[k]);
                    check_arc_length(place, others[k], lengths[at + k], "arc_lengths")?;
                }
                *bounds = [lower, upper];
            }
            Ok(())
        };
        ask_each(py, &self.0, &robots, ([f64::NAN; 2], rows.max(1)), ask, |_, found| {
            bounds.extend(found)
        })?;
        let side =
            |k: usize| array_or_number(py, shape.clone(), bounds.iter().map(|it| it[k]).collect());
        answer!(py, "Certificate", (side(0)?, side(1)?))
    }
}

/// Refuses a row that names no segments, except for a segment without length, whose distance is
/// NaN.
fn check_nothing(is_link: bool, distance: f64, row: usize) -> Result<(), Refused> {
    let text = if is_link {
        format!(
            "`answer.segments` is -1 and -1 in row {row}, so it names no pair of links; there is nothing to certify"
        )
    } else if !distance.is_nan() {
        format!(
            "`answer.distance` is {distance:?} for segment {row}, which has no length; give what `per_link` returned: NaN"
        )
    } else {
        return Ok(());
    };
    Err(Refused::other("answer_does_not_fit", text))
}

/// The segments that a robot's links are.
fn in_order(chain: &Chain, points: &[Vector]) -> Vec<i64> {
    (0..chain.links().len()).map(|link| segment_of(chain, points, link)).collect()
}

/// The number of the link that a segment is.
fn link_of(segments: &[i64], segment: f64, points: &str) -> Result<u32, Refused> {
    // Positions of segments are whole numbers far below 2^53.
    let link = segments.iter().position(|&other| other as f64 == segment);
    link.map(|link| link as u32).ok_or_else(|| {
        let text = format!(
            "`answer.segments` names the segment {segment} of `{points}`, which is no link; give the robots that were asked about"
        );
        Refused::other("no_such_link", text)
    })
}
