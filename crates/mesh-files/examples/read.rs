//! Prints what is read from each file, a line of JSON each: `cargo run --example read -- wall.stl
//! lines.vtp:0`. A colon and a number after the name choose a label or a line. Before a file
//! `--line` reads it as a centreline, and `--no-position` reads a label map without a position.

use mesh_files::{Frame, Options, load_centreline, load_with};
use serde_json::{Value, json};

fn main() {
    let (mut is_line, mut allow_no_position) = (false, false);
    for argument in std::env::args().skip(1) {
        match argument.as_str() {
            "--line" => is_line = true,
            "--no-position" => allow_no_position = true,
            _ => {}
        }
        if argument.starts_with("--") {
            continue;
        }
        let (name, number) = match argument.rsplit_once(':') {
            Some((name, number)) if number.parse::<u32>().is_ok() => (name, number.parse().ok()),
            _ => (argument.as_str(), None),
        };
        let frame = |frame: Option<Frame>| frame.map(|frame| format!("{frame:?}"));
        let answer: Value = if std::mem::take(&mut is_line) {
            let options = Options::default().with_line(number.map(|number: u32| number as usize));
            match load_centreline(name, &options) {
                Ok(line) => {
                    json!({ "points": line.points, "radii": line.radii, "frame": frame(line.frame) })
                }
                Err(error) => json!({ "error": error.to_string() }),
            }
        } else {
            let options = Options::default()
                .with_label(number)
                .with_no_position_allowed(std::mem::take(&mut allow_no_position));
            match load_with(name, &options) {
                Ok(mesh) => json!({
                    "vertices": mesh.vertices, "triangles": mesh.triangles, "frame": frame(mesh.frame),
                    "skipped": mesh.skipped_faces, "doubts": mesh.doubts,
                }),
                Err(error) => json!({ "error": error.to_string() }),
            }
        };
        println!("{answer}");
    }
}
