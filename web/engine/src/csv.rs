use parry_continuum::parry::math::{Real, Vector};

/// Points and the radius of each segment. Empty lines, lines that begin with # and one heading are
/// passed over.
pub fn centreline(text: &str, radius: Real) -> Result<(Vec<Vector>, Vec<Real>), String> {
    let (mut points, mut radii) = (Vec::new(), Vec::new());
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines = text
        .lines()
        .zip(1..)
        .filter(|(line, _)| !(line.trim().is_empty() || line.starts_with('#')));
    for (index, (line, number)) in lines.enumerate() {
        let words: Vec<_> = line.split([',', ';', '\t']).map(str::trim).collect();
        let numbers: Result<Vec<Real>, _> = words.iter().map(|word| word.parse()).collect();
        match numbers.as_deref() {
            Ok(&[x, y, z]) => {
                points.push(Vector::new(x, y, z));
                radii.push(radius);
            }
            Ok(&[x, y, z, own]) => {
                points.push(Vector::new(x, y, z));
                radii.push(own);
            }
            Err(_)
                if index == 0
                    && !words.iter().any(|word| word.contains(|c: char| c.is_ascii_digit())) => {}
            _ => {
                return Err(format!(
                    "line {number} is '{}'; write x,y,z or x,y,z,radius",
                    shown(line)
                ));
            }
        }
    }
    radii.pop();
    Ok((points, radii))
}

/// The beginning of a line.
fn shown(line: &str) -> String {
    line.chars().filter(|c| !c.is_control()).take(40).collect()
}
