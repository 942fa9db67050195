//! Every crate that the library builds on may be used under MIT or Apache-2.0 terms. Asks cargo,
//! without a network.

use serde_json::Value;
use std::collections::HashSet;
use std::process::Command;

/// Licences with at most the conditions of MIT or Apache-2.0.
const GOOD: [&str; 9] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Zlib",
    "ISC",
    "0BSD",
    "CC0-1.0",
    "Unicode-3.0",
];

/// Whether some choice that the expression offers is good: every part of an AND, any part of an OR.
fn is_good(expression: &str) -> bool {
    let expression = expression.replace('/', " OR ");
    let plain = |part: &str| {
        let name = part.trim().trim_matches(['(', ')']);
        GOOD.contains(&name) || name == "Apache-2.0 WITH LLVM-exception"
    };
    // Parentheses are around alternatives only, so an AND separates what must all be good.
    expression.split(" AND ").all(|all| all.split(" OR ").any(plain))
}

#[test]
fn expressions_are_understood() {
    for good in [
        "MIT",
        "MIT OR Apache-2.0",
        "Apache-2.0/MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "GPL-3.0 OR MIT",
    ] {
        assert!(is_good(good), "{good}");
    }
    for bad in
        ["GPL-3.0", "MIT AND GPL-3.0", "LGPL-2.1 OR MPL-2.0", "(MIT OR Apache-2.0) AND GPL-2.0", ""]
    {
        assert!(!is_good(bad), "{bad}");
    }
}

/// The optional features, and whether this test was built with them.
const FEATURES: [(&str, bool); 4] = [
    ("parallel", cfg!(feature = "parallel")),
    ("gpu", cfg!(feature = "gpu")),
    ("rapier", cfg!(feature = "rapier")),
    ("serde-serialize", cfg!(feature = "serde-serialize")),
];

fn cargo(arguments: &[&str]) -> String {
    let mut cargo = Command::new(env!("CARGO"));
    let output = cargo.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn dependencies_may_be_used_as_this_crate_is() {
    let metadata = cargo(&["metadata", "--offline", "--no-deps", "--format-version", "1"]);
    let metadata: Value = serde_json::from_str(&metadata).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let published: Vec<_> = packages
        .iter()
        .filter(|package| package["publish"].is_null())
        .map(|package| package["name"].as_str().unwrap())
        .collect();
    assert!(published.len() >= 2 && published.contains(&env!("CARGO_PKG_NAME")), "{published:?}");

    // Only packages that this test was built from: cargo has downloaded nothing else on a fresh
    // machine. `cargo tree` lists what such a package needs on this system; cargo's metadata
    // would ask for all systems.
    let format = "{p} | {l}";
    let mut seen = HashSet::new();
    let gpu_is_here = cfg!(feature = "gpu");
    for package in published.into_iter().filter(|package| gpu_is_here || *package != "gpu-batch") {
        let mut arguments =
            vec!["tree", "--offline", "--edges", "normal,build", "--package", package];
        arguments.extend(["--prefix", "none", "--no-dedupe", "--format", format]);
        if package == env!("CARGO_PKG_NAME") {
            let features = FEATURES.into_iter().filter(|(_, is_on)| *is_on);
            arguments.extend(features.flat_map(|(feature, _)| ["--features", feature]));
        }
        for line in cargo(&arguments).lines().filter(|line| !line.is_empty()) {
            let (name, licence) = line.split_once(" | ").unwrap();
            assert!(is_good(licence), "{name} is licensed under '{licence}'");
            seen.insert(name.to_owned());
        }
    }
    assert!(seen.len() > 20, "only {} crates", seen.len());
}
