//! Every name that the library shows leads somewhere: it has an example or a page. The names are those of
//! docs/internals/public_api.txt, which `.ci/public-api` compares with what the compiler says.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The texts of a folder's files with one of these endings.
fn texts(folder: &str, endings: &[&str], found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap() {
        let entry = entry.unwrap();
        let path = format!("{folder}/{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            texts(&path, endings, found);
        } else if endings.iter().any(|ending| path.ends_with(ending)) {
            found.push((path.clone(), read(&path)));
        }
    }
}

/// The public items that are no part of a trait's implementation, by path.
fn items() -> Vec<String> {
    let listing = read("docs/internals/public_api.txt");
    let mut is_implementation = false;
    let mut items = Vec::new();
    for line in listing.lines() {
        if line.starts_with("impl") {
            is_implementation = line.contains(" for ");
        } else if ["pub struct", "pub enum", "pub trait", "pub mod", "pub macro"]
            .iter()
            .any(|start| line.starts_with(start))
        {
            is_implementation = false;
        }
        if is_implementation {
            continue;
        }
        let path = line.split_whitespace().find(|word| word.starts_with("parry_continuum"));
        if let Some(path) = path.filter(|_| line.starts_with("pub")) {
            let end = path.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':').unwrap_or(path.len());
            items.push(path[..end].trim_end_matches(':').to_owned());
        }
    }
    items
}

/// The variant's name, if the path is that of a variant of an error.
fn variant_of_error(item: &str) -> Option<&str> {
    let (path, name) = item.rsplit_once("::")?;
    (path.ends_with("Error") && name.starts_with(char::is_uppercase)).then_some(name)
}

/// Whether the path is that of a field of such a variant.
fn is_field_of_error(item: &str) -> bool {
    item.rsplit_once("::").is_some_and(|(path, _)| variant_of_error(path).is_some())
}

#[test]
fn every_public_name_has_an_example_or_a_page() {
    let mut pages = Vec::new();
    texts("examples", &[".rs"], &mut pages);
    texts("docs", &[".md"], &mut pages);
    pages.retain(|(path, _)| !path.starts_with("docs/internals"));
    pages.push(("README.md".to_owned(), read("README.md")));
    // The documentation of one item may lead to another.
    let mut sources = Vec::new();
    texts("src", &[".rs"], &mut sources);
    for (_, text) in &mut sources {
        let is_doc =
            |line: &&str| line.trim_start().starts_with("///") || line.trim_start().starts_with("//!");
        *text = text.lines().filter(is_doc).collect::<Vec<_>>().join("\n");
    }
    pages.extend(sources);
    let words: BTreeSet<&str> =
        pages.iter().flat_map(|(_, text)| text.split(|c: char| !c.is_alphanumeric() && c != '_')).collect();

    let items = items();
    assert!(items.len() > 250, "{}", items.len());
    // The fields of an error's variants are what its message says.
    let unmentioned: Vec<_> = items
        .iter()
        .filter(|item| !is_field_of_error(item))
        .filter(|item| !words.contains(item.rsplit("::").next().unwrap()))
        .collect();
    assert!(unmentioned.is_empty(), "neither an example nor a page has these: {unmentioned:#?}");
}

/// One line of the book for each kind of error.
#[test]
fn every_error_is_in_the_book() {
    let page = read("docs/book/errors.md");
    let items = items();
    let variants: BTreeSet<_> = items.iter().filter_map(|item| variant_of_error(item)).collect();
    assert!(variants.len() > 40, "{}", variants.len());
    let missing: Vec<_> = variants.iter().filter(|name| !page.contains(&format!("| `{name}` |"))).collect();
    assert!(missing.is_empty(), "docs/book/errors.md lacks {missing:?}");
}
