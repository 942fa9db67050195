//! Warnings about a robot that is probably in another frame or unit than the mesh.
//!
//! # Algorithm
//! 1. Compare the box around the robot with the box around the mesh: their sizes, and whether they
//!    overlap.
//! 2. If there is a misfit, try the usual mistakes in this order: the other frame, another unit,
//!    both. The first change after which the boxes fit is the remedy. Another unit must bring the
//!    sizes nearer to one another: otherwise it hides a wrong pose.
//! 3. Compare the radius with the box around the mesh.
//!
//! A margin that is tiny beside the mesh, and a robot that turns back, are doubted too.
//!
//! The box of a robot is the box of its points, without the radii, whose unit may be another one.

use std::ops::RangeInclusive;

/// Sizes of a robot and a mesh in the same unit differ by at most this factor.
const LARGEST_RATIO: f64 = 100.0;

/// The ratios of a radius to the diagonal of the mesh's box that are not doubted. Instruments have
/// 1/50 (a bronchoscope in a trachea) to 1/4000 (a guide wire in an aorta).
const USUAL_RADII: RangeInclusive<f64> = 1.0 / 5000.0..=1.0 / 10.0;

/// The ratio of most instruments. A factor of 100 takes it out of the range on either side.
const TYPICAL_RADIUS: f64 = 1.0 / 200.0;

/// The factors by which a radius may be wrong.
const RADIUS_UNITS: [f64; 6] = [1000.0, 100.0, 10.0, 0.1, 0.01, 0.001];

/// The factors between metres, centimetres and millimetres.
const UNITS: [f64; 4] = [1000.0, 1e-3, 10.0, 0.1];

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub low: [f64; 3],
    /// The greatest coordinates.
    pub high: [f64; 3],
}

impl Bounds {
    /// Returns the box around points. Points that are not finite are skipped. `None` if there is no
    /// other point.
    pub fn of_points(points: impl IntoIterator<Item = [f64; 3]>) -> Option<Self> {
        let points = points.into_iter().filter(|point| point.iter().all(|x| x.is_finite()));
        points.map(|point| Self { low: point, high: point }).reduce(|a, b| Self {
            low: [0, 1, 2].map(|axis| a.low[axis].min(b.low[axis])),
            high: [0, 1, 2].map(|axis| a.high[axis].max(b.high[axis])),
        })
    }

    /// Returns the length of the diagonal.
    fn size(&self) -> f64 {
        [0, 1, 2]
            .map(|axis| self.high[axis] - self.low[axis])
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    }

    /// Returns the largest gap between the boxes along an axis; negative if they overlap.
    fn gap(&self, other: &Self) -> f64 {
        let gaps = [0, 1, 2]
            .map(|axis| (self.low[axis] - other.high[axis]).max(other.low[axis] - self.high[axis]));
        gaps.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    fn is_alike(&self, other: &Self) -> bool {
        (1.0 / LARGEST_RATIO..=LARGEST_RATIO).contains(&(self.size() / other.size()))
    }

    /// Returns by how many powers of e the sizes of the boxes differ.
    fn mismatch(&self, other: &Self) -> f64 {
        (self.size() / other.size()).ln().abs()
    }
}

/// A change of frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// The factor of coordinates and radii.
    pub scale: f64,
    /// Whether x and y change sign, as between [RAS](crate::Frame::Ras) and
    /// [LPS](crate::Frame::Lps).
    pub turns: bool,
}

impl Change {
    /// No change.
    pub const NONE: Self = Self { scale: 1.0, turns: false };

    /// Returns the changed point.
    pub fn apply(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let sign = if self.turns { -1.0 } else { 1.0 };
        [sign * self.scale * x, sign * self.scale * y, self.scale * z]
    }
}

/// The signs that a robot is in another frame or unit than the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Misfits {
    /// One sentence for each sign, without a full stop. Empty if the robot fits.
    pub doubts: Vec<String>,
    /// The change after which the robot fits, if a usual mistake explains the misfit.
    pub remedy: Option<Change>,
}

impl Misfits {
    /// Returns the doubts; the last one names the remedy in the caller's words.
    pub fn with_remedy(self, words: impl FnOnce(Change) -> String) -> Vec<String> {
        let Self { mut doubts, remedy } = self;
        if let (Some(last), Some(remedy)) = (doubts.last_mut(), remedy) {
            last.push_str(&format!("; with {} they fit", words(remedy)));
        }
        doubts
    }
}

