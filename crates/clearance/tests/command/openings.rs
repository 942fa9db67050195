//! Walls that are open or badly joined are announced, and `--inside` decides by the side.

use crate::{refuse, run, warnings};
use continuum_programs::file;

/// A box of 60, without the faces of some numbers. It has two triangles on each side: the two at
/// x = 60 are 10 and 11.
fn room_without(name: &str, left_out: &[usize], turned: &[usize]) -> String {
    let corners = (0..8).map(|k| format!("v {} {} {}\n", 60 * (k & 1), 30 * (k & 2), 15 * (k & 4)));
    let faces = [
        [1, 3, 4],
        [1, 4, 2],
        [5, 6, 8],
        [5, 8, 7],
        [1, 2, 6],
        [1, 6, 5],
        [3, 7, 8],
        [3, 8, 4],
        [1, 5, 7],
        [1, 7, 3],
        [2, 4, 8],
        [2, 8, 6],
    ];
    let faces = faces.iter().enumerate().filter(|(number, _)| !left_out.contains(number));
    let faces = faces.map(|(number, [a, b, c])| {
        if turned.contains(&number) {
            format!("f {a} {c} {b}\n")
        } else {
            format!("f {a} {b} {c}\n")
        }
    });
    file(name, &(corners.collect::<String>() + &faces.collect::<String>()))
}

#[test]
fn a_robot_that_leaves_through_a_cut_end_is_announced() {
    // Open at x = 60. The robot begins in the middle and ends 70 outside.
    let wall = &room_without("cut.obj", &[10, 11], &[]);
    let shape = &file("cut.csv", "30,30,30,2\n50,30,30,2\n70,30,30,2\n130,30,30\n");
    let asked = ["--mesh", wall, "--centreline", shape, "--margin", "2"];
    let (status, out, error) = run(&asked);
    assert_eq!(status, Some(0));
    let [open, side] = warnings(&error)[..] else { panic!("{error}") };
    // The square of 60 is 60 sqrt(2) across its diagonal.
    let expected = "the mesh is open: one opening 84.85 wide at (60, 30, 30); a robot may leave";
    assert!(open.starts_with(expected), "{error}");
    assert!(side.contains("not every link is inside") && side.contains("--inside"), "{error}");
    for line in [
        "base: inside the mesh",
        "tip: outside the mesh",
        "sides: link 0 inside, link 1 undecided (on the mesh or in an opening), link 2 outside",
        "margin 2: kept, base inside the mesh, tip outside the mesh",
    ] {
        assert!(out.lines().any(|found| found == line), "{line}: {out}");
    }
    let (status, out, error) = run(&[&asked[..], &["--inside"]].concat());
    assert!(status == Some(1) && out.contains("\ninside: not every link\n"), "{out}");
    assert_eq!(warnings(&error).len(), 1);
    // JSON has all of it.
    let (_, out, _) = run(&[&asked[..], &["--json"]].concat());
    let report: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(report["sides"], serde_json::json!(["inside", "undecided", "outside"]));
    assert!(report["inside"] == false && report["tip"] == "outside");
    assert_eq!(report["mesh"]["openings"][0]["edges"], 4);
    assert_eq!(report["warnings"].as_array().unwrap().len(), 2);
}

#[test]
fn inside_asks_for_every_link_and_for_the_margin() {
    let closed = &room_without("inside.obj", &[], &[]);
    let open = &room_without("inside_open.obj", &[10, 11], &[]);
    let within = &file("within.csv", "10,30,30,2\n20,30,30,2\n30,30,30\n");
    let beside = &file("inside_beside.csv", "347,30,30,2\n360,30,30\n");
    let through = &file("inside_through.csv", "30,30,30,2\n30,30,90\n");
    for (wall, shape, more, expected, said) in [
        (closed, within, &[][..], 0, "inside: every link"),
        (open, within, &[], 0, "inside: every link"),
        (closed, within, &["--margin", "7"], 0, "inside: every link"),
        // The base is 10 from the wall, less the radius in other directions; its face is 10 from
        // it.
        (closed, within, &["--margin", "11"], 1, "inside: every link"),
        (closed, beside, &[], 1, "inside: not every link"),
        (closed, beside, &["--margin", "200"], 1, "inside: not every link"),
        (closed, through, &[], 1, "inside: not every link"),
    ] {
        let arguments = [&["--mesh", wall, "--centreline", shape, "--inside"][..], more].concat();
        let (status, out, error) = run(&arguments);
        assert_eq!(status, Some(expected), "{arguments:?}: {out}{error}");
        assert!(out.lines().any(|line| line == said), "{arguments:?}: {out}");
    }
    // 287 beside the wall the margin is kept. That is announced.
    let (status, out, error) = run(&["--mesh", closed, "--centreline", beside, "--margin", "2"]);
    assert!(
        status == Some(0) && out.contains("\nmargin 2: kept, base outside the mesh\n"),
        "{out}"
    );
    assert!(warnings(&error)[1].contains("not every link is inside"), "{error}");
    // Many shapes.
    let shapes = "shape,x,y,z,radius\n1,10,30,30,2\n1,30,30,30\n2,30,30,30,2\n2,130,30,30\n";
    let shapes = &file("inside_shapes.csv", shapes);
    let asked = ["--mesh", open, "--shapes", shapes, "--margin", "1"];
    let (status, out, error) = run(&asked);
    let inside: Vec<_> = out.lines().map(|line| line.rsplit(',').next().unwrap()).collect();
    assert_eq!(inside, ["inside", "true", "false"], "{out}");
    assert!(status == Some(0) && error.contains("not every link is inside"), "{error}");
    let (status, _, error) = run(&[&asked[..], &["--inside"]].concat());
    assert!(status == Some(1) && error.contains("inside: 1 of 2 shapes\n"), "{error}");
    refuse(&["--mesh", open, "--labels", "--inside"], "cannot be used with");
}

#[test]
fn edges_that_cannot_have_two_sides_are_announced() {
    let shape = &file("flaws.csv", "10,30,30,2\n30,30,30\n");
    let said = |wall: &str| {
        let (status, _, error) = run(&["--mesh", wall, "--centreline", shape]);
        assert_eq!(status, Some(0), "{error}");
        warnings(&error).join("\n")
    };
    assert_eq!(said(&room_without("sound.obj", &[], &[])), "");
    let turned = said(&room_without("turned.obj", &[], &[10]));
    assert!(turned.starts_with("the mesh has 3 edges whose triangles face opposite ways; "));
    let half = said(&room_without("half_turned.obj", &[], &[0, 1, 2, 3, 4, 5]));
    assert!(half.contains("inside and outside may be reversed"), "{half}");
    // A wall across the box.
    let room = std::fs::read_to_string(room_without("parted.obj", &[], &[])).unwrap();
    let parted = said(&file("parted.obj", &(room + "f 1 2 8\nf 1 8 7\n")));
    assert!(parted.contains("edges of more than two triangles; "), "{parted}");
}
