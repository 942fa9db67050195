//! Centrelines as VTK and 3D Slicer write them, and what is wrong with others. `tests/data/make.py`
//! wrote the files by VTK.

use crate::{Vertex, refused};
use mesh_files::{Centreline, Frame, Options, centreline_from_bytes, load_centreline};
use std::path::PathBuf;

fn data(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", name].iter().collect()
}

/// What make.py draws.
fn line(number: usize) -> Vec<Vertex> {
    let (count, shift) = [(4, 0.0), (3, 8.0)][number];
    (0..count).map(f64::from).map(|k| [k, k * k / 4.0, 1.0 - k / 2.0 + shift]).collect()
}

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<Centreline, String> {
    centreline_from_bytes(name, bytes.as_ref(), &Options::default())
        .map_err(|error| error.to_string())
}

const FILES: [&str; 10] = [
    "lines_4_ascii.vtk",
    "lines_4_binary.vtk",
    "lines_5_ascii.vtk",
    "lines_5_binary.vtk",
    "lines_ascii.vtp",
    "lines_binary.vtp",
    "lines_binary_packed.vtp",
    "lines_appended.vtp",
    "lines_appended_packed.vtp",
    "lines_appended_packed_base64.vtp",
];

#[test]
fn every_kind_of_file_by_vtk_holds_the_same_lines() {
    for name in FILES {
        for number in [0, 1] {
            let options = Options::scaled(2.0).with_line(Some(number));
            let found = load_centreline(data(name), &options)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            assert_eq!(
                found.points,
                line(number).into_iter().map(|p| p.map(|x| 2.0 * x)).collect::<Vec<_>>(),
                "{name}"
            );
            assert_eq!(found.frame, None, "{name}");
        }
        let error = load_centreline(data(name), &Options::default()).unwrap_err().to_string();
        assert!(error.ends_with("holds 2 lines; choose one from 0 to 1"), "{error}");
        let error = load_centreline(data(name), &Options::default().with_line(Some(2)))
            .unwrap_err()
            .to_string();
        assert!(
            error.ends_with("has no line 2, but 2, counted from 0; choose one of them"),
            "{error}"
        );
    }
}

#[test]
fn a_file_that_ends_too_early_or_holds_other_bytes_never_breaks_the_reader() {
    for name in FILES {
        let whole = std::fs::read(data(name)).unwrap();
        let mut refused = 0;
        for end in 0..whole.len() {
            refused +=
                usize::from(read(name, &whole[..end]).is_err_and(|error| !error.contains('\n')));
        }
        // Two lines without a choice: whole as they may be, none is read.
        assert_eq!(refused, whole.len(), "{name}");
        for at in 0..whole.len() {
            for change in [1, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= change;
                let options = Options::default().with_line(Some(0));
                if let Err(error) = centreline_from_bytes(name, &bytes, &options) {
                    assert!(!error.to_string().contains('\n'), "{error}");
                }
            }
        }
    }
}

#[test]
fn arrays_take_no_more_memory_than_is_allowed() {
    for name in [
        "lines_binary.vtp",
        "lines_binary_packed.vtp",
        "lines_appended.vtp",
        "lines_appended_packed.vtp",
    ] {
        let bytes = std::fs::read(data(name)).unwrap();
        // 21 coordinates, 7 points of lines and 2 ends take 48 bytes each, and 8 before.
        for (limit, is_enough) in [(30 * 57, true), (29 * 48, false), (100, false)] {
            let options = Options::default().with_line(Some(0)).with_memory_limit(limit);
            let found =
                centreline_from_bytes(name, &bytes, &options).map_err(|error| error.to_string());
            assert_eq!(found.is_ok(), is_enough, "{name}, {limit}: {found:?}");
            assert!(is_enough || found.unwrap_err().contains("more memory than is allowed"));
        }
    }
    // Many pieces that name one and the same array.
    let text =
        String::from_utf8_lossy(&std::fs::read(data("lines_ascii.vtp")).unwrap()).into_owned();
    let [head, rest] = text.split_once("<Piece").map(|(head, rest)| [head, rest]).unwrap();
    let (piece, tail) = rest.split_once("</Piece>").unwrap();
    let many = format!("{head}{}{tail}", format!("<Piece{piece}</Piece>").repeat(50));
    let options = Options::default().with_line(Some(99));
    assert_eq!(
        centreline_from_bytes("many.vtp", many.as_bytes(), &options).unwrap().points,
        line(1)
    );
}

