//! Every call that a page names exists, and the chapter on queries names the call for every
//! question of the module `proximity`. Fenced code is left out: other tests compile and run it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Calls of other libraries that pages name.
const FOREIGN: [&str; 26] = [
    "ccd_enabled",
    "coal::collide",
    "ContactPair::total_impulse",
    "CollisionRequest::security_margin",
    "CollisionResult::getContact",
    "DistanceResult::nearest_points",
    "fcl::Box",
    "fcl::BVHModel",
    "fcl::Capsule",
    "fcl::collide",
    "fcl::continuousCollide",
    "fcl::distance",
    "fcl::InterpMotion",
    "parry::query::distance",
    "query::distance",
    "ActiveCollisionTypes::KINEMATIC_FIXED",
    "contact_softness.natural_frequency",
    "static_contact_softness.natural_frequency",
    "contacts_enabled",
    "manifolds",
    "map_init",
    "num_max_contacts",
    "ray.init",
    "security_margin",
    "solver_manifolds",
    "trimesh.load_mesh",
];

/// Endings of file names: a span such as `Cargo.toml` is no call.
const EXTENSIONS: [&str; 11] =
    ["cff", "csv", "h5", "hpp", "ipynb", "json", "md", "png", "py", "svg", "toml"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap()
}

/// The files of a folder with this ending, without its subfolders unless `deep`.
fn files(folder: &Path, ending: &str, deep: bool, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if deep {
                files(&path, ending, deep, found);
            }
        } else if path.extension().is_some_and(|extension| extension == ending) {
            found.push(path);
        }
    }
}

/// The texts of the files of a folder and its subfolders.
fn sources(folder: &str, ending: &str) -> String {
    let mut found = Vec::new();
    files(&root().join(folder), ending, true, &mut found);
    found.iter().map(|path| fs::read_to_string(path).unwrap() + "\n").collect()
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Removes generic arguments: `Vec3<T>::dot` becomes `Vec3::dot`.
fn without_generics(text: &str) -> String {
    let mut depth = 0_i32;
    let mut kept = String::new();
    let mut before = ' ';
    for c in text.chars() {
        match c {
            '<' => depth += 1,
            // An arrow closes nothing.
            '>' if before != '-' => depth = (depth - 1).max(0),
            '\n' => {
                depth = 0;
                kept.push(c);
            }
            _ if depth == 0 => kept.push(c),
            _ => {}
        }
        before = c;
    }
    kept.replace("::::", "::")
}

fn words(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// `TooFewPoints` becomes `too_few_points`, as in the `kind()` of an error.
fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    for (index, c) in name.chars().enumerate() {
        if c.is_uppercase() && index > 0 {
            snake.push('_');
        }
        snake.extend(c.to_lowercase());
    }
    snake
}

/// The names that a library declares.
struct Library {
    words: BTreeSet<String>,
    items: Items,
}

enum Items {
    /// The compiler's list has whole paths.
    Paths(BTreeSet<[String; 2]>),
    /// Sources declare types and their items apart.
    Types(BTreeSet<String>),
}

impl Library {
    /// By the compiler's list.
    fn listed(text: &str) -> Self {
        let text = without_generics(text);
        let mut words = words(&text);
        let kinds: Vec<_> = words
            .iter()
            .filter(|word| word.starts_with(char::is_uppercase))
            .map(|word| snake_case(word))
            .collect();
        words.extend(kinds);
        let mut paths = BTreeSet::new();
        for path in text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != ':') {
            let names: Vec<_> = path.split("::").collect();
            paths.extend(names.windows(2).map(|pair| [pair[0].to_owned(), pair[1].to_owned()]));
        }
        Self { words, items: Items::Paths(paths) }
    }

    /// By its sources, or by its stubs in Python.
    fn declared(text: &str) -> Self {
        let code: Vec<&str> =
            text.lines().map(str::trim).filter(|line| !line.starts_with("//")).collect();
        let types = code.iter().filter_map(|line| {
            let line = line.trim_start_matches("pub ");
            let mut rest = ["struct ", "enum ", "trait ", "class "].iter();
            let rest = rest.find_map(|start| line.strip_prefix(start))?;
            rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next()
        });
        let types = types.map(str::to_owned).collect();
        Self { words: words(&code.join("\n")), items: Items::Types(types) }
    }

    fn has(&self, owner: Option<&str>, name: &str) -> bool {
        let Some(owner) = owner else { return self.words.contains(name) };
        match &self.items {
            Items::Paths(paths) => paths.contains(&[owner.to_owned(), name.to_owned()]),
            Items::Types(types) => types.contains(owner) && self.words.contains(name),
        }
    }
}

