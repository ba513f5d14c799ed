//! The files of a crate, found as the compiler finds them: from its root along `mod` lines.

use super::references::{self, FileReferences};
use std::fs;
use std::path::{Path, PathBuf};

/// A file, and what it refers to.
#[derive(Debug)]
pub(super) struct ModuleFile {
    pub path: PathBuf,
    /// Names from below the root to the file's module; none for the root itself.
    pub module: Vec<String>,
    pub references: FileReferences,
}

/// Returns the file `entry` of a crate's root and all below it that are built without tests.
pub(super) fn of_crate(entry: &Path) -> Result<Vec<ModuleFile>, String> {
    let mut files = Vec::new();
    collect(entry, &[], &mut files)?;
    Ok(files)
}

fn collect(path: &Path, module: &[String], out: &mut Vec<ModuleFile>) -> Result<(), String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let references = references::of_file(&text, module)
        .map_err(|(line, why)| format!("{}:{line}: {why}", path.display()))?;
    let children = references.child_files.clone();
    out.push(ModuleFile {
        path: path.to_path_buf(),
        module: module.to_vec(),
        references,
    });
    for child in children {
        let name = child.join("::");
        let file = file_of(path, module, &child)
            .ok_or_else(|| format!("{}: mod {name} has no file", path.display()))?;
        collect(&file, &child, out)?;
    }
    Ok(())
}

/// Returns the file of the module `child`, which a `mod` line in the file `path` of `module` names.
fn file_of(path: &Path, module: &[String], child: &[String]) -> Option<PathBuf> {
    let stem = path.file_stem()?.to_string_lossy();
    let mut folder = path.parent()?.to_path_buf();
    if !["lib", "main", "mod"].contains(&&*stem) {
        folder.push(&*stem);
    }
    let (name, between) = child.strip_prefix(module)?.split_last()?;
    folder.extend(between);
    let places = [
        folder.join(format!("{name}.rs")),
        folder.join(name).join("mod.rs"),
    ];
    places.into_iter().find(|place| place.exists())
}
