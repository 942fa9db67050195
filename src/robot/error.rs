use parry3d_f64::math::{Real, Vector};
use std::fmt::{self, Display, Formatter};
use strum::IntoStaticStr;
use thiserror::Error;

/// Why a robot, a tube or a motion is refused. Each message names the wrong value and what to
/// change.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum RobotError {
    /// A point has a coordinate that is NaN or infinite.
    #[error(
        "point {index} has a coordinate that is not finite ({value}); remove or repair it in `{parameter}`",
        value = number(.value)
    )]
    PointNotFinite {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the point in the input.
        index: usize,
        /// The wrong coordinate.
        value: Real,
    },
    /// A coordinate is so large that differences of coordinates could overflow.
    #[error(
        "point {index} in `{parameter}` has the coordinate {value}, beyond +-{limit:e}; choose a larger unit of length",
        value = number(.value)
    )]
    PointOutOfRange {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the point in the input.
        index: usize,
        /// The wrong coordinate.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// A radius is NaN, infinite, negative or too large.
    #[error(
        "radius {index} is {value}; `{parameter}` must be finite, at least 0 and at most {limit:e}",
        value = number(.value)
    )]
    BadRadius {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the radius in the input.
        index: usize,
        /// The wrong radius.
        value: Real,
        /// The largest radius accepted.
        limit: Real,
    },
    /// A flat cap needs a direction; a link without length has none.
    #[error(
        "the link from point {index} has length 0 or nearly so, and the direction of its flat cap is undefined; \
         use two round caps (a ball) or move one end point"
    )]
    FlatCapWithoutAxis {
        /// Index of the link's start point in the input.
        index: usize,
    },
    /// A centreline needs at least two points.
    #[error("a centreline needs at least 2 points, got {count} in `{parameter}`")]
    TooFewPoints {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// The number of points given.
        count: usize,
    },
    /// The number of radii does not fit the number of points.
    #[error(
        "{points} points need {expected} radii, got {radii} in `{parameter}`{rule}",
        rule = radii_rule(*.points, *.expected, *.radii)
    )]
    LengthsDiffer {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// The number of points given.
        points: usize,
        /// The number of radii that these points need.
        expected: usize,
        /// The number of radii given.
        radii: usize,
    },
    /// Each point needs a tangent.
    #[error("{points} points need as many `tangents`, got {tangents}")]
    TangentsDiffer {
        /// The number of points given.
        points: usize,
        /// The number of tangents given.
        tangents: usize,
    },
    /// A motion needs as many points at its end as at its start.
    #[error("`from` has {from} points and `to` has {to}; give both the same number")]
    PointsDiffer {
        /// The number of points at the start.
        from: usize,
        /// The number of points at the end.
        to: usize,
    },
    /// A motion needs the same sections at its end as at its start, with the same radii.
    #[error(
        "section {index} is not the same in `from` and `to`; give both as many sections, of the same radii"
    )]
    SectionsDiffer {
        /// The first section that is missing or has another radius.
        index: usize,
    },
    /// A pose has a component that is NaN, infinite or too large.
    #[error(
        "the pose `{parameter}` has the component {value}; it must be finite and within +-{limit:e}",
        value = number(.value)
    )]
    BadPose {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// The wrong component.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// The rotation of a pose scales: its quaternion's length differs from 1 by more than
    /// single-precision rounding.
    #[error(
        "the pose `{parameter}` has a quaternion of length {length}; normalise its rotation",
        length = number(.length)
    )]
    PoseNotRigid {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// The length of the quaternion.
        length: Real,
    },
    /// A point of a motion's centreline moves faster than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} moves at {found}, more than the {stated} \
         stated; state more",
        t = number(.t),
        share = number(.share),
        found = number(.found),
        stated = number(.stated)
    )]
    FasterThanStated {
        /// The time.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// The place in the section, from 0 to 1.
        share: Real,
        /// A lower bound on the speed of the place.
        found: Real,
        /// The speed that the motion states.
        stated: Real,
    },
    /// The direction of a motion's centreline turns faster than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} turns at {found} rad, more than the \
         {stated} stated; state more",
        t = number(.t),
        share = number(.share),
        found = number(.found),
        stated = number(.stated)
    )]
    TurnsFasterThanStated {
        /// The time.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// The place in the section, from 0 to 1.
        share: Real,
        /// A lower bound on the angular speed of the place, rad per unit of time.
        found: Real,
        /// The angular speed that the motion states, rad per unit of time.
        stated: Real,
    },
    /// A motion's centreline leaves the stated frame faster than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} {} at {found} relative to the common \
         frame, more than the {stated} stated; state another frame, or more",
        if *.is_turn { "turns" } else { "moves" },
        t = number(.t),
        share = number(.share),
        found = number(.found),
        stated = number(.stated)
    )]
    LeavesFrame {
        /// The time.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// The place in the section, from 0 to 1.
        share: Real,
        /// A lower bound on the speed of the place relative to the frame.
        found: Real,
        /// The speed that the motion states.
        stated: Real,
        /// Whether both are angular speeds, in rad.
        is_turn: bool,
    },
    /// A motion's centreline is farther from its stated displacement than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} is {found} off its stated course, more \
         than the {stated} stated; state more",
        t = number(.t),
        share = number(.share),
        found = number(.found),
        stated = number(.stated)
    )]
    FartherOffThanStated {
        /// The time.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// The place in the section, from 0 to 1.
        share: Real,
        /// A lower bound on the deviation.
        found: Real,
        /// The deviation that the motion states.
        stated: Real,
    },
    /// A motion must keep its sections, with the same radii and faces, at all times.
    #[error(
        "at t = {t} the motion has other sections, radii or faces than before; keep them the same",
        t = number(.t)
    )]
    SectionsChange {
        /// The time.
        t: Real,
    },
    /// The shapes of a path must have the same links: the same segments with a length and the same
    /// radii.
    #[error(
        "shape {index} of `shapes` has other links than the first: other segments without length, or other radii; make all shapes of \
         the same segments, each with a length"
    )]
    ShapesDiffer {
        /// Index of the shape.
        index: usize,
    },
    /// The kinematics behind a motion has no shape: return it from
    /// [`Motion::shape`](crate::Motion::shape).
    #[error("the kinematics has no shape at t = {t}: {reason}", t = number(.t))]
    NoShape {
        /// The time.
        t: Real,
        /// The reason, in the words of the kinematics.
        reason: &'static str,
    },
    /// A path needs at least one motion.
    #[error("`{parameter}` is empty; a path needs at least one")]
    NoMotions {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
    },
    /// A motion of a path does not begin where the previous one ends.
    #[error(
        "motion {index} of `motions` begins {off} away from the end of the motion before it, turned by {turn} rad, at share \
         {share} of section {section}; let each motion begin where the previous one ends",
        share = number(.share),
        off = number(.off),
        turn = number(.turn)
    )]
    MotionsApart {
        /// Index of the motion that begins elsewhere.
        index: usize,
        /// The section, counted from the base.
        section: usize,
        /// The place in the section, from 0 to 1.
        share: Real,
        /// A lower bound on the distance of the two places.
        off: Real,
        /// A lower bound on the turn between the two directions, rad.
        turn: Real,
    },
    /// A stated speed is NaN, infinite or negative.
    #[error(
        "the motion states the speed {value} for section {section}; it must be finite and at least 0",
        value = number(.value)
    )]
    BadSpeed {
        /// The section, counted from the base.
        section: usize,
        /// The wrong speed.
        value: Real,
    },
    /// Every point of the centreline is the same.
    #[error("all points of the centreline are the same; a chain needs two distinct points")]
    AllPointsEqual,
    /// A segment is so short beside its radius that its length underflows in computations.
    #[error(
        "radius {index} is {value}, beside which the length {length} of its segment is lost; check the unit of \
         `{parameter}`",
        value = number(.value),
        length = number(.length)
    )]
    HidesLength {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the radius in the input.
        index: usize,
        /// The radius.
        value: Real,
        /// The length of the segment.
        length: Real,
    },
    /// A number is NaN, infinite or negative.
    #[error("`{parameter}` is {value}; it must be finite and at least 0", value = number(.value))]
    Negative {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// The wrong number.
        value: Real,
    },
    /// A tube needs at least one section.
    #[error("there are no sections in `{parameter}`; a tube needs at least one section")]
    NoSections {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
    },
    /// A section's length is not a positive number.
    #[error(
        "section {index} in `{parameter}` has the length {value}; it must be finite and more than 0",
        value = number(.value)
    )]
    BadLength {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the section in the input.
        index: usize,
        /// The wrong length.
        value: Real,
    },
    /// A section's curvature is NaN, infinite or negative.
    #[error(
        "section {index} in `{parameter}` has the curvature {value}; it must be finite and at least 0",
        value = number(.value)
    )]
    BadCurvature {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the section in the input.
        index: usize,
        /// The wrong curvature.
        value: Real,
    },
    /// A direction of the centreline is zero or not finite.
    #[error(
        "tangent {index} in `{parameter}` is {value}; give the direction of the centreline there",
        value = vector(.value)
    )]
    BadTangent {
        /// The parameter's name in the function that was called.
        parameter: &'static str,
        /// Index of the tangent in the input; for a function, index of the section.
        index: usize,
        /// The wrong direction.
        value: Vector,
    },
    /// The samples turn more sharply than the assumed curvature between samples allows.
    #[error(
        "the centreline turns so sharply at point {index} that it may turn by {turn} rad between point {after} and the next; if the \
         robot bends so, give more points there; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`); check the end tangents if there are any; give frames at one place one direction; for a robot of straight \
         links use a Chain",
        turn = number(.turn)
    )]
    TurnsTooSharply {
        /// Index in the input of the point at which the curve turns most.
        index: usize,
        /// Index in the input of the point before the segment that may turn by `turn`.
        after: usize,
        /// The largest curvature times distance between two neighbouring points, rad.
        turn: Real,
    },
    /// A section with a flat end bends within its radius, so its discs would stick out of that end.
    #[error(
        "the section from {index} has a flat end, the curvature {curvature} and the radius {radius}; their product must \
         be below 1, so check the unit of length; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`)",
        curvature = number(.curvature),
        radius = number(.radius)
    )]
    BendsWithinRadius {
        /// Index of the section's first point; for a function, index of the section.
        index: usize,
        /// The largest curvature of the section.
        curvature: Real,
        /// Its radius.
        radius: Real,
    },
    /// The curve of a function has a coordinate that is NaN or infinite.
    #[error(
        "the curve is not finite near the arc length {arc_length}; repair the function",
        arc_length = number(.arc_length)
    )]
    CurveNotFinite {
        /// The arc length of the place.
        arc_length: Real,
    },
    /// The argument of a function is not its arc length.
    #[error(
        "at {arc_length} the curve advances by {speed} for each unit of its argument; give it by arc length",
        arc_length = number(.arc_length),
        speed = number(.speed)
    )]
    NotByArcLength {
        /// The arc length of the place.
        arc_length: Real,
        /// The speed found there, which should be 1.
        speed: Real,
    },
    /// A function bends more than the curvature stated for its section.
    #[error(
        "at {arc_length} the curve has the curvature {found}, more than the {stated} stated; state more",
        arc_length = number(.arc_length),
        found = number(.found),
        stated = number(.stated)
    )]
    BendsMoreThanStated {
        /// The arc length of the place.
        arc_length: Real,
        /// The curvature found there.
        found: Real,
        /// The curvature stated for the section.
        stated: Real,
    },
    /// A function's tangent differs from the direction in which its points advance.
    #[error(
        "at {arc_length} the tangent differs by {off} from the direction in which the points go; repair it",
        arc_length = number(.arc_length),
        off = number(.off)
    )]
    TangentOff {
        /// The arc length of the place.
        arc_length: Real,
        /// The length of the difference of the unit vectors.
        off: Real,
    },
}

