//! The programs that measure and write pages, each rehearsed: what they write is whole, and its
//! numbers are numbers. Times are not judged.

use continuum_programs::*;

const ACCURACY: &str = env!("CARGO_BIN_EXE_accuracy");
const CURVES: &str = env!("CARGO_BIN_EXE_curves");
const OWN_PARTS: &str = env!("CARGO_BIN_EXE_own_parts");
const SPEED: &str = env!("CARGO_BIN_EXE_speed");
const STUDIES: &str = env!("CARGO_BIN_EXE_studies");
const TRADEOFF: &str = env!("CARGO_BIN_EXE_tradeoff");

/// A page with marks, and what becomes of it.
fn page_with(name: &str, mark: &str) {
    file(name, &format!("before\n<!-- {mark} -->\nstale\n<!-- /{mark} -->\nafter\n"));
}

fn assert_quoted(name: &str, mark: &str, begins: &str) {
    let page = read(name);
    let begins = format!("before\n<!-- {mark} -->\n{begins}");
    assert!(page.starts_with(&begins) && !page.contains("stale"), "{page}");
    assert!(page.ends_with(&format!("\n<!-- /{mark} -->\nafter\n")), "{page}");
    assert_finite(&page);
}

#[test]
fn the_trade_is_measured_drawn_and_quoted() {
    let hall = room("hall.obj");
    page_with("trade/docs/book/trade.md", "tradeoff");
    let place = ["--mesh", &hall, "--base", "30,30,30", "--axis", "0,0,1"];
    let small = ["--shapes", "12", "--timed", "2", "--edges", "4", "--out", "trade/docs"];
    succeed(TRADEOFF, &[&place[..], &small].concat());

    let page = read("trade/docs/TRADEOFF.md");
    let shown = page.split("## The trade").nth(1).unwrap().split("![").next().unwrap();
    let trade = read("trade/docs/tradeoff_links.csv");
    for model in [
        "capsules",
        "cylinders",
        "fitted caps",
        "parry's Capsule",
        "parry's Cylinder",
        "7 spheres a link",
        "tube",
    ] {
        // The page shows one tolerance, the file all.
        assert_eq!(trade.matches(&format!("\n{model},")).count(), 7, "{model}: {trade}");
        assert_eq!(shown.matches(&format!("\n| {model} | ")).count(), 1, "{model}: {shown}");
        assert!(shown.contains(&format!("\n| {model} | 0.1 mm |")), "{model}: {shown}");
    }
    for (head, file, shown, all) in [
        ("| triangles | shapes | tolerance |", "samples", 8, 16),
        ("| model | within | margin |", "decisions", 7, 30),
    ] {
        let file = read(&format!("trade/docs/tradeoff_{file}.csv"));
        assert_eq!((table(&page, head).len(), file.lines().count()), (shown, 1 + all), "{file}");
        assert_finite(&file);
    }
    for text in [
        "of the 12 shapes do not touch the wall",
        "95 % confidence (Wilson)",
        "GJK alone",
        "torsion, same angles at the base",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }
    assert_finite(&page);
    let motions = table(&page, "| tip moves |");
    let of: Vec<_> = motions.iter().map(|row| &*row[0]).collect();
    assert_eq!(of, ["1 mm", "2 mm", "5 mm", "10 mm"]);
    // This chapter alone, with other edges: nothing else changes.
    succeed(
        TRADEOFF,
        &[&place[..], &["--only", "motions", "--edges", "2", "--out", "trade/docs"]].concat(),
    );
    let again = read("trade/docs/TRADEOFF.md");
    let parts = |page: &str| -> Vec<String> { page.split(" -->\n").map(str::to_owned).collect() };
    let (before, after) = (parts(&page), parts(&again));
    assert!(
        before.len() == 3
            && before[0] == after[0]
            && before[2] == after[2]
            && before[1] != after[1]
    );
    assert!(after[1].contains(" 2 of each length"), "{again}");
    refuse(TRADEOFF, &["--only", "motions", "--out", "trade/nowhere"], "has no such chapter");
    // Marks of parry's two shapes and of the tube at seven tolerances each, and in the legend; a
    // label for each row of the front.
    let picture = read("trade/docs/tradeoff.svg");
    for colour in ["#0072B2", "#56B4E9", "#D55E00"] {
        let marks = picture.matches(&format!("<polygon opacity=\"1\" fill=\"{colour}\"")).count();
        assert_eq!(marks, 7 + 1, "{colour}: {picture}");
    }
    let front = table(&page, "| time | worst error | model |");
    assert_eq!(picture.matches(" within ").count(), front.len(), "{picture}");
    // The picture again, from the table: the same series.
    succeed(TRADEOFF, &["--only", "picture", "--out", "trade/docs"]);
    let again = read("trade/docs/tradeoff.svg");
    let marks = |svg: &str| svg.matches("<polygon").count();
    let labels = |svg: &str| svg.matches(" within ").count();
    assert_eq!(marks(&again) - labels(&again), marks(&picture) - labels(&picture), "{again}");
    assert_quoted("trade/docs/book/trade.md", "tradeoff", "**Take a `Tube`");
    assert_eq!(table(&read("trade/docs/book/trade.md"), "| error | free shape: `Tube` |").len(), 4);

    let wall = file("wall.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
    let arguments = [
        "--mesh",
        &wall,
        "--base",
        "0,0,0",
        "--axis",
        "0,0,1",
        "--shapes",
        "10",
        "--out",
        "trade/none",
    ];
    let (status, _, error) = run(TRADEOFF, &arguments);
    // In one line, after the stage.
    let last = error.lines().last().unwrap_or_default();
    assert!(status != Some(0) && last.contains("every shape touches the wall"), "{error}");
}

/// A percentage.
fn percent(text: &str) -> f64 {
    text.trim().strip_suffix(" %").unwrap_or_else(|| panic!("{text}")).parse().unwrap()
}

#[test]
fn speed_is_measured_drawn_and_quoted() {
    page_with("speed/README.md", "speed");
    let arguments = ["--largest", "1", "--enough", "0", "--out", "speed/docs"];
    assert_eq!(succeed(SPEED, &arguments), "speed/docs/SPEED.md\n");
    let page = read("speed/docs/SPEED.md");
    assert_finite(&page);
    assert!(page.contains(
        "`cargo run --release -p continuum-studies --bin speed -- --largest 1 --enough 0 --out speed/docs`"
    ));

    for head in
        ["| wall | triangles | all links: parry |", "| wall | triangles | nodes, first time |"]
    {
        let rows = table(&page, head);
        let of: Vec<_> = rows.iter().map(|row| (&*row[0], &*row[1])).collect();
        assert_eq!(of, [("near", "5120"), ("far", "5120")], "{head}");
    }
    let planner = table(&page, "| scene | triangles | touching |");
    let of: Vec<_> = planner.iter().map(|row| &*row[0]).collect();
    assert_eq!(of, ["ventricle", "cavity", "vessel"]);
    for row in &planner {
        let [touching, free] = [2, 6].map(|column| row[column].parse::<u32>().unwrap());
        assert!(touching > 100 && free > 100 && touching + free == 10_000, "{row:?}");
    }
    assert_eq!(table(&page, "| scene | triangles | one thread |").len(), 3);
    assert!(page.contains("6,000 triangles divided in four once"), "{page}");
    let latency = table(&page, "| query | triangles | ticks |");
    let queries: Vec<_> = latency.iter().map(|row| &*row[0]).collect();
    assert_eq!(queries, ["`minimum`", "`clears`", "`per_link`", "`contacts_within`"]);
    for row in &latency {
        // The median, what one tick in a thousand exceeds, and the largest; alone, then after other
        // work.
        let micros: Vec<f64> = row[2..].iter().map(|cell| cell.parse().unwrap()).collect();
        for times in micros.chunks(4) {
            assert!(times[0] >= 20.0 && times[1..].is_sorted() && times[1] > 0.0, "{row:?}");
        }
    }
    let rare = table(&page, "| query | triangles | touching |");
    assert_eq!(
        rare.iter().map(|row| &*row[0]).collect::<Vec<_>>(),
        ["`clears`", "`minimum`", "`contacts_within`"]
    );
    for row in &rare {
        // The number of touching shapes; median, one in a thousand, worst, worst over median; then
        // the same for free shapes.
        let numbers: Vec<f64> = row[2..].iter().map(|cell| cell.parse().unwrap()).collect();
        assert!(
            numbers[0] > 20.0 && numbers[5] > 20.0 && numbers[0] + numbers[5] == 1000.0,
            "{row:?}"
        );
        assert!(
            numbers[1..4].is_sorted() && numbers[6..9].is_sorted() && numbers[1] > 0.0,
            "{row:?}"
        );
    }
    assert_eq!(table(&page, "| order | precision | culling |").len(), 8);
    let shares = table(&page, "| order | precision | capsules |");
    assert_eq!(shares.len(), 4);
    for model in shares.iter().flat_map(|row| &row[2..]) {
        let (axes, measured) = model.split_once(',').unwrap();
        let (axes, measured) = (percent(axes), percent(measured));
        assert!(measured > 0.0 && axes > measured && axes < 50.0, "{shares:?}");
    }
    assert!(!table(&page, "| instruction set |").is_empty());
    let head = page.lines().find(|line| line.starts_with("| microseconds |")).unwrap();
    let growth = table(&page, head);
    let names: Vec<_> = growth.iter().map(|row| &*row[0]).collect();
    for (model, engines) in ["capsules", "fitted caps", "cylinders"].iter().zip(names.chunks(3)) {
        let expected = ["exhaustive f32", "exhaustive f64", "search, warm start"];
        assert_eq!(engines, expected.map(|engine| format!("{model}, {engine}")));
    }
    let sizes: Vec<u32> =
        head.split(" | ").skip(1).map(|n| n.trim_matches([' ', '|']).parse().unwrap()).collect();
    assert!(sizes.len() == 2 && sizes[1] == 4 * sizes[0], "{head}");
    assert_eq!(table(&page, "| triangles | refit and search |").len(), 1);
    assert_eq!(table(&page, "| engine | bytes |").len(), 3);
    let goals = read("speed/docs/internals/speed_goals.md");
    assert_finite(&goals);
    assert!(table(&goals, "| job | goal | measured | met |").len() > 5);
    let quoted = read("speed/README.md");
    assert_eq!(table(&quoted, "| wall | triangles | all links: parry |").len(), 1);
    assert!(
        quoted.contains("`clears` takes ") && quoted.contains(" times less than parry's"),
        "{quoted}"
    );

    // Three lines, each with its name; axes are black too.
    let plot = read("speed/docs/speed.svg");
    for name in ["parry, link by link", "every triangle, f32", "search, warm start"] {
        assert_eq!(plot.matches(name).count(), 1, "{name}: {plot}");
    }
    let lines: Vec<_> = plot.split("<polyline").skip(1).collect();
    for colour in ["#D55E00", "#0072B2"] {
        let count = lines.iter().filter(|line| line.contains(colour)).count();
        assert_eq!(count, 1, "{colour}: {plot}");
    }
    assert_quoted(
        "speed/README.md",
        "speed",
        "Written by `cargo run --release -p continuum-studies --bin speed -- --largest 1",
    );

    for (arguments, expected) in [
        (["--largest", "7"], "from 1 to 6"),
        (["--enough", "-1"], "--help"),
        (["--enough=nan", "--largest=1"], "seconds from 0 to 60"),
    ] {
        refuse(SPEED, &arguments, expected);
    }
}

#[test]
fn curves_are_measured_drawn_and_quoted() {
    let marks = "before\n<!-- curves -->\nstale\n<!-- /curves -->\nafter\n";
    file("curves/docs/book/tube.md", marks);
    let out = succeed(CURVES, &["--robots", "3", "--out", "curves/docs"]);
    let page = read("curves/docs/book/tube.md");
    let (curves, faces) = out.split_at(out.find("| tube of radius 1 |").expect("a second table"));
    // The book shows some rows, each as the whole page has it.
    let (before, shown) = page.split_once("<!-- curves -->\n").expect("a mark");
    let (shown, after) = shown.split_once("<!-- /curves -->").expect("a mark");
    assert_eq!((before, after), ("before\n", "\nafter\n"));
    assert!(shown.lines().count() == 2 + 9 && shown.lines().all(|row| curves.contains(row)));
    assert_finite(&page);
    let whole = read("curves/docs/CURVES.md");
    assert!(whole.contains(curves) && whole.ends_with(faces), "{whole}");
    let rows = table(&whole, "| 100 samples unless said otherwise | tube |");
    let fits: Vec<_> = rows.iter().filter(|row| row[1].starts_with("`fit`")).collect();
    assert!(rows.len() > 60 && fits.len() > 30, "{page}");
    assert!(fits.iter().all(|row| row[3] == "3" && row[4] == "3"), "{page}");
    // One line for all noises of `fit`, and one for each of three noises without it.
    let picture = read("curves/docs/curves.svg");
    for name in
        ["fit, noise up to 0.5 mm", "from_samples, noise 0.01 mm", "noise 0.03 mm", "noise 0.1 mm"]
    {
        assert!(picture.contains(name), "{name}: {picture}");
    }
}

#[test]
fn rules_of_own_parts_are_counted_and_quoted() {
    file(
        "own/docs/book/robots.md",
        "before\n<!-- own_parts -->\nstale\n<!-- /own_parts -->\nafter\n",
    );
    let out = succeed(OWN_PARTS, &["--shapes", "40", "--out", "own/docs"]);
    let page = read("own/docs/book/robots.md");
    assert_eq!(page, format!("before\n<!-- own_parts -->\n{out}<!-- /own_parts -->\nafter\n"));
    let rows = table(&page, "| robot | margin, mm |");
    assert_eq!(rows.len(), 9, "{page}");
    // All shapes are counted, some are near themselves, and this crate's rule misses none of them.
    let number = |row: &[String], column: usize| row[column].parse::<u32>().expect("a number");
    assert!(
        rows.iter().all(|row| number(row, 2) + number(row, 3) + number(row, 4) == 40),
        "{page}"
    );
    assert!(rows.iter().map(|row| number(row, 2)).sum::<u32>() > 20, "{page}");
    assert!(rows.iter().all(|row| number(row, 5) == 0), "{page}");
    // Two bends have no local minimum; all three robots have a distance by arc length.
    let picture = read("own/docs/self.svg");
    assert_eq!(picture.matches("local minima: none").count(), 2, "{picture}");
    assert_eq!(picture.matches("by arc length: ").count(), 3, "{picture}");
    assert!(!picture.contains("by arc length: none"), "{picture}");
}

#[test]
fn the_studies_are_made_and_one_is_made_again() {
    let small =
        ["--problems", "400", "--queries", "20", "--triangles", "1000", "--polynomials", "200"];
    let _ = std::fs::remove_dir_all(place("studies"));
    let out = ["--out", "studies"];
    assert_eq!(succeed(STUDIES, &[&small[..], &out].concat()), "studies/studies.md\n");
    let page = read("studies/studies.md");
    assert_finite(&page);

    let routes = table(&page, "| route | f32: worst |");
    assert_eq!((routes.len(), read("studies/studies_discs.csv").lines().count()), (10, 1 + 13));
    // Answers with more than 8 units of error, in single and in double precision: none by the
    // default.
    assert_eq!([&*routes[0][0], &*routes[0][2], &*routes[0][6]], ["convex, Halley", "0", "0"]);
    for printed in &routes[1..5] {
        assert!(
            printed[0].starts_with("(18) as printed") && percent(&printed[3]) > 0.0,
            "{printed:?}"
        );
    }
    let tables: Vec<_> = page.split("\n## Table I").collect();
    for chapter in ["I: segment to segment", "II: point to triangle"] {
        let chapter = tables.iter().find(|text| text.starts_with(chapter)).unwrap();
        assert_eq!(table(chapter, "| precision | queries | clamped |").len(), 4);
    }
    let growth = table(&page, "| precision | model | pairs and discs | 1000 |");
    assert_eq!(
        (growth.len(), table(&page, "| precision | model | pairs and discs | s |").len()),
        (8, 8)
    );
    let engines = read("studies/studies_engines.csv");
    assert_eq!(
        (engines.lines().count(), read("studies/studies_index.csv").lines().count()),
        (1 + 16, 1 + 16)
    );
    for row in engines.lines().skip(1).filter(|row| !row.contains("(18)")) {
        // A loop in single precision may find another triangle that is as near as it can tell.
        let is_rounded = row.starts_with("f32") && row.contains("one by one");
        let limit = if is_rounded { 1e-4 } else { 1e-10 };
        let error = row.rsplit(',').next().unwrap();
        assert!(error.parse::<f64>().unwrap() < limit, "an error in mm: {row:?}");
    }
    assert_eq!(table(&page, "| degree | finder |").len(), 10);
    let finders = read("studies/studies_roots.csv");
    assert_eq!(finders.lines().count(), 1 + 24);
    for row in finders.lines().skip(1) {
        let cells: Vec<_> = row.split(',').collect();
        assert!(
            [4, 7].iter().all(|found| cells[*found] == "all" || percent(cells[*found]) > 90.0),
            "{row}"
        );
    }

    let again = ["--only", "polynomials", "--polynomials", "20"];
    succeed(STUDIES, &[&again[..], &out].concat());
    let (chapters, polynomials) = page.split_once("## Table V").unwrap();
    let after = read("studies/studies.md");
    let (chapters_after, polynomials_after) = after.split_once("## Table V").unwrap();
    let eigenvalues = table(&page, "| coefficients | degree | ours us |");
    assert_eq!(eigenvalues.len(), 10);
    assert!(
        eigenvalues.iter().all(|row| row[3] == "all" || percent(&row[3]) > 80.0),
        "{eigenvalues:?}"
    );
    assert_eq!(chapters, chapters_after);
    assert!(
        polynomials.contains("\n200 polynomials") && polynomials_after.contains("\n20 polynomials")
    );

    for (arguments, expected) in [
        (["--problems", "19"], "at least 20"),
        (["--only", "roots"], "discs, branching, engines, polynomials, schur"),
    ] {
        refuse(STUDIES, &arguments, expected);
    }
}

#[test]
fn accuracy_is_measured_and_drawn() {
    succeed(ACCURACY, &["--out", "accuracy"]);
    let page = read("accuracy/ACCURACY.md");
    for table in ["ours", "extremes", "certificates", "gpu"] {
        assert!(page.contains(&format!("<!-- {table} -->\n")), "{table}: {page}");
    }
    for (file, least) in [
        ("accuracy.csv", 2 * 18 * 11),
        ("accuracy_cases.csv", 150),
        ("accuracy_categories.csv", 18),
        ("accuracy_pairs.csv", 11),
        ("accuracy_powers.csv", 16),
        ("accuracy_certificates.csv", 13),
        ("accuracy_parry.csv", 18),
    ] {
        let lines = read(&format!("accuracy/{file}"));
        assert!(lines.lines().count() > least, "{file}: {lines}");
        assert_finite(&lines);
    }
    assert!(colours("accuracy/correctness.png") > 10);
}
