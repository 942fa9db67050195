//! The reading lists of ARCHITECTURE.md: each file calls the next, or, indented, the one that it
//! stands under.

use super::sources::{Source, sources, words};
use std::collections::BTreeMap;
use std::fs;

/// The most files of a reading list.
const MOST: usize = 6;

/// A step of a list: a file, what of it is called, and whether it stands under another.
#[derive(Debug)]
struct Step<'a> {
    file: &'a str,
    item: &'a str,
    is_under: bool,
}

/// The lists of a page by their headings. A step begins `file.rs`, `item`.
fn lists(page: &str) -> BTreeMap<&str, Vec<Step<'_>>> {
    let mut lists = BTreeMap::<_, Vec<_>>::new();
    let mut heading = "";
    for line in page.lines() {
        if let Some(text) = line.strip_prefix("### ") {
            heading = text;
        }
        let is_under = line.starts_with("   - `");
        let is_step =
            is_under || (line.starts_with(|c: char| c.is_ascii_digit()) && line.contains(". `"));
        if is_step {
            let mut code = line.split('`').skip(1).step_by(2);
            let (file, item) = (code.next().unwrap_or_default(), code.next().unwrap_or_default());
            lists.entry(heading).or_default().push(Step { file, item, is_under });
        }
    }
    lists
}

/// Whether a text defines an item of this name.
fn defines(code: &str, item: &str) -> bool {
    let mut words = words(code).peekable();
    while let Some(word) = words.next() {
        let is_definition =
            ["fn", "struct", "enum", "trait", "type", "const", "macro_rules"].contains(&word);
        if is_definition && words.peek() == Some(&item) {
            return true;
        }
    }
    false
}

/// What is wrong with a list.
fn faults(list: &[Step], sources: &[Source]) -> Vec<String> {
    let code = |file: &str| {
        let source = sources.iter().find(|source| source.path.strip_prefix("src/") == Some(file));
        source.map(|source| source.code.as_str())
    };
    let mut faults = Vec::new();
    let mut caller: Option<&Step> = None;
    for step in list {
        let own = code(step.file);
        if !own.is_some_and(|code| defines(code, step.item)) {
            faults.push(format!("{} has no `{}`", step.file, step.item));
        }
        if let Some(caller) = caller {
            let calls =
                code(caller.file).is_some_and(|code| words(code).any(|word| word == step.item));
            if !calls {
                faults.push(format!(
                    "{} does not name `{}` of {}",
                    caller.file, step.item, step.file
                ));
            }
        }
        if !step.is_under {
            caller = Some(step);
        }
    }
    if list.len() > MOST {
        faults.push(format!("{} files are more than {MOST}", list.len()));
    }
    faults
}

#[test]
fn each_file_of_a_reading_list_calls_the_next() {
    let page = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let (lists, sources) = (lists(&page), sources());
    assert!(lists.len() >= 6, "{:?}", lists.keys());
    for (heading, list) in &lists {
        assert!(list.len() >= 3, "{heading}: {list:?}");
        assert_eq!(faults(list, &sources), [""; 0], "{heading}");
    }
}

#[test]
fn faults_of_a_reading_list_are_found() {
    let source = |path: &str, code: &str| Source { path: path.to_owned(), code: code.to_owned() };
    let sources = [
        source("src/a.rs", "fn ask() { search(); help() }"),
        source("src/b.rs", "fn search() { Measure }"),
        source("src/c.rs", "struct Measure;"),
        source("src/d.rs", "fn help() {}"),
    ];
    let faults = |page: &str| faults(&lists(page)["one"], &sources);
    let right = "### one\n1. `a.rs`, `ask`: it\n   - `d.rs`, `help`: it\n2. `b.rs`, `search`\n3. `c.rs`, `Measure`\n";
    assert_eq!(faults(right), [""; 0]);
    assert_eq!(faults(&right.replace("d.rs", "c.rs")), ["c.rs has no `help`"]);
    assert_eq!(
        faults("### one\n1. `a.rs`, `ask`\n2. `c.rs`, `Measure`\n"),
        ["a.rs does not name `Measure` of c.rs"]
    );
    assert_eq!(faults("### one\n1. `a.rs`, `ask`\n2. `e.rs`, `ask`\n"), ["e.rs has no `ask`"]);
    let long = format!("### one\n{}", "1. `b.rs`, `search`\n".repeat(7));
    assert_eq!(faults(&long), ["7 files are more than 6"]);
}
