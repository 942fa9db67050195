//! The files that the command writes. None of them replaces a file that it reads.

use crate::messages;
use crate::options::Options;
use std::fs;
use std::io::{ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};

/// Checks that the outputs differ from the inputs and from one another. `wall` are the files of
/// --mesh.
pub fn check(my: &Options, wall: &[PathBuf]) -> Result<(), String> {
    let inputs = [
        ("--centreline", my.centreline.as_ref()),
        ("--shapes", my.shapes.as_ref()),
        ("--pose", my.pose.as_ref()),
    ];
    let mesh = my.prove.as_deref().map(mesh_path);
    let outputs = [
        ("--plot", my.plot.as_ref()),
        ("--csv", my.csv.as_ref()),
        ("--prove", my.prove.as_ref()),
        ("--prove", mesh.as_ref()),
    ];
    let inputs = inputs.into_iter().filter_map(|(name, path)| Some((name, path?)));
    let inputs = wall.iter().map(|path| ("--mesh", path)).chain(inputs);
    let mut taken: Vec<_> = inputs.map(|(name, path)| (name, Place::of(path))).collect();
    for (option, path) in outputs {
        let Some(path) = path else { continue };
        let place = Place::of(path);
        if let Some((other, _)) = taken.iter().find(|(_, taken)| taken.is(&place)) {
            return Err(format!(
                "{option} would write {}, the file of {other}; choose another name for {option}",
                path.display()
            ));
        }
        taken.push((option, place));
    }
    Ok(())
}

/// Returns the path of the mesh that belongs to a proof.
pub fn mesh_path(proof: &Path) -> PathBuf {
    proof.with_extension("obj")
}

/// Writes a file for this option.
pub fn write(option: &str, path: &Path, contents: impl AsRef<[u8]>) -> Result<(), String> {
    fs::write(path, contents).map_err(|error| {
        format!("cannot write {} ({error}); choose another {option}", path.display())
    })
}

/// Prints a text. A reader such as `head` may close the pipe early: that is no error.
pub fn print(text: &str) -> Result<(), String> {
    match stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("cannot write to standard output ({error})"))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error. Names of files may have control characters.
pub fn tell(kind: &str, text: &str) {
    eprintln!("{kind}: {}", messages::in_one_line(text));
}

/// Where a path leads, for comparison. The file itself may not exist yet.
struct Place {
    path: PathBuf,
    /// The number of the file on its device. Hard links have the same.
    number: Option<[u64; 2]>,
}

impl Place {
    fn of(path: &Path) -> Self {
        let resolved = path.canonicalize().or_else(|_| {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new(".")).canonicalize()?;
            Ok::<_, std::io::Error>(folder.join(path.file_name().unwrap_or_default()))
        });
        Self { path: resolved.unwrap_or_else(|_| path.to_owned()), number: number(path) }
    }

    fn is(&self, other: &Self) -> bool {
        self.path == other.path || (self.number.is_some() && self.number == other.number)
    }
}

#[cfg(unix)]
fn number(path: &Path) -> Option<[u64; 2]> {
    use std::os::unix::fs::MetadataExt;
    let file = fs::metadata(path).ok()?;
    Some([file.dev(), file.ino()])
}

#[cfg(not(unix))]
fn number(_path: &Path) -> Option<[u64; 2]> {
    None
}
