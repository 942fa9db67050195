//! Surfaces in VTK's files, lines that are cut into cells, and what stands between the sections.

use crate::reports::{area, volume};
use crate::{Vertex, read, refused};
use mesh_files::{Centreline, Frame, Options, centreline_from_bytes};

const POINTS: [Vertex; 5] =
    [[0.0, 0.0, 0.0], [0.0, 0.0, 10.0], [1.0, 0.0, 20.0], [3.0, 0.0, 29.0], [4.0, 1.0, 35.0]];

fn lines(name: &str, bytes: impl AsRef<[u8]>, line: Option<usize>) -> Result<Centreline, String> {
    let options = Options::default().with_line(line);
    centreline_from_bytes(name, bytes.as_ref(), &options).map_err(|error| error.to_string())
}

fn text(section: &str) -> String {
    let points: Vec<_> = POINTS.iter().flatten().map(f64::to_string).collect();
    format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 5 double\n{}\n{section}\n",
        points.join(" ")
    )
}

fn cells(cells: &[&[usize]]) -> String {
    let numbers: usize = cells.iter().map(|cell| cell.len() + 1).sum();
    let line = |cell: &&[usize]| {
        let words: Vec<_> = cell.iter().map(usize::to_string).collect();
        format!("{} {}\n", cell.len(), words.join(" "))
    };
    text(&format!(
        "LINES {} {numbers}\n{}",
        cells.len(),
        cells.iter().map(line).collect::<String>()
    ))
}

fn places(indices: &[usize]) -> Vec<Vertex> {
    indices.iter().map(|&index| POINTS[index]).collect()
}

#[test]
fn cells_are_joined_where_their_ends_meet() {
    // The cells, and the lines that they make: in the order and the direction of their first cells.
    type Lines<'a> = &'a [&'a [usize]];
    let cases: [(Lines<'_>, Lines<'_>); 20] = [
        (&[&[0, 1], &[1, 2], &[2, 3], &[3, 4]], &[&[0, 1, 2, 3, 4]]),
        (&[&[2, 3], &[0, 1], &[3, 4], &[1, 2]], &[&[0, 1, 2, 3, 4]]),
        // Some are turned, and the first one too.
        (&[&[2, 3], &[1, 0], &[3, 4], &[2, 1]], &[&[0, 1, 2, 3, 4]]),
        (&[&[3, 2], &[0, 1], &[3, 4], &[1, 2]], &[&[4, 3, 2, 1, 0]]),
        // Once around.
        (&[&[1, 2], &[2, 0], &[0, 1]], &[&[1, 2, 0, 1]]),
        // Two lines, and one that branches.
        (&[&[3, 4], &[0, 1], &[1, 2]], &[&[3, 4], &[0, 1, 2]]),
        (&[&[0, 1], &[1, 2], &[1, 3], &[3, 4]], &[&[0, 1], &[1, 2], &[1, 3, 4]]),
        // Longer lines go on where one begins at the end of another.
        (&[&[2, 3, 4], &[0, 1, 2]], &[&[0, 1, 2, 3, 4]]),
        (&[&[0, 1, 2], &[2, 3], &[3, 4]], &[&[0, 1, 2, 3, 4]]),
        (&[&[0, 1, 2], &[3, 2]], &[&[0, 1, 2, 3]]),
        // Two branches that begin, or end, at one place.
        (&[&[0, 1, 2], &[0, 3, 4]], &[&[0, 1, 2], &[0, 3, 4]]),
        (&[&[1, 2, 0], &[4, 3, 0]], &[&[1, 2, 0], &[4, 3, 0]]),
        // One that meets the middle of another.
        (&[&[0, 1, 2], &[1, 3], &[3, 4]], &[&[0, 1, 2], &[1, 3, 4]]),
        // A cell without length is left out, unless there is no other; a repeated point stays.
        (&[&[0, 1], &[2, 2]], &[&[0, 1]]),
        (&[&[0, 0], &[0, 1], &[1, 1, 1], &[1, 2], &[2]], &[&[0, 1, 2]]),
        (&[&[2, 2]], &[&[2, 2]]),
        (&[&[0, 1, 1], &[1, 2]], &[&[0, 1, 1, 2]]),
        // A cell that stands twice, or three times, in either direction.
        (&[&[0, 1], &[0, 1], &[1, 2], &[2, 3]], &[&[0, 1, 2, 3]]),
        (&[&[2, 3], &[0, 1], &[3, 2], &[1, 2], &[2, 3]], &[&[0, 1, 2, 3]]),
        // Two longer ones that share their ends are two.
        (&[&[0, 1, 4], &[0, 2, 4]], &[&[0, 1, 4], &[0, 2, 4]]),
    ];
    for (cut, expected) in cases {
        for (number, line) in expected.iter().enumerate() {
            let found = lines("a.vtk", cells(cut), Some(number));
            assert_eq!(found.map(|found| found.points), Ok(places(line)), "{cut:?}");
        }
        let alone = lines("a.vtk", cells(cut), None);
        if expected.len() == 1 {
            assert!(alone.is_ok(), "{cut:?}");
        } else {
            refused("several", alone, &format!("holds {} lines; choose one", expected.len()));
        }
    }
    // The points of each cell are its own, as where files were joined.
    let own = "POINTS 6 double\n0 0 0 0 0 10 1 0 20 3 0 29 0 0 10 1 0 20\nLINES 3 9\n2 2 3\n2 0 1\n2 4 5\n";
    let apart = text("").split("POINTS").next().unwrap().to_owned() + own;
    assert_eq!(lines("a.vtk", apart, None).unwrap().points, places(&[0, 1, 2, 3]));
}

/// A file of cells with points of their own: the coordinates of both ends, in order.
fn own_cells(ends: &[[Vertex; 2]], kind: &str) -> String {
    let count = ends.len();
    let points: Vec<_> = ends.iter().flatten().flatten().map(|x| format!("{x:e}")).collect();
    let cells: String =
        (0..count).map(|cell| format!("2 {} {}\n", 2 * cell, 2 * cell + 1)).collect();
    format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS {} {kind}\n{}\nLINES {count} {}\n{cells}",
        2 * count,
        points.join(" "),
        3 * count
    )
}

