//! Corrupted files: for any bytes, reading ends soon, takes little memory, and returns a mesh or an
//! error of one line.

use crate::reports::report;
use mesh_files::{MeshFileError, Options, from_bytes};
use std::time::{Duration, Instant};

/// Corrupted files per format.
const ROUNDS: usize = 2000;
/// The files have a few hundred bytes; memory is in proportion, unless a header is trusted.
const MEMORY: u64 = 4 << 20;
const TIME: Duration = Duration::from_secs(1);

/// A fixed sequence (splitmix64).
pub struct Draws(pub u64);

impl Draws {
    pub fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % count.max(1) as u64) as usize
    }
}

/// One to four changes: a flipped bit, another byte, an end, lines that change places, a line
/// twice, a digit more.
fn spoilt(whole: &[u8], draws: &mut Draws) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..=draws.below(4) {
        let at = draws.below(bytes.len());
        match draws.below(6) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << draws.below(8),
            1 if !bytes.is_empty() => bytes[at] = draws.below(256) as u8,
            2 => bytes.truncate(at),
            3 | 4 => {
                let mut lines: Vec<_> =
                    bytes.split(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
                let [a, b] = [draws.below(lines.len()), draws.below(lines.len())];
                if draws.below(2) == 0 {
                    lines.swap(a, b)
                } else {
                    lines.insert(a, lines[b].clone())
                }
                bytes = lines.join(&b'\n');
            }
            _ => {
                let digit = (at..bytes.len()).find(|&at| bytes[at].is_ascii_digit());
                digit.into_iter().for_each(|at| bytes.insert(at, b'9'));
            }
        }
    }
    bytes
}

fn check(name: &str, whole: &[u8], read: impl Fn(&[u8]) -> Result<(), MeshFileError>) {
    let mut draws = Draws(whole.len() as u64);
    let (mut refused, mut changed) = (0, 0);
    for round in 0..ROUNDS {
        let bytes = spoilt(whole, &mut draws);
        changed += usize::from(bytes != whole);
        let start = Instant::now();
        let mut answer = Ok(());
        let taken = allocation_counter::measure(|| answer = read(&bytes)).bytes_max;
        assert!(
            taken < MEMORY && start.elapsed() < TIME,
            "{name}, {round}: {taken}, {:?}",
            start.elapsed()
        );
        if let Err(error) = answer {
            let text = error.to_string();
            assert!(!text.contains('\n') && text.contains(name), "{name}, {round}: {text}");
            refused += 1;
        }
    }
    // The sample has both.
    assert!(changed > ROUNDS * 3 / 4, "{name}: {changed}");
    assert!((ROUNDS / 20..ROUNDS).contains(&refused), "{name}: {refused}");
}

fn check_meshes(files: &[(&str, &str)]) {
    for (name, file) in files {
        check_mesh(name, &std::fs::read(report(file)).unwrap());
    }
}

fn check_mesh(name: &str, whole: &[u8]) {
    check(name, whole, |bytes| {
        let mesh = from_bytes(name, bytes, &Options::default().with_memory_limit(MEMORY / 2))?;
        let count = mesh.vertices.len();
        let (read, stated) = (mesh.triangles.len() + mesh.skipped_faces, stated_faces(name, bytes));
        assert!(read >= stated, "{name}: {read} of {stated} in {}", bytes.escape_ascii());
        assert!(
            !mesh.triangles.is_empty() && mesh.vertices.iter().flatten().all(|x| x.is_finite())
        );
        assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
        Ok(())
    });
}

/// The number of faces that a file states, as a simple reader sees it: lines of OBJ with three
/// corners, triangles of text in STL, and counts in the heads of PLY, VTK and VTK XML.
fn stated_faces(name: &str, bytes: &[u8]) -> usize {
    let text = String::from_utf8_lossy(bytes);
    let lines = || text.split(['\n', '\r']);
    let after = |head: &str| {
        let count = lines()
            .find_map(|line| line.split_once(head)?.1.split([' ', '"']).next()?.parse().ok());
        count.unwrap_or(0)
    };
    match name.rsplit_once('.').map_or("", |(_, extension)| extension) {
        "obj" => {
            let words =
                |line: &str| line.split('#').next().unwrap_or_default().split_whitespace().count();
            lines().filter(|line| line.starts_with("f ") && words(line) > 3).count()
        }
        "stl" if bytes.contains(&0) => 0,
        "stl" => text.matches("endfacet").count(),
        "ply" => after("element face "),
        "vtk" => after("POLYGONS "),
        "vtp" => after("NumberOfPolys=\""),
        _ => 0,
    }
}

