//! The queries about a robot in the wall.

use crate::placement::place;
use crate::{Answers, Robot, Wall};
use mesh_files::{Bounds, Frame};
use parry_continuum::parry::math::Real;
use parry_continuum::proximity::{Opening, Proximity};
use serde_json::json;
use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen]
impl Wall {
    /// How far each link is. `matrix` is blank, or the pose: 4 lines of 4 numbers.
    ///
    /// # Errors
    /// The matrix is not a pose, the frames are not known, or the robot is out of range.
    pub fn ask(&mut self, robot: &Robot, matrix: &str) -> Result<Answers, String> {
        let placement = place(robot, self, matrix)?;
        let (chain, pose) = (robot.chain(), placement.pose);
        let mut links = Vec::new();
        self.search.per_link(chain, &pose, &mut links).map_err(|error| error.to_string())?;
        let minimum = self.search.minimum(chain, &pose).map_err(|error| error.to_string())?;
        let mut sides = Vec::new();
        self.search.link_sides(chain, &pose, &mut sides).map_err(|error| error.to_string())?;
        let robot = chain.links().to_vec();
        let ends = [robot[0].start(), robot[robot.len() - 1].end()];
        let [base, tip] = ends.map(|end| self.search.side(pose * end));
        Ok(Answers { links, minimum, base, tip, sides, robot, placement })
    }

    /// The answers with all digits, as JSON: mesh, base, links and minimum.
    pub fn report(&self, answers: &Answers) -> String {
        let bounds = self.bounds().map(|Bounds { low, high }| [low, high]);
        let surface = self.search.surface();
        let opening = |opening: &Opening| {
            let Opening { edges, width, centre, .. } = opening;
            json!({ "edges": edges, "width": width, "centre": centre.to_array() })
        };
        let report = json!({
            "mesh": {
                "triangles": self.search.triangles().len(),
                "bounds": bounds,
                "frame": self.frame().map(Frame::name),
                "unit": self.is_millimetres.then_some("mm"),
                "openings": surface.openings.iter().map(opening).collect::<Vec<_>>(),
                "nonmanifold_edges": surface.nonmanifold_edges,
                "misoriented_edges": surface.misoriented_edges,
            },
            "turned": answers.placement.turned.map(|frames| frames.map(Frame::name)),
            "base": answers.base(),
            "tip": answers.tip(),
            "sides": answers.sides(),
            "inside": answers.is_inside(),
            "links": answers.links,
            "minimum": answers.minimum,
        });
        report.to_string()
    }

    /// The proof that the robot keeps more than the margin, for `check_proof.py`. Nothing if the
    /// robot does not keep the margin, or keeps it only within rounding.
    ///
    /// # Errors
    /// As [`ask`](Self::ask); or the margin is negative.
    pub fn prove(
        &mut self,
        robot: &Robot,
        matrix: &str,
        margin: Real,
    ) -> Result<Option<String>, String> {
        let pose = place(robot, self, matrix)?.pose;
        let proof =
            self.search.prove(robot.chain(), &pose, margin).map_err(|error| error.to_string())?;
        Ok(proof.map(|proof| proof.to_string()))
    }
}
