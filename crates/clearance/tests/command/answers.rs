//! A user's own mesh, centreline and matrix: distances known by hand, and errors that say what to
//! change.

use crate::{minimum, refuse, run, succeed};
use continuum_programs::{file, room};

/// A quarter turn that brings x to y and y to -x, and a shift.
const TURNED: &str = "0 -1 0 60\n1 0 0 0\n0 0 1 0\n0 0 0 1\n";

#[test]
fn a_straight_robot_in_a_box_has_the_clearance_that_one_can_see() {
    // A box of 60 in each direction, and a needle along z: 20 from both ends, 28 and then 29 from
    // the sides.
    let room = &room("box.obj");
    let shape = &file("shape.csv", "x,y,z,radius\n30,30,20,2\n30,30,30,1\n30,30,40\n");
    let out = succeed(&["--mesh", room, "--centreline", shape]);
    let head = "mesh: 12 triangles from [0.000, 0.000, 0.000] to [60.000, 60.000, 60.000], frame not stated, unit not stated\n\
                base: inside the mesh\n";
    assert!(out.starts_with(head) && out.lines().count() == 5, "{out}");
    assert_eq!(minimum(&["--mesh", room, "--centreline", shape]), 20.0);
    assert_eq!(succeed(&["--mesh", room, "--centerline", shape]), out);
    // Semicolons, no heading, one radius for all; moved to 7 from a side.
    let plain = &file("plain.csv", "\u{feff}30; 30; 20\r\n30; 30; 40\r\n\r\n");
    let moved = &file("moved.txt", "1 0 0 -21\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    let moved = ["--mesh", room, "--centreline", plain, "--pose", moved, "--radius", "2"];
    assert_eq!(minimum(&moved), 7.0);
    // Turned: (5, 30) goes to (30, 5).
    let side = &file("side.csv", "5,30,20,1\n5,30,40,1\n");
    let turned = &file("turned.txt", TURNED);
    let out =
        succeed(&["--mesh", room, "--centreline", side, "--pose", turned, "--tolerance", "0.01"]);
    assert!(
        out.contains(", from [30.000000, 4.000000, ") && out.contains(" to [30.000000, 0.000000, "),
        "{out}"
    );
    let curve = out
        .lines()
        .find_map(|line| line.strip_prefix("curve: "))
        .unwrap_or_else(|| panic!("{out}"));
    let bounds: Vec<f64> = curve.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert!(bounds[0] <= 4.0 && 4.0 <= bounds[1] && bounds[1] - bounds[0] <= 0.0100001, "{out}");
    // The files that come with the example.
    let data = |name: &str| format!("{}/../../examples/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let [wall, shape, pose] = ["wall.stl", "shape.csv", "pose.txt"].map(data);
    let readme = ["--mesh", &wall, "--centreline", &shape, "--pose", &pose];
    let clearance = minimum(&readme);
    assert!(clearance > 0.5, "{clearance}");
    // As the README goes on.
    assert_eq!(minimum(&[&readme[..], &["--tolerance", "0.1"]].concat()), clearance);
    // A matrix as numpy prints it.
    let printed = &file(
        "printed.txt",
        "[[ 1.  0.  0. -21.]\n [ 0.  1.  0.  0.]\n [ 0.  0.  1.  0.]\n [ 0.  0.  0.  1.]]\n",
    );
    let printed = ["--mesh", room, "--centreline", plain, "--pose", printed, "--radius", "2"];
    assert_eq!(minimum(&printed), 7.0);
    let array =
        "[[1., 0., 0., -21.],\n [0., 1., 0., 0.],\n [0., 0., 1., 0.],\n [0., 0., 0., 1.]]\n";
    let array = [
        "--mesh",
        room,
        "--centreline",
        plain,
        "--pose",
        &file("array.txt", array),
        "--radius",
        "2",
    ];
    assert_eq!(minimum(&array), 7.0);
}

#[test]
fn points_are_read_as_people_write_them() {
    let room = &room("people.obj");
    for text in [
        "30,30,20,2\n30,30,40\n",
        "30,30,20,2\n30,30,40,0\n",
        "# saved by hand\n\nx,y,z,radius\n30,30,20,2\n# the tip\n30,30,40\n",
        "\u{feff}x;y;z;radius\r\n30; 30; 20; 2\r\n30; 30; 40\r\n",
        "# x y z r\n3.0e1 3.0e1 2.0e1 2.0e0\n3.0e1 3.0e1 4.0e1 2.0e0\n",
        "X\tY\tZ\tR [mm]\n30\t30\t20\t2\n30\t30\t40\n",
        "  30   30 20  2 \n\n   30  30 40",
        "30 , 30 ,\t20,\u{a0}2\n30,30,40\n",
        // Decimal commas, quotes, lines that end by carriage returns alone, and columns as
        // ParaView names them.
        "30,0;30,0;20,0;1,0\n30,0;30,0;40,0\n",
        "30,0\t30,0\t20,0\t1,0\n30,0\t30,0\t40,0\n",
        "\"x\",\"y\",\"z\",\"radius\"\n\"30\",\"30\",\"20\",\"2\"\n\"30,0\",\"30\",\"40\"\n",
        "x,y,z,r\r30,30,20,2\r30,30,40\r",
        "\"Radius\",\"Normals:0\",\"Points:0\",\"Points:1\",\"Points:2\"\n2,7,30,30,20\n2,7,30,30,40\n",
        "x [mm],y [mm],z [mm],radius [mm],distance_to_wall_mm\r\n30,30,20,2,9\r\n30,30,40,2,9\r\n",
        "radius,X,Y,Z\n2,30,30,20\n2,30,30,40\n",
        // A table of pandas with its index.
        ",x,y,z,diameter\n0,30,30,20,4\n1,30,30,40,4\n",
    ] {
        assert_eq!(
            minimum(&["--mesh", room, "--centreline", &file("people.csv", text)]),
            20.0,
            "{text}"
        );
    }
}

#[test]
fn faces_without_area_are_said_and_change_no_distance() {
    let good = std::fs::read_to_string(room("good_faces.obj")).unwrap();
    let wall = &file("bad_faces.obj", &(good + "f 1 2\nf 3 3 3\nf 4 5 5 4\n"));
    let shape = &file("faces.csv", "30,30,20,2\n30,30,40\n");
    let (status, out, error) = run(&["--mesh", wall, "--centreline", shape]);
    assert!(status == Some(0) && out.contains("\nminimum 20.00: "), "{out} {error}");
    assert!(
        error.ends_with("bad_faces.obj: 3 faces without area\n") && error.lines().count() == 1,
        "{error}"
    );
}

#[test]
fn what_is_wrong_with_my_files_is_said_in_one_line() {
    let room = &room("wrong.obj");
    let shape = &file("good.csv", "30,30,20,2\n30,30,40\n");
    let refuse_shape = |text: &str, expected: &str| {
        refuse(&["--mesh", room, "--centreline", &file("bad.csv", text)], expected);
    };
    for text in ["x,y,z\n30,30,20\n30,30,40\n", "30,30,20\n30,30,40\n"] {
        refuse_shape(text, "no radius; write it behind x,y,z, or give --radius");
    }
    refuse_shape("30,30,20,1\n30,zero,40\n", "line 2 of ");
    refuse_shape("30,30,20,1\n30,zero,40\n", "write x,y,z or x,y,z,radius");
    refuse_shape("x1,zero,0\n0,0,1,1\n0,0,2", "line 1 of ");
    // A column is a radius where its heading says so.
    refuse_shape(
        "x,y,z,distance_to_wall_mm\n30,30,20,2\n30,30,40,2\n",
        "no radius; write it behind x,y,z, or give",
    );
    refuse_shape(
        "x,y,z\n30,30,20,2\n30,30,40\n",
        "has 4 columns, but the heading names 3; write x,y,z",
    );
    refuse_shape("30,30,20,2\n30,30,30\n30,30,40\n", "line 2 of ");
    let radius = ["--mesh", room, "--centreline", shape, "--radius", "1"];
    refuse(&radius, "has a column of radii; leave out --radius");
    let diameters = &file("diameters.csv", "x,y,z,diameter\n30,30,20,2\n30,30,40,2\n");
    let radius = ["--mesh", room, "--centreline", diameters, "--radius", "1"];
    refuse(&radius, "has a column of radii; leave out --radius");
    refuse_shape(
        "30,30,20,1\n",
        "bad.csv holds a line of 1 point; give the points from base to tip",
    );
    refuse_shape("30,30,20,-1\n30,30,40\n", "radius 0 is -1");
    refuse_shape("30,30,20,1\n30,30,40,-1\n", "the radius of the last point is -1");
    refuse_shape("30,30,20,1\n30,30,40,nan\n", "the radius of the last point is NaN");
    refuse_shape("30,30,20,inf\n30,30,40\n", "radius 0 is inf");
    refuse_shape("30,30,20,1\n30,nan,40\n", "vertex 1");
    // A number too many, or one that is not there: nothing moves up.
    refuse_shape("30,30,20,1,0\n30,30,40\n", "line 1 of ");
    refuse_shape("30,30,20,1\n30,30\n", "has 2 columns; write x,y,z or x,y,z,radius");
    for (text, line, column) in [
        ("1,,2,0.5\n30,30,40\n", 1, 2),
        ("30,30,20,1\n,30,30,40\n", 2, 1),
        ("x,y,z,r\n30,30,20,1\n30,30,,40\n", 3, 3),
        ("30,30,20,1\n30,30,40,\n", 2, 4),
        ("30;30;;20\n30;30;40\n", 1, 3),
        ("30\t\t30\t20\n30\t30\t40\n", 1, 2),
        ("\u{feff}30, ,30,20\r\n30,30,40\r\n", 1, 2),
        ("x,y,z,r\r\n\r\n30,30,20,1\r\n30,30,40, \r\n", 4, 4),
        (",,\n30,30,20,1\n30,30,40\n", 1, 1),
        ("x,,z\n30,30,20,1\n30,30,40\n", 1, 1),
    ] {
        let missing = file("missing.csv", text);
        for radius in [&["--radius", "0.5"][..], &[]] {
            let arguments = [&["--mesh", room, "--centreline", &missing][..], radius].concat();
            refuse(&arguments, &format!("line {line} of "));
            refuse(&arguments, &format!("in column {column}; write x,y,z or x,y,z,radius"));
        }
    }
    // Columns that their heading names otherwise.
    refuse_shape("z,y,x\n30,30,20,1\n30,30,40\n", "has 'z' in column 1");
    refuse_shape("radius,X,Z,Y\n1,30,30,20\n1,30,30,40\n", "has 'Z' in column 3");
    // Decimal commas between spaces; two numbers in a column.
    refuse_shape("1,5 2,5\n3,5 4,5\n", "has '5 2' in column 2");
    refuse_shape("30 30,20\n30,30,40\n", "has '30 30' in column 1");
    let refuse_pose = |text: &str, expected: &str| {
        let pose = file("bad.txt", text);
        refuse(&["--mesh", room, "--centreline", shape, "--pose", &pose], expected);
    };
    refuse_pose("1 0 0 0\n0 1 0 0\n0 0 1 0\n", "--pose needs 4 lines of 4 numbers");
    refuse_pose("1 0 0\n0 1 0\n0 0 1\n", "write 4 numbers");
    refuse_pose(
        &TURNED.replace(' ', ",").replace("1,0,0,0", "1,,0,0"),
        "has nothing in column 2; write 4 numbers",
    );
    refuse_pose(&TURNED.replace(' ', ",").replace("1,0,0,0", "1,0,0,0,"), "line 2 of ");
    refuse_pose(&TURNED.replace("0 0 0 1", "0 0 0"), "has 3 columns; write 4 numbers");
    refuse_pose(&(TURNED.to_owned() + "0 0 0 1\n"), "--pose needs 4 lines of 4 numbers");
    refuse_pose(&TURNED.replace("0 0 0 1", "0 0 0 2"), "not 0 0 0 1");
    refuse_pose(&TURNED.replace("-1", "1"), "mirrors");
    refuse_pose(&TURNED.replace("-1", "-0.5"), "right angles by 0.75");
    refuse_pose("0 -1e3 0 60\n1e3 0 0 0\n0 0 1e3 0\n0 0 0 1\n", "scales by 1000");
    refuse_pose(&TURNED.replace("60", "nan"), "row 1, column 4");
    refuse(&["--mesh", room, "--centreline", "nowhere.csv"], "cannot read nowhere.csv");
    refuse(&["--mesh", "nowhere.stl", "--centreline", shape], "check the path");
    for (option, wrong, expected) in [
        ("--radius", "wide", "write a number"),
        ("--radius", "-1", "write a number that is at least 0"),
        ("--radius", "nan", "write a number that is at least 0"),
        ("--radius", "inf", "write a number that is at least 0"),
        ("--tolerance", "1,5", "write a number"),
        ("--tolerance", "0", "write a number greater than 0"),
        ("--tolerance", "nan", "write a number greater than 0"),
        ("--label", "left", "write a whole number"),
    ] {
        let (status, _, error) = run(&["--mesh", room, "--centreline", shape, option, wrong]);
        assert!(status == Some(2) && error.contains(expected), "{error}");
        assert!(error.lines().count() == 1, "{error}");
    }
    refuse(&["--mesh", room], "--centreline <FILE>");
    refuse(&["--centreline", shape], "--mesh <FILE>");
    refuse(&["--mesh", room, "--centerlin", shape], "a similar argument exists: '--centerline'");
    refuse(&["--mesh", room, "--centreline", shape, "--frame", "xyz"], "lps, ras");
    let both = ["--mesh", room, "--centreline", shape, "--shapes", shape];
    refuse(&both, "cannot be used with '--shapes <FILE>'");
    #[cfg(unix)]
    refuse(&["--mesh", "/dev/zero", "--centreline", shape], "ends in .stl, .obj or .ply");
}

/// What is printed as a warning beside an answer.
fn warnings(arguments: &[&str]) -> Vec<String> {
    let (status, out, error) = run(arguments);
    assert!(status == Some(0) && out.contains("minimum "), "{out} {error}");
    error.lines().filter_map(|line| line.strip_prefix("warning: ")).map(str::to_owned).collect()
}

#[test]
fn a_robot_in_another_frame_or_unit_is_doubted_and_the_remedy_works() {
    // A box from 10 to 60: turned about z it is elsewhere.
    let walls = std::fs::read_to_string(room("frames_room.obj"))
        .unwrap()
        .replace("v 0", "v 10")
        .replace(" 0", " 10");
    let wall = &file("frames.obj", &walls);
    let shape = &file("frames.csv", "30,30,20,2\n30,30,40\n");
    let turned = &file("frames_lps.csv", "-30,-30,20,2\n-30,-30,40\n");
    let metres = &file("frames_m.csv", "0.030,0.030,0.020,0.002\n0.030,0.030,0.040\n");
    let both = &file("frames_both.csv", "-0.030,-0.030,0.020,0.002\n-0.030,-0.030,0.040\n");
    let of = |shape: &str, more: &[&str]| {
        minimum(&[&["--mesh", wall, "--centreline", shape][..], more].concat())
    };
    assert!(warnings(&["--mesh", wall, "--centreline", shape]).is_empty());
    assert_eq!(of(shape, &[]), 10.0);
    for (shape, options) in [
        (turned, &["--frame", "lps", "--mesh-frame", "ras"][..]),
        (metres, &["--scale", "1000"]),
        (both, &["--scale", "1000", "--frame", "lps", "--mesh-frame", "ras"]),
    ] {
        let said = warnings(&["--mesh", wall, "--centreline", shape]).join("\n");
        assert!(said.contains(&format!("with {} they fit", options.join(" "))), "{said}");
        assert!((of(shape, options) - 10.0).abs() < 1e-9);
        assert!(
            warnings(&[&["--mesh", wall, "--centreline", shape][..], options].concat()).is_empty()
        );
    }
    // A hundred times as large, but over the wall: both are said.
    let large = &file("frames_large.csv", "-3000,30,20,2\n9000,30,40\n");
    let said = warnings(&["--mesh", wall, "--centreline", large]).join("\n");
    assert!(said.contains("the robot's box measures 12000.0"), "{said}");
    // A file that says its frame, and a mesh that does not.
    let curve = r#"{"markups": [{"coordinateSystem": "LPS", "controlPoints": [
        {"position": [-30, -30, 20]}, {"position": [-30, -30, 40]}]}]}"#;
    let curve = &file("frames.mrk.json", curve);
    let arguments = ["--mesh", wall, "--centreline", curve, "--radius", "2"];
    refuse(&arguments, "does not say whether it is LPS or RAS; say it with --mesh-frame");
    let arguments = [&arguments[..], &["--mesh-frame", "ras"]].concat();
    assert!(succeed(&arguments).contains("robot: turned from LPS to RAS\n"));
    assert_eq!(minimum(&arguments), 10.0);
    refuse(
        &[&arguments[..], &["--frame", "ras"]].concat(),
        "says that it is LPS; leave out --frame",
    );
}

