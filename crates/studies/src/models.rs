//! The robot of the paper's comparisons, by each model.

use continuum_demo::{ctr, ventricle};
use parry_continuum::{Chain, RobotError};

/// Links of each model.
pub const LINKS: usize = 30;

/// The concentric tube robot at its goal in the ventricle: as capsules, with caps that fit
/// (Algorithm 1), and as cylinders; the paper's K, Z* and Z.
///
/// # Errors
/// None for this robot.
pub fn models() -> Result<[(&'static str, Chain); 3], RobotError> {
    let line = ctr::three_tubes().centreline(&ventricle::goal(), LINKS);
    let (points, radii) = (&line.points, &line.radii);
    Ok([
        ("capsules", Chain::capsules(points, radii)?),
        ("fitted caps", Chain::from_centreline(points, radii)?),
        ("cylinders", Chain::cylinders(points, radii)?),
    ])
}
