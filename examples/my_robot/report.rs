//! What was found of one robot, as lines or as JSON.

use crate::frames::name;
use crate::wall::Wall;
use mesh_files::Frame;
use parry_continuum::proximity::{Clearance, LinkProximity, Proximity, Side};
use serde_json::json;
use std::io::{self, Write};

pub struct Report<'a> {
    pub wall: &'a Wall,
    pub turned: Option<[Frame; 2]>,
    pub base: Side,
    pub links: Vec<LinkProximity>,
    pub curve: Option<Clearance>,
    pub minimum: LinkProximity,
    pub doubts: &'a [String],
}

impl Report<'_> {
    pub fn print(&self, as_json: bool) -> io::Result<()> {
        if as_json { self.print_json() } else { self.print_lines() }
    }

    fn print_lines(&self) -> io::Result<()> {
        let mut out = io::stdout();
        writeln!(out, "mesh: {}", self.wall.describe())?;
        if let Some([from, to]) = self.turned {
            writeln!(out, "robot: turned from {} to {}", name(from), name(to))?;
        }
        let base = match self.base {
            Side::Inside => "inside the mesh",
            Side::Outside => "outside the mesh",
            Side::Undecided => "on the mesh, or the mesh is open there",
        };
        writeln!(out, "base: {base}")?;
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
        writeln!(out, "minimum {:.6}", self.minimum.distance)
    }

    fn print_json(&self) -> io::Result<()> {
        let Wall { search, bounds, frame, states_unit } = self.wall;
        let report = json!({
            "mesh": {
                "triangles": search.triangles().len(),
                "bounds": [bounds.mins.to_array(), bounds.maxs.to_array()],
                "frame": frame.map(name),
                "unit": states_unit.then_some("mm"),
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
            "warnings": self.doubts,
        });
        writeln!(io::stdout(), "{report:#}")
    }
}