#[test]
fn the_base_is_told_to_be_inside_or_outside_and_a_unit_that_is_not_known() {
    let wall = &room("base.obj");
    let beside = &file("beside.csv", "70,30,20,1\n70,30,40\n");
    let out = succeed(&["--mesh", wall, "--centreline", beside]);
    assert!(
        out.contains("\nbase: outside the mesh\n") && out.contains("\nminimum 9.000: link 0"),
        "{out}"
    );
    let on = &file("on.csv", "60,30,20,1\n70,30,20\n");
    assert!(succeed(&["--mesh", wall, "--centreline", on]).contains("\nbase: on the mesh, or "));
    // Two voxels of an NRRD file; its unit is that of the scanner, or nothing.
    let organ = "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 2 1 1\n\
                 space directions: (20,0,0) (0,20,0) (0,0,20)\nUNITS\nspace origin: (0,0,0)\nencoding: ascii\n\n1 1\n";
    let [known, unknown] =
        [("known", "space units: \"mm\" \"mm\" \"mm\""), ("unknown", "# of nothing")]
            .map(|(name, units)| file(&format!("{name}.nrrd"), &organ.replace("UNITS", units)));
    let inside = &file("inside.csv", "0,0,0,1\n20,0,0\n");
    let out = succeed(&["--mesh", &known, "--centreline", inside]);
    assert!(out.contains(", frame LPS, unit mm\nbase: inside"), "{out}");
    let out = succeed(&["--mesh", &unknown, "--centreline", inside]);
    assert!(out.contains(", frame LPS, unit not stated\n"), "{out}");
    let options = ["--mesh", &known, "--centreline", inside, "--mesh-frame", "ras"];
    refuse(&options, "says that it is LPS; leave out --mesh-frame");
}

