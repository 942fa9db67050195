//! The names that the crate shows stand in docs/internals/public_names.txt: none comes or goes unnoticed.

use std::collections::BTreeSet;
use std::fs;

/// The modules whose names are listed, by file.
const MODULES: [(&str, &str); 4] = [
    ("parry_continuum", "src/lib.rs"),
    ("parry_continuum::distance", "src/distance/mod.rs"),
    ("parry_continuum::gpu", "src/gpu/mod.rs"),
    ("parry_continuum::proximity", "src/proximity.rs"),
];

/// What a module's file shows: its public modules, items and re-exports, hidden ones left out.
fn names(text: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut is_hidden = false;
    let joined = text.replace("{\n", "{").replace(",\n}", "}").replace(",\n    ", ", ");
    for item in joined.lines() {
        if let Some(item) = item.strip_prefix("pub ") {
            let (kind, rest) = item.split_once(' ').unwrap_or((item, ""));
            let last = rest.trim_end_matches(';').rsplit("::").next().unwrap_or_default();
            let last = last.split_once(" as ").map_or(last, |(_, name)| name);
            let shown = match kind {
                "use" => last.trim_matches(['{', '}', ' ']),
                _ => rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default(),
            };
            if !is_hidden {
                names.extend(
                    shown.split(',').map(|name| name.trim().to_owned()).filter(|name| !name.is_empty()),
                );
            }
            is_hidden = false;
        } else {
            is_hidden = is_hidden || item.starts_with("#[doc(hidden)]");
            is_hidden = is_hidden && (item.is_empty() || item.starts_with("#["));
        }
    }
    names
}

#[test]
fn the_listing_is_complete() {
    let listing: String = MODULES
        .iter()
        .map(|(module, file)| {
            let text = fs::read_to_string(file).unwrap();
            names(&text).iter().map(|name| format!("{module}::{name}\n")).collect::<String>()
        })
        .collect();
    assert!(listing.lines().count() > 40, "{listing}");
    let expected = fs::read_to_string("docs/internals/public_names.txt").unwrap_or_default();
    assert_eq!(
        listing, expected,
        "the names that are shown; if it is meant, docs/internals/public_names.txt gets them"
    );
}
