//! What docs/ACCURACY.md says of this crate is what this crate computes.

#[path = "../examples/scene/accuracy.rs"]
mod accuracy;
mod common;

/// The kernels are scalar IEEE arithmetic, so the numbers agree to the last digit on any machine. An error that
/// grew is a fault, one that shrank is news: either way the tables are to be written again, and looked at.
#[test]
fn the_written_errors_are_the_measured_ones() {
    let written = include_str!("../docs/ACCURACY.md");
    let (_, ours) = written.split_once("<!-- ours -->\n").expect("the start of this crate's tables");
    let (ours, _) = ours.split_once("<!-- /ours -->").expect("the end of this crate's tables");
    let measured = accuracy::tables(&common::distance_cases());
    let differs = ours.lines().zip(measured.lines()).find(|(written, measured)| written != measured);
    if let Some((written, measured)) = differs {
        panic!(
            "docs/ACCURACY.md says\n{written}\nbut measured is\n{measured}\n\
             `cargo run --release --example accuracy` writes the tables again"
        );
    }
    assert_eq!(ours.lines().count(), measured.lines().count());
    assert!(measured.lines().count() > 200, "every kind and category has a row");
}

#[test]
fn the_readme_quotes_the_worst_errors() {
    let written = include_str!("../docs/ACCURACY.md");
    let all = written.lines().find(|line| line.starts_with("| **all** |")).expect("the row of all cases");
    let cells: Vec<_> = all.split('|').map(str::trim).collect();
    let readme = include_str!("../README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    for (cell, precision) in [(4, "double"), (7, "single")] {
        let quote = format!("{} u x extent in {precision} precision", cells[cell]);
        assert!(readme.contains(&quote), "README.md should say: {quote}");
    }
}
