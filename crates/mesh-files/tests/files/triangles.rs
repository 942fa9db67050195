//! STL, OBJ and PLY in every spelling.

use crate::{ascii_stl, binary_stl, file, ply_header, read, ring};
use mesh_files::{Frame, Options, load_with};

#[test]
fn meshes_are_read_as_they_were_written() {
    let mesh = &ring();
    let (points, triangles) = mesh;
    let mut solid = binary_stl(mesh);
    // A binary file may call itself solid, and an ASCII file may leave its solid without a name.
    solid[..16].copy_from_slice(b"solid of bytes \n");
    let ascii = ascii_stl(mesh);
    let line = |head: &str, words: [String; 3]| format!("{head} {}\n", words.join(" "));
    let vertices: String = points.iter().map(|p| line("v", p.map(|x| x.to_string()))).collect();
    let faces: String =
        triangles.iter().map(|t| line("f", t.map(|i| (i + 1).to_string()))).collect();
    let relative: String = triangles
        .iter()
        .map(|t| line("f", t.map(|i| format!("-{}", points.len() as u32 - i))))
        .collect();
    let obj = vertices.clone() + &faces;
    let ply: String = points
        .iter()
        .map(|p| line("", p.map(|x| x.to_string())))
        .chain(triangles.iter().map(|t| line("3", t.map(|i| i.to_string()))))
        .collect();
    let mut packed =
        ply_header(points.len(), triangles.len(), "binary_little_endian", "float").into_bytes();
    points.iter().flatten().for_each(|&x| packed.extend((x as f32).to_le_bytes()));
    for triangle in triangles {
        packed.push(3);
        triangle.iter().for_each(|corner| packed.extend(corner.to_le_bytes()));
    }
    let marked = |text: &str| format!("\u{feff}{text}").into_bytes();
    let ply = ply_header(points.len(), triangles.len(), "ascii", "double") + &ply;

    let single = 24.0 * f64::from(f32::EPSILON);
    for (name, bytes, tolerance) in [
        ("read.stl", binary_stl(mesh), single),
        ("solid.STL", solid, single),
        ("ascii.stl", ascii.clone().into_bytes(), 0.0),
        ("upper.stl", ascii.to_uppercase().into_bytes(), 0.0),
        ("marked.stl", marked(&ascii), 0.0),
        ("dos.stl", ascii.replace('\n', "\r\n").into_bytes(), 0.0),
        ("spread.stl", ascii.replace(' ', "\t ").into_bytes(), 0.0),
        ("read.obj", obj.clone().into_bytes(), 0.0),
        ("relative.obj", (vertices + &relative).into_bytes(), 0.0),
        ("marked.obj", marked(&obj), 0.0),
        ("continued.obj", obj.replace("f ", "f \\\n").into_bytes(), 0.0),
        ("old.obj", obj.replace('\n', "\r").into_bytes(), 0.0),
        ("ascii.ply", ply.clone().into_bytes(), 0.0),
        ("marked.ply", marked(&ply), 0.0),
        ("binary.ply", packed, single),
    ] {
        for scale in [1.0, 1000.0] {
            let read = load_with(file(name, &bytes), &Options::scaled(scale)).unwrap();
            assert_eq!(
                (read.vertices.len(), read.triangles.len()),
                (points.len(), triangles.len()),
                "{name}"
            );
            for (read_triangle, written) in read.triangles.iter().zip(triangles) {
                for corner in 0..3 {
                    let p = read.vertices[read_triangle[corner] as usize];
                    let q = points[written[corner] as usize].map(|x| x * scale);
                    let off =
                        [0, 1, 2].map(|i| (p[i] - q[i]).abs()).into_iter().fold(0.0, f64::max);
                    assert!(off <= tolerance * scale, "{name}: {p:?} for {q:?}");
                }
            }
        }
    }
}

