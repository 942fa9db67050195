//! The report about one robot, as lines or as JSON.

use crate::number::{self, fixed, length};
use crate::sides::{Sides, name, place};
use crate::verdict::Verdict;
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::proximity::{Clearance, LinkProximity, Opening, Proximity, Witness};
use serde_json::json;

/// What became of the proof that `--prove` asks for.
pub enum Proven {
    /// It was written; this command checks it.
    By(String),
    /// The margin is not kept, or undecided.
    NotKept,
    /// The margin is kept, but by too little for a proof.
    TooClose,
}

pub struct Report<'a> {
    pub wall: &'a Wall,
    /// The frames of robot and wall, if the robot was turned from one to the other.
    pub turned: Option<[Frame; 2]>,
    pub sides: Sides,
    /// Whether --inside asks for the sides.
    pub asks_inside: bool,
    pub links: Vec<LinkProximity>,
    pub curve: Option<Clearance>,
    pub minimum: LinkProximity,
    pub verdict: Option<Verdict>,
    pub proven: Option<Proven>,
    pub doubts: &'a [String],
}

impl Report<'_> {
    /// Returns the report as lines. The last line is the minimum.
    pub fn lines(&self) -> String {
        let unit = self.wall.unit();
        let mut lines = vec![format!("mesh: {}", self.wall.describe())];
        if let Some([from, to]) = self.turned {
            lines.push(format!("robot: turned from {} to {}", from.name(), to.name()));
        }
        lines.push(format!("base: {}", place(self.sides.base)));
        if !self.sides.is_one() {
            lines.push(format!("tip: {}", place(self.sides.tip)));
            lines.push(format!("sides: {}", self.sides.of_links()));
        }
        let link = |found: &LinkProximity| {
            let Witness { on_robot, on_mesh, .. } = found.witness;
            let LinkProximity { link, distance, .. } = found;
            let [on_robot, on_mesh] = [on_robot, on_mesh].map(|point| number::place(point, 6));
            format!("link {link}: {}, from {on_robot} to {on_mesh}", fixed(*distance, 6))
        };
        lines.extend(self.links.iter().map(link));
        if let Some(curve) = &self.curve {
            let doubt = if curve.resolved { "" } else { ", farther apart than --tolerance" };
            let Clearance { lower, upper, .. } = curve;
            let place = curve.witness.arc_length;
            let [lower, upper] = [lower, upper].map(|bound| fixed(*bound, 6));
            let place = fixed(place, 3);
            lines.push(format!("curve: {lower} to {upper}, {place} along it{doubt}"));
        }
        lines.extend(self.proven.as_ref().map(|proven| {
            match proven {
                Proven::By(command) => format!("proof: check it with {command}"),
                Proven::NotKept => "proof: none, since the margin is not kept".into(),
                Proven::TooClose => {
                    "proof: none, since the margin is kept by too little; give a smaller --margin"
                        .into()
                }
            }
        }));
        if self.asks_inside {
            let all = if self.sides.is_inside() { "every link" } else { "not every link" };
            lines.push(format!("inside: {all}"));
        }
        lines.extend(self.verdict.map(|verdict| verdict.describe(&self.sides, unit)));
        lines.push(minimum(&format!("link {}", self.minimum.link), &self.minimum, self.wall));
        lines.join("\n") + "\n"
    }

    /// Returns the report as JSON, with all digits.
    pub fn json(&self) -> String {
        let Wall { search, bounds, frame, .. } = self.wall;
        let surface = search.surface();
        let opening = |opening: &Opening| {
            let Opening { edges, width, centre, .. } = opening;
            json!({ "edges": edges, "width": width, "centre": centre.to_array() })
        };
        let report = json!({
            "mesh": {
                "triangles": search.triangles().len(),
                "bounds": [bounds.mins.to_array(), bounds.maxs.to_array()],
                "frame": frame.map(Frame::name),
                "unit": self.wall.unit(),
                "openings": surface.openings.iter().map(opening).collect::<Vec<_>>(),
                "nonmanifold_edges": surface.nonmanifold_edges,
                "misoriented_edges": surface.misoriented_edges,
            },
            "turned": self.turned.map(|frames| frames.map(Frame::name)),
            "base": name(self.sides.base),
            "tip": name(self.sides.tip),
            "sides": self.sides.links.iter().map(|side| name(*side)).collect::<Vec<_>>(),
            "inside": self.sides.is_inside(),
            "links": self.links,
            "curve": self.curve,
            "minimum": self.minimum,
            "margin": self.verdict.map(|verdict| json!({
                "value": verdict.margin,
                "kept": verdict.is_kept,
            })),
            "proof": match &self.proven {
                Some(Proven::By(command)) => Some(command),
                _ => None,
            },
            "warnings": self.doubts,
        });
        format!("{report:#}\n")
    }
}

/// Returns the last line: the least distance, and where it is. `subject` names the link or the
/// shape.
pub fn minimum(subject: &str, found: &LinkProximity, wall: &Wall) -> String {
    let unit = wall.unit();
    format!(
        "minimum {}: {subject}, {} from the base, triangle {}",
        length(found.distance, 4, unit),
        length(found.witness.arc_length, 3, unit),
        found.witness.triangle
    )
}
