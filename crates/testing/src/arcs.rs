//! Curves whose curvature is known everywhere: circular arcs that join with a common tangent.

use crate::Random;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};

/// A part of the tube with one radius.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    pub length: Real,
    pub radius: Real,
    /// An upper bound on the curvature of its arcs.
    pub curvature: Real,
}

/// The centreline of a tube, by arc length.
#[derive(Clone, Debug)]
pub struct Arcs {
    /// For each arc: the arc length at its end, the frame at its start (the arc begins along z),
    /// and its curvature vector.
    arcs: Vec<(Real, Pose, Vector)>,
    pub stretches: Vec<Stretch>,
    frame: Pose,
}

impl Arcs {
    /// Returns an empty centreline. Its first arc leaves `frame` along z.
    pub fn from_frame(frame: Pose) -> Self {
        Self { arcs: Vec::new(), stretches: Vec::new(), frame }
    }

    /// Appends arcs of one radius, each with a length and a curvature vector, whose z coordinate is
    /// ignored.
    pub fn push(&mut self, radius: Real, arcs: &[(Real, Vector)]) {
        let (mut length, mut curvature) = (0.0, 0.0);
        for &(part, bend) in arcs {
            let bend = Vector::new(bend.x, bend.y, 0.0);
            self.arcs.push((self.length() + length + part, self.frame, bend));
            self.frame *= along(bend, part);
            length += part;
            curvature = bend.length().max(curvature);
        }
        self.stretches.push(Stretch { length, radius, curvature });
    }

    /// Returns up to three stretches of up to two arcs. Their lengths range from below the radius
    /// to 20 radii. Their radius of curvature is as small as slightly above the tube's radius.
    pub fn random(random: &mut Random, frame: Pose, size: Real) -> Self {
        let mut all = Self::from_frame(frame);
        for _ in 0..=random.below(3) {
            let radius = size * random.between(0.2, 2.0);
            let curvature =
                random.between(0.0, 0.95) * [1.0, 0.1][random.below(2) as usize] / radius;
            let mut arc = |_| {
                let length =
                    radius * [0.3, 2.0, 20.0][random.below(3) as usize] * random.between(0.3, 1.0);
                let share = [1.0, 1.0, 0.0, random.unit()][random.below(4) as usize];
                let angle = random.between(0.0, 7.0);
                (length, Vector::new(angle.cos(), angle.sin(), 0.0) * (curvature * share))
            };
            let arcs: Vec<_> = (0..2).map(&mut arc).collect();
            let count = 1 + random.below(2) as usize;
            all.push(radius, &arcs[..count]);
        }
        all
    }

    pub fn length(&self) -> Real {
        self.stretches.iter().map(|stretch| stretch.length).sum()
    }

    /// Returns the point and the unit tangent at an arc length.
    pub fn at(&self, s: Real) -> (Vector, Vector) {
        let k = self.arcs.partition_point(|arc| arc.0 < s).min(self.arcs.len() - 1);
        let start = if k == 0 { 0.0 } else { self.arcs[k - 1].0 };
        let (_, frame, bend) = self.arcs[k];
        let frame = frame * along(bend, s - start);
        (frame.translation, frame.rotation * Vector::Z)
    }

    /// Returns the total turn up to an arc length.
    pub fn turned(&self, s: Real) -> Real {
        let (mut from, mut turned) = (0.0, 0.0);
        for &(end, _, bend) in &self.arcs {
            turned += bend.length() * (s.min(end) - from).max(0.0);
            from = end;
        }
        turned
    }

    /// Returns the unit tangents at both ends.
    pub fn end_tangents(&self) -> [Vector; 2] {
        [0.0, self.length()].map(|s| self.at(s).1)
    }

    /// Returns the length of the shortest arc.
    pub fn shortest(&self) -> Real {
        self.arcs
            .iter()
            .fold((0.0, Real::INFINITY), |(from, least), arc| (arc.0, least.min(arc.0 - from)))
            .1
    }

    /// Returns points at most `spacing` apart, and the radius between each two. Near the ends of
    /// every stretch it adds points at the distances `at_ends`.
    pub fn samples(&self, spacing: Real, at_ends: &[Real]) -> (Vec<Vector>, Vec<Real>) {
        let (mut points, mut radii, mut from) = (vec![self.at(0.0).0], Vec::new(), 0.0);
        for stretch in &self.stretches {
            let count = (stretch.length / spacing).ceil().max(1.0) as usize;
            let mut here: Vec<_> =
                (1..=count).map(|k| stretch.length * k as Real / count as Real).collect();
            let near = at_ends.iter().filter(|off| **off < 0.4 * stretch.length);
            here.extend(near.flat_map(|off| [*off, stretch.length - off]));
            here.sort_by(Real::total_cmp);
            here.dedup();
            points.extend(here.iter().map(|s| self.at(from + s).0));
            radii.extend(std::iter::repeat_n(stretch.radius, here.len()));
            from += stretch.length;
        }
        (points, radii)
    }
}

/// Returns the pose of an arc's end relative to its start. The arc begins along z.
fn along(bend: Vector, length: Real) -> Pose {
    let curvature = bend.length();
    let turn = Rotation::from_scaled_axis(bend * length);
    if curvature * length < 1e-9 {
        return Pose::from_parts(Vector::Z * length, turn);
    }
    let inward = bend.cross(Vector::Z) / curvature;
    // 1 - cos would lose half of the digits at small angles.
    let (sin, cos) = (0.5 * curvature * length).sin_cos();
    Pose::from_parts((Vector::Z * cos + inward * sin) * (2.0 * sin / curvature), turn)
}
