//! Numbers from bytes, of the kinds that break geometry: equal, nearly equal, tiny, huge, and not numbers at all.

use arbitrary::Unstructured;
use parry_continuum::parry::math::{Pose, Vector};

/// Bytes on their way to numbers. When they are used up, all further numbers are 0.
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

    /// A number below `count`.
    pub fn below(&mut self, count: u8) -> usize {
        usize::from(self.byte() % count)
    }

    pub fn flag(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    /// A number that came before.
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

    /// The identity more often than not.
    pub fn pose(&mut self) -> Pose {
        if self.byte() < 160 { Pose::IDENTITY } else { Pose::new(self.point(), self.point()) }
    }
}
