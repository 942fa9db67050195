//! The markups of 3D Slicer: JSON with the control points of each curve.

use super::Lines;
use crate::mesh::Frame;
use crate::text::{shown, without_mark};
use serde::Deserialize;

#[derive(Deserialize)]
struct File {
    markups: Vec<Markup>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Markup {
    coordinate_system: Option<String>,
    coordinate_units: Option<String>,
    control_points: Vec<ControlPoint>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ControlPoint {
    position: Option<[f64; 3]>,
    position_status: Option<String>,
}

pub fn read(bytes: &[u8]) -> Result<Lines, String> {
    let File { markups } =
        serde_json::from_slice(without_mark(bytes)).map_err(|error| error.to_string().replace('\n', " "))?;
    let (mut lines, mut frame) = (Vec::new(), None);
    for markup in markups {
        // Older versions number the frames.
        let own = match markup.coordinate_system.as_deref() {
            Some("LPS" | "1") => Some(Frame::Lps),
            Some("RAS" | "0") => Some(Frame::Ras),
            Some(other) => {
                return Err(format!("its coordinateSystem '{}' is neither LPS nor RAS", shown(other)));
            }
            None => None,
        };
        match markup.coordinate_units.as_deref() {
            None | Some("mm") => {}
            Some(unit) => return Err(format!("its coordinateUnits are '{}', not mm", shown(unit))),
        }
        let is_set =
            |point: &ControlPoint| point.position_status.as_deref().is_none_or(|status| status == "defined");
        let line: Vec<_> = markup
            .control_points
            .iter()
            .filter(|point| is_set(point))
            .filter_map(|point| point.position)
            .collect();
        if line.is_empty() {
            continue;
        }
        if !lines.is_empty() && frame != own {
            return Err("its curves are in different frames; save each in a file of its own".into());
        }
        frame = own;
        lines.push(line);
    }
    Ok(Lines { lines, frame })
}
