//! Every link in the repository's pages to another of its files leads somewhere.

use std::fs;
use std::path::{Path, PathBuf};

/// The pages under a directory, but not those of builds and tools.
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
    links.filter_map(|rest| rest.split_once(')')).map(|(target, _)| target.to_owned()).collect()
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
