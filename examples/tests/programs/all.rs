//! Every program: its errors, its output and its pictures.

use crate::{refuse, succeed};
use continuum_programs::{colours, file, place, read, room};

/// A place for a picture in a directory that is a file.
fn beside(file: &str) -> String {
    format!("{file}/picture.png")
}

#[test]
fn programs_answer_bad_input_with_one_line_and_an_error_code() {
    let empty = &file("hollow.obj", "v 0 0 0\n");
    let nan = &file("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
    let tiny = &file(
        "tiny.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    );
    let sheet = &file("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", empty], "no triangles"),
        (&["--mesh", nan], "vertex 2"),
        (&["--mesh", tiny, "--scale", "1e200"], "larger unit"),
        (&["--mesh", tiny], "no room"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--mesh", empty, "--scale", "-1"], "positive number"),
        (&["--triangle", "1"], "a similar argument exists: '--triangles'"),
        (&["--triangles", "none"], "write a whole number from 6000 to 20000000"),
        (&["--triangles", "100"], "write a whole number from 6000 to 20000000"),
        (&["--mesh", tiny, "--scale", "big"], "write a number"),
        (&["--mesh", tiny, "--label", "all"], "write a whole number of at least 0"),
        (&["--base", "1,2"], "three numbers"),
        (&["--base", "1,2,inf"], "three numbers"),
        (&["--axis", "0,0,0"], "a direction needs a length"),
        (&["--model", "cone"], "capsule, cylinder, fitted"),
        (&["--tolerance", "-0.1"], "at least 0"),
        (&["--steps", "0"], "write a whole number from 1 to 100000"),
        // An output that cannot be written is found before a mesh that cannot be read.
        (&["--out", "bar.jpg", "--mesh", "nowhere.stl"], "ends in .jpg"),
        (&["--out", &beside(empty), "--mesh", "nowhere.stl"], "choose another --out"),
        (&["--scale", "2"], "--mesh"),
    ] {
        refuse("ventricle", arguments, expected);
    }
    #[cfg(not(feature = "gpu"))]
    refuse("ventricle", &["--engine", "gpu"], "--features gpu");
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--push", "101"], "from 0 to 100"),
        (&["--links", "2"], "write a whole number from 3 to 60"),
        (&["--out", "film.png", "--mesh", "nowhere.stl"], "ends in .png"),
    ] {
        refuse("rapier_ventricle", arguments, expected);
    }
    assert!(!place("bar.jpg").exists() && !place("film.png").exists());
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--margin", "-1"], "at least 0"),
        (&["--margin", "3"], "does not keep 3 mm at its base"),
        (&["--plans", "0"], "write a whole number from 1 to 10000"),
    ] {
        refuse("plan", arguments, expected);
    }
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", sheet], "name one with --base"),
        (&["--margin", "-1"], "at least 0"),
        (&["--between", "far"], "write a length"),
        (&["--steps", "0"], "write a whole number from 1 to 100000"),
        (&["--out", "bar.jpg", "--mesh", "nowhere.stl"], "ends in .jpg"),
    ] {
        refuse("two_robots", arguments, expected);
    }
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--margin", "-1"], "at least 0"),
        (&["--shapes", "0"], "write a whole number of at least 1"),
        (&["--links", "0"], "write a whole number from 1 to 1000"),
    ] {
        refuse("design", arguments, expected);
    }
    #[cfg(not(feature = "gpu"))]
    refuse("design", &["--engine", "gpu"], "--features gpu");
    for name in ["design", "ventricle", "rapier_ventricle", "plan", "two_robots"] {
        assert!(succeed(name, &["--help"]).contains("--mesh"));
    }
}

#[test]
fn programs_draw_their_pictures() {
    let room = room("room.obj");
    let arguments = [
        "--mesh",
        &room,
        "--model",
        "capsule",
        "--tolerance",
        "0.2",
        "--steps",
        "3",
        "--out",
        "drawn",
    ];
    let out = succeed("ventricle", &arguments);
    assert!(out.contains("12 triangles, 3 steps: search and exhaustive engine agree"), "{out}");
    assert!(out.contains("that took ") && out.contains(" pieces: the shortest is "), "{out}");
    for line in
        ["parry distance(Cylinder, TriMesh)", "search, first time", "search, again", "exhaustive"]
    {
        assert!(out.contains(line), "{out}");
    }
    let arguments = ["--mesh", &room, "--beside", "6", "--steps", "2", "--out", "drawn/two.png"];
    let out = succeed("two_robots", &arguments);
    assert!(
        out.contains("step  clear  least slack") && out.contains("robot against robot"),
        "{out}"
    );
    succeed("figure7", &["--out", "drawn/seven.png"]);
    for name in ["drawn/ventricle.png", "drawn/two.png", "drawn/seven.png"] {
        assert!(colours(name) > 1000, "{name} has {} colours", colours(name));
    }
}

