//! Segmentations become closed surfaces where the voxels are, in millimetres.

use crate::{Vertex, read, refused};
use flate2::{Compression, write::GzEncoder};
use mesh_files::{Frame, Mesh, Options, from_bytes};
use std::collections::HashMap;
use std::io::Write;

const SIZES: [usize; 3] = [40, 34, 30];

/// Rows of a matrix from voxels to millimetres.
type Matrix = [[f64; 4]; 3];

fn apply(matrix: &Matrix, voxel: Vertex) -> Vertex {
    matrix.map(|row| row[0] * voxel[0] + row[1] * voxel[1] + row[2] * voxel[2] + row[3])
}

/// Voxels of 1, 1.2 and 0.8 mm, turned about (1, 2, 2) / 3 by 40 degrees (Rodrigues' formula), and
/// moved.
fn oblique(mirror: f64) -> Matrix {
    let (axis, angle) = ([1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], 40_f64.to_radians());
    let (sin, cos) = angle.sin_cos();
    let cross = [[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]];
    let spacing = [1.0, 1.2, 0.8 * mirror];
    let shift = [-20.0, 31.0, 7.0];
    let entry = |i: usize, j: usize| {
        let unit = if i == j { cos } else { 0.0 };
        (unit + sin * cross[i][j] + (1.0 - cos) * axis[i] * axis[j]) * spacing[j]
    };
    [0, 1, 2].map(|i| [entry(i, 0), entry(i, 1), entry(i, 2), shift[i]])
}

/// A ball of label 3 of this radius around a voxel in the matrix's millimetres; a corner of label
/// 7; and its centre.
fn ball(matrix: &Matrix, radius: f64) -> (Vec<u8>, Vertex) {
    let centre = apply(matrix, [19.3, 16.6, 14.9]);
    let mut labels = Vec::new();
    for z in 0..SIZES[2] {
        for y in 0..SIZES[1] {
            for x in 0..SIZES[0] {
                let off = distance(apply(matrix, [x as f64, y as f64, z as f64]), centre);
                labels.push(if off < radius { 3 } else { 7 * u8::from(x + y + z < 4) });
            }
        }
    }
    (labels, centre)
}

fn distance(p: Vertex, q: Vertex) -> f64 {
    [0, 1, 2].map(|i| (p[i] - q[i]).powi(2)).iter().sum::<f64>().sqrt()
}

/// A NIfTI-1 header, by the byte offsets of nifti1.h, and the voxels.
struct Nifti {
    head: Vec<u8>,
    voxels: Vec<u8>,
}

impl Nifti {
    fn new(voxels: Vec<u8>) -> Self {
        let mut file = Self { head: vec![0; 352], voxels };
        file.put(0, &348_i32.to_le_bytes());
        let [x, y, z] = SIZES.map(|size| size as i16);
        file.shorts(40, &[3, x, y, z, 1, 1, 1, 1]).shorts(70, &[2, 8]).floats(108, &[352.0]);
        file.put(344, b"n+1\0");
        file
    }

    fn put(&mut self, at: usize, bytes: &[u8]) -> &mut Self {
        self.head[at..at + bytes.len()].copy_from_slice(bytes);
        self
    }

