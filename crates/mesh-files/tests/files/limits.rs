//! Counts in a file's header are not trusted, and the contents of an archive are not stored.

use crate::{file, ply_header, read, refused};
use mesh_files::{MeshFileError, Options, load};

/// Little for a computer, and little beside what the files below would take.
const LITTLE: u64 = 4 << 20;

/// The most memory that was held at once.
fn memory(ask: impl FnOnce()) -> u64 {
    allocation_counter::measure(ask).bytes_max
}

#[test]
fn headers_that_count_what_is_not_there_take_no_memory() {
    let vertex = |count: u64, format: &str| {
        ply_header(3, 1, format, "float")
            .replace("vertex 3", &format!("vertex {count}"))
            .into_bytes()
    };
    let face = |count: u32| {
        let head =
            ply_header(0, 1, "binary_little_endian", "float").replace("uchar int", "uint int");
        [head.as_bytes(), &count.to_le_bytes(), &[0; 40]].concat()
    };
    let nothing = |format: &str, count: u64| {
        let head = ply_header(3, 1, format, "float");
        let head =
            head.replace("element vertex", &format!("element nothing {count}\nelement vertex"));
        [head.as_bytes(), &[0; 100]].concat()
    };
    let mut stl = vec![0; 84 + 50];
    stl[80..84].copy_from_slice(&(u32::MAX - 1).to_le_bytes());
    for (name, bytes, expected) in [
        ("ascii.ply", vertex(4_000_000_000, "ascii"), "end early"),
        ("little.ply", vertex(4_000_000_000, "binary_little_endian"), "end early"),
        ("big.ply", vertex(u64::MAX / 2, "binary_big_endian"), "end early"),
        ("face.ply", face(u32::MAX), "end early"),
        // Any number of elements of no words or no bytes: what follows them is read.
        ("lines.ply", nothing("ascii", 4_000_000_000), "where a number should be"),
        (
            "bytes.ply",
            nothing("binary_little_endian", u64::MAX / 2),
            "3 of element 'vertex' end early",
        ),
        ("count.stl", stl, "counts 4294967294 triangles, but it ends after 1"),
    ] {
        let bytes = if name == "bytes.ply" { bytes[..bytes.len() - 99].to_vec() } else { bytes };
        let taken = memory(|| refused(name, read(name, &bytes), expected));
        assert!(taken < LITTLE, "{name}: {taken}");
    }
}