#[test]
fn polygons_are_cut_and_objects_joined() {
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    assert_eq!(read("quad.obj", quad).unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    let two =
        "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf 4 5 6\n";
    let read_two = read("two.obj", two).unwrap();
    assert_eq!(read_two.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert!(read_two.vertices[..3].iter().all(|p| p[2] == 0.0));
    assert!(read_two.vertices[3..].iter().all(|p| p[2] == 9.0));
    // What a surface needs not may be broken: here a texture coordinate that is not there.
    let textured = "v 0 0 0\nv 1 0 0\nvt 0 0\nv 0 1 0\nvn 0 0 1\nf 1/-9/2 2/7/1 3/1/-5\n";
    let textured = read("textured.obj", textured).unwrap();
    assert_eq!((textured.vertices.len(), textured.triangles), (3, vec![[0, 1, 2]]));
    let text = ply_header(5, 1, "ascii", "float") + &"0 0 0\n".repeat(5) + "5 0 1 2 3 4\n";
    assert_eq!(read("pentagon.ply", text).unwrap().triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn faces_without_area_are_left_out_and_counted() {
    let (points, triangles) = ring();
    let vertices: String = points.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let face = |corners: &[u32]| {
        let words: Vec<_> = corners.iter().map(|corner| (corner + 1).to_string()).collect();
        format!("f {}\n", words.join(" "))
    };
    // A face, and the triangles that it is cut into by hand.
    let faces: [(&[u32], &[[u32; 3]]); 11] = [
        (&[], &[]),
        (&[7], &[]),
        (&[7, 8], &[]),
        (&[7, 7, 7], &[]),
        (&[7, 8, 7], &[]),
        (&[7, 8, 7, 8, 7, 8], &[]),
        (&[1, 2, 3], &[[1, 2, 3]]),
        // Twice in a row, at the end, again as the first one, and two triangles that share their
        // first corner.
        (&[1, 1, 2, 3], &[[1, 2, 3]]),
        (&[1, 2, 3, 3], &[[1, 2, 3]]),
        (&[1, 2, 3, 1], &[[1, 2, 3]]),
        (&[1, 2, 3, 1, 4, 5], &[[1, 2, 3], [1, 4, 5]]),
    ];
    let skipped = faces.iter().filter(|(_, cut)| cut.is_empty()).count();
    let cut =
        |faces: &[(&[u32], &[[u32; 3]])]| faces.iter().flat_map(|(_, cut)| cut.to_vec()).collect();
    let expected: [Vec<[u32; 3]>; 3] = [cut(&faces[..3]), triangles.clone(), cut(&faces)];
    let expected = expected.concat();

    let good: String = triangles.iter().map(|triangle| face(triangle)).collect();
    let bad = |faces: &[(&[u32], &[[u32; 3]])]| {
        faces.iter().map(|(corners, _)| face(corners)).collect::<String>()
    };
    let obj = read("a.obj", vertices + &bad(&faces[..3]) + &good + &bad(&faces)).unwrap();
    assert_eq!((obj.skipped_faces, &obj.triangles), (skipped + 3, &expected));
    assert_eq!(obj.vertices, points);

    let all: Vec<_> = faces[..3]
        .iter()
        .map(|(corners, _)| corners.to_vec())
        .chain(triangles.iter().map(|triangle| triangle.to_vec()))
        .chain(faces.iter().map(|(corners, _)| corners.to_vec()))
        .collect();
    let line = |corners: &Vec<u32>| {
        let words: Vec<_> = corners.iter().map(u32::to_string).collect();
        format!("{} {}\n", corners.len(), words.join(" "))
    };
    let ascii = ply_header(points.len(), all.len(), "ascii", "double")
        + &points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect::<String>()
        + &all.iter().map(line).collect::<String>();
    let mut binary =
        ply_header(points.len(), all.len(), "binary_big_endian", "double").into_bytes();
    points.iter().flatten().for_each(|x| binary.extend(x.to_be_bytes()));
    for corners in &all {
        binary.push(corners.len() as u8);
        corners.iter().for_each(|corner| binary.extend(corner.to_be_bytes()));
    }
    for bytes in [ascii.into_bytes(), binary] {
        let ply = read("a.ply", bytes).unwrap();
        assert_eq!((ply.skipped_faces, &ply.triangles), (skipped + 3, &expected));
        assert_eq!(ply.vertices, points);
    }

    // STL names no vertices: those at one place are one.
    let mut twice = triangles.clone();
    twice.splice(5..5, [[9, 9, 9], [9, 10, 9]]);
    for bytes in [
        binary_stl(&(points.clone(), twice.clone())),
        ascii_stl(&(points.clone(), twice)).into_bytes(),
    ] {
        let stl = read("a.stl", bytes).unwrap();
        assert_eq!((stl.skipped_faces, stl.triangles.len()), (2, triangles.len()));
    }
    // In one line, but of three different vertices: nothing is left out.
    let thin = read("thin.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 0 0\nf 1 2 3\nf 2 3 4\n").unwrap();
    assert_eq!((thin.skipped_faces, thin.triangles.len()), (0, 2));
}

#[test]
fn coordinates_that_are_whole_numbers_keep_all_their_digits() {
    let text = ply_header(3, 1, "ascii", "int") + "16777217 0 0\n0 -2147483647 0\n0 0 1\n3 0 1 2\n";
    let vertices = read("a.ply", text).unwrap().vertices;
    assert_eq!(vertices, [[16_777_217.0, 0.0, 0.0], [0.0, -2_147_483_647.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn an_obj_that_is_written_is_read_as_the_same_doubles() {
    let corners = [[0.1, -1.0 / 3.0, 5e-324], [1e300, 7.0, f64::EPSILON], [-0.0, 1e16 + 2.0, 1.5]];
    let text = mesh_files::to_obj(&corners, &[[2, 0, 1]]);
    let mesh = read("written.obj", &text).unwrap();
    assert_eq!(
        mesh.vertices.iter().map(|v| v.map(f64::to_bits)).collect::<Vec<_>>(),
        corners.map(|v| v.map(f64::to_bits))
    );
    assert_eq!(mesh.triangles, [[2, 0, 1]]);
    assert!(text.ends_with("f 3 1 2\n"), "{text}");
}

#[test]
fn the_frame_that_a_file_notes_is_kept() {
    let mut noted = binary_stl(&ring());
    assert_eq!(read("plain.stl", &noted).unwrap().frame, None);
    noted[..30].copy_from_slice(b"3D Slicer output. SPACE=LPS   ");
    let lps = read("noted.stl", &noted).unwrap();
    assert_eq!(lps.frame, Some(Frame::Lps));
    let ras = lps.clone().in_frame(Frame::Ras).unwrap();
    assert_eq!((ras.frame, &ras.triangles), (Some(Frame::Ras), &lps.triangles));
    let [x, y, z] = lps.vertices[0];
    assert_eq!(ras.vertices[0], [-x, -y, z]);
    assert!(read("plain.stl", binary_stl(&ring())).unwrap().in_frame(Frame::Ras).is_none());
}
