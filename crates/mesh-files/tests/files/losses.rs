//! No face is lost without a word: what a file states beside the faces that are read is an error.

use crate::reports::{obj, report};
use crate::{binary_stl, ply_header, read, refused, ring};

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn the_ends_of_lines_may_differ_in_a_file() {
    let whole = obj(TETRAHEDRON).unwrap();
    for (from, to) in [
        ("f 1 3 2", "# faces\rf 1 3 2"),
        ("f 1 3 2\n", "f 1 3 2\r"),
        ("\n", "\r\r\n"),
        ("v 0 0 0\nv 1 0 0\n", "v 0 0 0\r\nv 1 0 0\r"),
        ("f 3 1 4\n", "f 3 1 4"),
    ] {
        let text = TETRAHEDRON.replace(from, to);
        assert_eq!(obj(&text).as_ref(), Ok(&whole), "{text:?}");
    }
    // Messages count lines in the same way.
    for end in ["\n", "\r", "\r\n", "\r\r\n"] {
        refused(
            "line",
            obj(&TETRAHEDRON.replace("f 1 3 2", "f 1 x 2").replace('\n', end)),
            "line 5 has 'x'",
        );
    }
}

#[test]
fn statements_of_obj_that_are_not_read_are_refused() {
    for (from, to, expected) in [
        ("f 1 3 2", "f1 3 2", "line 5 has the unknown statement 'f1'"),
        ("f 1 3 2", "F 1 3 2", "line 5 has the unknown statement 'F'"),
        ("v 0 0 1", "V 0 0 1", "line 4 has the unknown statement 'V'"),
        ("f 1 3 2", "face 1 3 2", "unknown statement 'face'"),
        ("f 1 3 2", "1 3 2", "unknown statement '1'"),
        ("f 1 3 2", "g a\nb\\\n1 3 2", "unknown statement 'b'"),
        ("f 1 3 2", "l 1 2 \\\nf1 3 2", "unknown statement 'f1'"),
        ("v 0 0 1\n", "v 0 0 1 \\\n", "'f' where a number should be"),
        ("f 1 3 2", "surf 0 1 0 1 1 2 3", "line 5 has the statement 'surf', whose surface is not"),
        ("f 1 3 2", "call other.obj", "line 5 has the statement 'call', whose surface is not read"),
    ] {
        refused(to, obj(&TETRAHEDRON.replacen(from, to, 1)), expected);
    }
    // Curves and points of any length are no surface.
    let lines = "l 1 2 \\\n3 4\np 1\ncurv 0 1 1 \\\n 2 \\\n3\nend\nvt 0 0\nvn 0 0 1\n";
    assert_eq!(obj(&(lines.to_owned() + TETRAHEDRON)), obj(TETRAHEDRON));
}

#[test]
fn facets_in_the_name_of_a_solid_are_refused() {
    let text = std::fs::read_to_string(report("A07_end_solid.stl")).unwrap();
    for text in [text.replace('\n', " "), text.replace('\n', " ").replace("end facet", "endfacet")]
    {
        let lost = text.replacen("facet normal", "fact normal", 1);
        refused("facet", read("a.stl", lost), "line 1 ends a facet that does not begin");
    }
}

#[test]
fn bytes_and_faces_beside_those_that_a_ply_counts_are_refused() {
    let (points, triangles) = ring();
    let binary = |faces: usize| {
        let head = ply_header(points.len(), faces, "binary_little_endian", "double");
        let mut bytes = head.into_bytes();
        points.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        for triangle in &triangles {
            bytes.push(3);
            triangle.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        }
        bytes
    };
    let whole = read("a.ply", binary(triangles.len())).unwrap();
    assert_eq!(whole.triangles, triangles);
    refused("fewer", read("a.ply", binary(300)), "more bytes than its header announces");
    let padded = [&binary(triangles.len())[..], b"\0\0\r\n"].concat();
    assert_eq!(read("a.ply", padded), Ok(whole));
    // Of few vertices, whose numbers are control characters.
    let few = |faces| {
        let mut bytes = ply_header(4, faces, "binary_little_endian", "float").into_bytes();
        let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        corners.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3_i32]] {
            bytes.push(3);
            face.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        }
        bytes
    };
    assert_eq!(read("a.ply", few(4)).unwrap().triangles.len(), 4);
    refused("few", read("a.ply", few(3)), "it has 13 more bytes than its header announces");
    let text = ply_header(3, 1, "ascii", "float") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let second = "element polygon 1\nproperty list uchar int vertex_indices\nend_header";
    let other = text.replace("end_header", second) + "3 0 2 1\n";
    refused("other", read("a.ply", other), "its element 'polygon' has faces; name the element");
    // The scanned grid of Stanford's files names a vertex or none.
    let grid = text.replace("end_header", &second.replace("polygon 1", "range_grid 2"));
    assert_eq!(read("a.ply", grid + "0\n1 2\n").unwrap().triangles, [[0, 1, 2]]);
    let stl = binary_stl(&ring());
    assert_eq!(read("a.stl", &stl).unwrap().triangles.len(), triangles.len());
}