#[test]
fn many_shapes_give_a_line_each() {
    let wall = &room("many.obj");
    let shapes = "shape,x,y,z,radius\n1,30,30,20,2\n1,30,30,40\n7,30,30,10,1\n7,30,30,30\n8,30,30,20,1\n8,nan,30,30\n";
    let shapes = &file("many.csv", shapes);
    let out = succeed(&["--mesh", wall, "--shapes", shapes]);
    let lines: Vec<_> = out.lines().collect();
    assert!(
        lines.len() == 4 && lines[0].starts_with("shape,distance,arc_length,segment,triangle,"),
        "{out}"
    );
    assert!(lines[1].starts_with("1,20,") && lines[2].starts_with("7,10,0,0,"), "{out}");
    assert!(lines[3].starts_with("8,,") && lines[3].contains("point 1"), "{out}");
    assert!(lines.iter().all(|line| line.split(',').count() >= 12), "{out}");
    let out = succeed(&["--mesh", wall, "--shapes", shapes, "--json"]);
    let objects: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(objects[1]["minimum"]["distance"], 10.0);
    assert!(objects[2]["error"].as_str().unwrap().contains("point 1"));
    refuse(
        &["--mesh", wall, "--shapes", &file("few.csv", "1,30,30\n")],
        "write shape,x,y,z or shape,x,y,z,radius",
    );
    refuse(&["--mesh", wall, "--shapes", &file("none.csv", "\n")], "has no points");
    let headed = file("headed.csv", "shape,y,x,z\n1,30,30,20\n");
    refuse(&["--mesh", wall, "--shapes", &headed], "has 'y' in column 2");
}

