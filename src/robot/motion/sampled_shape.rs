//! Some places of a shape: where they are, which way the curve leads there, and how well both are
//! known.

use crate::distance::Scalar;
use crate::robot::Tube;
use crate::robot::scale::{direction, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// The least distance between two numbers, 2^-1074.
const MIN_STEP: Real = Real::from_bits(1);

/// A share of a section; or, from one share to another, the chord between the two.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampledPlace {
    pub section: usize,
    pub shares: [Real; 2],
}

/// The places to try: nine even shares of each section; and where a shape is given by samples,
/// eight of its samples and the chords from them to the next, which are known best.
pub(super) fn places(tube: &Tube) -> Vec<SampledPlace> {
    const PARTS: u32 = 8;
    let mut places = Vec::new();
    for (number, section) in tube.sections().iter().enumerate() {
        let mut add = |shares: [Real; 2]| places.push(SampledPlace { section: number, shares });
        for part in 0..=PARTS {
            add([Real::from(part) / Real::from(PARTS); 2]);
        }
        let mut last = None;
        for part in 0..PARTS {
            let middle = (Real::from(part) + 0.5) / Real::from(PARTS);
            let Some(between) =
                tube.samples_around(section, middle).filter(|found| last != Some(*found))
            else {
                continue;
            };
            add([between[0]; 2]);
            add(between);
            last = Some(between);
        }
    }
    places
}

/// A place in one shape.
#[derive(Clone, Copy, Debug)]
struct Sample {
    point: Vector,
    /// How far off the point may be.
    error: Real,
    direction: Vector,
    /// How far off the direction may be.
    tilt: Real,
    /// By how much less than the curve's directions the chord's may turn, as a factor.
    shrink: Real,
}

/// A shape at some places, and how far these may go from there by what a motion states.
#[derive(Clone, Debug, Default)]
pub(super) struct SampledShape {
    pub t: Real,
    samples: Vec<Sample>,
    /// What rounding can do to a point.
    rounding: Real,
    /// The stated ways, and angles, of the steps since then, added up.
    stated: Vec<[Real; 2]>,
}

/// How far a place went from one shape to another, at the least, and how far by what was stated;
/// and how far it turned.
pub(super) struct PlaceMotion {
    pub way: Real,
    pub angle: Real,
}

impl SampledShape {
    /// Samples a shape.
    pub(super) fn take(&mut self, t: Real, tube: &Tube, pose: &Pose, places: &[SampledPlace]) {
        self.t = t;
        // As in queries: a placed point is off by less than 16 roundings of the largest coordinate;
        // a place along the curve by less than one of its length.
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach() + tube.length();
        // Where a rounding of that vanishes, the steps between numbers do not.
        self.rounding = 64.0 * Real::UNIT_ROUNDOFF * reach + 64.0 * MIN_STEP;
        self.samples.clear();
        self.stated.clear();
        self.stated.resize(places.len(), [0.0; 2]);
        for place in places {
            let Some(section) = tube.sections().get(place.section) else { continue };
            let [from, to] = place.shares;
            let here = tube.at_share(section, from);
            // The direction of a link is that between its two ends, which are rounded.
            let is_link = section.last - section.first == 1;
            let turned = if is_link { self.rounding / (section.end - section.start) } else { 0.0 };
            let mut sample = Sample {
                point: *pose * here.point,
                error: here.off + tube.error(),
                direction: pose.rotation * here.direction,
                tilt: here.tilt + turned + 32.0 * Real::UNIT_ROUNDOFF,
                shrink: 1.0,
            };
            if from < to {
                let there = tube.at_share(section, to);
                let chord = *pose * there.point - sample.point;
                let size = length(chord);
                // The mean of the directions between two shares turns by no more than they do. The
                // chord is that mean times the length, if shares of the curve are
                // as long as those of the samples' lines: they are to `stretch`. And
                // where the mean is 1 - b^2 / 24 long or longer, for the turn b in between, its
                // direction turns by as much more.
                let known = tube.bound(section, tube.ticks_around(section, [from, to]));
                let bend =
                    known.curvature * (section.end - section.start) * (to - from) * section.stretch;
                sample.direction = direction(chord);
                sample.tilt = (section.stretch - 1.0)
                    + (here.off + there.off + self.rounding) / size
                    + 32.0 * Real::UNIT_ROUNDOFF;
                sample.shrink = (1.0 - bend * bend / 24.0).max(0.0);
            }
            self.samples.push(sample);
        }
    }

    /// Adds what is stated for another step.
    pub(super) fn add(&mut self, stated: &[[Real; 2]]) {
        for (sum, [way, angle]) in self.stated.iter_mut().zip(stated) {
            *sum = [sum[0] + way, sum[1] + angle];
        }
    }

    /// What was stated since, for a place.
    pub(super) fn stated(&self, place: usize) -> [Real; 2] {
        self.stated.get(place).copied().unwrap_or_default()
    }

    /// Where a place went from here to another shape, and how far off that may be.
    pub(super) fn way(&self, to: &Self, place: usize) -> Option<(Vector, Real)> {
        let (from, there) = (self.samples.get(place)?, to.samples.get(place)?);
        Some((there.point - from.point, self.rounding + to.rounding + from.error + there.error))
    }

    /// How far a place went at least, from here to another shape.
    pub(super) fn moved(&self, to: &Self, place: usize) -> Option<PlaceMotion> {
        let (from, there) = (self.samples.get(place)?, to.samples.get(place)?);
        let (way, off) = self.way(to, place)?;
        let way = way.length() - off;
        // Without length there is no direction.
        let has_direction = from.direction != Vector::ZERO && there.direction != Vector::ZERO;
        let turned =
            (there.direction - from.direction).length() * (from.shrink * there.shrink).sqrt();
        let angle =
            if has_direction { turned - from.tilt - there.tilt } else { Real::NEG_INFINITY };
        Some(PlaceMotion { way, angle })
    }
}
