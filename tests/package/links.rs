//! Every link in the repository's pages to another of its files leads somewhere.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The pages under a directory, except pages of builds and tools.
fn pages(directory: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            if !["target", ".git", "out", "corpus", "node_modules"].contains(&name.as_str()) {
                pages(&path, found);
            }
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
}

/// The targets of a page's links and pictures, those in code left out.
fn targets(text: &str) -> Vec<String> {
    let prose = text.split("```").step_by(2);
    let links = prose.flat_map(|part| part.split("](").skip(1));
    let inline = links.filter_map(|rest| rest.split_once(')')).map(|(target, _)| target.to_owned());
    inline.chain(definitions(text).into_values()).collect()
}

/// What the names in brackets lead to, as the lines say that begin with one. Markdown takes no
/// notice of capitals.
fn definitions(text: &str) -> BTreeMap<String, String> {
    let rows = text.lines().filter_map(|line| line.strip_prefix('[')?.split_once("]: "));
    rows.map(|(label, target)| (label.to_lowercase(), target.to_owned())).collect()
}

#[test]
fn links_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut all = Vec::new();
    pages(root, &mut all);
    let mut count = 0;
    for page in &all {
        for target in targets(&fs::read_to_string(page).unwrap()) {
            let file = target.split('#').next().unwrap_or_default();
            // The web, the same page, and names that rustdoc resolves.
            let is_elsewhere = file.contains("://") || file.is_empty() || file.contains("::");
            if !is_elsewhere {
                let place = page.parent().unwrap().join(file);
                assert!(place.exists(), "{}: {target} is not there", page.display());
                count += 1;
            }
        }
    }
    assert!(all.len() > 10 && count > 30, "{count} links in {} pages", all.len());
}

/// A chapter's names in brackets lead to files where it is read as a page, and to the reference
/// where it is a part of that: there the rows of `src/book_links.md` come first, and count.
#[test]
fn chapters_link_to_the_reference_too() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let in_reference = definitions(&fs::read_to_string(root.join("src/book_links.md")).unwrap());
    assert!(in_reference.len() > 50);
    let mut used = BTreeSet::new();
    let mut chapters = Vec::new();
    pages(&root.join("docs/book"), &mut chapters);
    for chapter in chapters {
        let text = fs::read_to_string(&chapter).unwrap();
        for label in definitions(&text).into_keys() {
            // Its own row is one.
            let uses = text.to_lowercase().matches(&format!("[{label}]")).count();
            assert!(uses > 1, "{}: [{label}] is used nowhere", chapter.display());
            let is_known = in_reference.contains_key(&label);
            assert!(is_known, "{}: [{label}] has no row in src/book_links.md", chapter.display());
            used.insert(label);
        }
    }
    let unused: Vec<_> = in_reference.keys().filter(|label| !used.contains(*label)).collect();
    assert!(unused.is_empty(), "src/book_links.md has rows that no chapter uses: {unused:?}");
}
