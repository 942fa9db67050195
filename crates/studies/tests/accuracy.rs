//! What docs/ACCURACY.md says of this crate is what this crate computes.

use continuum_demo::levels::levels;
use continuum_studies::accuracy::measure::{Measured, Measurement, measure, problems, range};
use continuum_studies::accuracy::{EACH, LARGEST, certificates, engines, reference, tables};
use continuum_studies::{long_table, quote};
use continuum_testing::distance_cases;

/// A file of the repository.
fn read(path: &str) -> String {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The part of the page between two marks.
fn written(mark: &str) -> String {
    let page = read("docs/ACCURACY.md");
    quote::between(&page, mark).expect("the page's marks").to_owned()
}

/// The kernels are scalar IEEE arithmetic, so the numbers agree to the last digit on any machine.
/// An error that grew is a fault, one that shrank is news: either way the tables are to be written
/// again, and looked at.
fn assert_same(written: &str, measured: &str) {
    let differs =
        written.lines().zip(measured.lines()).find(|(written, measured)| written != measured);
    if let Some((written, measured)) = differs {
        panic!(
            "the docs say\n{written}\nbut measured is\n{measured}\n\
             `cargo run --release -p continuum-studies --bin accuracy` writes the tables again"
        );
    }
    assert_eq!(written.lines().count(), measured.lines().count());
}

#[test]
fn the_written_errors_are_the_measured_ones() {
    let cases = distance_cases();
    assert_same(&written("millimetres"), &reference::in_millimetres(&cases));
    assert_same(&written("ours"), &reference::table(&cases));
    let file = read("docs/accuracy_cases.csv");
    let (head, file) = file.split_once('\n').expect("a head");
    assert_eq!(head, reference::HEAD);
    // Only parry's cells, the last two, may differ.
    let ours = |line: &str| line.rsplitn(3, ',').last().unwrap_or_default().to_owned();
    let written: Vec<_> = file.lines().map(ours).collect();
    let measured: Vec<_> =
        reference::lines(&cases, |_| "-,-".into()).iter().map(|line| ours(line)).collect();
    assert_same(&written.join("\n"), &measured.join("\n"));
    assert!(measured.len() > 150, "every kind and category has a row");
}

#[test]
fn the_written_gaps_of_certificates_are_the_measured_ones() {
    let measured = certificates::measure(&distance_cases(), &problems::<f64>(EACH));
    assert_same(&written("certificates"), &measured.table());
    let measured = measured.lines();
    assert_same(&read("docs/accuracy_certificates.csv"), &measured);
    for link in ["barrel", "round cap", "flat cap", "rim"] {
        for mesh in ["vertex", "edge", "interior"] {
            assert!(measured.contains(&format!("\n{mesh},{link},")), "{mesh}, {link}: {measured}");
        }
    }
}

/// Of each line of the file: scalar cells as they are, the cells of an instruction set of this
/// machine as upper bounds.
fn assert_lines(written: &[&str], measurement: &Measurement) {
    let measured = tables::lines(measurement, |_, _| "-,-".into());
    assert_eq!(written.len(), measured.len());
    for (written, measured) in written.iter().zip(&measured) {
        let [written_cells, cells] =
            [*written, measured].map(|line| line.split(',').collect::<Vec<_>>());
        assert_eq!(
            written_cells[..6],
            cells[..6],
            "docs/accuracy.csv says\n{written}\nbut measured is\n{measured}"
        );
        for (bound, cell) in written_cells.iter().zip(&cells).skip(6).take(2 * tables::LEVELS.len())
        {
            if let (Ok(bound), Ok(cell)) = (bound.parse::<f64>(), cell.parse::<f64>()) {
                assert!(
                    cell <= bound,
                    "docs/accuracy.csv says\n{written}\nbut measured is\n{measured}"
                );
                assert!(bound <= 16.0, "{written}");
            }
        }
        assert!(
            cells[5] == "-" || cells[5].parse::<f64>().is_ok_and(|worst| worst <= 16.0),
            "{measured}"
        );
    }
}

/// The largest error in a table of the extremes, in double and in single precision.
fn worst(table: &str) -> [f64; 2] {
    let rows = table.lines().map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    let errors = |from_end: usize| {
        rows.clone().filter_map(move |cells| {
            cells.get(cells.len().checked_sub(from_end)?)?.parse::<f64>().ok()
        })
    };
    [5, 2].map(|column| errors(column).fold(0.0, f64::max))
}

fn measured<T: Measured>() -> Measurement {
    measure(&problems::<T>(EACH), &levels())
}

#[test]
fn the_written_extremes_are_the_measured_ones() {
    let (double, single) = (measured::<f64>(), measured::<f32>());
    let ranges = [range::<f64>(LARGEST[0]), range::<f32>(LARGEST[1])];
    assert_same(&written("extremes"), &tables::tables(&double, &single, ranges));
    let page = written("extremes");
    let (categories, pairs) = page.split_once("\nBy pair").expect("two tables");
    for (file, shown, table) in [
        ("categories", categories, tables::by_category(&double, &single)),
        ("pairs", pairs, tables::by_pair(&double, &single)),
    ] {
        assert_same(&read(&format!("docs/accuracy_{file}.csv")), &long_table::csv(&table));
        assert_eq!(worst(shown), worst(&table), "the page shows the worst of all {file}");
    }
    assert_same(&read("docs/accuracy_powers.csv"), &tables::powers(&double, &single));
    let file = read("docs/accuracy.csv");
    let file: Vec<_> = file.lines().collect();
    assert_eq!(file[0], tables::head());
    let (double_lines, single_lines) = file[1..].split_at((file.len() - 1) / 2);
    assert_lines(double_lines, &double);
    assert_lines(single_lines, &single);
}

#[test]
fn every_engine_is_exact_at_the_extremes() {
    let errors = engines::measure(&problems::<f64>(4), &levels());
    assert!(errors.len() > 2 * levels().len());
    for (engine, errors) in errors {
        let worst = errors.iter().copied().fold(0.0, f64::max);
        println!("{engine}: {worst:.2} in {}", errors.len());
        assert!(errors.len() > 100 && worst <= 16.0, "{engine}: {worst} of {}", errors.len());
    }
}

#[test]
fn the_readme_quotes_the_worst_errors() {
    let written = read("docs/ACCURACY.md");
    let all =
        written.lines().find(|line| line.starts_with("| **all** |")).expect("the row of all cases");
    let cells: Vec<_> = all.split('|').map(str::trim).collect();
    let readme = read("README.md");
    let readme = readme.split_whitespace().collect::<Vec<_>>().join(" ");
    for (cell, precision) in [(4, "double"), (7, "single")] {
        let quote = format!("{} u x extent in {precision} precision", cells[cell]);
        assert!(readme.contains(&quote), "README.md should say: {quote}");
    }
}

/// On the GPU that the table was measured on its cells are upper bounds; on any other the promise
/// is 16.
#[cfg(feature = "gpu")]
#[test]
fn the_kernels_of_the_gpu_keep_to_the_written_errors() {
    use continuum_studies::accuracy;
    use continuum_testing::gpu::{PRECISIONS, open};

    let file = read("docs/accuracy_gpu.csv");
    let (head, file) = file.split_once('\n').expect("a head");
    assert_eq!(head, accuracy::gpu::HEAD);
    let mut measured = Vec::new();
    let mut adapter = None;
    for ((_, precision), name) in PRECISIONS.into_iter().zip(["f32", "f64"]) {
        let Some(gpu) = open(precision) else { continue };
        adapter = Some(gpu.adapter().to_string());
        let found = match name {
            "f32" => accuracy::gpu::measure(gpu, &problems::<f32>(EACH)),
            _ => accuracy::gpu::measure(gpu, &problems::<f64>(EACH)),
        };
        measured.extend(accuracy::gpu::lines(name, &found.expect("a GPU that works")));
    }
    let Some(adapter) = adapter else { return };
    let is_the_written_one = written("gpu").contains(&adapter);
    println!("{adapter}{}", if is_the_written_one { ", as written" } else { "" });
    for line in measured {
        let (place, worst) = line.rsplit_once(',').expect("cells");
        let worst: f64 = worst.parse().unwrap_or(0.0);
        assert!(worst <= 16.0, "{line}");
        // Up to the number of problems.
        let place = place.rsplit_once(',').expect("a cell").0;
        let written = file.lines().find(|written| written.starts_with(place));
        let bound = written.and_then(|written| written.rsplit_once(',')?.1.parse::<f64>().ok());
        if let (true, Some(bound)) = (is_the_written_one, bound) {
            assert!(worst <= bound, "docs/accuracy_gpu.csv says {bound}, but measured is\n{line}");
        }
    }
}