#[test]
fn ends_that_differ_by_rounding_meet() {
    let mut draws = crate::mutations::Draws(3);
    let mut draw = || draws.below(1 << 20) as f64 / f64::from(1 << 19) - 1.0;
    for round in 0..200 {
        // A walk of steps of about 1, whose coordinates are at most 100. Each cell has points of
        // its own, rounded in another way, in any order and direction.
        let mut places = vec![[70.0 * draw(), 70.0 * draw(), 70.0 * draw()]];
        for _ in 0..20 {
            let last = places[places.len() - 1];
            places.push(last.map(|x| x + 0.5 + 0.4 * draw()));
        }
        let largest = places.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let error = [1e-14, 1e-12 / 30.0, f64::from(f32::EPSILON), 4e-6][round % 4] * largest;
        let scale = 2_f64.powi([-300, 0, 300][round / 4 % 3]);
        let mut rounded = |place: Vertex| place.map(|x| scale * (x + error * draw()));
        let mut ends: Vec<[Vertex; 2]> =
            places.windows(2).map(|pair| [rounded(pair[0]), rounded(pair[1])]).collect();
        ends.iter_mut().for_each(|pair| pair.rotate_left(usize::from(draw() > 0.0)));
        ends.sort_by_cached_key(|_| (1e6 * draw()) as i64);
        let found = lines("a.vtk", own_cells(&ends, "double"), None)
            .unwrap_or_else(|message| panic!("{round}: {message}"))
            .points;
        assert_eq!(found.len(), places.len(), "{round}");
        let is_near = |places: &mut dyn Iterator<Item = &Vertex>| {
            found.iter().zip(places).all(|(found, place)| {
                (0..3).all(|axis| (found[axis] / scale - place[axis]).abs() <= 1.1 * error)
            })
        };
        assert!(is_near(&mut places.iter()) || is_near(&mut places.iter().rev()), "{round}");
    }
    // Single precision: the same places, and the next numbers.
    let single = |more: u32| {
        let rounded = |x: f64| f32::from_bits((x as f32 / 3.0 + 70.0).to_bits() + more);
        POINTS.map(|place| place.map(|x| f64::from(rounded(x))))
    };
    let (a, b) = (single(0), single(1));
    let ends = [[a[0], a[1]], [b[2], b[1]], [a[2], a[3]], [b[3], a[4]]];
    assert_eq!(lines("a.vtk", own_cells(&ends, "float"), None).unwrap().points.len(), 5);
    // Six digits, as VTK prints them: 100 and 99.9999, 70.3333 and 70.3334.
    let printed = |more: f64| a.map(|p| p.map(|x| format!("{:.4}", x + more).parse().unwrap()));
    let (c, d): ([Vertex; 5], [Vertex; 5]) = (printed(-0.0001), printed(0.0));
    let ends = [[c[0], c[1]], [d[2], d[1]], [c[2], c[3]], [d[3], c[4]]];
    assert_eq!(lines("a.vtk", own_cells(&ends, "float"), None).unwrap().points.len(), 5);
    // Within rounding, one cell has no length and another one stands twice.
    let ends = [[a[0], a[1]], [a[1], b[1]], [b[1], b[0]], [a[1], a[2]]];
    assert_eq!(lines("a.vtk", own_cells(&ends, "float"), None).unwrap().points, a[..3]);
}

