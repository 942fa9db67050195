//! The situations of public bug reports, each a small file in `tests/data/reports`. What is right
//! follows from how the files were made: a tetrahedron with corners at the origin and one along
//! each axis, or a block of voxels.

use crate::{Vertex, refused};
use mesh_files::{Mesh, Options, load_with};
use std::path::PathBuf;

pub fn report(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", "reports", name].iter().collect()
}

pub fn load(name: &str, options: &Options) -> Result<Mesh, String> {
    load_with(report(name), options).map_err(|error| error.to_string())
}

pub fn corners(mesh: &Mesh) -> Vec<[Vertex; 3]> {
    mesh.triangles
        .iter()
        .map(|triangle| triangle.map(|corner| mesh.vertices[corner as usize]))
        .collect()
}

fn cross([a, b, c]: [Vertex; 3]) -> Vertex {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

pub fn area(mesh: &Mesh) -> f64 {
    let area = |triangle| cross(triangle).iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0;
    corners(mesh).into_iter().map(area).sum()
}

pub fn volume(mesh: &Mesh) -> f64 {
    let of = |triangle: [Vertex; 3]| {
        let [[a, b, c], normal] = [triangle[0], cross(triangle)];
        (a * normal[0] + b * normal[1] + c * normal[2]) / 6.0
    };
    corners(mesh).into_iter().map(of).sum()
}

/// Four triangles that enclose a sixth, each turned outwards.
pub fn assert_tetrahedron(name: &str, mesh: Result<Mesh, String>) {
    let mesh = mesh.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((mesh.triangles.len(), mesh.skipped_faces), (4, 0), "{name}");
    assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-15, "{name}: {}", volume(&mesh));
    let expected = 1.5 + 0.75_f64.sqrt();
    assert!((area(&mesh) - expected).abs() < 1e-15, "{name}: {}", area(&mesh));
}

/// What a mesh as small as these must be.
pub fn obj(text: &str) -> Result<Mesh, String> {
    crate::read("a.obj", text)
}

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn lines_of_obj_that_end_in_a_backslash_go_on_only_where_they_may() {
    assert_tetrahedron("A01", load("A01_backslash_comment.obj", &Options::default()));
    assert_tetrahedron("A02", load("A02_inline_comment.obj", &Options::default()));
    for line in ["#", "g", "o", "usemtl", "mtllib", "s", "# C:\\anatomy\\", "vt", "l", "curv 0 1"] {
        for place in 0..8 {
            let mut lines: Vec<_> = TETRAHEDRON.lines().map(str::to_owned).collect();
            lines.insert(place, format!("{line} \\"));
            assert_tetrahedron(line, obj(&(lines.join("\n") + "\n")));
        }
    }
    // Vertices and faces do go on, over a line of nothing too, and to the end of the file.
    for (from, to) in [
        ("f 3 1 4\n", "f 3 1 4 \\"),
        ("f 3 1 4\n", "f 3 1 \\\n4 \\\n"),
        ("f 3 1 4\n", "f 3 \\\n\\\n1 4"),
        ("v 1 0 0", "v 1 \\\n0 \\\r\n0"),
        ("f 3 1 4", "f 3 1 4 # a path: C:\\"),
        ("v 1 0 0", "v 1 0 0# one\\"),
    ] {
        assert_tetrahedron(to, obj(&TETRAHEDRON.replace(from, to)));
    }
}

#[test]
fn concave_polygons_cover_what_they_enclose() {
    let mesh = load("A03_concave_L.obj", &Options::default()).unwrap();
    assert_eq!((mesh.triangles.len(), area(&mesh)), (4, 7.0));
    assert!(corners(&mesh).into_iter().all(|triangle| cross(triangle)[2] > 0.0));
    let two = load("A04_two_objects.obj", &Options::default()).unwrap();
    assert!(two.triangles.len() == 24 && (volume(&two) - 16.0).abs() < 1e-13);
}

#[test]
fn strips_and_numbers_of_ply_are_read_in_every_spelling() {
    let strip = load("A05_tristrips_ascii.ply", &Options::default()).unwrap();
    assert_eq!(
        (strip.triangles, area(&load("A05_tristrips_ascii.ply", &Options::default()).unwrap())),
        (vec![[0, 1, 2], [2, 1, 3]], 1.0)
    );
    for name in [
        "A06_big_endian_double_extra.ply",
        "A06_crlf_binary.ply",
        "A06_realsense_one_value_a_line.ply",
        "A06_ushort_uint_and_second_list.ply",
    ] {
        assert_tetrahedron(name, load(name, &Options::default()));
    }
    let text = std::fs::read_to_string(report("A06_realsense_one_value_a_line.ply")).unwrap();
    let bytes = |text: String| text.into_bytes();
    let mut latin = bytes(text.replace("ascii 1.0\n", "ascii 1.0\ncomment M#nchen\n"));
    let umlaut = latin.iter().position(|&byte| byte == b'#').unwrap();
    latin[umlaut] = 0xfc;
    for (name, bytes) in [
        ("CR alone", bytes(text.replace('\n', "\r"))),
        ("CRLF", bytes(text.replace('\n', "\r\n"))),
        (
            "blank lines",
            bytes(text.replace("end_header\n", "end_header\n\n\n").replace("\n3 ", "\n\n3 ")),
        ),
        ("blank lines in the header", bytes(text.replace("element", "\nelement"))),
        ("Latin-1", latin),
        ("points without digits", bytes(text.replace("1 \n", "1. \n").replace("0 \n", ".0 \n"))),
        ("exponents", bytes(text.replace("1 \n", "+1.E+000 \n"))),
        ("all in one line", bytes(text.replace("\n3 ", " 3 ").replace(" \n", " "))),
        ("spaces", bytes(text.replace("property ", "  property \t").replace("\n3", "\n\t 3"))),
    ] {
        assert_tetrahedron(name, crate::read("a.ply", &bytes));
    }
}

