//! A ball in a MetaImage label map, written by SimpleITK (`tests/data/make.py`), is where SimpleITK
//! says.

use crate::{read, refused};
use mesh_files::{Frame, Options, from_bytes, load_with};
use std::path::{Path, PathBuf};

/// As make.py prints it.
const CENTRE: [f64; 3] = [-17.62980947, 15.89470958, 12.0];
const RADIUS: f64 = 6.0;

fn data(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", name].iter().collect()
}

#[test]
fn a_ball_is_where_its_voxels_are() {
    let [packed, apart] = ["ball.mha", "ball.mhd"]
        .map(|name| load_with(data(name), &Options::default().with_label(Some(3))).unwrap());
    assert_eq!(packed, apart);
    assert!(packed.frame == Some(Frame::Lps) && packed.states_unit);
    // Voxels are 2.7 from corner to corner.
    let off = |vertex: &[f64; 3]| {
        let away =
            [0, 1, 2].map(|axis| (vertex[axis] - CENTRE[axis]).powi(2)).iter().sum::<f64>().sqrt();
        (away - RADIUS).abs()
    };
    assert!(packed.vertices.iter().all(|vertex| off(vertex) < 2.7));
    let mean: [f64; 3] = [0, 1, 2].map(|axis| {
        packed.vertices.iter().map(|v| v[axis]).sum::<f64>() / packed.vertices.len() as f64
    });
    assert!([0, 1, 2].iter().all(|&axis| (mean[axis] - CENTRE[axis]).abs() < 0.3), "{mean:?}");
}

#[test]
fn header_and_voxels_are_read_from_memory() {
    let [header, voxels] = ["ball.mhd", "ball.raw"].map(|name| std::fs::read(data(name)).unwrap());
    let options = Options::default().with_label(Some(3));
    let load = |has_voxels: bool| {
        let content = |file: &Path| match file.to_str() {
            Some("ball.mhd") => Some(&header[..]),
            Some("ball.raw") if has_voxels => Some(&voxels[..]),
            _ => None,
        };
        mesh_files::load_from("ball.mhd", content, &options)
    };
    assert_eq!(load(true), load_with(data("ball.mhd"), &options));
    let missing = load(false).map_err(|error| error.to_string());
    refused("ball.mhd", missing, "cannot read ball.raw (it is not given)");
}

#[test]
fn what_is_wrong_with_a_meta_image_is_said_in_one_line() {
    let header = std::fs::read_to_string(data("ball.mhd")).unwrap();
    let one = header.replace("ball.raw", "LOCAL");
    let voxels = "\u{3}".repeat(16 * 12 * 10);
    assert!(read("ball.mha", one.clone() + &voxels).is_ok());
    for (text, expected) in [
        (header.clone(), "its voxels are in a second file"),
        (one.clone(), "shorter than its header says"),
        (one.replace("NDims = 3", "NDims = 4"), "not one volume of three dimensions"),
        (one.replace("DimSize = 16", "DimSize = x"), "'DimSize' is not three numbers"),
        (one.replace("MET_UCHAR", "MET_OTHER"), "ElementType 'MET_OTHER'"),
        (one.replace("1 1.5 2", "1 1.5"), "'ElementSpacing' is not 3 numbers"),
        (one.replace("1 1.5 2", "1 1.5 0"), "TransformMatrix brings all voxels into one plane"),
        (one.replace("ObjectType = Image", "Image"), "where a field should be"),
        (one.replace("CompressedData = False", "CompressedData = True") + &voxels, "damaged"),
    ] {
        refused("ball.mha", read("ball.mha", text), expected);
    }
    for (text, body) in [
        (one.replace("LOCAL", "Local"), voxels.clone()),
        (
            one.replace("ElementDataFile", "HeaderSize = 3\nElementDataFile"),
            "123".to_owned() + &voxels,
        ),
        (
            one.replace("ElementDataFile", "HeaderSize = -1\nElementDataFile"),
            "12345".to_owned() + &voxels,
        ),
    ] {
        assert!(read("ball.mha", text + &body).is_ok());
    }
    // No file of another folder, and no pattern of names.
    for (other, expected) in [
        ("../ball.raw", "its voxels are in a second file"),
        ("..\\ball.raw", "its voxels are in a second file"),
        ("/etc/passwd", "its voxels are in a second file"),
        ("\"\"", "its voxels are in a second file"),
        ("slice%03d.raw", "in several files, 'slice%03d.raw', which cannot be read; save one .mha"),
        ("LIST", "in several files, 'LIST', which cannot be read; save one .mha"),
    ] {
        refused(other, read("ball.mhd", header.replace("ball.raw", other)), expected);
    }
}

