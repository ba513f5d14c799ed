//! Elementary functions in crates whose bits must not depend on the machine: through `dwell_scene::math` or `libm` only.
//!
//! The standard library's `sin` and kin, and glam's functions that call them, are the platform's. Clippy's list of disallowed
//! methods would hold for tests too, where they are the natural oracle; so the sources are read here, up to their tests.

use crate::findings::CheckOutcome;
use std::fs;
use std::path::{Path, PathBuf};

/// The crates, by their folders.
const CRATES: &[&str] = &[
    "engine/scene",
    "engine/render",
    "engine/world",
    "physics",
    "acoustics",
    "semantics",
];

/// Methods of numbers and of glam's rotations. A call has a dot before it, or for glam's makers two colons.
const METHODS: &[&str] = &[
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "powf",
    "hypot",
    "cbrt",
    "to_scaled_axis",
    "to_axis_angle",
    "to_euler",
    "angle_between",
    "slerp",
    "rotate_towards",
];
const MAKERS: &[&str] = &[
    "from_axis_angle",
    "from_scaled_axis",
    "from_rotation_x",
    "from_rotation_y",
    "from_rotation_z",
    "from_euler",
    "from_angle",
];

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let mut outcome = CheckOutcome::default();
    let mut count = 0;
    for name in CRATES {
        let mut files = Vec::new();
        sources(&root.join(name).join("src"), &mut files)?;
        count += files.len();
        for file in files {
            let text = read(&file)?;
            let shown = file
                .strip_prefix(root)
                .unwrap_or(&file)
                .display()
                .to_string();
            outcome.findings.extend(calls(&text).into_iter().map(|(line, call)| {
                format!(
                    "{shown}:{line}: {call} is the platform's; take dwell_scene::math or libm, which have the same bits everywhere"
                )
            }));
        }
    }
    outcome
        .notes
        .push(format!("{count} files of {} crates", CRATES.len()));
    Ok(outcome)
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// The Rust files below a folder, in order.
fn sources(folder: &Path, out: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            sources(&path, out)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            out.push(path);
        }
    }
    Ok(())
}

/// Lines, counted from 1, and calls, before a file's tests and outside of comments.
fn calls(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("#[cfg(test)]") {
            break;
        }
        let code = line.split("//").next().unwrap_or("");
        let methods = METHODS.iter().map(|name| format!(".{name}("));
        let makers = MAKERS.iter().map(|name| format!("::{name}("));
        for call in methods
            .chain(makers)
            .filter(|call| code.contains(call.as_str()))
        {
            found.push((index + 1, format!("{call})")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_platforms_functions_are_found_and_ours_are_not() {
        let text = "let a = x.sin();\nlet b = math::sin(x); // not x.cos()\nlet c = libm::hypot(x, y);\n\
                    let d = Quat::from_rotation_y(a);\nlet e = x.sqrt();\n#[cfg(test)]\nlet f = x.exp();\n";
        assert_eq!(
            calls(text),
            [
                (1, ".sin()".to_owned()),
                (4, "::from_rotation_y()".to_owned())
            ]
        );
    }

    #[test]
    fn this_repository_passes() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        assert_eq!(run(root).unwrap().findings, [""; 0]);
    }
}
