//! The files that the command writes: `--csv`, `--plot` and `--prove`.

use crate::{refuse, run, succeed};
use continuum_programs::{file, pixels, place, read, room};
use std::process::Command;

/// A box of 60, and a needle of two radii: 20 from both ends, 28 and 29 from the sides.
fn needle(name: &str) -> [String; 2] {
    let shape = "x,y,z,radius\n30,30,20,2\n30,30,30,1\n30,30,40\n";
    [room(&format!("{name}_wall.obj")), file(&format!("{name}_shape.csv"), shape)]
}

#[test]
fn a_table_has_a_line_for_each_link() {
    let [wall, shape] = &needle("table");
    let out = succeed(&["--mesh", wall, "--centreline", shape, "--csv", "links.csv"]);
    assert!(out.contains("\nlink 0: 20.000000, "), "{out}");
    let table = read("links.csv");
    let lines: Vec<_> = table.lines().collect();
    let head =
        "link,distance,arc_length,segment,triangle,robot_x,robot_y,robot_z,mesh_x,mesh_y,mesh_z";
    assert!(lines.len() == 3 && lines[0] == head, "{table}");
    assert!(lines[1].starts_with("0,20,0,0,") && lines[2].starts_with("1,20,20,1,"), "{table}");
    assert!(lines.iter().all(|line| line.split(',').count() == 11), "{table}");
    // Many shapes: the table goes to the file, and the summary to the terminal.
    let shapes = "1,30,30,20,2\n1,30,30,40\n7,30,30,10,1\n7,30,30,30\n8,30,30,20,1\n8,nan,30,30\n";
    let shapes = &file("table_shapes.csv", shapes);
    let printed = succeed(&["--mesh", wall, "--shapes", shapes]);
    let out = succeed(&["--mesh", wall, "--shapes", shapes, "--csv", "shapes.csv"]);
    assert_eq!(read("shapes.csv"), printed);
    assert!(out.starts_with("minimum 10.00: shape 7, link 0, 0 from the base, triangle "), "{out}");
    assert_eq!(out.lines().count(), 1);
}

#[test]
fn a_plot_shows_the_clearance_along_the_robot() {
    let [wall, shape] = &needle("plot");
    let asked = ["--mesh", wall, "--centreline", shape, "--plot", "clearance.svg"];
    succeed(&[&asked[..], &["--margin", "12.5"]].concat());
    let plot = read("clearance.svg");
    assert!(plot.starts_with("<svg") && plot.trim_end().ends_with("</svg>"), "{plot}");
    for text in
        ["Margin 12.5 kept; closest to the wall", "20.00", "link 0", "margin 12.5", "clearance"]
    {
        assert!(plot.contains(text), "{text}: {plot}");
    }
    // The curve is the longest line. It is level with the ends of the robot at both ends (20), and
    // highest near the middle of the thin half: 29 from the sides, where the ends are farther.
    let corners = |line: &str| -> Vec<(f64, f64)> {
        let numbers = |pair: &str| {
            let (x, y) = pair.split_once(',').unwrap();
            (x.parse().unwrap(), y.parse().unwrap())
        };
        line.split_whitespace().map(numbers).collect()
    };
    let lines =
        plot.split("points=\"").skip(1).map(|rest| corners(rest.split('"').next().unwrap()));
    let curve = lines.max_by_key(Vec::len).unwrap();
    assert!(curve.len() > 300, "{}", curve.len());
    assert!(curve.is_sorted_by_key(|corner| corner.0));
    let (first, last) = (curve[0], curve[curve.len() - 1]);
    let (high, low) = curve
        .iter()
        .fold((f64::MAX, f64::MIN), |(high, low), corner| (high.min(corner.1), low.max(corner.1)));
    assert!((first.1 - last.1).abs() <= 1.0 && first.1 == low && high < low - 50.0, "{curve:?}");
    // Half of the way: 28 on one side of the step and 29 on the other.
    let middle: Vec<_> = curve
        .iter()
        .filter(|corner| (corner.0 - 0.5 * (first.0 + last.0)).abs() < 30.0)
        .map(|corner| corner.1)
        .collect();
    let scale = (low - high) / 9.0;
    let step = middle.iter().fold(f64::MIN, |low, &y| low.max(y)) - high;
    assert!((step - scale).abs() < 0.35 * scale, "{step} {scale}");
    // The same picture in pixels: both have the line of the margin in orange, the curve in blue.
    succeed(&[
        "--mesh",
        wall,
        "--centreline",
        shape,
        "--margin",
        "12.5",
        "--plot",
        "clearance.PNG",
    ]);
    let (size, pixels) = pixels("clearance.PNG");
    assert_eq!(size, [1800, 960]);
    // The dashes are 8 of 13; the letters of the margin have the same colour.
    let wide = 2 * (last.0 - first.0) as usize;
    for (colour, least, most) in
        [([0, 114, 178], 3 * wide, 6 * wide), ([213, 94, 0], 2 * wide, 4 * wide)]
    {
        let count = pixels.iter().filter(|pixel| **pixel == colour).count();
        assert!((least..most).contains(&count), "{colour:?}: {count}, {wide} wide");
    }
    refuse(
        &["--mesh", wall, "--centreline", shape, "--plot", "clearance.pdf"],
        "write a name that ends in .svg or .png",
    );
}