/// Names as Windows and people write them, where SimpleITK 2.5 on Linux finds no file.
#[test]
fn names_of_voxels_have_quotes_or_backslashes() {
    let [header, voxels] = ["ball.mhd", "ball.raw"].map(|name| std::fs::read(data(name)).unwrap());
    let header = String::from_utf8(header).unwrap();
    let options = Options::default().with_label(Some(3));
    let expected = load_with(data("ball.mhd"), &options).unwrap();
    for (name, file) in [
        (".\\ball.raw", "./ball.raw"),
        ("sub\\the ball.raw", "sub/the ball.raw"),
        ("\"ball.raw\"", "ball.raw"),
        ("'a ball.raw'", "a ball.raw"),
        ("\".\\ball.raw\"", "./ball.raw"),
        ("50% ball.raw", "50% ball.raw"),
    ] {
        let header = header.replace("ball.raw", name);
        let content = |asked: &Path| match asked {
            path if path == Path::new("ball.mhd") => Some(header.as_bytes()),
            path if path == Path::new(file) => Some(&voxels[..]),
            _ => None,
        };
        let found = mesh_files::load_from("ball.mhd", content, &options);
        assert_eq!(found.as_ref(), Ok(&expected), "{name}");
    }
}

/// What SimpleITK 2.5 reads as offset 0 or spacing 1, and other units as millimetres.
#[test]
fn a_position_that_is_not_stated_needs_the_option_and_units_are_converted() {
    let header = std::fs::read_to_string(data("ball.mhd")).unwrap();
    let voxels = std::fs::read(data("ball.raw")).unwrap();
    let whole = header.replace("ball.raw", "LOCAL");
    let without = |fields: &[&str]| -> String {
        let is_kept = |line: &&str| !fields.iter().any(|field| line.starts_with(field));
        whole.lines().filter(is_kept).map(|line| format!("{line}\n")).collect()
    };
    let read = |text: &str, is_allowed: bool| {
        let options = Options::default().with_label(Some(3)).with_no_position_allowed(is_allowed);
        from_bytes("a.mha", &[text.as_bytes(), &voxels].concat(), &options)
            .map_err(|error| error.to_string())
    };
    let expected = read(&whole, false).unwrap();
    assert_eq!(read(&whole, true).as_ref(), Ok(&expected));
    for (fields, missing) in [(&["Offset"][..], "Offset"), (&["ElementSpacing"], "ElementSpacing")]
    {
        let message = format!("voxels are (its header has no field '{missing}'); save it again");
        refused(missing, read(&without(fields), false), &message);
    }
    for name in ["Position", "Origin"] {
        assert_eq!(read(&whole.replace("Offset", name), false).as_ref(), Ok(&expected));
    }
    assert_eq!(read(&whole.replace("Spacing", "Size"), false).as_ref(), Ok(&expected));
    // The first voxel at the origin, and voxels of sides 1: differences of vertices.
    let origin = numbers(&whole, "Offset");
    let moved = read(&without(&["Offset"]), true).unwrap();
    for (vertex, old) in moved.vertices.iter().zip(&expected.vertices) {
        assert!((0..3).all(|axis| (vertex[axis] + origin[axis] - old[axis]).abs() < 1e-12));
    }
    assert_eq!((moved.frame, moved.triangles.len()), (Some(Frame::Lps), expected.triangles.len()));
    let plain = read(&without(&["Offset", "TransformMatrix", "ElementSpacing"]), true).unwrap();
    assert_eq!(plain.frame, None);
    let [lowest, highest] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|least| plain.vertices.iter().map(|vertex| vertex[0]).reduce(least).unwrap());
    // The ball's radius is 6 voxels of side 1 along the first axis.
    assert!((highest - lowest - 12.0).abs() < 1.0, "{lowest} {highest}");
    for (unit, factor) in [("mm", 1.0), ("um", 1e-3), ("cm", 10.0), ("MM", 1.0), ("?", 1.0)] {
        let stated = whole.replace("DimSize", &format!("DistanceUnits = {unit}\nDimSize"));
        let found = read(&stated, false).unwrap();
        assert!(found.states_unit);
        for (vertex, old) in found.vertices.iter().zip(&expected.vertices) {
            let off = |axis: usize| (vertex[axis] - factor * old[axis]).abs();
            assert!((0..3).all(|axis| off(axis) < 1e-12 * factor * 100.0), "{unit}");
        }
    }
    let inch = whole.replace("DimSize", "DistanceUnits = inch\nDimSize");
    refused("inch", read(&inch, false), "its DistanceUnits 'inch' cannot be read; save it in mm");
}

/// The numbers of a field.
fn numbers(header: &str, field: &str) -> Vec<f64> {
    let line = header.lines().find(|line| line.starts_with(field)).unwrap();
    let (_, value) = line.split_once('=').unwrap();
    value.split_whitespace().map(|number| number.parse().unwrap()).collect()
}