#[test]
fn ends_that_differ_by_more_than_rounding_stay_apart() {
    // Coordinates of a map, in double precision: single precision does not tell its points apart.
    let far = |i: f64| [5e6 + 0.1 * i, -4e6, 0.02 * i];
    let ends: Vec<_> = (0..50).map(|i| [far(f64::from(i)), far(f64::from(i + 1))]).collect();
    assert_eq!(lines("a.vtk", own_cells(&ends, "double"), None).unwrap().points.len(), 51);
    for (gap, expected) in [(1e-9, true), (0.01, false)] {
        let mut ends = ends.clone();
        ends[25..].iter_mut().flatten().for_each(|p| p[1] += gap);
        assert_eq!(lines("a.vtk", own_cells(&ends, "double"), None).is_ok(), expected, "{gap}");
    }
    // A gap of a thousandth beside a length of ten.
    let ends = [[POINTS[0], POINTS[1]], [POINTS[1].map(|x| x + 1e-3), POINTS[2]]];
    refused("gap", lines("a.vtk", own_cells(&ends, "double"), None), "holds 2 lines");
    // A point that is not finite meets nothing, and is refused where it is chosen.
    let ends = [[POINTS[0], [f64::NAN; 3]], [[f64::NAN; 3], POINTS[2]]];
    refused("nan", lines("a.vtk", own_cells(&ends, "double"), Some(0)), "is not finite");
}

#[test]
fn files_of_carriage_returns_alone_are_read() {
    let whole = cells(&[&[0, 1, 2], &[2, 3]]);
    let field = "FIELD FieldData 1\nSPACE 1 1 string\nLPS\nMETADATA\nINFORMATION 0\n\nPOINTS";
    let whole = whole.replace("POINTS", field);
    let expected = lines("a.vtk", &whole, None);
    assert_eq!(expected.as_ref().unwrap().frame, Some(Frame::Lps));
    assert_eq!(lines("a.vtk", whole.replace('\n', "\r"), None), expected);
    assert_eq!(lines("a.vtk", whole.replace('\n', "\r\n"), None), expected);
    // Binary numbers, which contain line feeds.
    let head = "# vtk DataFile Version 5.1\rx\rBINARY\rDATASET POLYDATA\rPOINTS 2 float\r";
    let mut bytes = head.as_bytes().to_vec();
    [0.0_f32, 0.0, 10.0, f32::from_bits(0x4120_0a0a), 0.0, 0.0]
        .iter()
        .for_each(|x| bytes.extend(x.to_be_bytes()));
    bytes.extend(b"\rLINES 2 2\rOFFSETS vtkIdType\r");
    [0_i64, 2].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    bytes.extend(b"\rCONNECTIVITY vtkIdType\r");
    [0_i64, 1].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    bytes.extend(b"\r");
    let read = lines("a.vtk", &bytes, None).unwrap().points;
    assert_eq!(read[1][0], f64::from(f32::from_bits(0x4120_0a0a)));
}

#[test]
fn a_line_of_one_point_is_refused() {
    let curve = r#"{"markups": [{"type": "Curve", "controlPoints": [{"position": [1, 2, 3]}]}]}"#;
    for (name, text) in [
        ("a.csv", "0,0,0\n".to_owned()),
        ("a.csv", "x,y,z\n0,0,0\n".to_owned()),
        ("a.mrk.json", curve.to_owned()),
        ("a.vtk", text("LINES 1 2\n1 3\n")),
    ] {
        refused(name, lines(name, text, None), "holds a line of 1 point; give the points");
    }
}

