//! Checks the rule of ARCHITECTURE.md against deadlocks in the text of the sources.

use super::sources::sources;

/// The calls that make threads wait, and the files that may use them: each states why no thread
/// waits there for a pool.
const WAITING: [&str; 9] = [
    "OnceLock",
    "LazyLock",
    "Mutex",
    "RwLock",
    "Condvar",
    "Barrier",
    "mpsc",
    "Once::",
    "thread::park",
];
const MAY_WAIT: [&str; 4] =
    ["src/threads/lazy.rs", "src/threads/parallel.rs", "src/robot/chain.rs", "src/gpu/opened.rs"];

/// The only file that gives work to a pool.
const POOL: &str = "src/threads/pool.rs";

#[test]
fn nobody_who_holds_a_lock_can_wait_for_a_pool() {
    let files = sources();
    for file in &files {
        let (name, text) = (&file.path, &file.code);
        let waits = WAITING.iter().find(|word| text.contains(*word));
        assert!(
            waits.is_none() || MAY_WAIT.contains(&name.as_str()),
            "{name}: {waits:?}; what is built once is a `Lazy`, whose builder has no pool"
        );
        assert!(
            !text.contains("rayon") || name == POOL,
            "{name}: {POOL} alone gives work to a pool"
        );
    }
    // They still do what they are listed for.
    for name in MAY_WAIT {
        let text = files.iter().find(|file| file.path == name).map(|file| &file.code);
        assert!(text.is_some_and(|text| WAITING.iter().any(|word| text.contains(word))), "{name}");
    }
}
