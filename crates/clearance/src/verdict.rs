//! Whether a robot keeps a margin.

use crate::number::as_written;
use crate::sides::Sides;
use parry_continuum::proximity::Clearance;

/// The decision about a margin.
#[derive(Clone, Copy)]
pub struct Verdict {
    pub margin: f64,
    /// `None` if the margin lies between the bounds of the curve.
    pub is_kept: Option<bool>,
    /// For the curve instead of the chain: whether its bounds meet --tolerance.
    curve: Option<bool>,
}

impl Verdict {
    /// Decides by the distance of the chain, or by the bounds of the curve if there are any.
    pub fn new(margin: f64, distance: f64, curve: Option<&Clearance>) -> Self {
        let is_kept = match curve {
            None => Some(distance > margin),
            Some(curve) if curve.lower > margin => Some(true),
            Some(curve) if curve.upper <= margin => Some(false),
            Some(_) => None,
        };
        Self { margin, is_kept, curve: curve.map(|curve| curve.resolved) }
    }

    /// Names the decision.
    pub fn decision(&self) -> &'static str {
        match self.is_kept {
            Some(true) => "kept",
            Some(false) => "not kept",
            None => "undecided",
        }
    }

    /// Describes the decision in one line. Names the sides of the wall, since distances are
    /// unsigned.
    pub fn describe(&self, sides: &Sides, unit: Option<&str>) -> String {
        let margin = as_written(self.margin, unit);
        let decision = self.decision();
        let subject = if self.curve.is_some() { " by the curve" } else { "" };
        let advice = match (self.is_kept, self.curve) {
            (None, Some(true)) => "; give a smaller --tolerance",
            (None, _) => "; write more points along the robot",
            (Some(_), _) => "",
        };
        format!("margin {margin}: {decision}{subject}, {}{advice}", sides.ends())
    }
}