/// Compares the box of a robot with that of a mesh.
///
/// - `robot`: returns the box around the robot's points after a change of its input.
/// - `may_turn`: whether the frame may be wrong. False if the caller stated a pose or both frames.
pub fn misfits(robot: impl Fn(Change) -> Option<Bounds>, mesh: &Bounds, may_turn: bool) -> Misfits {
    let mut misfits = Misfits { doubts: Vec::new(), remedy: None };
    let Some(own) = robot(Change::NONE) else { return misfits };
    if !own.is_alike(mesh) {
        let sizes = [own.size(), mesh.size()];
        misfits.doubts.push(format!(
            "the robot's box measures {}, the mesh's {}",
            fixed(sizes[0]),
            fixed(sizes[1])
        ));
    }
    let gap = own.gap(mesh);
    if gap > 0.0 {
        misfits.doubts.push(format!(
            "the robot's box and the mesh's do not overlap; they are {} apart",
            fixed(gap)
        ));
    }
    if misfits.doubts.is_empty() {
        return misfits;
    }
    let turned = [Change { scale: 1.0, turns: true }];
    let scaled = |turns: bool| UNITS.map(|scale| Change { scale, turns });
    let changes = turned.into_iter().chain(scaled(false)).chain(scaled(true));
    misfits.remedy = changes.filter(|change| may_turn || !change.turns).find(|change| {
        robot(*change).is_some_and(|changed| {
            let is_nearer = change.scale == 1.0 || changed.mismatch(mesh) < own.mismatch(mesh);
            is_nearer && changed.gap(mesh) <= 0.0 && changed.is_alike(mesh)
        })
    });
    if let (Some(last), None) = (misfits.doubts.last_mut(), misfits.remedy)
        && gap > 0.0
    {
        last.push_str("; check the robot's pose");
    }
    misfits
}

/// A radius that is probably in another unit than the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusDoubt {
    /// The warning, without a full stop.
    pub doubt: String,
    /// The factor after which the radius is usual.
    pub factor: f64,
}

/// Doubts a robot's largest radius that is more than 1/10 or less than 1/5000 of the diagonal of
/// the mesh's box. A radius of 0 is never doubted.
///
/// If [`misfits`] names a scale that applies to the radius too, `radius` is the scaled radius: see
/// [`scales_radius`].
pub fn radius_doubt(radius: f64, mesh: &Bounds) -> Option<RadiusDoubt> {
    let share = radius / mesh.size();
    if radius == 0.0 || !share.is_finite() || USUAL_RADII.contains(&share) {
        return None;
    }
    let size = if share > *USUAL_RADII.end() { "large" } else { "small" };
    let doubt = format!(
        "the radius {} is {size} beside the mesh's box, which measures {}; check its unit",
        short(radius),
        fixed(mesh.size())
    );
    let off = |factor: &f64| (share * factor / TYPICAL_RADIUS).ln().abs();
    let factor = RADIUS_UNITS.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    Some(RadiusDoubt { doubt, factor })
}

/// Returns whether a radius is probably in the unit of the coordinates, so that `scale` applies to
/// both: if the scaled radius is usual, or if neither is usual and the scaled one is nearer to it.
pub fn scales_radius(radius: f64, scale: f64, mesh: &Bounds) -> bool {
    let is_usual = |radius: f64| radius_doubt(radius, mesh).is_none();
    let off = |radius: f64| (radius / mesh.size() / TYPICAL_RADIUS).ln().abs();
    is_usual(radius * scale) || (!is_usual(radius) && off(radius * scale) < off(radius))
}

/// A margin other than 0 is at least this share of the diagonal of the mesh's box. Margins of
/// millimetres that are written in metres are smaller; margins of 1/20 mm in an aorta are larger.
const LEAST_MARGIN: f64 = 1e-4;

/// Doubts a margin that is less than 1/10,000 of the diagonal of the mesh's box. A margin of 0 is
/// never doubted.
pub fn margin_doubt(margin: f64, mesh: &Bounds) -> Option<String> {
    let size = mesh.size();
    (margin > 0.0 && margin < LEAST_MARGIN * size).then(|| {
        format!(
            "the margin {} is small beside the mesh's box, which measures {}; check its unit",
            short(margin),
            fixed(size)
        )
    })
}

/// Steps shorter than this share of the mean step have no direction: their ends are one point that
/// was rounded in different ways.
const SHORT_STEP: f64 = 0.01;

/// Doubts a robot that turns by more than 90 degrees between two steps: its points may be out of
/// order, or belong to several robots, or one of them may be wrong.
pub fn sharp_turns(points: &[[f64; 3]]) -> Option<String> {
    let step = |from: &[f64; 3], to: &[f64; 3]| [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let length = |[x, y, z]: [f64; 3]| x.hypot(y).hypot(z);
    let steps = || points.windows(2).map(|pair| step(&pair[0], &pair[1]));
    let mean = steps().map(|step| length(step) / (points.len() - 1) as f64).sum::<f64>();
    let mut before: Option<[f64; 3]> = None;
    let mut turns = Vec::new();
    for (index, step) in steps().enumerate() {
        let own = length(step);
        if own > SHORT_STEP * mean && own.is_finite() {
            let unit = step.map(|x| x / own);
            let along = before.map(|before| (0..3).map(|axis| before[axis] * unit[axis]).sum());
            turns.extend(along.filter(|along: &f64| *along < 0.0).map(|_| index));
            before = Some(unit);
        }
    }
    let first = *turns.first()?;
    let others = match turns.len() {
        1 => String::new(),
        2 => ", and at one other point".to_owned(),
        count => format!(", and at {} other points", count - 1),
    };
    Some(format!(
        "the robot turns by more than 90 degrees at point {first}{others}; check the order of the \
         points, and whether they are of one robot"
    ))
}

/// Numbers from here on are written with an exponent.
const LARGE: f64 = 1e15;

/// Returns a number with three decimals.
fn fixed(number: f64) -> String {
    if number.abs() < LARGE { format!("{number:.3}") } else { format!("{number:.3e}") }
}

/// Returns a number rounded to four significant digits.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    if (1e-6..LARGE).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}