/// Runs the command that the program printed. `None` without Python, if that is not required.
fn check(command: &str) -> Option<(bool, String)> {
    let words: Vec<_> = command.split(' ').collect();
    assert!(words[0] == "python3" && words.len() == 4, "{command}");
    match Command::new(words[0]).args(&words[1..]).current_dir(place("")).output() {
        Ok(output) => Some((output.status.success(), String::from_utf8(output.stdout).unwrap())),
        Err(error) if std::env::var_os("CI").is_none() => {
            eprintln!("skipped, without python3: {error}");
            None
        }
        Err(error) => panic!("python3: {error}"),
    }
}

/// The command that checks the proof.
fn command(out: &str) -> &str {
    let line = out.lines().find_map(|line| line.strip_prefix("proof: check it with "));
    line.unwrap_or_else(|| panic!("{out}"))
}

#[test]
fn the_checker_accepts_the_proof_by_the_printed_command() {
    let [wall, shape] = &needle("proof");
    let asked = ["--mesh", wall, "--centreline", shape, "--margin", "19.5"];
    for (options, premise) in [
        (&["--prove", "chain.txt"][..], "chain"),
        (&["--prove", "tube.txt", "--tolerance", "0.1"], "tube"),
    ] {
        let out = succeed(&[&asked[..], options].concat());
        assert!(out.contains("\nmargin 19.5: kept"), "{out}");
        let Some((is_yes, said)) = check(command(&out)) else { return };
        assert!(is_yes && said.trim_end().ends_with("\nyes"), "{said}");
        assert!(
            said.starts_with(&format!("This {premise} keeps more than 19.5 from 12 triangles"))
        );
        // The checker reads these files: a proof of a larger margin is refused.
        let altered = read(options[1]).replace("margin 19.5", "margin 20.5");
        file(options[1], &altered);
        let (is_yes, said) = check(command(&out)).unwrap();
        assert!(!is_yes && said.starts_with("no"), "{said}");
    }
}

#[test]
fn a_proof_in_another_folder_and_with_a_pose_is_accepted() {
    let [wall, shape] = &needle("posed");
    let pose = &file("posed.txt", "1 0 0 0\n0 1 0 0\n0 0 1 7.25\n0 0 0 1\n");
    std::fs::create_dir_all(place("proofs")).unwrap();
    let path = place("proofs").join("plan.txt");
    let asked = ["--mesh", wall, "--centreline", shape, "--pose", pose, "--margin", "12"];
    let out = succeed(&[&asked[..], &["--prove", path.to_str().unwrap()]].concat());
    let Some((is_yes, said)) = check(command(&out)) else { return };
    assert!(is_yes && said.contains("27.25"), "{said}");
}

#[test]
fn there_is_no_proof_of_a_margin_that_is_not_kept() {
    let [wall, shape] = &needle("unproven");
    let asked = ["--mesh", wall, "--centreline", shape, "--prove", "unproven.txt"];
    let (status, out, error) = run(&[&asked[..], &["--margin", "20"]].concat());
    assert_eq!((status, error.as_str()), (Some(1), ""));
    assert!(out.contains("\nproof: none, since the margin is not kept\n"), "{out}");
    assert!(!place("unproven.txt").exists() && !place("unproven.obj").exists());
    refuse(&asked, "--margin <LENGTH>");
    let asked = ["--mesh", wall, "--centreline", shape, "--margin", "1", "--prove"];
    refuse(&[&asked[..], &["proof.obj"]].concat(), "such as proof.txt");
}

