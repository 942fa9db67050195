//! `--labels`, and what is said of labels that are read as one wall.

use crate::{refuse, run, succeed};
use continuum_programs::{file, room};

/// Voxels of 2 x 2 x 2 mm: three of label 1, one of label 7, two of none.
fn segmentation(name: &str, labels: &str) -> String {
    let head = "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 6 1 1\n\
                space directions: (2,0,0) (0,2,0) (0,0,2)\nspace units: \"mm\" \"mm\" \"mm\"\n\
                space origin: (0,0,0)\nencoding: ascii\n\n";
    file(name, &format!("{head}{labels}\n"))
}

#[test]
fn labels_are_listed_with_their_volumes() {
    let organs = &segmentation("organs.nrrd", "1 1 0 1 7 0");
    let lines = "label 1: 24.00 mm^3 (0.0240 ml), 3 voxels\n\
                 label 7: 8.000 mm^3 (0.00800 ml), 1 voxels\n";
    let merged = format!("{lines}wall: labels 1, 7 merged; --label takes one of them\n");
    assert_eq!(succeed(&["--mesh", organs, "--labels"]), merged);
    let one = format!("{lines}wall: label 7\n");
    assert_eq!(succeed(&["--mesh", organs, "--labels", "--label", "7"]), one);
    let out = succeed(&["--mesh", organs, "--labels", "--label", "2"]);
    assert!(out.ends_with("wall: none, since no voxel has label 2\n"), "{out}");
    let only = &segmentation("organ.nrrd", "0 0 3 3 0 0");
    assert!(succeed(&["--mesh", only, "--labels"]).ends_with("wall: label 3\n"));
    let json = succeed(&["--mesh", organs, "--labels", "--label", "7", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        json[0],
        serde_json::json!({"label": 1, "voxels": 3, "volume_mm3": 24.0, "wall": false})
    );
    assert_eq!(json[1]["wall"], true);
}

#[test]
fn labels_that_are_merged_are_named_beside_the_answer() {
    let organs = &segmentation("merged.nrrd", "1 1 0 1 7 0");
    let shape = &file("merged.csv", "-1,0.5,0,0.3\n9,0.5,0\n");
    let asked = ["--mesh", organs, "--centreline", shape];
    let (status, out, error) = run(&asked);
    assert!(status == Some(0) && out.contains("\nminimum "), "{out}{error}");
    let note = format!("note: labels 1, 7 of {organs} are merged; --label takes one of them\n");
    assert!(error.starts_with(&note), "{error}");
    let (_, _, error) = run(&[&asked[..], &["--label", "7"]].concat());
    assert!(!error.contains("note: "), "{error}");
}

#[test]
fn a_wrong_label_is_refused_in_the_words_of_the_options() {
    let organs = &segmentation("wrong.nrrd", "1 1 0 1 7 0");
    let shape = &file("wrong.csv", "0,9,0,1\n9,9,0\n");
    refuse(
        &["--mesh", organs, "--centreline", shape, "--label", "2"],
        "but with 0, 1, 7; choose one of them with --label",
    );
    let wall = &room("unlabelled.obj");
    refuse(&["--mesh", wall, "--centreline", shape, "--label", "2"], "leave out --label");
    refuse(&["--mesh", wall, "--labels"], "holds triangles without labels (OBJ)");
    refuse(&["--mesh", &segmentation("none.nrrd", "0 0 0 0 0 0"), "--labels"], "holds no segment");
    refuse(
        &["--mesh", organs, "--labels", "--centreline", shape],
        "'--labels' cannot be used with",
    );
    let unplaced = std::fs::read_to_string(organs).unwrap();
    let unplaced = &file("unplaced.nrrd", &unplaced.replace("space origin: (0,0,0)\n", ""));
    refuse(&["--mesh", unplaced, "--labels"], "give --allow-no-position");
    refuse(&["--mesh", unplaced, "--centreline", shape], "give --allow-no-position");
    succeed(&["--mesh", unplaced, "--labels", "--allow-no-position"]);
    succeed(&["--mesh", unplaced, "--centreline", shape, "--label", "1", "--allow-no-position"]);
}
