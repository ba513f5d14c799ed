//! Small files, one concept each: lists the long ones.

use crate::findings::CheckOutcome;
use std::path::{Path, PathBuf};

/// Above this a file fails.
const LIMIT_LINES: usize = 600;
/// Above this one looks for the second concept.
const LOOK_LINES: usize = 400;
const SOURCE: &[&str] = &["css", "js", "py", "pyi", "rs", "sh", "wgsl"];
/// Folders that hold nothing of ours, or nothing that a person writes.
const SKIP: &[&str] = &[
    "target",
    "out",
    "dist",
    "node_modules",
    "__pycache__",
    "corpus",
];
/// In one of the first lines of a file whose length is that of its data.
const MARKS: &[&str] = &["@generated", "@table"];

pub(crate) fn check(root: &Path) -> Result<CheckOutcome, String> {
    let mut paths = Vec::new();
    walk(root, &mut paths).map_err(|error| format!("{}: {error}", root.display()))?;
    paths.sort();
    let mut outcome = CheckOutcome::default();
    let mut lines = Vec::new();
    for path in &paths {
        let text = std::fs::read_to_string(path)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        let name = path
            .strip_prefix(root)
            .unwrap_or(path)
            .display()
            .to_string();
        lines.push(text.lines().count());
        outcome.merge(judge(&name, &text));
    }
    lines.sort_unstable();
    let median = lines.get(lines.len() / 2).copied().unwrap_or(0);
    outcome.notes.insert(
        0,
        format!("{} source files, median {median} lines", lines.len()),
    );
    Ok(outcome)
}

fn judge(name: &str, text: &str) -> CheckOutcome {
    let lines = text.lines().count();
    let data = text
        .lines()
        .take(10)
        .any(|line| MARKS.iter().any(|mark| line.contains(mark)));
    let mut outcome = CheckOutcome::default();
    if lines > LIMIT_LINES && data {
        outcome
            .notes
            .push(format!("{name}: {lines} lines, a table or generated"));
    } else if lines > LIMIT_LINES {
        outcome.findings.push(format!(
            "{name}: {lines} lines, allowed are {LIMIT_LINES} (tables say @table at the top)"
        ));
    } else if lines > LOOK_LINES {
        outcome
            .notes
            .push(format!("{name}: {lines} lines; is there a second concept?"));
    }
    outcome
}

fn walk(folder: &Path, paths: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let path = entry.path();
        let kind = entry.file_type()?;
        if kind.is_dir() && !name.starts_with('.') && !SKIP.contains(&name.as_ref()) {
            walk(&path, paths)?;
        } else if kind.is_file()
            && path
                .extension()
                .is_some_and(|e| SOURCE.contains(&e.to_string_lossy().as_ref()))
        {
            paths.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_files_fail_and_tables_are_listed() {
        let long = "let x = 1;\n".repeat(601);
        assert!(!judge("a.rs", &long).passed());
        let table = judge("b.rs", &format!("// @table of colours\n{long}"));
        assert!(table.passed() && table.notes.len() == 1);
    }

    #[test]
    fn the_limit_itself_passes_with_a_question() {
        let outcome = judge("a.rs", &"x\n".repeat(600));
        assert!(outcome.passed() && outcome.notes[0].contains("second concept"));
        assert_eq!(judge("a.rs", &"x\n".repeat(400)), CheckOutcome::default());
    }
}
