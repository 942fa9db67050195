//! Imports run one way: a room imports only what ARCHITECTURE.md's table of rooms says that it
//! stands on.

use super::sources::{Source, sources, words};
use std::collections::BTreeMap;
use std::fs;

/// The rooms that each room may import: itself, the rooms below it, and the rooms below them.
fn rooms(page: &str) -> BTreeMap<String, Vec<String>> {
    let mut rooms = BTreeMap::<String, Vec<String>>::new();
    for row in page.lines().filter_map(|line| line.strip_prefix("| `src/")) {
        let mut cells = row.split('|');
        let room = words(cells.next().unwrap_or_default()).next().unwrap_or_default().to_owned();
        let mut below = vec![room.clone()];
        for stands_on in words(cells.next().unwrap_or_default()) {
            // The table begins at the bottom, so that there is no circle.
            let more = rooms
                .get(stands_on)
                .unwrap_or_else(|| panic!("`{room}` stands on {stands_on}, which is above it"));
            below.extend(more.iter().cloned());
        }
        rooms.insert(room, below);
    }
    rooms
}

/// What a file names of the crate, each as the first name behind the crate's root.
fn imports(source: &Source) -> Vec<String> {
    let mut module: Vec<_> =
        source.path.trim_start_matches("src/").trim_end_matches(".rs").split('/').collect();
    if module.last() == Some(&"mod") {
        module.pop();
    }
    let mut found = Vec::new();
    let starts = source.code.match_indices("crate::").chain(source.code.match_indices("super::"));
    for (place, word) in starts {
        let is_within = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
        if source.code[..place].ends_with(is_within) {
            continue;
        }
        let (mut depth, mut rest) = (0, &source.code[place + word.len()..]);
        if word == "super::" {
            depth = module.len() - 1;
            while let Some(more) = rest.strip_prefix("super::") {
                (depth, rest) = (depth.saturating_sub(1), more);
            }
        }
        if depth > 0 {
            found.push(module[0].to_owned());
        } else {
            found.extend(first_names(rest));
        }
    }
    found
}

/// The first name of a path, or of each path in braces.
fn first_names(rest: &str) -> Vec<String> {
    let name = |path: &str| words(path).next().unwrap_or_default().to_owned();
    let Some(group) = rest.strip_prefix('{') else { return vec![name(rest)] };
    let (mut depth, mut begin, mut names) = (0, 0, Vec::new());
    for (place, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                names.push(name(&group[begin..place]));
                begin = place + 1;
            }
            _ => {}
        }
        if c == '}' && begin == place + 1 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// What of a file's imports its room does not stand on. The files beside the rooms are the crate's
/// face, and may show anything.
fn upward(source: &Source, rooms: &BTreeMap<String, Vec<String>>) -> Vec<String> {
    let Some((room, _)) = source.path.trim_start_matches("src/").split_once('/') else {
        return Vec::new();
    };
    let below = rooms
        .get(room)
        .unwrap_or_else(|| panic!("{}: ARCHITECTURE.md has no such room", source.path));
    imports(source).into_iter().filter(|name| !below.contains(name)).collect()
}

#[test]
fn no_room_imports_what_is_above_it() {
    let rooms = rooms(&fs::read_to_string("ARCHITECTURE.md").unwrap());
    assert!(rooms.len() >= 12, "{rooms:?}");
    let mut count = 0;
    for source in sources() {
        count += imports(&source).len();
        let upward = upward(&source, &rooms);
        assert!(
            upward.is_empty(),
            "{} imports {upward:?}, on which its room does not stand",
            source.path
        );
    }
    assert!(count > 500, "{count} imports");
}

#[test]
fn upward_imports_are_found() {
    let page = "| `src/low` | | |\n| `src/middle` | low | |\n| `src/high` | middle | |\n";
    let found = |path: &str, code: &str| {
        upward(&Source { path: path.to_owned(), code: code.to_owned() }, &rooms(page))
    };
    for code in [
        "use crate::low::A;",
        "use super::b::B;",
        "use crate::{low::{A, B}, middle};",
        "use super::super::middle::C;",
    ] {
        assert_eq!(found("src/middle/a/c.rs", code), [""; 0], "{code}");
    }
    for code in [
        "use crate::high::A;",
        "fn a() -> crate::high::A {}",
        "use crate::{low::{A, B}, high};",
        "use crate::{high::{A, B}, low};",
        "use super::super::super::high::A;",
        "pub(in crate::high) fn a() {}",
    ] {
        assert_eq!(found("src/middle/a/c.rs", code), ["high"], "{code}");
    }
    // What is shown to users is no room.
    assert_eq!(found("src/low/mod.rs", "use crate::A;"), ["A"]);
    assert_eq!(found("src/low/mod.rs", "use super::middle::A;"), ["middle"]);
    assert_eq!(found("src/lib.rs", "use crate::high::A;"), [""; 0]);
}
