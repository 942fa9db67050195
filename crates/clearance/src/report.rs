//! The report about one robot, as lines or as JSON.

use crate::frames::name;
use crate::number::length;
use crate::single::Proven;
use crate::verdict::{Verdict, side};
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::proximity::{Clearance, LinkProximity, Proximity, Side};
use serde_json::json;
use std::io::{self, Write};

pub struct Report<'a> {
    pub wall: &'a Wall,
    /// The frames of robot and wall, if the robot was turned from one to the other.
    pub turned: Option<[Frame; 2]>,
    pub base: Side,
    pub links: Vec<LinkProximity>,
    pub curve: Option<Clearance>,
    pub minimum: LinkProximity,
    pub verdict: Option<Verdict>,
    pub proven: Option<Proven>,
    pub doubts: &'a [String],
}

impl Report<'_> {
    pub fn print(&self, as_json: bool) -> io::Result<()> {
        if as_json { self.print_json() } else { self.print_lines() }
    }

    fn print_lines(&self) -> io::Result<()> {
        let mut out = io::BufWriter::new(io::stdout().lock());
        writeln!(out, "mesh: {}", self.wall.describe())?;
        if let Some([from, to]) = self.turned {
            writeln!(out, "robot: turned from {} to {}", name(from), name(to))?;
        }
        writeln!(out, "base: {}", side(self.base))?;
        for l in &self.links {
            writeln!(
                out,
                "link {}: {:.6}, from {:.6} to {:.6}",
                l.link, l.distance, l.witness.on_robot, l.witness.on_mesh
            )?;
        }
        if let Some(curve) = &self.curve {
            let doubt = if curve.resolved { "" } else { ", farther apart than --tolerance" };
            writeln!(
                out,
                "curve: {:.6} to {:.6}, {:.3} along it{doubt}",
                curve.lower, curve.upper, curve.witness.arc_length
            )?;
        }
        match &self.proven {
            Some(Proven::By(command)) => writeln!(out, "proof: check it with {command}")?,
            Some(Proven::NotKept) => writeln!(out, "proof: none, since the margin is not kept")?,
            Some(Proven::TooClose) => writeln!(
                out,
                "proof: none, since the margin is kept by too little; give a smaller --margin"
            )?,
            None => {}
        }
        if let Some(verdict) = &self.verdict {
            writeln!(out, "{}", verdict.describe(self.base, self.wall.unit()))?;
        }
        writeln!(
            out,
            "{}",
            minimum(&format!("link {}", self.minimum.link), &self.minimum, self.wall)
        )?;
        out.flush()
    }

    fn print_json(&self) -> io::Result<()> {
        let Wall { search, bounds, frame, .. } = self.wall;
        let report = json!({
            "mesh": {
                "triangles": search.triangles().len(),
                "bounds": [bounds.mins.to_array(), bounds.maxs.to_array()],
                "frame": frame.map(name),
                "unit": self.wall.unit(),
            },
            "turned": self.turned.map(|frames| frames.map(name)),
            "base": match self.base {
                Side::Inside => "inside",
                Side::Outside => "outside",
                Side::Undecided => "undecided",
            },
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
        writeln!(io::stdout(), "{report:#}")
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
