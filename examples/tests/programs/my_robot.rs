//! A user's own mesh, centreline and matrix: distances known by hand, and errors that say what to change.

use crate::{example, refuse, succeed};
use continuum_testing::programs::{file, room, run};

/// A quarter turn that brings x to y and y to -x, and a shift.
const TURNED: &str = "0 -1 0 60\n1 0 0 0\n0 0 1 0\n0 0 0 1\n";

/// What the program prints after `minimum`.
fn minimum(arguments: &[&str]) -> f64 {
    let out = succeed("my_robot", arguments);
    let last = out.lines().last().and_then(|line| line.strip_prefix("minimum ")).map(str::to_owned);
    last.unwrap_or_else(|| panic!("{out}")).parse().unwrap()
}

#[test]
fn a_straight_robot_in_a_box_has_the_clearance_that_one_can_see() {
    // A box of 60 in each direction, and a needle along z: 20 from both ends, 28 and then 29 from the sides.
    let room = &room("box.obj");
    let shape = &file("shape.csv", "x,y,z,radius\n30,30,20,2\n30,30,30,1\n30,30,40\n");
    let out = succeed("my_robot", &["--mesh", room, "--centreline", shape]);
    assert_eq!(out.lines().count(), 3, "{out}");
    assert_eq!(minimum(&["--mesh", room, "--centreline", shape]), 20.0);
    // Semicolons, no heading, one radius for all; moved to 7 from a side.
    let plain = &file("plain.csv", "\u{feff}30; 30; 20\r\n30; 30; 40\r\n\r\n");
    let moved = &file("moved.txt", "1 0 0 -21\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    let moved = ["--mesh", room, "--centreline", plain, "--pose", moved, "--radius", "2"];
    assert_eq!(minimum(&moved), 7.0);
    // Turned: (5, 30) goes to (30, 5).
    let side = &file("side.csv", "5,30,20,1\n5,30,40,1\n");
    let turned = &file("turned.txt", TURNED);
    let out =
        succeed("my_robot", &["--mesh", room, "--centreline", side, "--pose", turned, "--tolerance", "0.01"]);
    assert!(
        out.contains(", from [30.000000, 4.000000, ") && out.contains(" to [30.000000, 0.000000, "),
        "{out}"
    );
    let curve = out.lines().find_map(|line| line.strip_prefix("curve: ")).unwrap_or_else(|| panic!("{out}"));
    let bounds: Vec<f64> = curve.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
    assert!(bounds[0] <= 4.0 && 4.0 <= bounds[1] && bounds[1] - bounds[0] <= 0.0100001, "{out}");
    // The files that come with the example.
    let data = |name: &str| format!("{}/data/{name}", env!("CARGO_MANIFEST_DIR"));
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
    let array = "[[1., 0., 0., -21.],\n [0., 1., 0., 0.],\n [0., 0., 1., 0.],\n [0., 0., 0., 1.]]\n";
    let array = ["--mesh", room, "--centreline", plain, "--pose", &file("array.txt", array), "--radius", "2"];
    assert_eq!(minimum(&array), 7.0);
}

#[test]
fn points_are_read_as_people_write_them() {
    let room = &room("people.obj");
    for text in [
        "30,30,20,2\n30,30,40\n",
        "30,30,20,2\n30,30,40,0\n",
        "# saved by hand\n\nx,y,z\n30,30,20,2\n# the tip\n30,30,40\n",
        "\u{feff}x;y;z;radius\r\n30; 30; 20; 2\r\n30; 30; 40\r\n",
        "# x y z r\n3.0e1 3.0e1 2.0e1 2.0e0\n3.0e1 3.0e1 4.0e1 2.0e0\n",
        "X\tY\tZ\n30\t30\t20\t2\n30\t30\t40\n",
        "  30   30 20  2 \n\n   30  30 40",
        "30 , 30 ,\t20,\u{a0}2\n30,30,40\n",
    ] {
        assert_eq!(minimum(&["--mesh", room, "--centreline", &file("people.csv", text)]), 20.0, "{text}");
    }
}

#[test]
fn faces_without_area_are_said_and_change_no_distance() {
    let good = std::fs::read_to_string(room("good_faces.obj")).unwrap();
    let wall = &file("bad_faces.obj", &(good + "f 1 2\nf 3 3 3\nf 4 5 5 4\n"));
    let shape = &file("faces.csv", "30,30,20,2\n30,30,40\n");
    let (success, out, error) = run(example("my_robot"), &["--mesh", wall, "--centreline", shape]);
    assert!(success && out.ends_with("minimum 20.000000\n"), "{out} {error}");
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
        refuse("my_robot", &["--mesh", room, "--centreline", &file("bad.csv", text)], expected);
    };
    refuse_shape("x,y,z\n30,30,20\n30,30,40\n", "line 2 of ");
    refuse_shape("30,30,20\n30,30,40\n", "no radius; write it as a fourth number, or give --radius");
    refuse_shape("30,30,20,1\n30,zero,40\n", "line 2 of ");
    refuse_shape("30,30,20,1\n30,zero,40\n", "write x,y,z or x,y,z,radius");
    refuse_shape("x1,zero,0\n0,0,1,1\n0,0,2", "line 1 of ");
    // Decimal commas.
    refuse_shape("30,5;30,0;20,0;1,0\n30,0;30,0;40,0\n", "write x,y,z or x,y,z,radius");
    refuse_shape("30,30,20,1\n", "point");
    refuse_shape("30,30,20,-1\n30,30,40\n", "radius 0 is -1");
    refuse_shape("30,30,20,1\n30,30,40,-1\n", "the radius of the last point is -1");
    refuse_shape("30,30,20,1\n30,30,40,nan\n", "the radius of the last point is NaN");
    refuse_shape("30,30,20,inf\n30,30,40\n", "radius 0 is inf");
    refuse_shape("30,30,20,1\n30,nan,40\n", "point 1");
    // A number too many, or one that is not there: nothing moves up.
    refuse_shape("30,30,20,1,0\n30,30,40\n", "line 1 of ");
    refuse_shape("30,30,20,1\n30,30\n", "has 2 columns; write x,y,z or x,y,z,radius");
    for (text, line, column) in [
        ("1,,2,0.5\n30,30,40\n", 1, 2),
        ("30,30,20,1\n,30,30,40\n", 2, 1),
        ("x,y,z\n30,30,20,1\n30,30,,40\n", 3, 3),
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
            refuse("my_robot", &arguments, &format!("line {line} of "));
            refuse("my_robot", &arguments, &format!("in column {column}; write x,y,z or x,y,z,radius"));
        }
    }
    // Columns that their heading names otherwise.
    refuse_shape("z,y,x\n30,30,20,1\n30,30,40\n", "has 'z' in column 1");
    refuse_shape("radius,X,Y,Z\n1,30,30,20\n1,30,30,40\n", "has 'X' in column 2");
    // Decimal commas between spaces; two numbers in a column.
    refuse_shape("1,5 2,5\n3,5 4,5\n", "has '5 2' in column 2");
    refuse_shape("30 30,20\n30,30,40\n", "has '30 30' in column 1");
    let refuse_pose = |text: &str, expected: &str| {
        let pose = file("bad.txt", text);
        refuse("my_robot", &["--mesh", room, "--centreline", shape, "--pose", &pose], expected);
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
    refuse("my_robot", &["--mesh", room, "--centreline", "nowhere.csv"], "cannot read nowhere.csv");
    refuse("my_robot", &["--mesh", "nowhere.stl", "--centreline", shape], "check the path");
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
        let (success, _, error) =
            run(example("my_robot"), &["--mesh", room, "--centreline", shape, option, wrong]);
        assert!(!success && error.contains(expected), "{error}");
    }
    #[cfg(unix)]
    refuse("my_robot", &["--mesh", "/dev/zero", "--centreline", shape], "ends in .stl, .obj or .ply");
}

#[test]
fn a_report_holds_all_digits_of_its_query() {
    let out = succeed("report", &[]);
    let (_, distances) = out.trim().split_once(": ").unwrap_or_else(|| panic!("{out}"));
    let distances: Vec<_> = distances.split(", ").filter_map(|part| part.split(' ').next()).collect();
    assert!(distances.len() == 2 && distances[0] == distances[1], "{out}");
    assert!((2.0..10.0).contains(&distances[0].parse().unwrap()), "{out}");
}
