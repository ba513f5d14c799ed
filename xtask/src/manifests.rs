//! The workspace's own manifests: what each member declares.

use crate::tree::cargo;
use serde::Deserialize;
use std::path::Path;

/// A workspace member.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub(crate) struct Member {
    pub name: String,
    pub manifest_path: String,
    pub dependencies: Vec<Dependency>,
}

/// One line of a `[dependencies]` table, whether it is active or not.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub(crate) struct Dependency {
    pub name: String,
    #[serde(default)]
    pub kind: Option<String>,
}

impl Dependency {
    /// Only tests, benches and examples see it.
    pub(crate) fn is_dev(&self) -> bool {
        self.kind.as_deref() == Some("dev")
    }
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Member>,
}

/// The members of the workspace at `root`, sorted by name.
pub(crate) fn members(root: &Path) -> Result<Vec<Member>, String> {
    let text = cargo(root, &["metadata", "--format-version", "1", "--no-deps"])?;
    parse(&text)
}

fn parse(metadata: &str) -> Result<Vec<Member>, String> {
    let metadata: Metadata = serde_json::from_str(metadata)
        .map_err(|error| format!("cargo metadata printed something else than expected: {error}"))?;
    let mut members = metadata.packages;
    members.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_told_apart() {
        let members = parse(
            r#"{"packages": [{"name": "a", "manifest_path": "/r/a/Cargo.toml", "dependencies": [
                {"name": "b", "kind": null}, {"name": "c", "kind": "dev"}, {"name": "d", "kind": "build"}]}]}"#,
        )
        .unwrap();
        let dev: Vec<bool> = members[0]
            .dependencies
            .iter()
            .map(Dependency::is_dev)
            .collect();
        assert_eq!(dev, [false, true, false]);
    }

    #[test]
    fn other_text_is_refused() {
        assert!(parse("{}").unwrap_err().contains("packages"));
    }
}
