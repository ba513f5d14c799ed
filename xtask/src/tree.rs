//! The dependency graph as it is built: `cargo tree`, which, unlike `cargo metadata`, leaves out what no feature turns on.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// Name and version.
pub(crate) type PackageId = (String, String);

/// A package of the graph.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct DependencyPackage {
    /// SPDX expression of the manifest, or nothing.
    pub licence: String,
    /// Each set of features it is built with; two where host and target differ.
    pub features: BTreeSet<String>,
    /// The source of a package that is not from a registry: a folder or the address of a repository.
    pub source: Option<String>,
    /// Runs in the compiler; nothing of it is linked.
    pub proc_macro: bool,
}

/// Packages and who uses whom.
#[derive(Debug, Default)]
pub(crate) struct DependencyTree {
    pub packages: BTreeMap<PackageId, DependencyPackage>,
    /// User, used.
    pub edges: BTreeSet<(PackageId, PackageId)>,
}

/// The graph that `cargo tree` prints for `selection`, such as `["--workspace", "-e", "normal"]`.
pub(crate) fn tree(root: &Path, selection: &[&str]) -> Result<DependencyTree, String> {
    let mut args = vec!["tree", "--prefix", "depth", "--format", "|{p}|{l}|{f}"];
    args.extend(selection);
    parse(&cargo(root, &args)?)
}

/// The graph of all members with all that builds and tests them, for this machine.
pub(crate) fn workspace(root: &Path) -> Result<DependencyTree, String> {
    tree(root, &["--workspace", "--edges", "normal,build,dev"])
}

/// The same for all machines.
pub(crate) fn workspace_on_all_targets(root: &Path) -> Result<DependencyTree, String> {
    let selection = [
        "--workspace",
        "--edges",
        "normal,build,dev",
        "--target",
        "all",
    ];
    tree(root, &selection)
}

/// Standard output of a cargo command.
pub(crate) fn cargo(root: &Path, args: &[&str]) -> Result<String, String> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(program)
        .args(args)
        .current_dir(root)
        .output()
        .map_err(|error| format!("cargo {} cannot be started: {error}", args.join(" ")))?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        return Err(format!(
            "cargo {} failed: {}",
            args.join(" "),
            stderr.trim()
        ));
    }
    String::from_utf8(output.stdout).map_err(|error| format!("cargo printed no UTF-8: {error}"))
}

fn parse(text: &str) -> Result<DependencyTree, String> {
    let mut tree = DependencyTree::default();
    let mut path: Vec<PackageId> = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let mut fields = line.split('|');
        let (Some(depth), Some(package), Some(licence), Some(features)) =
            (fields.next(), fields.next(), fields.next(), fields.next())
        else {
            return Err(format!(
                "cargo tree printed {line:?}, expected depth|package|licence|features"
            ));
        };
        let depth: usize = depth
            .parse()
            .map_err(|_| format!("cargo tree printed {line:?} without a depth"))?;
        let mut words = package.splitn(3, ' ');
        let (Some(name), Some(version)) = (words.next(), words.next()) else {
            return Err(format!(
                "cargo tree printed {package:?}, expected name and version"
            ));
        };
        let id = (name.to_owned(), version.trim_start_matches('v').to_owned());
        let rest = words.next().unwrap_or_default();
        let proc_macro = rest.contains("(proc-macro)");
        let source = Some(rest)
            .map(|rest| rest.replace("(proc-macro)", ""))
            .map(|rest| {
                rest.trim()
                    .trim_start_matches('(')
                    .trim_end_matches(')')
                    .to_owned()
            });
        path.truncate(depth);
        if let Some(user) = path.last() {
            tree.edges.insert((user.clone(), id.clone()));
        }
        let entry = tree.packages.entry(id.clone()).or_default();
        licence.clone_into(&mut entry.licence);
        entry
            .features
            .insert(features.trim_end_matches(" (*)").to_owned());
        entry.proc_macro = proc_macro;
        entry.source = source.filter(|source| !source.is_empty());
        path.push(id);
    }
    Ok(tree)
}

impl DependencyTree {
    /// Returns what becomes part of a library that is made of `package`: all it uses, but for derive macros and what only they use.
    pub(crate) fn linked(&self, package: &str) -> BTreeSet<PackageId> {
        let mut open: Vec<&PackageId> = self
            .packages
            .keys()
            .filter(|(name, _)| name == package)
            .collect();
        let mut linked = BTreeSet::new();
        while let Some(id) = open.pop() {
            if !self.packages[id].proc_macro && linked.insert(id.clone()) {
                open.extend(
                    self.edges
                        .iter()
                        .filter(|(user, _)| user == id)
                        .map(|(_, used)| used),
                );
            }
        }
        linked
    }
}

#[cfg(test)]
pub(crate) fn parse_fixture(text: &str) -> DependencyTree {
    parse(text).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(name: &str) -> PackageId {
        (name.to_owned(), "1.0.0".to_owned())
    }

    #[test]
    fn depth_makes_edges() {
        let tree = parse_fixture(
            "0|a v1.0.0 (/r/a)|MIT|\n1|b v1.0.0|MIT|std\n2|c v1.0.0 (proc-macro)|MIT|x,y\n1|c v1.0.0 (proc-macro)|MIT|x,y (*)\n",
        );
        let edges = [(id("a"), id("b")), (id("a"), id("c")), (id("b"), id("c"))];
        assert_eq!(tree.edges, edges.into());
        assert_eq!(tree.packages[&id("c")].features, ["x,y".to_owned()].into());
        assert_eq!(tree.packages[&id("c")].source, None);
        assert!(tree.packages[&id("c")].proc_macro && !tree.packages[&id("b")].proc_macro);
        assert_eq!(tree.packages[&id("a")].source.as_deref(), Some("/r/a"));
    }

    #[test]
    fn what_only_a_macro_uses_is_not_linked() {
        let tree = parse_fixture(
            "0|a v1.0.0|MIT|\n1|m v1.0.0 (proc-macro)|MIT|\n2|q v1.0.0|MIT|\n2|s v1.0.0|MIT|\n1|b v1.0.0|MIT|\n2|s v1.0.0|MIT|\n",
        );
        assert_eq!(tree.linked("a"), [id("a"), id("b"), id("s")].into());
    }

    #[test]
    fn repositories_are_seen() {
        let tree = parse_fixture("0|a v1.0.0 (https://host/a?rev=1#abc)|MIT|\n");
        assert_eq!(
            tree.packages[&id("a")].source.as_deref(),
            Some("https://host/a?rev=1#abc")
        );
    }

    #[test]
    fn other_text_is_refused() {
        assert!(parse("a v1.0.0\n").is_err());
        assert!(parse("x|a v1.0.0|MIT|\n").is_err());
    }
}