#[test]
fn a_way_is_planned_proven_and_drawn() {
    let out = succeed(
        "plan",
        &[
            ["--plans", "1"],
            ["--margin", "0.3"],
            ["--picture", "planned/way.png"],
            ["--clearance", "planned/clearance.png"],
        ]
        .concat(),
    );
    let rows: Vec<_> = ["proof", "steps of 0.5 mm", "steps of 0.1 mm"]
        .into_iter()
        .map(|name| {
            let row = out
                .lines()
                .find_map(|line| line.strip_prefix(name))
                .unwrap_or_else(|| panic!("{name}: {out}"));
            let numbers: Vec<f64> =
                row.split_whitespace().filter_map(|cell| cell.parse().ok()).collect();
            // Drawn, clear, edges, accepted, shapes an edge, two shares, time, touch, failed.
            assert_eq!(numbers.len(), 10, "{row}");
            assert!(
                numbers[0] > numbers[1] && numbers[1] > 0.0 && numbers[2] > numbers[3],
                "{row}"
            );
            assert!(numbers[4] >= 1.0 && (numbers[5] + numbers[6] - 100.0).abs() < 2.0, "{row}");
            numbers
        })
        .collect();
    // No proven edge touches, no plan failed, and fine steps look at more shapes.
    assert!(rows[0][8] == 0.0 && rows.iter().all(|row| row[9] == 0.0), "{out}");
    assert!(rows[2][4] > 2.0 * rows[1][4] && rows[2][4] > rows[0][4], "{out}");
    assert!(out.contains("it keeps 0.3 mm, which"), "{out}");
    assert!(
        out.contains("it also keeps 1 mm from the vein, and 0.3 mm from the endoscope"),
        "{out}"
    );
    assert!(colours("planned/way.png") > 1000);
    // No step comes nearer than the proven bound.
    let line = out
        .lines()
        .find(|line| line.starts_with("no shape of the way"))
        .unwrap_or_else(|| panic!("{out}"));
    let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [proven, _, seen] = numbers[..] else { panic!("{line}") };
    assert!(0.29 <= proven && proven <= seen, "{line}");
    assert!(colours("planned/clearance.png") > 10);
}

#[test]
fn the_robot_is_pushed_recorded_and_filmed() {
    let _ = std::fs::remove_dir_all(place("pushed"));
    let out = succeed(
        "rapier_ventricle",
        &["--links", "5", "--push", "0.5", "--frames", "1", "--out", "pushed"],
    );
    let steps: usize = out.split(" steps: ").next().unwrap().parse().unwrap();
    let rows = |name: &str| -> Vec<Vec<f64>> {
        let numbers =
            |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<f64>>();
        let rows: Vec<_> = read(name).lines().skip(1).map(numbers).collect();
        assert!(rows.iter().flatten().all(|number| number.is_finite()), "{name}");
        rows
    };
    let whole = rows("pushed/steps.csv");
    assert!(steps > 1000 && whole.len() == steps, "{} rows: {out}", whole.len());
    // step, time, out, pushed, links, clearance, closest link, links held, force, and two
    // deviations.
    assert!(
        whole
            .iter()
            .enumerate()
            .all(|(place, row)| row.len() == 11 && row[0] == (place + 1) as f64)
    );
    assert!(whole.is_sorted_by_key(|row| row[2]) && whole.is_sorted_by_key(|row| row[3]));
    let last = &whole[steps - 1];
    assert!(last[2] > 20.0 && last[3] == 0.5 && last[4] == 5.0, "{last:?}");
    let links = rows("pushed/links.csv");
    assert_eq!(links.len() as f64, whole.iter().map(|row| row[4]).sum::<f64>());
    for (row, of_links) in whole.iter().zip(links.chunk_by(|a, b| a[0] == b[0])) {
        let nearest = of_links.iter().map(|link| link[2]).fold(f64::INFINITY, f64::min);
        assert!(row[0] == of_links[0][0] && row[5] == nearest && nearest > 0.0, "{row:?}");
    }
    let pictures: Vec<_> = std::fs::read_dir(place("pushed"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    let frames =
        pictures.iter().filter(|name| name.to_str().unwrap().starts_with("frame_")).count();
    assert!((1..=2).contains(&frames), "{pictures:?}");
    for name in ["pushed/sheet.png", "pushed/frame_000.png"] {
        assert!(colours(name) > 1000, "{name} has {} colours", colours(name));
    }
}

#[test]
fn designs_are_compared() {
    let room = room("designed.obj");
    let out = succeed("design", &["--mesh", &room, "--shapes", "3000", "--margin", "2"]);
    let rows: Vec<_> = out.lines().filter(|line| line.contains("cm3 |")).collect();
    assert_eq!(rows.len(), 4, "{out}");
    for row in rows {
        // Numbers of a row: lengths, radii, the share, the volume, the speed.
        let numbers: Vec<f64> =
            row.split([' ', ',']).filter_map(|word| word.parse().ok()).collect();
        let [share, volume] = [numbers[6], numbers[7]];
        assert!((1.0..100.0).contains(&share) && (0.1..30.0).contains(&volume), "{row}");
    }
}

#[test]
fn a_report_holds_all_digits_of_its_query() {
    let out = succeed("report", &[]);
    let (_, distances) = out.trim().split_once(": ").unwrap_or_else(|| panic!("{out}"));
    let distances: Vec<_> =
        distances.split(", ").filter_map(|part| part.split(' ').next()).collect();
    assert!(distances.len() == 2 && distances[0] == distances[1], "{out}");
    assert!((2.0..10.0).contains(&distances[0].parse().unwrap()), "{out}");
}