    fn shorts(&mut self, at: usize, numbers: &[i16]) -> &mut Self {
        self.put(at, &numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
    }

    fn floats(&mut self, at: usize, numbers: &[f32]) -> &mut Self {
        self.put(at, &numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
    }

    /// Placed by the rows of a matrix.
    fn sform(&mut self, matrix: &Matrix) -> &mut Self {
        let rows: Vec<_> = matrix.iter().flatten().map(|&x| x as f32).collect();
        self.shorts(254, &[1]).floats(280, &rows)
    }

    /// Placed as [`oblique`] is: by a quaternion and the spacings.
    fn qform(&mut self, mirror: f32) -> &mut Self {
        let half = 20_f32.to_radians().sin() / 3.0;
        self.shorts(252, &[1]).floats(76, &[mirror, 1.0, 1.2, 0.8]);
        self.floats(256, &[half, 2.0 * half, 2.0 * half, -20.0, 31.0, 7.0])
    }

    fn bytes(&self) -> Vec<u8> {
        [&self.head[..], &self.voxels].concat()
    }
}

fn nrrd(matrix: &Matrix, kind: &str, encoding: &str, space: &str, voxels: &[u8]) -> Vec<u8> {
    let column = |j: usize| format!("({},{},{})", matrix[0][j], matrix[1][j], matrix[2][j]);
    let [x, y, z] = SIZES;
    let head = format!(
        "NRRD0004\n# a comment: no field\ntype: {kind}\ndimension: 3\nspace: {space}\nsizes: {x} {y} {z}\n\
         space directions: {} {} {}\nkinds: domain domain domain\nendian: big\nencoding: {encoding}\n\
         space origin: {}\nSegment0_Name:=ball\n\n",
        column(0),
        column(1),
        column(2),
        column(3)
    );
    [head.as_bytes(), voxels].concat()
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut archive = GzEncoder::new(Vec::new(), Compression::fast());
    archive.write_all(bytes).unwrap();
    archive.finish().unwrap()
}

fn label(name: &str, bytes: &[u8], label: u32) -> Result<Mesh, String> {
    from_bytes(name, bytes, &Options::default().with_label(Some(label)))
        .map_err(|error| error.to_string())
}

/// Every edge is passed as often in one direction as in the other.
fn assert_closed(mesh: &Mesh) {
    let mut edges = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((from, to)).or_insert(0) += 1;
            *edges.entry((to, from)).or_insert(0) -= 1;
        }
    }
    assert!(edges.values().all(|&times| times == 0));
}

/// The volume inside; positive if the triangles are counter-clockwise seen from outside.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.vertices[i as usize];
    let six = mesh.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(corner);
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    });
    six.sum::<f64>() / 6.0
}

/// A closed surface around the ball. Each vertex lies in a cube of voxels that the sphere passes
/// through, so it is off the sphere by at most the cube's diagonal.
fn assert_ball(name: &str, mesh: &Mesh, centre: Vertex, radius: f64, unit: f64) {
    assert_closed(mesh);
    assert!(mesh.triangles.len() > 2000, "{name}: {}", mesh.triangles.len());
    let diagonal = (1.0_f64 + 1.44 + 0.64).sqrt() * unit;
    for &vertex in &mesh.vertices {
        let off = distance(vertex, centre) - radius;
        assert!(off.abs() <= diagonal, "{name}: {vertex:?} is off by {off}");
    }
    let exact = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    assert!((volume(mesh) / exact - 1.0).abs() < 0.03, "{name}: {} for {exact}", volume(mesh));
}

#[test]
fn a_segmented_ball_is_where_its_voxels_are() {
    for mirror in [1.0, -1.0] {
        let matrix = oblique(mirror);
        let (voxels, centre) = ball(&matrix, 9.5);
        let by_rows = Nifti::new(voxels.clone()).sform(&matrix).bytes();
        let by_turn = Nifti::new(voxels.clone()).qform(mirror as f32).bytes();
        // The sform wins where both are given.
        let both = Nifti::new(voxels.clone()).qform(-mirror as f32).sform(&matrix).bytes();
        for (name, bytes) in [
            ("rows.nii", by_rows.clone()),
            ("turn.nii", by_turn),
            ("both.nii", both),
            ("rows.nii.gz", gzip(&by_rows)),
            ("raw.nrrd", nrrd(&matrix, "uchar", "raw", "right-anterior-superior", &voxels)),
            ("gzip.nrrd", nrrd(&matrix, "uint8", "gzip", "RAS", &gzip(&voxels))),
        ] {
            let mesh = label(name, &bytes, 3).unwrap();
            assert_eq!(mesh.frame, Some(Frame::Ras), "{name}");
            assert_ball(name, &mesh, centre, 9.5, 1.0);
        }
    }
}

