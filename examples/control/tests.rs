//! The program as a user runs it: the fixture keeps the robot away from the wall.

use continuum_programs::{colours, refuse, succeed};

const CONTROL: &str = env!("CARGO_BIN_EXE_control");

/// The number before ` mm` in the line that begins so.
fn nearest(output: &str, line: &str) -> f64 {
    let line = output.lines().find(|text| text.trim_start().starts_with(line)).expect("the line");
    let (number, _) = line
        .split_once("nearer than ")
        .and_then(|(_, rest)| rest.split_once(" mm"))
        .expect("a number");
    number.parse().expect("a number")
}

#[test]
fn a_fixture_keeps_the_robot_away_from_the_wall() {
    let out = succeed(CONTROL, &["--ticks", "800", "--out", "controlled/way.png"]);
    assert!(nearest(&out, "without the fixture") < 0.01, "{out}");
    assert!(nearest(&out, "with the fixture") >= 0.5, "{out}");
    for part in ["kinematics", "robot", "query", "p99.9"] {
        assert!(out.contains(part), "{out}");
    }
    assert!(colours("controlled/way.png") > 10);
    refuse(CONTROL, &["--ticks", "1"], "write a whole number from 100 to 1000000");
    refuse(CONTROL, &["--out", "bar.jpg"], "ends in .jpg");
}
