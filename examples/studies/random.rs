//! A small seeded generator (xorshift64*), so that every run has the same data, as in the paper.

pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: u32) -> u32 {
        (self.bits() >> 32) as u32 % count
    }

    /// Uniform in a cube of half width `size`.
    pub fn point(&mut self, size: f64) -> [f64; 3] {
        [self.between(-size, size), self.between(-size, size), self.between(-size, size)]
    }

    /// The rows of a rotation.
    pub fn rotation(&mut self) -> [[f64; 3]; 3] {
        // From a unit quaternion.
        loop {
            let [x, y, z] = self.point(1.0);
            let w = self.between(-1.0, 1.0);
            let squared = x * x + y * y + z * z + w * w;
            if squared < 0.1 || squared > 1.0 {
                continue;
            }
            let s = 2.0 / squared;
            return [
                [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
                [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
                [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
            ];
        }
    }
}
