//! Sampled places of a shape: their points and directions, with the errors of both.

use super::CommonFrame;
use crate::curve::Tube;
use crate::distance::Scalar;
use crate::robot::{direction, length};
use parry3d_f64::math::{Pose, Real, Vector};

/// The least positive number, 2^-1074.
const MIN_STEP: Real = Real::from_bits(1);

/// A place at a share of a section, or the chord between two shares.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampledPlace {
    pub section: usize,
    pub shares: [Real; 2],
}

/// Returns the places to test: nine even shares of each section. For a shape by samples also eight
/// samples and the chords from them to the next sample, which are known best.
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
    /// Upper bound on the error of the point.
    error: Real,
    direction: Vector,
    /// Upper bound on the error of the direction.
    tilt: Real,
    /// Factor from the turn of the chord to a lower bound on the turn of the curve's directions.
    shrink: Real,
}

/// A shape at some places, with the stated displacements since then.
#[derive(Clone, Debug, Default)]
pub(super) struct SampledShape {
    pub t: Real,
    samples: Vec<Sample>,
    /// Upper bound on the rounding error of a point.
    rounding: Real,
    /// The sums of the stated displacements and turns of the steps since then.
    stated: Vec<[Real; 2]>,
}

/// Lower bounds on the displacement and the turn of a place from one shape to another.
pub(super) struct PlaceMotion {
    pub way: Real,
    pub angle: Real,
}

impl SampledShape {
    /// Samples a shape.
    pub(super) fn take(&mut self, t: Real, tube: &Tube, pose: &Pose, places: &[SampledPlace]) {
        self.t = t;
        // As in queries: a placed point is off by less than 16 roundings of the largest coordinate,
        // a place along the curve by less than one rounding of its length.
        let reach = pose.translation.abs().max_element() + 2.0 * tube.reach() + tube.length();
        // If these roundings underflow, the spacing of numbers remains.
        self.rounding = 64.0 * Real::UNIT_ROUNDOFF * reach + 64.0 * MIN_STEP;
        self.samples.clear();
        self.stated.clear();
        self.stated.resize(places.len(), [0.0; 2]);
        for place in places {
            let Some(section) = tube.sections().get(place.section) else { continue };
            let [from, to] = place.shares;
            let here = tube.at_share(section, from);
            // The direction of a link is computed from its two ends, which are rounded.
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
                // The mean of the directions between two shares turns by at most as much as the
                // directions. The chord is that mean times the length, if shares of the curve are
                // as long as shares of the polyline, which holds up to `stretch`. For a turn b in
                // between, the mean has at least the length `1 - b^2 / 24`, so its direction may
                // turn by more by that factor.
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

    /// Returns an upper bound on the rounding error of a point.
    pub(super) fn rounding(&self) -> Real {
        self.rounding
    }

    /// Adds the stated displacements and turns of another step.
    pub(super) fn add(&mut self, stated: &[[Real; 2]]) {
        for (sum, [way, angle]) in self.stated.iter_mut().zip(stated) {
            *sum = [sum[0] + way, sum[1] + angle];
        }
    }

    /// Returns the sums of a place's stated displacement and turn.
    pub(super) fn stated(&self, place: usize) -> [Real; 2] {
        self.stated.get(place).copied().unwrap_or_default()
    }

    /// Returns the displacement of a place to another shape, and an upper bound on its error.
    pub(super) fn way(&self, to: &Self, place: usize) -> Option<(Vector, Real)> {
        let (from, there) = (self.samples.get(place)?, to.samples.get(place)?);
        Some((there.point - from.point, self.rounding + to.rounding + from.error + there.error))
    }

    /// Returns the point of a place.
    pub(super) fn point(&self, place: usize) -> Option<Vector> {
        Some(self.samples.get(place)?.point)
    }

    /// Returns lower bounds on the displacement and the turn of a place to another shape.
    pub(super) fn moved(&self, to: &Self, place: usize) -> Option<PlaceMotion> {
        self.moved_in(None, to, place)
    }

    /// [`moved`](Self::moved), seen from a frame that a motion states for the time between the two
    /// shapes.
    pub(super) fn moved_in(
        &self,
        frame: Option<&CommonFrame>,
        to: &Self,
        place: usize,
    ) -> Option<PlaceMotion> {
        let (from, there) = (self.samples.get(place)?, to.samples.get(place)?);
        let (mut way, mut off) = self.way(to, place)?;
        let mut direction = from.direction;
        if let Some(frame) = frame {
            let (turn, [before, after]) = frame.carries(to.t - self.t);
            let lever = from.point - before;
            way = there.point - (after + turn * lever);
            direction = turn * direction;
            let reach = before.abs().max(after.abs()).max_element() + lever.abs().max_element();
            off += 64.0 * Real::UNIT_ROUNDOFF * reach;
        }
        let way = length(way) - off;
        // Without length there is no direction.
        let has_direction = from.direction != Vector::ZERO && there.direction != Vector::ZERO;
        let turned = (there.direction - direction).length() * (from.shrink * there.shrink).sqrt();
        let angle =
            if has_direction { turned - from.tilt - there.tilt } else { Real::NEG_INFINITY };
        Some(PlaceMotion { way, angle })
    }
}
