//! The unpacked archives of the packages that are linked: who wrote them, and which licence files they carry.

use crate::tree::{PackageId, cargo};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The fields of a package's manifest beyond what `cargo tree` prints.
#[derive(Debug, Clone, Default, Deserialize)]
pub(crate) struct Manifest {
    name: String,
    version: String,
    #[serde(rename = "manifest_path")]
    path: PathBuf,
    /// A file with terms of its own, beside the manifest.
    license_file: Option<PathBuf>,
    #[serde(default)]
    pub authors: Vec<String>,
    pub repository: Option<String>,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Manifest>,
}

/// Beginnings of the names of files with terms, lower case.
const NAMES: &[&str] = &["licen", "copying", "copyright", "notice", "unlicense"];

/// All packages of the workspace's graph on a platform.
pub(crate) fn manifests(
    root: &Path,
    platform: &str,
) -> Result<BTreeMap<PackageId, Manifest>, String> {
    let text = cargo(
        root,
        &[
            "metadata",
            "--format-version",
            "1",
            "--filter-platform",
            platform,
        ],
    )?;
    let metadata: Metadata = serde_json::from_str(&text)
        .map_err(|error| format!("cargo metadata printed something else than expected: {error}"))?;
    Ok(metadata
        .packages
        .into_iter()
        .map(|package| ((package.name.clone(), package.version.clone()), package))
        .collect())
}

impl Manifest {
    /// The texts of its licence files, by file name.
    pub(crate) fn texts(&self) -> Result<Vec<String>, String> {
        let folder = self
            .path
            .parent()
            .ok_or_else(|| format!("{}: no folder", self.path.display()))?;
        let mut files: Vec<PathBuf> = in_folder(folder)?
            .into_iter()
            .filter(|path| is_terms(path))
            .collect();
        // A folder of texts, as the REUSE convention has it.
        for path in files.clone().iter().filter(|path| path.is_dir()) {
            files.extend(in_folder(path)?);
        }
        files.extend(self.license_file.iter().map(|file| folder.join(file)));
        files.retain(|path| path.is_file());
        files.sort();
        files.dedup();
        files.iter().map(|path| read(path)).collect()
    }
}

#[cfg(test)]
impl Manifest {
    /// Of a package that lies in a folder.
    pub(crate) fn in_folder(folder: &Path) -> Self {
        Self {
            path: folder.join("Cargo.toml"),
            ..Self::default()
        }
    }
}

/// A text file.
pub(crate) fn read(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    // Old files spell names in Latin-1; the terms are ASCII.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn is_terms(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_lowercase();
    NAMES.iter().any(|beginning| name.starts_with(beginning))
        && !matches!(
            path.extension().and_then(|ending| ending.to_str()),
            Some("rs" | "toml")
        )
}

fn in_folder(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let broken = |error: std::io::Error| format!("{}: {error}", folder.display());
    std::fs::read_dir(folder)
        .map_err(broken)?
        .map(|entry| entry.map(|entry| entry.path()).map_err(broken))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_with_terms_are_known_by_name() {
        for name in [
            "LICENSE",
            "License-MIT.md",
            "LICENCE",
            "COPYING",
            "NOTICE.txt",
            "UNLICENSE",
        ] {
            assert!(is_terms(Path::new(name)), "{name}");
        }
        for name in ["README.md", "src", "licence.rs", "license.toml"] {
            assert!(!is_terms(Path::new(name)), "{name}");
        }
    }
}
