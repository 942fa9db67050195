//! The reference cases of `tests/data`.

use serde::Deserialize;

/// A reference distance: the inputs of one pair and the distance to 30 digits.
#[derive(Clone, Debug, Deserialize)]
pub struct Case {
    pub id: String,
    pub kind: String,
    pub cat: String,
    #[serde(default)]
    pub tri: [[f64; 3]; 3],
    #[serde(default)]
    pub s0: [f64; 3],
    #[serde(default)]
    pub s1: [f64; 3],
    #[serde(default)]
    pub u0: [f64; 3],
    #[serde(default)]
    pub u1: [f64; 3],
    #[serde(default)]
    pub p: [f64; 3],
    #[serde(default)]
    pub c: [f64; 3],
    #[serde(default)]
    pub n: [f64; 3],
    #[serde(default)]
    pub p0: [f64; 3],
    #[serde(default)]
    pub p1: [f64; 3],
    #[serde(default)]
    pub r: f64,
    #[serde(default)]
    pub caps: Vec<String>,
    pub d: String,
    pub scale: f64,
    pub mag: f64,
    pub f32: bool,
}

impl Case {
    /// Returns the expected distance, rounded to `f64`.
    pub fn distance(&self) -> f64 {
        self.d.parse().expect("a decimal number")
    }

    /// Returns whether the pair is a triangle and a link.
    pub fn is_link(&self) -> bool {
        self.kind.contains("capsule") || self.kind.contains("cylinder")
    }

    /// Returns which caps are flat, for the kinds that have caps.
    pub fn flat(&self) -> [bool; 2] {
        match self.kind.as_str() {
            "triangle_cylinder" => [true, true],
            "triangle_modified_cylinder" => [self.caps[0] == "flat", self.caps[1] == "flat"],
            _ => [false, false],
        }
    }
}

/// A reference distance between two links, to 30 digits.
#[derive(Clone, Debug, Deserialize)]
pub struct LinkCase {
    pub id: String,
    pub cat: String,
    /// The ends of both axes.
    pub links: [[[f64; 3]; 2]; 2],
    pub radii: [f64; 2],
    /// Which caps are flat.
    pub flat: [[bool; 2]; 2],
    pub d: String,
    pub scale: f64,
    pub mag: f64,
    pub f32: bool,
}

impl LinkCase {
    /// Returns the expected distance, rounded to `f64`.
    pub fn distance(&self) -> f64 {
        self.d.parse().expect("a decimal number")
    }
}

/// Reads one JSON value from each line.
pub fn read_lines<T: for<'a> Deserialize<'a>>(text: &str) -> Vec<T> {
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

/// Returns the reference distances.
pub fn distance_cases() -> Vec<Case> {
    read_lines(include_str!("../../../tests/data/distance.jsonl"))
}

/// Returns the reference distances between two links, written by
/// `crates/studies/reference/link_link.py`.
pub fn link_cases() -> Vec<LinkCase> {
    read_lines(include_str!("../../../tests/data/link_link.jsonl"))
}
