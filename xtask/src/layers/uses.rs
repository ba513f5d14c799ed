//! Dependencies among our own crates, as the manifests declare them.

use super::rules::Rule;
use crate::manifests::Member;
use std::path::Path;

/// Returns what departs from `rules`; `root` is the folder the rules' folders are relative to.
pub(crate) fn check(members: &[Member], rules: &[Rule], root: &Path) -> Vec<String> {
    let mut findings = Vec::new();
    for rule in rules {
        if !members.iter().any(|member| member.name == rule.name) {
            findings.push(format!(
                "{}: has a rule, but is no member of the workspace",
                rule.name
            ));
        }
    }
    for member in members {
        let Some(rule) = rules.iter().find(|rule| rule.name == member.name) else {
            findings.push(format!(
                "{}: has no place in the layers; give it a rule in xtask/src/layers/rules.rs",
                member.name
            ));
            continue;
        };
        if Path::new(&member.manifest_path).parent() != Some(&root.join(rule.folder)) {
            findings.push(format!(
                "{}: {} is not in {}",
                member.name, member.manifest_path, rule.folder
            ));
        }
        findings.extend(forbidden(member, rule, members));
    }
    findings
}

fn forbidden(member: &Member, rule: &Rule, members: &[Member]) -> Vec<String> {
    let ours = member
        .dependencies
        .iter()
        .filter(|used| members.iter().any(|other| other.name == used.name));
    ours.filter(|used| {
        let name = used.name.as_str();
        let always = rule.may_use.contains(&name);
        let in_tests = used.is_dev() && (rule.tests_may_use.contains(&name) || name == rule.name);
        !always && !in_tests
    })
    .map(|used| {
        let kind = if used.is_dev() { "in its tests " } else { "" };
        let mut allowed = rule.may_use.to_vec();
        if used.is_dev() {
            allowed.extend(rule.tests_may_use);
        }
        let allowed = if allowed.is_empty() {
            "none of ours".to_owned()
        } else {
            allowed.join(", ")
        };
        format!(
            "{}: uses {} {kind}but may use {allowed}",
            member.name, used.name
        )
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifests::Dependency;

    const RULES: &[Rule] = &[
        Rule {
            name: "low",
            folder: "low",
            may_use: &[],
            tests_may_use: &[],
        },
        Rule {
            name: "files",
            folder: "files",
            may_use: &["low"],
            tests_may_use: &[],
        },
        Rule {
            name: "eye",
            folder: "eye",
            may_use: &["low"],
            tests_may_use: &["files"],
        },
    ];

    fn member(name: &str, uses: &[(&str, Option<&str>)]) -> Member {
        let dependencies = uses
            .iter()
            .map(|(name, kind)| Dependency {
                name: (*name).to_owned(),
                kind: kind.map(str::to_owned),
            })
            .collect();
        Member {
            name: name.to_owned(),
            manifest_path: format!("/r/{name}/Cargo.toml"),
            dependencies,
        }
    }

    fn house(eye: &[(&str, Option<&str>)]) -> Vec<Member> {
        vec![
            member("eye", eye),
            member("files", &[("low", None)]),
            member("low", &[]),
        ]
    }

    fn findings(members: &[Member]) -> Vec<String> {
        check(members, RULES, Path::new("/r"))
    }

    #[test]
    fn downward_uses_pass() {
        assert_eq!(
            findings(&house(&[
                ("low", None),
                ("files", Some("dev")),
                ("serde", None)
            ])),
            [""; 0]
        );
    }

    #[test]
    fn a_sibling_is_refused() {
        assert_eq!(
            findings(&house(&[("files", None)])),
            ["eye: uses files but may use low"]
        );
    }

    #[test]
    fn a_sibling_in_a_build_script_is_refused() {
        assert_eq!(findings(&house(&[("files", Some("build"))])).len(), 1);
    }

    #[test]
    fn an_upward_use_is_refused_even_in_tests() {
        let mut members = house(&[("low", None)]);
        members[2] = member("low", &[("eye", Some("dev"))]);
        assert_eq!(
            findings(&members),
            ["low: uses eye in its tests but may use none of ours"]
        );
    }

    #[test]
    fn a_crate_without_a_rule_is_refused() {
        let mut members = house(&[]);
        members.push(member("new", &[]));
        assert!(findings(&members)[0].starts_with("new: has no place"));
    }

    #[test]
    fn a_rule_without_a_crate_is_refused() {
        assert_eq!(
            findings(&house(&[])[..2]),
            ["low: has a rule, but is no member of the workspace"]
        );
    }

    #[test]
    fn a_crate_in_another_folder_is_refused() {
        let mut members = house(&[]);
        members[0].manifest_path = "/r/engine/eye/Cargo.toml".to_owned();
        assert_eq!(
            findings(&members),
            ["eye: /r/engine/eye/Cargo.toml is not in eye"]
        );
    }
}
