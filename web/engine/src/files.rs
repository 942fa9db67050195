//! The user's files, in memory; and errors of reading in the words of the page.

use mesh_files::{MeshFileError, Options, centreline_from_bytes};
use std::path::Path;
use wasm_bindgen::prelude::wasm_bindgen;

/// Leaves room for the files and the surface in the 4 GiB of WebAssembly.
const MEMORY_LIMIT: u64 = 1 << 30;

/// The options that a reader gets.
pub fn options(scale: f64) -> Options {
    Options::scaled(scale).with_memory_limit(MEMORY_LIMIT)
}

/// Files by name.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Files(Vec<(String, Vec<u8>)>);

#[wasm_bindgen]
impl Files {
    /// Returns no files.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Files {
        Self::default()
    }

    /// Adds a file. It replaces a file of the same name.
    pub fn add(&mut self, name: &str, bytes: Vec<u8>) {
        self.0.retain(|(own, _)| own != name);
        self.0.push((name.to_owned(), bytes));
    }

    /// Returns whether a file is read as a robot: a text, markups, or VTK's PolyData with lines.
    pub fn holds_robot(&self, name: &str) -> bool {
        let lower = name.to_ascii_lowercase();
        let ends = |extensions: &[&str]| extensions.iter().any(|end| lower.ends_with(end));
        ends(&[".csv", ".tsv", ".txt", ".dat", ".json"])
            || (ends(&[".vtp", ".vtk"])
                && matches!(self.line(name), Some(Ok(_) | Err(MeshFileError::SeveralLines { .. }))))
    }

    /// Returns the number of lines among which the user chooses: 0 if the file needs no choice.
    pub fn line_choices(&self, name: &str) -> u32 {
        match self.line(name) {
            Some(Err(MeshFileError::SeveralLines { count, .. })) => {
                count.try_into().unwrap_or(u32::MAX)
            }
            Some(Err(MeshFileError::NotACurve { .. })) => 1,
            _ => 0,
        }
    }
}

impl Files {
    /// Returns the bytes of a file.
    pub(crate) fn get(&self, path: &Path) -> Option<&[u8]> {
        let name = path.file_name()?.to_str()?;
        let (_, bytes) = self.0.iter().find(|(own, _)| own == name)?;
        Some(bytes)
    }

    fn line(&self, name: &str) -> Option<Result<mesh_files::Centreline, MeshFileError>> {
        Some(centreline_from_bytes(name, self.get(Path::new(name))?, &options(1.0)))
    }
}

/// Returns the error of reading a file, in the words of the page.
pub fn refused(error: &MeshFileError) -> String {
    match error {
        MeshFileError::Unreadable { file, .. } => {
            format!("{} is missing; choose it together with its header", file.display())
        }
        MeshFileError::NoPosition { file, missing, .. } => format!(
            "{} does not say where its voxels are ({missing}); save it again with a position, or tick 'Place the first voxel \
             at the origin'",
            file.display()
        ),
        error => error.to_string().replace(", or raise Options::memory_limit", ""),
    }
}