/// The inline code of a page.
fn spans(page: &str) -> Vec<String> {
    let prose: Vec<&str> = page.split("\n```").step_by(2).collect();
    let paragraphs = prose.iter().flat_map(|part| part.split("\n\n"));
    let spans = paragraphs.flat_map(|paragraph| paragraph.split('`').skip(1).step_by(2));
    spans.map(|span| span.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

/// Returns the call that a span names: its type, if any, and its name. `None` if it is no call.
fn call(span: &str) -> Option<(Option<String>, String)> {
    let is_called = span.ends_with(')');
    let path = span.split('(').next()?;
    let path = without_generics(path.trim_start_matches('.'));
    if let Some((owner, name)) = path.rsplit_once("::") {
        let owner = owner.rsplit("::").next()?;
        return (is_name(owner) && is_name(name))
            .then(|| (Some(owner.to_owned()), name.to_owned()));
    }
    let name = path.rsplit('.').next()?;
    let is_path = path.split('.').all(is_name);
    let is_file = name != path && EXTENSIONS.contains(&name);
    let is_method = name != path || is_called || name.contains('_');
    let is_lower = !name.starts_with(char::is_uppercase) || is_called;
    (is_path && !is_file && is_method && is_lower).then(|| (None, name.to_owned()))
}

#[test]
fn every_call_that_a_page_names_exists() {
    let libraries = [
        Library::listed(&read("docs/internals/public_api.txt")),
        Library::declared(&sources("crates/mesh-files/src", "rs")),
        Library::declared(&sources("crates/gpu-batch/src", "rs")),
        Library::declared(
            &(sources("crates/python/python", "pyi") + &sources("crates/python/python", "py")),
        ),
    ];
    let mut pages = Vec::new();
    files(&root().join("docs"), "md", false, &mut pages);
    files(&root().join("docs/book"), "md", true, &mut pages);
    pages.extend(["README.md", "crates/python/README.md"].map(|page| root().join(page)));

    let (mut count, mut missing, mut foreign) = (0, Vec::new(), BTreeSet::from(FOREIGN));
    for page in pages {
        for span in spans(&fs::read_to_string(&page).unwrap()) {
            let Some((owner, name)) = call(&span) else { continue };
            count += 1;
            let path = span.split('(').next().unwrap_or_default();
            let exists = libraries.iter().any(|library| library.has(owner.as_deref(), &name));
            if !exists && !FOREIGN.contains(&path) {
                missing.push(format!("{}: `{span}`", page.display()));
            }
            foreign.remove(path);
        }
    }
    assert!(missing.is_empty(), "pages name calls that do not exist: {missing:#?}");
    assert!(count > 300, "{count} calls");
    assert!(foreign.is_empty(), "no page names {foreign:?}");
}

/// The calls in the second column of the tables in a file's head.
fn questions(source: &str) -> Vec<String> {
    let rows = source.lines().filter_map(|line| line.strip_prefix("//! | "));
    let cells = rows.filter_map(|row| row.split(" | ").nth(1));
    let links = cells.flat_map(|cell| cell.split("[`").skip(1));
    links.filter_map(|link| link.split("`]").next()).map(str::to_owned).collect()
}

#[test]
fn the_chapter_on_queries_answers_every_question() {
    let page = read("docs/book/queries.md");
    let questions = questions(&read("src/proximity.rs"));
    assert!(questions.len() > 40, "{questions:?}");
    let is_answered = |question: &String| {
        let Some((owner, name)) = question.rsplit_once("::") else {
            return page.contains(&format!("`{question}`"));
        };
        // A subject with a row of its own has its calls there.
        let row = page.lines().find(|line| line.starts_with(&format!("| `{owner}` |")));
        let place = row.unwrap_or(&page);
        place.contains(&format!("`{name}`")) || place.contains(&format!("`{question}`"))
    };
    let missing: Vec<_> = questions.iter().filter(|question| !is_answered(question)).collect();
    assert!(missing.is_empty(), "docs/book/queries.md lacks {missing:?}");
}