/// The same text with another end of each line.
fn with_ends(file: &str, end: &str) -> Vec<u8> {
    std::fs::read_to_string(report(file)).unwrap().replace('\n', end).into_bytes()
}

#[test]
fn spoilt_files_of_triangles_are_read_or_refused() {
    check_meshes(&[
        ("a.obj", "A02_inline_comment.obj"),
        ("concave.obj", "A03_concave_L.obj"),
        ("a.ply", "A06_ushort_uint_and_second_list.ply"),
        ("strips.ply", "A05_tristrips_ascii.ply"),
        ("binary.ply", "A06_big_endian_double_extra.ply"),
        ("a.stl", "A07_end_solid.stl"),
        ("binary.stl", "A08_attribute_payload.stl"),
    ]);
    check_mesh("line.stl", &with_ends("A07_end_solid.stl", " "));
}

/// Surfaces of VTK, in which all cells are stated twice: by a count, and by themselves.
#[cfg(feature = "centrelines")]
#[test]
fn spoilt_surfaces_of_vtk_are_read_or_refused() {
    let head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let polygons = "METADATA\nINFORMATION 0\n\nPOLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    let data = "POINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default\n1\n2\n3\n4\n";
    check_mesh("surface.vtk", format!("{head}{polygons}{data}").as_bytes());
    let vtp = "<VTKFile type=\"PolyData\">\n<PolyData>\n<Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n<Points>\n\
        <DataArray type=\"Float64\" NumberOfComponents=\"3\">\n0 0 0 1 0 0 0 1 0 0 0 1\n</DataArray>\n</Points>\n\
        <Polys>\n<DataArray type=\"Int64\" Name=\"connectivity\">\n0 2 1\n0 1 3\n1 2 3\n2 0 3\n</DataArray>\n\
        <DataArray type=\"Int64\" Name=\"offsets\">\n3 6 9 12\n</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
    check_mesh("surface.vtp", vtp.as_bytes());
}

#[cfg(feature = "label-maps")]
#[test]
fn spoilt_label_maps_are_read_or_refused() {
    check_meshes(&[
        ("a.nii", "A10_slope_uint8.nii"),
        ("a.nii.gz", "A10_slope_nan.nii.gz"),
        ("a.nrrd", "A13_colon_key_value_crlf.nrrd"),
        ("skip.nrrd", "A13_byte_skip_minus_1.nrrd"),
        ("a.mha", "A14_anatomical_says_RAS.mha"),
    ]);
}

#[cfg(feature = "centrelines")]
#[test]
fn spoilt_centrelines_are_read_or_refused() {
    for (name, file) in [
        ("a.vtk", "A15_field_before_points.vtk"),
        ("a.vtp", "A17_two_point_cells.vtp"),
        ("space.vtp", "A18_space_lps_in_field_data.vtp"),
        ("a.mrk.json", "A19_undefined_point.mrk.json"),
        ("a.csv", "A20_bom_heading_units.csv"),
        ("binary.vtk", "../lines_5_binary.vtk"),
        ("packed.vtp", "../lines_appended_packed_base64.vtp"),
    ] {
        check_line(name, &std::fs::read(report(file)).unwrap());
    }
    check_line("returns.vtk", &with_ends("A15_field_before_points.vtk", "\r"));
    let text = std::fs::read_to_string(report("A20_bom_heading_units.csv")).unwrap();
    let utf16: Vec<_> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    check_line("utf16.csv", &utf16);
}

#[cfg(feature = "centrelines")]
fn check_line(name: &str, whole: &[u8]) {
    check(name, whole, |bytes| {
        let options = Options::default().with_line(Some(0)).with_memory_limit(MEMORY / 2);
        let line = mesh_files::centreline_from_bytes(name, bytes, &options)?;
        assert!(line.points.len() > 1 && line.points.iter().flatten().all(|x| x.is_finite()));
        Ok(())
    });
}

