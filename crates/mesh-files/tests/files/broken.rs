//! Every error is one line, in our words, that says what to do.

use crate::{ascii_stl, binary_stl, ply_header, read, refused, ring};
use mesh_files::{Options, from_bytes, load};

#[test]
fn what_is_wrong_with_a_file_is_said_in_one_line() {
    let mesh = &ring();
    let stl = binary_stl(mesh);
    let cut = stl[..10_000].to_vec();
    let mut fewer = stl.clone();
    fewer[80..84].copy_from_slice(&7_u32.to_le_bytes());
    let mut nan = stl.clone();
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    let text = ascii_stl(mesh);
    let half = &text[..text.match_indices("facet").nth(100).unwrap().0];
    let ply = |faces: &str| ply_header(3, 1, "ascii", "float") + "0 0 0\n1 0 0\n0 1 0\n" + faces;
    let flat = ply("3 0 1 2\n").replace("property float z\n", "").replace(" 0\n", "\n");
    let mut packed = ply_header(3, 1, "binary_big_endian", "double").into_bytes();
    [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f64::NAN, 0.0]
        .iter()
        .for_each(|x| packed.extend(x.to_be_bytes()));
    packed.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    let huge =
        ply_header(3, 1, "binary_little_endian", "float").replace("vertex 3", "vertex 99999999999");
    let obj = "# by hand\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (name, bytes, expected) in [
        ("a.xyz", vec![], "ends in .stl, .obj or .ply"),
        ("none", vec![], "ends in .stl, .obj or .ply"),
        ("brain.img", vec![], "save the segmentation as one file"),
        ("empty.stl", vec![], "export it again"),
        ("cut.stl", cut, "counts 672 triangles, but it ends after 198"),
        ("fewer.stl", fewer, "counts 7 triangles, but 33250 more bytes follow"),
        ("zero.stl", vec![0; 84], "no triangles"),
        ("nan.stl", nan, "repair that vertex"),
        ("facet.stl", b"solid x\nfacet normal\n".to_vec(), "ends without 'endsolid'"),
        ("half.stl", half.into(), "ends without 'endsolid'"),
        (
            "word.stl",
            text.replacen("vertex", "vertices", 1).into(),
            "line 4 has the unknown word 'vertices'",
        ),
        ("number.stl", text.replacen("vertex ", "vertex x", 1).into(), "line 4 has 'x"),
        ("corners.stl", text.replacen("endfacet", "", 1).into(), "has 6 vertices, not 3"),
        ("obj.stl", obj.into(), "holds OBJ, not STL"),
        ("stl.obj", text.clone().into(), "holds STL, not OBJ"),
        ("stl.ply", text.into(), "holds STL, not PLY"),
        ("page.stl", b"<!doctype html>\n<p>Not found</p>\n".to_vec(), "holds XML or HTML"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), "no triangles"),
        (
            "beyond.obj",
            obj.replace("1 2 3", "1 2 4").into(),
            "line 5 names vertex 4, but there are 3",
        ),
        (
            "zero.obj",
            obj.replace("1 2 3", "0 1 2").into(),
            "line 5 has '0' where the number of a vertex",
        ),
        ("before.obj", obj.replace("1 2 3", "-1 -2 -4").into(), "line 5 has '-4'"),
        (
            "edge.obj",
            obj.replace("1 2 3", "1 2").into(),
            "no triangles, but a face without area; export",
        ),
        (
            "beyond-edge.obj",
            obj.replace("1 2 3", "1 4\nf 1 2 3").into(),
            "line 5 names vertex 4, but there are 3",
        ),
        ("word.obj", b"v 0 zero 0\n".to_vec(), "line 1 has 'zero' where a number should be"),
        ("short.obj", b"v 0 0\n".to_vec(), "line 1 ends where a number should be"),
        ("nan.obj", obj.replace("v 1 0 0", "v 1 nan 0").into(), "repair that vertex"),
        ("beyond.ply", ply("3 0 1 3\n").into(), "names vertex 3, but there are 3"),
        ("negative.ply", ply("3 0 1 -1\n").into(), "export it again"),
        ("missing.ply", ply("").into(), "the 1 of element 'face' end early"),
        ("edge.ply", ply("2 0 1\n").into(), "no triangles, but a face without area; export"),
        (
            "list.ply",
            ply("3 0 1 2\n").replace("vertex_indices", "corners").into(),
            "face 0 has no list of vertices",
        ),
        ("flat.ply", flat.into(), "its vertices have no property 'z'"),
        ("header.ply", b"ply\nformat ascii 1.0\n".to_vec(), "end with 'end_header'"),
        ("huge.ply", huge.into(), "export it again"),
        ("nan.ply", packed, "repair that vertex"),
    ] {
        refused(name, read(name, bytes), expected);
    }
    let scaled = |scale| {
        from_bytes("a.ply", ply("3 0 1 2\n").as_bytes(), &Options::scaled(scale))
            .map_err(|e| e.to_string())
    };
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused("scale", scaled(scale), "give a positive number");
    }
    assert!(scaled(1e300).is_ok());
}

#[test]
fn a_label_of_triangles_is_refused() {
    let options = Options::default().with_label(Some(2));
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec();
    for (name, bytes) in [("a.stl", binary_stl(&ring())), ("a.obj", obj)] {
        assert!(read(name, &bytes).is_ok());
        let labelled = from_bytes(name, &bytes, &options).map_err(|e| e.to_string());
        refused(name, labelled, "holds triangles without labels");
    }
    let misnamed =
        from_bytes("a.stl", b"NRRD0004\ntype: uchar\n\n", &options).map_err(|e| e.to_string());
    refused("misnamed", misnamed, "give it the extension of what it holds");
}

#[test]
fn a_file_is_looked_at_before_it_is_read() {
    let loaded = |path: &str| load(path).map_err(|error| error.to_string());
    refused("nowhere", loaded("nowhere/brain.stl"), "nowhere/brain.stl");
    refused("nowhere", loaded("nowhere/brain.stl"), "check the path");
    let directory = format!("{}/folder.stl", env!("CARGO_TARGET_TMPDIR"));
    std::fs::create_dir_all(&directory).unwrap();
    refused("folder", loaded(&directory), "not a file");
    #[cfg(unix)]
    {
        // It never ends, under its own name and under a better one.
        refused("zero", loaded("/dev/zero"), "ends in .stl, .obj or .ply");
        let link = format!("{}/zero.stl", env!("CARGO_TARGET_TMPDIR"));
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        refused("link", loaded(&link), "not a file");
    }
}
