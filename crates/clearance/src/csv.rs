//! Answers as CSV, with all digits.

use crate::number::all_digits;
use parry_continuum::proximity::{LinkProximity, Witness};

/// The columns of an answer after its number.
pub const COLUMNS: &str = "distance,arc_length,segment,triangle,\
                           robot_x,robot_y,robot_z,mesh_x,mesh_y,mesh_z";

/// Returns a line for each link.
pub fn links(links: &[LinkProximity]) -> String {
    let lines = links.iter().map(|found| format!("{},{}\n", found.link, answer(found)));
    format!("link,{COLUMNS}\n") + &lines.collect::<String>()
}

/// Returns the columns of an answer.
pub fn answer(found: &LinkProximity) -> String {
    let Witness { on_robot, on_mesh, triangle, arc_length, segment, .. } = found.witness;
    let [robot, mesh] = [on_robot, on_mesh].map(|point| point.to_array().map(all_digits).join(","));
    let [distance, arc_length] = [found.distance, arc_length].map(all_digits);
    format!("{distance},{arc_length},{segment},{triangle},{robot},{mesh}")
}
