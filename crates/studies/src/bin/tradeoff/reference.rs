//! How exact the reference is: its stations twice as close, and chains capped by Algorithm 1 at the
//! same stations.

use crate::outcome::{REFERENCE_SPACING, reference};
use crate::shapes::Stations;
use crate::ways::text;
use continuum_demo::ctr::{Joints, Robot};
use parry_continuum::Chain;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Proximity};

/// The largest difference of clearances from the reference's, in magnitude, mm.
pub struct Checked {
    /// With stations twice as close.
    pub halved: Real,
    /// With stations four times as close.
    pub quartered: Real,
    /// With the caps of Algorithm 1.
    pub algorithm_1: Real,
}

/// Checks the reference on some shapes.
pub fn check(
    robot: &Robot,
    shapes: &[Joints],
    mesh: &TriMesh,
    base: &Pose,
) -> Result<Checked, String> {
    let mut search = BvhSearch::new(mesh).map_err(text)?;
    let mut checked = Checked { halved: 0.0, quartered: 0.0, algorithm_1: 0.0 };
    for joints in shapes {
        let curve = Stations::graded(robot, joints, REFERENCE_SPACING).curve(robot, joints);
        let capped = Chain::from_centreline(&curve.points, &curve.radii).map_err(text)?;
        let mut clearance =
            |chain: &Chain| Ok::<_, String>(search.minimum(chain, base).map_err(text)?.distance);
        let truth = clearance(&reference(robot, joints, REFERENCE_SPACING)?)?;
        let halved = clearance(&reference(robot, joints, REFERENCE_SPACING / 2.0)?)?;
        let quartered = clearance(&reference(robot, joints, REFERENCE_SPACING / 4.0)?)?;
        let off = |largest: Real, clearance: Real| largest.max((clearance - truth).abs());
        checked.halved = off(checked.halved, halved);
        checked.quartered = off(checked.quartered, quartered);
        checked.algorithm_1 = off(checked.algorithm_1, clearance(&capped)?);
    }
    Ok(checked)
}