/// XML that takes long where namespaces are resolved or attributes compared: a limit instead.
#[cfg(feature = "centrelines")]
#[test]
fn hostile_xml_is_refused_at_once() {
    let count = 100_000;
    let attributes: String = (0..count).map(|i| format!(" a{i}=\"\"")).collect();
    let nested: String = (0..count).map(|i| format!("<a xmlns:n{i}=\"u{i}\">")).collect();
    let flat: String = (0..2 * count).map(|i| format!("<a xmlns:n{i}=\"u{i}\"/>")).collect();
    for (inside, expected) in [
        (format!("<a{attributes}/>"), "more than 64 attributes"),
        (nested, "nested more than 32 levels deep"),
        ("<a>".repeat(count), "nested more than 32 levels deep"),
        (flat, "more than 131072 elements"),
    ] {
        let text = format!("<VTKFile type=\"PolyData\">{inside}</VTKFile>");
        let start = Instant::now();
        let options = Options::default();
        let lines = mesh_files::centreline_from_bytes("a.vtp", text.as_bytes(), &options).map(drop);
        let mesh = from_bytes("a.vtp", text.as_bytes(), &options).map(drop);
        for answer in [lines, mesh] {
            crate::refused("a.vtp", answer.map_err(|error| error.to_string()), expected);
        }
        assert!(start.elapsed() < Duration::from_secs(10), "{expected}: {:?}", start.elapsed());
    }
}

/// Faces of very many corners: their time is in proportion to the file's size.
#[test]
fn faces_of_many_corners_are_cut_soon() {
    // A comb, one that leans, a spiral, and corners drawn at random, whose edges cross everywhere.
    type Corner = [f64; 2];
    let comb = |i: usize, count: usize| match i {
        0 => [0.0, -1e3],
        _ if i + 1 == count => [count as f64, -1e3],
        _ => [i as f64, if i.is_multiple_of(2) { 0.0 } else { 1e3 }],
    };
    let spiral = |i: usize, count: usize| {
        let (step, width) = if 2 * i < count { (i, 0.0) } else { (count - 1 - i, 0.4) };
        let (angle, r) = (step as f64 / 8.0, step as f64 / 50.0 + 1.0 - width);
        [r * angle.cos(), r * angle.sin()]
    };
    let mut draws = Draws(7);
    let mut drawn = |_: usize, _: usize| [0, 1].map(|_| draws.below(1 << 20) as f64);
    let leaning = |i: usize, count: usize| {
        let [x, y] = comb(i, count);
        [x + 2.0 * y, y + 2.0 * x]
    };
    type Outline<'a> = &'a mut dyn FnMut(usize, usize) -> Corner;
    let outlines: [(&str, Outline<'_>); 4] = [
        ("comb", &mut { comb }),
        ("leaning", &mut { leaning }),
        ("spiral", &mut { spiral }),
        ("drawn", &mut drawn),
    ];
    for (name, outline) in outlines {
        for (faces, count) in [(20, 1000), (1, 20_000)] {
            let mut text = String::new();
            for face in 0..faces {
                let corners: Vec<_> = (0..count).map(|i| outline(i, count)).collect();
                text.extend(corners.iter().map(|[x, y]| format!("v {x} {y} 0\n")));
                let words = (1..=count).map(|i| (face * count + i).to_string());
                text += &format!("f {}\n", words.collect::<Vec<_>>().join(" "));
            }
            let start = Instant::now();
            let mesh = crate::read("a.obj", &text).unwrap();
            assert!(start.elapsed() < TIME, "{name}, {count}: {:?}", start.elapsed());
            assert_eq!(mesh.triangles.len(), faces * (count - 2), "{name}");
        }
    }
    // A corner so far away that all others share a few cells: little time, and no surface.
    let far = |i: usize, count: usize| if i == 0 { [5e5, -1e6] } else { comb(i, count) };
    let corners: String =
        (0..20_000).map(|i| far(i, 20_000)).map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    let face: Vec<_> = (1..=20_000).map(|corner| corner.to_string()).collect();
    let start = Instant::now();
    let answer = crate::read("a.obj", format!("{corners}f {}\n", face.join(" ")));
    assert!(start.elapsed() < TIME, "{:?}", start.elapsed());
    crate::refused(
        "a.obj",
        answer,
        "a face of 20000 corners is too intricate; triangulate it before",
    );
}
