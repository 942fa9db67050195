//! The labels of a segmentation, with their volumes.

use crate::number::digits;
use crate::options::Options;
use crate::{messages, outputs};
use serde_json::json;

/// Prints a line for each label, and which of them form the wall.
pub fn print(my: &Options) -> Result<(), String> {
    let options = mesh_files::Options::default().with_no_position_allowed(my.allow_no_position);
    let labels =
        mesh_files::load_labels(&my.mesh, &options).map_err(|error| messages::of_file(&error))?;
    let is_wall = |label: u32| my.label.is_none_or(|wall| wall == label);
    let mut text = String::new();
    if my.json {
        let object = |found: &mesh_files::LabelVolume| {
            json!({
                "label": found.label,
                "voxels": found.voxels,
                "volume_mm3": found.volume,
                "wall": is_wall(found.label),
            })
        };
        let objects: Vec<_> = labels.iter().map(object).collect();
        text = format!("{:#}\n", json!(objects));
    } else {
        for found in &labels {
            let (cubic, millilitres) = (digits(found.volume, 4), digits(found.volume / 1000.0, 3));
            text += &format!(
                "label {}: {cubic} mm^3 ({millilitres} ml), {} voxels\n",
                found.label, found.voxels
            );
        }
        text += &wall(my, labels.iter().map(|found| found.label).collect());
    }
    outputs::print(&text)
}

/// Returns a line that says which labels form the wall.
fn wall(my: &Options, labels: Vec<u32>) -> String {
    match (my.label, &labels[..]) {
        (Some(label), labels) if labels.contains(&label) => format!("wall: label {label}\n"),
        (Some(label), _) => format!("wall: none, since no voxel has label {label}\n"),
        (None, [label]) => format!("wall: label {label}\n"),
        (None, labels) => {
            format!(
                "wall: labels {} merged; --label takes one of them\n",
                mesh_files::list_labels(labels)
            )
        }
    }
}
