//! The module of a name below a crate's root: itself, or the one that the root re-exports it from.

use super::references::FileReferences;
use std::collections::{BTreeMap, BTreeSet};

/// The meanings of the names below the root.
#[derive(Debug)]
pub(super) struct RootNames {
    modules: BTreeSet<String>,
    /// The names below the root that it re-exports, by the exported name.
    exports: BTreeMap<String, Vec<String>>,
    /// Items of the root, and names that it has from other crates.
    others: BTreeSet<String>,
}

impl RootNames {
    /// Names below a root whose file is `root`; `modules` are those that are built without tests.
    pub(super) fn new(root: &FileReferences, modules: BTreeSet<String>) -> Self {
        let mut exports = BTreeMap::new();
        let mut others: BTreeSet<String> = root.items.iter().cloned().collect();
        for import in &root.imports {
            let Some(name) = &import.name else { continue };
            // In the root a path may begin with the name of a module.
            let own = || {
                modules
                    .contains(&import.written[0])
                    .then(|| import.written.clone())
            };
            match import.path.clone().or_else(own) {
                Some(path) => {
                    exports.insert(name.clone(), path);
                }
                None => {
                    others.insert(name.clone());
                }
            }
        }
        Self {
            modules,
            exports,
            others,
        }
    }

    /// Returns the top-level module that defines the path, or nothing for what stands in the root itself.
    ///
    /// # Errors
    /// The name, where none of the root's lines brings it.
    pub(super) fn module_of(&self, path: &[String]) -> Result<Option<&str>, String> {
        let mut path = path;
        // Each name of the root leads to another one, at most once.
        for _ in 0..=self.exports.len() {
            let Some(first) = path.first() else {
                return Ok(None);
            };
            if let Some(module) = self.modules.get(first) {
                return Ok(Some(module));
            }
            match self.exports.get(first) {
                Some(export) => path = export,
                None if self.others.contains(first) => return Ok(None),
                None => break,
            }
        }
        Err(path.first().cloned().unwrap_or_default())
    }
}
