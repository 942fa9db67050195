//! The example programs as a user meets them: bad input gives one line and an error code, good input a picture.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// A file with the given text, in a directory of this test's own.
fn file(name: &str, text: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().into()
}

/// Runs an example program as a user does, in a directory of this test's own.
fn program(name: &str, arguments: &[&str]) -> (bool, String, String) {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    let directory = BUILT.get_or_init(|| {
        let mut build = Command::new(env!("CARGO"));
        build.args([
            "build",
            "--quiet",
            "--example",
            "ventricle",
            "--example",
            "figure7",
            "--example",
            "rapier_ventricle",
            "--example",
            "tradeoff",
        ]);
        assert!(build.current_dir(env!("CARGO_MANIFEST_DIR")).status().unwrap().success());
        // This test is target/debug/deps/scene-..; examples are in target/debug/examples.
        std::env::current_exe().unwrap().ancestors().nth(2).unwrap().join("examples")
    });
    let output = Command::new(directory.join(name))
        .args(arguments)
        .current_dir(env!("CARGO_TARGET_TMPDIR"))
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.success(), text(output.stdout), text(output.stderr))
}

#[test]
fn programs_answer_bad_input_with_one_line_and_an_error_code() {
    let empty = &file("hollow.obj", "v 0 0 0\n");
    let nan = &file("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    let tiny = &file("tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    let sheet = &file("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", empty], "no triangles"),
        (&["--mesh", nan], "vertex 2"),
        (&["--mesh", tiny, "--scale", "1e200"], "larger unit"),
        (&["--mesh", tiny], "no room"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--mesh", empty, "--scale", "-1"], "positive number"),
        (&["--triangle", "1"], "--triangle"),
        (&["--triangles", "none"], "'none'"),
        (&["--triangles", "100"], "6000..=20000000"),
        (&["--base", "1,2"], "three numbers"),
        (&["--base", "1,2,inf"], "three numbers"),
        (&["--axis", "0,0,0"], "a direction needs a length"),
        (&["--model", "cone"], "capsule, cylinder, modified"),
        (&["--engine", "gpu"], "--features gpu"),
        (&["--tolerance", "-0.1"], "at least 0"),
        (&["--steps", "0"], "1..=100000"),
        (&["--scale", "2"], "--mesh"),
    ] {
        let (success, out, error) = program("ventricle", arguments);
        assert!(!success && out.is_empty(), "{arguments:?}: {out}");
        assert!(error.contains(expected) && error.lines().count() == 1, "{arguments:?}: {error}");
    }
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--push", "101"], "from 0 to 100"),
        (&["--links", "2"], "3..=60"),
    ] {
        let (success, out, error) = program("rapier_ventricle", arguments);
        assert!(!success && out.is_empty(), "{arguments:?}: {out}");
        assert!(error.contains(expected) && error.lines().count() == 1, "{arguments:?}: {error}");
    }
    assert!(program("ventricle", &["--help"]).0 && program("rapier_ventricle", &["--help"]).0);
}

#[test]
fn programs_draw_their_pictures() {
    let corners = (0..8).map(|k| format!("v {} {} {}\n", 60 * (k & 1), 30 * (k & 2), 15 * (k & 4)));
    let sides = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    let room = file("room.obj", &(corners.collect::<String>() + sides));
    let arguments =
        ["--mesh", &room, "--model", "capsule", "--tolerance", "0.2", "--steps", "3", "--out", "drawn"];
    let (success, out, error) = program("ventricle", &arguments);
    assert!(success, "{error}");
    assert!(out.contains("12 triangles, 3 steps: search and exhaustive engine agree"), "{out}");
    for line in ["parry distance(Cylinder, TriMesh)", "search, cold", "search, warm", "exhaustive"] {
        assert!(out.contains(line), "{out}");
    }
    let (success, _, error) = program("figure7", &["--out", "drawn/seven.png"]);
    assert!(success, "{error}");
    for name in ["drawn/ventricle.png", "drawn/seven.png"] {
        let file = std::fs::File::open(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let colours: BTreeSet<_> = pixels.as_chunks::<3>().0.iter().collect();
        assert!(colours.len() > 1000, "{name} has {} colours", colours.len());
    }
}

#[test]
fn the_trade_is_measured_drawn_and_quoted() {
    let corners = (0..8).map(|k| format!("v {} {} {}\n", 60 * (k & 1), 30 * (k & 2), 15 * (k & 4)));
    let sides = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    let hall = file("hall.obj", &(corners.collect::<String>() + sides));
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trade");
    std::fs::create_dir_all(&directory).unwrap();
    let readme = directory.join("README.md");
    std::fs::write(&readme, "before\n<!-- tradeoff -->\nstale\n<!-- /tradeoff -->\nafter\n").unwrap();
    let place = ["--mesh", &hall, "--base", "30,30,30", "--axis", "0,0,1"];
    let small = ["--shapes", "12", "--timed", "2", "--out", "trade/docs"];
    let (success, _, error) = program("tradeoff", &[place, small].concat());
    assert!(success, "{error}");

    let read = |path: PathBuf| std::fs::read_to_string(path).unwrap();
    let page = read(directory.join("docs/TRADEOFF.md"));
    let trade = page.split("## The trade").nth(1).unwrap().split("![").next().unwrap();
    for model in [
        "K, capsules",
        "Z, cylinders",
        "Z*, modified",
        "Z*, faces fixed",
        "parry's Capsule",
        "parry's Cylinder",
        "7 spheres a link",
    ] {
        assert_eq!(trade.matches(&format!("\n| {model} | ")).count(), 7, "{model}: {trade}");
    }
    for text in [
        "of the 12 shapes are free",
        "95 % confidence (Wilson)",
        "GJK alone",
        "torsion, same angles at the base",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }
    assert!(!page.contains("NaN") && !page.contains("inf "), "{page}");
    // Discs and rings for the search of four models at seven tolerances, and in the legend.
    assert_eq!(read(directory.join("docs/tradeoff.svg")).matches("<circle").count(), 2 * 4 * 7 + 2);
    let readme = read(readme);
    assert!(
        readme.starts_with("before\n<!-- tradeoff -->\nMeasured by") && !readme.contains("stale"),
        "{readme}"
    );
    assert!(readme.ends_with("\n<!-- /tradeoff -->\nafter\n"), "{readme}");

    let wall = file("wall.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    let arguments =
        ["--mesh", &wall, "--base", "0,0,0", "--axis", "0,0,1", "--shapes", "10", "--out", "trade/none"];
    let (success, _, error) = program("tradeoff", &arguments);
    assert!(!success && error.contains("every shape touches the wall"), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
}