impl RobotError {
    /// Returns the variant's name in snake case, the same in Rust and Python.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}

/// A number in a message: with an exponent if it would have many digits without one.
struct Number(Real);

impl Display for Number {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        if value == 0.0 || !value.is_finite() || (1e-5..1e16).contains(&value.abs()) {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}

/// Returns a number as messages write it.
pub(crate) fn number(value: &Real) -> impl Display + use<> {
    Number(*value)
}

/// Returns what to say if radii are given for segments but needed for points, or the reverse.
fn radii_rule(points: usize, expected: usize, radii: usize) -> &'static str {
    if expected < points && radii == points {
        "; give one for each segment between two points"
    } else if expected == points && radii + 1 == points {
        "; give one for each point"
    } else {
        ""
    }
}

/// Returns a vector as messages write it.
fn vector(value: &Vector) -> impl Display + use<> {
    let [x, y, z] = value.to_array().map(Number);
    format!("[{x}, {y}, {z}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        let texts = [1e300, -1e-300, -1.0, 0.1, 0.0, 1e16, 123456.75, f64::INFINITY, f64::NAN];
        let texts = texts.map(|value| number(&value).to_string());
        assert_eq!(
            texts,
            ["1e300", "-1e-300", "-1", "0.1", "0", "1e16", "123456.75", "inf", "NaN"]
        );
        let value = Vector::new(1e-200, 0.0, 2.0);
        let error = RobotError::BadTangent { parameter: "tangents", index: 0, value };
        assert!(error.to_string().contains("is [1e-200, 0, 2];"), "{error}");
    }
}
