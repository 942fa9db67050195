//! The proof of a margin, and the mesh, as files for `docs/book/check_proof.py`.

use crate::outputs;
use parry_continuum::proximity::{BvhSearch, Proof, Proximity};
use std::path::{Path, PathBuf};

/// The checker, from the root of the repository.
const CHECKER: &str = "docs/book/check_proof.py";

/// Writes the proof and its mesh, and returns the command that checks them.
pub fn write(path: &Path, proof: &Proof, search: &BvhSearch) -> Result<String, String> {
    let mesh = outputs::mesh_path(path);
    outputs::write("--prove", &mesh, mesh_files::to_obj(search.vertices(), search.triangles()))?;
    outputs::write("--prove", path, proof.to_string())?;
    let words = [checker().as_path(), &mesh, path].map(quoted);
    Ok(format!("python3 {}", words.join(" ")))
}

/// Returns the path of the checker: in this directory, or in the repository that this command was
/// built from.
fn checker() -> PathBuf {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2);
    let built_from = repository.map(|root| root.join(CHECKER)).filter(|path| path.exists());
    match built_from {
        Some(path) if !Path::new(CHECKER).exists() => path,
        _ => CHECKER.into(),
    }
}

/// Quotes a path for a shell, if it needs that. A name that is not UTF-8 or has control characters
/// is quoted byte by byte.
fn quoted(path: &Path) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-\\:".contains(c);
    match path.to_str() {
        Some(text) if text.chars().all(is_plain) => text.to_owned(),
        Some(text) if !text.contains(char::is_control) => {
            format!("'{}'", text.replace('\'', r"'\''"))
        }
        _ => {
            let byte = |byte: &u8| match byte {
                b' '..=b'~' if !b"'\\".contains(byte) => char::from(*byte).to_string(),
                _ => format!("\\x{byte:02x}"),
            };
            let bytes = path.as_os_str().as_encoded_bytes().iter().map(byte);
            format!("$'{}'", bytes.collect::<String>())
        }
    }
}