#[test]
fn strips_of_ply_are_cut_by_the_rules_of_strips() {
    let head = |format: &str, count: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
             element tristrips 1\nproperty list {count} int vertex_indices\nend_header\n"
        )
    };
    let points: String = (0..6).map(|i| format!("{} {} 0\n", i / 2, i % 2)).collect();
    // Two strips; one that is drawn on by naming vertices twice, whose turns stay; and one too
    // short.
    for (strip, expected) in [
        (&[0, 1, 2, 3, -1, 5, 4, 3][..], &[[0, 1, 2], [2, 1, 3], [5, 4, 3]][..]),
        (&[0, 1, 2, 2, 3, 3, 4, 5], &[[0, 1, 2], [4, 3, 5]]),
        (&[-1, -1, 0, 1, -1, 1, 2, 3, -1], &[[1, 2, 3]]),
    ] {
        let words: Vec<_> = strip.iter().map(i32::to_string).collect();
        let text =
            head("ascii", "int") + &points + &format!("{} {}\n", strip.len(), words.join(" "));
        let mesh = crate::read("a.ply", text).unwrap();
        assert_eq!(mesh.triangles, expected, "{strip:?}");
        let mut bytes = head("binary_big_endian", "uchar").into_bytes();
        for number in points.split_whitespace() {
            bytes.extend(number.parse::<f32>().unwrap().to_be_bytes());
        }
        bytes.push(strip.len() as u8);
        strip.iter().for_each(|corner: &i32| bytes.extend(corner.to_be_bytes()));
        assert_eq!(crate::read("a.ply", bytes).unwrap(), mesh);
    }
}

#[test]
fn stl_is_read_where_its_length_is_certain() {
    for name in [
        "A07_end_solid.stl",
        "A07_ind_normal.stl",
        "A07_nan_normal.stl",
        "A08_attribute_payload.stl",
        "A08_binary_solid.stl",
        "A08_count_minus_1.stl",
        "A08_solid_trailing_2_bytes.stl",
    ] {
        assert_tetrahedron(name, load(name, &Options::default()));
    }
    let upper = load("A07_upper_exponent.stl", &Options::default()).unwrap();
    assert_eq!(upper.triangles.len(), 4);
    assert_eq!(load("A07_two_solids.stl", &Options::default()).unwrap().triangles.len(), 8);
    refused(
        "commas",
        load("A07_comma_decimal.stl", &Options::default()),
        "write decimals with a point",
    );
    refused("cut", load("A07_no_endsolid.stl", &Options::default()), "without 'endsolid'");
    let whole = std::fs::read(report("A08_binary_solid.stl")).unwrap();
    let counted = |count: u32, length: usize| {
        let mut bytes = whole.clone();
        bytes[..5].copy_from_slice(b"bytes");
        bytes.resize(length, 7);
        bytes[80..84].copy_from_slice(&count.to_le_bytes());
        crate::read("a.stl", bytes)
    };
    // What a writer leaves that never came back to count; and fewer bytes than a triangle behind
    // the last one.
    assert_tetrahedron("no count", counted(0, 284));
    assert_tetrahedron("no count", counted(u32::MAX, 284));
    assert_tetrahedron("a tail", counted(4, 333));
    for (count, length, expected, remedy) in [
        (4, 283, "counts 4 triangles, but it ends after 3", "it may be cut short"),
        (5, 284, "counts 5 triangles, but it ends after 4", "write 4 into its bytes 80 to 83"),
        (u32::MAX, 283, "but it ends after 3", "it may be cut short"),
        (3, 284, "counts 3 triangles, but 50 more bytes follow", "write 4 into its bytes 80 to 83"),
        (3, 290, "counts 3 triangles, but 56 more bytes follow", "cut it after byte 234"),
    ] {
        refused("count", counted(count, length), expected);
        refused("count", counted(count, length), remedy);
    }
    // The remedies work: bytes 80 to 83 are the count.
    assert_tetrahedron("count", counted(4, 284));
    assert_eq!(counted(3, 234).unwrap().triangles.len(), 3);
    let text = std::fs::read_to_string(report("A07_end_solid.stl")).unwrap();
    for (from, to) in
        [("end solid", "END SOLID"), ("end loop", "endloop"), ("endfacet", "end facet")]
    {
        assert_tetrahedron(to, crate::read("a.stl", text.replace(from, to)));
    }
    // All words in one line, with a name, with the word that begins a facet as a name, and without.
    for name in ["solid of one line", "solid facet", "SOLID facet of \u{e9}", "solid"] {
        let line = text.replace('\n', " ");
        let (_, rest) = line.split_once("facet ").unwrap();
        let line = format!("{name} facet {rest}");
        assert_tetrahedron(name, crate::read("a.stl", &line));
        let two = line.clone() + &line;
        assert_eq!(crate::read("a.stl", two).unwrap().triangles.len(), 8, "{name}");
        let cut = line.split("end solid").next().unwrap();
        refused(name, crate::read("a.stl", cut), "ends without 'endsolid'");
    }
}

