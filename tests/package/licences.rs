//! Every crate that the library builds on may be used under MIT or Apache-2.0 terms. Asks cargo alone, without a network.

use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::process::Command;

/// Licences that ask for no more than MIT or Apache-2.0 do.
const GOOD: [&str; 9] =
    ["MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "ISC", "0BSD", "CC0-1.0", "Unicode-3.0"];

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
    for bad in ["GPL-3.0", "MIT AND GPL-3.0", "LGPL-2.1 OR MPL-2.0", "(MIT OR Apache-2.0) AND GPL-2.0", ""] {
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
    // What this very test was built from: nothing else need be at hand.
    let version = cargo(&["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let mut arguments = vec!["metadata", "--offline", "--format-version", "1", "--filter-platform", host];
    for (feature, is_on) in FEATURES {
        if is_on {
            arguments.extend(["--features", feature]);
        }
    }
    let metadata: Value = serde_json::from_str(&cargo(&arguments)).unwrap();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let packages: HashMap<_, _> =
        list(&metadata["packages"]).into_iter().map(|package| (text(&package["id"]), package)).collect();
    let nodes: HashMap<_, _> =
        list(&metadata["resolve"]["nodes"]).into_iter().map(|node| (text(&node["id"]), node)).collect();

    // From what this repository publishes along everything but what only tests and examples need.
    let is_published = |package: &&Value| package["source"].is_null() && package["publish"].is_null();
    let mut next: Vec<_> =
        packages.values().filter(is_published).map(|package| text(&package["id"])).collect();
    assert!(next.len() >= 2 && next.contains(&text(&metadata["resolve"]["root"])), "{next:?}");
    let mut seen = HashSet::new();
    while let Some(id) = next.pop() {
        if !seen.insert(id.clone()) {
            continue;
        }
        let (package, node) = (&packages[&id], &nodes[&id]);
        let (name, licence) = (text(&package["name"]), text(&package["license"]));
        assert!(is_good(&licence), "{name} is licensed under '{licence}'");
        for dependency in list(&node["deps"]) {
            if list(&dependency["dep_kinds"]).iter().any(|kind| kind["kind"] != "dev") {
                next.push(text(&dependency["pkg"]));
            }
        }
    }
    assert!(seen.len() > 20, "only {} crates", seen.len());
}
