//! A feature adds or leaves out whole items: modules, re-exports, functions, fields and variants.
//! Nothing inside of a function depends on one.

use super::sources::{Source, sources};

/// Returns the attributes of features that stand at something else than an item, a field, a variant
/// or an arm, each with the next line that is no attribute.
fn misplaced(source: &Source) -> Vec<String> {
    let mut lines = source.code.lines();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        let line = line.trim_start();
        if !(line.starts_with("#[cfg(") && line.contains("feature = ")) {
            continue;
        }
        let next = lines.find(|line| !line.trim_start().starts_with("#[")).unwrap_or_default();
        if !is_item(next.trim_start()) {
            found.push(format!("{}: {line} {next}", source.path));
        }
    }
    found
}

/// Whether a line begins an item, a field, a variant or an arm.
fn is_item(line: &str) -> bool {
    let items = [
        "pub ",
        "pub(",
        "use ",
        "mod ",
        "fn ",
        "impl ",
        "impl<",
        "struct ",
        "enum ",
        "trait ",
        "const ",
        "static ",
        "type ",
        "macro_rules! ",
        "Self::",
    ];
    let name = line.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
    let is_field = name.len() < line.len() && name.starts_with(": ") && line.ends_with(',');
    let is_variant = line.starts_with(char::is_uppercase) && line.ends_with("),");
    items.iter().any(|item| line.starts_with(item)) || is_field || is_variant
}

#[test]
fn features_add_whole_items() {
    let sources = sources();
    let with = sources.iter().filter(|source| source.code.contains("feature = \"tubes\""));
    assert!(with.count() > 10);
    let misplaced: Vec<_> = sources.iter().flat_map(misplaced).collect();
    assert!(misplaced.is_empty(), "{misplaced:#?}");
}

#[test]
fn statements_that_depend_on_a_feature_are_found() {
    let count = |line: &str| {
        let code = format!("    #[cfg(feature = \"tubes\")]\n    #[inline]\n    {line}\n");
        misplaced(&Source { path: String::new(), code }).len()
    };
    for item in ["pub(crate) fn a() {}", "mod a;", "a: u32,", "Device(#[from] A),", "use a::B;"] {
        assert_eq!(count(item), 0, "{item}");
    }
    for statement in ["if a {", "let a = 1;", "return 1;", "self.a.forget();", "a.iter()"] {
        assert_eq!(count(statement), 1, "{statement}");
    }
}
