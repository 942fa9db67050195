//! What programs write into the README: the text between two marks.

use std::fs;
use std::path::Path;

/// Puts `text` between `<!-- mark -->` and `<!-- /mark -->` of the README beside the directory `docs`, if there is one
/// that has these marks.
///
/// # Errors
/// The README cannot be written.
pub fn in_readme(text: &str, mark: &str, docs: &Path) -> Result<(), String> {
    let path = docs.join("../README.md");
    let Ok(readme) = fs::read_to_string(&path) else { return Ok(()) };
    let (begin, end) = (format!("<!-- {mark} -->\n"), format!("<!-- /{mark} -->"));
    let Some((before, rest)) = readme.split_once(&begin) else { return Ok(()) };
    let Some((_, after)) = rest.split_once(&end) else { return Ok(()) };
    fs::write(&path, format!("{before}{begin}{text}{end}{after}"))
        .map_err(|error| format!("cannot write {} ({error})", path.display()))
}