#[test]
fn thousands_of_cells_are_one_line_soon() {
    let count = 20_000;
    let points: String = (0..count).map(|i| format!("{i} 0 0\n")).collect();
    let cells: String = (1..count).rev().map(|i| format!("2 {} {i}\n", i - 1)).collect();
    let all = format!(
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS {count} float\n{points}LINES {} {}\n{cells}",
        count - 1,
        3 * (count - 1)
    );
    let line = lines("a.vtk", all, None).unwrap();
    assert!(line.points.iter().enumerate().all(|(i, point)| point[0] == i as f64));
    assert_eq!(line.points.len(), count);
}

#[test]
fn what_stands_before_the_points_is_passed_over_and_its_frame_is_kept() {
    let line = "LINES 1 4\n3 0 1 2\n";
    let whole = text(line);
    for before in [
        "METADATA\nINFORMATION 0\n\n",
        "FIELD FieldData 2\ntime 1 1 double\n0.5\nMETADATA\nINFORMATION 1\nNAME a LOCATION b\nDATA 1\n\n\nids 2 2 long\n1 2 3 4\n",
        "FIELD FieldData 1\nnames 1 2 string\ntwo%20words\nPOINTS\n",
    ] {
        let found =
            lines("a.vtk", whole.replace("POINTS", &format!("{before}POINTS")), None).unwrap();
        assert_eq!((found.points, found.frame), (places(&[0, 1, 2]), None), "{before}");
    }
    let noted = whole.replace("POINTS", "FIELD FieldData 1\nSPACE 1 1 string\nLPS\nPOINTS");
    assert_eq!(lines("a.vtk", noted, None).unwrap().frame, Some(Frame::Lps));
    // In bytes: a text has its length before it, numbers of the same type have four bytes or eight.
    for (kind, size) in
        [("vtkIdType", 4), ("vtkIdType", 8), ("long", 4), ("long", 8), ("vtktypeint64", 8)]
    {
        let number = |x: u64| x.to_be_bytes()[8 - size..].to_vec();
        let mut bytes =
            b"# vtk DataFile Version 5.1\nx\nBINARY\nDATASET POLYDATA\nFIELD FieldData 3\n"
                .to_vec();
        bytes.extend(format!("ids 1 3 {kind}\n").bytes());
        (1..4).for_each(|id| bytes.extend(number(id)));
        bytes.extend(b"\nSPACE 1 1 string\n\xc3RAS\nbits 1 9 bit\n\xff\x80\nPOINTS 3 double\n");
        POINTS[..3].iter().flatten().for_each(|x| bytes.extend(x.to_be_bytes()));
        bytes.extend(format!("\nLINES 2 3\nOFFSETS {kind}\n").bytes());
        [0, 3].into_iter().for_each(|end| bytes.extend(number(end)));
        bytes.extend(format!("\nCONNECTIVITY {kind}\n").bytes());
        [0, 1, 2].into_iter().for_each(|point| bytes.extend(number(point)));
        bytes.extend(b"\nPOINT_DATA 3\n");
        let found = lines("a.vtk", &bytes, None);
        assert_eq!(
            found.map(|f| (f.points, f.frame)),
            Ok((places(&[0, 1, 2]), Some(Frame::Ras))),
            "{kind} {size}"
        );
    }
    // What LPS may be called in a file of VTK's XML, as numbers of letters; any other array of this
    // name says nothing.
    let vtp =
        std::fs::read_to_string(crate::reports::report("A18_space_lps_in_field_data.vtp")).unwrap();
    for (letters, frame) in
        [("82 65 83 0", Some(Frame::Ras)), ("76 80 83", Some(Frame::Lps)), ("1 2 3", None)]
    {
        let found = lines("a.vtp", vtp.replace("76 80 83 0", letters), None).unwrap();
        assert_eq!(found.frame, frame, "{letters}");
    }
    // "RAS\0" and "LPS\0" in base64 behind the length of four bytes.
    for (letters, frame) in [("BAAAAFJBUwA=", Frame::Ras), ("BAAAAExQUwA=", Frame::Lps)] {
        let start = vtp.find("SPACE").unwrap();
        let (head, tail) = vtp.split_at(start);
        let binary =
            head.to_owned() + &tail.replacen("ascii", "binary", 1).replace("76 80 83 0", letters);
        assert_eq!(lines("a.vtp", binary, None).unwrap().frame, Some(frame));
    }
}

