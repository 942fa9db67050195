//! Plausible mistakes in a robot's file, and in the margin, are not accepted in silence.

use crate::{refuse, run, warnings};
use continuum_programs::{file, room};

#[test]
fn mistakes_in_the_file_of_a_robot_are_named() {
    // A box of 60.
    let wall = &room("mistakes.obj");
    for (name, text, expected) in [
        (
            "order.csv",
            "30,30,20,2\n30,30,40,2\n30,30,30,2\n30,30,45\n",
            "the robot turns by more than 90 degrees at point 1, and at one other point; check",
        ),
        (
            "names.csv",
            "mag_x,mag_y,mag_z,radius\n30,30,20,2\n30,30,40,2\n",
            "'mag_x', 'mag_y' and 'mag_z' are read as the position, but their names do not say",
        ),
        (
            "counted.csv",
            "1,30,30,2\n2,30,30,3\n3,30,30,4\n",
            "the first column counts the lines, but the columns are read as x,y,z or x,y,z,radius",
        ),
    ] {
        let shape = &file(&format!("mistakes_{name}"), text);
        let (status, _, error) = run(&["--mesh", wall, "--centreline", shape]);
        assert_eq!(status, Some(0), "{name}: {error}");
        assert!(matches!(&warnings(&error)[..], [one] if one.starts_with(expected)), "{error}");
    }
    for (name, text, expected) in [
        ("radii.csv", "x,y,z,radius,OD\n30,30,20,2,4\n30,30,40,2,4\n", "'radius' and 'OD'"),
        (
            "times.csv",
            "time,x,y,z,r\n0,30,30,20,2\n0,30,30,40,2\n1,30,31,20,2\n1,30,31,40,2\n",
            "holds 2 lines; choose one from 0 to 1 with --line",
        ),
    ] {
        let shape = &file(&format!("mistakes_{name}"), text);
        refuse(&["--mesh", wall, "--centreline", shape], expected);
    }
    let rows = [(0, 20), (0, 40), (5, 20), (5, 40), (0, 40), (0, 45)];
    let rows = rows.map(|(shape, z)| format!("{shape},30,30,{z},2\n"));
    let shapes = &file("mistakes_shapes.csv", &rows.concat());
    let (_, _, error) = run(&["--mesh", wall, "--shapes", shapes]);
    assert!(warnings(&error)[0].starts_with("shape 0: line 5 begins a shape whose"), "{error}");
}

#[test]
fn a_margin_in_metres_is_doubted() {
    let [wall, shape] =
        &[room("margin_unit.obj"), file("margin_unit.csv", "30,30,20,2\n30,30,40\n")];
    for (margin, count) in [("0.002", 1), ("2", 0), ("0", 0)] {
        let asked = ["--mesh", wall, "--centreline", shape, "--margin", margin];
        let (status, _, error) = run(&asked);
        let found = warnings(&error);
        assert_eq!((status, found.len()), (Some(0), count), "{error}");
        let expected = "the margin 0.002 is small beside the mesh's box, which measures 103.923;";
        assert!(found.iter().all(|doubt| doubt.starts_with(expected)), "{error}");
    }
}
