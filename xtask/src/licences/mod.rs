//! Licences of what we ship, versions that stand twice, and sources outside the registry.

mod duplicates;
pub(crate) mod spdx;

use crate::findings::CheckOutcome;
use crate::tree::{self, DependencyTree};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;

const FILE: &str = "xtask/licences.toml";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Policy {
    /// SPDX identifiers, `WITH` clauses included.
    allowed: BTreeSet<String>,
    /// Exactly one version of these may stand in what we ship.
    single: Vec<String>,
    #[serde(default)]
    duplicate: Vec<duplicates::Exemption>,
}

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let text =
        std::fs::read_to_string(root.join(FILE)).map_err(|error| format!("{FILE}: {error}"))?;
    let policy: Policy = toml::from_str(&text).map_err(|error| format!("{FILE}: {error}"))?;
    let everything = tree::workspace_on_all_targets(root)?;
    let shipped = tree::tree(
        root,
        &["--workspace", "--exclude", "xtask", "--edges", "normal"],
    )?;
    let built = tree::workspace(root)?;

    let mut outcome = CheckOutcome::default();
    outcome
        .findings
        .extend(licences(&everything, &policy.allowed));
    outcome.findings.extend(foreign_sources(&everything, root));
    outcome.findings.extend(singles(&shipped, &policy.single));
    outcome.merge(duplicates::check(&built, &policy.duplicate));
    let counted = everything
        .packages
        .values()
        .filter(|package| package.source.is_none())
        .count();
    outcome.notes.push(format!(
        "{counted} packages of others, all platforms and tests included"
    ));
    Ok(outcome)
}

fn licences(tree: &DependencyTree, allowed: &BTreeSet<String>) -> Vec<String> {
    let mut findings = Vec::new();
    for ((name, version), package) in &tree.packages {
        match spdx::is_satisfied(&package.licence, allowed) {
            Ok(true) => {}
            Ok(false) => findings.push(format!(
                "{name} {version}: licence {:?} asks for more than {FILE} allows",
                package.licence
            )),
            Err(why) => findings.push(format!(
                "{name} {version}: licence {:?}: {why}",
                package.licence
            )),
        }
    }
    findings
}

/// Everything comes from a registry or from this repository.
fn foreign_sources(tree: &DependencyTree, root: &Path) -> Vec<String> {
    let mut findings = Vec::new();
    for ((name, version), package) in &tree.packages {
        if let Some(source) = &package.source
            && !Path::new(source).starts_with(root)
        {
            findings.push(format!(
                "{name} {version}: comes from {source}; allowed are registries and this repository"
            ));
        }
    }
    findings
}

fn singles(shipped: &DependencyTree, single: &[String]) -> Vec<String> {
    let mut findings = Vec::new();
    for name in single {
        let versions: Vec<&str> = shipped
            .packages
            .keys()
            .filter(|(other, _)| other == name)
            .map(|(_, version)| version.as_str())
            .collect();
        if versions.len() != 1 {
            findings.push(format!(
                "{name}: the normal tree holds versions {versions:?}, allowed is exactly one"
            ));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::parse_fixture;

    #[test]
    fn an_unlisted_licence_is_found() {
        let tree = parse_fixture("0|a v1|MIT|\n0|b v1|GPL-3.0-only|\n0|c v1||\n");
        let findings = licences(&tree, &["MIT".to_owned()].into());
        assert_eq!(findings.len(), 2);
        assert!(findings[0].starts_with("b 1: licence \"GPL-3.0-only\""));
        assert!(findings[1].starts_with("c 1: licence \"\""));
    }

    #[test]
    fn a_repository_and_a_folder_outside_are_found() {
        let tree = parse_fixture(
            "0|a v1 (/r/a)|MIT|\n0|b v1 (https://host/b#1)|MIT|\n0|c v1 (/elsewhere/c)|MIT|\n0|d v1|MIT|\n",
        );
        let findings = foreign_sources(&tree, Path::new("/r"));
        assert_eq!(findings.len(), 2);
        assert!(findings[0].contains("https://host/b#1") && findings[1].contains("/elsewhere/c"));
    }

    #[test]
    fn two_versions_or_none_of_a_single_are_found() {
        let one = ["glam".to_owned()];
        assert_eq!(singles(&parse_fixture("0|glam v1|MIT|\n"), &one), [""; 0]);
        assert_eq!(
            singles(&parse_fixture("0|glam v1|MIT|\n0|glam v2|MIT|\n"), &one).len(),
            1
        );
        assert_eq!(singles(&parse_fixture("0|a v1|MIT|\n"), &one).len(), 1);
    }
}
