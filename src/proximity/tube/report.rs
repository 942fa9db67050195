use parry3d_f64::math::{Real, Vector};

/// Where a tube is closest to a mesh, between bounds. All in the mesh's frame and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde-serialize",
    serde(try_from = "super::serialised::Fields", into = "super::serialised::Fields")
)]
#[non_exhaustive]
pub struct Clearance {
    /// The clearance is at least this.
    pub lower: Real,
    /// The clearance is at most this: 0 where the tube touches the mesh.
    pub upper: Real,
    /// The arc length on the centreline at the place that realises `upper`.
    pub arc_length: Real,
    /// The section of constant radius at that place, counted from the base.
    pub section: u32,
    /// The triangle there.
    pub triangle: u32,
    /// A point of the tube that is `upper` away from `on_mesh`, or nearer.
    pub on_robot: Vector,
    /// A point of the triangle; the same as `on_robot` where `upper` is 0.
    pub on_mesh: Vector,
}

/// Whether a tube keeps a margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// Its clearance is more than the margin.
    Clear,
    /// Its clearance is at most the margin.
    Touches,
    /// Its clearance is within the resolution of the margin.
    Undecided,
}

impl Clearance {
    /// What stands in a batch until its turn comes.
    pub(in crate::proximity) fn unanswered() -> Self {
        let nowhere = Vector::splat(Real::NAN);
        Self {
            lower: Real::NAN,
            upper: Real::NAN,
            arc_length: Real::NAN,
            section: 0,
            triangle: 0,
            on_robot: nowhere,
            on_mesh: nowhere,
        }
    }
}