#[test]
fn surfaces_of_vtk_are_meshes() {
    let head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
    let polygons = "POLYGONS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    let new = "POLYGONS 5 12\nOFFSETS vtktypeint64\n0 3 6 9 12\nCONNECTIVITY vtktypeint64\n0 2 1 0 1 3 1 2 3 2 0 3\n";
    let cells = polygons.replace("POLYGONS", "CELLS") + "CELL_TYPES 4\n5\n5\n5\n5\n";
    let grid = head.replace("POLYDATA", "UNSTRUCTURED_GRID");
    for text in [head.to_owned() + polygons, head.to_owned() + new, grid.clone() + &cells] {
        let mesh = read("a.vtk", &text).unwrap();
        assert!((volume(&mesh) - 1.0 / 6.0).abs() < 1e-15, "{text}");
        // As a centreline it is none, and a centreline is no mesh.
        refused("surface", lines("a.vtk", &text, None), "holds no line; export the curve");
    }
    let strip = "TRIANGLE_STRIPS 1 5\n4 1 2 0 3\n";
    assert_eq!(read("a.vtk", head.to_owned() + strip).unwrap().triangles, [[1, 2, 0], [0, 2, 3]]);
    refused(
        "line",
        read("a.vtk", head.to_owned() + "LINES 1 4\n3 0 1 2\n"),
        "holds no triangles; export the surface",
    );
    refused(
        "cells",
        read("a.vtk", grid.clone() + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"),
        "extract the surface",
    );
    let pixel = grid + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n8\n";
    assert_eq!(read("a.vtk", pixel).unwrap().triangles, [[0, 1, 3], [0, 3, 2]]);
    let vtp = |polys: &str, offsets: &str| {
        let text =
            std::fs::read_to_string(crate::reports::report("A17_two_point_cells.vtp")).unwrap();
        let text = text.replace("0 0 0 0 0 10 1 0 20 3 0 29", "0 0 0 1 0 0 0 1 0 0 0 1");
        let count = offsets.split(' ').count();
        let text = text.replace("Lines=\"3\"", "Lines=\"0\"");
        let text = text.replace("Polys=\"0\"", &format!("Polys=\"{count}\""));
        text.replace("0 1 1 2 2 3", polys).replace("2 4 6", offsets).replace("Lines>", "Polys>")
    };
    let mesh = read("a.vtp", vtp("0 2 1 0 1 3 1 2 3 2 0 3", "3 6 9 12")).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.vertices.len()), (4, 4));
    let square = read("a.vtp", vtp("0 1 2 3", "4")).unwrap();
    assert!(square.triangles.len() == 2 && area(&square) > 0.0);
    refused("beyond", read("a.vtp", vtp("0 1 4", "3")), "names vertex 4, but there are 4");
    for (packer, name) in [("vtkLZ4DataCompressor", "LZ4"), ("vtkLZMADataCompressor", "LZMA")] {
        let text =
            vtp("0 1 2", "3").replace("version", &format!("compressor=\"{packer}\" version"));
        refused(
            name,
            read("a.vtp", text),
            &format!("packed by {name}; save it with the compressor ZLib, or none"),
        );
    }
}

const CURVE: &str = r#"{"markups": [{"type": "Curve", UNITS "controlPoints": [
    {"position": [1500, -2000, 3000], "positionStatus": "defined"},
    {"position": "", "positionStatus": "preview"}, {"position": null}, {"position": ""},
    {"position": [0, 0, 0], "positionStatus": "undefined"}, {"position": [4000, 5000, 6250]}]}]}"#;

