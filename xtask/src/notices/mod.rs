//! The licence texts of everything that the wheel's extension is made of, from the archives that are compiled.
//!
//! Written at build time to a folder that git ignores and `python/pyproject.toml` names among the licence files: one page
//! for crates and for what zig links, one for Rust's standard library, as the toolchain ships it.

mod archives;
mod page;

use crate::findings::CheckOutcome;
use crate::licences::spdx;
use crate::tree::{self, PackageId};
use archives::Manifest;
use page::IncludedWork;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGE: &str = "dwell-python";
/// Platforms that `make wheel` knows; their crates are listed together.
const PLATFORMS: &[&str] = &["x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"];
/// Relative to the repository's root.
const FOLDER: &str = "python/third-party";

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let mut outcome = CheckOutcome::default();
    let mut linked: BTreeMap<PackageId, (String, Manifest)> = BTreeMap::new();
    for platform in PLATFORMS {
        let tree = tree::tree(
            root,
            &[
                "--package",
                PACKAGE,
                "--edges",
                "normal",
                "--target",
                platform,
            ],
        )?;
        let mut manifests = archives::manifests(root, platform)?;
        for id in tree.linked(PACKAGE) {
            let package = &tree.packages[&id];
            // Our own crates stand under the licence beside this page.
            if package.source.is_none() {
                let manifest = manifests
                    .remove(&id)
                    .ok_or_else(|| format!("cargo metadata knows no {} {}", id.0, id.1))?;
                linked.insert(id, (package.licence.clone(), manifest));
            }
        }
    }
    let mut works = crates(root, &linked, &mut outcome)?;
    let count = works.len();
    works.extend(of_zig(root)?);
    let page = page::page(&works);

    let folder = root.join(FOLDER);
    let library = folder.join("rust-standard-library.html");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{FOLDER}: {error}"))?;
    std::fs::write(folder.join("crates.txt"), &page)
        .map_err(|error| format!("{FOLDER}: {error}"))?;
    std::fs::write(&library, of_rust(root)?)
        .map_err(|error| format!("{}: {error}", library.display()))?;
    outcome.notes.push(format!(
        "{FOLDER}: {count} crates, {} kB",
        page.len() / 1000
    ));
    Ok(outcome)
}

/// Every crate with its own texts, or with those of a crate out of the same repository, or with the text its licence is
/// known by.
fn crates(
    root: &Path,
    linked: &BTreeMap<PackageId, (String, Manifest)>,
    outcome: &mut CheckOutcome,
) -> Result<Vec<IncludedWork>, String> {
    let mut works = Vec::new();
    for ((name, version), (licence, manifest)) in linked {
        let mut texts = manifest.texts()?;
        if texts.is_empty() {
            texts = of_siblings(linked, manifest)?;
        }
        // Its text names no author, so one copy is as good as another; ours is the licence as published.
        if texts.is_empty() && spdx::is_satisfied(licence, &["Apache-2.0".to_owned()].into())? {
            texts.push(archives::read(&root.join("LICENSE-APACHE"))?);
        }
        if texts.is_empty() {
            outcome.findings.push(format!(
                "{name} {version}: its archive has no text of {licence:?}, nor has one of its repository"
            ));
        }
        let mut origin = manifest.repository.clone().unwrap_or_default();
        if !manifest.authors.is_empty() {
            origin = format!("{origin} | {}", manifest.authors.join(", "));
        }
        works.push(IncludedWork {
            title: format!("{name} {version}"),
            licence: licence.clone(),
            origin,
            texts,
        });
    }
    Ok(works)
}

fn of_siblings(
    linked: &BTreeMap<PackageId, (String, Manifest)>,
    manifest: &Manifest,
) -> Result<Vec<String>, String> {
    for (_, other) in linked.values() {
        if manifest.repository.is_some() && other.repository == manifest.repository {
            let texts = other.texts()?;
            if !texts.is_empty() {
                return Ok(texts);
            }
        }
    }
    Ok(Vec::new())
}

/// Returns what zig, the wheel's linker, adds of its own.
fn of_zig(root: &Path) -> Result<Vec<IncludedWork>, String> {
    let folder = ziglang(root).ok_or(
        "ziglang, the wheel's linker, is not in .venv; `make wheel` installs it and calls this",
    )?;
    Ok(vec![IncludedWork {
        title: "zig compiler-rt".to_owned(),
        licence: "MIT".to_owned(),
        origin: "https://ziglang.org".to_owned(),
        texts: vec![archives::read(&folder.join("LICENSE"))?],
    }])
}

fn ziglang(root: &Path) -> Option<PathBuf> {
    let pythons = std::fs::read_dir(root.join(".venv/lib")).ok()?;
    pythons
        .flatten()
        .map(|python| python.path().join("site-packages/ziglang"))
        .find(|folder| folder.is_dir())
}

/// The page of copyrights that comes with the compiler.
fn of_rust(root: &Path) -> Result<String, String> {
    let output = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--print", "sysroot"])
        .current_dir(root)
        .output()
        .map_err(|error| format!("rustc cannot be started: {error}"))?;
    let sysroot = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    archives::read(&Path::new(&sysroot).join("share/doc/rust/COPYRIGHT-library.html"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One crate under `licence` in a folder without any text.
    fn listed(licence: &str) -> (Vec<IncludedWork>, CheckOutcome) {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let manifest = Manifest::in_folder(&root.join("xtask/src/notices"));
        let id = ("a".to_owned(), "1".to_owned());
        let mut outcome = CheckOutcome::default();
        let linked = [(id, (licence.to_owned(), manifest))].into();
        let works = crates(root, &linked, &mut outcome).unwrap();
        (works, outcome)
    }

    #[test]
    fn a_crate_without_any_text_is_found() {
        let (_, outcome) = listed("BSD-3-Clause");
        assert!(
            outcome.findings[0].starts_with("a 1: its archive has no text of \"BSD-3-Clause\"")
        );
    }

    #[test]
    fn apache_has_one_text_for_all() {
        let (works, outcome) = listed("MIT OR Apache-2.0");
        assert!(outcome.passed() && works[0].texts[0].contains("Apache License"));
    }
}