/// A million elements of one byte each that no mesh needs, and a triangle behind them.
#[test]
fn elements_that_are_not_needed_are_not_kept() {
    let count = 1_000_000;
    let head = ply_header(3, 1, "binary_little_endian", "float");
    let other = format!("element other {count}\nproperty uchar colour\nelement vertex");
    let mut bytes = head.replace("element vertex", &other).into_bytes();
    bytes.extend(vec![7; count]);
    [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
        .iter()
        .for_each(|x| bytes.extend(x.to_le_bytes()));
    bytes.extend([3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0]);
    let taken = memory(|| assert_eq!(read("other.ply", &bytes).unwrap().triangles, [[0, 1, 2]]));
    assert!(taken < LITTLE, "{taken}");
}

#[test]
fn a_file_beyond_the_limit_is_not_read() {
    let path = file("sparse.stl", b"");
    std::fs::File::options().write(true).open(&path).unwrap().set_len(3 << 30).unwrap();
    let taken = memory(|| {
        let refusal = load(&path).unwrap_err();
        assert!(
            matches!(refusal, MeshFileError::TooLarge { bytes, limit, .. } if (bytes, limit) == (3 << 30, 2 << 30))
        );
        refused(
            "sparse.stl",
            Err::<(), _>(refusal.to_string()),
            "3072 MiB of memory, but 2048 MiB are allowed; crop it",
        );
    });
    std::fs::remove_file(&path).unwrap();
    assert!(taken < LITTLE, "{taken}");
    assert_eq!(Options::default().memory_limit, 2 << 30);
}

#[cfg(feature = "label-maps")]
mod label_maps {
    use super::{LITTLE, memory};
    use flate2::{Compression, write::GzEncoder};
    use mesh_files::{Mesh, MeshFileError, Options, from_bytes};
    use std::io::Write;

    /// An NRRD file of bytes, packed. What `voxel` says of three numbers is in it.
    fn packed(sizes: [usize; 3], voxel: impl Fn([usize; 3]) -> u8) -> Vec<u8> {
        let [x, y, z] = sizes;
        let head = format!(
            "NRRD0004\ntype: uchar\ndimension: 3\nspace: RAS\nsizes: {x} {y} {z}\nencoding: gzip\n\
             space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n"
        );
        let mut archive = GzEncoder::new(head.into_bytes(), Compression::fast());
        for z in 0..z {
            let rows = (0..y).flat_map(|y| (0..x).map(move |x| [x, y, z]));
            archive.write_all(&rows.map(&voxel).collect::<Vec<_>>()).unwrap();
        }
        archive.finish().unwrap()
    }

    fn within(bytes: &[u8], limit: u64) -> Result<Mesh, MeshFileError> {
        from_bytes("a.nrrd", bytes, &Options::default().with_memory_limit(limit))
    }

    #[test]
    fn a_small_archive_of_a_large_volume_takes_no_memory() {
        let zeros = packed([400; 3], |_| 0);
        assert!(zeros.len() < 1 << 20);
        for label in [None, Some(1)] {
            let taken = memory(|| {
                let options = Options::default().with_label(label).with_memory_limit(0);
                match (from_bytes("a.nrrd", &zeros, &options), label) {
                    (Err(MeshFileError::NothingSegmented { .. }), None) => {}
                    (Err(MeshFileError::NoSuchLabel { present, .. }), Some(_)) => {
                        assert_eq!(present, [0])
                    }
                    other => panic!("{other:?}"),
                }
            });
            assert!(taken < LITTLE, "{label:?}: {taken}");
        }
        // Two voxels in opposite corners: the box around them is the volume.
        let corners = packed([400; 3], |voxel| u8::from(voxel == [0; 3] || voxel == [399; 3]));
        let taken = memory(|| {
            let refusal = within(&corners, 5 * 403_u64.pow(3) - 1);
            let bytes = 5 * 403_u64.pow(3);
            assert!(
                matches!(refusal, Err(MeshFileError::TooLarge { bytes: b, .. }) if b == bytes),
                "{refusal:?}"
            );
        });
        assert!(taken < LITTLE, "{taken}");
    }

    #[test]
    fn labels_of_all_kinds_are_listed_up_to_a_limit() {
        let sizes = [50, 40, 30];
        let shades = packed(sizes, |[x, y, z]| (x + y + z) as u8);
        let head = shades.windows(2).position(|pair| pair == b"\n\n").unwrap();
        let text = String::from_utf8(shades[..head].to_vec()).unwrap();
        let count = sizes.iter().product::<usize>();
        // From the highest to the lowest, so that all have to make room.
        let numbers: String = (0..count).rev().map(|number| format!("{number} ")).collect();
        let file = text.replace("gzip", "text").replace("uchar", "int") + "\n\n" + &numbers;
        let options = Options::default().with_label(Some(u32::MAX));
        let Err(MeshFileError::NoSuchLabel { present, .. }) =
            from_bytes("a.nrrd", file.as_bytes(), &options)
        else {
            panic!("there is no such label")
        };
        assert_eq!(present, (0..1000).collect::<Vec<_>>());
        // Lists the labels that are read as one surface, or none if one label is chosen.
        let labels = |bytes: &[u8], label| {
            from_bytes("a.nrrd", bytes, &Options::default().with_label(label)).unwrap().labels
        };
        assert_eq!(labels(&shades, None), (1..=117).collect::<Vec<_>>());
        assert_eq!(labels(file.as_bytes(), None), (1..=1000).collect::<Vec<_>>());
        assert!(labels(&shades, Some(5)).is_empty());
    }

    /// The memory that a refusal names is enough, and at most that much is taken.
    #[test]
    fn the_memory_that_is_asked_for_is_enough_and_no_more_is_taken() {
        let hash =
            |[x, y, z]: [usize; 3]| (x * 7919 + y * 104_729 + z * 1_299_709) ^ (x * y + z * 31);
        type Inside<'a> = &'a dyn Fn([usize; 3]) -> bool;
        let volumes: [(&str, Inside<'_>); 5] = [
            ("full", &|_| true),
            ("checkerboard", &|[x, y, z]| (x + y + z) % 2 == 0),
            ("dots", &|voxel| voxel.iter().all(|x| x % 3 == 1)),
            ("rods", &|[x, y, _]| x % 2 == 0 && y % 2 == 0),
            ("noise", &|voxel| hash(voxel) % 2 == 0),
        ];
        for (name, is_inside) in volumes {
            let bytes = packed([70, 60, 50], |voxel| u8::from(is_inside(voxel)));
            let mut limit = 0;
            let mut refusals = 0;
            let mut read = None;
            let mut taken = 0;
            while read.is_none() {
                taken = memory(|| match within(&bytes, limit) {
                    Ok(mesh) => read = Some(mesh.triangles.len()),
                    Err(MeshFileError::TooLarge { bytes, limit: said, .. }) => {
                        assert!(said == limit && bytes > limit, "{name}");
                        (limit, refusals) = (bytes, refusals + 1);
                    }
                    Err(error) => panic!("{name}: {error}"),
                });
            }
            // Once for the box and once for the surface.
            assert_eq!(refusals, 2, "{name}");
            assert!(taken <= limit + LITTLE / 16, "{name}: {taken} of {limit}");
            assert!(2 * taken > limit, "{name}: {taken} of {limit}");
        }
    }
}
