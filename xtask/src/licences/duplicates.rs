//! One package in two versions: compiled twice, and types that do not fit each other.

use super::FILE;
use crate::findings::CheckOutcome;
use crate::tree::DependencyTree;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A duplicate we live with.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Exemption {
    name: String,
    /// The crates that need the older one, and why that does no harm.
    reason: String,
    /// The condition that ends it.
    way_out: String,
}

/// Duplicates without an exemption, and exemptions without a duplicate.
pub(crate) fn check(tree: &DependencyTree, exemptions: &[Exemption]) -> CheckOutcome {
    let mut versions: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (name, version) in tree.packages.keys() {
        versions.entry(name).or_default().push(version);
    }
    versions.retain(|_, versions| versions.len() > 1);

    let mut outcome = CheckOutcome::default();
    for exemption in exemptions {
        match versions.remove(exemption.name.as_str()) {
            Some(found) => outcome.notes.push(format!(
                "twice: {} {} ({}; until {})",
                exemption.name,
                found.join(" and "),
                exemption.reason,
                exemption.way_out
            )),
            None => outcome.findings.push(format!(
                "{FILE}: exempts {}, which stands once or not at all; remove it",
                exemption.name
            )),
        }
    }
    for (name, found) in versions {
        outcome.findings.push(format!(
            "{name}: stands in versions {}; align them, or exempt it in {FILE} with a reason and a way out",
            found.join(" and ")
        ));
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::parse_fixture;

    fn exempt(name: &str) -> Exemption {
        Exemption {
            name: name.to_owned(),
            reason: "old".to_owned(),
            way_out: "new".to_owned(),
        }
    }

    #[test]
    fn a_duplicate_is_found_unless_exempt() {
        let tree = parse_fixture("0|a v1|MIT|\n0|a v2|MIT|\n0|b v1|MIT|\n");
        assert_eq!(check(&tree, &[]).findings.len(), 1);
        let exempted = check(&tree, &[exempt("a")]);
        assert!(exempted.passed());
        assert_eq!(exempted.notes, ["twice: a 1 and 2 (old; until new)"]);
    }

    #[test]
    fn a_stale_exemption_is_found() {
        let tree = parse_fixture("0|b v1|MIT|\n");
        assert!(check(&tree, &[exempt("b")]).findings[0].contains("exempts b"));
    }
}