const CURVE: &str = r#"{"markups": [{"type": "Curve", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": [
    {"id": "1", "position": [1.5, -2, 3], "positionStatus": "defined"},
    {"id": "2", "position": [0, 0, 0], "positionStatus": "preview"},
    {"id": "3", "position": [4, 5, 6.25]}]}]}"#;

#[test]
fn a_curve_of_slicer_has_its_points_and_its_frame() {
    let curve = read("F.mrk.json", CURVE).unwrap();
    assert_eq!(curve.points, [[1.5, -2.0, 3.0], [4.0, 5.0, 6.25]]);
    assert_eq!(curve.frame, Some(Frame::Lps));
    assert_eq!(read("F.mrk.json", CURVE.replace("LPS", "RAS")).unwrap().frame, Some(Frame::Ras));
    assert_eq!(
        read("F.json", CURVE.replace(r#""coordinateSystem": "LPS", "#, "")).unwrap().frame,
        Some(Frame::Lps)
    );
}

#[test]
fn the_frame_that_slicer_notes_in_a_file_of_vtk_is_told() {
    let text = String::from_utf8(std::fs::read(data("lines_5_ascii.vtk")).unwrap()).unwrap();
    let options = Options::default().with_line(Some(0));
    let noted = text.replace("vtk output", "3D Slicer output. SPACE=LPS");
    let found = centreline_from_bytes("lines.vtk", noted.as_bytes(), &options).unwrap();
    assert_eq!(found.frame, Some(Frame::Lps));
}

#[test]
fn what_is_wrong_with_a_centreline_is_said_in_one_line() {
    let vtk = String::from_utf8(std::fs::read(data("lines_4_ascii.vtk")).unwrap()).unwrap();
    let vtp = String::from_utf8(std::fs::read(data("lines_ascii.vtp")).unwrap()).unwrap();
    for (name, text, expected) in [
        ("a.xyz", String::new(), "ends in .mrk.json, .vtp or .vtk, or a text"),
        ("a.vtk", String::new(), "'# vtk DataFile'"),
        ("a.vtk", "solid x".into(), "holds STL, not VTK"),
        (
            "a.vtk",
            vtk.replace("POLYDATA", "STRUCTURED_GRID"),
            "export the centreline or the surface as",
        ),
        ("a.vtk", vtk.replace("POINTS 7", "POINTS 99999999999999"), "where a number should be"),
        ("a.vtk", vtk.replace("LINES 2 9", "LINES 2 99999999999999"), "where a number should be"),
        ("a.vtk", vtk.replace("4 0 1 2 3", "4 0 1 2 7"), "a line names point 7, but there are 7"),
        ("a.vtk", vtk.replace("4 0 1 2 3", "4 0 1 2 -1"), "-1 is no number of a point"),
        ("a.vtk", vtk.replace("LINES", "WIRES"), "where a section should begin"),
        ("a.vtk", vtk.replace("double", "decimal"), "numbers of type 'decimal'"),
        ("a.vtk", vtk.split("LINES").next().unwrap().into(), "holds no line"),
        ("a.vtp", String::new(), "is not a valid VTK XML file"),
        ("a.vtp", vtp.replace("PolyData", "ImageData"), "export the centreline or the surface as"),
        ("a.vtp", vtp.replace("Int64", "Float64"), "by numbers that are no integers"),
        ("a.vtp", vtp.replace("Int64", "Bits"), "numbers of type 'Bits'"),
        ("a.vtp", vtp.replace("Name=\"offsets\"", "Name=\"ends\""), "offsets do not fit"),
        ("a.mrk.json", "{".into(), "is not a valid markups file"),
        ("a.mrk.json", r#"{"markups": []}"#.into(), "holds no line"),
        ("a.mrk.json", CURVE.replace("LPS", "XYZ"), "neither LPS nor RAS"),
        ("a.mrk.json", CURVE.replace("mm", "inch"), "coordinateUnits are 'inch', not mm"),
        ("a.mrk.json", CURVE.replace("6.25", "1e999"), "is not a valid markups file"),
    ] {
        assert!(expected != "holds STL, not VTK" || text.starts_with("solid"));
        refused(name, read(name, &text), expected);
    }
}