#[test]
fn every_type_of_number_gives_the_same_surface() {
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let expected = label("a.nrrd", &nrrd(&matrix, "uchar", "raw", "LPS", &voxels), 3).unwrap();
    assert_eq!(expected.frame, Some(Frame::Lps));
    let big = |bytes: fn(u8) -> Vec<u8>| {
        voxels.iter().flat_map(|&label| bytes(label)).collect::<Vec<u8>>()
    };
    let text: String = voxels.iter().map(|label| format!("{label} ")).collect();
    for (kind, encoding, bytes) in [
        ("signed char", "raw", voxels.clone()),
        ("short", "raw", big(|label| i16::from(label).to_be_bytes().into())),
        ("unsigned short", "raw", big(|label| u16::from(label).to_be_bytes().into())),
        ("int", "raw", big(|label| i32::from(label).to_be_bytes().into())),
        ("uint32_t", "raw", big(|label| u32::from(label).to_be_bytes().into())),
        ("long long", "raw", big(|label| i64::from(label).to_be_bytes().into())),
        ("uint64", "raw", big(|label| u64::from(label).to_be_bytes().into())),
        ("float", "raw", big(|label| f32::from(label).to_be_bytes().into())),
        ("double", "raw", big(|label| f64::from(label).to_be_bytes().into())),
        ("uint8", "ascii", text.into()),
    ] {
        let mesh = label("a.nrrd", &nrrd(&matrix, kind, encoding, "LPS", &bytes), 3).unwrap();
        assert!(mesh == expected, "{kind} {encoding}");
    }
    // The header's scale and shift are applied: 2 x 3 + 1.
    let scaled = Nifti::new(voxels).sform(&matrix).floats(112, &[2.0, 1.0]).bytes();
    assert_eq!(label("a.nii", &scaled, 7).unwrap().triangles, expected.triangles);
}

/// What nibabel 5.4 makes of slopes and intercepts: `get_slope_inter`, and 1 and 0 where that says
/// None.
#[test]
fn numbers_are_scaled_as_nibabel_scales_them() {
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let plain = label("a.nii", &Nifti::new(voxels.clone()).sform(&matrix).bytes(), 3).unwrap();
    let (nan, infinite) = (f32::NAN, f32::INFINITY);
    let scaled = |slope: f32, intercept: f32| {
        Nifti::new(voxels.clone()).sform(&matrix).floats(112, &[slope, intercept]).bytes()
    };
    for slope in [nan, -nan, infinite, -infinite, 0.0, -0.0] {
        for intercept in [0.0, 5.0, nan, infinite, -infinite] {
            let read = label("a.nii", &scaled(slope, intercept), 3);
            assert_eq!(
                read.as_ref().ok(),
                Some(&plain),
                "{slope} {intercept} {:?}",
                read.as_ref().err()
            );
        }
    }
    for intercept in [nan, infinite, -infinite] {
        refused("intercept", label("a.nii", &scaled(2.0, intercept), 3), "multiplied by 2, but");
    }
    assert_eq!(label("a.nii", &scaled(1.0, 4.0), 7).unwrap().triangles, plain.triangles);
    assert_eq!(label("a.nii", &scaled(-1.0, 10.0), 7).unwrap().triangles, plain.triangles);
}

#[test]
fn units_and_frames_are_those_of_the_file() {
    let matrix = oblique(1.0);
    let (voxels, centre) = ball(&matrix, 9.5);
    let metres =
        label("m.nii", &Nifti::new(voxels.clone()).sform(&matrix).put(123, &[1]).bytes(), 3)
            .unwrap();
    assert_ball("metres", &metres, centre.map(|x| x * 1000.0), 9500.0, 1000.0);
    let las = label("las.nrrd", &nrrd(&matrix, "uchar", "raw", "LAS", &voxels), 3).unwrap();
    assert_eq!(las.frame, Some(Frame::Ras));
    assert_ball("las", &las, [-centre[0], centre[1], centre[2]], 9.5, 1.0);
    let none = nrrd(&matrix, "uchar", "raw", "3D-right-handed", &voxels);
    assert_eq!(label("none.nrrd", &none, 3).unwrap().frame, None);
}

