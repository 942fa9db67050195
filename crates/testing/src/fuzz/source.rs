//! Numbers from bytes, of the kinds that break geometry: equal, nearly equal, tiny, huge, infinite
//! and NaN.

use arbitrary::Unstructured;
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Rot3, Vector};
use parry_continuum::parry::shape::Cuboid;

/// Bytes that are converted to numbers. When they are used up, all further numbers are 0.
pub struct Source<'a> {
    bytes: Unstructured<'a>,
    seen: Vec<f64>,
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes: Unstructured::new(bytes), seen: vec![0.0, 1.0] }
    }

    pub fn byte(&mut self) -> u8 {
        self.bytes.arbitrary().unwrap_or(0)
    }

    /// Returns a number below `count`.
    pub fn below(&mut self, count: u8) -> usize {
        usize::from(self.byte() % count)
    }

    pub fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// Returns an earlier number.
    fn earlier(&mut self) -> f64 {
        let place = usize::from(self.byte());
        self.seen[place % self.seen.len()]
    }

    pub fn number(&mut self) -> f64 {
        let number = match self.byte() % 10 {
            0 => f64::from_bits(self.bytes.arbitrary().unwrap_or(0)),
            1 | 2 => f64::from(self.byte() as i8 / 16),
            3 => f64::from(self.bytes.arbitrary::<i32>().unwrap_or(0)) / f64::from(1 << 24),
            4 => f64::from(self.bytes.arbitrary::<i16>().unwrap_or(0)) / 256.0,
            5 => 2.0_f64.powi(i32::from(self.byte() as i8)),
            6 => self.earlier(),
            7 => -self.earlier(),
            8 => {
                let near = self.earlier();
                let away = 2.0_f64.powi(-i32::from(self.byte() % 56));
                near + near * away
            }
            _ => {
                let number = self.earlier();
                (0..self.byte() % 4).fold(number, |number, _| number.next_up())
            }
        };
        if number.is_finite() && number != 0.0 {
            self.seen.push(number);
        }
        number
    }

    pub fn point(&mut self) -> Vector {
        Vector::new(self.number(), self.number(), self.number())
    }

    /// Returns a pose, the identity in most cases.
    pub fn pose(&mut self) -> Pose {
        if self.byte() < 160 { Pose::IDENTITY } else { Pose::new(self.point(), self.point()) }
    }
    pub fn bits(&mut self) -> u64 {
        self.bytes.arbitrary().unwrap_or(0)
    }

    /// Returns a vector of size one or tiny, along an axis in most cases.
    pub fn way(&mut self) -> Vector {
        let size = 2.0_f64.powi(-(self.below(50) as i32));
        let way = match self.below(8) {
            axis @ 0..3 => Vector::AXES[axis],
            axis @ 3..6 => -Vector::AXES[axis - 3],
            6 => Vector::new(0.6, 0.0, 0.8),
            _ => {
                Vector::new(f64::from(self.byte() as i8), f64::from(self.byte() as i8), 40.0)
                    / 128.0
            }
        };
        if self.flag() { way } else { way * size }
    }

    /// Returns the pose, or a pose near it: shifted, or turned about an axis.
    pub fn nudged(&mut self, pose: Pose) -> Pose {
        match self.below(4) {
            0 => pose,
            1 => Pose::from_translation(self.way()) * pose,
            2 => Pose::from_rotation(Rot3::from_scaled_axis(self.way())) * pose,
            _ => pose * Pose::from_rotation(Rot3::from_scaled_axis(self.way())),
        }
    }

    /// Returns a mesh of size one: a grid or a box, aligned with the axes, or triangles of any
    /// kind.
    pub fn wall(&mut self) -> (Vec<Vector>, Vec<[u32; 3]>) {
        match self.below(4) {
            0 => {
                let count = 1 + self.below(12) as u32;
                let place = |k: u32| f64::from(k) / f64::from(count) - 0.5;
                let bump = self.number() % 1.0;
                let number = |i: u32, j: u32| i * (count + 1) + j;
                let vertex = |i: u32, j: u32| {
                    Vector::new(place(i), place(j), if (i * j) % 7 == 6 { bump } else { 0.0 })
                };
                let cells = (0..count).flat_map(|i| (0..count).map(move |j| (i, j)));
                let indices = cells.flat_map(|(i, j)| {
                    let [a, b] = [number(i, j), number(i + 1, j)];
                    let [c, d] = [number(i + 1, j + 1), number(i, j + 1)];
                    [[a, b, c], [a, c, d]]
                });
                let all = (0..=count).flat_map(|i| (0..=count).map(move |j| (i, j)));
                (all.map(|(i, j)| vertex(i, j)).collect(), indices.collect())
            }
            1 => Cuboid::new(Vector::new(0.5, 0.25, 1.0)).to_trimesh(),
            _ => {
                let limit =
                    |vertex: Vector| vertex.map(|x| if x.abs() < 1e3 { x } else { x.sin() });
                let vertices: Vec<_> =
                    (0..3 + self.below(10)).map(|_| limit(self.point())).collect();
                let vertices: Vec<_> = vertices
                    .into_iter()
                    .map(|vertex| if vertex.is_finite() { vertex } else { Vector::ONE })
                    .collect();
                let count = vertices.len() as u8;
                let corners =
                    (0..1 + count).map(|_| [0; 3].map(|_| self.below(count) as u32)).collect();
                (vertices, corners)
            }
        }
    }

    /// Returns points and radii of size one: along an axis and touching aligned shapes, or any.
    pub fn centreline(&mut self) -> (Vec<Vector>, Vec<f64>) {
        let count = 1 + self.below(6);
        let radius = [0.0, 0.125, 0.25, 0.1][self.below(4)];
        let near = Vector::Z * radius + self.way();
        let along = Vector::AXES[self.below(3)] * 0.25;
        let is_any = self.below(4) == 0;
        let points =
            (0..=count).map(|k| if is_any { self.point() } else { near + along * k as f64 });
        let points: Vec<_> =
            points.map(|point| point.clamp(Vector::splat(-1e3), Vector::splat(1e3))).collect();
        let step = if self.flag() { 0.5 } else { 1.0 };
        (points, (0..count).map(|k| if k > count / 2 { radius * step } else { radius }).collect())
    }

    /// Returns a [`centreline`](Self::centreline) as a chain.
    pub fn chain(&mut self) -> Option<Chain> {
        let build = [Chain::from_centreline, Chain::cylinders, Chain::capsules][self.below(3)];
        let (points, radii) = self.centreline();
        build(&points, &radii).ok()
    }
}
