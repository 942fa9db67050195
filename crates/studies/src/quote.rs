//! What programs write between two marks of a page: `<!-- mark -->` and `<!-- /mark -->`.

use std::fs;
use std::path::Path;

/// What a page says before, between and after its marks; None where it has no such marks.
fn parted<'a>(page: &'a str, mark: &str) -> Option<[&'a str; 3]> {
    let begin = format!("<!-- {mark} -->\n");
    let from = page.find(&begin)? + begin.len();
    let to = from + page[from..].find(&format!("<!-- /{mark} -->"))?;
    Some([&page[..from], &page[from..to], &page[to..]])
}

/// What stands between two marks of a page.
pub fn between<'a>(page: &'a str, mark: &str) -> Option<&'a str> {
    parted(page, mark).map(|[_, between, _]| between)
}

/// What is written alone needs its place in a page.
///
/// # Errors
/// The page has no such marks.
pub fn check_chapter(mark: &str, path: &Path) -> Result<(), String> {
    if fs::read_to_string(path).is_ok_and(|page| between(&page, mark).is_some()) {
        Ok(())
    } else {
        Err(format!("{} has no such chapter; write it whole, without --only", path.display()))
    }
}

/// Puts `text` between two marks of the README beside the directory `docs`, if there is one
/// that has these marks.
///
/// # Errors
/// The README cannot be written.
pub fn in_readme(text: &str, mark: &str, docs: &Path) -> Result<(), String> {
    in_page(text, mark, &docs.join("../README.md"))
}

/// Puts `text` between two marks of a page, if there is one that has these marks.
///
/// # Errors
/// The page cannot be written.
pub fn in_page(text: &str, mark: &str, path: &Path) -> Result<(), String> {
    let Ok(page) = fs::read_to_string(path) else { return Ok(()) };
    let Some([before, _, after]) = parted(&page, mark) else { return Ok(()) };
    fs::write(path, format!("{before}{text}{after}"))
        .map_err(|error| format!("cannot write {} ({error})", path.display()))
}
