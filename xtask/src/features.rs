//! One build serves tests and extension: both ask each dependency for the same features.
//!
//! Cargo unites features over the packages a command names. Where a test-only dependency asks for one more feature of,
//! say, bitflags, everything above bitflags compiles a second time for the extension, rapier included.

use crate::findings::CheckOutcome;
use crate::tree::{self, DependencyTree};
use std::path::Path;

/// Packages with heavy dependencies that are built alone besides the whole workspace.
const BUILT_ALONE: &[&str] = &["dwell-python"];

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let all = tree::workspace(root)?;
    let mut outcome = CheckOutcome::default();
    for name in BUILT_ALONE {
        let alone = tree::tree(root, &["--package", name, "--edges", "normal,build"])?;
        outcome.findings.extend(differences(name, &alone, &all));
        outcome.notes.push(format!(
            "{name}: {} packages shared with the tests",
            alone.packages.len()
        ));
    }
    Ok(outcome)
}

fn differences(name: &str, alone: &DependencyTree, all: &DependencyTree) -> Vec<String> {
    let mut findings = Vec::new();
    for (id, package) in &alone.packages {
        let shared = all.packages.get(id).map(|package| &package.features);
        for features in &package.features {
            if !shared.is_some_and(|shared| shared.contains(features)) {
                findings.push(format!(
                    "{} {}: {name} builds it with [{features}], the tests with {:?}; \
                     name the union in the workspace's dependency table",
                    id.0,
                    id.1,
                    shared.into_iter().flatten().collect::<Vec<_>>()
                ));
            }
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::parse_fixture;

    #[test]
    fn equal_features_pass() {
        let alone = parse_fixture("0|e v1|MIT|\n1|a v1|MIT|std\n");
        let all = parse_fixture("0|e v1|MIT|\n1|a v1|MIT|std\n1|t v1|MIT|\n");
        assert_eq!(differences("e", &alone, &all), [""; 0]);
    }

    #[test]
    fn a_feature_that_only_tests_ask_for_is_found() {
        let alone = parse_fixture("0|e v1|MIT|\n1|a v1|MIT|\n");
        let all = parse_fixture("0|e v1|MIT|\n1|a v1|MIT|std\n");
        let findings = differences("e", &alone, &all);
        assert_eq!(findings.len(), 1);
        assert!(findings[0].starts_with("a 1: e builds it with [], the tests with [\"std\"]"));
    }
}