#[test]
fn json_holds_all_of_it() {
    let wall = &room("json.obj");
    let shape = &file("json.csv", "30,30,20,2\n30,30,30,1\n30,30,40\n");
    let out = succeed(&["--mesh", wall, "--centreline", shape, "--tolerance", "0.1", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(report["mesh"]["triangles"] == 12 && report["mesh"]["frame"].is_null());
    assert!(
        report["base"] == "inside"
            && report["minimum"]["distance"] == 20.0
            && report["warnings"] == serde_json::json!([])
    );
    assert!(report["links"][1]["segment"] == 1 && report["curve"]["resolved"] == true);
}

#[test]
fn the_minimum_is_printed_whatever_becomes_of_the_curve() {
    let wall = &room("sharp.obj");
    // It turns back on itself.
    let shape = &file("sharp.csv", "30,30,20,2\n30,30,40,2\n30,31,20\n");
    let (status, out, error) = run(&["--mesh", wall, "--centreline", shape, "--tolerance", "0.1"]);
    assert!(status == Some(2) && out.contains("\nminimum 18.00: link "), "{out}");
    let [doubt, error] = error.lines().collect::<Vec<_>>()[..] else { panic!("{error}") };
    assert!(doubt.starts_with("warning: the robot turns by more than 90 degrees at point 1;"));
    assert!(error.starts_with("error: no bounds for the curve: "), "{error}");
    assert!(error.contains("leave out --tolerance for a robot of straight links"), "{error}");
}

#[test]
fn a_line_of_vtk_is_a_robot() {
    let wall = &room("vtk.obj");
    let vtk = "# vtk DataFile Version 5.1\nline\nASCII\nDATASET POLYDATA\nPOINTS 4 double\n30 30 20 30 30 40 31 30 10 31 30 40\n\
               LINES 3 4\nOFFSETS vtktypeint64\n0 2 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\n";
    let line = &file("line.vtk", vtk);
    let asked = ["--mesh", wall, "--centreline", line, "--radius", "2"];
    refuse(&asked, "holds 2 lines; choose one from 0 to 1");
    assert_eq!(minimum(&[&asked[..], &["--line", "1"]].concat()), 10.0);
    refuse(&["--mesh", wall, "--centreline", line, "--line", "1"], "give --radius");
    let shape = &file("line.csv", "30,30,20,2\n30,30,40\n");
    let asked = ["--mesh", wall, "--centreline", shape, "--line", "1"];
    refuse(&asked, "has no line 1, but 1, counted from 0; choose one of them with --line");
    let branches = &file("branches.csv", "30,30,20\n30,30,40\n\n31,30,10\n31,30,40\n");
    let asked = ["--mesh", wall, "--centreline", branches, "--radius", "2"];
    refuse(&asked, "holds 2 lines; choose one from 0 to 1 with --line");
    assert_eq!(minimum(&[&asked[..], &["--line", "1"]].concat()), 10.0);
}

/// The last line names the link, its place and the triangle, with the unit if a file states it.
#[test]
fn the_last_line_names_the_place() {
    let last = |wall: &str, shape: &str| {
        let out = succeed(&["--mesh", wall, "--centreline", shape]);
        out.lines().last().unwrap().to_owned()
    };
    // The sheet x = 0. The corner between the two links is nearest: 6.034 from it, and 17.94 from
    // the base.
    let sheet = |scale: f64| {
        let corners = [[0, -9, -9], [0, 90, -9], [0, -9, 90], [0, 90, 90]];
        let vertex = |v: [i32; 3]| {
            let [x, y, z] = v.map(|x| f64::from(x) * scale);
            format!("v {x} {y} {z}\n")
        };
        corners.map(vertex).concat() + "f 2 3 4\nf 1 2 3\n"
    };
    let shape = |scale: f64| {
        let point = |p: [f64; 3]| {
            let [x, y, z] = p.map(|x| x * scale);
            format!("{x},{y},{z},{}\n", 0.5 * scale)
        };
        [[9.034, 1.0, 1.0], [6.534, 1.0, 18.764], [9.034, 1.0, 30.0]].map(point).concat()
    };
    for (name, scale, expected) in [
        ("one", 1.0, "minimum 6.034: link 0, 17.9 from the base, triangle 1"),
        ("metres", 1e-3, "minimum 0.006034: link 0, 0.0179 from the base, triangle 1"),
        ("tiny", 1e-9, "minimum 6.034e-9: link 0, 1.79e-8 from the base, triangle 1"),
        ("huge", 1e9, "minimum 6.034e9: link 0, 1.79e10 from the base, triangle 1"),
    ] {
        let wall = file(&format!("last_{name}.obj"), &sheet(scale));
        let shape = file(&format!("last_{name}.csv"), &shape(scale));
        assert_eq!(last(&wall, &shape), expected);
    }
    // A voxel of 20 mm around the origin: its surface reaches at most 10 mm from the centre, and
    // the robot's side is 29 mm from it.
    let organ = "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 1 1 1\n\
                 space directions: (20,0,0) (0,20,0) (0,0,20)\nspace units: \"mm\" \"mm\" \"mm\"\n\
                 space origin: (0,0,0)\nencoding: ascii\n\n1\n";
    let line = last(&file("last.nrrd", organ), &file("last.csv", "-5,0,30,1\n5,0,30\n"));
    let (distance, place) = line.split_once(": ").unwrap();
    let distance: f64 =
        distance.strip_prefix("minimum ").unwrap().strip_suffix(" mm").unwrap().parse().unwrap();
    assert!((19.0..29.0).contains(&distance), "{line}");
    assert!(
        place.starts_with("link 0, ") && place.contains(" mm from the base, triangle "),
        "{line}"
    );
}

#[test]
fn a_radius_in_another_unit_is_doubted_and_the_remedy_works() {
    let wall = &room("radius_wall.obj");
    let plain = &file("radius_plain.csv", "30,30,20\n30,30,40\n");
    let metres = &file("radius_metres.csv", "0.030,0.030,0.020\n0.030,0.030,0.040\n");
    let asked = ["--mesh", wall, "--centreline", plain, "--radius"];
    for good in ["0.5", "2", "0.03", "0"] {
        assert_eq!(warnings(&[&asked[..], &[good]].concat()), [""; 0], "{good}");
    }
    for (radius, size) in
        [("50", "large"), ("0.005", "small"), ("500", "large"), ("0.0005", "small")]
    {
        let said = warnings(&[&asked[..], &[radius]].concat());
        let expected = format!("the radius {radius} is {size} beside the mesh's box");
        let said = said.iter().find(|line| line.contains(&expected));
        let said = said.unwrap_or_else(|| panic!("{radius}: {said:?}"));
        let remedy = said.split("--radius ").nth(1).and_then(|rest| rest.split(' ').next());
        assert_eq!(remedy.unwrap().parse(), Ok(0.5), "{said}");
    }
    // --scale does not multiply --radius.
    let scaled = ["--mesh", wall, "--centreline", metres, "--scale", "1000", "--radius"];
    let said = warnings(&[&scaled[..], &["0.0005"]].concat());
    assert!(said.len() == 1 && said[0].contains("--radius 0.5"), "{said:?}");
    assert_eq!(warnings(&[&scaled[..], &["0.5"]].concat()), [""; 0]);
    // Radii in the file: in the unit of the file. A wrong scale is one doubt, not two.
    let table = |name: &str, text: &str| file(&format!("radius_{name}.csv"), text);
    let both = &table("both", "0.030,0.030,0.020,0.0005\n0.030,0.030,0.040\n");
    let said = warnings(&["--mesh", wall, "--centreline", both]);
    assert!(said.iter().all(|line| !line.contains("radius")), "{said:?}");
    let mixed = &table("mixed", "0.030,0.030,0.020,0.5\n0.030,0.030,0.040\n");
    let said = warnings(&["--mesh", wall, "--centreline", mixed, "--scale", "1000"]);
    let expected = "a radius of 0.0005 in the file would be usual";
    assert!(said.len() == 1 && said[0].contains(expected), "{said:?}");
    assert_eq!(warnings(&["--mesh", wall, "--centreline", both, "--scale", "1000"]), [""; 0]);
}

/// Frames are named in any case.
#[test]
fn a_frame_is_named_in_any_case() {
    let wall = &room("cases.obj");
    let shape = &file("cases.csv", "-30,-30,20,2\n-30,-30,40\n");
    for [frame, other] in [["LPS", "RAS"], ["Lps", "ras"], ["ras", "lPS"]] {
        let asked =
            ["--mesh", wall, "--centreline", shape, "--frame", frame, "--mesh-frame", other];
        assert_eq!(minimum(&asked), 20.0);
    }
}

/// Where sizes match, a change of unit that makes the boxes overlap would hide a wrong pose.
#[test]
fn a_shifted_robot_is_no_matter_of_units() {
    let wall = &room("shifted.obj");
    let shape = &file("shifted.csv", "90,90,20,2\n90,90,40\n");
    let said = warnings(&["--mesh", wall, "--centreline", shape]).join("\n");
    assert!(said.ends_with("they are 30.000 apart; check the robot's pose"), "{said}");
}

/// Nothing is printed with hundreds of digits.
#[test]
fn huge_numbers_are_short() {
    let scaled = |name: &str, power: &str| {
        let text = std::fs::read_to_string(room(name)).unwrap();
        let far = |line: &str| match line.strip_prefix("v ") {
            Some(place) => format!("v {}\n", place.replace("60", &format!("6{power}"))),
            None => format!("{line}\n"),
        };
        file(name, &text.lines().map(far).collect::<String>())
    };
    let plain = &room("huge_plain.obj");
    let huge = &scaled("huge.obj", "e149");
    let far = &file("huge.csv", "3e149,3e149,2e149,1e148\n3e149,3e149,4e149\n");
    let near = &file("huge_near.csv", "30,30,20,2\n30,30,40\n");
    let shapes =
        &file("huge_shapes.csv", "1e300,3e149,3e149,2e149,1e148\n1e300,3e149,3e149,4e149,1\n");
    for arguments in [
        &["--mesh", huge, "--centreline", far, "--tolerance", "1e147", "--margin", "1e300"][..],
        &["--mesh", huge, "--centreline", far, "--csv", "huge_out.csv"],
        &["--mesh", huge, "--shapes", shapes],
        &["--mesh", plain, "--centreline", far],
        &["--mesh", huge, "--centreline", near],
        &["--mesh", plain, "--centreline", near, "--scale", "1e300"],
        &["--mesh", plain, "--centreline", &file("huge_radius.csv", "3,3,2,1e300\n3,3,4\n")],
        &["--mesh", plain, "--centreline", near, "--margin", "1e308"],
    ] {
        let (_, out, error) = run(arguments);
        let table = std::fs::read_to_string(continuum_programs::place("huge_out.csv"));
        let text = out + &error + &table.unwrap_or_default();
        let longest = text.split(|c: char| !c.is_ascii_digit()).map(str::len).max();
        assert!(longest.unwrap_or(0) <= 20, "{arguments:?}: {text}");
    }
}
