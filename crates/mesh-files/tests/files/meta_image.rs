//! A ball in a MetaImage label map, written by SimpleITK (`tests/data/make.py`), is where SimpleITK
//! says.

use crate::{read, refused};
use mesh_files::{Frame, Options, load_with};
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
    for other in ["../ball.raw", "/etc/passwd", "slice%03d.raw", "LIST"] {
        refused(
            other,
            read("ball.mhd", header.replace("ball.raw", other)),
            "its voxels are in a second file",
        );
    }
}
