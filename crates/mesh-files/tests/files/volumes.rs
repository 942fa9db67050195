//! NIfTI files whose two forms disagree, and label maps with negative voxels. `tests/data/volumes`
//! has a block that is centred at (16, 26, 54); its makers read the files by nibabel and SimpleITK.

use crate::refused;
use crate::reports::centre;
use mesh_files::{Frame, LabelVolume, Mesh, Options, from_bytes, load_with};
use std::path::PathBuf;

fn volume(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", "volumes", name].iter().collect()
}

fn load(name: &str, label: Option<u32>) -> Result<Mesh, String> {
    load_with(volume(name), &Options::default().with_label(label))
        .map_err(|error| error.to_string())
}

#[test]
fn forms_that_place_a_label_map_differently_are_doubted() {
    // What ITK takes if the forms differ: the sform only if its code is that of a scanner.
    for (name, itk) in [
        ("09_flipped_qform.nii", Some("qform")),
        ("09_forms_agree.nii", None),
        ("09_forms_both_scanner.nii", Some("sform")),
        ("09_forms_disagree.nii", Some("qform")),
        ("09_forms_rotated_10deg.nii", Some("qform")),
        ("09_forms_rounding.nii", None),
        ("09_forms_shift_3mm.nii", Some("qform")),
        ("09_nifti2_disagree.nii", Some("qform")),
        ("09_qform_only.nii", None),
        ("09_sform_1mm_pixdim_2mm.nii", Some("qform")),
        ("09_sform_only.nii", None),
        ("09_sform_template_qform_scanner.nii", Some("qform")),
    ] {
        let mesh = load(name, None).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(mesh.frame, Some(Frame::Ras), "{name}");
        let Some(itk) = itk else {
            assert_eq!(mesh.doubts, Vec::<String>::new(), "{name}");
            let is_near = |(a, b): (f64, f64)| (a - b).abs() < 1e-4;
            assert!(centre(&mesh).into_iter().zip([16.0, 26.0, 54.0]).all(is_near), "{name}");
            continue;
        };
        let [doubt] = &mesh.doubts[..] else { panic!("{name}: {:?}", mesh.doubts) };
        let takes = if itk == "qform" { "ITK and 3D Slicer take the qform" } else { "and ITK do" };
        assert!(doubt.contains("mm apart; the sform is read, as nibabel"), "{name}: {doubt}");
        assert!(doubt.contains(takes), "{name}: {doubt}");
        if name.contains("shift_3mm") {
            assert!(doubt.contains(" 3.000 mm apart"), "{doubt}");
        }
    }
}

/// Turns of any angle as nibabel writes them: the quaternion in single precision, and the matrix of
/// the unrounded turn. Its error is largest near half turns, where a is small.
#[test]
fn forms_that_differ_by_rounding_are_not_doubted() {
    let whole = std::fs::read(volume("09_forms_agree.nii")).unwrap();
    let mut draws = crate::mutations::Draws(3);
    let mut draw = || draws.below(1 << 20) as f64 / f64::from(1 << 19) - 1.0;
    let mut small = 0;
    for round in 0..2000 {
        let a = draw() * 10_f64.powi(-(round % 8));
        let [b, c, d] = [draw(), draw(), draw()];
        let length = (b * b + c * c + d * d).sqrt();
        let rest = (1.0 - a * a).sqrt() / length;
        let [b, c, d] = [b * rest, c * rest, d * rest];
        let a = a.abs();
        small += usize::from(a < 1e-4);
        let spacing = [0.4883, 0.7, 4.0];
        let shift = [draw() * 300.0, draw() * 300.0, draw() * 300.0];
        let turn = [
            [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a + d * d - b * b - c * c],
        ];
        let file = |more: f64| {
            let mut bytes = whole.clone();
            let mut put =
                |at: usize, x: f64| bytes[at..at + 4].copy_from_slice(&(x as f32).to_le_bytes());
            put(76, 1.0);
            [0, 1, 2].into_iter().for_each(|k| put(80 + 4 * k, spacing[k]));
            [b, c, d].into_iter().enumerate().for_each(|(k, x)| put(256 + 4 * k, x));
            for row in 0..3 {
                put(268 + 4 * row, shift[row]);
                (0..3).for_each(|k| put(280 + 16 * row + 4 * k, turn[row][k] * spacing[k]));
                put(292 + 16 * row, shift[row] + more);
            }
            from_bytes("a.nii", &bytes, &Options::default()).unwrap().doubts
        };
        assert_eq!(file(0.0), Vec::<String>::new(), "{round}: {a}");
        // A shift of a voxel is more than rounding.
        assert_eq!(file(0.7).len(), 1, "{round}: {a}");
    }
    assert!(small > 200, "{small}");
}

#[test]
fn a_voxel_of_minus_one_is_background() {
    let plain = load("10_no_minus_one.nii", None).unwrap();
    for name in [
        "10_minus_one.nii",
        "10_neg.mha",
        "10_neg.nrrd",
        "10_neg_f32.nii",
        "10_neg_i16.nii",
        "10_neg_i32.nii",
        "10_neg_i8.nii",
        "10_neg_one_voxel.nii",
    ] {
        for label in [None, Some(1)] {
            let mesh = load(name, label).unwrap_or_else(|error| panic!("{error}"));
            let is_lps = !name.ends_with(".nii");
            let frame = if is_lps { Frame::Lps } else { Frame::Ras };
            assert_eq!((centre(&mesh), mesh.frame), ([16.0, 26.0, 54.0], Some(frame)), "{name}");
            assert_eq!(mesh.triangles.len(), plain.triangles.len(), "{name}");
            assert_eq!(mesh.labels, if label.is_none() { vec![1] } else { Vec::new() }, "{name}");
        }
        let labels = mesh_files::load_labels(volume(name), &Options::default()).unwrap();
        assert!(matches!(labels[..], [LabelVolume { label: 1, .. }]), "{name}: {labels:?}");
        refused(name, load(name, Some(7)), "has no voxel with label 7, but with 0, 1; choose one");
    }
    // The label 255 of bytes is no -1.
    assert_eq!(load("10_neg_u8_255.nii", None).unwrap().labels, [1, 255]);
    for (name, expected) in [
        (
            "10_neg_i16_m1000.nii",
            "holds a voxel of -1000, and labels are at least 0 (-1 is read as",
        ),
        ("10_neg_f32_nan.nii", "holds an image, in which a voxel is NaN, and not labels"),
    ] {
        refused(name, load(name, Some(1)), expected);
        refused(name, load(name, None), "give the segmentation of the image");
    }
    // A label that is -1e-5 beside 0 is rounded.
    assert!(load("10_neg_f64_neg_small.nii", Some(1)).is_ok());
    let wall = load("10_wall_is_minus_one.nii", Some(1));
    assert!(wall.is_ok() || wall.is_err_and(|error| error.contains("has no voxel with label 1")));
}
