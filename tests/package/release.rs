//! Every file that states the version states the same one, and published packages can be published.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

fn read(file: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

/// What follows `before` on the first line that begins so.
fn stated<'a>(text: &'a str, before: &str) -> &'a str {
    let line = text.lines().find_map(|line| line.strip_prefix(before));
    line.unwrap_or_else(|| panic!("no line begins with {before}")).trim_matches('"')
}

#[test]
fn all_files_state_one_version() {
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(stated(&read("CITATION.cff"), "version: "), version);
    // The workflow of the wheels compares the first such line of both files.
    for file in ["Cargo.toml", "crates/python/Cargo.toml"] {
        assert_eq!(stated(&read(file), "version = "), version, "{file}");
    }
    let changes = read("CHANGELOG.md");
    let (newest, _) = stated(&changes, "## ").split_once(' ').unwrap();
    assert_eq!(newest, version, "the first heading of CHANGELOG.md");
}

#[test]
fn published_packages_are_those_of_the_page() {
    let metadata = ["metadata", "--offline", "--no-deps", "--format-version", "1"];
    let output = Command::new(env!("CARGO")).args(metadata).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    // `publish = false` is an empty list of registries.
    let published: Vec<&Value> =
        packages.iter().filter(|package| package["publish"].is_null()).collect();
    let mut names: Vec<_> =
        published.iter().map(|package| package["name"].as_str().unwrap()).collect();
    names.sort_unstable();
    let line = format!("cargo publish --dry-run -p {}\n", names.join(" -p "));
    assert!(read("RELEASING.md").contains(&line), "RELEASING.md lacks: {line}");
    for package in published {
        assert_eq!(package["version"], env!("CARGO_PKG_VERSION"), "{}", package["name"]);
        for field in ["description", "license", "readme", "rust_version"] {
            assert!(package[field].is_string(), "{} has no {field}", package["name"]);
        }
        assert!(!package["keywords"].as_array().unwrap().is_empty(), "{}", package["name"]);
    }
}
