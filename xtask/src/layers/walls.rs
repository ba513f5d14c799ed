//! Foundations that one crate hides: reached by nobody else, neither declared nor through someone else's crate.

use super::rules::DependencyWall;
use crate::manifests::Member;
use crate::tree::DependencyTree;
use std::collections::{BTreeMap, BTreeSet};

/// Each breach: who reaches what, on which way.
pub(crate) fn check(
    members: &[Member],
    tree: &DependencyTree,
    walls: &[DependencyWall],
) -> Vec<String> {
    let mut uses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for ((user, _), (used, _)) in &tree.edges {
        uses.entry(user).or_default().insert(used);
    }
    // What a manifest declares counts even where no feature turns it on yet.
    for member in members {
        uses.entry(&member.name)
            .or_default()
            .extend(member.dependencies.iter().map(|used| used.name.as_str()));
    }
    let ours: BTreeSet<&str> = members.iter().map(|member| member.name.as_str()).collect();
    let mut findings = Vec::new();
    for wall in walls {
        for member in members
            .iter()
            .filter(|member| !wall.allowed_crates.contains(&member.name.as_str()))
        {
            if let Some(way) = way_to(wall.dependency, &member.name, &uses, &ours) {
                findings.push(format!(
                    "{}: reaches {} ({}), which only {} may",
                    member.name,
                    wall.dependency,
                    way.join(" > "),
                    wall.allowed_crates.join(", ")
                ));
            }
        }
    }
    findings
}

/// A way from a member to `goal` that passes no other member, since those answer for themselves.
fn way_to<'a>(
    goal: &str,
    from: &'a str,
    uses: &BTreeMap<&'a str, BTreeSet<&'a str>>,
    ours: &BTreeSet<&str>,
) -> Option<Vec<&'a str>> {
    let mut came_from: BTreeMap<&str, &str> = BTreeMap::new();
    let mut open = vec![from];
    while let Some(user) = open.pop() {
        for &used in uses.get(user).into_iter().flatten() {
            if used == from || came_from.contains_key(used) || ours.contains(used) {
                continue;
            }
            came_from.insert(used, user);
            if used == goal {
                let mut way = vec![used];
                while let Some(&user) = way.last().and_then(|last| came_from.get(last)) {
                    way.push(user);
                }
                way.reverse();
                return Some(way);
            }
            open.push(used);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifests::Dependency;
    use crate::tree::parse_fixture;

    const WALLS: &[DependencyWall] = &[DependencyWall {
        dependency: "rigid",
        allowed_crates: &["physics"],
    }];

    fn member(name: &str, declares: &[&str]) -> Member {
        let dependencies = declares
            .iter()
            .map(|name| Dependency {
                name: (*name).to_owned(),
                kind: None,
            })
            .collect();
        Member {
            name: name.to_owned(),
            manifest_path: String::new(),
            dependencies,
        }
    }

    #[test]
    fn through_the_crate_behind_the_wall_is_fine() {
        let tree = parse_fixture("0|world v1|MIT|\n1|physics v1|MIT|\n2|rigid v1|MIT|\n");
        assert_eq!(
            check(
                &[member("physics", &["rigid"]), member("world", &[])],
                &tree,
                WALLS
            ),
            [""; 0]
        );
    }

    #[test]
    fn a_declared_use_is_a_breach() {
        let tree = parse_fixture("0|world v1|MIT|\n");
        let findings = check(&[member("world", &["rigid"])], &tree, WALLS);
        assert_eq!(
            findings,
            ["world: reaches rigid (world > rigid), which only physics may"]
        );
    }

    #[test]
    fn a_use_through_a_foreign_crate_is_a_breach() {
        let tree = parse_fixture("0|world v1|MIT|\n1|helper v1|MIT|\n2|rigid v1|MIT|\n");
        let findings = check(
            &[member("physics", &[]), member("world", &["helper"])],
            &tree,
            WALLS,
        );
        assert_eq!(
            findings,
            ["world: reaches rigid (world > helper > rigid), which only physics may"]
        );
    }

    #[test]
    fn circles_end() {
        let tree = parse_fixture("0|world v1|MIT|\n1|a v1|MIT|\n2|b v1|MIT|\n3|a v1|MIT|\n");
        assert_eq!(check(&[member("world", &["a"])], &tree, WALLS), [""; 0]);
    }
}
