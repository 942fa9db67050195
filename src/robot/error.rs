use parry3d_f64::math::{Real, Vector};
use strum::IntoStaticStr;
use thiserror::Error;

/// Why a link or a chain could not be built. Each message names the value at fault and what to
/// change.
#[derive(Clone, Copy, Debug, PartialEq, Error, IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
#[non_exhaustive]
pub enum RobotError {
    /// A point has a coordinate that is NaN or infinite.
    #[error(
        "point {index} has a coordinate that is not finite ({value}); remove or repair it in `{parameter}`"
    )]
    PointNotFinite {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the point in the input.
        index: usize,
        /// The offending coordinate.
        value: Real,
    },
    /// A point lies so far out that differences of coordinates could overflow.
    #[error(
        "point {index} in `{parameter}` has the coordinate {value}, beyond +-{limit:e}; choose a larger unit of length"
    )]
    PointOutOfRange {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the point in the input.
        index: usize,
        /// The offending coordinate.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// A radius is NaN, infinite, negative or beyond the accepted range.
    #[error(
        "radius {index} is {value}; `{parameter}` must be finite, at least 0 and at most {limit:e}"
    )]
    BadRadius {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the radius in the input.
        index: usize,
        /// The offending radius.
        value: Real,
        /// The largest radius accepted.
        limit: Real,
    },
    /// A flat cap has no direction on a link without length.
    #[error(
        "the link from point {index} has length 0 or nearly so, and the direction of its flat cap is undefined; \
         use two round caps (a ball) or move one end point"
    )]
    FlatCapWithoutAxis {
        /// Position of the link's start point in the input.
        index: usize,
    },
    /// A centreline needs at least two points.
    #[error("a centreline needs at least 2 points, got {count} in `{parameter}`")]
    TooFewPoints {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// How many points were given.
        count: usize,
    },
    /// The number of radii does not fit the number of points.
    #[error("{points} points need {expected} radii, got {radii} in `{parameter}`")]
    LengthsDiffer {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// How many points were given.
        points: usize,
        /// How many radii they need.
        expected: usize,
        /// How many radii were given.
        radii: usize,
    },
    /// Each point needs a tangent.
    #[error("{points} points need as many `tangents`, got {tangents}")]
    TangentsDiffer {
        /// How many points were given.
        points: usize,
        /// How many tangents were given.
        tangents: usize,
    },
    /// A motion needs as many points at its end as at its start.
    #[error("`from` has {from} points and `to` has {to}; give both the same number")]
    PointsDiffer {
        /// How many points it starts with.
        from: usize,
        /// How many points it ends with.
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
    /// A pose has a component that is NaN or infinite, or lies out of range.
    #[error(
        "the pose `{parameter}` has the component {value}; it must be finite and within +-{limit:e}"
    )]
    BadPose {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// The offending component.
        value: Real,
        /// The largest magnitude accepted.
        limit: Real,
    },
    /// The rotation of a pose scales: the length of its quaternion is not 1, even for single
    /// precision.
    #[error("the pose `{parameter}` has a quaternion of length {length}; normalise its rotation")]
    PoseNotRigid {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// The length of the quaternion.
        length: Real,
    },
    /// A point of a motion's centreline moves faster than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} moves at {found}, more than the {stated} \
         stated; state more"
    )]
    FasterThanStated {
        /// When.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// Where in the section, from 0 to 1.
        share: Real,
        /// Its speed, at least.
        found: Real,
        /// The speed that the motion states.
        stated: Real,
    },
    /// The direction of a motion's centreline turns faster than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} turns at {found} rad, more than the \
         {stated} stated; state more"
    )]
    TurnsFasterThanStated {
        /// When.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// Where in the section, from 0 to 1.
        share: Real,
        /// Its angular speed, at least.
        found: Real,
        /// The angular speed that the motion states.
        stated: Real,
    },
    /// A motion's centreline is farther off its stated course than the motion states.
    #[error(
        "around t = {t} the centreline at share {share} of section {section} is {found} off its stated course, more \
         than the {stated} stated; state more"
    )]
    FartherOffThanStated {
        /// When.
        t: Real,
        /// The section, counted from the base.
        section: usize,
        /// Where in the section, from 0 to 1.
        share: Real,
        /// How far off it is, at least.
        found: Real,
        /// How far off the motion states it to be.
        stated: Real,
    },
    /// A motion's sections must be the same at all times, with the same radii and faces.
    #[error(
        "at t = {t} the motion has other sections, radii or faces than before; keep them the same"
    )]
    SectionsChange {
        /// When.
        t: Real,
    },
    /// The shapes of a path must have the same links: the same segments must have a length, with
    /// the same radii.
    #[error(
        "shape {index} of `shapes` has other links than the first: other segments without length, or other radii; make all shapes of \
         the same segments, each with a length"
    )]
    ShapesDiffer {
        /// The shape, counted from 0.
        index: usize,
    },
    /// The kinematics behind a motion has no shape: return it from
    /// [`Motion::shape`](crate::Motion::shape).
    #[error("the kinematics has no shape at t = {t}: {reason}")]
    NoShape {
        /// When.
        t: Real,
        /// Why, in the words of the kinematics.
        reason: &'static str,
    },
    /// A path needs at least one motion.
    #[error("there are no motions in `{parameter}`; a path needs at least one motion")]
    NoMotions {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
    },
    /// A stated speed is not a number that is at least 0.
    #[error(
        "the motion states the speed {value} for section {section}; it must be finite and at least 0"
    )]
    BadSpeed {
        /// The section, counted from the base.
        section: usize,
        /// The offending speed.
        value: Real,
    },
    /// Every point of the centreline is the same.
    #[error("all points of the centreline are the same; a chain needs two distinct points")]
    AllPointsEqual,
    /// A radius beside which the length of its segment is nothing to compute with.
    #[error(
        "radius {index} is {value}, beside which the length {length} of its segment is lost; check the unit of \
         `{parameter}`"
    )]
    HidesLength {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the radius in the input.
        index: usize,
        /// The radius.
        value: Real,
        /// The length of the segment.
        length: Real,
    },
    /// A number is NaN, infinite or negative.
    #[error("`{parameter}` is {value}; it must be finite and at least 0")]
    Negative {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// The offending number.
        value: Real,
    },
    /// A tube needs at least one section.
    #[error("there are no sections in `{parameter}`; a tube needs at least one section")]
    NoSections {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
    },
    /// A section's length is not a positive number.
    #[error(
        "section {index} in `{parameter}` has the length {value}; it must be finite and more than 0"
    )]
    BadLength {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the section in the input.
        index: usize,
        /// The offending length.
        value: Real,
    },
    /// A section's curvature is NaN, infinite or negative.
    #[error(
        "section {index} in `{parameter}` has the curvature {value}; it must be finite and at least 0"
    )]
    BadCurvature {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the section in the input.
        index: usize,
        /// The offending curvature.
        value: Real,
    },
    /// A direction of the centreline is zero or not finite.
    #[error(
        "tangent {index} in `{parameter}` is {value}; give the direction of the centreline there"
    )]
    BadTangent {
        /// The parameter, as the function that was called names it.
        parameter: &'static str,
        /// Position of the tangent among those given; of a function, the section.
        index: usize,
        /// The offending direction.
        value: Vector,
    },
    /// Samples turn more sharply than what is known of a curve between them.
    #[error(
        "the centreline turns so sharply at point {index} that it may turn by {turn} rad between point {after} and the next; if the \
         robot bends so, give more points there; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`); check the end tangents if there are any; give frames at one place one direction; for a robot of straight \
         links use a Chain"
    )]
    TurnsTooSharply {
        /// Position in the input of the point where it turns most.
        index: usize,
        /// Position in the input of the point before the segment in which it may turn so much.
        after: usize,
        /// The largest curvature times a distance between two points next to it, rad.
        turn: Real,
    },
    /// The discs of a section would stick out of its flat end.
    #[error(
        "the section from {index} has a flat end, the curvature {curvature} and the radius {radius}; their product must \
         be below 1, so check the unit of length; if the points are measured, fit them with a `deviation` as large as their noise \
         (`Tube::fit`)"
    )]
    BendsWithinRadius {
        /// Position of the section's first point; of a function, of the section.
        index: usize,
        /// The largest curvature of the section.
        curvature: Real,
        /// Its radius.
        radius: Real,
    },
    /// The curve of a function has a coordinate that is NaN or infinite.
    #[error("the curve is not finite near the arc length {arc_length}; repair the function")]
    CurveNotFinite {
        /// Where it is not.
        arc_length: Real,
    },
    /// The argument of a function is not its arc length.
    #[error(
        "at {arc_length} the curve advances by {speed} for each unit of its argument; give it by arc length"
    )]
    NotByArcLength {
        /// Where it is not.
        arc_length: Real,
        /// The speed, which should be 1.
        speed: Real,
    },
    /// A function bends more than its section states.
    #[error(
        "at {arc_length} the curve has the curvature {found}, more than the {stated} stated; state more"
    )]
    BendsMoreThanStated {
        /// Where it does.
        arc_length: Real,
        /// The curvature found there.
        found: Real,
        /// The section's.
        stated: Real,
    },
    /// A function's direction is not that of its points.
    #[error(
        "at {arc_length} the tangent differs by {off} from the direction in which the points go; repair it"
    )]
    TangentOff {
        /// Where it does.
        arc_length: Real,
        /// The length of the difference of the unit vectors.
        off: Real,
    },
}

impl RobotError {
    /// What went wrong in one word, the same in Rust and Python: the variant in snake case.
    pub fn kind(&self) -> &'static str {
        self.into()
    }
}
