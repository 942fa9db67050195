//! No files need one another in a circle: of any two, one can be read, tested and moved without the
//! other. A crate's root names all its files, so what the root needs does not count.

use super::sources::{Source, sources_in, words};
use std::collections::{BTreeMap, BTreeSet};

/// The folders with crates.
const FOLDERS: [&str; 4] = ["src", "crates", "examples", "web"];

/// The files of a crate.
#[derive(Default)]
struct Crate<'a> {
    /// By the path of their modules, joined by `::`.
    files: BTreeMap<String, File<'a>>,
}

/// What a file names.
struct File<'a> {
    path: &'a str,
    /// The last names of all `use` declarations, with their paths.
    imports: BTreeMap<String, Vec<String>>,
    /// The paths that its code needs. A name that is only exported again is not among them.
    needs: Vec<Vec<String>>,
}

impl<'a> File<'a> {
    fn new(source: &'a Source) -> Self {
        let (mut imports, mut needs, mut exports) = (BTreeMap::new(), Vec::new(), Vec::new());
        let mut code = String::new();
        let mut lines = source.code.lines();
        while let Some(line) = lines.next() {
            let is_public = line.trim_start().starts_with("pub");
            let Some((_, tree)) = line.split_once("use ").filter(|(before, _)| is_head(before))
            else {
                code += line;
                code.push('\n');
                continue;
            };
            let mut tree = tree.to_owned();
            while !tree.contains(';') {
                tree += lines.next().expect("a declaration ends");
            }
            for path in expanded(&tree) {
                if let Some(name) = path.last() {
                    imports.insert(name.clone(), path.clone());
                }
                if is_public { exports.push(path) } else { needs.push(path) }
            }
        }
        needs.extend(paths(&code));
        let declares =
            |line: &&str| line.trim_start().trim_start_matches("pub ").starts_with("mod ");
        let used: BTreeSet<_> =
            code.lines().filter(|line| !declares(line)).flat_map(words).collect();
        needs.extend(
            exports
                .into_iter()
                .filter(|path| path.last().is_some_and(|name| used.contains(name.as_str()))),
        );
        Self { path: &source.path, imports, needs }
    }
}

/// Whether a line may have this in front of `use`.
fn is_head(before: &str) -> bool {
    let before = before.trim();
    before.is_empty() || before == "pub" || (before.starts_with("pub(") && before.ends_with(')'))
}

/// The paths in code that have more than one name. A path in a text, such as an attribute's for a
/// form that is written and read, is none.
fn paths(code: &str) -> Vec<Vec<String>> {
    let is_within = |c: char| c.is_alphanumeric() || c == '_' || c == ':' || c == '"';
    code.split(|c| !is_within(c))
        .filter(|path| path.contains("::") && !path.starts_with([':', '"']))
        .map(|path| words(path).map(str::to_owned).collect())
        .collect()
}

/// The paths of a tree of imports, each with the name that it has in its own file.
fn expanded(tree: &str) -> Vec<Vec<String>> {
    let tree = tree.trim().trim_end_matches(';');
    let Some((before, group)) = tree.split_once('{') else {
        let path = tree.split_once(" as ").map_or(tree, |(path, _)| path);
        return vec![words(path).filter(|name| *name != "self").map(str::to_owned).collect()];
    };
    let before: Vec<_> = words(before).map(str::to_owned).collect();
    let (mut depth, mut begin, mut found) = (1, 0, Vec::new());
    for (place, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if (depth == 1 && c == ',') || (depth == 0 && c == '}') {
            let part = group[begin..place].trim();
            if !part.is_empty() {
                found.extend(expanded(part).into_iter().map(|path| [&before[..], &path].concat()));
            }
            begin = place + 1;
        }
    }
    found
}