#[test]
fn no_file_that_is_read_is_replaced() {
    let [wall, shape] = &needle("kept");
    let asked = ["--mesh", wall, "--centreline", shape, "--margin", "1"];
    let before = [wall, shape].map(|path| std::fs::read_to_string(path).unwrap());
    for (options, expected) in [
        (&["--csv", shape][..], "the file of --centreline; choose another name for --csv"),
        (&["--csv", "kept_shape.csv"], "the file of --centreline; choose another name for --csv"),
        (&["--prove", "kept_wall.txt"], "the file of --mesh; choose another name for --prove"),
        (&["--csv", "both.svg", "--plot", "both.svg"], "the file of --plot"),
        (&["--csv", "nowhere/links.csv"], "choose another --csv"),
        (&["--plot", "nowhere/plot.svg"], "choose another --plot"),
        (&["--prove", "nowhere/proof.txt"], "choose another --prove"),
    ] {
        refuse(&[&asked[..], options].concat(), expected);
    }
    assert_eq!([wall, shape].map(|path| std::fs::read_to_string(path).unwrap()), before);
}

/// Header and voxels are two files of one mesh; a hard link is the same file by another name.
#[test]
fn neither_voxels_nor_linked_files_are_replaced() {
    let data =
        |name: &str| format!("{}/../mesh-files/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::create_dir_all(place("")).unwrap();
    for name in ["ball.mhd", "ball.raw"] {
        std::fs::copy(data(name), place(name)).unwrap();
    }
    let nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 1 1 1\n\
                space directions: (20,0,0) (0,20,0) (0,0,20)\nspace units: \"mm\" \"mm\" \"mm\"\n\
                space origin: (0,0,0)\nencoding: ascii\ndata file: voxel.txt\n";
    let (header, voxel) = (file("voxel.nhdr", nrrd), file("voxel.txt", "1\n"));
    let shape = &file("voxel_shape.csv", "30,0,0,1\n40,0,0\n");
    let ball = place("ball.mhd").to_str().unwrap().to_owned();
    let before = std::fs::read(place("ball.raw")).unwrap();
    for (mesh, output) in [(&ball, "ball.raw"), (&header, "voxel.txt"), (&header, "voxel.nhdr")] {
        let asked = ["--mesh", mesh, "--centreline", shape, "--csv", output];
        refuse(&asked, "the file of --mesh; choose another name for --csv");
        succeed(&asked[..4]);
    }
    #[cfg(unix)]
    {
        let link = place("linked.csv");
        let _ = std::fs::remove_file(&link);
        std::fs::hard_link(shape, &link).unwrap();
        let asked = ["--mesh", &ball, "--centreline", shape, "--csv", "linked.csv"];
        refuse(&asked, "the file of --centreline; choose another name for --csv");
        std::fs::remove_file(&link).unwrap();
    }
    assert_eq!(std::fs::read(place("ball.raw")).unwrap(), before);
    assert_eq!(std::fs::read_to_string(voxel).unwrap(), "1\n");
}

/// Names of files may have any bytes but 0. They stay in one line, and the printed command works.
#[cfg(unix)]
#[test]
fn any_name_of_a_file_is_taken() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let [wall, shape] = &needle("named");
    let names =
        [&b"proof\xff.txt"[..], b"line\nend.txt", b"it's one.txt", "pr\u{fc}fung.txt".as_bytes()];
    for name in names {
        let (proof, plot) = (OsStr::from_bytes(name), [name, b".svg"].concat());
        let asked =
            ["--mesh", wall, "--centreline", shape, "--margin", "1", "--prove"].map(OsStr::new);
        let more = [proof, OsStr::new("--plot"), OsStr::from_bytes(&plot)];
        let run =
            Command::new(crate::COMMAND).args(asked).args(more).current_dir(place("")).output();
        let run = run.unwrap();
        let out = String::from_utf8(run.stdout).unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let plot = std::fs::read_to_string(place("").join(OsStr::from_bytes(&plot))).unwrap();
        assert!(plot.starts_with("<svg"));
        assert_eq!(out.lines().filter(|line| !line.contains(": ")).count(), 0, "{out}");
        let bash = Command::new("bash").args(["-c", command(&out)]).current_dir(place("")).output();
        match bash {
            Ok(checked) => {
                let said = String::from_utf8_lossy(&checked.stdout).into_owned();
                assert!(said.ends_with("\nyes\n"), "{said}{out}");
            }
            Err(error) if std::env::var_os("CI").is_none() => eprintln!("skipped: {error}"),
            Err(error) => panic!("bash: {error}"),
        }
    }
    // An error about such a file is one line.
    let broken = file("broken\nname.csv", "30,zero,20\n");
    refuse(&["--mesh", wall, "--centreline", &broken], "broken\\nname.csv");
    refuse(&["--mesh", "no\nwall.obj", "--centreline", shape], "no\\nwall.obj");
    refuse(&["--mesh", wall, "--centreline", shape, "--plot", "no\nplot.pdf"], "ends in .svg");
}
