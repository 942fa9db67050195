//! Reads the markups of 3D Slicer: JSON with the control points of each curve.

use super::{Line, Lines};
use crate::mesh::Frame;
use crate::text::{shown, unit_in_mm, without_mark};
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
struct File {
    markups: Vec<Markup>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Markup {
    r#type: Option<String>,
    coordinate_system: Option<Value>,
    coordinate_units: Option<Value>,
    control_points: Option<Vec<ControlPoint>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct ControlPoint {
    position: Option<Position>,
    position_status: Option<String>,
}

/// The position of a point; a point that is not set may have an empty text.
#[derive(Deserialize)]
#[serde(untagged)]
enum Position {
    Set([f64; 3]),
    Text(String),
}

pub fn read(bytes: &[u8]) -> Result<Lines, String> {
    let File { markups } = serde_json::from_slice(without_mark(bytes))
        .map_err(|error| error.to_string().replace('\n', " "))?;
    let (mut lines, mut frame) = (Vec::new(), None);
    for markup in markups {
        let kind = shown(markup.r#type.as_deref().unwrap_or("Curve"));
        let own = own_frame(markup.coordinate_system.as_ref())?;
        let unit = own_unit(markup.coordinate_units.as_ref())?;
        let points =
            markup.control_points.ok_or_else(|| format!("its {kind} has no controlPoints"))?;
        let other = (!["Curve", "Line"].contains(&kind.as_str())).then_some(kind);
        let mut line = Line { other, ..Line::default() };
        for (index, point) in points.into_iter().enumerate() {
            let is_set = point.position_status.as_deref().is_none_or(|status| status == "defined");
            match point.position {
                Some(Position::Set(place)) if is_set => line.points.push(place.map(unit)),
                Some(Position::Text(text)) if is_set && !text.is_empty() => {
                    let text = shown(&text);
                    return Err(format!(
                        "control point {index} has the position '{text}', not three numbers"
                    ));
                }
                _ => line.skipped_points += 1,
            }
        }
        if line.points.is_empty() {
            continue;
        }
        if !lines.is_empty() && frame != Some(own) {
            return Err("its curves are in different frames; save each in a file of its own".into());
        }
        frame = Some(own);
        lines.push(line);
    }
    Ok(Lines { lines, frame, states_unit: true })
}

/// Returns the frame: LPS unless the file states another one. Older versions write it as a number.
fn own_frame(system: Option<&Value>) -> Result<Frame, String> {
    let text = match system {
        None | Some(Value::Null) => return Ok(Frame::Lps),
        Some(Value::String(text)) => text.clone(),
        Some(other) => other.to_string(),
    };
    match text.as_str() {
        "LPS" | "1" => Ok(Frame::Lps),
        "RAS" | "0" => Ok(Frame::Ras),
        other => Err(format!("its coordinateSystem '{}' is neither LPS nor RAS", shown(other))),
    }
}

/// Returns the conversion of a coordinate to millimetres. Millimetres are the unit unless the file
/// states another one, by a name or by a code of three words such as
/// `["mm", "UCUM", "millimeter"]`.
fn own_unit(units: Option<&Value>) -> Result<impl Fn(f64) -> f64 + Copy + use<>, String> {
    let name = match units {
        None | Some(Value::Null) => "mm",
        Some(Value::String(name)) => name,
        Some(Value::Array(code)) => {
            code.first().and_then(Value::as_str).unwrap_or("a code without a name")
        }
        Some(_) => "neither a name nor a code",
    };
    let factor = unit_in_mm(name).ok_or_else(|| {
        format!("its coordinateUnits are '{}', not mm; save it in mm", shown(name))
    })?;
    // Division by a whole number is exact; multiplication by its inverse is not.
    Ok(move |x: f64| if factor < 1.0 { x / (1.0 / factor).round() } else { x * factor })
}