#[test]
fn labels_at_the_border_are_closed_and_all_of_them_are_one() {
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let bytes = Nifti::new(voxels).sform(&matrix).bytes();
    let corner = label("a.nii", &bytes, 7).unwrap();
    assert_closed(&corner);
    // 20 voxels of 0.96 cubic millimetres, whose corners the surface rounds off.
    assert!((0.4..1.0).contains(&(volume(&corner) / (20.0 * 0.96))), "{}", volume(&corner));
    let both = read("a.nii", &bytes).unwrap();
    assert_closed(&both);
    assert_eq!(
        both.triangles.len(),
        corner.triangles.len() + label("a.nii", &bytes, 3).unwrap().triangles.len()
    );
    // Every voxel of the file: the surface goes all around.
    let full = Nifti::new(vec![1; SIZES.iter().product()]).sform(&matrix).bytes();
    let full = read("full.nii", full).unwrap();
    assert_closed(&full);
    let exact = SIZES.iter().product::<usize>() as f64 * 0.96;
    assert!((volume(&full) / exact - 1.0).abs() < 0.01, "{} for {exact}", volume(&full));
}

#[test]
fn what_is_wrong_with_a_label_map_is_said_in_one_line() {
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let whole = || Nifti::new(voxels.clone());
    let good = whole().sform(&matrix).bytes();
    let mut second = whole();
    second.sform(&matrix).put(344, b"ni1\0");
    let mut nifti_2 = whole();
    nifti_2.put(0, &540_i32.to_le_bytes()).put(4, b"n+2\0");
    let header = |from: &str, to: &str| {
        let bytes = nrrd(&matrix, "uchar", "raw", "RAS", &voxels);
        let end = bytes.windows(2).position(|pair| pair == b"\n\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        assert!(head.contains(from));
        [head.replace(from, to).as_bytes(), &bytes[end..]].concat()
    };
    for (name, bytes, expected) in [
        ("cut.nii", good[..20_000].to_vec(), "shorter than its header says"),
        ("head.nii", good[..200].to_vec(), "header is cut short"),
        ("damaged.nii.gz", gzip(&good)[..300].to_vec(), "damaged or cut short"),
        (
            "bomb.nii.gz",
            gzip(whole().sform(&matrix).shorts(42, &[2000, 999, 999]).bytes().as_slice()),
            "shorter",
        ),
        (
            "image.nii",
            whole().sform(&matrix).floats(112, &[0.1, 0.0]).bytes(),
            "image.nii holds an image, in which a voxel is 0.70",
        ),
        ("placeless.nii", whole().bytes(), "does not say where its voxels are"),
        ("plane.nii", whole().sform(&[matrix[0], matrix[1], matrix[1]]).bytes(), "into one plane"),
        (
            "series.nii",
            whole().sform(&matrix).shorts(40, &[4, 10, 10, 10, 5]).bytes(),
            "a single label map",
        ),
        (
            "many.nii",
            whole().sform(&matrix).shorts(42, &[32000, 32000, 32000]).bytes(),
            "too many; crop it",
        ),
        ("flat.nii", whole().sform(&matrix).shorts(42, &[0]).bytes(), "no voxels"),
        ("colour.nii", whole().sform(&matrix).shorts(70, &[128, 24]).bytes(), "type 128"),
        ("offset.nii", whole().sform(&matrix).floats(108, &[f32::NAN]).bytes(), "byte NaN"),
        ("unit.nii", whole().sform(&matrix).put(123, &[7]).bytes(), "unknown code 7"),
        ("second.nii", second.bytes(), "second file"),
        ("two.nii", nifti_2.bytes(), "two.nii "),
        (
            "zero.nii",
            Nifti::new(vec![0; voxels.len()]).sform(&matrix).bytes(),
            "zero.nii holds no segment, because all its voxels are 0",
        ),
        ("nrrd.nii", header("raw", "raw"), "holds NRRD, not NIfTI"),
        ("nifti.nrrd", good.clone(), "holds NIfTI, not NRRD"),
        ("cut.nrrd", header("raw", "raw")[..1000].to_vec(), "shorter than its header says"),
        ("type.nrrd", header("uchar", "block"), "its type 'block' cannot be read"),
        ("sizes.nrrd", header("sizes: 40 34 30", "sizes: 40 x 30"), "not three numbers"),
        ("layers.nrrd", header("dimension: 3", "dimension: 4"), "not 4 numbers"),
        ("packed.nrrd", header("raw", "bzip2"), "its encoding 'bzip2' cannot be read"),
        (
            "space.nrrd",
            header("space: RAS", "space: scanner-xyz"),
            "its space 'scanner-xyz' cannot be read",
        ),
        ("second.nrrd", header("endian", "data file: brain.raw\nendian"), "second file"),
        ("where.nrrd", header("space origin: ", "origin: "), "no field 'space origin'"),
        (
            "none.nrrd",
            header("space directions: ", "space directions: none "),
            "not 3 x three numbers",
        ),
        (
            "unit.nrrd",
            header("endian", "space units: \"mm\" \"mm\" \"m\"\nendian"),
            "not all the same",
        ),
        ("empty-line.nrrd", b"NRRD0004\ntype: uchar\n".to_vec(), "not followed by an empty line"),
        ("other.nrrd", b"something else\n\n".to_vec(), "does not begin with 'NRRD000'"),
    ] {
        refused(name, read(name, bytes), expected);
    }
    // One byte has no order, so its header need not name one.
    assert!(read("plain.nrrd", header("endian: big\n", "")).is_ok());
    refused(
        "order",
        read("order.nrrd", header("type: uchar\n", "type: short\n").as_slice()),
        "shorter",
    );
    // The file is as it should be: only the label is not in it.
    refused(
        "label",
        label("a.nii", &good, 5),
        "a.nii has no voxel with label 5, but with 0, 3, 7; choose one",
    );
    refused(
        "label",
        label("a.nrrd", &header("raw", "raw"), 5),
        "a.nrrd has no voxel with label 5, but with 0, 3, 7;",
    );
    let shades: Vec<_> = (0..voxels.len()).map(|index| (index % 200) as u8).collect();
    let shades = Nifti::new(shades).sform(&matrix).bytes();
    refused(
        "label",
        label("b.nii", &shades, 255),
        "label 255, but with 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ...; choose",
    );
    refused("second", read("brain.nhdr", ""), "as one file");
}

#[test]
fn labels_that_a_writer_scaled_are_rounded_and_images_refused() {
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let plain = label("a.nii", &Nifti::new(voxels.clone()).sform(&matrix).bytes(), 3).unwrap();
    // 7 is 255 parts of 7 / 255, in single precision or in a few digits: 6.9999998, 7.00005,
    // 6.9999.
    let scaled: Vec<_> = voxels.iter().map(|&label| (u32::from(label) * 255 / 7) as u8).collect();
    let of = |slope: f32, voxels: &[u8]| {
        label(
            "a.nii",
            &Nifti::new(voxels.to_vec()).sform(&matrix).floats(112, &[slope, 0.0]).bytes(),
            7,
        )
    };
    let sevens: Vec<_> = scaled.iter().map(|&part| if part == 255 { 255 } else { 0 }).collect();
    for slope in [7.0 / 255.0, 0.027_451, 0.027_450_8] {
        let found = of(slope, &sevens).unwrap();
        assert!(!found.triangles.is_empty() && found.triangles.len() < plain.triangles.len());
    }
    for slope in [0.0275, 0.0274] {
        refused("image", of(slope, &sevens), "holds an image, in which a voxel is");
    }
    // 3 / 7 of 255 is no whole number: 109 parts are 2.992.
    refused("image", of(7.0 / 255.0, &scaled), "holds an image, in which a voxel is 2.99");
    for (number, expected) in
        [(2.999_99_f32, true), (3.000_01, true), (2.999, false), (3.001, false)]
    {
        let bytes: Vec<_> = voxels
            .iter()
            .flat_map(|&voxel| if voxel == 3 { number } else { 0.0 }.to_be_bytes())
            .collect();
        let read = label("a.nrrd", &nrrd(&matrix, "float", "raw", "LPS", &bytes), 3);
        assert_eq!(read.is_ok(), expected, "{number}");
    }
    // High labels times a slope of nearly 1: 199.998, 59999.4.
    for high in [200_u16, 60_000] {
        let bytes: Vec<_> = voxels
            .iter()
            .flat_map(|&voxel| (if voxel == 3 { high } else { 0 }).to_le_bytes())
            .collect();
        let scaled = |slope: f32, kind: i16| {
            let mut file = Nifti::new(bytes.clone());
            file.sform(&matrix).shorts(70, &[kind, 16]).floats(112, &[slope, 0.0]);
            label("a.nii", &file.bytes(), high.into())
        };
        for slope in [1.0, 0.99999, 1.00001, 1.000_000_1, 0.99995, 1.00005] {
            assert_eq!(scaled(slope, 512).unwrap().triangles.len(), plain.triangles.len());
        }
        for slope in [0.99971, 1.00029] {
            refused("image", scaled(slope, 512), "holds an image, in which a voxel is");
        }
    }
    // A whole number that single precision cannot hold is no image.
    assert!(
        of(16_777_217.0 / 255.0, &sevens)
            .is_err_and(|error| error.contains("no voxel with label 7"))
    );
}

#[test]
fn a_form_of_nifti_that_says_nothing_is_not_used() {
    let matrix = oblique(1.0);
    let (voxels, centre) = ball(&matrix, 9.5);
    let whole = || Nifti::new(voxels.clone());
    // An sform of zeros beside a good qform.
    let zeros = [[0.0; 4]; 3];
    let q = label("q.nii", &whole().sform(&zeros).qform(1.0).bytes(), 3).unwrap();
    assert_ball("q", &q, centre, 9.5, 1.0);
    // Without one it says as little as no form.
    let mut alone = whole();
    alone.sform(&zeros).floats(76, &[1.0, 2.0, 3.0, 4.0]);
    refused(
        "zeros",
        label("a.nii", &alone.bytes(), 3),
        "voxels are (its sform is zero and its qform unknown); save it again with a position, or",
    );
    // Some of its numbers are no position.
    let flat = [matrix[0], matrix[1], [0.0; 4]];
    refused(
        "plane",
        label("a.nii", &whole().sform(&flat).bytes(), 3),
        "its sform brings all voxels into one plane",
    );
    // Negative spacings: SimpleITK 2.5 mirrors the axis and nibabel 5.4 does not, in either form.
    for (place, spacings, name) in
        [(80, [-1.0, 1.2, 0.8], 1), (80, [1.0, -1.2, 0.8], 2), (80, [1.0, 1.2, -0.8], 3)]
    {
        let mut negative = whole();
        negative.qform(1.0).floats(place, &spacings);
        for bytes in [negative.bytes(), negative.sform(&matrix).bytes()] {
            let read = label("a.nii", &bytes, 3);
            refused("spacing", read.clone(), &format!("its pixdim[{name}] is -"));
            refused("spacing", read, "save it with the program that shows it right");
        }
    }
    // Neither of them.
    let mut none = whole();
    none.floats(76, &[1.0, 2.0, 3.0, 4.0]);
    refused(
        "none",
        label("a.nii", &none.bytes(), 3),
        "does not say where its voxels are (sform and qform are both",
    );
    let options = Options::default().with_label(Some(7)).with_no_position_allowed(true);
    let corner = from_bytes("a.nii", &none.bytes(), &options).unwrap();
    assert_eq!(from_bytes("a.nii", &alone.bytes(), &options).as_ref(), Ok(&corner));
    assert_eq!(corner.frame, None);
    // The corner has voxels 0 to 3 along each axis.
    let far =
        [0, 1, 2].map(|axis| corner.vertices.iter().map(|v| v[axis]).fold(f64::MIN, f64::max));
    assert!(
        [2.0, 3.0, 4.0].iter().zip(far).all(|(size, far)| far > 3.0 * size && far < 4.0 * size),
        "{far:?}"
    );
}

/// A header of NIfTI-2, by the byte offsets of nifti2.h.
fn second(voxels: &[u8], matrix: &Matrix, is_big: bool) -> Vec<u8> {
    let mut head = vec![0; 544];
    let mut put = |at: usize, mut bytes: Vec<u8>| {
        if is_big {
            bytes.reverse();
        }
        head[at..at + bytes.len()].copy_from_slice(&bytes);
    };
    put(0, 540_i32.to_le_bytes().into());
    put(12, 2_i16.to_le_bytes().into());
    let sizes = SIZES.map(|size| size as i64);
    for (k, size) in [3, sizes[0], sizes[1], sizes[2], 1, 1, 1, 1].into_iter().enumerate() {
        put(16 + 8 * k, size.to_le_bytes().into());
    }
    put(168, 544_i64.to_le_bytes().into());
    put(176, 1_f64.to_le_bytes().into());
    put(348, 1_i32.to_le_bytes().into());
    for (k, x) in matrix.iter().flatten().enumerate() {
        put(400 + 8 * k, x.to_le_bytes().into());
    }
    put(500, 2_i32.to_le_bytes().into());
    head[4..8].copy_from_slice(b"n+2\0");
    [&head[..], voxels].concat()
}

#[test]
fn the_second_version_of_nifti_is_read() {
    let matrix = oblique(-1.0);
    let (voxels, centre) = ball(&matrix, 9.5);
    for is_big in [false, true] {
        let bytes = second(&voxels, &matrix, is_big);
        for (name, bytes) in [("a.nii", bytes.clone()), ("a.nii.gz", gzip(&bytes))] {
            let mesh = label(name, &bytes, 3).unwrap();
            assert_ball(name, &mesh, centre, 9.5, 1.0);
            assert_eq!((mesh.frame, mesh.states_unit), (Some(Frame::Ras), true));
        }
    }
}

#[test]
fn voxels_in_a_file_beside_the_header_are_read() {
    use mesh_files::load_with;
    let matrix = oblique(1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("beside");
    std::fs::create_dir_all(folder.join("raw data")).unwrap();
    let load = |name: &str| {
        load_with(folder.join(name), &Options::default().with_label(Some(3)))
            .map_err(|error| error.to_string())
    };
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    let whole = nrrd(&matrix, "uchar", "raw", "LPS", &voxels);
    let expected = label("a.nrrd", &whole, 3).unwrap();
    let head = String::from_utf8(whole[..whole.len() - voxels.len() - 1].to_vec()).unwrap();
    let apart = |field: &str| head.clone() + field;
    write("ball 1.raw", &voxels);
    write("raw data/ball.raw", &voxels);
    write("ball.raw.gz", &gzip(&voxels));
    write("tail.raw", &[&b"a head\n of 2 lines\n"[..], &voxels].concat());
    for (name, text) in [
        ("a.nhdr", apart("data file: ball 1.raw\n")),
        ("b.nhdr", apart("data file: ./ball 1.raw\n\n")),
        ("c.nrrd", apart("datafile: raw data/ball.raw\r\n")),
        ("d.nhdr", apart("data file: ball.raw.gz\n").replace("encoding: raw", "encoding: gzip")),
        ("e.nhdr", apart("data file: tail.raw\nbyte skip: -1\n")),
        ("f.nhdr", apart("data file: tail.raw\nbyte skip: 19\n")),
        ("g.nhdr", apart("data file: tail.raw\nline skip: 2\n")),
        ("h.nhdr", apart("DATA FILE: ball 1.raw\n")),
    ] {
        write(name, text.as_bytes());
        assert_eq!(load(name).as_ref(), Ok(&expected), "{name}");
    }
    for (name, text, expected) in [
        (
            "list.nhdr",
            apart("data file: LIST\na.raw\n"),
            "in several files, 'LIST', which cannot be read; save one .nrrd",
        ),
        (
            "many.nhdr",
            apart("data file: a%03d.raw 1 9 1\n"),
            "in several files, 'a%03d.raw 1 9 1', which cannot be read; save one .nrrd",
        ),
        ("up.nhdr", apart("data file: ../ball.raw\n"), "in a second file"),
        ("gone.nhdr", apart("data file: gone.raw\n"), "gone.raw"),
        ("skip.nhdr", apart("data file: ball 1.raw\nbyte skip: -2\n"), "its 'byte skip' is -2"),
    ] {
        write(name, text.as_bytes());
        refused(name, load(name), expected);
    }
}

#[test]
fn labels_are_listed_with_the_volume_of_their_voxels() {
    let matrix = oblique(-1.0);
    let (voxels, _) = ball(&matrix, 9.5);
    let list = |name: &str, bytes: &[u8], scale| {
        mesh_files::labels_from_bytes(name, bytes, &Options::scaled(scale))
            .map_err(|error| error.to_string())
    };
    let count = |label: u8| voxels.iter().filter(|&&voxel| voxel == label).count() as u64;
    let mut nifti = Nifti::new(voxels.clone());
    let nifti = nifti.sform(&matrix).bytes();
    let nrrd = nrrd(&matrix, "uchar", "raw", "LPS", &voxels);
    for (name, bytes) in [("a.nii", &nifti), ("a.nrrd", &nrrd)] {
        let found = list(name, bytes, 1.0).unwrap();
        let labels: Vec<_> = found.iter().map(|found| (found.label, found.voxels)).collect();
        assert_eq!(labels, [(3, count(3)), (7, count(7))], "{name}");
        // A voxel is 1 x 1.2 x 0.8 mm. The ball's own volume is near.
        for found in &found {
            let volume = 0.96 * found.voxels as f64;
            assert!((found.volume - volume).abs() < 1e-5 * volume, "{name}: {found:?}");
        }
        let ball = 4.0 / 3.0 * std::f64::consts::PI * 9.5_f64.powi(3);
        assert!((found[0].volume / ball - 1.0).abs() < 0.02, "{name}: {found:?}");
        let halved = list(name, bytes, 0.5).unwrap();
        assert_eq!(halved[0].volume, found[0].volume / 8.0, "{name}");
    }
    let triangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".as_bytes();
    refused("a.obj", list("a.obj", triangles, 1.0), "without labels (OBJ); give the segmentation");
    let mut nothing = Nifti::new(vec![0; voxels.len()]);
    let nothing = list("a.nii", &nothing.sform(&matrix).bytes(), 1.0);
    refused("a.nii", nothing, "all its voxels are 0");
    refused("a.nii", list("a.nii", &nifti[..400], 1.0), "shorter than its header says");
    refused("a.nii", list("a.nii", &nifti, -1.0), "the scale is -1");
}

/// Of more labels than `MOST_LABELS`, the lowest are listed with all their voxels, in any order of
/// the voxels.
#[test]
fn of_many_labels_the_lowest_are_listed() {
    let count = 1500_usize;
    let text = |labels: &[usize]| {
        let head = "NRRD0004\ntype: ushort\ndimension: 3\nspace: LPS\nsizes: SIZE 1 1\n\
                    space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\
                    encoding: ascii\n\n";
        let words: Vec<_> = labels.iter().map(usize::to_string).collect();
        head.replace("SIZE", &labels.len().to_string()) + &words.join(" ") + "\n"
    };
    let rising: Vec<_> = (1..=count).flat_map(|label| [label, 0]).collect();
    // Label k comes twice: among the falling, and among the rising.
    let both: Vec<_> = rising.iter().rev().chain(&rising).copied().collect();
    for (labels, times) in [(rising, 1), (both, 2)] {
        let text = text(&labels);
        let found = mesh_files::labels_from_bytes("a.nrrd", text.as_bytes(), &Options::default());
        let found = found.unwrap();
        let listed: Vec<_> = found.iter().map(|found| found.label as usize).collect();
        assert_eq!(listed, (1..=1000).collect::<Vec<_>>());
        assert!(found.iter().all(|found| found.voxels == times), "{times}");
    }
}
