//! What the function that was called names its parameters.

use crate::error::Refused;

/// The names of a robot's parameters: `points`, `radii` and `pose` for one robot, `points_a` and so
/// on for a pair. For a list of robots, an error also names the entry, such as `robots[0]`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Names {
    pub points: &'static str,
    pub radii: &'static str,
    pub pose: &'static str,
    /// What other parameters end in.
    suffix: &'static str,
    /// The place in the list `robots`.
    entry: Option<usize>,
}

impl Names {
    /// One robot, whose centreline is the parameter `points`.
    pub(crate) fn one(points: &'static str) -> Self {
        Self { points, radii: "radii", pose: "pose", suffix: "", entry: None }
    }

    /// The first and the second robot of a pair.
    pub(crate) const PAIR: [Self; 2] = [
        Self { points: "points_a", radii: "radii_a", pose: "pose_a", suffix: "_a", entry: None },
        Self { points: "points_b", radii: "radii_b", pose: "pose_b", suffix: "_b", entry: None },
    ];

    /// An entry of the list `robots`.
    pub(crate) fn entry(entry: usize) -> Self {
        Self { entry: Some(entry), ..Self::one("points") }
    }

    /// What stands for the whole robot.
    pub(crate) fn robot(&self) -> String {
        self.entry.map_or(self.points.to_owned(), |entry| format!("robots[{entry}]"))
    }

    /// The error with these parameter names. The library uses the names for one robot.
    pub(crate) fn apply(&self, refused: impl Into<Refused>) -> Refused {
        let refused = refused.into();
        self.in_entry(if self.suffix.is_empty() { refused } else { self.suffixed(refused) })
    }

    /// The error of an entry of the list, if there is a list.
    pub(crate) fn in_entry(&self, refused: Refused) -> Refused {
        match self.entry {
            Some(entry) => refused.of(&format!("robots[{entry}]")),
            None => refused,
        }
    }

    fn suffixed(&self, mut refused: Refused) -> Refused {
        match refused.parameter_mut() {
            Some(parameter) => {
                *parameter = match (*parameter, self.suffix) {
                    ("points", _) => self.points,
                    ("radii", _) => self.radii,
                    ("tangents", "_a") => "tangents_a",
                    ("tangents", _) => "tangents_b",
                    ("deviation", "_a") => "deviation_a",
                    ("deviation", _) => "deviation_b",
                    ("turn", "_a") => "turn_a",
                    ("turn", _) => "turn_b",
                    (other, _) => other,
                };
                refused
            }
            None => refused.of(self.points),
        }
    }
}