#[cfg(feature = "centrelines")]
mod vtk {
    use crate::{read, refused};

    const HEAD: &str = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n\
        POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
    const POLYGONS: &str = "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

    #[test]
    fn cells_that_a_section_does_not_count_are_refused() {
        let text = HEAD.to_owned() + POLYGONS;
        assert_eq!(read("a.vtk", &text).unwrap().triangles.len(), 4);
        let new = "POLYGONS 5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\nCONNECTIVITY vtktypeint64\n\
            0 2 1 0 1 3 1 2 3 2 0 3\n";
        let cells = POLYGONS.replace("POLYGONS", "CELLS") + "CELL_TYPES 4\n5\n5\n5\n5\n";
        let grid = HEAD.replace("POLYDATA", "UNSTRUCTURED_GRID") + &cells;
        let data = "POINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4\n";
        for (text, expected) in [
            (text.replace("POLYGONS 4", "POLYGONS 5"), "counts 5 cells, but has 4"),
            (text.replace("POLYGONS 4", "POLYGONS 3"), "counts 3 cells, but has 4"),
            (text.replace("4 16", "3 12"), "where a section should begin"),
            (text.replace("4 16", "4 15"), "shorter than it says"),
            (text.replace("16\n", "16 "), "no head of a section"),
            (text.replace("16\n", "16\r"), "no head of a section"),
            (text.clone() + "POINTS 1 float\n0 0 0\n", "another section of this kind"),
            (HEAD.to_owned() + data + POLYGONS, "points or cells after their data"),
            (
                HEAD.to_owned() + new.replace("0 3 6 9 12", "0 3 6 9 9").as_str(),
                "do not fit its CONN",
            ),
            (
                HEAD.to_owned() + new.replace("0 3 6 9 12", "3 3 6 9 12").as_str(),
                "do not fit its CONN",
            ),
            (grid.replace("CELL_TYPES 4\n5\n5\n5\n5\n", ""), "its CELLS have no CELL_TYPES"),
            (grid.replace("CELL_TYPES", &format!("{cells}CELL_TYPES")), "another section of this"),
            (grid.replace("4\n5\n5", "4\n5.5\n5"), "cells of type 5.5"),
            (grid.replace("4\n5\n5", "4\n8\n5"), "cells of type 8, which have 4 points"),
            (
                HEAD.to_owned() + "FIELD f 1\nids 1 9 int\n1 2 3\n" + POLYGONS,
                "'POLYGONS' where a num",
            ),
        ] {
            refused(&text, read("a.vtk", &text), expected);
        }
        // A block of metadata without the empty line at its end.
        let open = HEAD.to_owned() + "METADATA\nINFORMATION 0\n" + POLYGONS + data;
        assert_eq!(read("a.vtk", open).unwrap().triangles.len(), 4);
    }

    #[test]
    fn bytes_behind_the_cells_of_a_binary_section_are_refused() {
        let points = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let cells = [3_i32, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 2, 0, 3];
        let file = |count: usize, size: usize| {
            let mut bytes =
                HEAD.split("0 0 0").next().unwrap().replace("ASCII", "BINARY").into_bytes();
            points.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
            bytes.extend(format!("\nPOLYGONS {count} {size}\n").bytes());
            cells.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
            bytes.push(b'\n');
            bytes
        };
        assert_eq!(read("a.vtk", file(4, 16)).unwrap().triangles.len(), 4);
        for (count, size) in [(2, 8), (3, 12), (4, 12), (2, 16), (5, 16)] {
            let answer = read("a.vtk", file(count, size));
            assert!(answer.is_err(), "{count} {size}: {answer:?}");
        }
    }

    #[test]
    fn the_counts_of_a_piece_are_compared() {
        let text = "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\">\
            <Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\
            <Polys><DataArray type=\"Int64\" Name=\"connectivity\">0 2 1 0 1 3</DataArray>\
            <DataArray type=\"Int64\" Name=\"offsets\">3 6</DataArray></Polys></Piece></PolyData></VTKFile>";
        assert_eq!(read("a.vtp", text).unwrap().triangles.len(), 2);
        let polys = &text[text.find("<Polys>").unwrap()..text.find("</Piece>").unwrap()];
        for (from, to, expected) in [
            ("Polys=\"2\"", "Polys=\"3\"", "NumberOfPolys is 3, but there are 2"),
            ("Polys=\"2\"", "Polys=\"1\"", "NumberOfPolys is 1, but there are 2"),
            ("Polys=\"2\"", "Polys=\"x\"", "NumberOfPolys is x, but there are 2"),
            ("Points=\"4\"", "Points=\"5\"", "NumberOfPoints is 5, but there are 4"),
            ("3 6", "3", "offsets do not fit its connectivity"),
            (polys, "", "NumberOfPolys is 2, but there are 0"),
            ("</Piece>", &format!("{polys}</Piece>"), "has the element Polys twice"),
        ] {
            refused(to, read("a.vtp", text.replacen(from, to, 1)), expected);
        }
    }
}
