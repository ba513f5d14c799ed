//! The page that maps the crates: it misses none and names none that is gone.

use crate::manifests::Member;

pub(crate) const PAGE: &str = "docs/architecture.md";

/// Returns what `text` misses or names in vain.
pub(crate) fn check(text: &str, members: &[Member]) -> Vec<String> {
    let mut findings = Vec::new();
    for member in members {
        if !text.contains(&format!("`{}`", member.name)) {
            findings.push(format!("{PAGE}: misses `{}`", member.name));
        }
    }
    for (number, line) in text.lines().enumerate() {
        for name in crate_names(line) {
            if !members.iter().any(|member| member.name == name) {
                findings.push(format!(
                    "{PAGE}:{}: names {name}, which is no crate of the workspace",
                    number + 1
                ));
            }
        }
    }
    findings
}

/// Words that look like a crate of ours: `dwell-something`.
fn crate_names(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_ascii_alphanumeric() && c != '-' && c != '_')
        .map(|word| word.trim_matches('-'))
        .filter(|word| word.starts_with("dwell-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn members(names: &[&str]) -> Vec<Member> {
        let member = |name: &&str| Member {
            name: (*name).to_owned(),
            manifest_path: String::new(),
            dependencies: Vec::new(),
        };
        names.iter().map(member).collect()
    }

    #[test]
    fn a_true_page_passes() {
        let page = "| `dwell` | time |\n| `dwell-scene` | nouns |\n";
        assert_eq!(check(page, &members(&["dwell", "dwell-scene"])), [""; 0]);
    }

    #[test]
    fn a_missing_crate_is_found() {
        assert_eq!(
            check("`dwell-scene`", &members(&["dwell", "dwell-scene"])),
            ["docs/architecture.md: misses `dwell`"]
        );
    }

    #[test]
    fn a_crate_that_is_gone_is_found_with_its_line() {
        assert_eq!(
            check("`dwell`\n\nsee dwell-sound.", &members(&["dwell"])),
            ["docs/architecture.md:3: names dwell-sound, which is no crate of the workspace"]
        );
    }
}