#[test]
fn units_of_markups_are_brought_to_millimetres_and_unset_points_are_counted() {
    for (units, scale) in [
        ("", 1.0),
        (r#""coordinateUnits": null,"#, 1.0),
        (r#""coordinateUnits": "mm","#, 1.0),
        (r#""coordinateUnits": ["mm", "UCUM", "millimeter"],"#, 1.0),
        (r#""coordinateUnits": ["um", "UCUM", "micrometer"],"#, 1e3),
        (r#""coordinateUnits": "um","#, 1e3),
        (r#""coordinateUnits": "cm","#, 0.1),
        (r#""coordinateUnits": "m","#, 1e-3),
    ] {
        let curve = lines("a.mrk.json", CURVE.replace("UNITS", units), None).unwrap();
        let expected = [[1500.0, -2000.0, 3000.0], [4000.0, 5000.0, 6250.0]];
        assert_eq!(curve.points, expected.map(|point: Vertex| point.map(|x| x / scale)), "{units}");
        assert!(
            curve.skipped_points == 4 && curve.states_unit && curve.frame == Some(Frame::Lps),
            "{units}"
        );
    }
    for (units, expected) in [
        (r#""coordinateUnits": "inch","#, "'inch', not mm; save it in mm"),
        (r#""coordinateUnits": 7,"#, "not mm"),
        (r#""coordinateUnits": [],"#, "not mm"),
        (r#""coordinateSystem": "scanner","#, "neither LPS nor RAS"),
    ] {
        refused(units, lines("a.mrk.json", CURVE.replace("UNITS", units), None), expected);
    }
    let none = CURVE.replace("UNITS", "").replace("[1500, -2000, 3000]", "\"here\"");
    refused(
        "text",
        lines("a.mrk.json", none, None),
        "control point 0 has the 'position' \"here\", not three numbers; draw a curve",
    );
}

#[test]
fn what_is_wrong_with_markups_is_named_by_its_field() {
    let curve = |points: &str| format!(r#"{{"markups": [{{"controlPoints": {points}}}]}}"#);
    let set = r#"{"position": [1, 2, 3]}"#;
    assert!(lines("a.mrk.json", curve(&format!("[{set}, {set}]")), None).is_ok());
    for (text, expected) in [
        ("{}".to_owned(), "it has no list 'markups'"),
        ("[]".to_owned(), "it has no list 'markups'"),
        (r#"{"markups": {}}"#.to_owned(), "it has no list 'markups'"),
        (r#"{"markups": [7]}"#.to_owned(), "the entry 0 of its 'markups' is no object"),
        (r#"{"markups": [{"type": 7}]}"#.to_owned(), "has the 'type' 7, which is no text"),
        (r#"{"markups": [{"type": "Line"}]}"#.to_owned(), "its Line has no list 'controlPoints'"),
        (curve("null"), "its Curve has no list 'controlPoints'"),
        (curve("7"), "its Curve has no list 'controlPoints'"),
        (curve("[]"), "the 'controlPoints' of its Curve are empty"),
        (curve(r#"[{}, {"position": ""}]"#), "none of the 2 'controlPoints' of its Curve has"),
        (curve("[7]"), "control point 0 is no object"),
        (curve(&format!("[{set}, []]")), "control point 1 is no object"),
        (curve(r#"[{"position": [1, 2]}]"#), "point 0 has the 'position' [1,2], not three numbers"),
        (curve(r#"[{"position": [1, "2", 3]}]"#), "has the 'position' [1,\"2\",3], not three"),
        (curve(r#"[{"position": {"x": 1}}]"#), "has the 'position' of named values, not three"),
        (curve(r#"[{"positionStatus": 1}]"#), "has the 'positionStatus' 1, which is no text"),
    ] {
        refused(&text, lines("a.mrk.json", &text, None), expected);
        refused(&text, lines("a.mrk.json", &text, None), "draw a curve in 3D Slicer and save it");
    }
    // An empty curve beside another one is left out.
    let two = curve(&format!("[{set}, {set}]")).replace("[{\"c", "[{\"controlPoints\": []}, {\"c");
    assert_eq!(lines("a.mrk.json", two, None).unwrap().points.len(), 2);
}

#[test]
fn values_of_markups_take_no_more_memory_than_is_allowed() {
    for element in ["[0],", "0,", "{},", "\"\","] {
        let text = format!("{{\"markups\": [], \"other\": [{}0]}}", element.repeat(70_000));
        let ask = |limit: u64| {
            let options = Options::default().with_memory_limit(limit);
            let mut answer = Ok(());
            let taken = allocation_counter::measure(|| {
                let read = centreline_from_bytes("a.mrk.json", text.as_bytes(), &options);
                answer = read.map(drop).map_err(|error| error.to_string());
            });
            (answer, taken.bytes_max)
        };
        let limit = 64 * text.len() as u64;
        let (answer, taken) = ask(limit);
        refused(element, answer, "holds no line");
        assert!(taken <= limit, "{element}: {taken} of {limit}");
        let (answer, taken) = ask(limit - 1);
        refused(element, answer, "its values take more memory than is allowed");
        assert!(taken < 1 << 16, "{element}: {taken}");
    }
}

#[test]
fn points_that_are_no_curve_are_read_where_the_user_says_so() {
    for kind in ["Fiducial", "ClosedCurve", "Angle", "ROI", "Plane"] {
        let list = CURVE.replace("UNITS", "").replace("\"Curve\"", &format!("\"{kind}\""));
        refused(
            kind,
            lines("a.mrk.json", &list, None),
            &format!("of type {kind}, which is no curve; if the order"),
        );
        assert_eq!(lines("a.mrk.json", &list, Some(0)).unwrap().points.len(), 2);
    }
    let line = CURVE.replace("UNITS", "").replace("\"Curve\"", "\"Line\"");
    assert_eq!(lines("a.mrk.json", line, None).unwrap().points.len(), 2);
}

#[test]
fn texts_have_radii_where_they_say_so() {
    let radii = |text: &str| lines("a.csv", text, None).map(|line| (line.points.len(), line.radii));
    let two = Some(vec![2.0]);
    assert_eq!(radii("0,0,0,2\n0,0,1\n"), Ok((2, two.clone())));
    // Commas with tabs behind them, and decimal commas between tabs.
    assert_eq!(radii("0 , 0 ,\t0,\u{a0}2\n0,0,1\n"), Ok((2, two.clone())));
    assert_eq!(radii("0,5\t0,0\t0\t2,0\n0,0\t0\t1\n"), Ok((2, two.clone())));
    // A quoted tab is no separator, so the commas are decimal commas.
    assert_eq!(radii("\"0,5\t\"\t0,0\t0\t2,0\n0,0\t0\t1\n"), Ok((2, two.clone())));
    assert_eq!(radii("x,y,z,radius\n0,0,0,2\n0,0,1,2\n"), Ok((2, two.clone())));
    assert_eq!(radii("x,y,z,distance_to_wall_mm\n0,0,0,2\n0,0,1,2\n"), Ok((2, None)));
    assert_eq!(
        radii("x,y,z,distance_to_wall_mm,Radius (mm)\n0,0,0,9,2\n0,0,1,9,2\n"),
        Ok((2, two.clone()))
    );
    // Names of a frame's axes, in any columns. The r of R,A,S is no radius.
    for (text, frame, radii) in [
        ("r,a,s\n1,2,3\n4,5,6\n", Frame::Ras, None),
        ("R (mm),A (mm),S (mm)\n1,2,3\n4,5,6\n", Frame::Ras, None),
        ("label,l,p,s\n7,1,2,3\n7,4,5,6\n", Frame::Lps, None),
        ("L,P,S,radius\n1,2,3,2\n4,5,6,2\n", Frame::Lps, Some(vec![2.0])),
    ] {
        let read = lines("a.csv", text, None).unwrap();
        assert_eq!(read.points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{text}");
        assert_eq!((read.frame, read.radii), (Some(frame), radii), "{text}");
    }
    for text in [
        "px,py,pz\n1,2,3\n4,5,6\n",
        "x_mm;y_mm;z_mm\n1;2;3\n4;5;6\n",
        // Columns in front: an index as pandas writes it, without a name or saved again.
        ",x,y,z\n0,1,2,3\n1,4,5,6\n",
        "Unnamed: 0,x,y,z\n0,1,2,3\n1,4,5,6\n",
        "index\tx\ty\tz\n0\t1\t2\t3\n1\t4\t5\t6\n",
        "Points_0,Points_1,Points_2\n1,2,3\n4,5,6\n",
        "\"vtkOriginal\",\"Points:0\",\"Points:1\",\"Points:2\"\n7,1,2,3\n7,4,5,6\n",
    ] {
        let read = lines("a.csv", text, None).unwrap();
        assert_eq!((read.points[1], read.frame), ([4.0, 5.0, 6.0], None), "{text}");
        assert_eq!(read.radii, None, "{text}");
        // With the byte order marks of UTF-16.
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            let marked = "\u{feff}".to_owned() + text;
            let bytes: Vec<u8> = marked.encode_utf16().flat_map(order).collect();
            assert_eq!(lines("a.csv", bytes, None).as_ref(), Ok(&read), "{text}");
        }
    }
    // The radius of the vessel is not that of a robot, in any format.
    assert_eq!(radii("x,y,z,MaximumInscribedSphereRadius\n0,0,0,2\n0,0,1,2\n"), Ok((2, None)));
    for (text, radius) in [
        ("radius,x,y,z\n2,0,0,0\n2,0,0,1\n", 2.0),
        (",Points_0,Points_1,Points_2,Radii\n0,0,0,0,2\n1,0,0,1,2\n", 2.0),
        ("x,y,z,Diameter (mm)\n0,0,0,2\n0,0,1,2\n", 1.0),
        ("r,a,s,diameter\n0,0,0,3\n0,0,1,3\n", 1.5),
    ] {
        assert_eq!(radii(text), Ok((2, Some(vec![radius]))), "{text}");
    }
    // They differ.
    let both = radii("x,y,z,diameter,radius\n0,0,0,3,1\n0,0,1,3,1\n");
    refused("both", both, "has 'radius' and 'diameter', and both may be the radius");
    refused("diameter", radii("x,y,z,diameter\n0,0,0,1\n0,0,1,-1\n"), "the radius of the last");
    let shapes = |text: &str| {
        let path = crate::file("shapes.csv", text.as_bytes());
        mesh_files::load_shapes(path, &Options::default()).map_err(|error| error.to_string())
    };
    for text in [
        "shape,x,y,z,diameter\n3,0,0,0,4\n3,0,0,1,4\n5,0,0,0,4\n5,0,0,2,4\n",
        ",shape,x,y,z,r\n0,3,0,0,0,2\n1,3,0,0,1,2\n2,5,0,0,0,2\n3,5,0,0,2,2\n",
    ] {
        let found = shapes(text).unwrap();
        let [(3.0, first), (5.0, second)] = &found[..] else { panic!("{found:?}") };
        assert_eq!((first.points[1], second.points[1]), ([0.0, 0.0, 1.0], [0.0, 0.0, 2.0]));
        assert_eq!((&first.radii, &second.radii), (&two, &two), "{text}");
    }
    refused("shapes", shapes("x,y,z,r\n0,0,0,4\n"), "has 'y' in column 2, not x");
    refused("shapes", shapes("id,x,y,z,shape\n7,0,0,0\n"), "has 4 columns; write shape,x,y,z");
    assert_eq!(radii("x,y,z,shape\n0,0,0\n0,0,1\n"), Ok((2, None)));
    let report = lines(
        "a.csv",
        std::fs::read(crate::reports::report("A20_bom_heading_units.csv")).unwrap(),
        None,
    );
    assert_eq!(report.unwrap().points, [[0.0, 0.0, 0.0], [0.0, 0.0, 10.0]]);
    let scaled =
        centreline_from_bytes("a.csv", b"1;2;3;4\n1;2;4,5;4\n", &Options::scaled(10.0)).unwrap();
    assert_eq!((scaled.points[1], scaled.radii), ([10.0, 20.0, 45.0], Some(vec![40.0])));
    for (text, expected) in [
        ("", "has no points; write x,y,z or x,y,z,radius"),
        ("0,0,0,2\n0,0,1\n0,0,2\n", "line 2 of a.csv has no radius, but other lines have"),
        ("0,0,0,2\n0,0,1,-1\n", "line 2 of a.csv says that the radius of the last point is -1"),
        ("x,y,z\n0,0,0,2\n", "line 2 of a.csv has 4 columns, but the heading names 3"),
        ("z,y,x\n0,0,0\n", "line 1 of a.csv has 'z' in column 1"),
        ("x,z,y\n0,0,0\n", "line 1 of a.csv has 'z' in column 2"),
        ("x,name,y,z\n0,0,0,0\n", "line 1 of a.csv has 'y' in column 3"),
        (",,z\n0,0,0\n", "line 1 of a.csv has nothing in column 1"),
        ("time,a,b\n0,0,0\n", "line 1 of a.csv has 'time' in column 1, not x; write x,y,z"),
        ("\nlat,lon,alt\n0,0,0\n", "line 2 of a.csv has 'lat' in column 1, not x"),
        ("x,y,r\n0,0,0\n", "line 1 of a.csv has 'r' in column 3, not z"),
        ("0,0\n", "line 1 of a.csv has 2 columns"),
        ("0,0,\"\"\n", "has nothing in column 3"),
        ("0,0,0\n0,0,nan\n", "is not finite"),
    ] {
        refused(text, radii(text), expected);
    }
}
