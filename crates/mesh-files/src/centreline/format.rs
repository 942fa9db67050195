//! The formats of centrelines, by the extensions of their files.

use crate::MeshFileError;
use std::path::Path;

/// The format that the extension of a centreline's file names.
#[derive(Clone, Copy)]
pub(super) enum Format {
    Markups,
    Table,
    VtkLegacy,
    VtkXml,
}

impl Format {
    pub(super) fn of(path: &Path) -> Result<Self, MeshFileError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match name.rsplit_once('.').map_or("", |(_, extension)| extension) {
            "csv" | "tsv" | "txt" | "dat" => Ok(Self::Table),
            "json" => Ok(Self::Markups),
            "vtk" => Ok(Self::VtkLegacy),
            "vtp" => Ok(Self::VtkXml),
            _ => Err(MeshFileError::UnknownCentreline { file: path.to_owned() }),
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Markups => "markups",
            Self::Table => "text",
            Self::VtkLegacy => "VTK",
            Self::VtkXml => "VTK XML",
        }
    }
}
