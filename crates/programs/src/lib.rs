//! Runs programs as a user does, and reads their output.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the directory of this build: tests are in target/debug/deps.
pub fn build_directory() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    test.ancestors().nth(2).unwrap().to_owned()
}

/// Returns a path in the directory where programs run and write.
pub fn place(name: &str) -> PathBuf {
    build_directory().with_file_name("tmp").join(name)
}

/// Writes a file with the given text.
pub fn file(name: &str, text: &str) -> String {
    let path = place(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().into()
}

/// Reads a file that a program wrote.
pub fn read(name: &str) -> String {
    let path = place(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Writes a mesh file of a box that has space for a robot.
pub fn room(name: &str) -> String {
    let corners = (0..8).map(|k| format!("v {} {} {}\n", 60 * (k & 1), 30 * (k & 2), 15 * (k & 4)));
    let sides = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    file(name, &(corners.collect::<String>() + sides))
}

/// Returns the path of an example program, which `cargo test` has built: another build would
/// compile the library again wherever its features differ.
pub fn example(name: &str) -> PathBuf {
    let program = build_directory().join("examples").join(name);
    assert!(program.exists(), "{name} is not built: `cargo test --test` needs `--examples`");
    program
}

/// Runs a program. Returns its exit status, its output and its errors. Its pictures are rough,
/// unless `PARRY_CONTINUUM_EFFORT` is set.
pub fn run(program: impl AsRef<Path>, arguments: &[&str]) -> (Option<i32>, String, String) {
    let place = place("");
    std::fs::create_dir_all(&place).unwrap();
    let mut command = Command::new(program.as_ref());
    if std::env::var_os("PARRY_CONTINUUM_EFFORT").is_none() {
        command.env("CONTINUUM_DEMO_ROUGH", "1");
    }
    let output = command.args(arguments).current_dir(place).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// Returns the output of a program that must succeed.
pub fn succeed(program: impl AsRef<Path>, arguments: &[&str]) -> String {
    let program = program.as_ref();
    let (status, out, error) = run(program, arguments);
    assert!(status == Some(0), "{} {arguments:?}: {error}", program.display());
    out
}

/// Asserts that a program refuses these arguments with one line that contains `expected`. Returns
/// its exit status.
pub fn refuse(program: impl AsRef<Path>, arguments: &[&str], expected: &str) -> Option<i32> {
    let program = program.as_ref();
    let (status, out, error) = run(program, arguments);
    let name = program.display();
    assert!(status != Some(0) && out.is_empty(), "{name} {arguments:?}: {out}");
    assert!(
        error.contains(expected) && error.lines().count() == 1,
        "{name} {arguments:?}: {error}"
    );
    status
}

/// Returns the cells of the table whose head begins with `head`, row by row. Asserts that every row
/// is as long as the head and has no empty cell.
pub fn table(page: &str, head: &str) -> Vec<Vec<String>> {
    let mut lines = page.lines().skip_while(|line| !line.starts_with(head));
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let columns = cells(lines.next().unwrap_or_else(|| panic!("no table {head}: {page}"))).len();
    assert_eq!(lines.next(), Some(format!("|{}", "---|".repeat(columns)).as_str()), "{head}");
    let rows: Vec<_> = lines.take_while(|line| line.starts_with('|')).map(cells).collect();
    for row in &rows {
        assert!(row.len() == columns && row.iter().all(|cell| !cell.is_empty()), "{head}: {row:?}");
    }
    rows
}

/// Asserts that every number of the text is finite.
pub fn assert_finite(text: &str) {
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    assert!(!words.any(|word| ["NaN", "inf"].contains(&word)), "{text}");
}

/// Returns the number of colours of a picture.
pub fn colours(name: &str) -> usize {
    pixels(name).1.into_iter().collect::<BTreeSet<_>>().len()
}

/// Returns width, height and the pixels of a picture, row by row.
pub fn pixels(name: &str) -> ([usize; 2], Vec<[u8; 3]>) {
    let file = std::fs::File::open(place(name)).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    ([frame.width as usize, frame.height as usize], bytes.as_chunks::<3>().0.to_vec())
}
