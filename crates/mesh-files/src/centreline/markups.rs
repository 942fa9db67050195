//! Reads the markups of 3D Slicer: JSON with the control points of each curve.

use super::lines::{Line, Lines};
use crate::mesh::Frame;
use crate::text::{shown, to_mm, unit_in_mm, without_mark};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// An upper bound on the memory of the values of a file, for each of its bytes. `[0],` becomes a
/// [`Value`] of 32 bytes with room for four others, in a list that has room for as many again and
/// is copied as it grows.
pub const EACH: u64 = 64;

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Markup {
    r#type: Value,
    coordinate_system: Value,
    coordinate_units: Value,
    control_points: Value,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct ControlPoint {
    position: Value,
    position_status: Value,
}

pub fn read(bytes: &[u8]) -> Result<Lines, String> {
    let mut file: Value = serde_json::from_slice(without_mark(bytes))
        .map_err(|error| error.to_string().replace('\n', " "))?;
    let Some(Value::Array(markups)) = file.get_mut("markups").map(Value::take) else {
        return Err(format!("it has no list 'markups'; {SAVE}"));
    };
    let (mut lines, mut frame, mut unset) = (Vec::new(), None, None);
    for (index, markup) in markups.into_iter().enumerate() {
        let Some(markup) = object::<Markup>(markup) else {
            return Err(format!("the entry {index} of its 'markups' is no object; {SAVE}"));
        };
        let kind = text("type", &markup.r#type)
            .map_err(|wrong| format!("the entry {index} of its 'markups' {wrong}; {SAVE}"))?;
        let kind = shown(kind.unwrap_or("Curve"));
        let own = own_frame(&markup.coordinate_system)?;
        let unit = own_unit(&markup.coordinate_units)?;
        let Value::Array(points) = markup.control_points else {
            return Err(format!("its {kind} has no list 'controlPoints'; {SAVE}"));
        };
        let mut line = Line::default();
        for (index, point) in points.into_iter().enumerate() {
            match position(point)
                .map_err(|wrong| format!("control point {index} {wrong}; {SAVE}"))?
            {
                Some(place) => line.points.push(place.map(unit)),
                None => line.skipped_points += 1,
            }
        }
        if line.points.is_empty() {
            unset = unset.or(Some((kind, line.skipped_points)));
            continue;
        }
        line.other = (!["Curve", "Line"].contains(&kind.as_str())).then_some(kind);
        if !lines.is_empty() && frame != Some(own) {
            return Err("its curves are in different frames; save each in a file of its own".into());
        }
        frame = Some(own);
        lines.push(line);
    }
    match unset {
        Some((kind, 0)) if lines.is_empty() => {
            Err(format!("the 'controlPoints' of its {kind} are empty; {SAVE}"))
        }
        Some((kind, count)) if lines.is_empty() => {
            Err(format!("none of the {count} 'controlPoints' of its {kind} has a position; {SAVE}"))
        }
        _ => Ok(Lines { lines, frame, states_unit: true }),
    }
}

const SAVE: &str = "draw a curve in 3D Slicer and save it as .mrk.json";

/// Returns the position of a control point, if it is set. The position of a point that is not set
/// may be an empty text.
fn position(point: Value) -> Result<Option<[f64; 3]>, String> {
    let Some(ControlPoint { position, position_status }) = object(point) else {
        return Err("is no object".into());
    };
    if text("positionStatus", &position_status)?.is_some_and(|status| status != "defined") {
        return Ok(None);
    }
    match position {
        Value::Null => Ok(None),
        Value::String(text) if text.is_empty() => Ok(None),
        other => <[f64; 3]>::deserialize(&other)
            .map(Some)
            .map_err(|_| format!("has the 'position' {}, not three numbers", written(&other))),
    }
}

/// Returns an object with known fields.
fn object<T: DeserializeOwned>(value: Value) -> Option<T> {
    // serde takes an array for an object, too.
    value.is_object().then(|| serde_json::from_value(value).ok())?
}

/// Returns the text of a field, if it has one.
fn text<'a>(field: &str, value: &'a Value) -> Result<Option<&'a str>, String> {
    match value {
        Value::Null => Ok(None),
        Value::String(text) => Ok(Some(text)),
        other => Err(format!("has the '{field}' {}, which is no text", written(other))),
    }
}

/// Returns a value as a message can show it.
fn written(value: &Value) -> String {
    match value {
        Value::Object(_) => "of named values".into(),
        other => shown(&other.to_string()),
    }
}

/// Returns the frame: LPS unless the file states another one. Older versions write it as a number.
fn own_frame(system: &Value) -> Result<Frame, String> {
    let text = match system {
        Value::Null => return Ok(Frame::Lps),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    match text.as_str() {
        "LPS" | "1" => Ok(Frame::Lps),
        "RAS" | "0" => Ok(Frame::Ras),
        other => Err(format!(
            "its coordinateSystem '{}' is neither LPS nor RAS; save it as LPS",
            shown(other)
        )),
    }
}

/// Returns the conversion of a coordinate to millimetres. Millimetres are the unit unless the file
/// states another one, by a name or by a code of three words such as
/// `["mm", "UCUM", "millimeter"]`.
fn own_unit(units: &Value) -> Result<impl Fn(f64) -> f64 + Copy + use<>, String> {
    let name = match units {
        Value::Null => "mm",
        Value::String(name) => name,
        Value::Array(code) => {
            code.first().and_then(Value::as_str).unwrap_or("a code without a name")
        }
        _ => "neither a name nor a code",
    };
    let factor = unit_in_mm(name).ok_or_else(|| {
        format!("its coordinateUnits are '{}', not mm; save it in mm", shown(name))
    })?;
    Ok(move |x: f64| to_mm(x, factor))
}
