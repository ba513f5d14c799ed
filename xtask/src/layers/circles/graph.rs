//! The graph of modules by use, and its shortest circles.

use super::module_files::ModuleFile;
use super::root_names::RootNames;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt::Write;
use std::path::Path;

/// Number of references of one module to another that are printed.
const SHOWN: usize = 3;

/// The top-level modules of a crate and where they use each other.
#[derive(Debug, Default)]
pub(super) struct ModuleGraph {
    /// User, used, and each place as `file:line`.
    uses: BTreeMap<String, BTreeMap<String, Vec<String>>>,
}

impl ModuleGraph {
    /// Adds the references of `files`, the root's first, with paths relative to `root`.
    ///
    /// # Errors
    /// A path whose module is unknown.
    pub(super) fn add(&mut self, root: &Path, files: &[ModuleFile]) -> Result<(), String> {
        let Some(entry) = files.first() else {
            return Ok(());
        };
        let modules: BTreeSet<String> = files
            .iter()
            .filter_map(|file| file.module.first().cloned())
            .collect();
        let names = RootNames::new(&entry.references, modules);
        for file in files {
            let Some(user) = file.module.first() else {
                continue;
            };
            let shown = file.path.strip_prefix(root).unwrap_or(&file.path);
            for (path, line) in &file.references.paths {
                let place = format!("{}:{line}", shown.display());
                let module = names.module_of(path).map_err(|name| {
                    format!("{place}: crate::{name} is re-exported by no line that names it")
                })?;
                if let Some(used) = module.filter(|used| used != user) {
                    let uses = self.uses.entry(user.clone()).or_default();
                    let places = uses.entry(used.to_owned()).or_default();
                    if !places.contains(&place) {
                        places.push(place);
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the shortest circle through each use, shortest first.
    pub(super) fn cycles(&self) -> Vec<String> {
        let mut circles = BTreeSet::new();
        for (user, uses) in &self.uses {
            for used in uses.keys() {
                if let Some(mut circle) = self.way(used, user) {
                    let smallest = (0..circle.len()).min_by_key(|&k| circle[k]).unwrap_or(0);
                    circle.rotate_left(smallest);
                    circles.insert((circle.len(), circle));
                }
            }
        }
        circles
            .into_iter()
            .map(|(_, circle)| self.shown(&circle))
            .collect()
    }

    /// The shortest way along uses, both ends included.
    fn way<'a>(&'a self, from: &'a str, to: &str) -> Option<Vec<&'a str>> {
        let mut came_from: BTreeMap<&str, &str> = BTreeMap::new();
        let mut open = VecDeque::from([from]);
        while let Some(user) = open.pop_front() {
            if user == to {
                let mut way = vec![user];
                while let Some(&before) = way.last().and_then(|last| came_from.get(last)) {
                    way.push(before);
                }
                way.reverse();
                return Some(way);
            }
            for used in self.uses.get(user).into_iter().flat_map(BTreeMap::keys) {
                if used != from && !came_from.contains_key(used.as_str()) {
                    came_from.insert(used, user);
                    open.push_back(used);
                }
            }
        }
        None
    }

    fn shown(&self, circle: &[&str]) -> String {
        let steps = circle.iter().zip(circle.iter().cycle().skip(1));
        let steps = steps.map(|(user, used)| {
            let places = &self.uses[*user][*used];
            let mut shown = places[..places.len().min(SHOWN)].join(", ");
            if places.len() > SHOWN {
                let _ = write!(shown, " and {} more", places.len() - SHOWN);
            }
            format!("{user} > {used} ({shown})")
        });
        steps.collect::<Vec<_>>().join(", ")
    }
}
