//! The rule of ARCHITECTURE.md that keeps threads from waiting for each other for ever, as far as a text shows it.

use std::fs;
use std::path::Path;

/// What makes threads wait, and the files that may: each says why nobody waits there for a pool.
const WAITING: [&str; 9] =
    ["OnceLock", "LazyLock", "Mutex", "RwLock", "Condvar", "Barrier", "mpsc", "Once::", "thread::park"];
const MAY_WAIT: [&str; 3] = ["src/threads/lazy.rs", "src/robot/chain.rs", "src/gpu/failures.rs"];

/// The only file that gives work to a pool.
const POOL: &str = "src/threads/parallel.rs";

/// The crate's sources, less what only its tests see.
fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.to_str().unwrap().to_owned();
        if path.is_dir() {
            sources(&path, found);
        } else if name.ends_with(".rs") && !name.contains("tests") {
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("\nmod tests {").next().unwrap_or_default();
            let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            found.push((name, lines.collect::<Vec<_>>().join("\n")));
        }
    }
}

#[test]
fn nobody_who_holds_a_lock_can_wait_for_a_pool() {
    let mut files = Vec::new();
    sources(Path::new("src"), &mut files);
    assert!(files.len() > 150, "{}", files.len());
    for (name, text) in &files {
        let waits = WAITING.iter().find(|word| text.contains(*word));
        assert!(
            waits.is_none() || MAY_WAIT.contains(&name.as_str()),
            "{name}: {waits:?}; what is built once is a `Lazy`, whose builder has no pool"
        );
        assert!(!text.contains("rayon") || name == POOL, "{name}: {POOL} alone gives work to a pool");
    }
    // They still do what they are listed for.
    for name in MAY_WAIT {
        let text = files.iter().find(|(file, _)| file == name).map(|(_, text)| text);
        assert!(text.is_some_and(|text| WAITING.iter().any(|word| text.contains(word))), "{name}");
    }
}
