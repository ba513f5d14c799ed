//! Every function that Python can call calls engines through `py.engine`, or is listed here with its reason.
//!
//! `py.engine` (`python/src/engine_call.rs`) releases the GIL, maps errors, stops panics and lets signals through; a function
//! that forgets it does none of that. The sources are read, because no lint knows what pyo3 makes of them.

use crate::findings::CheckOutcome;
use std::fs;
use std::path::Path;

/// File, function, why it does without.
const EXEMPT: &[(&str, &str, &str)] = &[
    ("acoustics.rs", "rate_hz", "reads a field"),
    ("acoustics.rs", "signals", "a table of constants"),
    ("build_info.rs", "action_table", "a table of constants"),
    ("build_info.rs", "actions", "a table of constants"),
    ("build_info.rs", "builtin_names", "a table of constants"),
    ("build_info.rs", "charset", "a table of constants"),
    ("build_info.rs", "furniture_kinds", "a table of constants"),
    ("build_info.rs", "laws", "a table of constants"),
    ("build_info.rs", "max_text_length", "a constant"),
    ("build_info.rs", "sensors", "a table of constants"),
    ("build_info.rs", "settings", "a table of constants"),
    ("build_info.rs", "tasks", "a table of constants"),
    ("build_info.rs", "object_class", "a table of constants"),
    ("build_info.rs", "object_classes", "a table of constants"),
    ("build_info.rs", "vocabulary", "a table of constants"),
    ("engine_call.rs", "new", "makes a flag"),
    ("engine_call.rs", "stop", "sets a flag"),
    ("engine_call.rs", "watch_this_thread", "keeps a flag"),
    ("hrtf.rs", "id", "reads a field"),
    ("house.rs", "name", "reads a field"),
];

/// Methods that call engines: the method itself, and those of this crate that do nothing before it.
const ENGINE_CALL_PATTERNS: &[&str] = &[
    ".engine(",
    ".with(py",
    ".with(slf.py()",
    ".read_interruptible(py",
    ".prepare(py",
];

pub(crate) fn run(root: &Path) -> Result<CheckOutcome, String> {
    let mut outcome = CheckOutcome::default();
    let folder = root.join("python/src");
    let shown = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder).map_err(shown)? {
        names.push(
            entry
                .map_err(shown)?
                .file_name()
                .to_string_lossy()
                .into_owned(),
        );
    }
    names.sort();
    let (mut count, mut excused) = (0, Vec::new());
    for name in &names {
        let path = folder.join(name);
        if path.extension().is_none_or(|kind| kind != "rs") {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        for function in called_by_python(&text) {
            count += 1;
            if function.uses_engine_call {
                continue;
            }
            let reason =
                |(file, own, _): &&(&str, &str, &str)| *file == name && *own == function.name;
            if let Some(known) = EXEMPT.iter().find(reason) {
                excused.push(*known);
                continue;
            }
            outcome.findings.push(format!(
                "python/src/{name}:{}: {} does not call engines through `py.engine`",
                function.line, function.name
            ));
        }
    }
    for (file, name, _) in EXEMPT.iter().filter(|known| !excused.contains(known)) {
        outcome.findings.push(format!(
            "xtask/src/py_engine.rs: {file}: {name} needs no exemption any more"
        ));
    }
    let share = format!(
        "{count} functions for Python, {} without `py.engine`",
        excused.len()
    );
    outcome.notes.push(share);
    Ok(outcome)
}

#[derive(Debug, PartialEq, Eq)]
struct Function {
    name: String,
    line: usize,
    uses_engine_call: bool,
}

/// The functions under `#[pyfunction]` and in blocks under `#[pymethods]`, in sources as rustfmt leaves them.
fn called_by_python(text: &str) -> Vec<Function> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    let (mut in_methods, mut is_function) = (false, false);
    let mut k = 0;
    while k < lines.len() {
        let line = lines[k];
        match line {
            "#[pymethods]" => in_methods = true,
            "#[pyfunction]" => is_function = true,
            "}" => (in_methods, is_function) = (false, false),
            _ => {}
        }
        let indent = if in_methods { "    " } else { "" };
        let is_start = (in_methods && line.starts_with("    ") && !line.starts_with("     "))
            || (is_function && !line.starts_with(' '));
        if is_start && let Some(name) = function_name(line) {
            let end = format!("{indent}}}");
            let body: Vec<&str> = lines[k..]
                .iter()
                .take_while(|l| **l != end)
                .copied()
                .collect();
            found.push(Function {
                name: name.to_owned(),
                line: k + 1,
                uses_engine_call: ENGINE_CALL_PATTERNS
                    .iter()
                    .any(|way| body.iter().any(|l| l.contains(way))),
            });
            k += body.len();
            is_function = false;
            continue;
        }
        k += 1;
    }
    found
}

/// The name that a line begins a function with.
fn function_name(line: &str) -> Option<&str> {
    let rest = line.trim_start();
    let rest = rest.strip_prefix("pub(crate) ").unwrap_or(rest);
    let rest = rest.strip_prefix("fn ")?;
    rest.split(['(', '<']).next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_and_methods_are_found_and_others_are_not() {
        let text = "\
fn own() {
}

#[pymethods]
impl PyThing {
    #[new]
    fn new(py: Python<'_>) -> PyResult<Self> {
        py.engine(|| work())
    }

    fn name(&self) -> &str {
        &self.name
    }
}

impl PyThing {
    fn hidden(&self) {
    }
}

#[pyfunction]
#[pyo3(signature = (a=1))]
pub(crate) fn call<'py>(
    py: Python<'py>,
) -> u32 {
    thing.with(py, |thing| thing.work())
}

fn helper() {
}
";
        let found = called_by_python(text);
        let shown: Vec<_> = found
            .iter()
            .map(|f| (f.name.as_str(), f.line, f.uses_engine_call))
            .collect();
        assert_eq!(
            shown,
            [("new", 7, true), ("name", 11, false), ("call", 23, true)]
        );
    }
}
