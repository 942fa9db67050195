//! The README's command and its Rust snippet, and what they print.

use crate::run;
use continuum_programs as programs;
use std::path::Path;
use std::process::Command;

/// The root of the repository.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn page(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap()
}

/// The blocks of code of the README, with their languages.
fn blocks(text: &str) -> Vec<(&str, &str)> {
    text.split("\n```").skip(1).step_by(2).filter_map(|block| block.split_once('\n')).collect()
}

/// The block behind the first that contains `text`.
fn output_of(readme: &str, text: &str) -> String {
    let blocks = blocks(readme);
    let place = blocks.iter().position(|(_, block)| block.contains(text)).unwrap();
    let (language, output) = blocks[place + 1];
    assert_eq!(language, "text");
    format!("{output}\n")
}

#[test]
fn the_command_prints_what_the_readme_shows() {
    let readme = page("README.md");
    let (_, block) = blocks(&readme)
        .into_iter()
        .find(|(language, block)| *language == "sh" && block.contains("\nclearance "))
        .unwrap();
    assert!(block.starts_with("cargo install --path crates/clearance\n"), "{block}");
    let words = block.split("\nclearance ").nth(1).unwrap().replace("\\\n", " ");
    let words: Vec<_> = words.split_whitespace().collect();
    let run = Command::new(crate::COMMAND).args(&words).current_dir(root()).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let out = String::from_utf8(run.stdout).unwrap();
    let shown = output_of(&readme, "\nclearance ");
    let parts: Vec<_> = shown.split("...\n").collect();
    assert!(parts.len() > 1 && parts.iter().all(|part| out.contains(part)), "{shown}\n{out}");
    assert!(out.ends_with(parts[parts.len() - 1]), "{shown}\n{out}");
}

#[test]
fn the_snippet_is_the_quickstart_and_prints_what_the_readme_shows() {
    let (readme, example) = (page("README.md"), page("examples/quickstart.rs"));
    let code: String = example.lines().skip(2).map(|line| format!("{line}\n")).collect();
    let (_, snippet) =
        blocks(&readme).into_iter().find(|(language, _)| *language == "rust").unwrap();
    assert_eq!(format!("{snippet}\n"), code);
    assert_eq!(code.lines().count(), 15);
    let program = programs::example("quickstart");
    let run = Command::new(program).current_dir(root()).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let out = String::from_utf8(run.stdout).unwrap();
    assert_eq!(out, output_of(&readme, "Chain::from_centreline"));
}

#[test]
fn help_names_every_option_and_the_exit_status() {
    let (status, help, error) = run(&["--help"]);
    assert_eq!((status, error.as_str()), (Some(0), ""));
    for word in [
        "--mesh",
        "--label ",
        "--labels",
        "--centreline",
        "--centerline",
        "--line",
        "--shapes",
        "--radius",
        "--scale",
        "--frame",
        "--mesh-frame",
        "--pose",
        "--margin",
        "--inside",
        "--tolerance",
        "--plot",
        "--csv",
        "--prove",
        "--json",
        "--allow-no-position",
        "Exit status: ",
    ] {
        assert!(help.contains(word), "{word}: {help}");
    }
}
