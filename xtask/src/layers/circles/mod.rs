//! Circles between a crate's modules: two folders that use each other are one, whatever the tree shows.
//!
//! A module is a file or folder directly below `src/`; `lib.rs` and `main.rs` compose modules and are none. Names that they re-export
//! count as the module that defines them. Code of tests alone is left out.

mod graph;
mod module_files;
mod references;
mod root_names;

use crate::manifests::Member;
use std::path::Path;

/// Returns a finding for each shortest circle of each crate.
pub(crate) fn check(root: &Path, members: &[Member]) -> Result<Vec<String>, String> {
    let mut findings = Vec::new();
    for member in members {
        let folder = Path::new(&member.manifest_path)
            .parent()
            .ok_or_else(|| format!("{} lies nowhere", member.manifest_path))?;
        let circles = of_crate(root, folder)?.into_iter();
        findings.extend(circles.map(|circle| format!("{}: {circle}", member.name)));
    }
    Ok(findings)
}

/// Returns the circles of the crate in `folder`, with files relative to `root`.
fn of_crate(root: &Path, folder: &Path) -> Result<Vec<String>, String> {
    let sources = folder.join("src");
    let mut modules = graph::ModuleGraph::default();
    for name in ["lib.rs", "main.rs"] {
        let entry = sources.join(name);
        if entry.exists() {
            let files = module_files::of_crate(&entry)?;
            modules.add(root, &files)?;
        }
    }
    Ok(modules.cycles())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// A crate of the given files, in a folder of its own.
    fn circles_of(name: &str, files: &[(&str, &str)]) -> Result<Vec<String>, String> {
        let root =
            std::env::temp_dir().join(format!("xtask-circles-{name}-{}", std::process::id()));
        for (path, text) in files {
            let path = root.join("src").join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let circles = of_crate(&root, &root);
        fs::remove_dir_all(root).unwrap();
        circles
    }

    #[test]
    fn one_direction_passes() {
        let files = [
            ("lib.rs", "mod low; mod high; pub use high::High;"),
            ("low.rs", "pub struct Low;"),
            ("high.rs", "use crate::low::Low; pub struct High(Low);"),
        ];
        assert_eq!(circles_of("none", &files).unwrap(), [""; 0]);
    }

    #[test]
    fn two_modules_that_use_each_other_are_found_with_their_lines() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b::B;\npub struct A;\n"),
            ("b/mod.rs", "mod c;\npub struct B;\n"),
            (
                "b/c.rs",
                "\nfn f(\n    a: super::super::a::A,\n) {\n    let _ = crate::a::A;\n}\n",
            ),
        ];
        assert_eq!(
            circles_of("two", &files).unwrap(),
            ["a > b (src/a.rs:1), b > a (src/b/c.rs:3, src/b/c.rs:5)"]
        );
    }

    #[test]
    fn a_longer_circle_is_found() {
        let files = [
            ("lib.rs", "mod a; mod b; mod c;"),
            ("a.rs", "use super::{b::B, c};"),
            ("b.rs", "use crate::c;"),
            ("c.rs", "fn f() { vec![crate::a::f()]; }"),
        ];
        let circles = circles_of("three", &files).unwrap();
        assert_eq!(
            circles,
            [
                "a > c (src/a.rs:1), c > a (src/c.rs:1)",
                "a > b (src/a.rs:1), b > c (src/b.rs:1), c > a (src/c.rs:1)"
            ]
        );
    }

    #[test]
    fn names_of_the_root_count_as_their_modules() {
        let files = [
            (
                "lib.rs",
                "mod a; mod b; pub use a::inner::{A as Other}; pub(crate) use crate::Other as Last;",
            ),
            ("a/mod.rs", "pub mod inner;"),
            ("a/inner.rs", "use crate::b;"),
            ("b.rs", "pub type B = crate::Last;"),
        ];
        assert_eq!(
            circles_of("root", &files).unwrap(),
            ["a > b (src/a/inner.rs:1), b > a (src/b.rs:1)"]
        );
    }

    #[test]
    fn a_name_that_only_a_glob_of_the_root_can_bring_is_refused() {
        let files = [
            ("lib.rs", "mod a; mod b; pub use a::*; pub fn own() {}"),
            ("a.rs", "pub struct A; fn f() { crate::own() }"),
            ("b.rs", "use crate::A;"),
        ];
        let error = circles_of("glob", &files).unwrap_err();
        assert!(error.starts_with("src/b.rs:1: crate::A"), "{error}");
    }

    #[test]
    fn code_of_tests_and_comments_are_left_out() {
        let files = [
            ("lib.rs", "mod a; mod b; #[cfg(test)] mod fixtures;"),
            ("a.rs", "use crate::b;\n#[cfg(test)]\nuse crate::fixtures;"),
            (
                "b.rs",
                "//! See [`crate::a`].\n\n// crate::a::f()\nconst T: &str = \"crate::a\";\n\
                 #[cfg(test)]\nmod tests;\n#[cfg(all(test, unix))]\nmod more { use crate::a; }\n\
                 #[test]\nfn t() { crate::a::f() }\n",
            ),
            ("b/tests.rs", "use crate::a;"),
            ("fixtures.rs", "use crate::a;"),
        ];
        assert_eq!(circles_of("tests", &files).unwrap(), [""; 0]);
    }

    #[test]
    fn what_follows_code_of_tests_counts() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b;"),
            (
                "b.rs",
                "struct B {\n    #[cfg(test)]\n    only: u32,\n    other: crate::a::A,\n}\n",
            ),
        ];
        assert_eq!(
            circles_of("after", &files).unwrap(),
            ["a > b (src/a.rs:1), b > a (src/b.rs:4)"]
        );
    }

    #[test]
    fn code_that_is_also_built_without_tests_counts() {
        let files = [
            ("lib.rs", "mod a; mod b;"),
            ("a.rs", "use crate::b;"),
            (
                "b.rs",
                "#[cfg(any(test, unix))]\nuse crate::a::A;\n#[cfg(not(test))]\nuse crate::a::B;\n",
            ),
        ];
        assert_eq!(
            circles_of("cfg", &files).unwrap(),
            ["a > b (src/a.rs:1), b > a (src/b.rs:2, src/b.rs:4)"]
        );
    }

    #[test]
    fn a_file_that_is_no_rust_is_refused_with_its_place() {
        let files = [("lib.rs", "mod a;"), ("a.rs", "fn f() {\n")];
        let error = circles_of("broken", &files).unwrap_err();
        assert!(error.contains("a.rs:"), "{error}");
    }

    #[test]
    fn a_module_without_a_file_is_refused() {
        let error = circles_of("missing", &[("lib.rs", "mod a;")]).unwrap_err();
        assert!(error.contains("mod a has no file"), "{error}");
    }
}
