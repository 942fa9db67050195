//! Every public name has an example or a page. docs/internals/public_api.txt lists the names, and
//! `.ci/public-api` compares it with the compiler's list.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// The texts of a folder's files with one of the endings.
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

/// A public item that is no part of a trait's implementation.
struct Item {
    path: String,
    is_function: bool,
    /// Whether it is a function of a type that takes no `self`, and so is called by the type's
    /// name.
    is_constructor: bool,
}

impl Item {
    fn name(&self) -> &str {
        self.path.rsplit("::").next().unwrap()
    }

    /// Whether a text uses it or leads to it.
    fn is_in(&self, text: &str, words: &BTreeSet<&str>) -> bool {
        let name = self.name();
        if !self.is_function {
            return words.contains(name);
        }
        let owner = self.path.rsplit("::").nth(1).unwrap();
        let links = [format!("`{name}`"), format!("::{name}`")];
        let calls = if self.is_constructor {
            vec![
                format!("{owner}::{name}"),
                format!("{owner}::<f32>::{name}"),
                format!("{owner}::<f64>::{name}"),
            ]
        } else {
            vec![format!(".{name}("), format!(" {name}("), format!("({name}("), format!("!{name}(")]
        };
        calls.iter().any(|call| text.contains(call))
            || !self.is_constructor && links.iter().any(|link| text.contains(link))
    }
}

/// The public items, in the order of the list.
fn items() -> Vec<Item> {
    let listing = read("docs/internals/public_api.txt");
    let mut is_implementation = false;
    let mut items = Vec::new();
    for line in listing.lines() {
        if line.starts_with("impl") {
            is_implementation = line.contains(" for ");
        } else if ["pub struct", "pub enum", "pub trait", "pub mod", "pub macro"]
            .iter()
            .any(|start| line.trim_start_matches("#[non_exhaustive] ").starts_with(start))
        {
            is_implementation = false;
        }
        if is_implementation || !line.contains("pub ") {
            continue;
        }
        let Some((head, rest)) = line.split_once("parry_continuum") else { continue };
        // Without what a type is of: `Vec3<T>::dot`.
        let path: String = rest.split(['<', '>']).step_by(2).take(2).collect();
        let path = &path[..path
            .find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':')
            .unwrap_or(path.len())];
        let path = format!("parry_continuum{}", path.trim_end_matches(':'));
        let is_function = head.contains("fn ");
        let owner = path.rsplit("::").nth(1).unwrap_or_default();
        let of_type = owner.starts_with(char::is_uppercase);
        let takes_self = rest.split_once('(').is_some_and(|(_, arguments)| {
            ["self", "&self", "&mut self", "mut self"].iter().any(|own| arguments.starts_with(own))
        });
        items.push(Item {
            path,
            is_function,
            is_constructor: is_function && of_type && !takes_self,
        });
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

/// The code of the examples in a text's documentation.
fn examples(text: &str) -> String {
    let mut is_code = false;
    let mut code = String::new();
    for line in text.lines() {
        let line = line.trim_start();
        match line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).map(str::trim_start) {
            Some(line) if line.starts_with("```") => is_code = !is_code,
            Some(line) if is_code => {
                code.push_str(line);
                code.push('\n');
            }
            Some(_) => {}
            None => is_code = false,
        }
    }
    code
}

#[test]
fn every_public_name_has_an_example_or_a_page() {
    let mut pages = Vec::new();
    texts("examples", &[".rs"], &mut pages);
    texts("docs", &[".md"], &mut pages);
    pages.retain(|(path, _)| !path.starts_with("docs/internals"));
    pages.push(("README.md".to_owned(), read("README.md")));
    let mut sources = Vec::new();
    texts("src", &[".rs"], &mut sources);
    pages.extend(sources.into_iter().map(|(path, text)| (path, examples(&text))));
    let text: String = pages.into_iter().map(|(_, text)| text + "\n").collect();
    let words: BTreeSet<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();

    let items = items();
    let functions = items.iter().filter(|item| item.is_function).count();
    let constructors = items.iter().filter(|item| item.is_constructor).count();
    assert!(items.len() > 250 && functions > 80 && constructors > 20, "{functions} {constructors}");
    // Of an error there is a line in the book, and its message says what its fields are.
    let unmentioned: Vec<_> = items
        .iter()
        .filter(|item| variant_of_error(&item.path).is_none() && !is_field_of_error(&item.path))
        // A page needs no other.
        .filter(|item| !item.path.starts_with("parry_continuum::book"))
        .filter(|item| !item.is_in(&text, &words))
        .map(|item| &item.path)
        .collect();
    assert!(unmentioned.is_empty(), "neither an example nor a page has these: {unmentioned:#?}");
}

/// One line of the book for each kind of error.
#[test]
fn every_error_is_in_the_book() {
    let page = read("docs/book/errors.md");
    let items = items();
    let variants: BTreeSet<_> =
        items.iter().filter_map(|item| variant_of_error(&item.path)).collect();
    assert!(variants.len() > 40, "{}", variants.len());
    let missing: Vec<_> =
        variants.iter().filter(|name| !page.contains(&format!("| `{name}` |"))).collect();
    assert!(missing.is_empty(), "docs/book/errors.md lacks {missing:?}");
}
