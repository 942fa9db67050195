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
        assert!(
            !mesh.triangles.is_empty() && mesh.vertices.iter().flatten().all(|x| x.is_finite())
        );
        assert!(mesh.triangles.iter().flatten().all(|&corner| (corner as usize) < count));
        Ok(())
    });
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

/// Faces that are cut by ears: their time is quadratic at worst, so that their corners are limited.
#[test]
fn faces_of_many_corners_are_cut_soon_or_refused() {
    // A comb, and corners drawn at random, whose edges cross everywhere.
    let comb = |i: usize, count: usize| match i {
        0 => [0.0, -1e3],
        _ if i + 1 == count => [count as f64, -1e3],
        _ => [i as f64, if i.is_multiple_of(2) { 0.0 } else { 1e3 }],
    };
    let mut draws = Draws(7);
    let drawn: Vec<_> =
        (0..20_000).map(|_| [draws.below(1 << 20) as f64, draws.below(1 << 20) as f64]).collect();
    let obj = |corners: &[[f64; 2]]| {
        let vertices: String = corners.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
        let face: Vec<_> = (1..=corners.len()).map(|corner| corner.to_string()).collect();
        format!("{vertices}f {}\n", face.join(" "))
    };
    for count in [1000, 16_384, 20_000] {
        for corners in
            [(0..count).map(|i| comb(i, count)).collect::<Vec<_>>(), drawn[..count].to_vec()]
        {
            let text = obj(&corners);
            let start = Instant::now();
            let answer = crate::read("a.obj", &text);
            assert!(start.elapsed() < 60 * TIME, "{count}: {:?}", start.elapsed());
            println!("took {count}: {:?}", start.elapsed());
            if count > 16_384 {
                crate::refused(
                    "a.obj",
                    answer,
                    "a face of 20000 corners is not convex; triangulate it before",
                );
            } else {
                assert!(!answer.unwrap().triangles.is_empty());
            }
        }
    }
}
