//! `--margin`: a line with the verdict, and the exit status.

use crate::{refuse, run};
use continuum_programs::{file, room};

/// The line with the verdict, in the output or beside it.
fn verdict(text: &str) -> &str {
    let mut lines = text.lines().filter(|line| line.starts_with("margin "));
    let line = lines.next().unwrap_or_else(|| panic!("{text}"));
    assert_eq!(lines.next(), None);
    line
}

/// A box of 60, and a needle that is 20 from its nearest sides.
fn needle(name: &str) -> [String; 2] {
    [room(&format!("{name}.obj")), file(&format!("{name}.csv"), "30,30,20,2\n30,30,40\n")]
}

#[test]
fn the_exit_status_says_whether_the_margin_is_kept() {
    let [wall, shape] = &needle("needle");
    let asked = ["--mesh", wall, "--centreline", shape, "--margin"];
    for (margin, decision, expected) in
        [("0", "kept", 0), ("19.999", "kept", 0), ("20", "not kept", 1), ("25.5", "not kept", 1)]
    {
        let (status, out, error) = run(&[&asked[..], &[margin]].concat());
        assert_eq!(status, Some(expected), "{margin}: {error}");
        assert_eq!(verdict(&out), format!("margin {margin}: {decision}, base inside the mesh"));
        assert!(out.lines().last().unwrap().starts_with("minimum 20.00: link 0, "), "{out}");
    }
    // Outside of a closed wall the margin is kept too: the line says so.
    let outside = &file("margin_outside.csv", "90,30,20,2\n90,30,40\n");
    let (status, out, _) = run(&["--mesh", wall, "--centreline", outside, "--margin", "1"]);
    assert_eq!((status, verdict(&out)), (Some(0), "margin 1: kept, base outside the mesh"));
    // JSON has the verdict as a field.
    let (status, out, _) = run(&[&asked[..], &["25.5", "--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(status, Some(1));
    assert_eq!(report["margin"], serde_json::json!({"value": 25.5, "kept": false}));
    for wrong in ["-1", "nan", "inf", "1,5"] {
        refuse(&[&asked[..], &[wrong]].concat(), "write a number that is at least 0");
    }
}

#[test]
fn the_curve_decides_if_it_has_bounds() {
    let [wall, _] = &needle("curved");
    // Four points of an arc of radius 20 around the middle of the box, in the plane x = 30.
    let point = |k: f64| {
        let (sin, cos) = (0.5 * k).sin_cos();
        format!("30,{},{},1\n", 30.0 + 20.0 * sin, 30.0 + 20.0 * cos)
    };
    let shape = &file("curved.csv", &[0.0, 1.0, 2.0, 3.0].map(point).concat());
    let asked = ["--mesh", wall, "--centreline", shape, "--tolerance", "1"];
    let (_, out, error) = run(&asked);
    let bounds = out.lines().find_map(|line| line.strip_prefix("curve: "));
    let bounds = bounds.unwrap_or_else(|| panic!("{out} {error}"));
    let bounds: Vec<f64> =
        bounds.split([' ', ',']).filter_map(|word| word.parse().ok()).take(2).collect();
    let [lower, upper] = bounds[..] else { panic!("{out}") };
    assert!(lower < upper, "the bounds leave nothing undecided: {out}");
    for (margin, decision, expected) in [
        (lower - 0.01, "kept by the curve, base inside the mesh", 0),
        (upper + 0.01, "not kept by the curve, base inside the mesh", 1),
        (
            0.5 * (lower + upper),
            "undecided by the curve, base inside the mesh; give a smaller --tolerance",
            1,
        ),
    ] {
        let margin = &margin.to_string();
        let (status, out, _) = run(&[&asked[..], &["--margin", margin]].concat());
        assert_eq!(status, Some(expected));
        assert_eq!(verdict(&out), format!("margin {margin}: {decision}"));
    }
}

/// Few points leave the curve between bounds that no tolerance brings together.
#[test]
fn a_curve_of_few_points_needs_more_of_them() {
    let [wall, _] = &needle("few");
    let shape = &file("few.csv", "30,30,20,2\n30,30,30,2\n30,31,40\n");
    let asked = ["--mesh", wall, "--centreline", shape, "--tolerance", "1e-9", "--margin", "19.8"];
    let (status, out, _) = run(&asked);
    assert!(status == Some(1) && out.contains(", farther apart than --tolerance\n"), "{out}");
    assert!(verdict(&out).ends_with("; write more points along the robot"), "{out}");
}

#[test]
fn a_margin_holds_for_all_shapes() {
    let [wall, _] = &needle("shapes_margin");
    let good = "shape,x,y,z,radius\n1,30,30,20,2\n1,30,30,40\n7,30,30,10,1\n7,30,30,30\n";
    let shapes = &file("shapes_margin.csv", good);
    let asked = ["--mesh", wall, "--shapes", shapes, "--margin"];
    let (status, out, error) = run(&[&asked[..], &["9"]].concat());
    assert_eq!((status, verdict(&error)), (Some(0), "margin 9: kept, by 2 of 2 shapes"));
    assert!(!out.contains("margin"), "{out}");
    let (status, _, error) = run(&[&asked[..], &["10"]].concat());
    assert_eq!((status, verdict(&error)), (Some(1), "margin 10: not kept, by 1 of 2 shapes"));
    // A shape without an answer does not keep it.
    let broken = &file("broken_margin.csv", &format!("{good}8,30,30,20,1\n8,nan,30,30\n"));
    let (status, _, error) = run(&["--mesh", wall, "--shapes", broken, "--margin", "1"]);
    assert_eq!((status, verdict(&error)), (Some(1), "margin 1: not kept, by 2 of 3 shapes"));
}
