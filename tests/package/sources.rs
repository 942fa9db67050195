//! The library's sources, for rules about their text.

use std::fs;
use std::path::Path;

/// A file of the library, less comments and what only tests see.
pub struct Source {
    /// Its path from the root of the repository, with `/`.
    pub path: String,
    pub code: String,
}

/// All files of `src` except tests.
pub fn sources() -> Vec<Source> {
    sources_in(&["src"])
}

/// All files in some folders except tests.
pub fn sources_in(folders: &[&str]) -> Vec<Source> {
    let mut found = Vec::new();
    folders.iter().for_each(|folder| visit(folder, &mut found));
    found.sort_by(|a, b| a.path.cmp(&b.path));
    assert!(found.len() > 150, "{}", found.len());
    found
}

fn visit(folder: &str, found: &mut Vec<Source>) {
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = format!("{folder}/{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            visit(&path, found);
        } else if path.ends_with(".rs") && !path.contains("tests") {
            let text = fs::read_to_string(entry.path()).unwrap();
            found.push(Source { path, code: code(&text) });
        }
    }
}

/// A text without comments and modules of tests.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let opens_tests = |next: &&str| next.contains("mod ") && next.ends_with('{');
        let is_of_tests = line.starts_with("#[cfg(") && line.contains("test");
        if is_of_tests && lines.peek().is_some_and(opens_tests) {
            lines.by_ref().find(|line| *line == "}");
        } else if !line.trim_start().starts_with("//") {
            code += line.split_once(" // ").map_or(line, |(code, _)| code);
            code.push('\n');
        }
    }
    code
}

/// The words of a text.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

#[test]
fn comments_and_tests_are_no_code() {
    for tests in ["#[cfg(test)]", "#[cfg(all(test, feature = \"parallel\"))]"] {
        let text = "//! crate::a\nuse crate::b; // crate::c\n#[cfg(test)]\nmod tests {\n    use crate::d;\n}\nuse crate::e;\n";
        assert_eq!(code(&text.replace("#[cfg(test)]", tests)), "use crate::b;\nuse crate::e;\n");
    }
}