impl Crate<'_> {
    /// The module that a path begins at, and the names that follow; `None` for another crate.
    fn absolute(&self, module: &str, path: &[String]) -> Option<Vec<String>> {
        let names = |module: &str| words(module).map(str::to_owned).collect::<Vec<_>>();
        let mut base = names(module);
        let mut rest = path;
        match rest.first()?.as_str() {
            "crate" => return Some(rest[1..].to_vec()),
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            _ => {
                let child = [&base[..], &rest[..1]].concat().join("::");
                self.files.get(&child)?;
            }
        }
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The module whose file defines what a path names.
    fn definition(&self, module: &str, path: &[String], depth: usize) -> Option<String> {
        let names = self.absolute(module, path)?;
        let length = (0..=names.len())
            .rev()
            .find(|length| self.files.contains_key(&names[..*length].join("::")))?;
        let found = names[..length].join("::");
        let imported = names.get(length).and_then(|name| self.files[&found].imports.get(name));
        match imported {
            Some(path) if depth < 8 => {
                let path = [path, &names[length + 1..]].concat();
                self.definition(&found, &path, depth + 1)
            }
            _ => Some(found),
        }
    }

    /// The modules whose files a module's file needs; none for the root.
    fn needs(&self, module: &str) -> BTreeSet<String> {
        if module.is_empty() {
            return BTreeSet::new();
        }
        let needs = self.files[module].needs.iter();
        let found = needs.filter_map(|path| self.definition(module, path, 0));
        found.filter(|found| found != module).collect()
    }

    /// The files that need one another, in the order of the circle.
    fn circle(&self) -> Option<Vec<&str>> {
        let needs: BTreeMap<_, _> =
            self.files.keys().map(|module| (module.as_str(), self.needs(module))).collect();
        let mut needs = needs;
        // What needs nothing that is left is in no circle.
        loop {
            let done: Vec<_> =
                needs.iter().filter(|(_, all)| all.is_empty()).map(|(module, _)| *module).collect();
            if done.is_empty() {
                break;
            }
            for module in done {
                needs.remove(module);
                for all in needs.values_mut() {
                    all.remove(module);
                }
            }
        }
        let mut way = vec![*needs.keys().next()?];
        loop {
            let next = needs[way[way.len() - 1]].first()?;
            let next = *needs.get_key_value(next.as_str())?.0;
            if let Some(first) = way.iter().position(|module| *module == next) {
                return Some(way[first..].iter().map(|module| self.files[*module].path).collect());
            }
            way.push(next);
        }
    }
}

/// The crates in a list of files: the root of each is in the innermost folder that has one.
fn crates(sources: &[Source]) -> Vec<Crate<'_>> {
    let root = |folder: &str| {
        let has =
            |name: &str| sources.iter().any(|source| source.path == format!("{folder}/{name}"));
        ["lib.rs", "main.rs"].into_iter().find(|name| has(name))
    };
    let mut crates = BTreeMap::<&str, Crate<'_>>::new();
    for source in sources {
        let folders = source.path.match_indices('/').map(|(place, _)| &source.path[..place]);
        let Some((folder, root)) =
            folders.rev().find_map(|folder| root(folder).map(|root| (folder, root)))
        else {
            continue;
        };
        let within = &source.path[folder.len() + 1..];
        let module = if within == root { "" } else { within.trim_end_matches(".rs") };
        let module = module.trim_end_matches("/mod").replace('/', "::");
        crates.entry(folder).or_default().files.insert(module, File::new(source));
    }
    crates.into_values().collect()
}

#[test]
fn files_need_one_another_in_no_circle() {
    let sources = sources_in(&FOLDERS);
    let crates = crates(&sources);
    assert!(crates.len() > 10, "{}", crates.len());
    let needs =
        crates.iter().flat_map(|one| one.files.keys().map(|module| one.needs(module).len()));
    let needs: usize = needs.sum();
    assert!(needs > 1500, "{needs}");
    let circles: Vec<_> = crates.iter().filter_map(Crate::circle).collect();
    assert!(circles.is_empty(), "{circles:#?}");
}

#[test]
fn circles_are_found() {
    let circle = |files: &[(&str, &str)]| {
        let sources: Vec<_> = files
            .iter()
            .map(|(path, code)| Source { path: format!("src/{path}"), code: format!("{code}\n") })
            .collect();
        crates(&sources)[0].circle().map(|circle| circle.join(" "))
    };
    let root = ("lib.rs", "mod a;\npub use a::{A, b::B};");
    let found = Some("src/a/b.rs src/a/c.rs".to_owned());
    for (b, c) in [
        ("use super::c::C;", "use super::b::B;"),
        ("use crate::a::{c::{self, C}, d};", "fn c() -> super::b::B {}"),
        ("use super::C;", "use crate::B;"),
    ] {
        let module = ("a/mod.rs", "mod b;\nmod c;\npub(crate) use c::C;");
        assert_eq!(circle(&[root, module, ("a/b.rs", b), ("a/c.rs", c)]), found, "{b} {c}");
        assert_eq!(circle(&[root, module, ("a/b.rs", b), ("a/c.rs", "use other::B;")]), None);
    }
    // A module that exports what its file does not use does not need it.
    let b = ("a/b.rs", "use super::A;");
    assert_eq!(circle(&[root, ("a/mod.rs", "mod b;\npub use b::B;\nstruct A;"), b]), None);
    let parent = ("a/mod.rs", "mod b;\npub use b::B;\nstruct A(B);");
    assert_eq!(circle(&[root, parent, b]), Some("src/a/mod.rs src/a/b.rs".to_owned()));
}