/// The middle of the surface's box.
pub fn centre(mesh: &Mesh) -> Vertex {
    [0, 1, 2].map(|axis| {
        let all = || mesh.vertices.iter().map(|vertex| vertex[axis]);
        (all().fold(f64::MAX, f64::min) + all().fold(f64::MIN, f64::max)) / 2.0
    })
}

#[cfg(feature = "label-maps")]
mod label_maps {
    use super::{centre, load};
    use crate::refused;
    use mesh_files::{Frame, Options};

    #[test]
    fn a_block_of_voxels_is_where_the_header_says() {
        for name in [
            "A10_slope_uint8.nii",
            "A10_slope0.nii",
            "A10_slope_nan.nii.gz",
            "A11_big_endian.nii",
            "A11_pair.hdr",
            "A11_pair.img",
        ] {
            let mesh = load(name, &Options::default().with_label(Some(1))).unwrap();
            assert_eq!(
                (centre(&mesh), mesh.frame),
                ([16.0, 26.0, 54.0], Some(Frame::Ras)),
                "{name}"
            );
        }
        for (name, frame) in [
            ("A13_byte_skip_minus_1.nrrd", Frame::Lps),
            ("A13_colon_key_value_crlf.nrrd", Frame::Ras),
            ("A14_anatomical_says_RAS.mha", Frame::Lps),
            ("A14_compressed.mhd", Frame::Lps),
            ("A14_name_with_space.mhd", Frame::Lps),
        ] {
            let mesh = load(name, &Options::default().with_label(Some(1))).unwrap();
            assert_eq!((centre(&mesh), mesh.frame), ([16.0, 26.0, 54.0], Some(frame)), "{name}");
        }
    }

    #[test]
    fn a_map_without_a_position_or_in_layers_is_refused_with_the_remedy() {
        for name in ["A11_no_form.nii", "A12_spacings_only.nrrd"] {
            refused(name, load(name, &Options::default()), "Options::allow_no_position");
        }
        refused("layers", load("A13_overlap_4d.seg.nrrd", &Options::default()), "holds 2 layers");
    }
}

#[cfg(feature = "centrelines")]
mod centrelines {
    use super::report;
    use crate::{Vertex, refused};
    use mesh_files::{Centreline, Frame, Options, load_centreline};

    fn load(name: &str) -> Result<Centreline, String> {
        load_centreline(report(name), &Options::default()).map_err(|error| error.to_string())
    }

    #[test]
    fn lines_of_vtk_are_read_whatever_stands_before_them() {
        let straight: [Vertex; 3] = [[0.0, 0.0, 0.0], [0.0, 0.0, 10.0], [1.0, 0.0, 20.0]];
        for name in ["A15_field_before_points.vtk", "A15_crlf_long.vtk"] {
            assert_eq!(load(name).unwrap().points, straight, "{name}");
        }
        let joined = load("A17_two_point_cells.vtp").unwrap().points;
        assert_eq!(joined, [&straight[..], &[[3.0, 0.0, 29.0]]].concat());
        let lps = load("A18_space_lps_in_field_data.vtp").unwrap();
        assert_eq!((lps.frame, lps.points[0]), (Some(Frame::Lps), [10.0, 20.0, 30.0]));
    }

    #[test]
    fn curves_of_slicer_are_lps_and_what_is_not_set_is_left_out() {
        let curve: [Vertex; 3] = [[10.0, 20.0, 30.0], [10.0, 20.0, 40.0], [11.0, 20.0, 50.0]];
        for (name, count, skipped) in [
            ("A19_no_system_means_LPS.mrk.json", 3, 0),
            ("A19_undefined_point.mrk.json", 3, 1),
            ("A19_units_um.mrk.json", 2, 0),
        ] {
            let found = load(name).unwrap();
            assert_eq!(
                (&found.points[..], found.frame),
                (&curve[..count], Some(Frame::Lps)),
                "{name}"
            );
            assert_eq!(found.skipped_points, skipped, "{name}");
        }
        refused("none", load("A19_no_control_points.mrk.json"), "no list 'controlPoints'");
    }
}
