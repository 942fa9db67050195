//! Triangle and link as packs take them: as numbers in a row, the caps among them.

use continuum_testing::kernels::Input;
use continuum_testing::precision::Precision;
use parry_continuum::distance::laboratory::Kernel;
use parry_continuum::distance::{Scalar, Vec3, triangle_modified_cylinder};

/// The distance of triangle and link; the caps are numbers, 1 where they are flat.
pub struct LinkDistance;

/// How many numbers a triangle and a link have.
pub const NUMBERS: usize = 18;

impl Kernel<NUMBERS, 1> for LinkDistance {
    #[inline(always)]
    fn run<T: Scalar>(n: [T; NUMBERS]) -> [T; 1] {
        let (triangle, [start, end]) = (
            [Vec3::new(n[0], n[1], n[2]), Vec3::new(n[3], n[4], n[5]), Vec3::new(n[6], n[7], n[8])],
            [Vec3::new(n[9], n[10], n[11]), Vec3::new(n[12], n[13], n[14])],
        );
        let flat = [n[16].zero().lt(n[16]), n[17].zero().lt(n[17])];
        [triangle_modified_cylinder(triangle, start, end, n[15], flat).distance]
    }
}

/// Triangle, link and caps in a row.
pub fn numbers<T: Precision>(input: &Input<T>, flat: [bool; 2]) -> [T; NUMBERS] {
    let Input { triangle: [a, b, c], start, end, radius, .. } = *input;
    let mut numbers = [radius; NUMBERS];
    let points = [a, b, c, start, end].map(|v| [v.x, v.y, v.z]);
    numbers.iter_mut().zip(points.into_iter().flatten()).for_each(|(to, from)| *to = from);
    [numbers[16], numbers[17]] = flat.map(|flat| T::from_f64(f64::from(u8::from(flat))));
    numbers
}
